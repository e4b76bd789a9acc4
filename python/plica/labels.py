"""Cells as polygons, from a label image."""
from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number, number_from
from .errors import needed
from .label_images import LabelImage, numbered
from .label_repair import SMALL, given_away, openings, repaired, without_gaps
from .polygons import Polygons, check_keep, one_piece, parted, too_small

__all__ = ["polygons_of_labels"]

RIM_TOLERANCE = 0.1  # of the root of a cell's area: how far its free outline may be from the edges that replace it
OPEN_WALLS = 0.3     # share of walls; more of them left open are an error
FURTHER_PX = 8       # gaps of up to twice this width more are tried, to advise one
THIN_CELL = ("image: cell {} is too thin or winding for corners with its neighbours; correct it, or smooth all: "
             "skimage.filters.rank.majority(image.astype(\"uint16\"), skimage.morphology.disk(2))")


def polygons_of_labels(
    image: ArrayLike,
    um_per_pixel: float,
    *,
    background: int = 0,
    gap_px: float = 2,
    keep_cut: bool = False,
    keep: str = "all",
) -> Polygons:
    """Return the polygons of a label image, with straight edges between points where three labels meet.

    Parameters
    ----------
    image : array_like of int, shape (rows, columns)
        Label image: cell number of each pixel, seen from the apical side. Also an image of two values, with lines between cells
        (Tissue Analyzer), in one channel or three equal ones.
    um_per_pixel : float
        Pixel size, µm.
    background : int
        Label of pixels outside all cells.
    gap_px : float
        Background lines between cells, up to twice this width, are assigned to the nearest cells; 0: none.
    keep_cut : bool
        Whether to keep cells cut by the border of the image.
    keep : str
        ``"largest"`` omits cells that share no edge with the largest piece of tissue; with ``"all"``, pieces are an error.

    Returns
    -------
    Polygons
        Polygons with x to the right, y upwards, z = 0, and the origin at the centre of the lower left pixel. `cell_data`
        has the ``label`` of each. Edges without a neighbour follow the outline within a tenth of the cell's size. Cells with
        fewer than three corners are omitted.

    Warns
    -----
    UserWarning
        If small pieces and holes of cells were given to their surroundings, or lines were taken for outlines.

    Raises
    ------
    ValueError
        If the image has the wrong shape or type, a cell is in pieces of similar size or contains another cell, gaps are wider than
        `gap_px` closes, the tissue is in pieces, or no cell has three corners.

    Examples
    --------
    >>> import numpy as np, plica
    >>> rows, columns = np.mgrid[:60, :60]
    >>> labels = 1 + (rows // 20) * 3 + (columns + 10 * (rows // 20 % 2)) // 20
    >>> plica.polygons_of_labels(labels, um_per_pixel=0.5)  # doctest: +SKIP
    Polygons(1 cells, 6 vertices)
    """
    um_per_pixel = number_from(um_per_pixel, 0, "um_per_pixel", "the size of a pixel in µm, above 0", above=True)
    gap_px = number_from(gap_px, 0, "gap_px", "a width in pixels, 0 or more")
    number(background, "background", "one label")
    check_keep(keep)
    given = numbered(image, background)
    repairs: list[str] = []
    closed = repaired(given.numbers, given.names, gap_px, keep_cut, repairs)
    closed, polygons = without_slivers(closed, keep_cut, given.names, repairs, THIN_CELL)
    if open_walls(given.numbers, closed, gap_px) > OPEN_WALLS:
        raise ValueError(f"image: lines of background remain between cells: they are wider than {2 * gap_px:g} pixels"
                         f"{_advice(given, gap_px, keep_cut, 0.5)}")
    if len(polygons) == 0:
        raise ValueError("image: no cell has three corners where three cells meet"
                         f"{_advice(given, gap_px, keep_cut, 0.5) or '; give a label image of more cells, or set keep_cut = True'}")
    polygons.cell_data["label"] = given.names[polygons.cell_data["label"] - 1]
    polygons = one_piece(polygons, keep, "image", lambda: _advice(given, gap_px, keep_cut, 1))
    if count := parted(polygons, 1.0):
        given.remarks.append(f"image: cells that met at a point only were parted there by a pixel, at {count} places")
    if repairs:
        more = f", and {len(repairs) - 3} more" if len(repairs) > 3 else ""
        given.remarks.append(f"image: given to their surroundings: {', '.join(repairs[:3])}{more}")
    opened = openings(closed)
    if len(opened):
        row, column, size = opened[0]
        given.remarks.append(f"image: openings in the tissue: {len(opened)}, the largest of {size} pixels at row {row}, column {column}; "
                             f"label missing cells, or, if these are gaps, raise gap_px, now {gap_px:g}")
    for remark in given.remarks:
        warnings.warn(remark, stacklevel=2)
    polygons.points = um_per_pixel * (polygons.points + [0, len(closed) - 1, 0])
    return polygons


def without_slivers(closed: NDArray[Any], keep_cut: bool, names: NDArray[Any],
                    repairs: list[str], refusal: str) -> tuple[NDArray[Any], Polygons]:
    """Return numbers and polygons without cells that are too thin for their corners to be told apart. Large ones are refused."""
    polygons = traced(closed, keep_cut)
    while (slivers := too_small(polygons)).any():
        thin = polygons.cell_data["label"][slivers]
        sizes = np.bincount(closed.ravel(), minlength=len(names) + 1)
        large = thin[sizes[thin] > SMALL * np.median(sizes[1:][sizes[1:] > 0])]
        if len(large):
            raise ValueError(refusal.format(names[large[0] - 1]))
        for cell in thin:
            row, column = np.argwhere(closed == cell)[0]
            repairs.append(f"cell {names[cell - 1]} ({sizes[cell]} pixels at row {row}, column {column})")
        closed = given_away(closed, np.isin(closed, thin))
        polygons = traced(closed, keep_cut)
    return closed, polygons


def _advice(given: LabelImage, gap_px: float, keep_cut: bool, share: float) -> str:
    """Return as a remedy the smallest gap_px that makes at least this share of cells one tissue, if there is one."""
    label = needed("skimage.measure", "polygons of labels").label
    widest = min(2 * int(gap_px) + FURTHER_PX, max(given.numbers.shape))
    for wider in range(int(gap_px) + 1, widest + 1):
        try:
            closed = repaired(given.numbers, given.names, wider, keep_cut, [])
            if share == 1 and label(closed > 0, connectivity=1).max() > 1:
                continue
            polygons = traced(closed, keep_cut)
        except ValueError:
            continue
        joined = len(polygons) > 1 and (polygons.pieces == 0).mean() >= share
        if joined and open_walls(given.numbers, closed, wider) <= OPEN_WALLS:
            return f"; set gap_px = {wider}"
    return ""


def open_walls(given: NDArray[Any], closed: NDArray[Any], gap_px: float) -> float:
    """Return the share of walls between cells that closing wider gaps would close."""
    if not (closed == 0).any():
        return 0.0
    margin = int(2 * gap_px + 2)  # lines that end at the border stay open there
    within = (slice(margin, -margin), slice(margin, -margin))
    narrow, wide = closed[within], without_gaps(given, 2 * gap_px + 1, [])[within]

    def sides(numbers: NDArray[Any]) -> list[NDArray[Any]]:
        return [(numbers == 0)[1:] != (numbers == 0)[:-1], (numbers == 0)[:, 1:] != (numbers == 0)[:, :-1]]

    opened = sum(float(side.sum()) for side in sides(narrow)) - sum(float(side.sum()) for side in sides(wide))
    pairs = ((wide[1:], wide[:-1]), (wide[:, 1:], wide[:, :-1]))
    walls = sum(float(((one != other) & (one > 0) & (other > 0)).sum()) for one, other in pairs)
    return opened / 2 / max(walls, 1.0)


def traced(numbers: NDArray[Any], keep_cut: bool) -> Polygons:
    """Return the polygons of numbered cells, in pixels: x along columns, y against rows. ``label`` is the number of each."""
    measure = needed("skimage.measure", "polygons of labels")
    outside = int(numbers.max()) + 1  # a frame around the image
    padded = np.pad(numbers, 1, constant_values=outside)
    corners, of_label = _junctions(padded, measure)
    cut = set() if keep_cut else set(np.concatenate([numbers[0], numbers[-1], numbers[:, 0], numbers[:, -1]]).tolist())
    faces: list[list[int]] = []
    kept: list[int] = []
    for region in measure.regionprops(padded):
        if region.label in cut or region.label == outside:
            continue
        face = _face(region, padded, of_label.get(region.label, []), corners, measure)
        if len(face) >= 3:
            faces.append(face)
            kept.append(int(region.label))
    rows, columns = np.reshape(corners, (-1, 2)).T - 1
    points = np.column_stack([columns, -rows, np.zeros(len(rows))])
    return Polygons(points, faces, {"label": np.array(kept, dtype=np.int64)}).select(np.ones(len(faces), dtype=bool))


def _junctions(padded: NDArray[Any], measure: Any) -> tuple[list[NDArray[np.float64]], dict[int, list[int]]]:
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
    return list(places), {label: sorted(vertices) for label, vertices in found.items()}


def _face(region: Any, padded: NDArray[Any], vertices: list[int], corners: list[NDArray[np.float64]], measure: Any) -> list[int]:
    """Return the corners of a cell, counter-clockwise with y upwards. Bends of its free outline are appended to `corners`."""
    outlines = measure.find_contours(np.pad(region.image, 1).astype(float), 0.5, fully_connected="high")
    outline = max(outlines, key=len)[:-1] + region.bbox[:2] - 1
    stops = sorted((int(np.argmin(((outline - corners[vertex]) ** 2).sum(axis=1))), vertex) for vertex in vertices)
    # Points of an outline lie between a pixel of the cell and one of a neighbour.
    sides = [padded[tuple(side(outline).astype(int).T)] for side in (np.floor, np.ceil)]
    free = np.isin(np.where(sides[0] == region.label, sides[1], sides[0]), (0, padded[0, 0]))
    if free.any():
        while len(stops) < 2:  # of a cell with at most one neighbour
            origin = outline[stops[0][0]] if stops else outline.mean(axis=0)
            farthest = int(np.argmax(((outline - origin) ** 2).sum(axis=1)))
            stops = sorted([*stops, (farthest, len(corners))])
            corners.append(outline[farthest])
    inward = -np.sign((outline[:, 0] * np.roll(outline[:, 1], -1) - np.roll(outline[:, 0], -1) * outline[:, 1]).sum())
    face: list[int] = []
    for number, (start, vertex) in enumerate(stops):
        face.append(vertex)
        end = stops[number + 1][0] if number + 1 < len(stops) else stops[0][0] + len(outline)
        between = np.arange(start, end) % len(outline)
        if len(between) and free[between].mean() > 0.5:
            bends = _bends(outline[np.append(between, end % len(outline))], max(1.5, RIM_TOLERANCE * region.area**0.5), inward, measure)
            face += range(len(corners), len(corners) + len(bends))
            corners += bends
    rows, columns = np.reshape([corners[vertex] for vertex in face], (-1, 2)).T
    turns = float((columns * np.roll(rows, -1) - np.roll(columns, -1) * rows).sum())
    return face if turns < 0 else face[::-1]


def _bends(line: NDArray[np.float64], tolerance: float, inward: float, measure: Any) -> list[NDArray[np.float64]]:
    """Return the inner points of a polyline that keep it within `tolerance`, without those on the way between their neighbours.

    Points at which the cell would be concave are omitted as well: `inward` is the sign of a turn there.
    """
    bends = list(measure.approximate_polygon(line, tolerance))
    number = 1
    while number < len(bends) - 1:
        before, here, after = bends[number - 1:number + 2]
        way = after - before
        turn = inward * (way[0] * (here - before)[1] - way[1] * (here - before)[0])
        if turn < tolerance * np.linalg.norm(way):
            del bends[number]
            number = max(number - 1, 1)
        else:
            number += 1
    return bends[1:-1]
