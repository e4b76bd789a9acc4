"""Scenarios: parameters of a simulation that can be read and changed."""
from __future__ import annotations

import codecs
import contextlib
import difflib
import html
import io
import math
import os
import shutil
import tempfile
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import FileError, ScenarioError, needed

__all__ = ["Scenario", "Tissue", "builtin_scenarios"]

MASKS: Any = np.ma  # numpy gives it no types
GIVEN = "<Python>"  # in messages, the file name of a scenario made of text or a dict


def builtin_scenarios() -> dict[str, str]:
    """Return the names and titles of the built-in scenarios.

    Returns
    -------
    dict of str to str
        Titles by name.

    Examples
    --------
    >>> import plica
    >>> "drosophila" in plica.builtin_scenarios()
    True
    """
    return {name: str(tomllib.loads(text).get("title", "")) for name, text in _core.scenarios.items()}


class Tissue:
    """Tissue given as arrays: one layer of hexahedral cells.

    Parameters
    ----------
    points : array_like of float, shape (n, 3)
        Node positions in the reference state, µm.
    hexahedra : array_like of int, shape (cells, 8)
        Node indices of each cell, from 0, in VTK order.
    apical_faces : array_like of int, shape (cells,), optional
        Apical face of each cell: 0 to 5 for nodes (0,4,7,3), (1,2,6,5), (0,1,5,4), (3,7,6,2), (0,3,2,1), (4,5,6,7). If
        omitted, the cells must form one closed layer, whose outer surface is apical.
    regions : mapping of str to array_like of bool, shape (cells,), optional
        Named cell sets. A scenario uses one by ``[region.NAME]`` with ``array = "NAME"``.
    cell_data : mapping of str to array_like of float, shape (cells,), optional
        Named numbers per cell, for regions and profiles by ``array``. NaN or masked: no value; the cell belongs to no region
        by this array, and profiles refuse it.

    Raises
    ------
    ValueError
        If an array has the wrong shape or type, or points are not finite, masked or missing.

    Examples
    --------
    >>> import numpy as np, plica
    >>> x, y, z = np.meshgrid([0, 20, 40], [0, 20], [0, 30], indexing="ij")
    >>> points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    >>> number = np.arange(12).reshape(3, 2, 2)
    >>> cells = [[number[i + a, b, c] for a, b, c in
    ...           [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]] for i in (0, 1)]
    >>> plica.Tissue(points, cells, apical_faces=[5, 5], regions={"left": [True, False]})
    Tissue(2 cells, 12 nodes, regions: left)
    """

    def __init__(
        self,
        points: ArrayLike,
        hexahedra: ArrayLike,
        *,
        apical_faces: Optional[ArrayLike] = None,
        regions: Optional[Mapping[str, ArrayLike]] = None,
        cell_data: Optional[Mapping[str, ArrayLike]] = None,
    ) -> None:
        self.points = np.array(_unmasked(points, "points"), dtype=np.float64, order="C")
        self.hexahedra = _whole_numbers(hexahedra, "hexahedra")
        if self.points.ndim != 2 or self.points.shape[1] != 3:
            raise ValueError(f"points: shape {self.points.shape}; give (n, 3): x, y, z of each node, in µm")
        if not np.isfinite(self.points).all():
            node = int(np.argwhere(~np.isfinite(self.points))[0, 0])
            raise ValueError(f"points: node {node} is at {self.points[node]}; give finite numbers")
        if self.hexahedra.ndim != 2 or self.hexahedra.shape[1] != 8 or len(self.hexahedra) == 0:
            raise ValueError(f"hexahedra: shape {self.hexahedra.shape}; give (cells, 8): the nodes of each cell")
        bad = (self.hexahedra < 0) | (self.hexahedra >= len(self.points))
        if bad.any():
            cell = int(np.argwhere(bad)[0, 0])
            raise ValueError(f"hexahedra: cell {cell} has nodes {self.hexahedra[cell]}; there are {len(self.points)}, from 0")
        self.apical_faces: Optional[NDArray[np.int32]] = None
        if apical_faces is not None:
            faces = _whole_numbers(apical_faces, "apical_faces")
            if faces.shape != (len(self.hexahedra),) or faces.min() < 0 or faces.max() > 5:
                raise ValueError("apical_faces: give one number from 0 to 5 per cell")
            self.apical_faces = faces
        self.regions = {name: _mask(mask, len(self.hexahedra), f"region {name}") for name, mask in (regions or {}).items()}
        self.cell_data = {name: _numbers(values, len(self.hexahedra), f"cell_data {name}") for name, values in (cell_data or {}).items()}
        self.remarks: list[str] = []

        for array in (self.points, self.hexahedra):
            array.flags.writeable = False  # so that scenarios with this tissue stay unchanged

    @classmethod
    def from_file(cls, path: Union[str, os.PathLike[str]], *, apical_array: str = "") -> Tissue:
        """Read hexahedral cells with meshio: VTK (``.vtu``, ``.vtk``), Abaqus, Gmsh, XDMF and others.

        Parameters
        ----------
        path : str or path
            Mesh file. Coordinates are in µm, or ``embryo.scale`` converts them.
        apical_array : str, optional
            Cell array with the apical face of each cell (0 to 5), as in ``embryo.apical_array``.

        Returns
        -------
        Tissue
            Other arrays with one number per cell become `cell_data`; element sets and named physical groups become `regions`.
            Faces, lines and vertices beside the hexahedra are omitted; of quadratic hexahedra, only the corners are used.
            Both are listed in `remarks`, and among the advice of a scenario.

        Raises
        ------
        FileError
            If the file cannot be read, or has other volumes than hexahedra.
        MissingExtra
            If meshio is not installed.
        """
        mesh = _read_by_meshio(path)
        chosen = [number for number, block in enumerate(mesh.cells) if block.type.startswith("hexahedron")]
        others = {block.type: block.dim for number, block in enumerate(mesh.cells) if number not in chosen}
        volumes = sorted(name for name, dimension in others.items() if dimension > 2)
        if volumes or not chosen:
            found = f"cells of type {', '.join(volumes or sorted(others))}" if others else "no cells"
            raise FileError(f"{path}: has {found}; every cell must be a hexahedron: mesh one layer of hexahedra, in Gmsh for "
                            "example, or save the apical polygons as PLY and set embryo.shape to \"surface\"")
        arrays = {name: np.concatenate([MASKS.asarray(blocks[number]) for number in chosen]) for name, blocks in mesh.cell_data.items()}
        single = {name: values.reshape(-1) for name, values in arrays.items() if values.size == len(values)}
        if apical_array and apical_array not in single:
            there = ", ".join(single) or "none"
            raise FileError(f"{path}: no cell array {apical_array!r} with one number per cell; there are: {there}")
        faces = single.pop(apical_array) if apical_array else None
        try:
            if faces is not None:
                faces = MASKS.filled(faces.astype(np.float64), np.nan)
                if (wrong := ~np.isin(faces, range(6))).any():
                    cell = int(np.argmax(wrong))
                    raise ValueError(f"the apical face of cell {cell} is {faces[cell]:g} in \"{apical_array}\"; faces are 0 to 5")
                faces = faces.astype(np.int64)
            hexahedra = np.concatenate([mesh.cells[number].data[:, :8] for number in chosen])
            numeric = {name: values for name, values in single.items() if values.dtype.kind in "biuf"}
            tissue = cls(mesh.points, hexahedra.astype(np.int64), apical_faces=faces, regions=_sets_of(mesh, chosen), cell_data=numeric)
            tissue.remarks = _remarks_on(mesh, chosen)
            return tissue
        except (ValueError, TypeError) as error:
            raise FileError(f"{path}: {error}") from error

    @cached_property
    def _mesh(self) -> _core.Mesh:
        return _core.mesh(
            self.points,
            self.hexahedra,
            [] if self.apical_faces is None else self.apical_faces.tolist(),
            {name: values.tolist() for name, values in {**self.cell_data, **self.regions}.items()},
            self.remarks,
        )

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_mesh"}

    def __repr__(self) -> str:
        named: dict[str, Iterable[str]] = {"regions": self.regions, "arrays": self.cell_data}
        listed = "".join(f", {what}: {', '.join(names)}" for what, names in named.items() if names)
        return f"Tissue({len(self.hexahedra)} cells, {len(self.points)} nodes{listed})"


class Scenario:
    """Complete, valid description of a simulation; invalid changes are rejected.

    Parameters
    ----------
    source : str, path or mapping
        Name of a built-in scenario, TOML file, TOML text (several lines, or containing "="), or nested dict.
    tissue : Tissue, optional
        Cells to use instead of an embryo built by plica.

    Raises
    ------
    ScenarioError
        If the scenario is invalid; lists every error with its key and fix.
    FileError
        If the file cannot be read.
    ValueError
        If `source` is neither a built-in scenario nor a file.

    Examples
    --------
    >>> import plica
    >>> s = plica.Scenario("drosophila")
    >>> s["contraction.apical.stiffness_nN_per_um"] = 5
    >>> s["contraction.apical.stiffness_nN_per_um"]
    5
    >>> s.diff(plica.Scenario("drosophila"))["contraction.apical.stiffness_nN_per_um"]
    (5, 4.82)
    """

    def __init__(self, source: Union[str, os.PathLike[str], Mapping[str, Any]], *, tissue: Optional[Tissue] = None) -> None:
        self._source: tuple[str, str, str]  # name, file, text
        if isinstance(source, Mapping):
            self._source = ("scenario", GIVEN, _toml_of(source))
        elif isinstance(source, str) and ("\n" in source or "=" in source):
            self._source = ("scenario", GIVEN, source)
        else:
            self._source = _core.find(os.fspath(source))
        self._changes: dict[str, str] = {}
        self._regions: dict[str, NDArray[np.bool_]] = {}
        self._tissue = tissue
        if tissue is not None:
            self._changes = {"embryo.shape": '"file"', "embryo.file": f'"{GIVEN}"'}
        self._load()

    # The only place where a scenario is checked. On failure, self is unchanged.
    def _load(self, changes: Optional[dict[str, str]] = None, regions: Optional[dict[str, NDArray[np.bool_]]] = None) -> None:
        changes = self._changes if changes is None else changes
        regions = self._regions if regions is None else regions
        core = _core.load(
            *self._source,
            [f"{key}={value}" for key, value in changes.items()],
            {name: np.flatnonzero(mask).tolist() for name, mask in regions.items()},
            None if self._tissue is None else self._tissue._mesh,
        )
        self._core, self._changes, self._regions = core, changes, regions
        self._resolved: Optional[dict[str, Any]] = None

    @property
    def name(self) -> str:
        """Name of the built-in scenario, or of the file without extension."""
        return self._source[0]

    @property
    def title(self) -> str:
        """Title given in the scenario."""
        return self._core.title

    @property
    def tissue(self) -> Optional[Tissue]:
        """Tissue given from Python; None if plica builds the embryo or reads it from a file."""
        return self._tissue

    def to_toml(self) -> str:
        """Return the complete scenario, including defaults, as TOML text.

        Returns
        -------
        str
            Text as in ``scenario.toml`` of a run; it loads to an equal scenario.
        """
        return self._core.toml()

    def to_dict(self) -> dict[str, Any]:
        """Return the complete scenario, including defaults, as nested dicts."""
        return tomllib.loads(self.to_toml())

    def __getitem__(self, key: str) -> Any:
        if self._resolved is None:
            self._resolved = self.to_dict()
        value: Any = self._resolved
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                near = difflib.get_close_matches(key, list(dict(_items(self._resolved))), 3)
                hint = f"; nearest matches: {', '.join(near)}" if near else ""
                raise KeyError(f"{key}: has no value in this scenario{hint}")
            value = value[part]
        return value

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __contains__(self, key: object) -> bool:
        return key in set(self.keys())

    def keys(self) -> Iterator[str]:
        """Iterate over all dotted keys that have a value."""
        return (key for key, _ in _items(self.to_dict()))

    def update(self, changes: Mapping[str, Any]) -> None:
        """Change several keys at once, for changes that are valid only together.

        Parameters
        ----------
        changes : mapping of str to value
            Dotted keys, as in ``plica run --set``, with numbers, strings, lists, dicts or booleans.

        Raises
        ------
        ScenarioError
            If the result is invalid. The scenario is then unchanged.

        Examples
        --------
        >>> import plica
        >>> s = plica.Scenario("drosophila")
        >>> s.update({"elasticity.model": "neo-hookean", "elasticity.relaxation_s": 300})
        """
        merged = dict(self._changes)
        for key, value in changes.items():
            merged.pop(key, None)  # the last change comes last
            merged[key] = _toml_value(value, key)
        self._load(changes=merged)

    def set_region(self, name: str, cells: ArrayLike) -> None:
        """Define a region by a boolean array, replacing any definition in the scenario.

        Parameters
        ----------
        name : str
            Name of a new or existing region.
        cells : array_like of bool, shape (cells,)
            True for cells of the region, in the order of ``Simulation.cell_data``.

        Raises
        ------
        ValueError
            If `cells` is not boolean or selects no cell.

        Examples
        --------
        >>> import plica
        >>> s = plica.Scenario("drosophila")
        >>> x = plica.Simulation(s).cell_data["x_um"]
        >>> s.set_region("front", x < 0)
        """
        mask = _mask(cells, np.shape(cells)[0] if np.ndim(cells) else 0, f"region {name}")
        if not mask.any():
            raise ValueError(f"region {name}: selects no cell; set at least one to True")
        changes = self._changes
        if name not in self.to_dict().get("region", {}):
            # Declares the name for other keys; the array defines the cells.
            changes = {f"region.{name}.ids": f"[{int(np.argmax(mask))}]", **changes}
        self._load(changes=changes, regions={**self._regions, name: mask.copy()})

    @property
    def _ready(self) -> _core.Scenario:
        """Core scenario for a simulation; without VTK, includes cells read by meshio."""
        embryo = self.to_dict()["embryo"]
        if embryo["shape"] == "file" and not self._core.has_mesh and not _core.reads_meshes:
            self._core.give_mesh(Tissue.from_file(embryo["file"], apical_array=embryo.get("apical_array", ""))._mesh)
        return self._core

    def _check_masks(self, cells: int) -> None:
        for name, mask in self._regions.items():
            if len(mask) != cells:
                problem = f"is an array for {len(mask)} cells; the tissue has {cells}"
                raise ScenarioError([("", 0, f"region.{name}", problem, "give one boolean per cell")])

    def copy(self) -> Scenario:
        """Return an independent copy."""
        other = object.__new__(Scenario)
        other.__setstate__(self.__getstate__())
        return other

    def diff(self, other: Scenario) -> dict[str, tuple[Any, Any]]:
        """Return the keys in which two scenarios differ.

        Parameters
        ----------
        other : Scenario

        Returns
        -------
        dict of str to (value, value)
            Value in this scenario and in `other`; None where a scenario has none. Expected results of built-in scenarios
            (``[expect]``) are not compared.
        """
        mine, others = (dict(_items(scenario.to_dict())) for scenario in (self, other))
        keys = [key for key in {**mine, **others} if not key.startswith("expect.")]
        return {key: (mine.get(key), others.get(key)) for key in keys if mine.get(key) != others.get(key)}

    def advice(self) -> list[str]:
        """Return advice before a run, as lines that begin with "warning: " or "note: "."""
        return self._ready.advice()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        return self.to_dict() == other.to_dict() and self._tissue is other._tissue

    __hash__ = None  # type: ignore[assignment]

    def __getstate__(self) -> dict[str, Any]:
        return {"source": self._source, "changes": self._changes, "regions": self._regions, "tissue": self._tissue}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._source, self._tissue = state["source"], state["tissue"]
        self._load(dict(state["changes"]), dict(state["regions"]))

    def __repr__(self) -> str:
        of_arrays = {f"region.{name}.ids" for name in self._regions}
        shown = {key: value for key, value in self._changes.items() if key not in of_arrays and value != f'"{GIVEN}"'}
        changed = [f"{key} = {value}" for key, value in shown.items()]
        changed += [f"region.{name} of {mask.sum()} cells" for name, mask in self._regions.items()]
        return f"Scenario({self.name!r}{', with ' if changed else ''}{', '.join(changed)})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td style='text-align:left'>{html.escape(key)}</td>"
            f"<td style='text-align:left'>{html.escape(str(value))}</td></tr>"
            for key, value in _items(self.to_dict())
        )
        return (
            f"<b>{html.escape(self.name)}</b>: {html.escape(self.title)}"
            f"<details><summary>{html.escape(repr(self))}</summary><table>{rows}</table></details>"
        )


def _items(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _items(value, f"{before}{key}.")
        else:
            yield before + key, value


def _read_by_meshio(path: Union[str, os.PathLike[str]]) -> Any:
    """Return the meshio.Mesh in a file; a byte-order mark is omitted."""
    meshio = needed("meshio", f"reading {Path(path).name}")
    if not Path(path).is_file():
        raise FileError(f"{path}: cannot be read: {'it is a directory' if Path(path).is_dir() else 'there is no such file'}")
    said = io.StringIO()
    try:
        # For an unknown format, meshio prints the error and exits.
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said), tempfile.TemporaryDirectory() as folder:
            with open(path, "rb") as file:
                marked = file.read(3) == codecs.BOM_UTF8
            if marked:
                path = shutil.copy(path, folder)
                Path(path).write_bytes(Path(path).read_bytes()[3:])
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        why = " ".join(said.getvalue().split()) or f"{type(error).__name__}: {error}"
        raise FileError(f"{path}: cannot be read: {why}") from error


def _sets_of(mesh: Any, chosen: list[int]) -> dict[str, NDArray[np.bool_]]:
    """Return element sets and named physical groups that contain some of the chosen blocks' cells."""
    first = np.cumsum([0] + [len(mesh.cells[number].data) for number in chosen])
    sets = {}
    for name, of_blocks in mesh.cell_sets.items():
        mask = np.zeros(first[-1], dtype=bool)
        for begin, number in zip(first.tolist(), chosen):
            cells = of_blocks[number] if number < len(of_blocks) and not name.startswith("gmsh:") else None
            mask[begin + np.asarray([] if cells is None else cells, dtype=np.int64)] = True
        sets[name] = mask
    groups = mesh.cell_data.get("gmsh:physical")
    for name, (tag, dimension) in mesh.field_data.items() if groups is not None else ():
        if dimension == 3 and name not in sets:
            sets[name] = np.concatenate([groups[number] for number in chosen]) == tag
    return {name: mask for name, mask in sets.items() if mask.any()}


def _remarks_on(mesh: Any, chosen: list[int]) -> list[str]:
    """Say what of a file is not used, in the words of the reader of VTK files."""
    others = sum(len(block.data) for number, block in enumerate(mesh.cells) if number not in chosen)
    quadratic = sum(len(mesh.cells[number].data) for number in chosen if mesh.cells[number].data.shape[1] > 8)
    remarks = [f"{others} faces, lines and vertices beside the hexahedra were omitted"] if others else []
    return remarks + ([f"{quadratic} hexahedra have nodes between corners: only their corners are used"] if quadratic else [])


def _unmasked(values: ArrayLike, what: str) -> ArrayLike:
    if MASKS.is_masked(values):
        raise ValueError(f"{what}: {int(MASKS.count_masked(values))} values are masked; give a value for each")
    return values


def _numbers(values: ArrayLike, count: int, what: str) -> NDArray[np.float64]:
    """Return numbers per cell; NaN where they are masked."""
    numbers = MASKS.asarray(values)
    if numbers.dtype.kind not in "biuf" or numbers.shape != (count,):
        raise ValueError(f"{what}: an array of {numbers.dtype} and shape {numbers.shape}; give one number per cell ({count})")
    filled: NDArray[np.float64] = MASKS.filled(numbers.astype(np.float64), np.nan)
    return np.where(np.isfinite(filled), filled, np.nan)


def _mask(cells: Any, count: int, what: str) -> NDArray[np.bool_]:
    mask = np.asarray(_unmasked(cells, what))
    if mask.dtype != np.bool_ or mask.shape != (count,):
        raise ValueError(f"{what}: an array of {mask.dtype} and shape {mask.shape}; give one boolean per cell ({count})")
    return mask


def _whole_numbers(values: ArrayLike, what: str) -> NDArray[np.int32]:
    numbers = np.asarray(_unmasked(values, what))
    if not np.issubdtype(numbers.dtype, np.integer):
        raise ValueError(f"{what}: an array of {numbers.dtype}; give whole numbers")
    if numbers.size and (numbers.min() < -(2**31) or numbers.max() >= 2**31):
        raise ValueError(f"{what}: numbers exceed the range of 32-bit integers")
    return np.array(numbers, dtype=np.int32, order="C")


def _toml_value(value: Any, key: str) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return repr(number) if math.isfinite(number) else str(number)  # nan and inf are valid TOML, and rejected by the check
    if isinstance(value, (str, Path)):
        return _toml_text(str(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_toml_key(k)} = {_toml_value(v, f'{key}.{k}')}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_toml_value(item, key) for item in value) + "]"
    raise TypeError(f"{key}: a value of type {type(value).__name__}; give a number, text, boolean, list or dict")


def _toml_text(text: str) -> str:
    escaped = "".join(
        {'"': '\\"', "\\": "\\\\"}.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04X}") for c in text
    )
    return f'"{escaped}"'


def _toml_key(key: Any) -> str:
    text = str(key)
    return text if text and all(c.isascii() and (c.isalnum() or c in "-_") for c in text) else _toml_text(text)


def _toml_of(table: Mapping[str, Any]) -> str:
    return "".join(f"{_toml_key(key)} = {_toml_value(value, str(key))}\n" for key, value in table.items())
