"""Measured shapes that a run is compared with: positions of nodes, or centres and areas of the apical faces of cells."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from .arguments import mapping_of, numbers, told
from .polygons import Polygons
from .results import Frame

Array = NDArray[np.float64]
FITS = "positions of nodes, a Frame, Polygons, or a mapping with centres_um or areas_um2 of cells"


class Mesh(Protocol):
    """What targets need of a simulation."""

    @property
    def hexahedra(self) -> NDArray[np.int32]: ...
    @property
    def hexahedron_cell(self) -> NDArray[np.int32]: ...


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

    def _sum(self, of_facets: Array) -> Array:
        total = np.zeros((self.cells, *of_facets.shape[1:]))
        np.add.at(total, self.cell, of_facets)
        return total


class NodeTarget:
    """Positions of nodes of the same mesh; NaN where they are unknown."""

    def __init__(self, positions: Array, noise_um: float) -> None:
        self.seen, self.noise_um = np.isfinite(positions), noise_um
        self.positions = np.where(self.seen, positions, 0)
        self.count = int(self.seen.sum())

    def compare_changes_since(self, first: NodeTarget, positions: Array) -> None:
        """Compare displacements since a first shape, of which these are the positions in the model."""
        self.seen &= first.seen
        self.positions = np.where(self.seen, self.positions + positions - first.positions, 0)
        self.count = int(self.seen.sum())

    def distance_um(self, positions: Array) -> float:
        """Return the root mean square distance of known coordinates."""
        return float(self.noise_um * (self.misfit(positions)[0] / self.count) ** 0.5)

    def given(self) -> Array:
        """Return all numbers of the target."""
        return np.append(self.positions, self.noise_um)

    def probe(self, positions: Array, rng: np.random.Generator) -> Array:
        """Return the gradient by positions of a sum of residuals in units of their noise, with independent normal weights."""
        return np.where(self.seen, rng.standard_normal(positions.shape), 0) / self.noise_um

    def misfit(self, positions: Array) -> tuple[float, Array]:
        """Return the sum of squared residuals in units of their noise, and its gradient by positions."""
        apart = np.where(self.seen, positions - self.positions, 0) / self.noise_um
        return float((apart**2).sum()), 2 * apart / self.noise_um


class CellTarget:
    """Centres and areas of the apical faces of cells, on any mesh; NaN where they are unknown."""

    def __init__(self, faces: ApicalFaces, centres: Array, areas: Array, noise_um: float) -> None:
        self.faces, self.noise_um = faces, noise_um
        self.seen, self.seen_areas = np.isfinite(centres), np.isfinite(areas)
        self.centres, self.areas = np.where(self.seen, centres, 0), np.where(self.seen_areas, areas, 0)
        # A square whose corners have this noise.
        self.area_noise = noise_um * np.sqrt(2 * np.maximum(self.areas, noise_um**2))
        self.count = int(self.seen.sum() + self.seen_areas.sum())

    def compare_changes_since(self, first: CellTarget, positions: Array) -> None:
        """Compare displacements and ratios of areas since a first shape, of which these are the positions in the model."""
        centres, areas = self.faces.of(positions)
        self.seen &= first.seen
        self.seen_areas &= first.seen_areas & (first.areas > 0)
        self.centres = np.where(self.seen, self.centres + centres - first.centres, 0)
        self.areas = np.where(self.seen_areas, self.areas * areas / np.where(first.areas > 0, first.areas, 1), 0)
        self.count = int(self.seen.sum() + self.seen_areas.sum())

    def distance_um(self, positions: Array) -> float:
        """Return the root mean square distance of known coordinates of centres."""
        apart = (self.faces.of(positions)[0] - self.centres)[self.seen]
        return float((apart**2).mean() ** 0.5) if apart.size else 0.0

    def given(self) -> Array:
        """Return all numbers of the target."""
        return np.concatenate([self.centres.ravel(), self.areas, [self.noise_um]])

    def probe(self, positions: Array, rng: np.random.Generator) -> Array:
        """Return the gradient by positions of a sum of residuals in units of their noise, with independent normal weights."""
        self.faces.of(positions)
        return self.faces.pull_back(np.where(self.seen, rng.standard_normal(self.seen.shape), 0) / self.noise_um,
                                    np.where(self.seen_areas, rng.standard_normal(self.seen_areas.shape), 0) / self.area_noise)

    def misfit(self, positions: Array) -> tuple[float, Array]:
        """Return the sum of squared residuals in units of their noise, and its gradient by positions."""
        centres, areas = self.faces.of(positions)
        apart = np.where(self.seen, centres - self.centres, 0) / self.noise_um
        wider = np.where(self.seen_areas, areas - self.areas, 0) / self.area_noise
        gradient = self.faces.pull_back(2 * apart / self.noise_um, 2 * wider / self.area_noise)
        return float((apart**2).sum() + (wider**2).sum()), gradient


Target = Union[NodeTarget, CellTarget]


def target_of(value: Any, what: str, faces: ApicalFaces, nodes: int, compared: NDArray[np.int32], noise_um: float) -> Target:
    """Return a target. ValueError, with `what`, if its shape does not match the tissue."""
    if isinstance(value, Frame):
        value = value.polygons("apical")
    if isinstance(value, Polygons):
        centres, areas = centres_and_areas(value)
    elif isinstance(value, Mapping):
        given = mapping_of(value, what, FITS)
        unknown = sorted(set(given) - {"centres_um", "areas_um2"})
        if unknown or not given:
            raise ValueError(f"{what}: {', '.join(unknown) or 'is empty'}; give centres_um, areas_um2 or both")
        centres = numbers(given.get("centres_um", np.full((faces.cells, 3), np.nan)), what, FITS, masked_is_none=True)
        areas = numbers(given.get("areas_um2", np.full(faces.cells, np.nan)), what, FITS, masked_is_none=True)
    else:
        positions = numbers(value, what, FITS, masked_is_none=True)
        if positions.shape != (nodes, 3):
            raise ValueError(f"{what}: {told(positions)} for a tissue of {nodes} nodes; give positions of shape ({nodes}, 3), NaN "
                             "where unknown, or centres_um and areas_um2 of cells if the mesh differs")
        unread = np.ones(nodes, dtype=bool)
        unread[compared] = False
        positions[unread] = np.nan
        return _seen(NodeTarget(positions, noise_um), what)
    if centres.shape != (faces.cells, 3) or areas.shape != (faces.cells,):
        raise ValueError(f"{what}: {len(centres)} centres and {len(areas)} areas for {faces.cells} cells; give one per cell of the "
                         "scenario, in the order of cell_data, NaN where unknown")
    return _seen(CellTarget(faces, centres, areas, noise_um), what)


def _seen(target: Target, what: str) -> Target:
    if target.count == 0:
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
