"""Comparison of prisms with the labels that they are made of: numbers, and a picture of slices."""
from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import needed
from .hexahedra import scaled_jacobians
from .prisms import PrismTissue
from .voxel_sides import FIRST, SECOND, Floats
from .voxel_surfaces import RIM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .voxel_labels import Labels
    from .voxel_layer import Layer

__all__ = ["LabelQuality", "LabelledTissue"]

GOOD = "good: neighbours over 95 %, corners under 1.5 voxels, volumes under 10 %, scaled Jacobian over 0.2"
LEAST_WALL = 0.02    # of a usual wall between labels: smaller ones are points


class LabelQuality:
    """How well prisms agree with labels (`LabelledTissue.quality`).

    Good are over 95 % of neighbours (scutoids are some of the others), corners within 1.5 voxels and volumes within 10 % (medians), and
    scaled Jacobians over 0.2, below which ``plica check`` warns.

    Attributes
    ----------
    neighbours_right : float
        Share of pairs of neighbours, in prisms or in labels, that are neighbours in both.
    corner_distance_um : ndarray of float, shape (corners,)
        Distance of apical and basal corners from where the labels meet, to a voxel.
    volume_error, apical_area_error, basal_area_error : ndarray of float, shape (cells,)
        Of the prism over that of the label, minus 1.
    voxel_um : float
        Mean size of a voxel.
    """

    def __init__(self, tissue: PrismTissue, neighbours_right: float, corner_distance_um: NDArray[np.float64],
                 errors: tuple[NDArray[np.float64], ...], voxel_um: float) -> None:
        self.neighbours_right, self.corner_distance_um, self.voxel_um = neighbours_right, corner_distance_um, voxel_um
        self.volume_error, self.apical_area_error, self.basal_area_error = errors
        self._tissue = tissue

    @cached_property
    def scaled_jacobian(self) -> NDArray[np.float64]:
        """Least scaled Jacobian of the elements of each cell, as made with the defaults of ``[embryo]``; 1 for a brick, 0 if flat."""
        least = np.ones(len(self._tissue.cells))
        np.minimum.at(least, self._tissue.element_cells, scaled_jacobians(self._tissue.points, self._tissue.hexahedra))
        return least

    def __repr__(self) -> str:
        off, flattest = int(np.argmax(np.abs(self.volume_error))), int(np.argmin(self.scaled_jacobian))
        label = self._tissue.cell_data["label"]
        return (f"neighbours right: {100 * self.neighbours_right:.1f} %\n"
                f"corners: {np.median(self.corner_distance_um) / self.voxel_um:.2f} voxels from the labels' (median)\n"
                f"volumes: {100 * np.median(np.abs(self.volume_error)):.1f} % off (median), {100 * abs(self.volume_error[off]):.0f} % at most, "
                f"in cell {label[off]:.0f}\n"
                f"areas: apical {100 * np.median(np.abs(self.apical_area_error)):.1f} %, basal "
                f"{100 * np.median(np.abs(self.basal_area_error)):.1f} % off (median)\n"
                f"scaled Jacobian: {self.scaled_jacobian[flattest]:.2f} at least, in cell {label[flattest]:.0f}\n{GOOD}")


class LabelledTissue(PrismTissue):
    """Tissue made by `plica.tissue_of_labels`.

    Attributes
    ----------
    quality : LabelQuality
        Comparison with the labels.
    remarks : list of str
        Repairs, and what was found in the labels.
    """

    quality: LabelQuality
    spacing_um: tuple[float, float, float]

    @property
    def sizes(self) -> str:
        """Median height and width of cells (root of volume over height), and the extent of the tissue, in words."""
        widths = np.sqrt(self.volumes / np.maximum(self.heights, 1e-12))
        extent = np.ptp(np.concatenate([self.apical, self.basal]), axis=0)
        return (f"{rounded(float(np.median(self.heights)))} µm high and {rounded(float(np.median(widths)))} µm wide (medians); tissue "
                f"{' × '.join(map(rounded, extent.tolist()))} µm (x, y, z)")

    def __repr__(self) -> str:
        return f"{super().__repr__()[:-1]}; cells {self.sizes})"

    def figure(self, volume: Union[str, os.PathLike[str], ArrayLike]) -> Figure:
        """Draw slices through the middle of the cells, along each axis: labels in colours, cells in outline.

        Parameters
        ----------
        volume : path or array_like of int
            The labels, as given to `tissue_of_labels`.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from .label_files import read_labels

        labels = np.asarray(read_labels(volume)[0] if isinstance(volume, (str, os.PathLike)) else volume)
        labels = labels.reshape([length for length in labels.shape if length > 1])
        figure = needed("matplotlib.figure", "a figure").Figure(figsize=(12, 4.4), layout="constrained")
        spacing = np.array(self.spacing_um)
        middle = np.median((self.apical + self.basal) / 2, axis=0)[::-1]
        triangles = _triangles(self)
        for axes, axis in zip(figure.subplots(1, 3), range(3)):
            plane = int(np.clip(round(float(middle[axis] / spacing[axis])), 0, labels.shape[axis] - 1))
            rest = [one for one in range(3) if one != axis]
            image = np.take(labels, plane, axis)
            low, high = -0.5 * spacing[rest], (np.array(image.shape) - 0.5) * spacing[rest]
            axes.imshow(_coloured(image), extent=(low[1], high[1], high[0], low[0]), interpolation="nearest")
            lines = _cut(triangles, axis, (plane + 1e-3) * spacing[axis])[:, :, rest][:, :, ::-1]
            axes.add_collection(needed("matplotlib.collections", "a figure").LineCollection(lines, colors="k", linewidths=0.6))
            axes.set(title=f"{'zyx'[axis]} = {plane * spacing[axis]:.4g} µm", xlabel=f"{'zyx'[rest[1]]} (µm)", ylabel=f"{'zyx'[rest[0]]} (µm)")
        return figure  # type: ignore[no-any-return]


def rounded(value: float) -> str:
    """Return a number of three digits."""
    return f"{float(f'{value:.3g}'):g}"


def measured_quality(tissue: PrismTissue, layer: Layer, labels: Labels, spacing: Floats, contacts: dict[tuple[int, int], float],
                     kept: list[int], first_is_apical: bool) -> LabelQuality:
    """Return the quality of a tissue whose cells are those of `kept`, in order."""
    among = set(kept)
    edges: dict[frozenset[int], list[int]] = {}
    for cell in kept:
        ring = layer.rings[cell]
        for pair in zip(ring, ring[1:] + ring[:1]):
            edges.setdefault(frozenset(pair), []).append(cell)
    ours = {tuple(sorted(cells)) for cells in edges.values() if len(cells) == 2}
    walls = {pair: area for pair, area in contacts.items() if pair[0] in among and pair[1] in among}
    usual = float(np.median(list(walls.values()))) if walls else 0.0
    theirs = {pair for pair, area in walls.items() if area > LEAST_WALL * usual}
    used = sorted({column for cell in kept for column in layer.rings[cell]})
    distances = [_from_meetings(places, layer, side, used) for side, places in ((FIRST, layer.first), (SECOND, layer.second))]
    area = np.linalg.norm(layer.sides.normals, axis=1)
    errors = [tissue.volumes / tissue.cell_data["label_volume_um3"] - 1]
    for side, name in ((FIRST if first_is_apical else SECOND, "apical"), (SECOND if first_is_apical else FIRST, "basal")):
        of = layer.sides.side == side
        measured = np.bincount(layer.sides.faces.cell[of], weights=area[of], minlength=labels.cells + 1)[kept]
        errors.append(tissue.polygons(name).areas / np.where(measured > 0, measured, np.nan) - 1)
    right = len(ours & theirs) / max(len(ours | theirs), 1)
    return LabelQuality(tissue, right, np.concatenate(distances), tuple(np.nan_to_num(one) for one in errors), float(np.prod(spacing) ** (1 / 3)))


def _from_meetings(places: Floats, layer: Layer, side: int, columns: list[int]) -> Floats:
    """Return the distance of columns from the nearest place where three of their cells meet; without those that have none."""
    meetings = layer.meetings[side]
    of_cell: dict[int, list[int]] = {}
    for corner, cells in enumerate(meetings.cells):
        for cell in cells - {RIM}:
            of_cell.setdefault(cell, []).append(corner)
    found = []
    for column in columns:
        cells = layer.cells[column]
        options = [corner for corner in of_cell.get(min(cells - {RIM}), []) if len(meetings.cells[corner] & cells) >= 3]
        if options:
            found.append(float(np.linalg.norm(meetings.place[options] - places[column], axis=1).min()))
    return np.array(found)


def _triangles(tissue: PrismTissue) -> Floats:
    """Return triangles of all faces of cells, z, y, x; shape (n, 3, 3)."""
    found = []
    for cell in tissue.cells:
        top, bottom = tissue.apical[cell], tissue.basal[cell]
        above, below = np.roll(top, -1, axis=0), np.roll(bottom, -1, axis=0)
        found += [(top.mean(axis=0) + 0 * top, top, above), (bottom.mean(axis=0) + 0 * top, bottom, below), (bottom, below, above), (bottom, above, top)]
    triangles: Floats = np.concatenate([np.stack(one, axis=1) for one in found])[:, :, ::-1]
    return triangles


def _cut(triangles: Floats, axis: int, at: float) -> Floats:
    """Return the segments in which a plane across an axis cuts triangles; shape (n, 2, 3)."""
    height = triangles[:, :, axis] - at
    crossed = (height.min(axis=1) < 0) & (height.max(axis=1) > 0)
    corners, height = triangles[crossed], height[crossed]
    signs = height > 0
    lone = np.where(signs.sum(axis=1) == 1, signs.argmax(axis=1), (~signs).argmax(axis=1))
    rows = np.arange(len(lone))
    ends = []
    for step in (1, 2):
        other = (lone + step) % 3
        share = height[rows, lone] / (height[rows, lone] - height[rows, other])
        ends.append(corners[rows, lone] + share[:, None] * (corners[rows, other] - corners[rows, lone]))
    return np.stack(ends, axis=1)


def _coloured(image: NDArray[Any]) -> NDArray[np.float64]:
    """Return light colours of labels, white for the most frequent, which is background."""
    names, number = np.unique(image, return_inverse=True)
    number = number.reshape(image.shape)
    colours = 0.45 + 0.5 * np.random.default_rng(3).uniform(size=(len(names), 3))
    colours[np.bincount(number.ravel()).argmax() if 0 not in names else int(np.searchsorted(names, 0))] = 1
    return np.asarray(colours[number])
