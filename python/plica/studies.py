"""Comparison of runs, rendering, and calibration."""
from __future__ import annotations

import ctypes
import inspect
import os
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .errors import PlicaError, needed
from .results import Frame, Run, _pandas, open_run
from .scenario import Scenario
from .simulation import Simulation

if TYPE_CHECKING:
    import pandas

__all__ = ["Comparison", "Calibration", "Trial", "compare", "render", "calibrate"]

PathOrRun = Union[Run, str, "os.PathLike[str]"]


class Distances(NamedTuple):
    """Distances: mean, root mean square and maximum; µm."""

    mean_um: float
    rms_um: float
    max_um: float


def _distances(lengths: NDArray[np.float64]) -> Distances:
    return Distances(float(lengths.mean()), float(np.sqrt((lengths**2).mean())), float(lengths.max()))


def _surface(grid: Any) -> Any:
    # Newer versions require an algorithm; older ones have only one.
    known = inspect.signature(grid.extract_surface).parameters
    return grid.extract_surface(algorithm="dataset_surface") if "algorithm" in known else grid.extract_surface()


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
        self.frame_a: Frame = a.frames[-1] if time_min is None else a.frames.at(time_min)
        self.frame_b: Frame = b.frames[-1] if time_min is None else b.frames.at(time_min)

    @property
    def scenario(self) -> dict[str, tuple[Any, Any]]:
        """Keys in which the scenarios differ, with both values (a, b)."""
        return self.a.scenario.diff(self.b.scenario)

    @property
    def summary(self) -> pandas.DataFrame:
        """Values of both summaries, one row per value; columns a, b and difference (a - b)."""
        first, second = self.a.summary, self.b.summary

        def numbers(summary: Mapping[str, Any]) -> dict[str, float]:
            return {k: float(v) for k, v in summary.items() if isinstance(v, (int, float)) and not isinstance(v, bool)}

        table: pandas.DataFrame = _pandas("summary").DataFrame({"a": numbers(first), "b": numbers(second)})
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
        first = _surface(self.frame_a.to_pyvista())
        second = _surface(self.frame_b.to_pyvista()).triangulate()
        return _distances(np.abs(np.asarray(first.compute_implicit_distance(second)["implicit_distance"])))

    def __repr__(self) -> str:
        apart = self.nodes
        told = "" if apart is None else f", nodes up to {apart.max_um:.3g} µm apart"
        return f"Comparison({self.a.directory.name} and {self.b.directory.name}, {len(self.scenario)} keys differ{told})"


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
    """
    return Comparison(_run_of(a), _run_of(b), time_min)


def _run_of(run: PathOrRun) -> Run:
    return run if isinstance(run, Run) else open_run(run)


def render(
    what: Union[PathOrRun, Frame, Simulation],
    path: Optional[Union[str, os.PathLike[str]]] = None,
    *,
    color: str = "displacement",
    view: Optional[str] = None,
    time_min: Optional[float] = None,
    size: tuple[int, int] = (1000, 700),
    limits: Optional[tuple[float, float]] = None,
    bar: bool = True,
) -> Any:
    """Draw an embryo, off screen. Requires PyVista.

    Parameters
    ----------
    what : Run, path, Frame or Simulation
        Source of the mesh.
    path : str or path, optional
        PNG file to write.
    color : str
        Quantity that colours the cells: displacement, speed, area-ratio, pressure, volume-error, volume, contraction,
        strength, generation, region or self-intersections. Also an array of the cells, such as gene expression, for a
        snapshot, and a name in ``Simulation.cell_data`` for a simulation.
    view : str, optional
        antero-ventral, ventral, side, cross-section, sagittal-section or apical (apical surface from outside). By default
        antero-ventral, for an open sheet apical.
    time_min : float, optional
        Time of the snapshot of a run, minutes; by default the last.
    size : (int, int)
        Width and height, pixels.
    limits : (float, float), optional
        Values at the ends of the colour scale, to compare pictures; by default from the data.
    bar : bool
        Whether to draw the colour bar.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        RGB image.

    Raises
    ------
    ValueError
        If the colour or view is unknown.
    PlicaError
        If neither a display nor off-screen OpenGL is available.
    """
    pyvista = needed("pyvista", "render")
    _make_sure_of_drawing()
    fields = _core.colour_fields()
    if isinstance(what, Simulation):
        grid = what.to_pyvista()
        grid.point_data["displacement_um"] = what.positions - what.rest_positions
        grid.point_data["velocity_um_per_s"] = what.velocities
        for region, cells in what.regions.items():
            grid.cell_data[f"region_{region}"] = cells[what.hexahedron_cell]
    else:
        frame = what if isinstance(what, Frame) else _frame_of(what, time_min)
        grid = frame.to_pyvista()
    # Arrays from a file are drawn as numbers from 0.
    given = {k: {**fields["volume"], "label": k, "array": k} for k in grid.cell_data.keys() if not k.startswith("region_")}
    field = _named("color", color, {**given, **fields})
    views = _core.views(np.asarray(grid.points, dtype=float), grid.cells_dict[pyvista.CellType.HEXAHEDRON].astype(np.int32))
    seen = _named("view", view or next(iter(views)), views)
    values, names = _values(grid, field)
    data = grid.point_data if field["on_nodes"] else grid.cell_data
    data["colour"] = values
    sight, up = np.array(seen["sight"], dtype=float), seen["up"]
    if seen["cut_axis"] is not None:  # remove the part in front of the plane
        origin = np.zeros(3)
        origin[seen["cut_axis"]] = seen["cut_um"]
        grid = grid.clip(normal=-sight, origin=origin)
    low, high = limits or _core.colour_range(color, float(np.nanmin(values)), float(np.nanmax(values)))
    if not low < high:
        raise ValueError(f"limits {limits!r}: give two numbers, the lower one first")
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size))
    plotter.background_color = "white"
    steps = field["kind"] == "steps"
    colours = _colours(field["colours"][: max(2, len(names))] if names else field["colours"], steps)
    legend: dict[str, Any] = {"title": field["label"] + "\n", "color": "black", "position_x": 0.2, "position_y": 0.08}
    options: dict[str, Any] = {"scalar_bar_args": legend, "show_scalar_bar": bar}
    if names:
        options["annotations"] = dict(enumerate(names))
        legend["n_labels"] = 0
        low, high = -0.5, max(2, len(names)) - 0.5
    plotter.add_mesh(_surface(grid), scalars="colour", cmap=colours, clim=(low, high), show_edges=True,
                     edge_color="#404040", line_width=0.5, **options)
    plotter.enable_parallel_projection()
    plotter.camera_position = [tuple(-1000 * sight / np.linalg.norm(sight)), (0.0, 0.0, 0.0), up]
    plotter.reset_camera()
    picture = plotter.screenshot(None if path is None else os.fspath(path), return_img=True)
    plotter.close()
    return picture


def _named(what: str, name: str, known: Mapping[str, Any]) -> Any:
    if name not in known:
        raise ValueError(f"{what} {name!r}: unknown; use one of: {', '.join(known)}")
    return known[name]


def _make_sure_of_drawing() -> None:
    """Check for OpenGL, because VTK would end the process without it. PlicaError if there is none."""
    if os.environ.get("DISPLAY"):
        return
    for library in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so"):
        try:
            ctypes.CDLL(library)
            return
        except OSError:
            pass
    raise PlicaError("render requires OpenGL, but there is neither a display nor libEGL; on Debian: apt-get install libegl1")


def _frame_of(run: PathOrRun, time_min: Optional[float]) -> Frame:
    frames = _run_of(run).frames
    return frames[-1] if time_min is None else frames.at(time_min)


def _values(grid: Any, field: Mapping[str, Any]) -> tuple[NDArray[np.float64], list[str]]:
    """Return the values that colour the mesh and, for whole numbers, their labels."""
    if field["array"] == "region":
        masks = {k.removeprefix("region_"): np.asarray(v) > 0 for k, v in grid.cell_data.items() if k.startswith("region_")}
        parts = sorted((name for name, mask in masks.items() if not mask.all()))
        values = np.zeros(grid.n_cells)
        # The smallest region of a cell is drawn last.
        for name in sorted(parts, key=lambda one: -int(masks[one].sum())):
            values[masks[name]] = parts.index(name) + 1
        return values, ["other cells", *parts]
    data = grid.point_data if field["on_nodes"] else grid.cell_data
    if field["array"] not in data:
        raise ValueError(f"no array {field['array']}; arrays: {', '.join(data.keys())}")
    values = np.asarray(data[field["array"]], dtype=float)
    return (np.linalg.norm(values, axis=1) if values.ndim == 2 else values), []


def _colours(colours: list[tuple[float, float, float]], of_steps: bool) -> Any:
    maps = needed("matplotlib.colors", "render")
    return maps.ListedColormap(colours) if of_steps else maps.LinearSegmentedColormap.from_list("plica", colours)


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


def calibrate(
    scenario: Union[Scenario, str],
    vary: Mapping[str, tuple[float, float]],
    targets: Mapping[str, tuple[float, float]],
    *,
    most_trials: int = 40,
    callback: Optional[Callable[[Trial], object]] = None,
) -> Calibration:
    """Fit keys of a scenario so that results meet targets, as ``plica calibrate`` does.

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
    base = scenario if isinstance(scenario, Scenario) else Scenario(scenario)
    if base.tissue is not None or base._regions:
        raise ValueError("calibrate requires a scenario that a file can express: no tissue and no regions given as arrays")
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
        {key: (float(low), float(high)) for key, (low, high) in vary.items()},
        {name: (float(value), float(within)) for name, (value, within) in targets.items()},
        int(most_trials),
        take,
    )
    best = None if result["best"] is None else trial_of(result["best"])
    found = None
    if best is not None:
        found = base.copy()
        found.update(best.values)
    return Calibration(result["end"], best, trials, found)
