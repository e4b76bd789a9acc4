"""Results of a run, read from its directory."""
from __future__ import annotations

import fcntl
import base64
import html
import json
import math
import os
import xml.etree.ElementTree as xml
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union, overload

import numpy as np
from numpy.typing import NDArray

from .arguments import number, path_of, texts_of, three, told, voxel_spacing, whole
from .errors import FileError, needed
from .frame_labels import LabelVolume, voxels_of
from .names import label
from .polygons import Polygons
from .scenario import Scenario

if TYPE_CHECKING:
    import pandas

__all__ = ["Run", "Frame", "Frames", "open_run"]

LARGEST_SIDE = 100_000  # of a volume of labels, voxels


def _pandas(what: str) -> Any:
    return needed("pandas", what)


def _grid(points: NDArray[Any], hexahedra: NDArray[Any], point_data: dict[str, Any], cell_data: dict[str, Any]) -> Any:
    pyvista = needed("pyvista", "a mesh for PyVista")
    cells = np.column_stack([np.full(len(hexahedra), 8), hexahedra]).ravel()
    grid = pyvista.UnstructuredGrid(cells, np.full(len(hexahedra), pyvista.CellType.HEXAHEDRON), np.array(points))
    for name, values in point_data.items():
        grid.point_data[name] = values
    for name, values in cell_data.items():
        grid.cell_data[name] = values
    return grid


class Frame:
    """Snapshot of a run, read from one of its ``.vtu`` files.

    Attributes
    ----------
    path : Path
    time_s : float
        Simulated time, s.
    points : ndarray of float, shape (nodes, 3)
        Node positions, µm.
    hexahedra : ndarray of int, shape (elements, 8)
        Node indices of the elements in VTK order, the last four apical.
    point_data, cell_data, field_data : dict of str to ndarray
        Arrays per node, per element and for the whole file; units in the names.
    """

    def __init__(self, path: Path, time_s: float) -> None:
        self.path, self.time_s = path, time_s
        arrays = _read_vtu(path)
        self.points: NDArray[np.float64] = next(iter(arrays["Points"].values()))
        cells = arrays["Cells"]
        self.hexahedra: NDArray[np.int64] = cells["connectivity"].reshape(-1, 8)
        self.point_data: dict[str, NDArray[Any]] = arrays["PointData"]
        self.cell_data: dict[str, NDArray[Any]] = arrays["CellData"]
        self.field_data: dict[str, NDArray[Any]] = arrays["FieldData"]

    @property
    def time_min(self) -> float:
        """Simulated time, minutes."""
        return self.time_s / 60

    def to_pyvista(self) -> Any:
        """Return the snapshot as a ``pyvista.UnstructuredGrid``."""
        return _grid(self.points, self.hexahedra, self.point_data, self.cell_data)

    def polygons(self, side: str = "apical") -> Polygons:
        """Return the cells as polygons, with the arrays of the cells.

        Parameters
        ----------
        side : str
            "apical" or "basal".

        Returns
        -------
        Polygons

        Raises
        ------
        ValueError
            If `side` is neither "apical" nor "basal".
        FileError
            If an older version of plica wrote the file without polygons.
        """
        if not isinstance(side, str) or side not in ("apical", "basal"):
            raise ValueError(f'side: {told(side)}; give "apical" or "basal"')
        count = len(self.hexahedra)
        if "polygon_ends" in self.field_data:
            nodes, ends = self.field_data[f"polygon_{side}"], self.field_data["polygon_ends"]
            elements = self.field_data["polygon_elements"]
        elif len(np.unique(self.cell_data["cell_id"])) == count:  # every cell is one element
            nodes, ends = self.hexahedra[:, 4:] if side == "apical" else self.hexahedra[:, :4], 4 * np.arange(1, count + 1)
            elements = np.arange(count)
        else:
            raise FileError(f"{self.path}: has no cell polygons (written by an older version of plica); repeat the run")
        used, corners = np.unique(nodes.ravel(), return_inverse=True)
        values = {name: array[elements] for name, array in self.cell_data.items()}
        return Polygons(self.points[used], np.split(corners, ends[:-1]), values)

    def labels(self, spacing_um: Sequence[float], *, shape: Optional[Sequence[int]] = None, origin_um: Optional[Sequence[float]] = None) -> LabelVolume:
        """Return the cells as a volume of labels.

        Parameters
        ----------
        spacing_um : (float, float, float)
            Distances of planes (z), rows (y) and columns (x), µm.
        shape : (int, int, int), optional
            Planes, rows and columns; by default as many as the cells need. Cells outside are cut.
        origin_um : (float, float, float), optional
            Centre of the first voxel, z, y, x; by default 0 if ``shape`` is given, as in `plica.tissue_of_labels`, else below all cells.

        Returns
        -------
        LabelVolume
            ``labels``, ``origin_um`` and ``spacing_um``. A cell has its ``label``, or where cells have no such array or daughters share
            one, its ``cell_id`` + 1.

        Raises
        ------
        ValueError
            If a spacing is not above 0, or an argument has not three numbers.
        """
        spacing = voxel_spacing(spacing_um)
        low, high = self.points.min(axis=0)[::-1], self.points.max(axis=0)[::-1]
        usual = np.zeros(3) if shape is not None else low - spacing
        origin = usual if origin_um is None else three(origin_um, "origin_um", "three numbers: z, y, x of the first voxel, in µm")
        size = np.maximum(np.ceil((high - origin) / spacing) + 2, 1)
        if shape is not None:
            size = three(shape, "shape", "three whole numbers: planes, rows, columns")
        planes, rows, columns = (whole(int(one), "shape", 1, LARGEST_SIDE) for one in size)
        identity = self.cell_data["cell_id"].astype(np.int64)
        given = self.cell_data.get("label")
        names = identity + 1
        if given is not None and (given >= 1).all() and len(np.unique(given)) == len(np.unique(identity)):
            names = given.astype(np.int64)
        volume = voxels_of(self.points, self.hexahedra, names, spacing, origin, (planes, rows, columns))
        return LabelVolume(volume, (origin[0], origin[1], origin[2]), (spacing[0], spacing[1], spacing[2]))

    def to_meshio(self) -> Any:
        """Return the snapshot as a ``meshio.Mesh``."""
        meshio = needed("meshio", "a mesh for meshio")
        cell_data = {name: [values] for name, values in self.cell_data.items()}
        return meshio.Mesh(self.points, [("hexahedron", self.hexahedra)], point_data=self.point_data, cell_data=cell_data)

    def __repr__(self) -> str:
        return f"Frame(at {self.time_min:.4g} min, {len(self.hexahedra)} elements)"


class Frames(Sequence[Frame]):
    """Snapshots of a run in order of time; each is read from its file on access."""

    def __init__(self, directory: Path) -> None:
        listing = directory / "frames.pvd"
        try:
            root = xml.parse(listing).getroot()
            self._files = [
                (float(one.attrib["timestep"]), directory / one.attrib["file"]) for one in root.iter("DataSet")
            ]
        except FileNotFoundError:
            self._files = []
        except (OSError, ValueError, KeyError, xml.ParseError) as error:
            raise FileError(f"{listing}: cannot be read: {error}") from error

    @property
    def times_s(self) -> list[float]:
        """Times of the snapshots, s."""
        return [time_s for time_s, _ in self._files]

    def at(self, time_min: float) -> Frame:
        """Return the snapshot nearest to a time in minutes. FileError if the run has none."""
        time_min = number(time_min, "time_min")
        if not self._files:
            raise FileError("the run has no frames")
        return self[min(range(len(self)), key=lambda i: abs(self._files[i][0] - 60 * time_min))]

    def __len__(self) -> int:
        return len(self._files)

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[Frame, list[Frame]]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        try:
            time_s, path = self._files[index]
        except TypeError:
            raise TypeError(f"frames[{told(index)}]: give a whole number or a slice") from None
        return Frame(path, time_s)

    def __repr__(self) -> str:
        return f"Frames({len(self)}, to {self.times_s[-1] / 60:.4g} min)" if self._files else "Frames(none)"


class Run:
    """Results directory of a finished, running or killed run.

    Tables are read again on each access, so a running simulation shows its progress.

    Parameters
    ----------
    directory : str or path
        Directory written by ``plica run --out`` or ``Simulation.run(out=...)``.

    Raises
    ------
    FileError
        If the directory does not contain a run.
    """

    def __init__(self, directory: Union[str, os.PathLike[str]]) -> None:
        self.directory = Path(path_of(directory, "directory"))
        if not self.directory.is_dir():
            raise FileError(f"{self.directory}: there is no such directory")
        if not (self.directory / "series.csv").is_file():
            raise FileError(f"{self.directory}: not a results directory (no series.csv)")

    @property
    def series(self) -> pandas.DataFrame:
        """Time series, one row per step; missing values are NaN."""
        return self._table("series.csv")

    @property
    def cells(self) -> pandas.DataFrame:
        """Per-cell values, one row per cell and snapshot."""
        return self._table("cells.csv", "embryos of over 2000 cells have none by default; set output.cells_csv = true")

    @property
    def midline(self) -> pandas.DataFrame:
        """Midline of the furrow, one row per cell and snapshot."""
        return self._table("midline.csv", "the set \"fold\" was not measured")

    @property
    def cross_section(self) -> pandas.DataFrame:
        """Three cross-sections, one row per cell and snapshot."""
        return self._table("cross_section.csv", "the set \"fold\" was not measured")

    @property
    def lineage(self) -> pandas.DataFrame:
        """Cell lineage, one row per daughter cell, at its birth."""
        return self._table("lineage.csv", "no cells divide in this scenario")

    @property
    def frames(self) -> Frames:
        """Snapshots saved as meshes."""
        return Frames(self.directory)

    def labels(self, time_min: float, spacing_um: Sequence[float], *, shape: Optional[Sequence[int]] = None,
               origin_um: Optional[Sequence[float]] = None) -> LabelVolume:
        """Return the snapshot nearest to a time in minutes as a volume of labels; see `Frame.labels`."""
        return self.frames.at(time_min).labels(spacing_um, shape=shape, origin_um=origin_um)

    @property
    def summary(self) -> dict[str, Any]:
        """Final results (``summary.json``); empty until the run has ended."""
        path = self.directory / "summary.json"
        try:
            return dict(json.loads(path.read_text(encoding="utf-8")))
        except FileNotFoundError:
            return {}
        except (OSError, ValueError) as error:
            raise FileError(f"{path}: cannot be read: {error}") from error

    @property
    def status(self) -> str:
        """Final status ("equilibrium", "end_time", "failed", "interrupted"), or "running", or "killed"."""
        summary = self.summary
        if summary:
            return str(summary["status"])
        return "running" if self._is_held() else "killed"

    @property
    def scenario(self) -> Scenario:
        """Scenario of the run. ScenarioError if this version of plica cannot read it."""
        return Scenario(self.directory / "scenario.toml")

    def plot(self, columns: Union[str, Sequence[str], None] = None, ax: Any = None) -> Any:
        """Plot columns of `series` over time, one axes per column.

        Parameters
        ----------
        columns : str or sequence of str, optional
            Column names; by default depth of a furrow or fold, else largest displacement, and largest speed.
        ax : matplotlib Axes, or sequence of them, optional
            Axes to draw into, one per column; by default a new figure is made.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        ValueError
            If a column does not exist.
        MissingExtra
            If pandas or matplotlib is not installed.
        """
        plt = needed("matplotlib.pyplot", "plot")
        series = self.series
        if columns is None:
            columns = ("furrow_depth_um" if "furrow_depth_um" in series else "max_displacement_um", "max_node_speed_um_per_s")
        names = texts_of(columns, "columns")
        if not names:
            raise ValueError("columns: is empty; give the name of a column")
        is_fold = str(self.summary.get("outcome", "")).startswith("fold")
        missing = [name for name in names if name not in series]
        if missing:
            raise ValueError(f"series.csv has no column {missing[0]}; it has {', '.join(series.columns)}")
        if ax is None:
            figure, drawn = plt.subplots(len(names), 1, sharex=True, squeeze=False, figsize=(6, 1 + 2 * len(names)))
            axes = list(drawn[:, 0])
        else:
            axes = list(np.ravel(np.asarray(ax, dtype=object)))
            if len(axes) != len(names) or not all(hasattr(one, "set_ylabel") for one in axes):
                raise ValueError(f"ax: {told(ax)}; give one matplotlib Axes per column ({len(names)})")
            figure = axes[0].figure
        for name, one in zip(names, axes):
            one.plot(series["time_s"] / 60, series[name])
            one.set_ylabel(label(name).replace("furrow depth", "fold depth") if is_fold else label(name))
        axes[-1].set_xlabel("time (min)")
        figure.tight_layout()
        return figure

    def show(self, height: int = 800) -> Any:
        """Show the report inside a notebook.

        Parameters
        ----------
        height : int
            Height, pixels.
        """
        high = whole(height, "height")
        display = needed("IPython.display", "show")
        report = self.directory / "report.html"
        try:
            page = report.read_text(encoding="utf-8")
        except OSError as error:
            raise FileError(f"{report}: cannot be read; write it with `plica report {self.directory}`") from error
        return display.HTML(f'<div><iframe srcdoc="{html.escape(page)}" width="100%" height="{high}"></iframe></div>')

    def _table(self, name: str, why: str = "") -> pandas.DataFrame:
        path = self.directory / name
        try:
            table: pandas.DataFrame = _pandas(name).read_csv(path)
            return table
        except FileNotFoundError:
            raise FileError(f"{path}: there is no such file" + (f"; {why}" if why else "")) from None
        except (OSError, ValueError) as error:
            raise FileError(f"{path}: cannot be read: {error}") from error

    def _is_held(self) -> bool:
        descriptor = os.open(self.directory, os.O_RDONLY | os.O_DIRECTORY)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:  # file system without locks
            return False
        finally:
            os.close(descriptor)
        return False

    def __repr__(self) -> str:
        outcome = self.summary.get("outcome", "")
        return f"Run({str(self.directory)!r}, {self.status}, {len(self.frames)} frames{outcome and ': '}{outcome})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td style='text-align:left'>{html.escape(name)}</td><td>{html.escape(_short(value))}</td></tr>"
            for name, value in self.summary.items()
            if isinstance(value, (int, float, str)) and not isinstance(value, bool)
        )
        return f"{html.escape(repr(self))}<details><summary>summary</summary><table>{rows}</table></details>"


def open_run(directory: Union[str, os.PathLike[str]]) -> Run:
    """Open a results directory; available as ``plica.open``.

    Parameters
    ----------
    directory : str or path
        Directory of a finished or running run, also of older versions.

    Returns
    -------
    Run

    Raises
    ------
    FileError
        If the directory does not contain a run.

    Examples
    --------
    >>> import pathlib, tempfile, plica
    >>> folder = pathlib.Path(tempfile.mkdtemp()) / "run"
    >>> _ = plica.Simulation("division-demo").run(until_min=0.1, out=folder)
    >>> float(plica.open(folder).series["time_s"].iloc[-1])
    6.0
    """
    return Run(directory)


def _short(value: Union[int, float, str]) -> str:
    return f"{value:.6g}" if isinstance(value, float) and math.isfinite(value) else str(value)


# VTK XML of unstructured grids as plica writes it: zlib-compressed blocks in base64 within each array. Older frames have
# them appended, in base64 or raw.
TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1", "Int8": "i1"}


def _read_vtu(path: Path) -> dict[str, dict[str, NDArray[Any]]]:
    try:
        head, older, rest = path.read_bytes().partition(b"<AppendedData")
        encoding, _, appended = rest.partition(b"_")
        root = xml.fromstring(head + b"</VTKFile>" if older else head)
        found: dict[str, dict[str, NDArray[Any]]] = {}
        for group in ("Points", "Cells", "PointData", "CellData", "FieldData"):
            found[group] = {}
            where = "FieldData" if group == "FieldData" else f"Piece/{group}"
            for one in root.findall(f"./UnstructuredGrid/{where}/DataArray"):
                data = appended[int(one.attrib["offset"]) :] if older else (one.text or "").strip().encode()
                blocks = _blocks(data if b'"raw"' in encoding else _decoded(data))
                values = np.frombuffer(b"".join(blocks), TYPES[one.attrib["type"]])
                width = int(one.attrib.get("NumberOfComponents", "1"))
                found[group][one.attrib.get("Name", group)] = values.reshape(-1, width) if width > 1 else values
        if len(found["Points"]) != 1 or "connectivity" not in found["Cells"]:
            raise ValueError("it has no points or no cells")
        return found
    except (OSError, ValueError, KeyError, zlib.error, xml.ParseError) as error:
        raise FileError(f"{path}: cannot be read as a frame: {error}") from error


def _blocks(data: bytes) -> Iterator[bytes]:
    count = int(np.frombuffer(data, "<u8", 1)[0])
    start = 24 + 8 * count
    for size in map(int, np.frombuffer(data, "<u8", count, 24)):
        yield zlib.decompress(data[start : start + size])
        start += size


def _decoded(data: bytes) -> bytes:
    # Sizes and blocks are coded apart, so the code of the sizes ends at a multiple of four letters.
    count = int(np.frombuffer(base64.b64decode(data[:32]), "<u8", 1)[0])
    letters = 4 * -(-(24 + 8 * count) // 3)
    header = base64.b64decode(data[:letters])
    size = int(np.frombuffer(header, "<u8", count, 24).sum())
    return header + base64.b64decode(data[letters : letters + 4 * -(-size // 3)])
