"""A law of its own, in one file: apical faces resist changes of area, and those of a ring want a third of theirs.

Usage: law.py [FOLDER], with Python that finds plica and SymPy. Prints what the energy constant does to the depth of the dish.
"""
import sys

import numpy as np
import plica

SHEET = {"embryo": {"shape": "block", "length_um": 90, "width_um": 90, "cell_height_um": 10, "cells": [18, 18, 1]},
         "elasticity": {"young_modulus_Pa": 300}, "time": {"end_min": 5}}

faces = plica.Simulation(SHEET).hexahedra[:, 4:]  # apical corners of each cell
x, y, _ = plica.Simulation(SHEET).positions[faces].mean(axis=1).T
ring = abs(np.hypot(x, y) - 28) < 5
areas = plica.LocalEnergy("k / 2 * (area(0, 1, 2) + area(0, 2, 3) - A) ** 2 / A", faces, k=2, A=np.where(ring, 8, 25))


def fold(folder):
    """Run the sheet with the law."""
    sim = plica.Simulation(SHEET, energies={"areas": areas})
    sim.run(out=folder, overwrite=True)
    return sim


def depth(positions):
    """Height of the rim above the middle, um, and its gradient by positions."""
    gradient, from_middle = np.zeros_like(positions), np.hypot(*positions[faces[:, 0], :2].T)
    gradient[faces[from_middle > 55, 0], 2] = 1 / (from_middle > 55).sum()
    gradient[faces[from_middle < 15, 0], 2] = -1 / (from_middle < 15).sum()
    return float((gradient * positions).sum()), gradient


if __name__ == "__main__":
    fold(sys.argv[1] if len(sys.argv) > 1 else "results/law")
    tape = plica.record(SHEET, energies={"areas": areas})
    slope = tape.gradient(depth, of="energy.areas.k")
    print(f"{tape.value(depth):.1f} um deep; 1 nN/um more deepens it by {slope:.2f} um")
