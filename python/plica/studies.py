"""Comparison of runs, and calibration."""
from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .arguments import callable_of, number, pairs_of, whole
from .errors import FileError
from .names import in_columns
from .results import Frame, Run, _pandas, open_run
from .scenario import Scenario
from .scene import surface_of

if TYPE_CHECKING:
    import pandas

__all__ = ["Comparison", "Calibration", "Trial", "compare", "calibrate"]

COSTS = ("wall_", "peak_memory", "newton_", "linear_")  # numbers of the computation rather than of the tissue
MOST_SHOWN = 12

PathOrRun = Union[Run, str, "os.PathLike[str]"]


class Distances(NamedTuple):
    """Distances: mean, root mean square and maximum; µm."""

    mean_um: float
    rms_um: float
    max_um: float


def _distances(lengths: NDArray[np.float64]) -> Distances:
    return Distances(float(lengths.mean()), float(np.sqrt((lengths**2).mean())), float(lengths.max()))


class Comparison:
    """Comparison of two runs at two snapshots; created by `compare`.

    Attributes
    ----------
    a, b : Run
        The two runs.
    frame_a, frame_b : Frame
        The compared snapshots.
    """

    def __init__(self, a: Run, b: Run, time_min: Optional[float]) -> None:
        self.a, self.b = a, b
        for run in (a, b):
            if not run.frames:
                raise FileError(f"{run.directory}: the run has no frames")
        self.frame_a: Frame = a.frames[-1] if time_min is None else a.frames.at(time_min)
        self.frame_b: Frame = b.frames[-1] if time_min is None else b.frames.at(time_min)

    @property
    def scenario(self) -> dict[str, tuple[Any, Any]]:
        """Keys in which the scenarios differ, with both values (a, b)."""
        return self.a.scenario.diff(self.b.scenario)

    @property
    def summary(self) -> pandas.DataFrame:
        """Values of both summaries, one row per value; columns a, b and difference (a - b)."""
        table: pandas.DataFrame = _pandas("summary").DataFrame({"a": _numbers(self.a.summary), "b": _numbers(self.b.summary)})
        table["difference"] = table["a"] - table["b"]
        return table

    @property
    def nodes(self) -> Optional[Distances]:
        """Distances between nodes with equal number; None if the meshes differ."""
        if not np.array_equal(self.frame_a.hexahedra, self.frame_b.hexahedra):
            return None
        return _distances(np.linalg.norm(self.frame_a.points - self.frame_b.points, axis=1))

    @cached_property
    def surface(self) -> Distances:
        """Distances of the surface nodes of a from the surface of b. Requires PyVista."""
        first = surface_of(self.frame_a.to_pyvista())
        second = surface_of(self.frame_b.to_pyvista()).triangulate()
        return _distances(np.abs(np.asarray(first.compute_implicit_distance(second)["implicit_distance"])))

    def __repr__(self) -> str:
        apart = self.nodes
        told = "" if apart is None else f", nodes up to {apart.max_um:.3g} µm apart"
        return f"Comparison({self.a.directory.name} and {self.b.directory.name}, {len(self.scenario)} keys differ{told})"

    def __str__(self) -> str:
        """Keys and results that differ, the largest relative differences first."""
        lines = [repr(self), *in_columns([(key, *map(_short, values)) for key, values in self.scenario.items()], ("key", "a", "b"))]
        first, second = _numbers(self.a.summary), _numbers(self.b.summary)
        apart = {name: first[name] - second[name] for name in first if name in second and not name.startswith(COSTS)}
        apart = {name: difference for name, difference in apart.items() if difference != 0}
        order = sorted(apart, key=lambda name: -abs(apart[name]) / max(abs(first[name]), abs(second[name])))
        rows = [(name, *map(_short, (first[name], second[name], apart[name]))) for name in order[:MOST_SHOWN]]
        lines += in_columns(rows, ("result", "a", "b", "difference"))
        if len(order) > MOST_SHOWN:
            lines.append(f"and {len(order) - MOST_SHOWN} more: see .summary")
        return "\n".join(lines)


def _numbers(summary: Mapping[str, Any]) -> dict[str, float]:
    return {k: float(v) for k, v in summary.items() if isinstance(v, (int, float)) and not isinstance(v, bool)}


def _short(value: Any) -> str:
    text = "none" if value is None else f"{value:.5g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."


def compare(a: PathOrRun, b: PathOrRun, *, time_min: Optional[float] = None) -> Comparison:
    """Compare two runs.

    Parameters
    ----------
    a, b : Run or path
        Runs or their directories.
    time_min : float, optional
        Time of the compared snapshots, minutes; by default the last ones.

    Returns
    -------
    Comparison
        ``print`` shows what differs.
    """
    when = None if time_min is None else number(time_min, "time_min")
    first, second = (run if isinstance(run, Run) else open_run(run) for run in (a, b))
    return Comparison(first, second, when)


class Trial(NamedTuple):
    """One run of a calibration.

    Attributes
    ----------
    number : int
        Number of the run, from 1.
    values : dict of str to float
        Values of the keys.
    found : dict of str to float or None
        Values of the targets in this run.
    failure : str
        Reason for a missing value; empty if there is none.
    worst_miss : float
        Largest deviation from a target, divided by its tolerance; met if <= 1.
    """

    number: int
    values: dict[str, float]
    found: dict[str, Optional[float]]
    failure: str
    worst_miss: float


class Calibration(NamedTuple):
    """Result of a calibration.

    Attributes
    ----------
    end : str
        "met", "not_met" (local minimum above the tolerances), or "trials_spent".
    best : Trial or None
        Trial with the smallest misfit.
    trials : list of Trial
        All trials in order.
    scenario : Scenario or None
        Scenario of the best trial.
    """

    end: str
    best: Optional[Trial]
    trials: list[Trial]
    scenario: Optional[Scenario]

    def __repr__(self) -> str:
        best = "none" if self.best is None else ", ".join(f"{key} = {value:.6g}" for key, value in self.best.values.items())
        found = {} if self.best is None else self.best.found
        told = ", ".join(f"{name} = {'none' if value is None else f'{value:.6g}'}" for name, value in found.items())
        return f"Calibration({self.end} in {len(self.trials)} trials; best: {best}{'; ' if told else ''}{told})"


def calibrate(
    scenario: Union[Scenario, str],
    vary: Mapping[str, tuple[float, float]],
    targets: Mapping[str, tuple[float, float]],
    *,
    most_trials: int = 40,
    callback: Optional[Callable[[Trial], object]] = None,
) -> Calibration:
    """Fit keys of a scenario so that results meet targets, as ``plica calibrate`` does.

    For measurements with errors, at several times and in several scenarios: `fit`.

    Parameters
    ----------
    scenario : Scenario, str, path or mapping
        The scenario or its source.
    vary : mapping of str to (float, float)
        Dotted keys, each with its bounds.
    targets : mapping of str to (float, float)
        Values of ``summary.json``, each with target and tolerance.
    most_trials : int
        Maximum number of runs.
    callback : callable, optional
        Called with each `Trial`.

    Returns
    -------
    Calibration

    Raises
    ------
    ValueError
        If a target is not in the summary.
    ScenarioError
        If a key is unknown, or its bounds are invalid.

    Examples
    --------
    >>> import plica
    >>> found = plica.calibrate("division-demo", {"elasticity.young_modulus_Pa": (500, 2000)}, {"steps": (50, 1000)})
    >>> found.end
    'met'
    """
    callable_of(callback, "callback")
    base = scenario if isinstance(scenario, Scenario) else Scenario(scenario)
    base._require_file("calibrate")
    if base["embryo.shape"] == "file" and not _core.reads_meshes:
        raise ValueError("calibrate cannot read embryo.file: this build has no VTK; build plica with VTK")
    trials: list[Trial] = []

    def trial_of(row: Mapping[str, Any]) -> Trial:
        return Trial(row["trial"], row["values"], row["found"], row["failure"], row["worst_miss"])

    def take(row: Mapping[str, Any], _best: bool) -> None:
        trials.append(trial_of(row))
        if callback is not None:
            callback(trials[-1])

    result = _core.calibrate(
        base._core,
        [f"{key}={value}" for key, value in base._changes.items()],
        pairs_of(vary, "vary", "(low, high)"),
        pairs_of(targets, "targets", "(value, tolerance)"),
        whole(most_trials, "most_trials"),
        take,
    )
    best = None if result["best"] is None else trial_of(result["best"])
    found = None
    if best is not None:
        found = base.copy()
        found.update(best.values)
    return Calibration(result["end"], best, trials, found)
