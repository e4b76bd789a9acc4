"""Cells as polygons, from a snapshot or from a label image."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import FileError, needed

if TYPE_CHECKING:
    import pandas

__all__ = ["Polygons", "polygons_of_labels"]


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
        If a shape is wrong, a number is not finite, or a vertex does not exist.

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
        self.points: NDArray[np.float64] = np.array(points, dtype=np.float64)
        if self.points.ndim != 2 or self.points.shape[1] != 3 or not np.isfinite(self.points).all():
            raise ValueError("points: give finite numbers of shape (n, 3): x, y, z of each vertex, in µm")
        self.faces: list[NDArray[np.int64]] = [np.array(face, dtype=np.int64) for face in faces]
        for number, face in enumerate(self.faces):
            if len(face) < 3 or face.min() < 0 or face.max() >= len(self.points):
                raise ValueError(f"faces: polygon {number} has vertices {face}; give three or more, 0 to {len(self.points) - 1}")
        self.cell_data: dict[str, NDArray[Any]] = {name: np.asarray(values) for name, values in (cell_data or {}).items()}
        for name, values in self.cell_data.items():
            if values.shape != (len(self.faces),):
                raise ValueError(f"cell_data: {name} has shape {values.shape}; give one number for each of {len(self.faces)} polygons")

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
            If the extension is another, or, for ``.ply``, an array name is not one word.
        """
        file = Path(path)
        texts = {".ply": self._ply, ".vtp": self._vtp, ".obj": self._obj}
        if file.suffix not in texts:
            raise ValueError(f"{file}: the file's name must end in .ply, .vtp or .obj")
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


def polygons_of_labels(
    image: ArrayLike,
    um_per_pixel: float,
    *,
    background: int = 0,
    gap_px: int = 2,
    keep_cut: bool = False,
) -> Polygons:
    """Return the polygons of a label image, with straight edges between points where three labels meet.

    Parameters
    ----------
    image : array_like of int, shape (rows, columns)
        Label image: cell number of each pixel, seen from the apical side.
    um_per_pixel : float
        Pixel size, µm.
    background : int
        Label of pixels outside all cells.
    gap_px : int
        Background lines between cells, up to twice this width, are assigned to the nearest cells; 0: none.
    keep_cut : bool
        Whether to keep cells cut by the border of the image.

    Returns
    -------
    Polygons
        Polygons with x to the right, y upwards, z = 0, and the origin at the centre of the lower left pixel. `cell_data`
        has the ``label`` of each. Cells with fewer than three corners are omitted.

    Raises
    ------
    ValueError
        If the image has the wrong shape or type, a cell is in several pieces or has a hole, or no cell has three corners.

    Examples
    --------
    >>> import numpy as np, plica
    >>> rows, columns = np.mgrid[:60, :60]
    >>> labels = 1 + (rows // 20) * 3 + (columns + 10 * (rows // 20 % 2)) // 20
    >>> plica.polygons_of_labels(labels, um_per_pixel=0.5)  # doctest: +SKIP
    Polygons(1 cells, 6 vertices)
    """
    labels = np.asarray(image)
    if labels.ndim != 2 or not np.issubdtype(labels.dtype, np.integer):
        raise ValueError(f"image: shape {labels.shape} of {labels.dtype}; give whole numbers of shape (rows, columns)")
    if not (np.isfinite(um_per_pixel) and um_per_pixel > 0):
        raise ValueError(f"um_per_pixel: {um_per_pixel}; give the size of a pixel in µm, above 0")
    measure = needed("skimage.measure", "polygons of labels")
    # Labels from 1, 0 for background, and a frame with its own label around the image.
    names, numbers = np.unique(labels, return_inverse=True)
    numbers = numbers.reshape(labels.shape) + 1
    numbers[labels == background] = 0
    numbers = _without_gaps(numbers, gap_px)
    outside = len(names) + 1
    padded = np.pad(numbers, 1, constant_values=outside)
    places, of_label = _junctions(padded, measure)
    cut = {0, outside}
    if not keep_cut:
        for rim in (numbers[0], numbers[-1], numbers[:, 0], numbers[:, -1]):
            cut.update(rim.tolist())
    faces: list[list[int]] = []
    kept: list[int] = []
    for region in measure.regionprops(padded):
        vertices = of_label.get(region.label, [])
        if region.label in cut or len(vertices) < 3:
            continue
        faces.append(_in_order(region, places, vertices, names[region.label - 1], measure))
        kept.append(int(names[region.label - 1]))
    if not faces:
        raise ValueError("image: no cell has three corners where three labels meet; give a label image without gaps of more "
                         f"than {2 * gap_px} pixels between cells, or change gap_px or keep_cut")
    used, renumbered = np.unique(np.concatenate(faces), return_inverse=True)
    ends = np.cumsum([len(face) for face in faces])[:-1]
    rows, columns = places[used].T
    points = um_per_pixel * np.column_stack([columns - 1, labels.shape[0] - rows, np.zeros(len(used))])
    return Polygons(points, np.split(renumbered, ends), {"label": np.array(kept)})


def _without_gaps(numbers: NDArray[Any], gap_px: int) -> NDArray[Any]:
    """Assign background between cells, but not outside the tissue, to the nearest cell."""
    if gap_px <= 0 or not (numbers == 0).any():
        return numbers
    grown: NDArray[Any] = needed("skimage.segmentation", "polygons of labels").expand_labels(numbers, distance=gap_px)
    if (grown == 0).any():
        far = needed("scipy.ndimage", "polygons of labels").distance_transform_edt(grown != 0)
        grown[(numbers == 0) & (far <= gap_px)] = 0
    return grown


def _junctions(padded: NDArray[Any], measure: Any) -> tuple[NDArray[np.float64], dict[int, list[int]]]:
    """Return the points where three or more labels meet, by row and column, and those of each label."""
    windows = np.stack([padded[:-1, :-1], padded[:-1, 1:], padded[1:, :-1], padded[1:, 1:]])
    in_order = np.sort(windows, axis=0)
    meets = 1 + (np.diff(in_order, axis=0) != 0).sum(axis=0) >= 3
    groups, count = measure.label(meets, connectivity=2, return_num=True)
    rows, columns = np.nonzero(groups)
    members = groups[rows, columns] - 1
    size = np.bincount(members, minlength=count)
    places = np.column_stack([np.bincount(members, weights=at + 0.5, minlength=count) / size for at in (rows, columns)])
    found: dict[int, set[int]] = {}
    for member, labels in zip(members.tolist(), windows[:, rows, columns].T.tolist()):
        for label in labels:
            found.setdefault(label, set()).add(member)
    return places, {label: sorted(vertices) for label, vertices in found.items()}


def _in_order(region: Any, places: NDArray[np.float64], vertices: list[int], name: Any, measure: Any) -> list[int]:
    """Return the vertices of a cell along its outline, counter-clockwise with y upwards."""
    outlines = measure.find_contours(np.pad(region.image, 1).astype(float), 0.5, fully_connected="high")
    if len(outlines) != 1:
        raise ValueError(f"image: cell {name} has {len(outlines)} outlines: it is in several pieces, or has a hole; correct the "
                         "labels, by skimage.morphology.remove_small_objects for instance")
    outline = outlines[0] + np.array(region.bbox[:2]) - 1
    nearest = [int(np.argmin(((outline - places[vertex]) ** 2).sum(axis=1))) for vertex in vertices]
    ordered = [vertex for _, vertex in sorted(zip(nearest, vertices))]
    rows, columns = places[ordered].T
    turns = float((columns * np.roll(rows, -1) - np.roll(columns, -1) * rows).sum())
    return ordered if turns < 0 else ordered[::-1]
