"""Cells as polygons, from tyssue's three-dimensional monolayers."""
from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from .errors import FileError, needed
from .polygons import Polygons
from .prisms import PrismTissue

if TYPE_CHECKING:
    import pandas

__all__ = ["polygons_of_monolayer", "tissue_of_monolayer"]

TABLES = ("vert", "edge", "face")


def polygons_of_monolayer(source: Union[str, os.PathLike[str], Mapping[str, pandas.DataFrame], Any]) -> Polygons:
    """Return the apical faces and the heights of a monolayer of tyssue.

    Parameters
    ----------
    source : path, mapping of str to pandas.DataFrame, or tyssue.Monolayer
        HDF5 file of tyssue's ``save_datasets`` (needs PyTables), its tables ``vert``, ``edge`` and ``face``, or the monolayer.

    Returns
    -------
    Polygons
        Apical faces, counter-clockwise seen from outside the cells. `cell_data` has ``label``, the cell, and ``height``, the
        distance from the centre of its apical face to that of its basal one, for ``embryo.cell_height_array``. Cells with
        ``is_alive`` 0 are omitted.

    Raises
    ------
    FileError
        If the file cannot be read, or lacks a table.
    ValueError
        If tables lack a column, or a cell has not one apical and one basal face, each a ring of edges.

    Examples
    --------
    >>> plica.polygons_of_monolayer("monolayer.hf5").write("cells.ply")  # doctest: +SKIP
    """
    points, apical, basal, _ = _sides(source)
    up = [points[apical[cell]].mean(axis=0) - points[basal[cell]].mean(axis=0) for cell in apical]
    surface = Polygons(points, apical.values(), {"label": np.array(list(apical)), "height": np.linalg.norm(up, axis=1)})
    outward = [_normal(points[face]) @ way for face, way in zip(surface.faces, up)]
    if sum(outward) < 0:  # rings of tyssue run alike
        surface.faces = [face[::-1] for face in surface.faces]
    return surface.select(np.ones(len(surface), dtype=bool))


def tissue_of_monolayer(source: Union[str, os.PathLike[str], Mapping[str, pandas.DataFrame], Any]) -> PrismTissue:
    """Return the cells of a monolayer of tyssue as prisms, with the apical and basal corners that it has.

    Parameters
    ----------
    source : path, mapping of str to pandas.DataFrame, or tyssue.Monolayer
        As for `polygons_of_monolayer`.

    Returns
    -------
    PrismTissue
        `cell_data` has ``label``, the cell.

    Raises
    ------
    FileError, ValueError
        As `polygons_of_monolayer`; ValueError also if an apical corner is joined to no basal corner of its cell, or to two.

    Examples
    --------
    >>> scenario = plica.Scenario({"format": 1}, tissue=plica.tissue_of_monolayer("monolayer.hf5"))  # doctest: +SKIP
    """
    points, apical, basal, joined = _sides(source)
    below: dict[int, int] = {}
    for cell, ring in apical.items():
        for vertex in ring:
            ends = sorted(joined.get(vertex, set()) & {*basal[cell]})
            if len(ends) != 1 or below.setdefault(vertex, ends[0]) != ends[0]:
                raise ValueError(f"monolayer: the apical vertex in row {vertex}, of cell {cell} is joined to basal vertices {ends}; each needs an edge "
                                 "of a lateral face to one, the same for neighbours")
    columns = np.array(sorted(below))
    rings = []
    for cell, ring in apical.items():
        up = points[ring].mean(axis=0) - points[[below[vertex] for vertex in ring]].mean(axis=0)
        rings.append(np.searchsorted(columns, ring if _normal(points[ring]) @ up > 0 else ring[::-1]))
    return PrismTissue(points[columns], points[[below[vertex] for vertex in columns.tolist()]], rings,
                       cell_data={"label": np.array(list(apical), dtype=np.float64)})


def _sides(source: Any) -> tuple[Any, dict[Any, list[int]], dict[Any, list[int]], dict[int, set[int]]]:
    """Return points, the apical and the basal ring of each cell, and the vertices joined to each by edges."""
    tables = _tables(source)
    vertices, edges, faces = (tables[name] for name in TABLES)
    for name, columns in zip(TABLES, (["x", "y", "z"], ["srce", "trgt", "face", "cell"], ["segment"])):
        lacking = [column for column in columns if column not in tables[name]]
        if lacking:
            raise ValueError(f"monolayer: table {name} has no column {', '.join(lacking)}; give a tyssue Monolayer; of a sheet, "
                             "embryo.file reads the HDF5 file itself")
    if "is_alive" in faces:
        faces = faces[faces["is_alive"] != 0]
    number = {vertex: row for row, vertex in enumerate(vertices.index)}
    points = vertices[["x", "y", "z"]].to_numpy(dtype=np.float64)
    rings: dict[str, dict[Any, list[int]]] = {"apical": {}, "basal": {}}
    for face, of_face in edges.groupby("face"):
        segment = faces["segment"].get(face)
        if segment in rings:
            cell = of_face["cell"].iloc[0]
            if cell in rings[segment]:
                raise ValueError(f"monolayer: cell {cell} has two {segment} faces; one is required")
            rings[segment][cell] = _ring(dict(zip(of_face["srce"], of_face["trgt"])), len(of_face), face, number)
    apical, basal = rings["apical"], rings["basal"]
    alone = sorted(set(apical) ^ set(basal))
    if alone or not apical:
        which = f"cell {alone[0]} has no {'basal' if alone[0] in apical else 'apical'} face" if alone else "no face is apical"
        raise ValueError(f"monolayer: {which}; each cell needs one of each segment, \"apical\" and \"basal\"")
    joined: dict[int, set[int]] = {}
    for one, other in zip(edges["srce"], edges["trgt"]):
        if one in number and other in number:
            joined.setdefault(number[one], set()).add(number[other])
            joined.setdefault(number[other], set()).add(number[one])
    return points, apical, basal, joined


def _normal(corners: Any) -> Any:
    return np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)


def _ring(after: dict[Any, Any], count: int, face: Any, number: dict[Any, int]) -> list[int]:
    """Return the vertices along the edges of a face."""
    start = vertex = next(iter(after))
    ring: list[int] = []
    while len(ring) < count and vertex in after and vertex in number:
        ring.append(number[vertex])
        vertex = after[vertex]
    if len(ring) != count or len(after) != count or vertex != start or len(set(ring)) != count:
        raise ValueError(f"monolayer: the {count} edges of face {face} do not form one ring; correct its srce and trgt")
    return ring


def _tables(source: Any) -> Mapping[str, Any]:
    if isinstance(source, (str, os.PathLike)):
        pandas = needed("pandas", "reading a monolayer")
        needed("tables", f"reading {Path(source).name}")
        try:
            return {name: pandas.read_hdf(source, name) for name in TABLES}
        except (OSError, KeyError, ValueError, RuntimeError) as error:
            why = str(error).strip().split("\n")[-1]
            raise FileError(f"{os.fspath(source)}: is no HDF5 file with tables {', '.join(TABLES)}: {why}; write it by tyssue's "
                            "save_datasets") from error
    tables: Mapping[str, Any] = getattr(source, "datasets", source)
    lacking = [name for name in TABLES if not isinstance(tables, Mapping) or not hasattr(tables.get(name), "groupby")]
    if lacking:
        raise ValueError(f"monolayer: there is no table {', '.join(lacking)}; give a file, tables {', '.join(TABLES)}, or a tyssue Monolayer")
    return tables
