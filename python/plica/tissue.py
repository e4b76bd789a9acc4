"""Tissues given as arrays."""
from __future__ import annotations

import codecs
import contextlib
import io
import os
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import flags, integers, mapping_of, numbers, path_of, per_cell
from .errors import FileError, needed

if TYPE_CHECKING:
    from .prisms import PrismTissue

__all__ = ["Tissue"]

masked: Any = np.ma  # has no types


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
        self.points = np.ascontiguousarray(numbers(points, "points", "(n, 3) numbers: x, y, z of each node, in µm"))
        self.hexahedra = integers(hexahedra, "hexahedra")
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
            faces = integers(apical_faces, "apical_faces")
            if faces.shape != (len(self.hexahedra),) or faces.min() < 0 or faces.max() > 5:
                raise ValueError("apical_faces: give one number from 0 to 5 per cell")
            self.apical_faces = faces
        masks = mapping_of({} if regions is None else regions, "regions", "a mapping of names to arrays")
        self.regions = {name: flags(mask, len(self.hexahedra), f"region {name}") for name, mask in masks.items()}
        given = mapping_of({} if cell_data is None else cell_data, "cell_data", "a mapping of names to arrays")
        self.cell_data = {name: _finite(per_cell(values, len(self.hexahedra), f"cell_data {name}")) for name, values in given.items()}
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
        arrays = {name: np.concatenate([masked.asarray(blocks[number]) for number in chosen]) for name, blocks in mesh.cell_data.items()}
        single = {name: values.reshape(-1) for name, values in arrays.items() if values.size == len(values)}
        if apical_array and apical_array not in single:
            there = ", ".join(single) or "none"
            raise FileError(f"{path}: no cell array {apical_array!r} with one number per cell; there are: {there}")
        faces = single.pop(apical_array) if apical_array else None
        try:
            if faces is not None:
                faces = masked.filled(faces.astype(np.float64), np.nan)
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

    @classmethod
    def from_prisms(cls, apical: ArrayLike, basal: ArrayLike, cells: Iterable[ArrayLike], *,
                    regions: Optional[Mapping[str, ArrayLike]] = None, cell_data: Optional[Mapping[str, ArrayLike]] = None) -> PrismTissue:
        """Return a tissue of prisms: cells between an apical and a basal polygon, whose walls may lean.

        Parameters
        ----------
        apical, basal : array_like of float, shape (n, 3)
            Both ends of each column, µm. Neighbours share columns.
        cells : iterable of array_like of int
            Columns of each cell, counter-clockwise seen from the apical side.
        regions, cell_data
            As for `Tissue`.

        Raises
        ------
        ValueError
            If an array has the wrong shape or type. Other defects are reported by `Scenario`.

        Examples
        --------
        >>> import plica
        >>> square = [[0, 0], [10, 0], [10, 10], [0, 10]]
        >>> apical, basal = [[2 * x, 2 * y, 30] for x, y in square], [[x, y, 0] for x, y in square]
        >>> plica.Tissue.from_prisms(apical, basal, [[0, 1, 2, 3]])
        PrismTissue(1 cells, 4 columns)
        """
        from .prisms import PrismTissue

        return PrismTissue(apical, basal, cells, regions=regions, cell_data=cell_data)

    @property
    def shape(self) -> str:
        """Value of ``embryo.shape`` for this tissue."""
        return "file"

    @property
    def _prisms(self) -> Optional[_core.Prisms]:
        return None

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
        named: dict[str, Mapping[str, object]] = {"regions": self.regions, "arrays": self.cell_data}
        listed = "".join(f", {what}: {', '.join(entries)}" for what, entries in named.items() if entries)
        return f"Tissue({len(self.hexahedra)} cells, {len(self.points)} nodes{listed})"


def _read_by_meshio(path: Union[str, os.PathLike[str]]) -> Any:
    """Return the meshio.Mesh in a file; a byte-order mark is omitted."""
    path = path_of(path, "path")
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


def _finite(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(np.isfinite(values), values, np.nan)
