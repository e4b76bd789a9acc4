#!/usr/bin/env python3
"""First Piola-Kirchhoff stress, over mu, of a neo-Hookean body whose rest shape flows (docs/theory/neo_hookean.md), by
SciPy's integrator: numbers of tests/mechanics/elasticity/neo_hookean_test.cpp. Needs NumPy and SciPy."""
import numpy as np
from scipy.integrate import solve_ivp


def gradient(t):
    """F at time t, in units of tau: stretched for a time tau, then held, and sheared to and fro."""
    stretch, shear = 1 + 0.8 * min(t, 1), 0.6 * np.sin(2 * t)
    return np.array([[stretch, 0, shear], [0, stretch**-0.4, 0], [0, 0, stretch**-0.4]])


def rate(t, y):
    Cp, F = y.reshape(3, 3), gradient(t)
    C = F.T @ F
    return (C - np.trace(C @ np.linalg.inv(Cp)) / 3 * Cp).ravel()


Cp, start = np.eye(3), 0.0
for end in (0.5, 1.0, 2.0):  # a piece ends where the stretch bends
    Cp = solve_ivp(rate, (start, end), Cp.ravel(), method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1].reshape(3, 3)
    F, start = gradient(end), end
    P = F @ np.linalg.inv(Cp) - np.linalg.inv(F).T
    print(f"t = {end} tau, det Cp - 1 = {np.linalg.det(Cp) - 1:.1e}")
    print("\n".join("  {" + ", ".join(f"{value:.10f}" for value in row) + "}," for row in P))
