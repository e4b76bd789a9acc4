"""A layer of cells in a volume of labels: rings of corners at the middle height, and their places on both sides."""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import needed
from .voxel_columns import counterparts, evened, extended, fitted_corners, parted_meetings, ring_of, settled, without_idle
from .voxel_sides import FIRST, SECOND, Floats, Halfway, Sides
from .voxel_surfaces import RIM, Meetings, face_places, meetings_of, places_of, steps_of

BEND = 0.1    # of the width of a cell: free outlines are followed to within this distance


class Layer(NamedTuple):
    """Columns with their places on the first and second side and halfway (z, y, x in µm), and the ring of columns of each cell."""

    first: Floats
    second: Floats
    middle: Floats
    fitted: NDArray[np.bool_]       # by column: whether labels have its corners on both sides
    cells: list[frozenset[int]]     # that meet at each column
    rings: dict[int, list[int]]
    evened: list[int]               # cells whose corners were moved by more than a voxel, to make upright prisms
    flawed: list[int]               # cells that are none nevertheless
    sides: Sides
    meetings: dict[int, Meetings]   # by side; 0: halfway
    width: float                    # of a usual cell, µm
    height: float
    spacing: Floats


def layer_of(numbers: NDArray[Any], sides: Sides, spacing: Floats, volumes: Floats, contacts: dict[tuple[int, int], float]) -> Layer:
    """Return the layer of cells of which some span both sides. The volume has a margin of background, or beyond the image."""
    cells = len(volumes) - 1
    area = np.linalg.norm(sides.normals, axis=1)
    of_cell = np.column_stack([np.bincount(sides.faces.cell[sides.side == side], weights=area[sides.side == side], minlength=cells + 1)
                               for side in (FIRST, SECOND)])
    width = float(np.sqrt(np.median(of_cell[sides.spans].mean(axis=1))))
    height = float(np.median(volumes[1:][volumes[1:] > 0])) / width**2
    halfway = Halfway(sides, numbers.shape, spacing, height).faces(numbers, cells)
    if not len(halfway.low):
        raise ValueError("volume: the layer is one voxel thick, without a middle height; give finer voxels, or, of a flat layer, one plane to "
                         "plica.polygons_of_labels")
    meetings = {side: parted_meetings(meetings_of(faces, numbers.shape, spacing), contacts)
                for side, faces in ((0, halfway), *((side, sides.faces.select(sides.side == side)) for side in (FIRST, SECOND)))}
    columns, rings, bends = _rings(meetings[0], cells, numbers.shape, spacing, width)
    rings = without_idle(rings)
    middle = np.concatenate([meetings[0].place, [bend.place for bend in bends]]) if bends else meetings[0].place
    places = [_on_side(side, numbers, spacing, sides, meetings, columns, bends, middle, width) for side in (FIRST, SECOND)]
    joined = np.array([pair for ring in rings.values() for pair in zip(ring, ring[1:] + ring[:1])], dtype=np.int64).reshape(-1, 2)
    fitted: NDArray[np.bool_] = np.logical_and.reduce(np.isfinite(np.hstack(places)), axis=1)
    middles = face_places(sides.faces, numbers.shape, spacing)
    for number, side in enumerate((FIRST, SECOND)):
        of = sides.side == side
        places[number] = settled(extended(places[number], middle, joined), rings, sides.faces.select(of), middles[of], sides.normals[of])
    even = evened(places[0], places[1], middle, rings, float(np.prod(spacing) ** (1 / 3)))
    return Layer(even.first, even.second, middle, fitted, columns, rings, even.moved, even.flawed, sides, meetings, width, height, spacing)


class _Bend(NamedTuple):
    """Bend of the free outline of a cell: halfway place, part of the way between its ends, and the cells of these."""

    place: Floats
    share: float
    cell: int
    ends: tuple[frozenset[int], frozenset[int]]


def _rings(meetings: Meetings, cells: int, shape: tuple[int, ...], spacing: Floats,
           width: float) -> tuple[list[frozenset[int]], dict[int, list[int]], list[_Bend]]:
    arcs: dict[int, list[tuple[int, int, int]]] = {}
    for arc, (pair, ends) in enumerate(zip(meetings.pairs.tolist(), meetings.ends.tolist())):
        if min(ends) >= 0 and ends[0] != ends[1]:
            for cell in {*pair} - {RIM}:
                arcs.setdefault(cell, []).append((*ends, arc))
    columns, bends = list(meetings.cells), []
    rings: dict[int, list[int]] = {}
    for cell in range(1, cells + 1):
        free = {frozenset((one, other)): arc for one, other, arc in arcs.get(cell, []) if meetings.pairs[arc, 0] == RIM}
        ring = ring_of(arcs.get(cell, [])) or _pair_of(arcs.get(cell, []))
        bent: list[int] = []
        for corner, after in zip(ring, ring[1:] + ring[:1]):
            bent.append(corner)
            gap = free.pop(frozenset((corner, after)), None)
            if gap is None:
                continue
            centre = meetings.place[ring].mean(axis=0)
            line = outline_between(meetings, gap, corner, after, shape, spacing)
            for share in _bends(line, centre, BEND * width):
                bent.append(len(columns))
                columns.append(frozenset((RIM, cell)))
                bends.append(_Bend(line[round(share * (len(line) - 1))], share, cell, (meetings.cells[corner], meetings.cells[after])))
        if len(bent) >= 3:
            rings[cell] = bent
    return columns, rings, bends


def _pair_of(arcs: list[tuple[int, int, int]]) -> list[int]:
    """Return the two corners of a cell that has one neighbour, and a free outline."""
    return sorted({*arcs[0][:2]}) if len(arcs) == 2 and {*arcs[0][:2]} == {*arcs[1][:2]} else []


def outline_between(meetings: Meetings, arc: int, start: int, end: int, shape: tuple[int, ...], spacing: Floats) -> Floats:
    """Return places along an edge from one corner to the other, z, y, x in µm, smoothed."""
    graph, sparse = needed("scipy.sparse.csgraph", "cells of a volume"), needed("scipy.sparse", "cells of a volume")
    points = np.sort(meetings.points[meetings.of_edge == arc])
    places = places_of(points, shape, spacing)
    rows, columns = [], []
    for step in steps_of(shape).tolist():
        at = np.searchsorted(points, points + step)
        beside = np.flatnonzero(points[np.minimum(at, len(points) - 1)] == points + step)
        rows.append(beside)
        columns.append(at[beside])
    row, column = np.concatenate(rows), np.concatenate(columns)
    joined = sparse.coo_matrix((np.ones(len(row)), (row, column)), shape=(len(points), len(points)))
    first = int(np.argmin(((places - meetings.place[start]) ** 2).sum(axis=1)))
    hops = graph.dijkstra(joined, directed=False, unweighted=True, indices=first)
    order = np.argsort(np.where(np.isfinite(hops), hops, -1), kind="stable")
    line = np.concatenate([meetings.place[start, None], places[order], meetings.place[end, None]])
    middle = (line[:-2] + 2 * line[1:-1] + line[2:]) / 4
    return np.concatenate([line[:1], middle, line[-1:]])


def _bends(line: Floats, centre: Floats, tolerance: float) -> list[float]:
    """Return where along a line, from 0 to 1, it bends away from the centre by more than a tolerance."""
    if len(line) < 3:
        return []
    way = line[-1] - line[0]
    along = way / max(float(np.linalg.norm(way)), 1e-9)
    off = line - line[0] - ((line - line[0]) @ along)[:, None] * along
    outward = (line[0] + line[-1]) / 2 - centre
    far = np.linalg.norm(off, axis=1) * np.sign(off @ outward)
    most = int(np.argmax(far))
    if far[most] < tolerance or most in (0, len(line) - 1):
        return []
    share = most / (len(line) - 1)
    before, after = _bends(line[:most + 1], centre, tolerance), _bends(line[most:], centre, tolerance)
    return [*(share * one for one in before), share, *(share + (1 - share) * one for one in after)]


def _on_side(side: int, numbers: NDArray[Any], spacing: Floats, sides: Sides, meetings: dict[int, Meetings], columns: list[frozenset[int]],
             bends: list[_Bend], middle: Floats, width: float) -> Floats:
    """Return the places of columns on a side, NaN where its cells do not meet there."""
    places = np.full((len(columns), 3), np.nan)
    of = meetings[side]
    count = len(columns) - len(bends)
    corner = counterparts(columns[:count], middle, of)
    met = np.flatnonzero(corner >= 0)
    if len(met):
        places[met] = fitted_corners(numbers, spacing, sides, side, [columns[one] for one in met], of.place[corner[met]], width)
    free: dict[tuple[int, frozenset[frozenset[int]]], int] = {}
    for arc in np.flatnonzero(of.pairs[:, 0] == RIM).tolist():
        if of.ends[arc].min() >= 0:
            free[int(of.pairs[arc, 1]), frozenset(of.cells[end] for end in of.ends[arc].tolist())] = arc
    for number, bend in enumerate(bends):
        found = free.get((bend.cell, frozenset(bend.ends)))
        if found is None:
            continue
        start, end = of.ends[found].tolist()
        if of.cells[start] != bend.ends[0]:
            start, end = end, start
        line = outline_between(of, found, start, end, numbers.shape, spacing)
        places[count + number] = line[round(bend.share * (len(line) - 1))]
    return places
