"""Apical and basal side of a layer of cells in a volume of labels, and the surface halfway between them."""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import needed
from .voxel_surfaces import Faces, Integers, components, edges_of, face_places, neighbours_in, steps_of

LARGE_PATCH = 0.05   # of a cell's largest free patch: smaller ones are no side of it
SMOOTHINGS = 6       # of normals, over neighbouring faces
ONE_WAY = 0.4        # length of the mean normal of a patch; less, and it is on no side
RIM_COSINE = 0.5     # between the normal of a face and the axis of its cell: less is the rim
MOST_COARSE = 6e6    # voxels of the grid on which distances from the sides are computed
FEWEST_LEVELS = 6    # of that grid, through a cell
FIRST, SECOND, LATERAL = 1, 2, 0
Floats = NDArray[np.float64]


class Sides(NamedTuple):
    """Free faces of cells, in order of voxel and axis, their side (LATERAL, FIRST or SECOND), and their area vectors, outward."""

    faces: Faces
    side: Integers
    normals: Floats  # z, y, x; µm²
    spans: NDArray[np.bool_]  # by cell: whether it has two free faces, one on each side


def free_faces(numbers: NDArray[Any], cells: int) -> tuple[Faces, Integers]:
    """Return faces between a cell (1 to `cells`) and background (0), and the sign of the outward normal along the axis."""
    low, axes, cell, sign = [], [], [], []
    for axis, step in enumerate(steps_of(numbers.shape)):
        flat = numbers.reshape(-1)
        one, other = flat[:-step], flat[step:]
        found = np.flatnonzero((one == 0) != (other == 0))
        before, after = one[found], other[found]
        is_cell = np.maximum(before, after) <= cells
        found, before, after = found[is_cell], before[is_cell], after[is_cell]
        low.append(found)
        axes.append(np.full(len(found), axis))
        cell.append(np.maximum(before, after).astype(np.int64))
        sign.append(np.where(before > 0, 1, -1))
    faces = Faces(np.concatenate(low), np.concatenate(axes), np.concatenate(cell))
    order = np.argsort(3 * faces.low + faces.axis, kind="stable")
    return faces.select(order), np.concatenate(sign)[order]


def sides_of(numbers: NDArray[Any], cells: int, spacing: Floats, pairs: Integers) -> Sides:
    """Return the two sides of a layer; which of them is apical is left open. `pairs` are cells that touch.

    Cells inside the layer have a free face on each side; these join over cells to the two sides. Free faces of cells at the
    rim are one: they are told apart by their normals and the directions of neighbours from side to side.
    """
    faces, sign = free_faces(numbers, cells)
    shape = numbers.shape
    area: Floats = np.prod(spacing) / spacing[faces.axis]
    one, other = neighbours_in(edges_of(faces, shape))
    same = faces.cell[one] == faces.cell[other]
    patch = components(one[same], other[same], len(faces.low))
    normals = _smoothed_normals(faces, area * sign, one, other)
    side, spans = _side_of_patches(faces, normals, patch, one[~same], other[~same], cells)
    side = side[patch]
    axis = _axes(faces, side, area, face_places(faces, shape, spacing), spans, pairs)
    rest = side == LATERAL
    along = (normals[rest] * axis[faces.cell[rest]]).sum(axis=1) / np.maximum(np.linalg.norm(normals[rest], axis=1), 1e-12)
    side[rest] = np.where(along < -RIM_COSINE, FIRST, np.where(along > RIM_COSINE, SECOND, LATERAL))
    return Sides(faces, side, normals, spans)


def _smoothed_normals(faces: Faces, area: Floats, one: Integers, other: Integers) -> Floats:
    """Return outward area vectors, averaged over neighbouring faces."""
    sparse = needed("scipy.sparse", "cells of a volume")
    count = len(faces.low)
    normals = np.zeros((count, 3))
    normals[np.arange(count), faces.axis] = area
    weights = np.ones(2 * len(one) + count)
    every = np.arange(count)
    mean = sparse.csr_matrix((weights, (np.concatenate([one, other, every]), np.concatenate([other, one, every]))), shape=(count, count))
    mean = sparse.diags(1 / np.asarray(mean.sum(axis=1)).ravel()) @ mean
    for _ in range(SMOOTHINGS):
        normals = mean @ normals
    return normals


def _side_of_patches(faces: Faces, normals: Floats, patch: Integers, one: Integers, other: Integers,
                     cells: int) -> tuple[Integers, NDArray[np.bool_]]:
    """Return the side of each free patch of a cell, and which cells have one on each.

    A patch that faces all ways, such as one through a hole in the layer, is on no side.
    """
    count = int(patch.max(initial=-1)) + 1
    size = np.bincount(patch, weights=np.linalg.norm(normals, axis=1), minlength=count)
    way = np.column_stack([np.bincount(patch, weights=along, minlength=count) for along in normals.T])
    of_cell = np.zeros(count, dtype=np.int64)
    of_cell[patch] = faces.cell
    order = np.lexsort((-size, of_cell))
    order = order[np.linalg.norm(way[order], axis=1) > ONE_WAY * size[order]]
    first = np.flatnonzero(np.concatenate([[True], of_cell[order][1:] != of_cell[order][:-1]])) if len(order) else np.zeros(0, dtype=np.int64)
    first = first[first + 1 < len(order)]
    pair = np.column_stack([order[first], order[first + 1]])  # the largest two of each cell
    opposite = (of_cell[pair[:, 0]] == of_cell[pair[:, 1]]) & ((way[pair[:, 0]] * way[pair[:, 1]]).sum(axis=1) < 0)
    pair = pair[opposite & (size[pair[:, 1]] > LARGE_PATCH * size[pair[:, 0]])]
    counts = np.zeros(count, dtype=bool)
    counts[pair] = True
    joins = counts[patch[one]] & counts[patch[other]] & ((way[patch[one]] * way[patch[other]]).sum(axis=1) > 0)
    group = components(patch[one[joins]], patch[other[joins]], count)
    two = np.argsort(-np.bincount(group[counts], minlength=max(count, 2)), kind="stable")[:2]
    side = np.full(count, LATERAL)
    for number, which in zip((FIRST, SECOND), two):
        side[counts & (group == which)] = number
    spans = np.zeros(cells + 1, dtype=bool)
    spans[of_cell[pair[side[pair].prod(axis=1) == FIRST * SECOND, 0]]] = True
    side[~spans[of_cell]] = LATERAL
    return side, spans


def _axes(faces: Faces, side: Integers, area: Floats, places: Floats, spans: NDArray[np.bool_], pairs: Integers) -> Floats:
    """Return the unit direction from the first to the second side of each cell, that of others from their neighbours."""
    count = len(spans)
    middle = []
    for number in (FIRST, SECOND):
        of = side == number
        weight = np.bincount(faces.cell[of], weights=area[of], minlength=count)
        middle.append(np.column_stack([np.bincount(faces.cell[of], weights=area[of] * along[of], minlength=count)
                                       for along in places.T]) / np.maximum(weight, 1e-12)[:, None])
    axis = np.where(spans[:, None], middle[1] - middle[0], 0.0)
    one, other = pairs.T
    for _ in range(count):
        length = np.linalg.norm(axis, axis=1, keepdims=True)
        axis = np.divide(axis, length, out=np.zeros_like(axis), where=length > 0)
        known = length[:, 0] > 0
        sums = np.zeros_like(axis)
        np.add.at(sums, one, axis[other])
        np.add.at(sums, other, axis[one])
        gains = ~known & (np.linalg.norm(sums, axis=1) > 0)
        if not gains.any():
            break
        axis[gains] = sums[gains]
    return axis


class Halfway:
    """Whether voxels are nearer to the first than to the second side, from distances on a coarser grid."""

    def __init__(self, sides: Sides, shape: tuple[int, ...], spacing: Floats, height: float) -> None:
        ndimage = needed("scipy.ndimage", "cells of a volume")
        self.shape = shape
        wanted = max((np.prod(shape) * np.prod(spacing) / MOST_COARSE) ** (1 / 3), spacing.min())
        size = min(wanted, max(height / FEWEST_LEVELS, spacing.min()))
        self.factor = np.maximum(1, np.floor(size / spacing + 1e-9)).astype(np.int64)
        coarse = tuple(-(-length // factor) for length, factor in zip(shape, self.factor.tolist()))
        places = np.column_stack(np.unravel_index(sides.faces.low, shape))
        far = []
        for number in (FIRST, SECOND):
            empty = np.ones(coarse, dtype=bool)
            empty[tuple((places[sides.side == number] // self.factor).T)] = False
            far.append(ndimage.distance_transform_edt(empty, sampling=self.factor * spacing).astype(np.float32))
        self.nearer = far[1] - far[0]  # positive: nearer to the first

    def of(self, places: Integers) -> NDArray[np.bool_]:
        """Return whether voxels (z, y, x) are nearer to the first side."""
        ndimage = needed("scipy.ndimage", "cells of a volume")
        at = (places + 0.5) / self.factor - 0.5
        return np.asarray(ndimage.map_coordinates(self.nearer, at.T, order=1, mode="nearest") > 0)

    def faces(self, numbers: NDArray[Any], cells: int) -> Faces:
        """Return the faces halfway, with the cell of the voxel that is nearer to the first side."""
        ndimage = needed("scipy.ndimage", "cells of a volume")
        sign = (self.nearer > 0).astype(np.uint8)
        changes = ndimage.maximum_filter(sign, 3) != ndimage.minimum_filter(sign, 3)
        blocks = np.column_stack(np.nonzero(changes)) * self.factor
        inside = np.column_stack([part.ravel() for part in np.indices(self.factor)])
        low, axes, cell = [], [], []
        flat = numbers.reshape(-1)
        steps = steps_of(self.shape)
        for chunk in np.array_split(blocks, max(1, len(blocks) * len(inside) // 4_000_000)):
            places = (chunk[:, None, :] + inside[None]).reshape(-1, 3)
            places = places[(places < np.array(self.shape) - 1).all(axis=1)]
            number = places @ steps
            places, number = places[flat[number] > 0], number[flat[number] > 0]
            nearer = self.of(places)
            for axis in range(3):
                beyond = number + steps[axis]
                tissue = flat[beyond] > 0
                here = nearer[tissue]
                there = self.of(places[tissue] + np.eye(3, dtype=np.int64)[axis])
                split = here != there
                chosen = number[tissue][split]
                low.append(chosen)
                axes.append(np.full(len(chosen), axis))
                cell.append(flat[np.where(here[split], chosen, chosen + steps[axis])].astype(np.int64))
        faces = Faces(np.concatenate(low), np.concatenate(axes), np.concatenate(cell))
        return faces.select(faces.cell <= cells)
