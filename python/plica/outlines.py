"""Cells as polygons, from outlines that were traced one by one."""
from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number_from
from .errors import FileError, needed
from .label_repair import openings, without_gaps
from .labels import OPEN_WALLS, open_walls, traced, without_slivers
from .polygons import Polygons, check_keep, one_piece, parted

__all__ = ["polygons_of_outlines"]

PIXELS = 50           # across a usual cell, in the image on which outlines meet
MOST_PIXELS = 4e7
USUAL_TOLERANCE = 0.2  # of the size of a usual cell
LARGEST_OVERLAP = 0.5  # of a cell; more of it within another means that one cell was traced twice
WIDER = (1.25, 1.5, 2, 3, 4)  # tolerances that are tried, to advise one
THIN_OUTLINE = "outlines: outline {} is too thin or winding for corners with its neighbours; omit or correct it"
TOLD = 0.005           # of the tissue's area: smaller repairs are within the accuracy


class Outline(NamedTuple):
    """Corners of a cell, shape (n, 2), its place in the source, from 0, and its numbers by name."""

    ring: NDArray[np.float64]
    place: int
    numbers: dict[str, float]


def polygons_of_outlines(
    outlines: Union[str, os.PathLike[str], Mapping[str, Any], Iterable[ArrayLike]],
    um_per_unit: float = 1.0,
    *,
    tolerance_um: Optional[float] = None,
    y_down: bool = True,
    keep: str = "all",
) -> Polygons:
    """Return cells that share their corners, from outlines that were traced one by one.

    Parameters
    ----------
    outlines : path, mapping or iterable of array_like of shape (n, 2)
        GeoJSON file of QuPath or Baysor, its content, or x and y of the corners of each cell.
    um_per_unit : float
        Unit of the coordinates, µm; for QuPath, the size of a pixel.
    tolerance_um : float, optional
        Widest gap between neighbours that is closed, µm; a fifth of the size of a usual cell if omitted.
    y_down : bool
        Whether y points down, seen from the apical side, as in images. The result has y upwards, and the same x.
    keep : str
        ``"largest"`` omits cells that share no edge with the largest piece of tissue; with ``"all"``, pieces are an error.

    Returns
    -------
    Polygons
        Cells with corners where three of them meet, and straight edges, accurate to 2 % of the size of a cell; z = 0.
        `cell_data` has ``label``, the place of each in the source, from 0, and numbers that all cells have in the file, with
        ``_`` for what is no letter or digit in a name.

    Warns
    -----
    UserWarning
        If overlaps were divided, gaps were closed, or arrays and parts of cells were omitted.

    Raises
    ------
    FileError
        If the file cannot be read, or is no GeoJSON of polygons.
    ValueError
        If an outline has fewer than three corners, lies mostly within others, or cells are in pieces.

    Examples
    --------
    >>> import plica
    >>> left, right = [[0, 0], [9.8, 0], [9.9, 10], [0, 10]], [[10, 0], [20, 0], [20, 10], [10.1, 10]]
    >>> plica.polygons_of_outlines([left, right], tolerance_um=1)  # doctest: +SKIP
    Polygons(2 cells, 6 vertices)
    """
    um_per_unit = number_from(um_per_unit, 0, "um_per_unit", "the unit of the coordinates in µm, above 0", above=True)
    check_keep(keep)
    remarks: list[str] = []
    cells = _read(outlines, remarks)
    scale = np.array([1, 1 if y_down else -1]) * um_per_unit
    rings = [cell.ring * scale for cell in cells]
    size = float(np.sqrt(np.median([_area(ring) for ring in rings])))
    tolerance = USUAL_TOLERANCE * size if tolerance_um is None else number_from(tolerance_um, 0, "tolerance_um", "a width in µm, 0 or more")
    drawn = _drawn(rings, size / PIXELS, tolerance, remarks, [cell.place for cell in cells])
    gap_px = tolerance / drawn.pixel / 2
    closed = without_gaps(drawn.numbers, gap_px, [])
    if open_walls(drawn.numbers, closed, gap_px) > OPEN_WALLS:
        raise ValueError(f"outlines: gaps between neighbours are wider than tolerance_um = {tolerance:.3g}{_advice(drawn, tolerance)}")
    filled = ((closed > 0) & (drawn.numbers == 0)).sum() / (closed > 0).sum()
    if filled > TOLD:
        remarks.append(f"gaps of up to {tolerance:.3g} µm between neighbours, {100 * filled:.0f} % of the area, were closed")
    opened = openings(closed)
    if len(opened):
        x, y = drawn.pixel * opened[0, 1::-1] + drawn.origin
        remarks.append(f"openings in the tissue: {len(opened)}, the largest of {opened[0, 2] * drawn.pixel**2:.3g} µm² at x = {x:.4g}, "
                       f"y = {-y:.4g} µm; add missing cells, or, if these are gaps, raise tolerance_um, now {tolerance:.3g}")
    thin: list[str] = []
    polygons = without_slivers(closed, True, np.array([cell.place for cell in cells]), thin, THIN_OUTLINE)[1]
    if thin:
        remarks.append(f"{len(thin)} that are too thin for corners of their own were given to their neighbours")
    polygons.points = polygons.points * drawn.pixel + [drawn.origin[0], -drawn.origin[1], 0]
    _take_numbers(polygons, cells, remarks)
    polygons = one_piece(polygons, keep, "outlines", lambda: _advice(drawn, tolerance))
    parted(polygons, drawn.pixel)
    for remark in remarks:
        warnings.warn(f"outlines: {remark}", stacklevel=2)
    return polygons


def _area(ring: NDArray[np.float64]) -> float:
    x, y = ring.T
    return 0.5 * abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()))


class Drawn(NamedTuple):
    """Image of numbered cells without overlaps, the size of a pixel, µm, and the place of the first one."""

    numbers: NDArray[np.int64]
    pixel: float
    origin: NDArray[np.float64]


def _advice(drawn: Drawn, tolerance: float) -> str:
    """Return as a remedy a tolerance that makes the cells one tissue, if there is one."""
    for wider in (factor * tolerance for factor in WIDER):
        closed = without_gaps(drawn.numbers, wider / drawn.pixel / 2, [])
        if traced(closed, True).pieces.max() == 0 and open_walls(drawn.numbers, closed, wider / drawn.pixel / 2) <= OPEN_WALLS:
            return f"; set tolerance_um = {wider:.3g}"
    return ""


def _drawn(rings: list[NDArray[np.float64]], pixel: float, tolerance: float, remarks: list[str], places: list[int]) -> Drawn:
    draw, ndimage = needed("skimage.draw", "polygons of outlines"), needed("scipy.ndimage", "polygons of outlines")
    corners = np.concatenate(rings)
    origin = corners.min(axis=0) - tolerance - 3 * pixel
    columns, rows = np.ceil((corners.max(axis=0) + tolerance + 3 * pixel - origin) / pixel).astype(int)
    if rows * columns > MOST_PIXELS:
        raise ValueError(f"outlines: {len(rings)} cells of {pixel * PIXELS:.3g} µm lie in {columns * pixel:.4g} by {rows * pixel:.4g} µm; "
                         "give those of a part of the tissue, of at most about 10 000 cells")
    insides = [draw.polygon(*((ring - origin) / pixel).T[::-1], shape=(rows, columns)) for ring in rings]
    claims = np.zeros((rows, columns), dtype=np.int64)
    numbers = np.zeros_like(claims)
    for number, inside in enumerate(insides, 1):
        claims[inside] += 1
        numbers[inside] = number
    covered = np.array([(claims[inside] > 1).mean() if inside[0].size else 0 for inside in insides])
    _refuse_twice(insides, covered, places, claims.shape)
    nearest = ndimage.distance_transform_edt(claims != 1, return_distances=False, return_indices=True)
    if (claims > 1).sum() > TOLD * (claims > 0).sum():
        remarks.append(f"{(covered > 0.01).sum()} of {len(rings)} overlap others, by at most {100 * covered.max():.0f} % of their area; "
                       "overlaps were divided")
    return Drawn(np.where(claims > 1, numbers[tuple(nearest)], numbers), pixel, origin)


def _refuse_twice(insides: list[Any], covered: NDArray[np.float64], places: list[int], shape: tuple[int, ...]) -> None:
    """Raise ValueError where most of an outline lies within one other."""
    for suspect in np.flatnonzero(covered > LARGEST_OVERLAP):
        mask = np.zeros(shape, dtype=bool)
        mask[insides[suspect]] = True
        shares = np.array([mask[inside].sum() for inside in insides]) / mask.sum()
        shares[suspect] = 0
        if shares.max() > LARGEST_OVERLAP:
            raise ValueError(f"outlines: outline {places[suspect]} lies within outline {places[int(shares.argmax())]} to "
                             f"{100 * shares.max():.0f} % of its area; omit one of them")


def _take_numbers(polygons: Polygons, cells: list[Outline], remarks: list[str]) -> None:
    """Give polygons the place and the numbers of their outlines."""
    kept = [cells[number - 1] for number in polygons.cell_data["label"]]
    polygons.cell_data["label"] = np.array([cell.place for cell in kept])
    names = dict.fromkeys(name for cell in kept for name in cell.numbers)
    whole = [name for name in names if all(np.isfinite(cell.numbers.get(name, np.nan)) for cell in kept)]
    polygons.cell_data.update({name: np.array([cell.numbers[name] for cell in kept]) for name in whole})
    if len(whole) < len(names):
        without = next(name for name in names if name not in whole)
        remarks.append(f"{len(names) - len(whole)} arrays, such as {without}, lack the number of a cell and were omitted")


def _read(source: Any, remarks: list[str]) -> list[Outline]:
    """Return the outlines of a source. Those of a file without an area are omitted; others are refused."""
    name = "outlines"
    if isinstance(source, (str, os.PathLike)):
        name = os.fspath(source)
        try:
            source = json.loads(Path(source).read_text(encoding="utf-8-sig"))
        except (OSError, ValueError) as error:
            raise FileError(f"{name}: is no GeoJSON: {error}; of other formats, make GeoJSON by geopandas or QuPath") from error
    is_geojson = isinstance(source, Mapping) or (isinstance(source, list) and source and isinstance(source[0], Mapping))
    try:
        cells = list(_of_geojson(source, remarks)) if is_geojson else [
            Outline(np.array(ring, dtype=np.float64), place, {}) for place, ring in enumerate(source)]
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{name}: no outlines: {error}; give x and y of corners, or GeoJSON of type Polygon or MultiPolygon") from error
    flat = [cell for cell in cells if cell.ring.ndim != 2 or cell.ring.shape[1] != 2 or not np.isfinite(cell.ring).all()
            or len(np.unique(cell.ring, axis=0)) < 3 or _area(cell.ring) == 0]
    if is_geojson and flat:
        remarks.append(f"{len(flat)} have fewer than three corners, or no area, and were omitted, the first at place {flat[0].place}")
        cells = [cell for cell in cells if not any(cell is one for one in flat)]
    elif flat:
        raise ValueError(f"{name}: outline {flat[0].place} has shape {flat[0].ring.shape}; give finite x and y of three or more corners around an area")
    if not cells:
        raise ValueError(f"{name}: no outlines; give x and y of corners, or GeoJSON of type Polygon or MultiPolygon")
    return cells


def _of_geojson(content: Any, remarks: list[str]) -> Iterator[Outline]:
    """Yield the polygons of a FeatureCollection, a list of features, or a GeometryCollection; of QuPath, cells and detections."""
    features = content if isinstance(content, list) else content.get("features", content.get("geometries", [content]))
    kinds = [_properties(feature).get("objectType", _properties(feature).get("object_type", "")) for feature in features]
    are_cells = [kind in ("cell", "detection", "tile") for kind in kinds]
    parts = 0
    for place, feature in enumerate(features):
        geometry = feature.get("geometry", feature) or {}
        if (any(are_cells) and not are_cells[place]) or geometry.get("type") not in ("Polygon", "MultiPolygon"):
            continue
        polygons = geometry["coordinates"] if geometry["type"] == "MultiPolygon" else [geometry["coordinates"]]
        rings = [np.array([corner[:2] for corner in polygon[0]], dtype=np.float64).reshape(-1, 2) for polygon in polygons if polygon]
        parts += len(rings) > 1
        yield Outline(max(rings, key=_area, default=np.empty((0, 2))), place, _numbers_of(feature))
    if parts:
        remarks.append(f"{parts} have several parts, of which the largest was kept")


def _properties(feature: Mapping[str, Any]) -> Mapping[str, Any]:
    return feature.get("properties") or {}


def _numbers_of(feature: Mapping[str, Any]) -> dict[str, float]:
    """Return numbers among the properties and measurements of a feature, by names of one word."""
    found = {**_properties(feature), **({"cell": feature["cell"]} if "cell" in feature else {})}
    measured = found.pop("measurements", None) or {}
    if isinstance(measured, list):  # before QuPath 0.4
        measured = {one["name"]: one["value"] for one in measured}
    return {"_".join("".join(c if c.isalnum() else " " for c in name).split()): float(value)
            for name, value in {**found, **measured}.items() if isinstance(value, (int, float)) and not isinstance(value, bool)}
