"""Shapes of cells in movies of labels, as measured outcomes."""
from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number, number_from, numbers, told, voxel_spacing
from .errors import needed
from .label_files import read_labels
from .label_images import numbered
from .label_quality import LabelledTissue
from .label_repair import without_gaps
from .labels import _junctions
from .polygons import Polygons
from .volumes import NORMAL, MeasuredVolume, measured_volume
from .voxel_surfaces import face_places
from .whole_cells import label_moments, moment_noise

if TYPE_CHECKING:
    import pandas

__all__ = ["LabelledShapes", "shapes_of_labels"]

Array = NDArray[np.float64]
FEWEST_TIMES = 4     # fewer do not tell noise and wrong labels from movement
FEWEST_FOUND = 0.5   # of the cells, in each frame
OUTLIER = 5.0        # standard deviations of the noise from a steady movement
MOVEMENT = 0.06      # of a cell's size, and
CHANGE = 0.1         # of the logarithm of its area or volume: smaller departures from a steady movement are no errors
FAR = 0.5            # of a cell's size: at least the way to another cell
OUTSIDE = -1         # in place of a cell


class _Measured(NamedTuple):
    """Cells in one frame, NaN where unknown, in µm: centres (cells, 3), areas and heights (cells,), corners (corners, 3); of whole cells,
    volumes (cells,), centroids (cells, 3) and second moments (cells, 6)."""

    centres: Array
    areas: Array
    heights: Array
    corners: Array
    volumes: Array
    centroids: Array
    moments: Array


class LabelledShapes(Mapping[float, dict[str, Array]]):
    """Shapes of the cells of a movie, by time in minutes: `shapes` of `plica.infer`. Made by `plica.shapes_of_labels`.

    ``shapes[time]`` has ``centres_um`` and ``areas_um2`` of cells in images, ``centroids_um`` and ``moments_um2`` of whole cells in
    volumes, NaN where they are unknown or doubtful, and of cells whose first label was another cell, such as two merged ones, or one
    whose label passed to a neighbour.

    Attributes
    ----------
    times_min : ndarray of float, shape (times,)
        Times.
    labels : ndarray of int
        Label of each cell in the first frame, in the order of the scenario.
    centres_um, areas_um2, heights_um : ndarray of float
        By time and cell, of apical faces, as measured; NaN where unknown, as z and heights are in images. In volumes, a constriction
        within the blur below the surface is missed, and so are borders of rounded cells at the rim.
    volumes_um3, centroids_um, moments_um2 : ndarray of float
        By time and cell, of whole cells, as measured; NaN in images. Moments: xx, yy, zz, xy, yz, xz about the centroid, over the volume.
    corners_um : ndarray of float, shape (times, corners, 3)
        Apical corners, in the order of ``points`` or ``apical`` of the cells; NaN where the same cells do not meet.
    rim : ndarray of int
        Corners on the outline of the tissue.
    doubtful : ndarray of bool
        By time and cell: those that depart from a steady movement further than the noise, as wrong labels do.
    noise_um : float
        Standard deviation of a coordinate in a frame, times sqrt(2), since each wall is measured once and counts in two cells: `noise_um`
        of `plica.infer`.
    remarks : list of str
        Cells that are missing or doubtful.
    """

    def __init__(self, times_min: Array, labels: NDArray[np.int64], measured: list[_Measured], rim: NDArray[np.int64], pixel_um: float) -> None:
        self.times_min, self.labels, self.rim = times_min, labels, rim
        (self.centres_um, self.areas_um2, self.heights_um, self.corners_um, self.volumes_um3, self.centroids_um,
         self.moments_um2) = (np.stack(one) for one in zip(*measured))
        self._is_image = bool(np.isnan(self.volumes_um3).all())
        self.doubtful, self.noise_um = _doubtful_and_noise(times_min, self._series(), pixel_um)
        self._is_other = self._first_was_other()
        self.remarks = self._told()

    def __getitem__(self, time_min: float) -> dict[str, Array]:
        at = np.flatnonzero(self.times_min == time_min)
        if len(at) == 0:
            raise KeyError(time_min)
        unknown = self.doubtful[at[0]] | self._is_other
        names = ("centres_um", "areas_um2") if self._is_image else ("centroids_um", "moments_um2")
        measured = {name: getattr(self, name)[at[0]] for name in names}
        return {name: np.where(unknown.reshape(-1, *(1,) * (values.ndim - 1)), np.nan, values) for name, values in measured.items()}

    def __iter__(self) -> Iterator[float]:
        return iter(self.times_min.tolist())

    def __len__(self) -> int:
        return len(self.times_min)

    def table(self) -> pandas.DataFrame:
        """Return one row per frame and cell: time_min, label, x_um, y_um, z_um, area_um2, height_um, doubtful."""
        times, cells = self.areas_um2.shape
        columns = dict(zip(("x_um", "y_um", "z_um"), self.centres_um.reshape(-1, 3).T))
        table: pandas.DataFrame = needed("pandas", "tables").DataFrame({
            "time_min": np.repeat(self.times_min, cells), "label": np.tile(self.labels, times), **columns,
            "area_um2": self.areas_um2.ravel(), "height_um": self.heights_um.ravel(), "doubtful": self.doubtful.ravel()})
        return table

    def _series(self) -> _Series:
        if self._is_image:
            size = float(np.sqrt(np.nanmedian(self.areas_um2)))
            # The noise of an area is sqrt(2 area) times that of a coordinate.
            sizes = np.log(self.areas_um2)[..., None] / np.sqrt(2)
            return _Series(size, self.centres_um[..., :2] / size, sizes, np.zeros((*sizes.shape[:2], 0)))
        size = float(np.cbrt(np.nanmedian(self.volumes_um3)))
        usual = moment_noise(np.nanmedian(self.moments_um2, axis=0), 1e-6) * 1e6
        return _Series(size, self.centroids_um / size, self.moments_um2 / (usual * size), np.log(self.volumes_um3)[..., None])

    def _first_was_other(self) -> NDArray[np.bool_]:
        """Return which cells are doubtful in the first frame, and in the next one where they are not have another size, or are far from
        there, apart from the movement that is common to all cells."""
        sizes, places = (self.areas_um2, self.centres_um[..., :2]) if self._is_image else (self.volumes_um3, self.centroids_um)
        later = (np.isfinite(sizes) & ~self.doubtful).argmax(axis=0), np.arange(len(self.labels))
        moved = places - places[0]
        with np.errstate(invalid="ignore"):
            far = np.linalg.norm(moved - np.nanmedian(moved, axis=1, keepdims=True), axis=2)[later] > FAR * self._series().size_um
            other = ~(np.abs(np.log(np.where(self.doubtful, np.nan, sizes)[later] / sizes[0])) < CHANGE)
        return np.asarray(self.doubtful[0] & (other | far))

    def _told(self) -> list[str]:
        remarks = []
        missing = np.isnan(self.areas_um2)
        for what, where in (("missing or cut", missing), ("doubtful", self.doubtful)):
            of_cell = where.sum(axis=0)
            cells = np.flatnonzero(of_cell)
            if len(cells):
                named = ", ".join(str(self.labels[cell]) for cell in cells[:5])
                many = "1 cell is" if len(cells) == 1 else f"{len(cells)} cells are"
                frames = " to ".join(str(one) for one in np.unique([of_cell[cells].min(), of_cell.max()]))
                remarks.append(f"{many} {what} in {frames} of {len(self)} frames: {named}{', …' if len(cells) > 5 else ''}")
        if len(self) < FEWEST_TIMES:
            remarks.append(f"noise_um is half a pixel, and wrong labels are not looked for: that takes {FEWEST_TIMES} frames")
        return remarks

    def __repr__(self) -> str:
        return f"LabelledShapes({len(self.labels)} cells at {len(self)} times, noise {self.noise_um:.3g} µm)"


def shapes_of_labels(
    frames: Mapping[float, Union[str, os.PathLike[str], ArrayLike]],
    spacing_um: Union[None, float, tuple[float, float, float]] = None,
    *,
    cells: Union[Polygons, LabelledTissue],
    links: Optional[ArrayLike] = None,
    apical: Optional[str] = None,
    background: int = 0,
    gap_px: float = 1,
) -> LabelledShapes:
    """Return the shapes of cells in a movie of tracked labels, for `plica.infer`.

    Parameters
    ----------
    frames : mapping of float to array_like of int, or to its file
        By time in minutes, 0 first: label images of shape (rows, columns), or volumes of shape (planes, rows, columns); the same
        region in all.
    spacing_um : float or (float, float, float), optional
        Size of a pixel, or distances of planes, rows and columns, µm. May be omitted for files of volumes that have them.
    cells : Polygons or LabelledTissue
        Cells of the frame at 0: from `plica.polygons_of_labels` for images, from `plica.tissue_of_labels` for volumes.
    links : array_like of float, shape (n, 3), optional
        Rows of time, label in that frame, and label of its cell at 0. Several labels may be of one cell: after a division, its
        daughters are taken together. By default, a cell keeps its label.
    apical : str, optional
        Apical side, as for `plica.tissue_of_labels`; for volumes only, where it is needed.
    background : int
        Label of pixels outside all cells.
    gap_px : float
        As for `plica.polygons_of_labels` and `plica.tissue_of_labels`.

    Returns
    -------
    LabelledShapes
        Centres, areas, corners and noise; of volumes also centroids and second moments of whole cells, which are compared. Corners are
        those of `cells` where the same cells meet again.

    Raises
    ------
    ValueError
        If frames differ in shape or spacing, have less than half of the cells, or `cells` have no labels or other ones; if `apical` is
        given for images.
    FileError
        If a file cannot be read.

    Notes
    -----
    A cell that is missing or cut by the border of the image is unknown in that frame. With four frames or more, what is measured is
    compared with a steady movement through the frame before and after. Departures give the noise; frames of a cell without which its
    movement is steady are doubtful, as where cells are merged, split or exchanged.

    Examples
    --------
    >>> import numpy as np, plica
    >>> rows, columns = np.mgrid[:80, :80]
    >>> movie = [1 + (rows // 20) * 4 + (columns + 10 * (rows // 20 % 2) + shift) // 20 for shift in (0, 1)]
    >>> cells = plica.polygons_of_labels(movie[0], um_per_pixel=0.5)
    >>> shapes = plica.shapes_of_labels({0: movie[0], 2: movie[1]}, 0.5, cells=cells)
    >>> (shapes[2]["centres_um"] - shapes[0]["centres_um"])[:, 0].round(1)
    array([-0.5, -0.5, -0.5, -0.5, -0.5])
    """
    given = _frames(frames)
    labels = _labels_of(cells)
    number(background, "background", "one label")
    gap_px = number_from(gap_px, 0, "gap_px", "a width in pixels, 0 or more")
    if apical is not None and isinstance(cells, Polygons):
        raise ValueError(f"apical: {told(apical)}, but images show one surface only; omit it, or give volumes and cells from tissue_of_labels")
    by_time = _links(links, given)
    cell_of = {label: cell for cell, label in enumerate(labels.tolist())}
    points, faces = (cells.points, cells.faces) if isinstance(cells, Polygons) else (cells.apical, cells.cells)
    meeting = _meeting(faces, np.arange(len(faces)), len(points))
    column = {met: corner for corner, met in enumerate(meeting) if meeting.count(met) == 1}
    measured: list[_Measured] = []
    first_shape: tuple[int, ...] = ()
    first_spacing: tuple[float, ...] = ()
    for time, frame in given.items():
        what = f"frames[{time:g}]"
        array, spacing = _read(frame, spacing_um, what, isinstance(cells, Polygons))
        if not measured:
            first_shape, first_spacing = array.shape, spacing
        if array.shape != first_shape or not np.allclose(spacing, first_spacing):
            raise ValueError(f"{what}: shape {array.shape} and spacing {spacing} µm; that at 0 has {first_shape} and {first_spacing} µm: cut "
                             "out the same region in all frames, with the same spacing")
        array = _renamed(array, by_time.get(time), labels)
        try:
            if isinstance(cells, Polygons):
                one = _of_image(array, spacing[0], background, gap_px, cell_of, column, len(points))
            else:
                one = _of_volume(array, spacing, apical, background, gap_px, cell_of, column, len(points))
        except ValueError as error:
            raise ValueError(f"{what}: {error}") from error
        found = int(np.isfinite(one.areas).sum())
        if found < FEWEST_FOUND * len(labels):
            advice = "give the frame that cells are made of" if time == 0 else "track the labels, or give links"
            raise ValueError(f"{what}: has {found} of {len(labels)} cells by their labels; {advice}")
        measured.append(one)
    rim = np.array([corner for corner, met in enumerate(meeting) if OUTSIDE in met], dtype=np.int64)
    shapes = LabelledShapes(np.array(list(given)), labels, measured, rim, float(np.min(first_spacing)))
    for remark in shapes.remarks:
        warnings.warn(f"frames: {remark}", stacklevel=2)
    return shapes


def _frames(frames: Any) -> dict[float, Any]:
    if not isinstance(frames, Mapping) or not frames:
        given = "is empty" if isinstance(frames, Mapping) else told(frames)
        raise TypeError(f"frames: {given}; give a mapping of times in minutes to labels")
    by_time = {number_from(time, 0, "frames", "times in minutes, 0 or later"): frame for time, frame in frames.items()}
    if 0 not in by_time:
        raise ValueError(f"frames: begin at {min(by_time):g} min; give that of the cells at 0, because changes since then are compared")
    return dict(sorted(by_time.items()))


def _labels_of(cells: Any) -> NDArray[np.int64]:
    if not isinstance(cells, (Polygons, LabelledTissue)):
        raise TypeError(f"cells: {told(cells)}; give what polygons_of_labels or tissue_of_labels returned")
    if "label" not in cells.cell_data:
        raise ValueError("cells: have no array \"label\"; give what polygons_of_labels or tissue_of_labels returned")
    labels = np.asarray(cells.cell_data["label"]).astype(np.int64)
    if len(np.unique(labels)) < len(labels):
        raise ValueError("cells: two have one label; give each cell its own")
    return labels


def _links(links: Optional[ArrayLike], frames: dict[float, Any]) -> dict[float, dict[int, int]]:
    """Return by time the label at 0 of each label."""
    by_time: dict[float, dict[int, int]] = {}
    if links is None:
        return by_time
    fits = "rows of time in minutes, label, and label at 0"
    rows = numbers(links, "links", fits)
    if rows.ndim != 2 or rows.shape[1] != 3 or not np.isfinite(rows).all() or (rows[:, 1:] != np.floor(rows[:, 1:])).any():
        raise ValueError(f"links: {told(rows)}; give {fits}")
    for time, label, first in rows.tolist():
        if time not in frames:
            raise ValueError(f"links: there is no frame at {time:g} min; give times of frames")
        if by_time.setdefault(time, {}).setdefault(int(label), int(first)) != first:
            raise ValueError(f"links: label {label:.0f} at {time:g} min is linked to {by_time[time][int(label)]} and {first:.0f}; link it once")
    return by_time


def _read(frame: Any, spacing_um: Any, what: str, is_image: bool) -> tuple[NDArray[Any], tuple[float, ...]]:
    if isinstance(frame, (str, os.PathLike)):
        frame, of_file = read_labels(frame)
        spacing_um = of_file if spacing_um is None else spacing_um
    array = np.squeeze(np.asarray(frame))
    dimensions, shape = (2, "(rows, columns)") if is_image else (3, "(planes, rows, columns)")
    if array.ndim != dimensions:
        raise ValueError(f"{what}: {told(array)}; give labels of shape {shape}, because cells are of such a frame")
    if is_image:
        return array, (number_from(spacing_um, 0, "spacing_um", "the size of a pixel in µm, above 0", above=True),)
    return array, tuple(voxel_spacing(spacing_um).tolist())


def _renamed(array: NDArray[Any], links: Optional[dict[int, int]], labels: NDArray[np.int64]) -> NDArray[Any]:
    """Return a frame with labels at 0; labels without a link get new ones."""
    if links is None:
        return array
    names, inverse = np.unique(array, return_inverse=True)
    new = int(max(labels.max(), names.max())) + 1 + np.arange(len(names))
    renamed = np.array([links.get(int(name), 0 if name == 0 else int(fresh)) for name, fresh in zip(names, new)])
    return np.asarray(renamed[inverse].reshape(array.shape))


def _meeting(faces: list[NDArray[np.int64]], cell: ArrayLike, corners: int) -> list[frozenset[int]]:
    """Return for each corner the cells that meet there, OUTSIDE among them at a free edge. `cell` numbers the faces."""
    found: list[set[int]] = [set() for _ in range(corners)]
    edges: dict[frozenset[int], int] = {}
    for face, number_of in zip(faces, np.asarray(cell).tolist()):
        ring = face.tolist()
        for one, other in zip(ring, ring[1:] + ring[:1]):
            found[one].add(number_of)
            edges[frozenset((one, other))] = edges.get(frozenset((one, other)), 0) + 1
    for edge, count in edges.items():
        for corner in edge if count == 1 else ():
            found[corner].add(OUTSIDE)
    return [frozenset(cells) for cells in found]


def _placed(places: Array, meeting: list[frozenset[int]], column: dict[frozenset[int], int], corners: int) -> Array:
    """Return the places of corners at which the same cells meet, once; NaN for others."""
    found = np.full((corners, 3), np.nan)
    number_of: dict[int, list[int]] = {}
    for place, met in enumerate(meeting):
        if met in column:
            number_of.setdefault(column[met], []).append(place)
    for corner, those in number_of.items():
        if len(those) == 1:
            found[corner] = places[those[0]]
    return found


def _of_image(image: NDArray[Any], pixel_um: float, background: int, gap_px: float, cell_of: dict[int, int],
              column: dict[frozenset[int], int], corners: int) -> _Measured:
    """Measure the pixels of cells."""
    given = numbered(image, background)
    closed = without_gaps(given.numbers, gap_px, [])
    count = len(given.names) + 1
    cell = np.array([OUTSIDE, *(cell_of.get(int(name), OUTSIDE) for name in given.names)])
    rows, columns = np.indices(closed.shape)
    pixels = np.bincount(closed.ravel(), minlength=count)[:count]
    with np.errstate(invalid="ignore", divide="ignore"):
        x, y = (np.bincount(closed.ravel(), axis.ravel(), minlength=count)[:count] / pixels for axis in (columns, len(closed) - 1 - rows))
    cut = np.unique(np.concatenate([closed[0], closed[-1], closed[:, 0], closed[:, -1]]))
    seen = (cell != OUTSIDE) & (pixels > 0)
    seen[cut] = False
    cells = len(cell_of)
    centres, areas = np.full((cells, 3), np.nan), np.full(cells, np.nan)
    centres[cell[seen], 0], centres[cell[seen], 1] = pixel_um * x[seen], pixel_um * y[seen]
    areas[cell[seen]] = pixel_um**2 * pixels[seen]
    beyond = count  # a frame around the image
    places, of_label = _junctions(np.pad(closed, 1, constant_values=beyond), needed("skimage.measure", "shapes of labels"))
    meeting: list[set[int]] = [set() for _ in places]
    for label, vertices in of_label.items():
        for vertex in vertices:
            meeting[vertex].add(OUTSIDE if label == beyond else int(cell[label]))
    at = np.reshape(places, (-1, 2)) - 1
    where = pixel_um * np.column_stack([at[:, 1], len(closed) - 1 - at[:, 0], np.full(len(at), np.nan)])
    unknown = np.full(cells, np.nan)
    return _Measured(centres, areas, unknown, _placed(where, [frozenset(one) for one in meeting], column, corners), unknown,
                     np.full((cells, 3), np.nan), np.full((cells, 6), np.nan))


def _of_volume(volume: NDArray[Any], spacing: tuple[float, ...], apical: Optional[str], background: int, gap_px: float,
               cell_of: dict[int, int], column: dict[frozenset[int], int], corners: int) -> _Measured:
    """Measure the prisms of cells, their labels, and the voxels of these on the apical side."""
    steps = np.array(spacing)
    made = measured_volume(volume, tuple(spacing), apical, background, gap_px, False, "largest")
    tissue, labels = made.tissue, made.labels
    cell = np.array([cell_of.get(int(label), OUTSIDE) for label in tissue.cell_data["label"]])
    seen = cell != OUTSIDE
    number = np.searchsorted(labels.names, tissue.cell_data["label"].astype(np.int64))

    def by_cell(values: Array) -> Array:
        found = np.full((len(cell_of), *values.shape[1:]), np.nan)
        found[cell[seen]] = values[seen]
        return found

    centres, areas = (by_cell(one[number]) for one in _apical_faces(made, steps))
    whole = [by_cell(one[number]) for one in label_moments(labels.numbers, labels.cells, steps, labels.origin * steps)]
    placed = _placed(tissue.apical, _meeting(tissue.cells, cell, len(tissue.apical)), column, corners)
    return _Measured(centres, areas, by_cell(tissue.heights), placed, whole[0], whole[1], whole[2])


def _apical_faces(made: MeasuredVolume, spacing: Array) -> tuple[Array, Array]:
    """Return centres (cells, 3), µm, and areas (cells,), µm², of the apical faces of numbers 1 and on."""
    labels, of = made.labels, made.sides.side == made.apical
    cell, area = made.sides.faces.cell[of] - 1, np.linalg.norm(made.sides.normals[of], axis=1)
    places = (face_places(made.sides.faces.select(of), labels.numbers.shape, spacing) + labels.origin * spacing)[:, ::-1]
    areas = np.bincount(cell, area, labels.cells).astype(np.float64, copy=False)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.stack([np.bincount(cell, area * axis, labels.cells) for axis in places.T], axis=1) / areas[:, None], areas


class _Series(NamedTuple):
    """Quantities of cells, shape (times, cells, quantities): places and sizes, in units of the size of a cell, with the same noise, and
    others that show wrong labels."""

    size_um: float
    places: Array
    sizes: Array
    others: Array


def _doubtful_and_noise(times: Array, given: _Series, pixel_um: float) -> tuple[NDArray[np.bool_], float]:
    """Return which cells depart from a steady movement, shape (times, cells), and the noise of coordinates, µm."""
    doubtful = np.zeros(given.places.shape[:2], dtype=bool)
    if len(times) < FEWEST_TIMES:
        return doubtful, 0.5 * pixel_um
    series = np.concatenate([given.places, given.sizes, given.others], axis=-1)
    places, sizes, others = (one.shape[-1] for one in given[1:])
    bound = np.maximum(OUTLIER * _spread(times, series), [MOVEMENT] * places + [CHANGE / np.sqrt(2)] * sizes + [CHANGE] * others)
    # What is common to all cells at a time, as a drift of the stage. Medians of places themselves would jump where cells are missing.
    common = np.zeros((len(times), 1, series.shape[2]))
    common[1:-1, 0] = np.linalg.solve(_departures(times, np.eye(len(times)))[:, 1:-1], np.nanmedian(_departures(times, series), axis=1))
    for cell in range(series.shape[1]):
        of_cell = (series - common)[:, cell] / bound
        known = np.flatnonzero(np.isfinite(of_cell).all(axis=1))
        doubtful[np.setdiff1d(known, _steady(times, of_cell, known)), cell] = True
    spread = _spread(times, np.where(doubtful[..., None], np.nan, series))
    of_places, of_sizes = (given.size_um * float(np.sqrt((one**2).mean())) for one in (spread[:places], spread[places:places + sizes]))
    # A row of walls with noise s: centres have the variance s² / 2, widths 2 s². Taken for independent, both tell twice as much as the walls.
    return doubtful, float(np.sqrt(2) * max(of_places, of_sizes, 1e-3 * pixel_um))


def _departures(times: Array, series: Array) -> Array:
    """Return how far each inner time is from the straight line through the time before and after, over the standard deviation of
    that for independent noise of 1; shape (times - 2, ...)."""
    share = (times[1:-1] - times[:-2]) / (times[2:] - times[:-2])
    return _off_line(series[:-2], series[1:-1], series[2:], share.reshape(-1, *(1,) * (series.ndim - 1)))


def _off_line(before: Array, at: Array, after: Array, share: Array) -> Array:
    """Return how far `at` is from this share of the way from `before` to `after`, as `_departures`."""
    return np.asarray((at - (1 - share) * before - share * after) / np.sqrt(1 + share**2 + (1 - share) ** 2))


def _spread(times: Array, series: Array) -> Array:
    """Return the standard deviation of the noise of each quantity, by medians; series has shape (times, cells, quantities)."""
    departures = _departures(times, series)
    departures -= np.nanmedian(departures, axis=1, keepdims=True)
    return np.asarray(NORMAL * np.nanmedian(np.abs(departures), axis=(0, 1)))


def _steady(times: Array, series: Array, known: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the times that remain without as few as possible, so that no departure exceeds 1, and of as many those which depart least;
    none if these are less than half."""
    longest = 2
    while True:
        longest *= 2
        kept = known[_steadiest(times[known], series[known], longest)]
        if len(known) - len(kept) <= longest or longest >= len(known):  # a longer gap leaves out more
            return kept if 2 * len(kept) >= len(known) else kept[:0]


def _steadiest(times: Array, series: Array, longest: int) -> NDArray[np.int64]:
    """Return the numbers of these times, with at most `longest` left out in a row; none if there are no such three or more.

    A shortest path: from a pair of times that follow each other to the next pair. Each departure costs its square, which is at most 1
    by quantity, and each time that is left out costs more than all of these.
    """
    count, price = len(times), float(series.size)
    cost, before = np.full((count, count), np.inf), np.full((count, count), -1)
    for last in range(1, count):
        at = np.arange(max(0, last - 1 - longest), last)
        cost[at, last] = np.where(at <= longest, (last - 1) * price, np.inf)  # as the first pair
        first = np.arange(max(0, at[0] - 1 - longest), last - 1)
        if len(first) == 0:
            continue
        share = (times[at, None] - times[first]) / (times[last] - times[first])
        departures = _off_line(series[first], series[at, None], series[last], share[..., None])
        ways = cost[np.ix_(first, at)].T + np.where(np.abs(departures).max(axis=2) <= 1, (departures**2).sum(axis=2), np.inf)
        ways += price * (last - at - 1)[:, None]
        best = ways.argmin(axis=1)
        least = ways[np.arange(len(at)), best]
        found = np.isfinite(least)
        cost[at[found], last], before[at[found], last] = least[found], first[best[found]]
    total = np.where(before >= 0, cost, np.inf) + price * (count - 1 - np.arange(count))
    total[:, :max(0, count - 1 - longest)] = np.inf
    if not np.isfinite(total).any():
        return np.zeros(0, dtype=np.int64)
    middle, end = (int(one) for one in np.unravel_index(total.argmin(), total.shape))
    path = [end, middle]
    while before[middle, end] >= 0:
        middle, end = int(before[middle, end]), middle
        path.append(middle)
    return np.array(path[::-1])
