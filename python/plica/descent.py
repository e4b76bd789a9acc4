"""Gauss–Newton steps within a trust region and bounds."""
from __future__ import annotations

import math
from typing import NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from .errors import NumericsError
from .fit_problem import Problem
from .progress import Counter

Array = NDArray[np.float64]
FIRST_RADIUS = 0.5  # of steps; norm of changes of logarithms
LEAST_RADIUS = 1e-5


class End(NamedTuple):
    """Where a descent ends, and the runs so far."""

    place: Array
    score: float
    runs: int
    end: str


def descend(problem: Problem, begin: End, until: Optional[float], most_runs: int, tolerance: float, counter: Counter) -> End:
    """Minimise the sum of squared residuals up to a time. At least one run is made; NumericsError if it fails."""
    place, runs = begin.place, begin.runs

    def tried(at: Array) -> tuple[Optional[Array], float]:
        nonlocal runs
        runs += 1
        found = problem.residuals(at, until)
        score = math.inf if found is None else float(found @ found)
        counter.add(f"score {score:.4g}")
        return found, score

    residuals, score = tried(place)
    if residuals is None:
        raise NumericsError(problem.run(place, until)["reason"])
    radius, slopes = FIRST_RADIUS, problem.slopes(place, until)
    failed = False  # the last step
    while True:
        step = bounded_step(slopes, residuals, problem.low - place, problem.high - place, radius)
        gain = score - float(((residuals + slopes @ step) ** 2).sum())
        length = float(np.linalg.norm(step))
        if gain < tolerance and length < 0.99 * radius:
            return End(place, score, runs, "converged")
        if (failed and gain < tolerance) or radius < LEAST_RADIUS:
            return End(place, score, runs, "no better place nearby")
        if runs >= most_runs:
            return End(place, score, runs, "runs spent")
        there = place + step
        found, after = tried(there)
        part = (score - after) / max(gain, tolerance)
        if part < 0.25:
            radius = 0.25 * min(length, radius)
        elif part > 0.75 and length > 0.9 * radius:
            radius *= 2
        failed = True
        if found is not None and after < score:
            try:
                slopes = problem.slopes(there, until)
            except NumericsError:
                radius = min(0.25 * length, radius)
                continue
            place, residuals, score, failed = there, found, after, False


def bounded_step(slopes: Array, residuals: Array, low: Array, high: Array, radius: float) -> Array:
    """Return the step that minimises |residuals + slopes step| among those of at most this norm (Levenberg–Marquardt), with
    components that reach a bound held there."""
    step = np.zeros(slopes.shape[1])
    is_free = np.ones(len(step), dtype=bool)
    while is_free.any():
        rest = residuals + slopes[:, ~is_free] @ step[~is_free]
        left = math.sqrt(max(radius**2 - float(step[~is_free] @ step[~is_free]), (0.1 * radius) ** 2))
        step[is_free] = _damped(slopes[:, is_free], rest, left)
        beyond = is_free & ((step < low) | (step > high))
        if not beyond.any():
            break
        step[beyond] = np.clip(step, low, high)[beyond]
        is_free &= ~beyond
    return step


def _damped(slopes: Array, residuals: Array, radius: float) -> Array:
    u, s, v = np.linalg.svd(slopes, full_matrices=False)
    along = u.T @ residuals

    def step(damping: float) -> Array:
        return np.asarray(-v.T @ (along * s / (s**2 + damping)))

    low, high = 1e-12 * float(s[0]) ** 2 + 1e-300, max(float(s[0] * np.linalg.norm(residuals)) / radius, 1e-300)
    if np.linalg.norm(step(low)) <= radius:
        return step(low)
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if np.linalg.norm(step(middle)) > radius else (low, middle)
    return step(high)
