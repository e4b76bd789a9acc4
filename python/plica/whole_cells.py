"""Centroids and second moments of whole cells: of meshes, with transposed derivatives, and of labels."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))  # axes of second moments, in order
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
# Gauss points, exact for volumes and centroids; shape functions (points, corners), and their slopes (points, corners, 3).
FACTORS = 1 + CORNERS[:, None] * CORNERS[None] / 3**0.5
SHAPES = FACTORS.prod(axis=2) / 8
SLOPES = np.stack([CORNERS[None, :, axis] / 8 * np.delete(FACTORS, axis, axis=2).prod(axis=2) for axis in range(3)], axis=2)
# A box of width w, each side of which is off by the same noise, has a centroid off by n and a moment w² / 12 off by w n / 3.
MOMENT_NOISE = 12**0.5 / 3


class Mesh(Protocol):
    """What whole cells need of a simulation."""

    @property
    def hexahedra(self) -> NDArray[np.int32]: ...
    @property
    def hexahedron_cell(self) -> NDArray[np.int32]: ...


class WholeCells:
    """Centroids and second central moments of cells (xx, yy, zz, xy, yz, xz), as functions of node positions."""

    def __init__(self, mesh: Mesh, cells: int) -> None:
        self.hexahedra, self.cell, self.cells = mesh.hexahedra, mesh.hexahedron_cell, cells

    def of(self, positions: Array) -> tuple[Array, Array]:
        """Return centroids (cells, 3), µm, and second moments (cells, 6), µm²."""
        self._nodes, corners = len(positions), positions[self.hexahedra]
        edges = np.einsum("pck,eci->epki", SLOPES, corners)
        self._cofactors = np.stack([np.cross(edges[:, :, 1], edges[:, :, 2]), np.cross(edges[:, :, 2], edges[:, :, 0]),
                                    np.cross(edges[:, :, 0], edges[:, :, 1])], axis=2)
        self._parts = (edges[:, :, 0] * self._cofactors[:, :, 0]).sum(axis=2)
        self._volumes = self._sum(self._parts)
        places = np.einsum("pc,eci->epi", SHAPES, corners)
        centroids = np.stack([self._sum(self._parts * places[..., axis]) for axis in range(3)], axis=1) / self._volumes[:, None]
        self._spokes = places - centroids[self.cell, None]
        self._moments = np.stack([self._sum(self._parts * self._spokes[..., one] * self._spokes[..., other]) for one, other in PAIRS],
                                 axis=1) / self._volumes[:, None]
        return centroids, self._moments

    def pull_back(self, by_centroids: Array, by_moments: Array) -> Array:
        """Return the gradient by positions of a function of the last centroids and moments, from its gradients by them."""
        matrix = np.zeros((self.cells, 3, 3))
        for place, (one, other) in enumerate(PAIRS):
            matrix[:, one, other] += 0.5 * by_moments[:, place]
            matrix[:, other, one] += 0.5 * by_moments[:, place]
        along = (by_centroids / self._volumes[:, None])[self.cell, None]
        turned = np.einsum("eij,epj->epi", (matrix / self._volumes[:, None, None])[self.cell], self._spokes)
        of_cell = ((by_moments * self._moments).sum(axis=1) / self._volumes)[self.cell, None]
        by_place = self._parts[..., None] * (along + 2 * turned)
        by_part = ((along + turned) * self._spokes).sum(axis=2) - of_cell
        by_corner = np.einsum("epi,pc->eci", by_place, SHAPES) + np.einsum("ep,epki,pck->eci", by_part, self._cofactors, SLOPES)
        gradient = np.zeros((self._nodes, 3))
        np.add.at(gradient, self.hexahedra, by_corner)
        return gradient

    def changed(self, moments: Array, first: Array, of_model: Array) -> Array:
        """Return moments of the model after the measured change since the first ones."""
        return of_model + moments - first

    def noise(self, moments: Array, noise_um: float) -> Array:
        """Return the noise of moments, if centroids have this one."""
        return moment_noise(moments, noise_um)

    def _sum(self, of_points: Array) -> Array:
        return np.bincount(self.cell, of_points.sum(axis=1), self.cells).astype(np.float64, copy=False)


def moment_noise(moments: Array, noise_um: float) -> Array:
    """Return the noise of second moments of shape (..., 6) for sides that are off independently, so that centroids have this noise."""
    widths = np.sqrt(np.maximum(moments[..., :3], noise_um**2))
    return np.stack([MOMENT_NOISE * noise_um * np.sqrt(widths[..., one] * widths[..., other]) for one, other in PAIRS], axis=-1)


def label_moments(planes: Iterable[NDArray[Any]], cells: int, spacing: Array, origin: Array) -> tuple[Array, Array, Array]:
    """Return volumes (cells,), µm³, centroids (cells, 3), µm, and second moments (cells, 6), µm², of numbers 1 to `cells` in a volume.

    `spacing` and `origin`, the centre of the first voxel, are z, y, x in µm; results x, y, z.
    """
    counts, sums, squares = np.zeros(cells), np.zeros((cells, 3)), np.zeros((cells, 6))
    for number, plane in enumerate(planes):
        rows, columns = np.nonzero((plane > 0) & (plane <= cells))
        cell = plane[rows, columns].astype(np.int64) - 1
        places = np.stack([columns, rows, np.full(len(rows), number)]) * spacing[::-1, None] + origin[::-1, None]
        counts += np.bincount(cell, minlength=cells)
        sums += np.stack([np.bincount(cell, place, cells) for place in places], axis=1)
        squares += np.stack([np.bincount(cell, places[one] * places[other], cells) for one, other in PAIRS], axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        centroids = sums / counts[:, None]
        moments = squares / counts[:, None] - np.stack([centroids[:, one] * centroids[:, other] for one, other in PAIRS], axis=1)
    moments[:, :3] += spacing[::-1] ** 2 / 12  # of voxels themselves
    return counts * float(np.prod(spacing)), centroids, moments
