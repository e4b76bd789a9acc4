"""Misfit of runs to shapes as a function of log factors of cells, its gradient and curvature (inference.py)."""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Optional

import numpy as np
from numpy.typing import NDArray

from .scenario import Scenario
from .shape_targets import Residuals
from .simulation import Simulation
from .tapes import Tape, record

Array = NDArray[np.float64]
COMMON_SPREAD = 1.0  # of the log of the common factor
SMOOTH_PART = 0.5  # of the prior variance, which correlates between neighbours
FIRST_BAND, BAND_RATIO = 4, 1.7  # size of the first band of eigenvectors that share a curvature, and ratio of the ends of others
CHANGE = 1e-3  # of a log factor, for its derivatives
COARSER = 20  # times the tolerance of steps, for linearised runs
LONGER = 4  # times the longest step, or the given one
LINEAR_TOLERANCE = 1e-3  # of solves in linearised runs


class Field:
    """Log factors of one law: coefficients of the eigenvectors of the Laplacian of the graph of its cells."""

    def __init__(self, simulation: Simulation, law: str, length_um: Optional[float]) -> None:
        self.law = law
        strength = simulation._core.strength(law)
        self.acting = np.flatnonzero(strength)
        if len(self.acting) == 0:
            raise ValueError(f"of: {law} acts on no cell; choose another law")
        self.cells = len(strength)
        place = np.full(self.cells, -1)
        place[self.acting] = np.arange(len(self.acting))
        pairs = place[simulation.neighbours]
        pairs = pairs[(pairs >= 0).all(axis=1)]
        self.pairs = pairs
        centres = np.stack([simulation.cell_data[f"{axis}_um"] for axis in "xyz"], axis=1)[self.acting]
        apart = np.linalg.norm(centres[pairs[:, 0]] - centres[pairs[:, 1]], axis=1)
        spacing = float(np.median(apart)) if len(apart) else 1.0
        self.length_um = 2 * spacing if length_um is None else length_um
        count = len(self.acting)
        # On a square lattice of unit spacing this is the Laplace operator.
        laplacian = np.zeros((count, count))
        for a, b in (pairs.T, pairs.T[::-1]):
            np.add.at(laplacian, (a, a), 2 * count / max(len(pairs), 1))
            np.add.at(laplacian, (a, b), -2 * count / max(len(pairs), 1))
        eigenvalues, self.vectors = np.linalg.eigh(laplacian)
        self.is_common = eigenvalues < 1e-9
        smooth = 1 / (1 + (self.length_um / spacing) ** 2 * eigenvalues)
        if not self.is_common.all():
            smooth /= smooth[~self.is_common].mean()
        self.unit_precision = 1 / (SMOOTH_PART * smooth + 1 - SMOOTH_PART)
        ends = [0, min(FIRST_BAND, count)]
        while ends[-1] < count:
            ends.append(min(count, int(BAND_RATIO * ends[-1])))
        self.band = np.searchsorted(ends, np.arange(count), side="right") - 1

    def band_means(self, squares: Array) -> Array:
        """Return for each coefficient the mean over its band."""
        return (np.bincount(self.band, squares) / np.bincount(self.band))[self.band]

    def near_means(self, squares: Array) -> Array:
        """Return for each acting cell the mean over itself and its neighbours."""
        sums, counts = squares.copy(), np.ones(len(squares))
        for a, b in (self.pairs.T, self.pairs.T[::-1]):
            np.add.at(sums, a, squares[b])
            np.add.at(counts, a, 1)
        return np.asarray(sums / counts)

    def precision(self, spread: float) -> Array:
        """Return the prior precision of the coefficients."""
        return np.where(self.is_common, 1 / (len(self.acting) * COMMON_SPREAD**2), self.unit_precision / spread**2)


class Problem:
    """Misfit of runs to targets, and its gradient by coefficients of the fields."""

    def __init__(self, scenario: Scenario, fields: list[Field], times_min: list[float], residuals: Residuals, threads: int) -> None:
        self.scenario, self.fields, self.times_min, self.residuals, self.threads = scenario, fields, times_min, residuals, threads
        self.runs = 0

    def logs(self, v: Array) -> list[Array]:
        """Return log factors of acting cells of each law."""
        return [field.vectors @ part for field, part in zip(self.fields, self.by_law(v))]

    def by_law(self, values: Array) -> list[Array]:
        return np.split(values, np.cumsum([len(field.acting) for field in self.fields])[:-1])

    def factors(self, v: Array) -> dict[str, Array]:
        """Return factors of all cells; 1 where a law does not act."""
        found: dict[str, Array] = {}
        for field, log in zip(self.fields, self.logs(v)):
            found[field.law] = np.ones(field.cells)
            found[field.law][field.acting] = np.exp(log)
        return found

    def precision(self, spreads: Array) -> Array:
        return np.concatenate([field.precision(spread) for field, spread in zip(self.fields, spreads)])

    def run(self, v: Array, times: int) -> Tape:
        """Record the run until the last of the first times."""
        self.runs += 1
        tape = record(self.scenario, at_min=self.times_min[:times], until_min=self.times_min[times - 1],
                      strengths=self.factors(v), threads=self.threads)
        if tape._core.changes > 0:
            raise ValueError("infer: cells divide or exchange neighbours before the last shape, so shapes cannot be compared by node or "
                             "cell; leave out later shapes, or remove division and exchange from the scenario")
        return tape

    def run_coarsely(self, v: Array, times: int) -> Tape:
        """Record the same run in longer steps, for derivatives where an error of some percent does no harm."""
        coarse = self.scenario.copy()
        if coarse["time.step_s"] == "adaptive":
            coarse.update({"time.tolerance_um": COARSER * float(coarse["time.tolerance_um"]), "output.frame_every_s": 0,
                           "time.max_step_s": LONGER * float(coarse["time.max_step_s"])})
        else:
            coarse["time.step_s"] = LONGER * float(coarse["time.step_s"])
        return record(coarse, at_min=self.times_min[:times], until_min=self.times_min[times - 1], strengths=self.factors(v), threads=self.threads)

    def misfits(self, tape: Tape, times: int) -> Array:
        """Return the sum of squared residuals at each of the first times."""
        return self.residuals.of(self._positions(tape, times))[1]

    def _positions(self, tape: Tape, times: int) -> list[Array]:
        return [tape.positions(time) for time in self.times_min[:times]]

    def by_logs(self, tape: Tape, v: Array, by_positions: Array, tolerance: float = 1e-6) -> list[Array]:
        """Return the gradient by log factors of acting cells of each law, from that by positions at the first times."""
        at = self.times_min[: len(by_positions)]
        return [np.exp(log) * tape.gradient(by_positions, of=field.law, by="cell", at_min=at, tolerance=tolerance)[field.acting]
                for field, log in zip(self.fields, self.logs(v))]

    def coefficients(self, by_law: list[Array]) -> Array:
        """Return the gradient by coefficients from that by log factors of each law."""
        return np.concatenate([field.vectors.T @ part for field, part in zip(self.fields, by_law)])

    def gradient(self, tape: Tape, v: Array, times: int) -> Array:
        """Return the gradient of half the misfit by coefficients."""
        by_positions = self.residuals.gradients(self._positions(tape, times))
        return self.coefficients(self.by_logs(tape, v, by_positions))

    def product(self, tape: Tape, v: Array, change: Array, times: int) -> Array:
        """Return the product of the Gauss-Newton Hessian of half the misfit with a change of coefficients."""
        along = {}
        for field, log, changed in zip(self.fields, self.logs(v), self.logs(change)):
            along[field.law] = np.zeros(field.cells)
            along[field.law][field.acting] = np.exp(log) * changed
        motions = tape._along(along, self.times_min[:times], LINEAR_TOLERANCE)
        return self.coefficients(self.by_logs(tape, v, self.residuals.product(self._positions(tape, times), motions), LINEAR_TOLERANCE))

    def probe(self, tape: Tape, v: Array, times: int, rng: np.random.Generator) -> list[Array]:
        """Return the gradient by log factors of a sum of residuals with independent normal weights."""
        return self.by_logs(tape, v, self.residuals.probe(self._positions(tape, times), rng), LINEAR_TOLERANCE)

    def curvature(self, tape: Tape, v: Array, times: int) -> Array:
        """Return the Gauss-Newton Hessian of half the misfit by log factors of acting cells of all laws."""
        factors = self.factors(v)

        def changed() -> Iterator[list[Array]]:
            for field in self.fields:
                for cell in field.acting:
                    of_law = factors[field.law].copy()
                    of_law[cell] *= math.exp(CHANGE)
                    yield self._positions(tape._with_strengths({**factors, field.law: of_law}), times)

        return self.residuals.curvature(self._positions(tape, times), changed(), CHANGE)

    def counts(self, times: int) -> Array:
        """Return the number of residuals at each of the first times."""
        return self.residuals.counts(times)
