"""Cells as polygons, around their centres in an open sheet."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number_from, numbers
from .errors import needed
from .label_repair import without_gaps
from .labels import traced
from .polygons import Polygons, check_keep, one_piece, parted

__all__ = ["polygons_of_centres"]

PIXELS = 50         # between usual neighbours, in the image on which cells meet
MOST_PIXELS = 4e7
NEIGHBOURS = 6      # of a usual cell
WIDER = (1.25, 1.5, 2)  # reaches that are tried, to advise one
USUAL_REACH = 0.9   # of the distance of neighbours: a missing cell leaves a hole


def polygons_of_centres(
    centres: ArrayLike,
    *,
    reach_um: Optional[float] = None,
    cell_data: Optional[Mapping[str, ArrayLike]] = None,
    keep: str = "all",
) -> Polygons:
    """Return Voronoi polygons around the centres of cells in an open sheet, flat or curved.

    A closed embryo needs ``shape = "points"`` instead.

    Parameters
    ----------
    centres : array_like of float, shape (n, 2) or (n, 3)
        Centres on the apical surface, µm. With z, the apical side is up, and the sheet may be curved but not overhang.
    reach_um : float, optional
        Places farther than this from every centre are outside the tissue, µm; 0.9 of the distance of usual neighbours if
        omitted. Cells at the rim end half this distance outside their centres.
    cell_data : mapping of str to array_like, optional
        Arrays with one number per centre.
    keep : str
        ``"largest"`` omits cells that share no edge with the largest piece of tissue; with ``"all"``, pieces are an error.

    Returns
    -------
    Polygons
        Polygons accurate to 2 % of the distance of neighbours. `cell_data` has ``label``, the row of each centre, and the given
        arrays.

    Raises
    ------
    ValueError
        If a shape is wrong, a number is not finite, the sheet overhangs, or cells are in pieces.

    Examples
    --------
    >>> import numpy as np, plica
    >>> row, column = np.indices((6, 6)).reshape(2, -1)
    >>> plica.polygons_of_centres(8 * np.column_stack([column + row % 2 / 2, 0.87 * row]))  # doctest: +SKIP
    Polygons(36 cells, 98 vertices)
    """
    places = numbers(centres, "centres", "(n, 2) or (n, 3), x, y and z in µm")
    if places.ndim != 2 or places.shape[1] not in (2, 3) or len(places) <= NEIGHBOURS:
        raise ValueError(f"centres: shape {places.shape}; give (n, 2) or (n, 3), x, y and z of {NEIGHBOURS + 1} or more centres, in µm")
    if not np.isfinite(places).all():
        row = int(np.argwhere(~np.isfinite(places))[0, 0])
        raise ValueError(f"centres: row {row} is {places[row]}; give finite numbers")
    check_keep(keep)
    places = np.column_stack([places, np.zeros((len(places), 3 - places.shape[1]))])
    given = Polygons(np.zeros((3, 3)), [[0, 1, 2]] * len(places), cell_data).cell_data  # checked
    axes, flat = _flattened(places)
    tree = needed("scipy.spatial", "polygons of centres").cKDTree(flat[:, :2])
    distance = float(np.median(tree.query(flat[:, :2], NEIGHBOURS + 1)[0][:, 1:].mean(axis=1)))
    _refuse_overhang(flat, tree, distance)
    reach = USUAL_REACH * distance if reach_um is None else reach_um
    reach = number_from(reach, distance / 2, "reach_um", f"at least half the distance of neighbours, {distance / 2:.3g} µm")
    polygons = _around(flat, tree, distance, reach)
    polygons.points = polygons.points @ axes + places.mean(axis=0)
    polygons.cell_data.update({name: values[polygons.cell_data["label"]] for name, values in given.items()})
    polygons = one_piece(polygons, keep, "centres", lambda: _advice(flat, tree, distance, reach))
    parted(polygons, distance / PIXELS)
    return polygons


def _advice(flat: NDArray[np.float64], tree: Any, distance: float, reach: float) -> str:
    """Return as a remedy a reach that makes the cells one tissue, if there is one."""
    for wider in (factor * reach for factor in WIDER):
        if _around(flat, tree, distance, wider).pieces.max() == 0:
            return f"; set reach_um = {wider:.3g}, if they are neighbours"
    return ""


def _flattened(places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return axes of the sheet as rows, the last of them its mean normal, upwards, and the places along them."""
    middle = places.mean(axis=0)
    axes: NDArray[np.float64] = np.linalg.svd(places - middle, full_matrices=False)[2]
    normal = axes[2] if abs(axes[2, 2]) < 1e-9 else axes[2] * np.sign(axes[2, 2])
    first = np.eye(3)[0] - normal[0] * normal  # along x, so that a flat sheet stays as it is
    first = axes[0] if np.linalg.norm(first) < 0.1 else first / np.linalg.norm(first)
    axes = np.array([first, np.cross(normal, first), normal])
    return axes, (places - middle) @ axes.T


def _refuse_overhang(flat: NDArray[np.float64], tree: Any, distance: float) -> None:
    near = tree.query_pairs(0.5 * distance, output_type="ndarray")
    steep = near[np.abs(np.diff(flat[near, 2], axis=1)).ravel() > 1.5 * distance]
    if len(steep):
        raise ValueError(f"centres: rows {steep[0, 0]} and {steep[0, 1]} lie above each other: the sheet overhangs; give a part that does "
                         "not, or, for a closed embryo, shape = \"points\"")


def _around(flat: NDArray[np.float64], tree: Any, distance: float, reach: float) -> Polygons:
    """Return the polygons in the plane of the sheet, with heights of the corners; ``label``: row."""
    pixel = distance / PIXELS
    origin = flat[:, :2].min(axis=0) - reach - 3 * pixel
    columns, rows = np.ceil((flat[:, :2].max(axis=0) + reach + 3 * pixel - origin) / pixel).astype(int)
    if rows * columns > MOST_PIXELS:
        raise ValueError(f"centres: {len(flat)} cells lie in {columns * pixel:.4g} by {rows * pixel:.4g} µm, {distance:.3g} µm apart; give a part of "
                         "the tissue, of at most about 10 000 cells")
    row, column = np.indices((rows, columns))
    pixels = np.column_stack([origin[0] + column.ravel() * pixel, origin[1] + (rows - 1 - row).ravel() * pixel])
    far, nearest = (found.reshape(rows, columns) for found in tree.query(pixels))
    # What lies farther than `reach` from all centres grows back to half the distance of neighbours.
    to_outside = needed("scipy.ndimage", "polygons of centres").distance_transform_edt(far <= reach) * pixel
    numbers = np.where((far <= reach) & (to_outside >= reach - distance / 2), nearest + 1, 0)
    polygons = traced(without_gaps(numbers, 0, []), True)
    polygons.cell_data["label"] = polygons.cell_data["label"] - 1
    points = polygons.points * pixel + [origin[0], origin[1] + (rows - 1) * pixel, 0]
    # Planes through the nearest centres.
    near = tree.query(points[:, :2], NEIGHBOURS + 1)[1]
    steps = flat[near, :2] - points[:, None, :2]
    points[:, 2] = (np.linalg.pinv(np.insert(steps, 0, 1, axis=2))[:, 0] * flat[near, 2]).sum(axis=1)
    polygons.points = points
    return polygons
