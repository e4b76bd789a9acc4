"""Tissues given by apical and basal corners."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import flags, mapping_of, numbers, per_cell
from .polygons import Polygons
from .tissue import Tissue

__all__ = ["PrismTissue"]


class PrismTissue(Tissue):
    """Tissue of prisms (`Tissue.from_prisms`): cells between an apical and a basal polygon.

    Attributes
    ----------
    apical, basal : ndarray of float, shape (n, 3)
        Both ends of each column, µm.
    cells : list of ndarray of int
        Columns of each cell, counter-clockwise seen from the apical side.
    points, hexahedra : ndarray
        Nodes and elements, as made with the defaults of ``[embryo]``; `element_cells` has the cell of each element.
    cell_data, regions
        As in `Tissue`.
    """

    def __init__(
        self, apical: ArrayLike, basal: ArrayLike, cells: Iterable[ArrayLike], *,
        regions: Optional[Mapping[str, ArrayLike]] = None, cell_data: Optional[Mapping[str, ArrayLike]] = None,
    ) -> None:
        fits = "(n, 3) numbers: x, y, z of each column, in µm"
        top = Polygons(numbers(apical, "apical", fits), cells)
        bottom = numbers(basal, "basal", fits)
        if bottom.shape != top.points.shape or not np.isfinite(bottom).all():
            raise ValueError(f"basal: shape {bottom.shape}; give finite numbers of shape {top.points.shape}, one end for each apical one")
        self.apical, self.basal, self.cells = top.points, bottom, top.faces
        masks = mapping_of({} if regions is None else regions, "regions", "a mapping of names to arrays")
        self.regions = {name: flags(mask, len(self.cells), f"region {name}") for name, mask in masks.items()}
        given = mapping_of({} if cell_data is None else cell_data, "cell_data", "a mapping of names to arrays")
        self.cell_data = {name: per_cell(values, len(self.cells), f"cell_data {name}") for name, values in given.items()}
        self.apical_faces = None
        self.remarks: list[str] = []
        for array in (self.apical, self.basal):
            array.flags.writeable = False  # so that scenarios with this tissue stay unchanged

    @property
    def shape(self) -> str:
        return "prisms"

    @property
    def _mesh(self) -> None:  # type: ignore[override]
        return None

    @cached_property
    def _prisms(self) -> _core.Prisms:
        return _core.prisms(self.apical, self.basal, [cell.tolist() for cell in self.cells],
                            {name: values.tolist() for name, values in {**self.cell_data, **self.regions}.items()}, self.remarks)

    @cached_property
    def _elements(self) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]:
        points, nodes, cells = _core.hexahedra_of(self._prisms)
        return np.reshape(points, (-1, 3)), np.reshape(np.array(nodes, dtype=np.int32), (-1, 8)), np.array(cells)

    @property
    def points(self) -> NDArray[np.float64]:  # type: ignore[override]
        return self._elements[0]

    @property
    def hexahedra(self) -> NDArray[np.int32]:  # type: ignore[override]
        return self._elements[1]

    @property
    def element_cells(self) -> NDArray[np.int64]:
        return self._elements[2]

    @property
    def volumes(self) -> NDArray[np.float64]:
        """Volumes of the cells, µm³: lateral faces are bilinear, apical and basal ones triangles about the means of corners."""
        total = np.zeros(len(self.cells))
        for number, cell in enumerate(self.cells):
            top, bottom = self.apical[cell], self.basal[cell]
            middle = (top.mean(axis=0) + bottom.mean(axis=0)) / 2
            top, bottom = top - middle, bottom - middle
            above, below = np.roll(top, -1, axis=0), np.roll(bottom, -1, axis=0)
            triangles = [(top.mean(axis=0) + 0 * top, top, above), (bottom.mean(axis=0) + 0 * top, below, bottom)]
            sides = [(bottom, below, above), (bottom, above, top), (bottom, below, top), (below, above, top)]
            total[number] = sum(_cones(*one) for one in triangles) + sum(_cones(*one) for one in sides) / 2
        return total

    @property
    def heights(self) -> NDArray[np.float64]:
        """Mean lengths of the columns of each cell, µm."""
        length = np.linalg.norm(self.apical - self.basal, axis=1)
        return np.array([length[cell].mean() for cell in self.cells])

    def polygons(self, side: str = "apical") -> Polygons:
        """Return the apical or basal polygons with `cell_data`, both counter-clockwise seen from the apical side."""
        if side not in ("apical", "basal"):
            raise ValueError(f"side: {side!r:.60}; give \"apical\" or \"basal\"")
        return Polygons(self.apical if side == "apical" else self.basal, self.cells, self.cell_data)

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Write both polygons of each cell, ``.vtp`` or ``.ply``, to be read as ``embryo.file`` with ``embryo.shape = "prisms"``.

        Faces have arrays ``cell`` and ``is_apical`` beside `cell_data`. Requires a build with VTK to read ``.vtp``.
        """
        if str(path).endswith(".obj"):
            raise ValueError(f"{path}: .obj has no arrays; the file's name must end in .ply or .vtp")
        number = np.tile(np.arange(len(self.cells)), 2)
        faces = [*self.cells, *(cell + len(self.apical) for cell in self.cells)]
        data = {"cell": number, "is_apical": np.repeat([1, 0], len(self.cells)), **{name: values[number] for name, values in self.cell_data.items()}}
        Polygons(np.concatenate([self.apical, self.basal]), faces, data).write(path)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name not in ("_prisms", "_elements")}

    def __repr__(self) -> str:
        named: dict[str, Mapping[str, object]] = {"regions": self.regions, "arrays": self.cell_data}
        listed = "".join(f", {what}: {', '.join(entries)}" for what, entries in named.items() if entries)
        return f"{type(self).__name__}({len(self.cells)} cells, {len(self.apical)} columns{listed})"


def _cones(one: NDArray[Any], two: NDArray[Any], three: NDArray[Any]) -> float:
    """Return the volume of the cones from the origin to triangles."""
    return float((one * np.cross(two, three)).sum()) / 6
