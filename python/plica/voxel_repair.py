"""Repair of volumes of labels: gaps between cells, pieces, stray voxels, holes."""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .voxel_labels import SEGMENT, Labels
from .voxel_surfaces import Integers, components, steps_of

SMALL = 0.25     # of a usual cell: pieces of labels and holes up to this volume are repaired
SPECK = 0.05     # of a usual cell: smaller cells are given to their surroundings
MOST_PIECES = 0.5  # of labels: more further pieces are no accident
MOST_SPECKS = 20   # pieces of a label on average, if so: more are intensities
TOLD_GAPS = 0.005  # of the volume of all cells


class Runs(NamedTuple):
    """Runs of equal voxels along columns: first voxel, length, number, and the piece of equal voxels that each belongs to."""

    first: Integers
    length: Integers
    number: NDArray[Any]
    piece: Integers


def repaired_labels(labels: Labels, gap_px: float, spacing: NDArray[np.float64]) -> Labels:
    """Repair labels in place: no gaps between cells, each cell one piece without holes. `remarks` gets a line for each repair."""
    labels = labels._replace(names=_without_pieces(labels))
    if gap_px > 0 and _close_gaps(labels, gap_px, spacing):
        labels = labels._replace(names=_without_pieces(labels))
    return labels


def runs_of(numbers: NDArray[Any]) -> Runs:
    """Return the runs of a volume, and its pieces, connected by faces."""
    flat = numbers.reshape(-1)
    begins = np.empty(len(flat), dtype=bool)
    np.not_equal(flat[1:], flat[:-1], out=begins[1:])
    begins[::numbers.shape[2]] = True
    first = np.flatnonzero(begins)
    length = np.diff(np.append(first, len(flat)))
    number = flat[first]
    joined = []
    for step in steps_of(numbers.shape)[:2].tolist():
        inside = first + step < len(flat)
        start = np.searchsorted(first, first[inside] + step, side="right") - 1
        stop = np.searchsorted(first, first[inside] + length[inside] - 1 + step, side="right") - 1
        count = stop - start + 1
        one = np.repeat(np.flatnonzero(inside), count)
        other = np.repeat(start - np.cumsum(count) + count, count) + np.arange(len(one))
        same = number[one] == number[other]
        joined.append((one[same].astype(np.int32), other[same].astype(np.int32)))
    one, other = (np.concatenate(part) for part in zip(*joined))
    return Runs(first, length, number, components(one, other, len(first)))


def _voxels(runs: Runs, chosen: NDArray[np.bool_]) -> Integers:
    first, length = runs.first[chosen], runs.length[chosen]
    voxels: Integers = np.repeat(first - np.cumsum(length) + length, length) + np.arange(int(length.sum()))
    return voxels


def _without_pieces(labels: Labels) -> NDArray[np.int64]:
    """Give small pieces, specks and holes to their surroundings, in place; large pieces become cells. Return the labels of cells."""
    numbers = labels.numbers
    runs = runs_of(numbers)
    size = np.bincount(runs.piece, weights=runs.length).astype(np.int64)
    of, begin = np.zeros(len(size), dtype=np.int64), np.zeros(len(size), dtype=np.int64)
    of[runs.piece[::-1]], begin[runs.piece[::-1]] = runs.number[::-1], runs.first[::-1]
    cells, beyond = labels.cells, labels.cells + 1
    is_cell = (of > 0) & (of < beyond)
    largest = np.zeros(beyond + 1, dtype=np.int64)
    np.maximum.at(largest, of[is_cell], size[is_cell])
    usual = float(np.median(largest[largest > 0]))
    goes = is_cell & ((size < SPECK * usual) | ((size < largest[of]) & (size <= SMALL * usual)))
    hole = (of == 0) & (size <= SMALL * usual)
    hole[runs.piece[np.searchsorted(runs.first, _inner_margin(numbers.shape), side="right") - 1]] = False
    _tell(labels, goes, hole, of, size, begin, largest, numbers.shape)
    rest = is_cell & ~goes
    order = np.lexsort((-size, of))
    order = order[rest[order]]
    again = order[np.concatenate([[False], of[order][1:] == of[order][:-1]])]  # further large pieces of a label
    if len(again) > MOST_PIECES * cells:
        found = f"volume: its {cells} labels lie in "
        if is_cell.sum() > MOST_SPECKS * cells:
            raise ValueError(f"{found}{is_cell.sum()} pieces, as intensities do; {SEGMENT}")
        raise ValueError(f"{found}{rest.sum()} large pieces; number the pieces: skimage.measure.label(volume, connectivity=1)")
    names = labels.names
    if len(again):
        one = f"cell {names[of[again[0]] - 1]} ({size[again[0]]} voxels at {labels.where(_at(begin[again[0]], numbers.shape))})"
        named = ", ".join(map(str, names[of[again[:5]] - 1])) + ", …" * (len(again) > 5)
        labels.remarks.append(f"a piece of {one} was taken for a cell of its own; join them, if they are one" if len(again) == 1 else
                              f"{len(again)} pieces of cells {named} were taken for cells of their own, the first of {one}; join them, if they "
                              "are one, or number all cells differently")
    now = np.where(is_cell, of, np.where(of == beyond, beyond + len(again), 0))
    now[again] = cells + 1 + np.arange(len(again))
    flat = numbers.reshape(-1)
    if len(again):
        for piece in again.tolist():
            flat[_voxels(runs, runs.piece == piece)] = now[piece]
        margin = _voxels(runs, runs.number == beyond)
        flat[margin] = beyond + len(again)
        names = np.concatenate([names, names[of[again] - 1]])
    _fill(numbers, _voxels(runs, (goes | hole)[runs.piece]), len(names) + 1)
    return names


def _inner_margin(shape: tuple[int, ...]) -> Integers:
    """Return the voxels beside the margin, which reach beyond the image or are outside all cells."""
    steps = steps_of(shape)
    voxels = []
    for axis in range(3):
        one, other = ((axis + 1) % 3, (axis + 2) % 3)
        plane = np.arange(shape[one])[:, None] * steps[one] + np.arange(shape[other]) * steps[other]
        voxels += [plane.ravel() + place * steps[axis] for place in (1, shape[axis] - 2)]
    return np.concatenate(voxels)


def _at(voxel: int, shape: tuple[int, ...]) -> NDArray[np.int64]:
    return np.array(np.unravel_index(int(voxel), shape))


def _tell(labels: Labels, goes: NDArray[np.bool_], hole: NDArray[np.bool_], of: Integers, size: Integers, begin: Integers,
          largest: Integers, shape: tuple[int, ...]) -> None:
    whole = goes & (size == largest[of])
    for which, one, several in ((goes & ~whole, "piece", "pieces"), (whole, "cell", "cells"), (hole, "hole", "holes")):
        pieces = np.flatnonzero(which)
        if not len(pieces):
            continue
        most = int(pieces[np.argmax(size[pieces])])
        name = f" of cell {labels.names[of[most] - 1]}" if of[most] else ""
        what = "given to the surroundings" if of[most] else "filled"
        labels.remarks.append(f"{len(pieces)} small {one if len(pieces) == 1 else several} {what} (largest: "
                              f"{size[most]} voxel{'s' * (size[most] > 1)}{name} at {labels.where(_at(begin[most], shape))})")


def _fill(numbers: NDArray[Any], voxels: Integers, beyond: int, background: bool = True) -> None:
    """Give voxels the number that most of their neighbours have, in place, from outside inwards."""
    flat = numbers.reshape(-1)
    unknown = np.iinfo(numbers.dtype).max
    flat[voxels] = unknown
    steps = np.concatenate([-steps_of(numbers.shape), steps_of(numbers.shape)])
    while len(voxels):
        around = flat[voxels[:, None] + steps]
        known = (around != unknown) & (around != beyond) & ((around != 0) | background)
        votes = ((around[:, :, None] == around[:, None, :]) & known[:, None, :]).sum(axis=2) * known
        best = votes.argmax(axis=1)
        found = votes.max(axis=1) > 0
        if not found.any():
            flat[voxels] = 0
            return
        flat[voxels[found]] = around[found, best[found]]
        voxels = voxels[~found]


def _close_gaps(labels: Labels, gap_px: float, spacing: NDArray[np.float64]) -> bool:
    """Give background between cells to the nearest cell: gaps up to twice `gap_px` wide, a morphological closing by boxes.

    Return whether there was any.
    """
    numbers = labels.numbers
    radius = np.maximum(1, np.floor(gap_px * spacing.min() / spacing + 0.5)).astype(int)
    beyond = len(labels.names) + 1
    wide = np.pad((numbers > 0) & (numbers != beyond), radius[:, None])  # what is beyond the margin is no gap
    cells = np.count_nonzero(wide)
    for _ in range(2):  # dilation, then erosion
        wide = ~_spread(wide, radius)
    closed = wide[tuple(slice(one, -one) for one in radius.tolist())] & (numbers == 0)
    gaps = np.flatnonzero(closed)
    if len(gaps) > TOLD_GAPS * cells:
        labels.remarks.append(f"gaps between cells were closed: {100 * len(gaps) / (cells + len(gaps)):.2g} % of the tissue, the first at "
                              f"{labels.where(_at(gaps[0], numbers.shape))}")
    _fill(numbers, gaps, beyond, background=False)
    return len(gaps) > 0


def _spread(mask: NDArray[np.bool_], radius: NDArray[np.int64]) -> NDArray[np.bool_]:
    for axis, most in enumerate(radius.tolist()):
        wide = mask.copy()
        for step in range(1, most + 1):
            ahead, behind = [slice(None)] * 3, [slice(None)] * 3
            ahead[axis], behind[axis] = slice(step, None), slice(None, -step)
            wide[tuple(ahead)] |= mask[tuple(behind)]
            wide[tuple(behind)] |= mask[tuple(ahead)]
        mask = wide
    return mask
