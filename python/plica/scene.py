"""Scenes of pictures: what is drawn at which time from where, at one scale, by PyVista."""
from __future__ import annotations

import ctypes
import inspect
import math
import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .arguments import path_of, text_of, told, whole
from .errors import FileError, PlicaError, needed
from .results import Frame, Run, open_run
from .scenario import Scenario
from .simulation import Simulation

Image = NDArray[np.uint8]
SMALLEST_PX, LARGEST_PX = 100, 6000
TELLING = 5  # times of a strip
LEGEND_PX = 90
MARGIN = 1.06  # around the tissue
HEADED = 1.08  # above it, for a heading


class PictureColumn(NamedTuple):
    """Tissue at one time: a column of a picture."""

    heading: str
    grid: Any


class PictureRow(NamedTuple):
    """View of a picture: a row."""

    sight: NDArray[np.float64]
    up: NDArray[np.float64]
    cut_axis: Optional[int]
    cut_um: float


class Source:
    """Run, snapshot or simulation as columns of a picture."""

    def __init__(self, what: Any) -> None:
        self.frames: Sequence[Frame] = ()
        self.times_s: list[float] = []
        self.scenario: Optional[Scenario] = None
        if isinstance(what, (Frame, Simulation)):
            self.single: Union[Frame, Simulation, None] = what
            if isinstance(what, Simulation):
                self.scenario, self.rest = what.scenario, what.rest_positions
            else:
                self.rest = what.points - what.point_data.get("displacement_um", np.zeros(3))
        else:
            run = what if isinstance(what, Run) else open_run(path_of(what, "what"))
            self.single, self.frames = None, run.frames
            if not self.frames:
                raise FileError(f"{run.directory}: the run has no frames")
            self.scenario, self.times_s = run.scenario, run.frames.times_s
            self.rest = self.frames[0].points

    def moment(self, index: int) -> PictureColumn:
        if isinstance(self.single, Simulation):
            return PictureColumn(_time(self.single.time_s, False), _grid_of(self.single))
        frame = self.single or self.frames[index]
        return PictureColumn(_time(frame.time_s, bool(self.times_s) and self.times_s[-1] < 90), frame.to_pyvista())

    def telling(self) -> list[int]:
        """Snapshots at which a node first reaches 0, 1/4, … 1 of the largest displacement of the run."""
        farthest = [float(np.linalg.norm(frame.point_data.get("displacement_um", np.zeros((1, 3))), axis=1).max())
                    for frame in self.frames]
        parts = np.linspace(0, 1, TELLING)
        if max(farthest) > 0:
            found = [next(i for i, um in enumerate(farthest) if um >= part * max(farthest)) for part in parts[:-1]]
        else:
            found = [int(round(part * (len(farthest) - 1))) for part in parts[:-1]]
        return sorted({*found, len(farthest) - 1})


def _grid_of(simulation: Simulation) -> Any:
    grid = simulation.to_pyvista()
    grid.point_data["displacement_um"] = simulation.positions - simulation.rest_positions
    grid.point_data["velocity_um_per_s"] = simulation.velocities
    for region, cells in simulation.regions.items():
        grid.cell_data[f"region_{region}"] = cells[simulation.hexahedron_cell]
    return grid


def _time(time_s: float, in_s: bool) -> str:
    return f"{time_s:.3g} s" if in_s else f"{time_s / 60:.3g} min"


class Scene:
    """What all pictures of a source share: rows, colours, scale and size."""

    def __init__(self, source: Source, color: Any, views: list[Optional[str]], places: list[float], sections: bool,
                 size: Any, edges: bool, shell: bool, bar: bool) -> None:
        self.pyvista = needed("pyvista", "render")
        _make_sure_of_drawing()
        self.color, self.edges, self.bar = text_of(color, "color"), bool(edges), bool(bar)
        self.rest = source.rest
        self.size = None if size is None else _size(size)
        self.shell: Any = _shell(self.pyvista, source) if shell else None
        first = source.moment(0).grid
        # Arrays from a file are drawn as numbers from 0.
        fields = _core.colour_fields()
        given = {k: {**fields["volume"], "label": k, "array": k} for k in first.cell_data.keys() if not k.startswith("region_")}
        self.field = _named("color", self.color, {**given, **fields})
        elements = first.cells_dict[self.pyvista.CellType.HEXAHEDRON].astype(np.int32)
        low, high = self.rest.min(axis=0), self.rest.max(axis=0)
        middle = (low + high) / 2
        self.middle = middle if np.linalg.norm(middle) > 0.25 * (high - low).max() else np.zeros(3)
        known = _core.views(np.ascontiguousarray(self.rest, dtype=float), elements)
        self.rows = [self._row(known, name or next(iter(known))) for name in views]
        if sections:
            places = [*places, *(low[0] + part * (high[0] - low[0]) for part in (0.25, 0.5, 0.75))]
        for x in places:
            if not low[0] < x < high[0]:
                raise ValueError(f"at_x_um: {x:g} is outside the tissue; give x from {low[0]:.4g} to {high[0]:.4g}")
            self.rows.append(self._row(known, "cross-section", x))

    def _row(self, known: Mapping[str, Any], name: str, at_x_um: Optional[float] = None) -> PictureRow:
        view = _named("view", name, known)
        sight, axis = np.array(view["sight"], dtype=float), view["cut_axis"]
        usual = 0.0 if axis is None else view["cut_um"] + self.middle[axis]
        return PictureRow(sight / np.linalg.norm(sight), np.array(view["up"], dtype=float), axis, usual if at_x_um is None else at_x_um)

    def range_over(self, source: Source) -> tuple[float, float]:
        """Return the ends of the colour scale for all snapshots."""
        ends = [_ends(_values(source.moment(i).grid, self.field)[0]) for i in range(len(source.frames))]
        return self._range(min(low for low, _ in ends), max(high for _, high in ends))

    def _range(self, low: float, high: float) -> tuple[float, float]:
        found: tuple[float, float] = _core.colour_range(self.color, low, high)
        return found

    def draw(self, columns: list[PictureColumn], limits: Optional[tuple[float, float]]) -> Image:
        names: list[str] = []
        ends: list[tuple[float, float]] = []
        for column in columns:
            values, names = _values(column.grid, self.field)
            ends.append(_ends(values))
            (column.grid.point_data if self.field["on_nodes"] else column.grid.cell_data)["colour"] = values
        low, high = limits or self._range(min(one[0] for one in ends), max(one[1] for one in ends))
        options = self._colours(names, low, high)
        half = [self._half_size(columns, row) for row in self.rows]
        width, height, um_per_px, heights = self._layout(half, len(columns))
        weights = [*heights, LEGEND_PX] if self.bar else heights
        plotter = self.pyvista.Plotter(off_screen=True, window_size=[width, height], shape=(len(weights), len(columns)),
                                       row_weights=weights, border=False,
                                       groups=[(len(weights) - 1, slice(None))] if self.bar and len(columns) > 1 else None)
        plotter.background_color = "white"
        actor = None
        for r, row in enumerate(self.rows):
            for c, column in enumerate(columns):
                plotter.subplot(r, c)
                actor = plotter.add_mesh(surface_of(self._cut(column.grid, row)), scalars="colour", show_scalar_bar=False,
                                         show_edges=self.edges, edge_color="#404040", line_width=0.5, **options)
                if self.shell is not None:
                    plotter.add_mesh(self._cut(self.shell, row), color="#808080", opacity=0.2)
                if r == 0:
                    plotter.add_text(column.heading, position="upper_edge", font_size=10, color="black")
                self._aim(plotter, row, um_per_px * heights[r])
        if self.bar:
            plotter.subplot(len(weights) - 1, 0)
            self._add_legend(plotter, actor, names, um_per_px)
        image = np.array(plotter.screenshot(None, return_img=True), dtype=np.uint8)
        plotter.close()
        return image

    def _colours(self, names: list[str], low: float, high: float) -> dict[str, Any]:
        colours = self.field["colours"][: max(2, len(names))] if names else self.field["colours"]
        if names:
            low, high = -0.5, max(2, len(names)) - 0.5
        options = {"cmap": _colour_map(colours, self.field["kind"] == "steps"), "clim": (low, high)}
        return {**options, "annotations": dict(enumerate(names))} if names else options

    def _half_size(self, columns: list[PictureColumn], row: PictureRow) -> tuple[float, float]:
        across, up = _axes(row)
        points = np.concatenate([column.grid.points for column in columns] + ([self.shell.points] if self.shell is not None else []))
        away = points - self.middle
        return float(np.abs(away @ across).max()), HEADED * float(np.abs(away @ up).max())

    def _layout(self, half: list[tuple[float, float]], columns: int) -> tuple[int, int, float, list[float]]:
        """Return width and height, µm per pixel, and the height of each row in pixels."""
        legend = LEGEND_PX if self.bar else 0
        if self.size is None:
            width = min(2400, max(1000, 400 * columns))
            um_per_px = 2 * MARGIN * max(w for w, _ in half) / (width / columns)
            tall = sum(2 * MARGIN * h for _, h in half) / um_per_px
            height = int(min(LARGEST_PX, max(400, tall + 30 * len(half)) + legend))
        else:
            width, height = self.size
        free = max(1, height - legend)
        um_per_px = 2 * MARGIN * max(max(w for w, _ in half) / (width / columns), sum(h for _, h in half) / free)
        total = sum(h for _, h in half)
        return width, height, um_per_px, [free * h / total for _, h in half]

    def _cut(self, grid: Any, row: PictureRow) -> Any:
        """Remove the part in front of the plane of a section."""
        if row.cut_axis is None:
            return grid
        origin = np.zeros(3)
        origin[row.cut_axis] = row.cut_um
        return grid.clip(normal=-row.sight, origin=origin)

    def _aim(self, plotter: Any, row: PictureRow, height_um: float) -> None:
        plotter.enable_parallel_projection()
        far = 4 * float(np.linalg.norm(self.rest.max(axis=0) - self.rest.min(axis=0))) + 100
        plotter.camera_position = [tuple(self.middle - far * row.sight), tuple(self.middle), tuple(row.up)]
        plotter.camera.parallel_scale = height_um / 2
        plotter.renderer.ResetCameraClippingRange()

    def _add_legend(self, plotter: Any, actor: Any, names: list[str], um_per_px: float) -> None:
        # Names stand below the bar.
        place = {"n_labels": 0, "position_y": 0.27, "height": 0.55} if names else {"position_y": 0.1, "height": 0.75}
        plotter.add_scalar_bar(self.field["label"] + "\n", mapper=actor.mapper, color="black", position_x=0.2, width=0.6,
                               title_font_size=16, label_font_size=14, **place)
        length = _round_length(120 * um_per_px)
        line = self.pyvista.Line((0, 0, 0), (length, 0, 0))
        plotter.add_mesh(line, color="black", line_width=3)
        plotter.enable_parallel_projection()
        half_width = um_per_px * plotter.window_size[0] / 2
        at = half_width - length - 12 * um_per_px  # the bar's left end, seen from the middle
        plotter.camera_position = [(-at, 0, 1000), (-at, 0, 0), (0, 1, 0)]
        plotter.camera.parallel_scale = um_per_px * LEGEND_PX / 2
        plotter.renderer.ResetCameraClippingRange()
        plotter.add_text(f"{length:g} µm", position=(plotter.window_size[0] - length / um_per_px - 12, LEGEND_PX / 2 + 6),
                         font_size=9, color="black")


def _size(size: Any) -> tuple[int, int]:
    try:
        width, height = size
    except (TypeError, ValueError):
        raise ValueError(f"size: {told(size)}; give (width, height) in pixels") from None
    return whole(width, "size", SMALLEST_PX, LARGEST_PX), whole(height, "size", SMALLEST_PX, LARGEST_PX)


def _axes(row: PictureRow) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    across: NDArray[np.float64] = np.asarray(np.cross(row.sight, row.up), dtype=np.float64)
    across /= np.linalg.norm(across)
    return across, np.asarray(np.cross(across, row.sight), dtype=np.float64)


def _round_length(value: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is not above a value."""
    ten = 10.0 ** math.floor(math.log10(value))
    return ten * max(one for one in (1, 2, 5) if one * ten <= value)


def _shell(pyvista: Any, source: Source) -> Any:
    if source.scenario is None:
        raise ValueError("shell: a snapshot has no scenario; give the run or the simulation")
    found = source.scenario._core.shell(np.ascontiguousarray(source.rest, dtype=float))
    if found is None:
        raise ValueError("shell: the scenario has no vitelline membrane that can be drawn; leave shell out")
    half_axis, radius = found
    sphere = pyvista.Sphere(radius=radius, direction=(1, 0, 0), theta_resolution=60, phi_resolution=60)
    sphere.points = np.asarray(sphere.points, dtype=float) + np.sign(np.round(sphere.points[:, :1], 3)) * [half_axis, 0, 0]
    return sphere


def surface_of(grid: Any) -> Any:
    # Newer versions require an algorithm; older ones have only one.
    known = inspect.signature(grid.extract_surface).parameters
    return grid.extract_surface(algorithm="dataset_surface") if "algorithm" in known else grid.extract_surface()


def _named(what: str, name: str, known: Mapping[str, Any]) -> Any:
    if name not in known:
        raise ValueError(f"{what} {name!r}: unknown; use one of: {', '.join(known)}")
    return known[name]


def _make_sure_of_drawing() -> None:
    """Check for OpenGL, because VTK would end the process without it. PlicaError if there is none."""
    if os.environ.get("DISPLAY"):
        return
    for library, window in (("libEGL.so.1", "EGL"), ("libOSMesa.so.8", "OSOpenGL"), ("libOSMesa.so", "OSOpenGL")):
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        # Otherwise VTK tries the display first, and warns.
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", f"vtk{window}RenderWindow")
        return
    raise PlicaError("render requires OpenGL, but there is neither a display nor libEGL; on Debian: apt-get install libegl1")


def _ends(values: NDArray[np.float64]) -> tuple[float, float]:
    return float(np.nanmin(values)), float(np.nanmax(values))


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


def _colour_map(colours: list[tuple[float, float, float]], of_steps: bool) -> Any:
    maps = needed("matplotlib.colors", "render")
    return maps.ListedColormap(colours) if of_steps else maps.LinearSegmentedColormap.from_list("plica", colours)
