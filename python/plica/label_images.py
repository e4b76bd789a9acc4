"""Arrays accepted as label images: whole numbers, and outlines of cells in two values."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import told
from .errors import needed

BODY_RADIUS_PX = 2  # of the largest disc in the smallest region that counts as a cell; lines and specks are thinner
OUTSIDE_CELLS = 4   # a region at the border larger than this many cells lies outside the tissue


class LabelImage(NamedTuple):
    """Numbers of cells by pixel, shape (rows, columns); 0 is background. `names` has the label of each number from 1."""

    numbers: NDArray[np.int64]
    names: NDArray[np.int64]
    remarks: list[str]


def numbered(image: ArrayLike, background: int) -> LabelImage:
    """Return the label image in an array, which may have channels, or outlines in place of labels."""
    labels, call = _flat(image)
    names, numbers = np.unique(labels, return_inverse=True)
    numbers = numbers.reshape(labels.shape)
    remarks = []
    outlined = _cells_of_outlines(numbers, names, call) if len(names) == 2 else None
    if outlined is not None:
        names, numbers = np.unique(outlined[0], return_inverse=True)
        numbers, background = numbers.reshape(labels.shape), 0
        remarks.append(outlined[1])
    return LabelImage(np.where(names == background, 0, np.arange(1, len(names) + 1))[numbers], names.astype(np.int64), remarks)


def _flat(image: ArrayLike) -> tuple[NDArray[Any], str]:
    """Return whole numbers of shape (rows, columns), and the expression that gives them."""
    masked = np.argwhere(np.broadcast_to(image.mask, image.shape)) if isinstance(image, np.ma.MaskedArray) else np.empty((0, 2))
    if len(masked):
        raise ValueError(f"image: {len(masked)} pixels are masked, the first at {tuple(map(int, masked[0]))}; "
                         "image.filled(0) makes them background")
    labels, call = np.asarray(image), "image"
    if labels.dtype.kind in "SUO":
        raise ValueError(f"image: {told(image)}; give an array, by skimage.io.imread(\"labels.tif\") for instance")
    if labels.ndim > 2 and min(labels.shape) == 1:
        labels, call = np.squeeze(labels), "numpy.squeeze(image)"
    if labels.ndim == 3 and labels.shape[2] in (3, 4):
        if (labels[..., 1:3] != labels[..., :1]).any():
            raise ValueError(
                f"image: shape {labels.shape}: channels of colours differ. If each colour is one cell, give "
                "image[..., 0] * 65536 + image[..., 1] * 256 + image[..., 2] after image = image.astype(int); if lines of one "
                "colour separate cells, give (image[..., :3] == colour).all(axis=-1)")
        labels, call = labels[..., 0], f"{call}[..., 0]"
    if labels.ndim == 3:
        raise ValueError(
            f"image: shape {labels.shape}: a stack of planes; only flat label images of shape (rows, columns) are read: "
            "plica.tissue_of_labels makes cells of a stack")
    if labels.ndim != 2 or labels.size == 0 or labels.dtype.kind not in "biuf":
        raise ValueError(f"image: shape {labels.shape} of {labels.dtype}; give whole numbers of shape (rows, columns)")
    if labels.dtype.kind == "f":
        labels = _whole(labels)
    return labels, call


def _whole(labels: NDArray[Any]) -> NDArray[np.int64]:
    """Return floating-point labels, as some programs save them, as integers."""
    missing = np.argwhere(~np.isfinite(labels))
    if len(missing):
        raise ValueError(f"image: {len(missing)} pixels are not finite, the first at {tuple(map(int, missing[0]))}; "
                         "numpy.nan_to_num(image, posinf=0, neginf=0) makes them background")
    broken = np.argwhere(labels != np.floor(labels))
    if len(broken):
        first = tuple(map(int, broken[0]))
        raise ValueError(f"image: {labels[first]} at {first}; give whole numbers, one per cell; intensities need a segmentation "
                         "first, for instance skimage.segmentation.watershed")
    return labels.astype(np.int64)


def _cells_of_outlines(numbers: NDArray[Any], names: NDArray[Any], call: str) -> Optional[tuple[NDArray[Any], str]]:
    """Number the regions of an image of two values, 0 and 1 in `numbers`, one of which is that of the lines between cells.

    None if neither value has three regions, so that the image is one of few labels.
    """
    measure = needed("skimage.measure", "polygons of labels")
    distances = needed("scipy.ndimage", "polygons of labels").distance_transform_edt
    regions = [measure.label(numbers != line, connectivity=1) for line in (0, 1)]
    bodies = [len(np.unique(regions[line][distances(numbers != line) > BODY_RADIUS_PX])) for line in (0, 1)]
    calls = [f"skimage.measure.label({call} != {names[line]}, connectivity=1)" for line in (0, 1)]
    line = int(bodies[1] > bodies[0])
    if bodies[line] < 3:
        return None
    if bodies[line] < 3 * bodies[1 - line]:
        raise ValueError(f"image: two values, {names[0]} and {names[1]}, which are no label of each cell; number the cells: "
                         f"{calls[0]} if lines between cells have {names[0]}, {calls[1]} if they have {names[1]}")
    cells = regions[line]
    areas = np.bincount(cells.ravel())
    areas[0] = 0
    box = cells[tuple(slice(at.min(), at.max() + 1) for at in np.nonzero(cells))]  # without a line around the image
    border = np.unique(np.concatenate([box[0], box[-1], box[:, 0], box[:, -1]]))
    outside = border[areas[border] > OUTSIDE_CELLS * np.median(areas[1:])]
    cells[np.isin(cells, outside)] = 0
    return cells, (f"image: two values: {names[line]} was taken for lines around {bodies[line]} cells; labels are those of "
                   f"{calls[line]}")
