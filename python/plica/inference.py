"""Inference of the strengths of cells from shapes (docs/how-to/gradients.md).

Log factors of a law are Q v, with the eigenvectors Q of the Laplacian of the graph of its cells. Prior: coefficients v are
independent. Half of their variance spread² falls as 1 / (1 + length² eigenvalue), so neighbours correlate over a length; half is
equal for all, since cells also differ from their neighbours. Their weights, and the search, are in inference_search.py. The uncertainty
follows from the whole Hessian, one run per cell, or from averages where cells are many.
"""
from __future__ import annotations

import hashlib
import os
import sys
import warnings
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number_from, path_of, text_of, texts_of, told, whole
from .errors import FileError, needed
from .inference_problem import Field, Problem
from .inference_search import Search
from .knots import divided, times_of
from .scenario import Scenario
from .shape_targets import ApicalFaces, CellTarget, NodeTarget, Residuals, target_of
from .simulation import Simulation
from .tapes import record
from .whole_cells import WholeCells

__all__ = ["Inference", "infer"]

Array = NDArray[np.float64]
MISSED = "Residuals exceed the noise: the model differs from the tissue, or noise_um is too small"


@dataclass(frozen=True)
class Inference:
    """Factors on the strengths of cells that explain shapes; made by `infer`.

    Shapes fix ratios of forces only. `factors` are therefore relative to their mean, over all laws; `scale` is that mean, which
    has a meaning only as far as the stiffnesses and the drag of the scenario are measured.

    Attributes
    ----------
    scenario : Scenario
        Scenario of the laws. With knots in time, each law is divided there into one per knot (``"cortex.apical-at-5-min"``).
    factors : dict of str to ndarray of float
        By law, a number per cell: factor on its strength, with mean 1; NaN where the law does not act. Between knots, factors are
        linear in time.
    sd : dict of str to ndarray of float
        Posterior standard deviation of the logarithms of factors, given prior, noise and model.
    unseen : dict of str to ndarray of float
        Part of the prior variance that remains: 0, known from the shapes; 1, not seen by them.
    scale : float
        Mean factor at the scenario's stiffnesses and drag.
    times_min, misfit : ndarray of float, shape (times,)
        Times, and root mean square residual at each in units of the noise: 1 where the model explains the shapes.
    excess : float
        Residuals in units of the noise, all times, 1 or more. Above 1: the noise is larger than `noise_um`, or the model does
        not fit; `sd` is larger accordingly.
    spread : dict of str to float
        Prior standard deviation of log factors by law, given or from its evidence.
    length_um : dict of str to float
        Length of the prior, µm.
    runs : int
        Recorded runs.
    converged : bool
        Whether the minimum was reached within `most_runs`.
    has_model_error : bool
        Whether residuals are too large for a right model, also if the noise were 10 % larger than `noise_um`: their sum of squares,
        over that noise, has a probability below 0.1 % for as many residuals without the factors that they determine.
    """

    scenario: Scenario
    factors: dict[str, Array]
    sd: dict[str, Array]
    unseen: dict[str, Array]
    scale: float
    times_min: Array
    misfit: Array
    excess: float
    spread: dict[str, float]
    length_um: dict[str, float]
    runs: int
    converged: bool
    has_model_error: bool

    @property
    def strengths(self) -> dict[str, Array]:
        """Factors for ``plica.record`` of `scenario`, not divided by their mean; 1 where a law does not act."""
        return {law: np.where(np.isnan(factors), 1, self.scale * factors) for law, factors in self.factors.items()}

    def interval(self, law: str, part: float = 0.9) -> tuple[Array, Array]:
        """Return lower and upper ends of the central interval of each factor.

        Parameters
        ----------
        law : str
            A law of `factors`.
        part : float
            Probability of the interval.
        """
        if law not in self.factors:
            raise ValueError(f"law: {told(law)}; choose one of {', '.join(self.factors)}")
        inside = number_from(part, 0, "part", "a probability between 0 and 1", above=True)
        if inside >= 1:
            raise ValueError(f"part: {told(part)}; give a probability between 0 and 1")
        wide = NormalDist().inv_cdf(0.5 + inside / 2) * self.sd[law]
        return self.factors[law] * np.exp(-wide), self.factors[law] * np.exp(wide)

    def plot(self) -> Any:
        """Map the factors of each law, their standard deviations, and which cells the shapes do not show.

        A flat sheet is seen from above; other tissues are unrolled about the x axis, with the ventral midline in the middle.

        Returns
        -------
        matplotlib.figure.Figure
        """
        plt = needed("matplotlib.pyplot", "plot")
        x, y, z = (Simulation(self.scenario).cell_data[f"{axis}_um"] for axis in "xyz")
        is_flat = np.ptp(z) < 0.2 * np.ptp(y)
        across, name = (y, "y (µm)") if is_flat else (np.degrees(np.arctan2(y, -z)), "angle from the ventral midline (°)")
        figure, axes = plt.subplots(len(self.factors), 3, figsize=(13, 3.6 * len(self.factors)), layout="constrained", squeeze=False)
        size = min(300.0, 30000 / len(x))
        for row, (law, factors) in zip(axes, self.factors.items()):
            largest = max(1.05, float(np.nanmax(factors)), 1 / float(np.nanmin(factors)))
            for ax, values, title, colours, limits in zip(
                    row, (np.log2(factors), self.sd[law], self.unseen[law]),
                    (f"{law}: log2 of the factor", "sd of the logarithm", "not seen: 1"), ("RdBu_r", "viridis", "Greys"),
                    ((-np.log2(largest), np.log2(largest)), (0, None), (0, 1))):
                shown = ax.scatter(x, across, c=values, s=size, marker="s", cmap=colours, vmin=limits[0], vmax=limits[1])
                figure.colorbar(shown, ax=ax, shrink=0.8)
                ax.set(title=title, xlabel="x (µm)", ylabel=name)
        return figure

    def __repr__(self) -> str:
        lines = [f"Inference from {len(self.times_min)} times in {self.runs} runs" + ("" if self.converged else ", not converged")]
        for law, factors in self.factors.items():
            seen = float((self.unseen[law][np.isfinite(factors)] < 0.5).mean())
            lines.append(f"{law}: factors {np.nanmin(factors):.2f} to {np.nanmax(factors):.2f} relative to the mean, "
                         f"± {np.nanmedian(self.sd[law]):.1%}; {seen:.0%} of the cells seen by the shapes")
        lines.append("misfit / noise: " + ", ".join(f"{one:.2f} at {time:g} min" for one, time in zip(self.misfit, self.times_min)))
        if self.has_model_error:
            lines.append(MISSED + ("." if self.converged else ", or more runs are needed."))
        lines.append(f"ratios only; mean factor {self.scale:.3g} if stiffnesses and drag are as in the scenario")
        return "\n".join(lines)


def infer(
    scenario: Union[Scenario, str, os.PathLike[str], Mapping[str, Any]],
    shapes: Mapping[float, Any],
    *,
    of: Union[str, Iterable[str]],
    noise_um: float,
    knots_min: Optional[Iterable[float]] = None,
    surface: str = "apical",
    length_um: Optional[float] = None,
    spread: Optional[float] = None,
    most_runs: int = 60,
    probes: Optional[int] = None,
    drift: str = "",
    file: Union[None, str, os.PathLike[str]] = None,
    progress: bool = False,
    threads: int = 1,
) -> Inference:
    """Infer the strengths of cells from shapes at one or several times.

    Parameters
    ----------
    scenario : Scenario, str, path or mapping
        The model: as for `record`. Its strengths are where the search begins.
    shapes : mapping of float to shape
        By time in minutes. A shape is an array of node positions, µm, of shape (nodes, 3), NaN where unknown, for the mesh of the
        scenario; or, for any mesh, cells in the order of ``Simulation.cell_data``, NaN where unknown: a `Frame`, `Polygons`, or a
        mapping with ``centres_um`` of shape (cells, 3), ``areas_um2`` of shape (cells,) or both, of apical faces, or with ``centroids_um``
        of shape (cells, 3), ``moments_um2`` of shape (cells, 6) or both, of whole cells: second moments about the centroid, divided by the
        volume, xx, yy, zz, xy, yz, xz. With a shape at 0, displacements, ratios of areas and changes of moments since then are
        compared, and share its noise; give it if the mesh is another one than that of the scenario.
    of : str or iterable of str
        Contractions or cortices (``"cortex.apical"``).
    noise_um : float
        Standard deviation of each coordinate of nodes, centres or centroids, in each shape, µm. Areas have sqrt(2 area) times that;
        moments that of cells whose sides are off independently.
    knots_min : iterable of float, optional
        Two or more times, minutes, at which factors differ; linear in between, constant before and after, independent a priori. By
        default factors are constant in time. Each knot adds one gradient per run.
    surface : {"apical", "basal", "all"}
        Nodes that are compared, for shapes of node positions.
    length_um : float, optional
        Distance over which log factors correlate a priori; by default two cells.
    spread : float, optional
        Prior standard deviation of log factors; by default that of largest evidence.
    most_runs : int
        Most recorded runs before the search ends.
    probes : int, optional
        Gradients for the curvature of the misfit, at the beginning of each stage of the search and at its end: relative error of a
        variance about 1 / sqrt(3 probes). By default 6, and at the end, for up to 200 factors, one run per factor instead, which gives
        `Inference.sd` and `Inference.unseen` without the approximation that narrows intervals by 10 %, and more for unseen cells.
    drift : str
        Axes along which each shape may have moved as a whole, as the stage of a microscope does: ``"xy"`` or ``"xyz"``, for
        example. Movements that are common to all cells are then not compared. Give it for movies: how the whole moves depends on
        the outline of the tissue, which is segmented worst.
    file : str or path, optional
        File (``.npz``) of the search, written after each iteration; if it exists, the search continues from it.
    progress : bool
        Show a line per iteration on stderr.
    threads : int
        Threads per step.

    Returns
    -------
    Inference

    Raises
    ------
    ValueError
        If a shape does not match the tissue, a law is unknown or has no strengths, or a law has no derivatives (see `record`).
    NumericsError
        If the scenario itself cannot be run.

    Warns
    -----
    UserWarning
        If residuals exceed the noise (`Inference.has_model_error`).

    Notes
    -----
    Maximum of the posterior for Gaussian noise and a Gaussian prior of log factors, by L-BFGS; for more than 200 factors by Gauss-Newton
    steps, each for a few runs' time on top of the recorded one. Intervals by Laplace's approximation. A run that fails shortens a step. Shapes after a furrow closes are compared last, since earlier ones guide to them.

    Examples
    --------
    >>> import numpy as np, plica
    >>> block = plica.Scenario({"embryo": {"shape": "block", "length_um": 30, "width_um": 30, "cell_height_um": 10, "cells": [3, 3, 1]},
    ...     "cortex": {"apical": {"region": "all", "tension_mN_per_m": 1}}, "time": {"end_s": 60}, "stop": {"at_equilibrium": False}})
    >>> truth = np.array([0.8, 1, 1.2, 1, 1.3, 1, 0.7, 1, 1])
    >>> shape = plica.record(block, strengths={"cortex.apical": truth}).positions()
    >>> found = plica.infer(block, {1: shape}, of="cortex.apical", noise_um=0.01)
    >>> bool(np.abs(found.factors["cortex.apical"] - truth / truth.mean()).max() < 0.05)
    True
    """
    own = scenario.copy() if isinstance(scenario, Scenario) else Scenario(scenario)
    noise = number_from(noise_um, 0, "noise_um", "a number above 0, in µm", above=True)
    for value, name in ((length_um, "length_um"), (spread, "spread")):
        if value is not None:
            number_from(value, 0, name, "a number above 0", above=True)
    if own.to_dict()["embryo"].get("mirror"):
        raise ValueError("scenario: embryo.mirror makes cells of both sides equal, and their factors may differ; remove it")
    simulation = Simulation(own, threads=threads)
    laws = [simulation._label(law) for law in texts_of(of, "of")]
    for law in laws:
        if law.startswith("growth."):
            raise ValueError(f"of: {law} grows at an absolute rate, and shapes are explained by ratios of forces; give contractions or cortices")
    if not laws or len(set(laws)) < len(laws):
        raise ValueError(f"of: {told(of)}; give one contraction or cortex, or several different ones")
    if knots_min is not None:
        knots = times_of(knots_min)
        laws = [part for law in laws for part in divided(own, law, knots)]
        simulation = Simulation(own, threads=threads)
    axes = text_of(drift, "drift")
    if sorted(axes) != sorted({*axes} & {*"xyz"}):
        raise ValueError(f"drift: {told(axes)}; give axes, such as \"xy\", each once")
    times_min, residuals = _residuals(own, simulation, shapes, surface, noise, ["xyz".index(axis) for axis in axes])
    problem = Problem(own, [Field(simulation, law, length_um) for law in laws], times_min, residuals, whole(threads, "threads", 1, 1024))
    search = Search(problem, spread, None if probes is None else whole(probes, "probes", 1))
    keep = None if file is None else _Kept(path_of(file, "file"), search)
    limit = whole(most_runs, "most_runs", 1)

    def after_step() -> None:
        if keep is not None:
            keep.write()
        if progress:
            _tell(search)

    search.fit(limit, after_step)
    found = _result(search)
    if found.has_model_error:
        worst = int(np.argmax(found.misfit))
        warnings.warn(f"infer: residuals are {found.misfit[worst]:.2f} times the noise at {found.times_min[worst]:g} min, more than chance "
                      "explains; the model differs from the tissue (moduli, drag, mesh, time courses), or noise_um is too small"
                      + ("" if found.converged else "; the search did not converge: set a larger most_runs first"), stacklevel=2)
    return found


def _residuals(scenario: Scenario, simulation: Simulation, shapes: Any, surface: str, noise_um: float,
               drift: list[int]) -> tuple[list[float], Residuals]:
    if not isinstance(shapes, Mapping) or not shapes:
        given = "is empty" if isinstance(shapes, Mapping) else told(shapes)
        raise TypeError(f"shapes: {given}; give a mapping of times in minutes to shapes")
    nodes, cells = len(simulation.positions), len(simulation.pressures)
    start = record(scenario, until_min=1e-6)
    faces, whole = ApicalFaces(simulation, start._core.surface_nodes("apical"), cells), WholeCells(simulation, cells)
    compared = np.arange(nodes) if surface == "all" else start._core.surface_nodes(text_of(surface, "surface"))
    by_time = {number_from(time, 0, "shapes", "times in minutes"): shape for time, shape in shapes.items()}
    times_min = sorted(time for time in by_time if time > 0)
    if not times_min:
        raise ValueError("shapes: has no time after 0; give the shape at a later time")
    if 60 * times_min[-1] > simulation._core.end_s:
        raise ValueError(f"shapes: {times_min[-1]:g} min is after the end of the run, {simulation._core.end_s / 60:g} min; set a later "
                         "time.end_min, or leave this shape out")
    targets = [target_of(by_time[time], f"shapes[{time:g}]", faces, whole, nodes, compared, noise_um) for time in times_min]
    first = None
    if 0 in by_time:
        first = target_of(by_time[0], "shapes[0]", faces, whole, nodes, compared, noise_um)
        for time, target in zip(times_min, targets):
            if isinstance(first, NodeTarget) and isinstance(target, NodeTarget):
                target.compare_changes_since(first, simulation.positions)
            elif isinstance(first, CellTarget) and isinstance(target, CellTarget) and first.measures is target.measures:
                target.compare_changes_since(first, simulation.positions)
            else:
                raise ValueError(f"shapes: that at 0 and that at {time:g} min are of different kinds; give both as nodes, both as apical "
                                 "faces, or both as whole cells")
    size = float(np.ptp(simulation.positions, axis=0).max())
    for time, target in zip(times_min, targets):
        apart = target.distance_um(simulation.positions)
        if apart > size:
            raise ValueError(f"shapes[{time:g}]: lies {apart:.3g} µm from the tissue of the scenario, which is {size:.3g} µm long; give "
                             "it in µm and in the axes of the scenario")
    return times_min, Residuals(targets, first, drift)


class _Kept:
    """File of a search that a later session continues."""

    def __init__(self, path: str, search: Search) -> None:
        self.path, self.search = Path(path), search
        problem = search.problem
        told_apart = hashlib.sha256(problem.scenario.to_toml().encode())
        laws = [(field.law, field.length_um) for field in problem.fields]
        for part in (*laws, *problem.times_min, search.given_spread, problem.residuals.drift):
            told_apart.update(repr(part).encode())
        for target in problem.residuals.targets:
            told_apart.update(target.given().tobytes())
        self.problem = told_apart.hexdigest()
        if self.path.exists():
            self._read()

    def _read(self) -> None:
        try:
            with np.load(self.path) as stored:
                state = {name: stored[name] for name in ("problem", *self.search.state())}
        except (OSError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
            raise FileError(f"{self.path}: is damaged, or not of a search by plica.infer; choose another file ({error})") from error
        if str(state["problem"]) != self.problem:
            raise ValueError(f"file: {self.path} is of a search with another scenario, other shapes or settings; choose another file")
        self.search.restore(state)

    def write(self) -> None:
        part = self.path.with_name(self.path.name + ".part")
        try:
            with open(part, "wb") as stream:
                np.savez(stream, problem=self.problem, **self.search.state())
            os.replace(part, self.path)
        except OSError as error:
            raise FileError(f"{self.path}: cannot be written: {error.strerror}") from error


def _tell(search: Search) -> None:
    times = search.problem.times_min[: search.times]
    misfits = np.sqrt(search.misfits / search.problem.counts(search.times))
    sys.stderr.write(f"run {search.problem.runs}: misfit / noise "
                     + ", ".join(f"{misfit:.2f} at {time:g} min" for misfit, time in zip(misfits, times)) + "\n")


def _result(search: Search) -> Inference:
    problem = search.problem
    logs = problem.logs(search.v)
    factors = np.exp(np.concatenate(logs))
    scale = float(factors.mean())
    covariance, prior = _variances(search, factors / factors.sum())
    counts = problem.counts(search.times)

    def by_law(values: Array) -> dict[str, Array]:
        found: dict[str, Array] = {}
        for field, part in zip(problem.fields, problem.by_law(values)):
            found[field.law] = np.full(field.cells, np.nan)
            found[field.law][field.acting] = part
        return found

    return Inference(
        scenario=problem.scenario.copy(), factors=by_law(factors / scale), sd=by_law(np.sqrt(covariance)), unseen=by_law(np.minimum(covariance / prior, 1)), scale=scale,
        times_min=np.array(problem.times_min[: search.times]), misfit=np.sqrt(search.misfits / counts), excess=search.weight**-0.5,
        spread={field.law: float(one) for field, one in zip(problem.fields, search.spreads)},
        length_um={field.law: field.length_um for field in problem.fields}, runs=problem.runs, converged=search.converged,
        has_model_error=search.is_missed)


def _variances(search: Search, parts: Array) -> tuple[Array, Array]:
    """Return posterior and prior variances of the logarithm of each factor over the mean factor; `parts` are factors, of sum 1."""
    size, first = len(parts), 0
    prior, precision = np.zeros((2, size, size))
    for field, of_law in zip(search.problem.fields, search.problem.by_law(search.precision)):
        law = slice(first, first := first + len(field.acting))
        prior[law, law] = (field.vectors / of_law) @ field.vectors.T
        precision[law, law] = (field.vectors * of_law) @ field.vectors.T
    for part, curvature in search.curvatures():
        precision[part, part] += search.weight * curvature
    posterior = np.linalg.inv(precision)
    found = [np.diag(one) - 2 * one @ parts + parts @ one @ parts for one in (posterior, prior)]
    return found[0], found[1]
