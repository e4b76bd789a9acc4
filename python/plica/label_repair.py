"""Repair of label images: background between cells, labels in pieces, holes."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import needed

SPECK = 0.02        # of a usual cell: no smaller cell is kept, nor a smaller piece of one
SMALL = 0.25        # of a cell: pieces, holes and patches of background up to this part of its area are repaired
THIN_PX = 2         # from the middle to the pixels at the sides: pieces that are thinner and small are repaired
ALONG_STEP = 0.75   # px; by which pixels at the middle of an oblique line are farther from its sides than half its width
Numbers = NDArray[np.int64]


def _pixels(count: int) -> str:
    return f"{count} pixel{'' if count == 1 else 's'}"


def repaired(numbers: Numbers, names: NDArray[Any], gap_px: float, keep_cut: bool, remarks: list[str]) -> Numbers:
    """Close gaps between cells, and give small pieces and holes to their surroundings. `remarks` gets a line for each."""
    closed = without_gaps(without_holes(numbers, names, False, remarks), gap_px, remarks)
    return without_holes(without_pieces(closed, numbers, names, keep_cut, remarks), names, True, remarks)


def without_gaps(numbers: Numbers, gap_px: float, remarks: list[str]) -> Numbers:
    """Give background between cells to the nearest cell: lines up to twice `gap_px` wide, their junctions, small patches.

    The outside of the tissue, and openings in it, keep their shape: this is a morphological closing, in which patches that lines
    leave where they meet are closed as well.
    """
    empty = numbers == 0
    if not empty.any() or empty.all():
        return numbers
    ndimage = needed("scipy.ndimage", "polygons of labels")
    reach = gap_px + ALONG_STEP
    far, nearest = ndimage.distance_transform_edt(empty, return_indices=True)
    patches, _ = ndimage.label(far > reach, structure=np.ones((3, 3)))
    areas, of_cells = np.bincount(patches.ravel()), np.unique(numbers[~empty], return_counts=True)[1]
    small = areas <= SMALL * np.median(of_cells)
    small[np.concatenate([[0], patches[0], patches[-1], patches[:, 0], patches[:, -1]])] = False
    _tell_patches(small, areas, patches, far, reach, remarks, ndimage)
    stays = (patches > 0) & ~small[patches]
    if stays.any():
        stays = empty & (ndimage.distance_transform_edt(~stays) <= reach)
    return np.where(stays, 0, numbers[tuple(nearest)])


def _tell_patches(small: NDArray[Any], areas: NDArray[Any], patches: NDArray[Any], far: NDArray[Any], reach: float,
                  remarks: list[str], ndimage: Any) -> None:
    """Remark on patches that are wider than lines leave where they meet."""
    told = [int(patch) for patch in np.flatnonzero(small)]
    depths = ndimage.maximum(far, patches, told) if told else []
    told = [patch for patch, depth in zip(told, depths) if depth > 1.5 * reach + 1]
    if told:
        row, column = np.argwhere(patches == told[0])[0]
        remarks.append(f"{len(told)} patches of background between cells (the first of {areas[told[0]]} pixels at row {row}, "
                       f"column {column})")


def without_pieces(numbers: Numbers, given: Numbers, names: NDArray[Any], keep_cut: bool, remarks: list[str]) -> Numbers:
    """Keep the largest piece of each label, and give smaller pieces, and specks, to their surroundings.

    Labels whose pieces of similar size are all cut by the border of the image stay as they are, unless `keep_cut`.
    """
    if not numbers.any():
        return numbers
    measure, ndimage = (needed(package, "polygons of labels") for package in ("skimage.measure", "scipy.ndimage"))
    pieces = measure.label(numbers, background=0, connectivity=2)
    found = measure.regionprops_table(pieces, properties=("label", "area", "coords"))
    piece, area = found["label"], found["area"]
    first = np.array([coords[0] for coords in found["coords"]]).reshape(-1, 2)
    of = numbers[tuple(first.T)]
    largest = np.zeros(int(numbers.max()) + 1)
    np.maximum.at(largest, of, area)
    usual = np.median(largest[largest > 0])
    # Distances to the nearest pixel of another label: corners of thin pieces lie too close to each other to be told apart.
    edges = needed("skimage.segmentation", "polygons of labels").find_boundaries(numbers, mode="inner")
    width = ndimage.maximum(ndimage.distance_transform_edt(~edges), pieces, piece)
    large = (area > SMALL * largest[of]) & (area > np.where(width < THIN_PX, SMALL, SPECK) * usual)
    cut = np.isin(piece, np.concatenate([pieces[0], pieces[-1], pieces[:, 0], pieces[:, -1]])) & (not keep_cut)
    torn = (np.bincount(of[large], minlength=len(largest)) > 1) & (np.bincount(of[large & ~cut], minlength=len(largest)) > 0)
    if torn.any():
        _refuse_pieces(np.flatnonzero(torn[of] & large), len(piece), area, of, first, names)
    # Pieces without a given pixel are left by the closing of gaps.
    drawn = np.bincount(pieces.ravel(), weights=(given == numbers).ravel())[piece].astype(np.int64)
    for one in np.flatnonzero(~large & ~cut & (drawn > 0)):
        piece_of = "piece of " if largest[of[one]] > area[one] else ""
        (row, column), cell = first[one], names[of[one] - 1]
        remarks.append(f"{piece_of}cell {cell} ({_pixels(drawn[one])} at row {row}, column {column})")
    return given_away(numbers, np.isin(pieces, piece[~large]))


def given_away(numbers: Numbers, pixels: NDArray[np.bool_]) -> Numbers:
    """Give pixels the number of the nearest other pixel, which may be background."""
    if not pixels.any():
        return numbers
    nearest = needed("scipy.ndimage", "polygons of labels").distance_transform_edt(pixels, return_distances=False, return_indices=True)
    return np.asarray(numbers[tuple(nearest)])


def _refuse_pieces(torn: NDArray[Any], count: int, area: NDArray[Any], of: NDArray[Any], first: NDArray[Any],
                   names: NDArray[Any]) -> None:
    """Raise ValueError for labels with pieces of similar size, and for images of intensities."""
    if count > 10 * len(names):
        raise ValueError(f"image: its {len(names)} values lie in {count} pieces, as intensities do; segment it first, for instance by "
                         "skimage.segmentation.watershed; if it shows lines with soft edges, give image > image.max() / 2")
    pair = torn[of[torn] == of[torn[0]]][:2]
    sizes = " and of ".join(f"{area[one]:.0f} pixels at row {first[one][0]}, column {first[one][1]}" for one in pair)
    raise ValueError(f"image: cell {names[of[pair[0]] - 1]} is in pieces, of {sizes} ({len(np.unique(of[torn]))} cells in all); join "
                     "them, or let skimage.measure.label(image, connectivity=1) give each piece a label of its own")


def without_holes(numbers: Numbers, names: NDArray[Any], of_cells: bool, remarks: list[str]) -> Numbers:
    """Fill holes in cells that contain background only, or, if `of_cells`, small cells as well."""
    measure, ndimage = (needed(package, "polygons of labels") for package in ("skimage.measure", "scipy.ndimage"))
    filled = numbers.copy()
    for region in measure.regionprops(numbers):
        holes = ndimage.binary_fill_holes(region.image) & ~region.image
        if not holes.any():
            continue
        box, cell = region.slice, names[region.label - 1]
        row, column = np.argwhere(holes)[0] + region.bbox[:2]
        inside = np.unique(numbers[box][holes])
        if inside.any() and not of_cells:
            continue
        where = f"hole in cell {cell} ({_pixels(holes.sum())} at row {row}, column {column})"
        if inside.any() and holes.sum() > SMALL * (region.area + holes.sum()):
            within = ", ".join(str(names[number - 1]) for number in inside if number)
            raise ValueError(f"image: {where} contains cell {within}; image[scipy.ndimage.binary_fill_holes(image == {cell})] = {cell} "
                             "fills it; or draw a wall from it to another cell")
        filled[box][holes] = region.label
        remarks.append(where)
    return filled


def openings(numbers: Numbers) -> NDArray[np.int64]:
    """Return row, column and pixels of the patches of background that cells surround, the largest first; shape (patches, 3)."""
    ndimage = needed("scipy.ndimage", "polygons of labels")
    patches, count = ndimage.label(np.pad(numbers == 0, 1, constant_values=True), structure=np.ones((3, 3)))
    inside = np.setdiff1d(np.arange(1, count + 1), patches[0, 0])
    areas = np.bincount(patches.ravel(), minlength=count + 1)[inside]
    places = np.array(ndimage.maximum_position(patches > 0, patches, inside) if len(inside) else [], dtype=np.int64).reshape(-1, 2) - 1
    return np.column_stack([places, areas])[np.argsort(-areas, kind="stable")]
