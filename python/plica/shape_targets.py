"""Measured shapes that a run is compared with: positions of nodes, apical faces of cells, or whole cells."""
from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .arguments import mapping_of, numbers, told
from .polygons import Polygons
from .results import Frame
from .whole_cells import Mesh, WholeCells

Array = NDArray[np.float64]
CHANGE_UM = 1e-4  # of positions, for the derivatives of residuals along a motion
FITS = "positions of nodes, a Frame, Polygons, or a mapping with centres_um, areas_um2, centroids_um or moments_um2 of cells"


class ApicalFaces:
    """Centres and areas of the apical faces of cells, as functions of node positions, with transposed derivatives.

    Each facet is divided into triangles about the mean of its corners. The centre of a cell is the mean of its triangles,
    weighted by area.
    """

    def __init__(self, mesh: Mesh, apical_nodes: NDArray[np.int32], cells: int) -> None:
        tops = mesh.hexahedra[:, 4:]
        outer = np.isin(tops, apical_nodes).all(axis=1)
        self.facets, self.cell, self.cells = tops[outer], mesh.hexahedron_cell[outer], cells

    def of(self, positions: Array) -> tuple[Array, Array]:
        """Return centres (cells, 3), µm, and areas (cells,), µm²."""
        self._points, corners = positions, positions[self.facets]
        middle = corners.mean(axis=1, keepdims=True)
        self._spokes = corners - middle
        self._next = np.roll(self._spokes, -1, axis=1)
        normals = np.cross(self._spokes, self._next)
        lengths = np.linalg.norm(normals, axis=2)
        self._normals = normals / np.maximum(lengths, np.finfo(float).tiny)[..., None]
        self._area = 0.5 * lengths
        self._middle = middle + (self._spokes + self._next) / 3
        self._areas = np.maximum(self._sum(self._area.sum(axis=1)), np.finfo(float).tiny)
        self._centres = self._sum((self._area[..., None] * self._middle).sum(axis=1)) / self._areas[:, None]
        return self._centres, self._areas

    def pull_back(self, by_centres: Array, by_areas: Array) -> Array:
        """Return the gradient by positions of a function of the last centres and areas, from its gradients by them."""
        by_middle = self._area[..., None] * (by_centres / self._areas[:, None])[self.cell, None]
        by_area = by_areas[self.cell, None] + (
            (by_centres / self._areas[:, None])[self.cell, None] * (self._middle - self._centres[self.cell, None])).sum(axis=2)
        half = 0.5 * by_area[..., None]
        by_spokes = half * np.cross(self._next, self._normals) + by_middle / 3
        by_next = half * np.cross(self._normals, self._spokes) + by_middle / 3
        by_corner = by_spokes + np.roll(by_next, 1, axis=1)
        by_corner += (by_middle.sum(axis=1, keepdims=True) - by_corner.sum(axis=1, keepdims=True)) / 4
        gradient = np.zeros_like(self._points)
        np.add.at(gradient, self.facets, by_corner)
        return gradient

    def changed(self, areas: Array, first: Array, of_model: Array) -> Array:
        """Return areas of the model after the measured change since the first ones; NaN where these are 0."""
        return np.asarray(areas * of_model / np.where(first > 0, first, np.nan))

    def noise(self, areas: Array, noise_um: float) -> Array:
        """Return the noise of areas if centres have this one: that of squares whose corners have it."""
        return np.asarray(noise_um * np.sqrt(2 * np.maximum(areas, noise_um**2)))

    def _sum(self, of_facets: Array) -> Array:
        total = np.zeros((self.cells, *of_facets.shape[1:]))
        np.add.at(total, self.cell, of_facets)
        return total


class NodeTarget:
    """Positions of nodes of the same mesh; NaN where they are unknown."""

    def __init__(self, positions: Array, noise_um: float) -> None:
        self.seen, self.noise_um = np.isfinite(positions).ravel(), noise_um
        self.positions = positions

    @property
    def coordinates(self) -> int:
        """How many of the residuals, the first ones, are coordinates: x, y, z by place."""
        return self.positions.size

    def compare_changes_since(self, first: NodeTarget, positions: Array) -> None:
        """Compare displacements since a first shape, of which these are the positions in the model."""
        self.positions = np.where(first.seen.reshape(positions.shape), self.positions + positions - first.positions, self.positions)

    def distance_um(self, positions: Array) -> float:
        """Return the root mean square distance of known coordinates."""
        return float(self.noise_um * np.sqrt((self.residuals(positions) ** 2).sum() / max(self.seen.sum(), 1)))

    def given(self) -> Array:
        """Return all numbers of the target."""
        return np.append(self.positions, self.noise_um)

    def residuals(self, positions: Array) -> Array:
        """Return residuals in units of their noise; 0 where unknown."""
        return np.where(self.seen, (positions - self.positions).ravel(), 0) / self.noise_um

    def pull_back(self, positions: Array, by_residuals: Array) -> Array:
        """Return the gradient by positions of a function of the residuals, from its gradient by them."""
        return np.where(self.seen, by_residuals, 0).reshape(positions.shape) / self.noise_um


class CellTarget:
    """Middles and sizes of cells, on any mesh; NaN where they are unknown: centres and areas of apical faces, or centroids and second
    moments of whole cells."""

    def __init__(self, measures: Union[ApicalFaces, WholeCells], middles: Array, sizes: Array, noise_um: float) -> None:
        self.measures, self.middles, self.sizes, self.noise_um = measures, middles, sizes, noise_um
        self.size_noise = measures.noise(sizes, noise_um)

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Which residuals are known."""
        return np.asarray(np.isfinite(np.concatenate([self.middles.ravel(), self.sizes.ravel()])))

    @property
    def coordinates(self) -> int:
        """How many of the residuals, the first ones, are coordinates: x, y, z by cell."""
        return self.middles.size

    def compare_changes_since(self, first: CellTarget, positions: Array) -> None:
        """Compare changes since a first shape, of which these are the positions in the model."""
        middles, sizes = self.measures.of(positions)
        self.middles = np.where(np.isfinite(first.middles), self.middles + middles - first.middles, self.middles)
        self.sizes = np.where(np.isfinite(first.sizes), self.measures.changed(self.sizes, first.sizes, sizes), self.sizes)

    def distance_um(self, positions: Array) -> float:
        """Return the root mean square distance of known coordinates of middles."""
        apart = self.measures.of(positions)[0] - self.middles
        return float(np.sqrt(np.nanmean(apart**2))) if np.isfinite(apart).any() else 0.0

    def given(self) -> Array:
        """Return all numbers of the target."""
        return np.concatenate([self.middles.ravel(), self.sizes.ravel(), [self.noise_um]])

    def residuals(self, positions: Array) -> Array:
        """Return residuals in units of their noise; 0 where unknown."""
        middles, sizes = self.measures.of(positions)
        return np.nan_to_num(np.concatenate([((middles - self.middles) / self.noise_um).ravel(), ((sizes - self.sizes) / self.size_noise).ravel()]))

    def pull_back(self, positions: Array, by_residuals: Array) -> Array:
        """Return the gradient by positions of a function of the residuals, from its gradient by them."""
        self.measures.of(positions)
        by_middles, by_sizes = np.split(np.where(self.seen, by_residuals, 0), [self.middles.size])
        return self.measures.pull_back((by_middles / self.noise_um).reshape(self.middles.shape),
                                       np.nan_to_num(by_sizes.reshape(self.sizes.shape) / self.size_noise))


class Residuals:
    """Residuals of a run at several times, in units of their noise.

    Changes since a first shape share its error, which is as large as that of others: a normal offset that is common to all times. Along
    the axes of `drift` (0 to 2), each shape has an unknown movement that is common to all places. With both, the sum of squares is least
    at a fit to the values of all times, the first with residual 0 among them; without the offset where the first is unknown.
    """

    def __init__(self, targets: list[Target], first: Optional[Target], drift: Sequence[int] = ()) -> None:
        self.targets, self.first, self.drift = targets, first, drift

    def of(self, positions: list[Array]) -> tuple[list[Array], Array]:
        """Return residuals without drift and offset at each of the first times, and their sums of squares, in which the offset is shared out."""
        found, offset = self._parted(self._raw(positions), 0.0)
        shared = 0.0 if self.first is None or offset is None else float((offset[self.first.seen] ** 2).sum()) / len(found)
        return found, np.array([float((one**2).sum()) + shared for one in found])

    def gradients(self, positions: list[Array]) -> Array:
        """Return the gradient of half the sum of squares by positions at each of the first times."""
        return self._pulled(positions, self.of(positions)[0])

    def product(self, positions: list[Array], motions: Array) -> Array:
        """Return the gradient by positions of half the sum of squares of the changes of residuals along these motions of nodes."""
        size = CHANGE_UM / max(float(np.abs(motions).max()), np.finfo(float).tiny)
        more, less = [self._raw([one + part * motion for one, motion in zip(positions, motions)]) for part in (size, -size)]
        slopes = [(high - low) / (2 * size) for high, low in zip(more, less)]
        return self._pulled(positions, self._parted(slopes, 0.0)[0])

    def curvature(self, positions: list[Array], changed: Iterable[list[Array]], change: float) -> Array:
        """Return the Gauss-Newton Hessian of half the sum of squares by parameters, from positions at the first times after each of them has
        changed by this."""
        before, slopes, parted = self._raw(positions), [], []
        for those in changed:
            slope = [(one - still) / change for one, still in zip(self._raw(those), before)]
            slopes.append(np.concatenate(slope))
            parted.append(np.concatenate(self._parted(slope, 0.0)[0]))
        product = np.array(slopes) @ np.array(parted).T
        return np.asarray(0.5 * (product + product.T))

    def probe(self, positions: list[Array], rng: np.random.Generator) -> Array:
        """Return gradients by positions of a sum of residuals with normal weights, of which the covariance is the precision of residuals."""
        weights = [np.where(target.seen, rng.standard_normal(len(target.seen)), 0) for target in self.targets[:len(positions)]]
        at_first = 0.0 if self.first is None else np.where(self.first.seen, rng.standard_normal(len(weights[0])), 0)
        return self._pulled(positions, self._parted(weights, at_first)[0])

    def counts(self, times: int) -> Array:
        """Return the number of residuals at each of the first times."""
        seen = np.array([target.seen.sum() for target in self.targets[:times]])
        for axis in self.drift:
            seen -= [int(target.seen[axis:target.coordinates:3].any()) for target in self.targets[:times]]
        if self.first is None:
            return seen
        free = np.any([target.seen & ~self.first.seen for target in self.targets[:times]], axis=0)  # offsets that are unknown
        return seen - int(free.sum()) / times

    def _raw(self, positions: list[Array]) -> list[Array]:
        return [target.residuals(one) for target, one in zip(self.targets, positions)]

    def _parted(self, given: list[Array], at_first: Union[float, Array]) -> tuple[list[Array], Union[None, Array]]:
        """Return values without their drift and without their mean over times, the first among them, and this mean."""
        seen = np.stack([target.seen for target in self.targets[:len(given)]])
        values = np.stack(given)
        if self.first is not None:
            seen = np.vstack([self.first.seen, seen])
            values = np.vstack([np.broadcast_to(at_first, values[0].shape), values])
        for axis in self.drift:
            at = slice(axis, self.targets[0].coordinates, 3)
            values[:, at] -= seen[:, at] * _common(values[:, at], seen[:, at], self.first is not None)[:, None]
        if self.first is None:
            return list(values), None
        offset = values.sum(axis=0) / np.maximum(seen.sum(axis=0), 1)
        return [np.where(known, one - offset, 0) for known, one in zip(seen[1:], values[1:])], offset

    def _pulled(self, positions: list[Array], by_residuals: list[Array]) -> Array:
        return np.stack([target.pull_back(*both) for target, *both in zip(self.targets, positions, by_residuals)])


def _common(values: Array, seen: NDArray[np.bool_], has_offsets: bool) -> Array:
    """Return what is common to all places at each time, by least squares; values of shape (times, places) are 0 where they are not seen.
    With offsets, each place has one that is common to all times, and the first time has 0."""
    share = seen / np.maximum(seen.sum(axis=0), 1) if has_offsets else np.zeros(values.shape)
    matrix = np.diag(seen.sum(axis=1)) - share @ seen.T
    right = values.sum(axis=1) - share @ values.sum(axis=0)
    found, free = np.zeros(len(values)), slice(int(has_offsets), None)
    found[free] = np.linalg.lstsq(matrix[free, free], right[free], rcond=None)[0]
    return found


Target = Union[NodeTarget, CellTarget]
APICAL, WHOLE = ("centres_um", "areas_um2"), ("centroids_um", "moments_um2")


def target_of(value: Any, what: str, faces: ApicalFaces, whole: WholeCells, nodes: int, compared: NDArray[np.int32],
              noise_um: float) -> Target:
    """Return a target. ValueError, with `what`, if its shape does not match the tissue."""
    if isinstance(value, Frame):
        value = value.polygons("apical")
    if isinstance(value, Polygons):
        return _cell_target(what, faces, dict(zip(APICAL, centres_and_areas(value))), noise_um)
    if isinstance(value, Mapping):
        given = mapping_of(value, what, FITS)
        unknown = sorted(set(given) - {*APICAL, *WHOLE})
        if unknown or not given:
            raise ValueError(f"{what}: {', '.join(unknown) or 'is empty'}; give centres_um, areas_um2 or both, or centroids_um, moments_um2 or both")
        if {*APICAL} & {*given} and {*WHOLE} & {*given}:
            raise ValueError(f"{what}: has values of apical faces and of whole cells; give centres_um and areas_um2, or centroids_um and moments_um2")
        return _cell_target(what, whole if {*WHOLE} & {*given} else faces, given, noise_um)
    positions = numbers(value, what, FITS, masked_is_none=True)
    if positions.shape != (nodes, 3):
        raise ValueError(f"{what}: {told(positions)} for a tissue of {nodes} nodes; give positions of shape ({nodes}, 3), NaN "
                         "where unknown, or values of cells if the mesh differs")
    unread = np.ones(nodes, dtype=bool)
    unread[compared] = False
    positions[unread] = np.nan
    return _seen(NodeTarget(positions, noise_um), what)


def _cell_target(what: str, measures: Union[ApicalFaces, WholeCells], given: Mapping[str, Any], noise_um: float) -> Target:
    names = APICAL if isinstance(measures, ApicalFaces) else WHOLE
    cells = measures.cells
    values = []
    for name, shape in zip(names, ((cells, 3), (cells,) if isinstance(measures, ApicalFaces) else (cells, 6))):
        values.append(numbers(given.get(name, np.full(shape, np.nan)), what, FITS, masked_is_none=True))
        if values[-1].shape != shape:
            raise ValueError(f"{what}: {name} of shape {values[-1].shape} for {cells} cells; give {shape}, one row per cell of the scenario, in "
                             "the order of cell_data, NaN where unknown")
    return _seen(CellTarget(measures, values[0], values[1], noise_um), what)


def _seen(target: Target, what: str) -> Target:
    if not target.seen.any():
        raise ValueError(f"{what}: has no finite value on the surface that is compared; give positions of some nodes or cells")
    return target


def centres_and_areas(polygons: Polygons) -> tuple[Array, Array]:
    """Return centres, means of triangles about the mean of the corners weighted by area, and areas."""
    centres, areas = [], []
    for face in polygons.faces:
        corners = polygons.points[face]
        middle = corners.mean(axis=0)
        spokes = corners - middle
        following = np.roll(spokes, -1, axis=0)
        parts = 0.5 * np.linalg.norm(np.cross(spokes, following), axis=1)
        areas.append(parts.sum())
        centres.append(middle + parts @ (spokes + following) / (3 * max(parts.sum(), np.finfo(float).tiny)))
    return np.array(centres).reshape(-1, 3), np.array(areas)
