"""Surfaces of voxel faces with a cell each, and the corners and edges where these cells meet.

A face lies between a voxel and the next one along an axis, and has the number of the first ("low") and the axis. Corners of
voxels have the number of the voxel above them. Cells partition a surface exactly, so rings of edges close without tracing.
"""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import needed

Integers = NDArray[np.int64]
PATCH_PASSES = 3
RIM = 0  # in place of a cell, beyond the rim of a surface


class Faces(NamedTuple):
    """Faces of a surface: voxel below, axis, and cell."""

    low: Integers
    axis: Integers
    cell: Integers

    def select(self, chosen: NDArray[Any]) -> Faces:
        """Return some of the faces."""
        return Faces(self.low[chosen], self.axis[chosen], self.cell[chosen])


class Edges(NamedTuple):
    """Edges of faces in order of their ids, each once per face; `first` has the places where an edge begins."""

    ids: Integers    # 3 * lower corner + axis
    face: Integers
    first: Integers


def steps_of(shape: tuple[int, ...]) -> Integers:
    """Return the difference of numbers of neighbours along each axis."""
    return np.array([shape[1] * shape[2], shape[2], 1])


def places_of(numbers: Integers, shape: tuple[int, ...], spacing: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return corners of voxels by number as z, y, x in µm, from the centre of the first voxel."""
    return (np.column_stack(np.unravel_index(numbers, shape)) - 0.5) * spacing


def face_places(faces: Faces, shape: tuple[int, ...], spacing: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the middles of faces, z, y, x in µm."""
    middles = np.column_stack(np.unravel_index(faces.low, shape)).astype(np.float64)
    middles[np.arange(len(middles)), faces.axis] += 0.5
    return middles * spacing


def edges_of(faces: Faces, shape: tuple[int, ...]) -> Edges:
    """Return the edges of faces."""
    steps = steps_of(shape)
    base = faces.low + steps[faces.axis]
    one, other = (faces.axis + 1) % 3, (faces.axis + 2) % 3
    ids = np.concatenate([3 * base + one, 3 * (base + steps[other]) + one, 3 * base + other, 3 * (base + steps[one]) + other])
    order = np.argsort(ids, kind="stable")
    ids = ids[order]
    first = np.flatnonzero(np.concatenate([[True], ids[1:] != ids[:-1]])) if len(ids) else np.zeros(0, dtype=np.int64)
    return Edges(ids, order % max(len(base), 1), first)


def neighbours_in(edges: Edges) -> tuple[Integers, Integers]:
    """Return pairs of faces that follow each other at an edge."""
    same = edges.ids[1:] == edges.ids[:-1]
    return edges.face[:-1][same], edges.face[1:][same]


def components(one: NDArray[Any], other: NDArray[Any], count: int) -> Integers:
    """Return the number of the component of each of `count` things, from pairs that are joined."""
    sparse, graph = needed("scipy.sparse", "cells of a volume"), needed("scipy.sparse.csgraph", "cells of a volume")
    joined = sparse.coo_matrix((np.ones(len(one), dtype=bool), (one, other)), shape=(count, count))
    return np.asarray(graph.connected_components(joined, directed=False)[1], dtype=np.int64)


class Meetings(NamedTuple):
    """Corners of a surface, where three cells meet (the rim counts as one), and edges between them.

    `cells` has the cells of each corner, `place` its place; z, y, x in µm. Edges have two cells, the lower first, and two
    corners; -1 where they end at none. `points` are voxel corners along the edges, without order, by edge in `of_edge`.
    """

    cells: list[frozenset[int]]
    place: NDArray[np.float64]
    pairs: Integers
    ends: Integers
    points: Integers
    of_edge: Integers


def whole_patches(faces: Faces, edges: Edges) -> Faces:
    """Return the faces with one patch per cell: smaller ones belong to the cell that surrounds most of them."""
    one, other = neighbours_in(edges)
    cell = faces.cell.copy()
    for _ in range(PATCH_PASSES):
        same = cell[one] == cell[other]
        patch = components(one[same], other[same], len(cell))
        size = np.bincount(patch)
        of_cell = np.zeros(len(size), dtype=np.int64)
        of_cell[patch] = cell
        order = np.lexsort((-size, of_cell))
        small = np.ones(len(size), dtype=bool)
        small[order[np.concatenate([[True], of_cell[order][1:] != of_cell[order][:-1]])]] = False
        if not small.any():
            break
        sides = np.concatenate([np.column_stack([patch[one[~same]], cell[other[~same]]]), np.column_stack([patch[other[~same]], cell[one[~same]]])])
        sides, length = np.unique(sides[small[sides[:, 0]]], axis=0, return_counts=True)
        last = np.lexsort((length, sides[:, 0]))
        now = of_cell.copy()
        now[sides[last, 0]] = sides[last, 1]  # the longest common edge comes last
        cell = now[patch]
    return faces._replace(cell=cell)


def meetings_of(faces: Faces, shape: tuple[int, ...], spacing: NDArray[np.float64]) -> Meetings:
    """Return the corners and edges of cells on a surface."""
    edges = edges_of(faces, shape)
    faces = whole_patches(faces, edges)
    cell = faces.cell[edges.face]
    size = np.diff(np.append(edges.first, len(edges.ids)))
    low, high = (np.asarray(extreme.reduceat(cell, edges.first)) if len(cell) else cell for extreme in (np.minimum, np.maximum))
    between = (low != high) | (size == 1)
    low = np.where(size == 1, RIM, low)
    ids = edges.ids[edges.first[between]]
    ends = np.column_stack([ids // 3, ids // 3 + steps_of(shape)[ids % 3]])
    corners, ends = np.unique(ends, return_inverse=True)
    ends = ends.reshape(-1, 2)
    about = _cells_about(ends, np.repeat(np.flatnonzero(between), size[between]), edges, cell, size, between, len(corners))
    is_meeting = np.bincount(about[:, 0], minlength=len(corners)) >= 3
    cluster = _clusters(ends, is_meeting)
    cells, place = _of_clusters(cluster, about, places_of(corners, shape, spacing))
    pairs, arc_ends, of_arc = _arcs(ends, np.column_stack([low, high])[between], cluster)
    return Meetings(cells, place, pairs, arc_ends, corners[of_arc >= 0], of_arc[of_arc >= 0])


def _cells_about(ends: Integers, edge: Integers, edges: Edges, cell: Integers, size: Integers, between: NDArray[np.bool_],
                 count: int) -> Integers:
    """Return pairs of corner and cell (or rim), each once, for cells of the edges that end there."""
    rank = np.cumsum(between) - 1
    chosen = np.repeat(between, size)
    row = rank[edge]
    alone = np.flatnonzero(size[between] == 1)
    rows, cells = np.concatenate([row, alone]), np.concatenate([cell[chosen], np.full(len(alone), RIM)])
    span = int(cells.max(initial=0)) + 1
    keys = np.unique(np.concatenate([ends[rows, end] * span + cells for end in (0, 1)]))
    return np.column_stack([keys // span, keys % span])


def _clusters(ends: Integers, is_meeting: NDArray[np.bool_]) -> Integers:
    """Return the number of the meeting that each corner of voxels belongs to, or -1; those beside each other are one."""
    both = is_meeting[ends].all(axis=1)
    found = np.full(len(is_meeting), -1)
    group = components(ends[both, 0], ends[both, 1], len(is_meeting))
    found[is_meeting] = np.unique(group[is_meeting], return_inverse=True)[1]
    return found


def _of_clusters(cluster: Integers, about: Integers, places: NDArray[np.float64]) -> tuple[list[frozenset[int]], NDArray[np.float64]]:
    count = int(cluster.max(initial=-1)) + 1
    inside = cluster >= 0
    number = np.bincount(cluster[inside], minlength=count)
    place = np.column_stack([np.bincount(cluster[inside], weights=along[inside], minlength=count) / number for along in places.T])
    sets: list[set[int]] = [set() for _ in range(count)]
    for corner, cell in about[inside[about[:, 0]]].tolist():
        sets[cluster[corner]].add(cell)
    return [frozenset(one) for one in sets], place.reshape(-1, 3)


def _arcs(ends: Integers, pairs: Integers, cluster: Integers) -> tuple[Integers, Integers, Integers]:
    """Return the cells and end corners of each edge between meetings, and the edge of each corner of voxels, or -1."""
    inner = cluster[ends] < 0
    joined = inner.all(axis=1)
    group = components(ends[joined, 0], ends[joined, 1], len(cluster))
    of_arc = np.full(len(cluster), -1)
    of_arc[cluster < 0] = np.unique(group[cluster < 0], return_inverse=True)[1]
    count = int(of_arc.max(initial=-1)) + 1
    of_pairs = np.zeros((count, 2), dtype=np.int64)
    arc_ends = np.full((count, 2), -1)
    touched = inner.any(axis=1)
    of_pairs[of_arc[np.where(inner[touched, 0], ends[touched, 0], ends[touched, 1])]] = pairs[touched]
    into = touched & ~joined
    arc = of_arc[np.where(inner[into, 0], ends[into, 0], ends[into, 1])]
    meeting = cluster[np.where(inner[into, 0], ends[into, 1], ends[into, 0])]
    order = np.lexsort((meeting, arc))
    arc, meeting = arc[order], meeting[order]
    start = np.flatnonzero(np.concatenate([[True], arc[1:] != arc[:-1]])) if len(arc) else np.zeros(0, dtype=np.int64)
    stop = np.append(start[1:], len(arc)) - 1
    arc_ends[arc[start], 0] = meeting[start]
    several = stop > start
    arc_ends[arc[start[several]], 1] = meeting[stop[several]]
    return of_pairs, arc_ends, of_arc
