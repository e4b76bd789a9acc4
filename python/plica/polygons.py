"""Cells as polygons."""
from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import integers, mapping_of, numbers, path_of, told
from .errors import FileError, needed

if TYPE_CHECKING:
    import pandas

__all__ = ["Polygons"]


class Polygons:
    """Surface of polygons, one per cell.

    Parameters
    ----------
    points : array_like of float, shape (n, 3)
        Vertices, µm.
    faces : iterable of array_like of int
        Vertex indices of each polygon, counter-clockwise seen from outside.
    cell_data : mapping of str to array_like, optional
        Arrays with one number per polygon.

    Attributes
    ----------
    points, faces, cell_data
        Parameters as arrays.

    Raises
    ------
    ValueError
        If a shape is wrong, a number is masked, missing or not finite, or a vertex does not exist.

    Examples
    --------
    >>> import plica
    >>> square = plica.Polygons([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], [[0, 1, 2, 3]])
    >>> square
    Polygons(1 cells, 4 vertices)
    >>> square.areas
    array([4.])
    """

    def __init__(
        self, points: ArrayLike, faces: Iterable[ArrayLike], cell_data: Optional[Mapping[str, ArrayLike]] = None
    ) -> None:
        self.points: NDArray[np.float64] = numbers(points, "points", "finite numbers of shape (n, 3)")
        if self.points.ndim != 2 or self.points.shape[1] != 3 or not np.isfinite(self.points).all():
            raise ValueError("points: give finite numbers of shape (n, 3): x, y, z of each vertex, in µm")
        if not isinstance(faces, Iterable):
            raise TypeError(f"faces: {told(faces)}; give the vertices of each polygon")
        self.faces: list[NDArray[np.int64]] = [integers(face, "faces").astype(np.int64) for face in faces]
        for number, face in enumerate(self.faces):
            if face.ndim != 1 or len(face) < 3 or face.min() < 0 or face.max() >= len(self.points):
                raise ValueError(f"faces: polygon {number} has vertices {face}; give three or more, 0 to {len(self.points) - 1}")
        self.cell_data: dict[str, NDArray[Any]] = {}
        for name, values in mapping_of({} if cell_data is None else cell_data, "cell_data", "a mapping of names to arrays").items():
            self.cell_data[name] = _numbers(name, values, len(self.faces))

    @property
    def centres(self) -> NDArray[np.float64]:
        """Means of the corners of each polygon, µm; shape (faces, 3)."""
        return np.array([self.points[face].mean(axis=0) for face in self.faces]).reshape(-1, 3)

    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas of the polygons, µm², summed over triangles about the mean of the corners; shape (faces,)."""
        return np.array([
            0.5 * np.linalg.norm(np.cross(spokes, np.roll(spokes, -1, axis=0)), axis=1).sum()
            for spokes in (self.points[face] - centre for face, centre in zip(self.faces, self.centres))
        ])

    def _half_edges(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the ends, shape (n, 2), and the polygons of all half-edges."""
        ends = np.array([pair for one in self.faces for pair in zip(one, np.roll(one, -1))], dtype=np.int64).reshape(-1, 2)
        return ends, np.repeat(np.arange(len(self.faces)), [len(one) for one in self.faces])

    @property
    def pieces(self) -> NDArray[np.int64]:
        """Piece of each polygon, from 0, the largest; polygons that share an edge are in one; shape (faces,)."""
        ends, face = self._half_edges()
        edge = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)[1].ravel()
        order = np.argsort(edge, kind="stable")
        shared = edge[order][1:] == edge[order][:-1]
        one, other = face[order][1:][shared], face[order][:-1][shared]
        first = np.arange(len(self.faces))  # of the piece, when all is done
        while (first[one] != first[other]).any():
            lower = np.minimum(first[one], first[other])
            for ends_of in (one, other):
                np.minimum.at(first, first[ends_of], lower)
            first = first[first]
        size = np.bincount(first, minlength=len(self.faces))
        by_size = np.argsort(-size, kind="stable")
        rank = np.empty_like(by_size)
        rank[by_size] = np.arange(len(by_size))
        return np.asarray(rank[first])

    def select(self, cells: ArrayLike) -> Polygons:
        """Return some of the polygons, with their arrays.

        Parameters
        ----------
        cells : array_like of bool, shape (faces,)
            True for polygons to keep.

        Raises
        ------
        ValueError
            If `cells` is not one boolean per polygon.
        """
        mask = np.asarray(cells)
        if mask.shape != (len(self.faces),) or mask.dtype != bool:
            raise ValueError(f"cells: shape {mask.shape} of {mask.dtype}; give one boolean for each of {len(self.faces)} polygons")
        faces = [face for face, chosen in zip(self.faces, mask) if chosen]
        used, renumbered = np.unique(np.concatenate([*faces, []]).astype(np.int64), return_inverse=True)
        ends = np.cumsum([len(face) for face in faces])[:-1]
        return Polygons(self.points[used], np.split(renumbered, ends) if faces else [],
                        {name: values[mask] for name, values in self.cell_data.items()})

    def to_pyvista(self) -> Any:
        """Return the surface as a ``pyvista.PolyData``."""
        pyvista = needed("pyvista", "a surface for PyVista")
        faces = np.concatenate([np.concatenate([[len(face)], face]) for face in self.faces])
        surface = pyvista.PolyData(self.points, faces)
        for name, values in self.cell_data.items():
            surface.cell_data[name] = values
        return surface

    def to_tables(self) -> dict[str, pandas.DataFrame]:
        """Return vertex-model tables with the column names of tyssue.

        Returns
        -------
        dict of str to pandas.DataFrame
            ``vert`` (x, y, z), ``edge`` (half-edges: srce, trgt, face, opposite, -1 at a rim, dx, dy, dz, length) and
            ``face`` (x, y, z, num_sides, area, perimeter, and `cell_data`). Lengths in µm.
        """
        pandas = needed("pandas", "tables")
        srce = np.concatenate(self.faces)
        trgt = np.concatenate([np.roll(face, -1) for face in self.faces])
        face = np.repeat(np.arange(len(self.faces)), [len(one) for one in self.faces])
        number = {ends: edge for edge, ends in enumerate(zip(srce.tolist(), trgt.tolist()))}
        opposite = [number.get(ends, -1) for ends in zip(trgt.tolist(), srce.tolist())]
        along = self.points[trgt] - self.points[srce]
        length = np.linalg.norm(along, axis=1)
        edges = {"srce": srce, "trgt": trgt, "face": face, "opposite": opposite,
                 "dx": along[:, 0], "dy": along[:, 1], "dz": along[:, 2], "length": length}
        centres = self.centres
        faces = {"x": centres[:, 0], "y": centres[:, 1], "z": centres[:, 2],
                 "num_sides": [len(one) for one in self.faces], "area": self.areas,
                 "perimeter": np.bincount(face, weights=length), **self.cell_data}
        tables = {"vert": pandas.DataFrame(self.points, columns=["x", "y", "z"]),
                  "edge": pandas.DataFrame(edges), "face": pandas.DataFrame(faces)}
        for name, table in tables.items():
            table.index.name = name
        return tables

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Write the surface: ``.ply`` or ``.vtp`` with arrays, ``.obj`` without.

        Parameters
        ----------
        path : str or path
            File to write. ``.ply`` and ``.obj`` can be read back as ``embryo.file``; ``.vtp`` requires a build with VTK.

        Raises
        ------
        ValueError
            If the extension is another, a number is missing in `cell_data`, or, for ``.ply``, an array name is not one word.
        """
        file = Path(path_of(path, "path"))
        texts = {".ply": self._ply, ".vtp": self._vtp, ".obj": self._obj}
        if file.suffix not in texts:
            raise ValueError(f"{file}: the file's name must end in .ply, .vtp or .obj")
        for name, values in self.cell_data.items():
            _numbers(name, values, len(self.faces))
        try:
            file.write_text(texts[file.suffix](), encoding="utf-8")
        except OSError as error:
            raise FileError(f"{file}: cannot be written: {error}") from error

    def _obj(self) -> str:
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in self.points.tolist()]
        lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in self.faces]
        return "\n".join(lines) + "\n"

    def _ply(self) -> str:
        for name in self.cell_data:
            if name.split() != [name]:
                raise ValueError(f"cell_data: {name!r}; in a .ply file an array name must be one word; rename it")
        arrays = [np.asarray(values, dtype=np.float64).tolist() for values in self.cell_data.values()]
        lines = ["ply", "format ascii 1.0", f"element vertex {len(self.points)}", *(f"property double {axis}" for axis in "xyz"),
                 f"element face {len(self.faces)}", "property list uchar int vertex_indices",
                 *(f"property double {name}" for name in self.cell_data), "end_header"]
        lines += [f"{x!r} {y!r} {z!r}" for x, y, z in self.points.tolist()]
        lines += [" ".join(map(repr, [len(face), *face.tolist(), *values])) for face, *values in zip(self.faces, *arrays)]
        return "\n".join(lines) + "\n"

    def _vtp(self) -> str:
        def array(name: str, kind: str, values: NDArray[Any], more: str = "") -> str:
            numbers = " ".join(map(repr, values.ravel().tolist()))
            return f'<DataArray type="{kind}" Name={quoteattr(name)}{more} format="ascii">{numbers}</DataArray>'

        ends = np.cumsum([len(face) for face in self.faces])
        data = [array(name, "Float64", np.asarray(values, dtype=np.float64)) for name, values in self.cell_data.items()]
        return "\n".join([
            '<?xml version="1.0"?>', '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian">', "<PolyData>",
            f'<Piece NumberOfPoints="{len(self.points)}" NumberOfPolys="{len(self.faces)}">', "<CellData>", *data,
            "</CellData>", "<Points>", array("positions", "Float64", self.points, ' NumberOfComponents="3"'), "</Points>",
            "<Polys>", array("connectivity", "Int64", np.concatenate(self.faces)), array("offsets", "Int64", ends),
            "</Polys>", "</Piece>", "</PolyData>", "</VTKFile>", ""])

    def __len__(self) -> int:
        return len(self.faces)

    def __repr__(self) -> str:
        return f"Polygons({len(self.faces)} cells, {len(self.points)} vertices)"


def _numbers(name: str, values: ArrayLike, count: int) -> NDArray[Any]:
    """Return an array with one finite number for each of `count` polygons. ValueError names the first that is not."""
    array = np.asarray(values)
    if array.shape != (count,):
        raise ValueError(f"cell_data: {name} has shape {array.shape}; give one number for each of {count} polygons")
    missing = np.broadcast_to(values.mask if isinstance(values, np.ma.MaskedArray) else False, count)
    if array.dtype.kind not in "biuf":
        numbers = np.full(count, np.nan)
        for cell, value in enumerate(array):
            with contextlib.suppress(TypeError, ValueError):
                numbers[cell] = float(value)
        array = numbers
    missing = missing | ~np.isfinite(array)
    if missing.any():
        raise ValueError(f"cell_data: {name} has no number for polygon {int(np.argmax(missing))}, and for {int(missing.sum())} of {count} "
                         "in all; give numbers, or leave these polygons out: select(numpy.isfinite(values))")
    return array


def too_small(polygons: Polygons) -> NDArray[np.bool_]:
    """Return for each polygon whether it is the smallest of those that run along an edge in the same direction."""
    ends, face = polygons._half_edges()
    areas = polygons.areas
    order = np.lexsort((areas[face], ends[:, 1], ends[:, 0]))
    alike = (ends[order][1:] == ends[order][:-1]).all(axis=1)
    found = np.zeros(len(polygons), dtype=bool)
    found[face[order][:-1][alike]] = True
    return found


def parted(polygons: Polygons, step: float) -> int:
    """Part polygons that meet at a vertex but share no edge there, by moving it `step` into each side. Return how often."""
    ends, face = polygons._half_edges()
    edges = {(start, end): cell for (start, end), cell in zip(ends.tolist(), face.tolist())}
    free = np.array([pair[::-1] not in edges for pair in edges], dtype=bool)
    starts = np.bincount(np.array(list(edges), dtype=np.int64).reshape(-1, 2)[free, 0], minlength=len(polygons.points))
    pinched = np.flatnonzero(starts > 1)
    points = list(polygons.points)
    for vertex in pinched.tolist():
        at = {start: cell for (start, end), cell in edges.items() if end == vertex}  # by the corner before the vertex
        after = {cell: end for (start, end), cell in edges.items() if start == vertex}
        place = points[vertex]
        for number, first in enumerate(start for start in at if (vertex, start) not in edges):
            side = [at[first]]
            while after[side[-1]] in at:  # the next polygon around the vertex
                side.append(at[after[side[-1]]])
            way = np.mean([polygons.points[polygons.faces[cell]].mean(axis=0) for cell in side], axis=0) - place
            now = vertex if number == 0 else len(points)
            points[now:now + 1] = [place + step * way / np.linalg.norm(way)]
            for cell in side:
                polygons.faces[cell] = np.where(polygons.faces[cell] == vertex, now, polygons.faces[cell])
    polygons.points = np.array(points).reshape(-1, 3)
    return len(pinched)


def check_keep(keep: object) -> None:
    """Raise ValueError unless a value of `keep` is known."""
    if not isinstance(keep, str) or keep not in ("all", "largest"):
        raise ValueError(f"keep: {keep!r:.60}; give \"all\" or \"largest\"")


def one_piece(polygons: Polygons, keep: str, what: str, advice: Callable[[], str]) -> Polygons:
    """Return the polygons if they are one piece, or the largest piece. `advice` gives another remedy, or nothing."""
    pieces = polygons.pieces
    sizes = np.bincount(pieces)
    if keep == "largest" or len(sizes) == 1:
        return polygons.select(pieces == 0)
    numbers = ", ".join(map(str, sizes[:5])) + (", …" if len(sizes) > 5 else "")
    label = polygons.cell_data["label"][np.argmax(pieces == 1)]
    raise ValueError(f"{what}: the tissue is in {len(sizes)} pieces, which share no edge, of {numbers} cells (cell {label} is in the "
                     f"second){advice()}; keep = \"largest\" omits all but the first")
