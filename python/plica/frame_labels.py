"""Frames of runs as volumes of labels: voxels inside cells."""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # of hexahedra, seen from outside
SHARED = 1e-9       # voxels: those on a face belong to both cells, and are given to the later one
CHUNK = 2_000_000   # lines of voxels at once


class LabelVolume(NamedTuple):
    """Cells as voxels.

    `labels` has shape (planes, rows, columns), 0 outside all cells; `origin_um` (z, y, x) is the centre of the first voxel.
    """

    labels: NDArray[np.uint32]
    origin_um: tuple[float, float, float]
    spacing_um: tuple[float, float, float]


def voxels_of(points: Floats, hexahedra: NDArray[Any], labels: NDArray[Any], spacing: Floats, origin: Floats,
              shape: tuple[int, int, int]) -> NDArray[np.uint32]:
    """Return the label of the hexahedron around each voxel centre; spacing and origin z, y, x in µm, points x, y, z.

    Hexahedra are 24 tetrahedra each, about the means of their faces and of all corners, so that neighbours fit without gaps.
    """
    corners = ((points[:, ::-1] - origin) / spacing)[hexahedra]
    middle = corners.mean(axis=1)
    volume: NDArray[np.uint32] = np.zeros(shape, dtype=np.uint32)
    for face in FACES:
        centre = corners[:, face].mean(axis=1)
        for one, other in zip(face, (*face[1:], face[0])):
            _fill(volume, np.stack([middle, centre, corners[:, one], corners[:, other]], axis=1), labels)
    return volume


def _fill(volume: NDArray[np.uint32], tetrahedra: Floats, labels: NDArray[Any]) -> None:
    """Give voxels in tetrahedra (z, y, x in voxels) their labels, line by line along z."""
    shape = np.array(volume.shape)
    low = np.maximum(np.ceil(tetrahedra.min(axis=1) - SHARED), 0).astype(np.int64)
    high = np.minimum(np.floor(tetrahedra.max(axis=1) + SHARED), shape - 1).astype(np.int64)
    size = np.maximum(high - low + 1, 0)
    lines = np.where(size[:, 0] > 0, size[:, 1] * size[:, 2], 0)
    for part in np.array_split(np.arange(len(lines)), max(1, int(lines.sum()) // CHUNK)):
        count = lines[part]
        of = np.repeat(part, count)
        place = np.arange(len(of)) - np.repeat(np.cumsum(count) - count, count)
        row, column = low[of, 1] + place // size[of, 2], low[of, 2] + place % size[of, 2]
        below, above = low[of, 0] - SHARED, high[of, 0] + SHARED
        inside = np.ones(len(of), dtype=bool)
        for without in range(4):
            base, one, two = (tetrahedra[:, k] for k in range(4) if k != without)
            normal = np.cross(one - base, two - base)
            normal *= np.sign(((tetrahedra[:, without] - base) * normal).sum(axis=1))[:, None]  # inwards
            rise = normal[of, 0]
            rest = (normal[of, 1] * (base[of, 1] - row) + normal[of, 2] * (base[of, 2] - column))
            with np.errstate(divide="ignore", invalid="ignore"):
                bound = base[of, 0] + rest / rise
            below = np.where(rise > 0, np.maximum(below, bound), below)
            above = np.where(rise < 0, np.minimum(above, bound), above)
            inside &= (rise != 0) | (rest <= 0)
        inside &= below - SHARED <= above + SHARED  # flat tetrahedra have bounds without end
        first = np.ceil(np.where(inside, below, 0) - SHARED).astype(np.int64)
        many = np.maximum(np.floor(np.where(inside, above, -1) + SHARED).astype(np.int64) - first + 1, 0)
        line = np.repeat(np.arange(len(of)), many)
        plane = first[line] + np.arange(len(line)) - np.repeat(np.cumsum(many) - many, many)
        volume[plane, row[line], column[line]] = labels[of[line]]
