"""Columns of corners of cells in a volume of labels: rings of the middle height, and places on both sides."""
from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import needed
from .hexahedra import scaled_jacobians
from .voxel_sides import LATERAL, Floats, Sides
from .voxel_surfaces import RIM, Faces, Integers, Meetings, steps_of

FIT_RADIUS = 0.3     # of the width of a cell: planes are fitted to faces up to this far from a corner
FARTHEST_FIT = 2.5   # voxels between a corner and the mean of its voxels; farther, the fit is wrong
THIN_FIT = 0.15      # of the radius: narrower walls count less
LEAST_JACOBIAN = 0.15  # scaled, of the kites of which cells are made
MOST_EVENINGS = 100
EVENING = 0.2        # of the way to an even polygon, at a time
LIKE_MIDDLE = 0.1    # part of the polygon of the middle height in an even one
SETTLING = 0.4      # weight of corners' moves beside the gaps between polygons and labels
CHUNK = 3_000_000    # voxels about corners that are read at once


def parted_meetings(meetings: Meetings, contacts: dict[tuple[int, int], float]) -> Meetings:
    """Return meetings in which four cells meet at two corners, if two of them have a wall."""
    at: list[list[int]] = [[] for _ in meetings.cells]
    for arc, ends in enumerate(meetings.ends.tolist()):
        for end in {*ends} - {-1}:
            at[end].append(arc)
    cells, place = list(meetings.cells), list(meetings.place)
    pairs, ends = meetings.pairs.tolist(), meetings.ends.tolist()
    for corner, about in enumerate(meetings.cells):
        if len(about) != 4 or RIM in about or len(at[corner]) != 4:
            continue
        joined = {tuple(pairs[arc]) for arc in at[corner]}
        across = [pair for pair in combinations(sorted(about), 2) if pair not in joined]
        if len(joined) != 4 or len(across) != 2:
            continue
        wall = max(across, key=lambda pair: contacts.get(pair, 0.0))
        if not contacts.get(wall):
            continue
        other = len(cells)
        first, second = (about - {cell} for cell in sorted(about - {*wall}))
        cells[corner] = first
        cells.append(second)
        place.append(meetings.place[corner])
        for arc in at[corner]:
            if not {*pairs[arc]} <= first:
                ends[arc] = [other if end == corner else end for end in ends[arc]]
        pairs.append(list(wall))
        ends.append([corner, other])
    return meetings._replace(cells=cells, place=np.array(place).reshape(-1, 3), pairs=np.array(pairs, dtype=np.int64).reshape(-1, 2),
                             ends=np.array(ends, dtype=np.int64).reshape(-1, 2))


def counterparts(columns: list[frozenset[int]], middles: Floats, meetings: Meetings) -> Integers:
    """Return for each column the corner of a side at which three of its cells meet, the nearest of several; -1: none."""
    of_three: dict[tuple[int, ...], list[int]] = {}
    for corner, cells in enumerate(meetings.cells):
        for three in combinations(sorted(cells), 3):
            of_three.setdefault(three, []).append(corner)
    found = np.full(len(columns), -1)
    for column, cells in enumerate(columns):
        options = [corner for three in combinations(sorted(cells), 3) for corner in of_three.get(three, ())]
        if options:
            found[column] = min(options, key=lambda corner: float(((meetings.place[corner] - middles[column])**2).sum()))
    return found


class _Boxes(NamedTuple):
    """Voxels about corners: numbers of the voxels, and the place of each cell among those of the corner (from 1; 0: background)."""

    voxel: Integers
    local: NDArray[np.int8]
    width: int


def fitted_corners(numbers: NDArray[Any], spacing: Floats, sides: Sides, side: int, columns: list[frozenset[int]], places: Floats,
                   width: float) -> Floats:
    """Return corners where planes of walls, of a side and of the rim meet, by least squares, to parts of a voxel.

    `places` are those of the voxel corners, z, y, x in µm; `width` that of a usual cell.
    """
    radius = max(FIT_RADIUS * width, 1.2 * spacing.max(), 3 * spacing.min())
    half = np.ceil(radius / spacing).astype(np.int64)
    most = max(len(cells) for cells in columns)
    size = max(1, CHUNK // int(np.prod(2 * half)))
    found = places.copy()
    ids = 3 * sides.faces.low + sides.faces.axis
    for start in range(0, len(columns), size):
        chunk = slice(start, start + size)
        box = _box(numbers, spacing, half, columns[chunk], places[chunk], most)
        corner, group, way, area = _faces_about(box, numbers.shape, spacing, ids, sides, side, places[chunk])
        near = (way**2).sum(axis=1) <= radius**2
        found[chunk] += _common_point(corner[near], group[near], way[near], area[near], len(places[chunk]), box.width, radius)
    far = np.abs((found - places) / spacing).max(axis=1) > FARTHEST_FIT
    found[far] = places[far]
    return found


def _box(numbers: NDArray[Any], spacing: Floats, half: Integers, columns: list[frozenset[int]], places: Floats, most: int) -> _Boxes:
    middle = np.round(places / spacing + 0.5).astype(np.int64)
    axes = [np.clip(middle[:, k, None] + np.arange(-half[k], half[k]), 0, numbers.shape[k] - 1) for k in range(3)]
    steps = steps_of(numbers.shape)
    voxel = axes[0][:, :, None, None] * steps[0] + axes[1][:, None, :, None] * steps[1] + axes[2][:, None, None, :]
    label = numbers.reshape(-1)[voxel]
    local = np.where(label == 0, 0, -1).astype(np.int8)
    cells = np.array([(sorted(of) + [RIM] * most)[:most] for of in columns])
    for k in range(most):
        of = cells[:, k]
        local[(label == of[:, None, None, None]) & (of != RIM)[:, None, None, None]] = k + 1
    return _Boxes(voxel, local, most + 1)


def _faces_about(box: _Boxes, shape: tuple[int, ...], spacing: Floats, ids: Integers, sides: Sides, side: int,
                 places: Floats) -> tuple[Integers, Integers, Floats, Floats]:
    """Return corner, group, place from the corner, and area of faces about corners.

    Groups: pairs of places of cells for walls; (0, 1) for faces of the side; (0, 0) for the rim.
    """
    parts = []
    for axis in range(3):
        before, after = [slice(None)] * 4, [slice(None)] * 4
        before[axis + 1], after[axis + 1] = slice(None, -1), slice(1, None)
        one, other = box.local[tuple(before)], box.local[tuple(after)]
        at = np.nonzero((one != other) & (one >= 0) & (other >= 0))
        low = box.voxel[tuple(before)][at]
        smaller, larger = np.minimum(one[at], other[at]).astype(np.int64), np.maximum(one[at], other[at]).astype(np.int64)
        free = smaller == 0
        known = np.searchsorted(ids, 3 * low[free] + axis)
        which = sides.side[np.minimum(known, len(ids) - 1)]
        larger[free] = np.where(which == side, 1, np.where(which == LATERAL, 0, -1))
        middles = np.column_stack(np.unravel_index(low, shape)).astype(np.float64)
        middles[:, axis] += 0.5
        keep = larger >= 0
        parts.append((at[0][keep], (smaller * box.width + larger)[keep], (middles * spacing - places[at[0]])[keep],
                      np.full(int(keep.sum()), np.prod(spacing) / spacing[axis])))
    corner, group, way, area = (np.concatenate(column) for column in zip(*parts))
    return corner, group, way, area


def _common_point(corner: Integers, group: Integers, way: Floats, area: Floats, count: int, width: int, radius: float) -> Floats:
    """Return for each corner the point nearest to the planes through its groups of faces."""
    groups = width * width
    key = corner * groups + group

    def sums(values: Floats) -> Floats:
        return np.bincount(key, weights=area * values, minlength=count * groups).astype(np.float64, copy=False)

    weight = np.bincount(key, weights=area, minlength=count * groups)
    used = np.flatnonzero((np.bincount(key, minlength=count * groups) >= 4) & (weight > 0))
    mean = np.column_stack([sums(way[:, k])[used] for k in range(3)]) / weight[used, None]
    spread = np.empty((len(used), 3, 3))
    for i in range(3):
        for j in range(i, 3):
            spread[:, i, j] = spread[:, j, i] = sums(way[:, i] * way[:, j])[used] / weight[used] - mean[:, i] * mean[:, j]
    values, vectors = np.linalg.eigh(spread)
    normal = vectors[:, :, 0]
    trust = values[:, 1] / (values[:, 1] + (THIN_FIT * radius) ** 2)
    matrix = np.tile(0.02 * np.eye(3), (count, 1, 1))
    right = np.zeros((count, 3))
    at = used // groups
    np.add.at(matrix, at, trust[:, None, None] * normal[:, :, None] * normal[:, None, :])
    np.add.at(right, at, (trust * (normal * mean).sum(axis=1))[:, None] * normal)
    return np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0], dtype=np.float64)


def extended(places: Floats, middles: Floats, joined: Integers) -> Floats:
    """Return places with those that are NaN from the middle, as far and in the direction as neighbouring columns."""
    ways = places - middles
    known: NDArray[np.bool_] = np.logical_and.reduce(np.isfinite(ways), axis=1)
    ways = np.where(known[:, None], ways, 0.0)
    for _ in range(len(places)):
        if known.all():
            break
        sums, number = np.zeros_like(ways), np.zeros(len(ways))
        for one, other in (joined.T, joined.T[::-1]):
            use = known[other]
            np.add.at(sums, one[use], ways[other[use]])
            np.add.at(number, one[use], 1)
        gains = ~known & (number > 0)
        if not gains.any():
            break
        ways[gains] = sums[gains] / number[gains, None]
        known |= gains
    return middles + ways


def summed(groups: Integers, values: Floats, count: int) -> Floats:
    """Return the sums of rows of values by group."""
    return np.column_stack([np.bincount(groups, weights=along, minlength=count).astype(np.float64, copy=False) for along in values.T])


class Evened(NamedTuple):
    """Places of corners on both sides, cells with corners that moved far for that, and those that are no upright prisms nevertheless."""

    first: Floats
    second: Floats
    moved: list[int]
    flawed: list[int]


def evened(first: Floats, second: Floats, middles: Floats, rings: dict[int, list[int]], far_um: float) -> Evened:
    """Return places between which each cell is an upright prism of convex polygons; reports moves above `far_um`.

    Polygons of flawed cells become more like regular, stretched ones, and like those of the middle height.
    """
    sides = [first.copy(), second.copy()]
    kites = _Kites(rings)
    for _ in range(MOST_EVENINGS):
        flawed = kites.least_jacobians(sides[0], sides[1], middles) < LEAST_JACOBIAN
        if not flawed.any():
            break
        chosen = flawed[kites.of]
        corners = kites.corner[chosen]
        number = np.bincount(corners, minlength=len(middles))
        usual = kites.stretched(middles)
        for side in sides:
            target = kites.means(side)[kites.of] + (1 - LIKE_MIDDLE) * kites.stretched(side) + LIKE_MIDDLE * usual
            moves = summed(corners, target[chosen], len(middles))[number > 0] / number[number > 0, None] - side[number > 0]
            side[number > 0] += EVENING * moves
    left = kites.least_jacobians(sides[0], sides[1], middles) <= 0
    moves = np.maximum(np.linalg.norm(sides[0] - first, axis=1), np.linalg.norm(sides[1] - second, axis=1))
    return Evened(sides[0], sides[1], np.unique(kites.cells[kites.of[moves[kites.corner] > far_um]]).tolist(), kites.cells[left].tolist())


class _Kites:
    """Corners of all polygons in one row, with the corners beside them: prisms of kites about each."""

    def __init__(self, rings: dict[int, list[int]]) -> None:
        self.cells = np.array(sorted(rings))
        self.sizes = np.array([len(rings[cell]) for cell in self.cells.tolist()])
        self.of = np.repeat(np.arange(len(self.cells)), self.sizes)
        self.corner = np.concatenate([rings[cell] for cell in self.cells.tolist()])
        start = (np.cumsum(self.sizes) - self.sizes)[self.of]
        self.place = np.arange(len(self.of)) - start
        self.after = start + (self.place + 1) % self.sizes[self.of]
        self.before = start + (self.place - 1) % self.sizes[self.of]

    def means(self, places: Floats) -> Floats:
        """Return the means of the corners of each polygon."""
        means: Floats = summed(self.of, places[self.corner], len(self.cells)) / self.sizes[:, None]
        return means

    def stretched(self, places: Floats) -> Floats:
        """Return corners, from the middle of each polygon, of the nearest stretched regular polygon: the first waves around it."""
        angle = 2 * np.pi * self.place / self.sizes[self.of]
        spokes = places[self.corner] - self.means(places)[self.of]
        found: Floats = np.zeros_like(spokes)
        for wave in (np.cos(angle), np.sin(angle)):
            part = summed(self.of, wave[:, None] * spokes, len(self.cells)) * (2 / self.sizes[:, None])
            found += wave[:, None] * part[self.of]
        return found

    def least_jacobians(self, first: Floats, second: Floats, middles: Floats) -> Floats:
        """Return the least scaled Jacobian of the prisms of kites of each cell."""
        levels = []
        for side in (first, second):
            corner = side[self.corner]
            levels.append((self.means(side)[self.of], (corner + corner[self.before]) / 2, corner, (corner + corner[self.after]) / 2))
        points = np.concatenate([*levels[0], *levels[1]])
        spokes = middles[self.corner] - self.means(middles)[self.of]
        area = summed(self.of, np.cross(spokes, spokes[self.after]), len(self.cells))
        sign = np.sign((area * (self.means(second) - self.means(first))).sum(axis=1))
        nodes = np.arange(8) * len(self.of) + np.arange(len(self.of))[:, None]
        swapped = np.where(sign[self.of, None] > 0, nodes, nodes[:, [0, 3, 2, 1, 4, 7, 6, 5]])
        least: Floats = np.full(len(self.cells), np.inf)
        np.minimum.at(least, self.of, scaled_jacobians(points, swapped))
        return least


def without_idle(rings: dict[int, list[int]]) -> dict[int, list[int]]:
    """Return rings without corners along the common edge of two cells, where both polygons cannot be convex."""
    rings = {cell: list(ring) for cell, ring in rings.items()}
    users: dict[int, list[int]] = {}
    for cell, ring in rings.items():
        for column in ring:
            users.setdefault(column, []).append(cell)
    for column, cells in users.items():
        both = [rings[cell] for cell in cells]
        at = [ring.index(column) for ring in both]
        beside = [{ring[place - 1], ring[(place + 1) % len(ring)]} for ring, place in zip(both, at)]
        if len(cells) == 2 and beside[0] == beside[1] and min(map(len, both)) > 3:
            for ring, place in zip(both, at):
                ring.pop(place)
    return rings


def ring_of(arcs: list[tuple[int, int, int]]) -> list[int]:
    """Return the longest ring of corners along edges (corner, corner, edge)."""
    beside: dict[int, list[tuple[int, int]]] = {}
    for one, other, arc in arcs:
        beside.setdefault(one, []).append((other, arc))
        beside.setdefault(other, []).append((one, arc))
    best: list[int] = []
    for start in beside:
        if best and start in best:
            continue
        paths = [[start]]
        while paths:
            path = paths.pop()
            for corner, _ in beside[path[-1]]:
                if corner == start and len(path) > max(2, len(best)):
                    best = path
                elif corner not in path and corner > start and len(paths) < 500:
                    paths.append([*path, corner])
    return best


def settled(places: Floats, rings: dict[int, list[int]], faces: Faces, middles: Floats, normals: Floats) -> Floats:
    """Return corners moved along the normals of a side, as little as lets its flat polygons enclose the volume that the labels have.

    A polygon with its corners on a bent surface lies within it. `faces` of the side have the given middles and outward area vectors.
    """
    sparse, linear = needed("scipy.sparse", "cells of a volume"), needed("scipy.sparse.linalg", "cells of a volume")
    cells = np.array(sorted(rings))
    span = int(max(cells.max(), faces.cell.max(initial=0))) + 1
    count = np.maximum(np.bincount(faces.cell, minlength=span), 1)
    at, way = (np.column_stack([np.bincount(faces.cell, weights=along, minlength=span) / count for along in values.T])[cells]
               for values in (middles, normals))
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
    sizes = np.array([len(rings[cell]) for cell in cells.tolist()])
    row, column = np.repeat(np.arange(len(cells)), sizes), np.concatenate([rings[cell] for cell in cells.tolist()])
    up = np.zeros_like(places)
    np.add.at(up, column, way[row])
    up /= np.maximum(np.linalg.norm(up, axis=1, keepdims=True), 1e-12)
    mean = sparse.csr_matrix((1 / sizes[row], (row, column)), shape=(len(cells), len(places)))
    gap = ((at - mean @ places) * way).sum(axis=1) * (np.bincount(faces.cell, minlength=span)[cells] > 0)
    move = linear.lsqr(mean, gap, damp=SETTLING)[0]
    return np.asarray(places + move[:, None] * up)
