"""Volumes accepted as labels: whole numbers by voxel, as consecutive numbers of cells with a margin."""
from __future__ import annotations

from typing import Any, Iterator, NamedTuple

import numpy as np
from numpy.typing import NDArray

SLAB = 16            # planes at a time
LARGEST_DIRECT = 2**22  # of a label that is a place in a table
FEWEST_VOXELS = 8    # per label on average; fewer are intensities
SEGMENT = "segment the image first, for instance by skimage.segmentation.watershed or Cellpose"
MASK = ("volume: two values, which are no label of each cell; number the cells, for instance by skimage.measure.label, or by "
        "skimage.segmentation.watershed where they touch")
BACKGROUND = 15      # times the volume of a usual cell: larger labels are lumen, yolk or medium


class Labels(NamedTuple):
    """Numbers of cells by voxel, with a margin of one voxel or more that has no cells: 0 is background, `cells` + 1 beyond the image.

    `names` has the label of each number from 1; `origin` the voxel of the volume at the first one, z, y, x; `shape` that of the volume.
    """

    numbers: NDArray[Any]
    names: NDArray[np.int64]
    origin: NDArray[np.int64]
    shape: NDArray[np.int64]
    remarks: list[str]

    @property
    def cells(self) -> int:
        return len(self.names)

    def where(self, place: NDArray[Any]) -> str:
        """Describe a place in the array, z, y, x."""
        plane, row, column = np.clip(place + self.origin, 0, self.shape - 1).tolist()
        return f"plane {plane}, row {row}, column {column}"

    def place_of(self, number: int) -> NDArray[np.int64]:
        """Return the first voxel of a cell."""
        return np.array(np.unravel_index(int(np.argmax(self.numbers.reshape(-1) == number)), self.numbers.shape))


def numbered_volume(volume: NDArray[Any], background: int, keep_cut: bool) -> Labels:
    """Return the labels of a volume of `whole_numbers`."""
    names, counts = _labels_in(volume)
    remarks: list[str] = []
    is_cell = names != background
    usual = np.median(counts[is_cell]) if is_cell.any() else 0
    if volume.size < FEWEST_VOXELS * len(names):
        raise ValueError(f"volume: {len(names)} values in {volume.size} voxels, as intensities have; {SEGMENT}")
    for name, count in zip(names[is_cell].tolist(), counts[is_cell].tolist()):
        if is_cell.sum() > 3 and count > BACKGROUND * usual:
            is_cell[names == name] = False
            remarks.append(f"label {name}, of {count / usual:.0f} times the volume of a usual cell, was taken for background")
    if not is_cell.any():
        raise ValueError(f"volume: no cells; every voxel has label {background}, the background")
    if len(names) == 2 and is_cell.sum() == 1:
        raise ValueError(MASK)
    numbers = np.where(is_cell, np.cumsum(is_cell), 0)
    kept = names[is_cell]
    dtype = np.uint16 if len(kept) < 2**16 - 2 else np.uint32
    found, low = _mapped(volume, names, numbers.astype(dtype))
    return _with_margin(found, low, np.array(volume.shape), kept, keep_cut, remarks)


def _with_margin(found: NDArray[Any], low: NDArray[np.int64], shape: NDArray[np.int64], names: NDArray[Any], keep_cut: bool,
                 remarks: list[str]) -> Labels:
    borders = np.column_stack([low == 0, low + found.shape == shape])
    margin = np.array([[1 + (keep_cut and border and bool(np.take(found, end, axis).any())) for end, border in zip((0, -1), borders[axis])]
                       for axis in range(3)])  # of two voxels where kept cells meet the border, as elsewhere
    numbers = np.pad(found, margin)
    for axis in range(3):
        for end, border in zip((0, -1), borders[axis]):
            if border and not keep_cut:
                numbers[(slice(None),) * axis + (end,)] = len(names) + 1
    return Labels(numbers, names.astype(np.int64), low - margin[:, 0], shape, remarks)


def whole_numbers(volume: Any) -> NDArray[Any]:
    """Return a volume as an array of shape (planes, rows, columns). ValueError if it is none of labels."""
    if isinstance(volume, np.ma.MaskedArray) and np.any(volume.mask):
        raise ValueError("volume: voxels are masked; volume.filled(0) makes them background")
    array = np.asarray(volume)
    if array.ndim > 3 and sum(length > 1 for length in array.shape) <= 3:
        array = array.reshape([length for length in array.shape if length > 1])
    if array.ndim == 2:
        raise ValueError(f"volume: shape {array.shape}: one plane; plica.polygons_of_labels reads flat label images")
    if array.ndim != 3 or array.size == 0 or array.dtype.kind not in "biuf":
        raise ValueError(f"volume: shape {array.shape} of {array.dtype}; give whole numbers of shape (planes, rows, columns), one channel "
                         "and one time")
    if array.dtype.kind == "f":
        for slab in _slabs(array):
            if not np.isfinite(slab).all() or (slab != np.floor(slab)).any():
                raise ValueError("volume: values that are no whole numbers; give labels, one number per cell; for intensities, " + SEGMENT)
        array = array.astype(np.int64)
    if array.dtype.kind == "b":
        raise ValueError(MASK)
    return array


def _slabs(array: NDArray[Any]) -> Iterator[NDArray[Any]]:
    for start in range(0, len(array), SLAB):
        yield array[start:start + SLAB]


def _labels_in(volume: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Return the labels in a volume, in order, and their numbers of voxels."""
    if 0 <= int(volume.min()) and int(volume.max()) < LARGEST_DIRECT:
        counts = np.zeros(int(volume.max()) + 1, dtype=np.int64)
        for slab in _slabs(volume):
            counts += np.bincount(slab.ravel(), minlength=len(counts))
        names = np.flatnonzero(counts)
        return names, counts[names]
    found: dict[int, int] = {}
    for slab in _slabs(volume):
        for name, count in zip(*(part.tolist() for part in np.unique(slab, return_counts=True))):
            found[name] = found.get(name, 0) + count
    names = np.array(sorted(found), dtype=volume.dtype)
    return names, np.array([found[name] for name in names.tolist()])


def _mapped(volume: NDArray[Any], names: NDArray[Any], numbers: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Return the numbers of labels, in the box around all cells, and its first voxel."""
    table = None
    if 0 <= int(names[0]) and int(names[-1]) < LARGEST_DIRECT:
        table = np.zeros(int(names[-1]) + 1, dtype=numbers.dtype)
        table[names] = numbers
    found = np.empty(volume.shape, dtype=numbers.dtype)
    for slab, out in zip(_slabs(volume), _slabs(found)):
        out[...] = table[slab] if table is not None else numbers[np.searchsorted(names, slab)]
    box, low = [], []
    for axis in range(3):
        filled = np.flatnonzero(found.any(axis=tuple({0, 1, 2} - {axis})))
        start, stop = max(int(filled[0]) - 1, 0), min(int(filled[-1]) + 2, found.shape[axis])
        box.append(slice(start, stop))
        low.append(start)
    return found[tuple(box)], np.array(low)
