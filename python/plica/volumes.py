"""Cells as prisms, from volumes of labels."""
from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number, number_from, voxel_spacing
from .label_quality import LabelledTissue, measured_quality, rounded
from .label_files import read_labels
from .polygons import check_keep
from .voxel_labels import Labels, numbered_volume, whole_numbers
from .voxel_layer import Layer, layer_of
from .voxel_repair import repaired_labels
from .voxel_sides import FIRST, SECOND, Floats, Sides, sides_of
from .voxel_surfaces import RIM, Integers, components, face_places, steps_of

__all__ = ["tissue_of_labels"]

FLAT = 0.04          # difference of the areas of both sides, over their mean; less is no bend
CLEAR = 1.15         # ratio of a marker on both sides that tells which is apical
ONE_WAY = 0.3        # mean of normals; less and the layer faces all ways
LARGE_CELL = 1.7     # times the volume of a usual cell: two cells, which have about 2, may have one label,
LARGE_SPREADS = 2.5  # if it is also this many standard deviations of logarithms of volumes above it: cells of some tissues differ that much
NORMAL = 1.4826      # standard deviation of a normal distribution over the median of its absolute values
LEAST_HEIGHT, MOST_HEIGHT = 1, 300  # µm; cells that are lower or higher are few
WALL = 0.3           # of the face of a cube as large as a usual cell: smaller contacts are no wall
FEW_CELLS = 3        # and fewer are no layer
SAME = 0.01          # relative difference of spacings that are meant to be equal
OPENING = 1.5        # widths of a cell from the middle of an opening as small as missing cells leave
DIRECTIONS = {f"{sign}{axis}": (place, 1 if sign == "+" else -1) for place, axis in enumerate("zyx") for sign in "+-"}
SIDES = "\"outside\" or \"inside\" (of the bend), or a direction: \"+z\", \"-z\", \"+y\", \"-y\", \"+x\", \"-x\""


def tissue_of_labels(
    volume: Union[str, os.PathLike[str], ArrayLike],
    spacing_um: Optional[tuple[float, float, float]] = None,
    *,
    apical: Union[str, ArrayLike, None] = None,
    background: int = 0,
    gap_px: float = 1,
    keep_cut: bool = False,
    keep: str = "all",
) -> LabelledTissue:
    """Return the cells of one layer, from a volume of labels: sheet, tube, cyst or egg.

    Parameters
    ----------
    volume : path, or array_like of int, shape (planes, rows, columns)
        Cell number of each voxel; or its file: TIFF, OME-TIFF, NumPy or Zarr.
    spacing_um : (float, float, float), optional
        Distances of planes, rows and columns, µm. May be omitted for a file that has them.
    apical : str or array_like of float, shape (planes, rows, columns)
        Apical side: ``"outside"`` or ``"inside"`` of the bend, or the direction it faces, such as ``"+z"``. Or intensities of an apical
        marker: the brighter side is apical.
    background : int
        Label of voxels outside all cells. Labels far larger than cells, such as a lumen, count as background as well.
    gap_px : float
        Background between cells, up to twice this number of voxels of the finest axis, is given to the nearest cells; 0: none.
    keep_cut : bool
        Whether to keep cells cut by the border of the image.
    keep : str
        ``"largest"`` omits cells that share no wall with the largest piece of tissue; with ``"all"``, pieces are an error.

    Returns
    -------
    LabelledTissue
        Prisms with the rings of neighbours of the middle height, x along columns, y along rows, z along planes, and the origin at the
        centre of the first voxel. `cell_data` has ``label``, ``height_um``, ``taper`` (apical / basal area) and ``label_volume_um3``
        of each. `quality` compares them with the labels; `remarks` lists repairs.

    Warns
    -----
    UserWarning
        For each of `remarks`, which name cells and places.

    Raises
    ------
    ValueError
        If the array has the wrong shape or type, the cells are not one layer, or the apical side is not known.
    FileError
        If a file cannot be read.

    Examples
    --------
    >>> tissue = plica.tissue_of_labels("cyst.tif", (1, 0.3, 0.3), apical="inside")  # doctest: +SKIP
    >>> simulation = plica.Simulation(plica.Scenario({"format": 1}, tissue=tissue))  # doctest: +SKIP
    """
    tissue = measured_volume(volume, spacing_um, apical, background, gap_px, keep_cut, keep).tissue
    for remark in tissue.remarks:
        warnings.warn(f"volume: {remark}", stacklevel=2)
    return tissue


class MeasuredVolume(NamedTuple):
    """A tissue, the repaired labels that it is made of, and their free faces, of which those on one side are apical."""

    tissue: LabelledTissue
    labels: Labels
    sides: Sides
    apical: int


def measured_volume(volume: Any, spacing_um: Any, apical: Any, background: int, gap_px: float, keep_cut: bool, keep: str) -> MeasuredVolume:
    """Return the tissue of a volume, with what it is made of; arguments as for `tissue_of_labels`."""
    if isinstance(volume, (str, os.PathLike)):
        volume, found = read_labels(volume)
        spacing_um = found if spacing_um is None else spacing_um
    whole = whole_numbers(volume)
    spacing = voxel_spacing(spacing_um)
    number(background, "background", "one label")
    gap_px = number_from(gap_px, 0, "gap_px", "a width in voxels, 0 or more")
    check_keep(keep)
    marker = None if apical is None or isinstance(apical, str) else _marker(apical, volume)
    given = numbered_volume(whole, background, keep_cut)
    labels = repaired_labels(given, gap_px, spacing)
    volumes = _volumes(labels, spacing)
    contacts = contact_areas(labels.numbers, labels.cells, spacing)
    gaps = _gap_text(labels, contacts, gap_px, float(np.median(volumes[1:])))
    sides = sides_of(labels.numbers, labels.cells, spacing, np.array(list(contacts), dtype=np.int64).reshape(-1, 2))
    if not sides.spans.any():
        raise ValueError("volume: no cell reaches from one free side to the other; give one layer of cells, each with its number, and background on "
                         f"both sides{gaps or _cut_text(labels)}")
    layer = layer_of(labels.numbers, sides, spacing, volumes, contacts)
    first_is_apical = _first_is_apical(layer, labels, spacing, apical if isinstance(apical, str) else None, marker)
    kept = _kept(layer, labels, keep, gaps)
    tissue = _tissue(layer, labels, spacing, volumes, kept, first_is_apical)
    _tell(tissue, layer, labels, volumes, kept, {cell for pair in contacts for cell in pair})
    tissue.remarks = _size_remarks(tissue) + labels.remarks
    tissue.quality = measured_quality(tissue, layer, labels, spacing, contacts, kept, first_is_apical)
    return MeasuredVolume(tissue, labels, sides, FIRST if first_is_apical else SECOND)


def _marker(apical: Any, volume: Any) -> NDArray[Any]:
    marker = np.asarray(apical)
    if marker.shape != np.shape(volume) or marker.dtype.kind not in "biuf":
        raise ValueError(f"apical: an array of {marker.dtype} and shape {marker.shape}; give {SIDES}, or intensities of the shape of the volume")
    return marker


def _volumes(labels: Labels, spacing: Floats) -> Floats:
    total = np.zeros(labels.cells + 2, dtype=np.int64)
    for plane in labels.numbers:
        total += np.bincount(plane.ravel(), minlength=labels.cells + 2)
    return total[:-1].astype(np.float64) * float(np.prod(spacing))


def contact_areas(numbers: NDArray[Any], cells: int, spacing: Floats) -> dict[tuple[int, int], float]:
    """Return the area of voxel faces between each two cells that touch, the lower first; µm²."""
    found: dict[tuple[int, int], float] = {}
    flat = numbers.reshape(-1)
    for axis, step in enumerate(steps_of(numbers.shape)):
        one, other = flat[:-step], flat[step:]
        at = np.flatnonzero((one != other) & (one > 0) & (other > 0))
        low, high = np.minimum(one[at], other[at]).astype(np.int64), np.maximum(one[at], other[at]).astype(np.int64)
        keys, counts = np.unique((low * (cells + 2) + high)[high <= cells], return_counts=True)
        area = float(np.prod(spacing) / spacing[axis])
        for key, count in zip(keys.tolist(), counts.tolist()):
            pair = (key // (cells + 2), key % (cells + 2))
            found[pair] = found.get(pair, 0.0) + area * count
    return found


def _first_is_apical(layer: Layer, labels: Labels, spacing: Floats, apical: Optional[str], marker: Optional[NDArray[Any]]) -> bool:
    """Return whether the first side is apical. ValueError if that is not known."""
    sides = layer.sides
    inner = sides.spans[sides.faces.cell]
    area = [float(np.linalg.norm(sides.normals[inner & (sides.side == side)], axis=1).sum()) for side in (FIRST, SECOND)]
    if marker is not None:
        return _first_is_brighter(layer, labels, marker)
    bend = (area[0] - area[1]) / np.mean(area)
    way = sides.normals[sides.side == FIRST].sum(axis=0) / area[0]
    if apical is None:
        faces = f"faces {_direction(way)} and {_direction(-way)}" if np.linalg.norm(way) > ONE_WAY else "is bent around an inside"
        raise ValueError(f"apical: which side of the layer is apical is not known; the layer {faces}: give {SIDES}, or an apical marker")
    if apical in ("outside", "inside"):
        if abs(bend) < FLAT:
            raise ValueError(f"apical: \"{apical}\", but the layer is flat; it faces {_direction(way)} and {_direction(-way)}: give one of these")
        return bool((bend > 0) == (apical == "outside"))
    if apical not in DIRECTIONS:
        raise ValueError(f"apical: {apical!r:.60}; give {SIDES}")
    axis, sign = DIRECTIONS[apical]
    if abs(way[axis]) < ONE_WAY:
        raise ValueError(f"apical: \"{apical}\", but no side of the layer faces there; give {SIDES}")
    return bool(way[axis] * sign > 0)


def _direction(way: Floats) -> str:
    axis = int(np.argmax(np.abs(way)))
    return f"\"{'+' if way[axis] > 0 else '-'}{'zyx'[axis]}\""


def _first_is_brighter(layer: Layer, labels: Labels, marker: NDArray[Any]) -> bool:
    sides, shape = layer.sides, labels.numbers.shape
    middles = face_places(sides.faces, shape, np.ones(3)) + labels.origin
    mean = []
    for side in (FIRST, SECOND):
        at = middles[sides.side == side]
        both = [np.clip(rounded(at).astype(np.int64), 0, np.array(marker.shape) - 1) for rounded in (np.floor, np.ceil)]
        mean.append(float(np.mean([marker[tuple(one.T)].mean() for one in both])))
    if max(mean) < CLEAR * max(min(mean), 0):
        raise ValueError(f"apical: the marker has {mean[0]:.4g} and {mean[1]:.4g} on the two sides, which is too similar; give {SIDES}")
    return mean[0] > mean[1]


def _cut_cells(labels: Labels) -> Integers:
    """Return the cells at the border of the image."""
    numbers, beyond = labels.numbers, labels.cells + 1
    found = []
    for axis in range(3):
        for margin, inner in ((0, 1), (-1, -2)):
            plane = np.take(numbers, inner, axis)
            found.append(np.unique(plane[np.take(numbers, margin, axis) == beyond]))
    cut = np.unique(np.concatenate(found)).astype(np.int64)
    inside: Integers = cut[(cut > 0) & (cut < beyond)]
    return inside


def _gap_text(labels: Labels, contacts: dict[tuple[int, int], float], gap_px: float, usual_um3: float) -> str:
    """Return a remedy if most cells have no walls, or nothing."""
    walls = [pair for pair, area in contacts.items() if area > WALL * usual_um3 ** (2 / 3)]
    apart = labels.cells - len({cell for pair in walls for cell in pair})
    many = labels.cells > FEW_CELLS and apart > labels.cells / 2
    return f"; {apart} of {labels.cells} cells have no wall to another: raise gap_px, now {gap_px:g}" if many else ""


def _cut_text(labels: Labels) -> str:
    cut = len(_cut_cells(labels)) if labels.cells > FEW_CELLS else 0
    return f"; {cut} of {labels.cells} cells are cut by the border of the image: keep_cut = True keeps them" if cut else ""


def _kept(layer: Layer, labels: Labels, keep: str, gaps: str) -> list[int]:
    """Return the cells that become prisms, one piece. `gaps` is a remedy if these are wide."""
    cut = _cut_cells(labels)
    kept = [cell for cell in layer.rings if cell not in set(cut.tolist())]
    if len(cut):
        labels.remarks.append(f"cut by the border of the image, and omitted: {_cells(cut.tolist(), labels)}; keep_cut = True keeps them")
    if not kept:
        raise ValueError(f"volume: no cell has three corners where three cells meet{gaps or _cut_text(labels)}")
    pieces = _pieces(layer, kept)
    if len(pieces) > 1 and keep == "all":
        sizes = ", ".join(str(len(piece)) for piece in pieces[:5])
        cell = labels.names[pieces[1][0] - 1]
        raise ValueError(f"volume: the tissue is in {len(pieces)} pieces, which share no wall, of {sizes} cells (cell {cell} is in the second)"
                         + (gaps or "; keep = \"largest\" omits all but the first, or raise gap_px"))
    flawed = sorted({*layer.flawed} & {*pieces[0]})
    if flawed:
        raise ValueError("volume: no prisms between their neighbours, which surround them or lie inside them: "
                         f"{_cells(flawed, labels)}; correct these labels, or make them background")
    return sorted(pieces[0])


def _edges(layer: Layer, kept: list[int]) -> dict[frozenset[int], list[int]]:
    edges: dict[frozenset[int], list[int]] = {}
    for cell in kept:
        ring = layer.rings[cell]
        for pair in zip(ring, ring[1:] + ring[:1]):
            edges.setdefault(frozenset(pair), []).append(cell)
    return edges


def _pieces(layer: Layer, kept: list[int]) -> list[list[int]]:
    """Return the cells of each piece, the largest first."""
    walls = [(cells[0], other) for cells in _edges(layer, kept).values() for other in cells[1:]]
    return sorted(_joined(kept, walls), key=len, reverse=True)


def _joined(things: Iterable[int], pairs: list[tuple[int, int]]) -> list[list[int]]:
    """Return the groups of things that pairs connect, each in order."""
    names, rows = np.array(sorted(things), dtype=np.int64), np.array(pairs, dtype=np.int64).reshape(-1, 2)
    one, other = np.searchsorted(names, rows).T
    group = components(one, other, len(names)) if len(names) else names
    return [names[group == number].tolist() for number in range(int(group.max(initial=-1)) + 1)]


def _tissue(layer: Layer, labels: Labels, spacing: Floats, volumes: Floats, kept: list[int], first_is_apical: bool) -> LabelledTissue:
    top, bottom = (layer.first, layer.second) if first_is_apical else (layer.second, layer.first)
    used, renumbered = np.unique(np.concatenate([layer.rings[cell] for cell in kept]), return_inverse=True)
    offset = labels.origin * spacing
    apical, basal = ((places[used] + offset)[:, ::-1] for places in (top, bottom))
    rings = np.split(renumbered, np.cumsum([len(layer.rings[cell]) for cell in kept])[:-1])
    for number, ring in enumerate(rings):
        up = apical[ring].mean(axis=0) - basal[ring].mean(axis=0)
        middle = (apical + basal)[ring] / 2
        if (np.cross(middle, np.roll(middle, -1, axis=0)).sum(axis=0) @ up) < 0:
            rings[number] = ring[::-1]
    tissue = LabelledTissue(apical, basal, rings)
    tissue.spacing_um = (float(spacing[0]), float(spacing[1]), float(spacing[2]))
    areas = [tissue.polygons(side).areas for side in ("apical", "basal")]
    tissue.cell_data = {"label": labels.names[np.array(kept) - 1].astype(np.float64), "height_um": tissue.heights,
                        "taper": areas[0] / np.maximum(areas[1], 1e-12), "label_volume_um3": volumes[kept]}
    return tissue


def _size_remarks(tissue: LabelledTissue) -> list[str]:
    """Return remarks on a spacing that is probably in another unit or order."""
    height, (planes, rows, columns) = float(np.median(tissue.heights)), tissue.spacing_um
    found = []
    if not LEAST_HEIGHT < height < MOST_HEIGHT:
        found.append(f"cells are {rounded(height)} µm high (median): check that the spacing is in µm")
    uneven = abs(rows - columns) > SAME * columns
    if uneven or planes < (1 - SAME) * columns:
        found.append(f"spacing_um = ({planes:g}, {rows:g}, {columns:g}): {'rows and columns differ' if uneven else 'planes are finer than columns'}; "
                     "check the order, which is planes, rows, columns")
    return found


def _tell(tissue: LabelledTissue, layer: Layer, labels: Labels, volumes: Floats, kept: list[int], touching: set[int]) -> None:
    """Remark on cells that are missing, large, or touch on one side only."""
    cut = set(_cut_cells(labels).tolist())
    without = [cell for cell in range(1, labels.cells + 1) if volumes[cell] > 0 and cell not in layer.rings and cell not in cut]
    for which, what in (([cell for cell in without if cell not in touching], "isolated"),
                        ([cell for cell in without if cell in touching], "without three corners at the middle height")):
        if which:
            labels.remarks.append(f"{what}, and omitted: {_cells(which, labels)}")
    large = [cell for cell, is_large in zip(kept, large_cells(volumes[kept])) if is_large]
    if large:
        labels.remarks.append(f"more than {LARGE_CELL:g} times the volume of a usual cell, so two cells may have one label: "
                              f"{_cells(large, labels)}")
    lopsided = [cell for cell in kept if not layer.sides.spans[cell] and not any(RIM in layer.cells[column] for column in layer.rings[cell])]
    if lopsided:
        labels.remarks.append(f"on one side only, so that corners on the other follow the neighbours': {_cells(lopsided, labels)}")
    moved = sorted({*layer.evened} & {*kept})
    if moved:
        labels.remarks.append(f"flat or turned corners were evened out in {_cells(moved, labels)}")
    pairs = one_sided_pairs(layer, kept)
    if pairs:
        named = ", ".join(" and ".join(str(labels.names[cell - 1]) for cell in pair) for pair in pairs[:3])
        many = "1 pair of cells touches" if len(pairs) == 1 else f"{len(pairs)} pairs of cells touch"
        labels.remarks.append(f"{many} on one side only (scutoids), {named}{', …' if len(pairs) > 3 else ''}; the "
                              f"first at {labels.where(labels.place_of(pairs[0][0]))}: neighbours are those of the middle height")
    if loops := _openings(layer, kept):
        place = layer.middle[loops[0]].mean(axis=0) / layer.spacing
        many = f"an opening of {len(loops[0])} edges" if len(loops) == 1 else f"{len(loops)} openings of {_listed([len(loop) for loop in loops])} edges"
        labels.remarks.append(f"{many} in the layer, {'the first ' * (len(loops) > 1)}at {labels.where(np.round(place).astype(np.int64))}; "
                              "label missing cells, or leave it open")


def large_cells(volumes: Floats) -> NDArray[np.bool_]:
    """Return which cells are so much larger than usual, also for a tissue of cells of many sizes, that two may have one label."""
    logs = np.log(volumes / np.median(volumes))
    bound = max(float(np.log(LARGE_CELL)), LARGE_SPREADS * NORMAL * float(np.median(np.abs(logs))))
    return np.asarray(logs > bound)


def _cells(cells: list[int], labels: Labels) -> str:
    """Name cells and the place of the first."""
    named = _listed([labels.names[cell - 1] for cell in cells])
    return f"{len(cells)} cell{'s' if len(cells) > 1 else ''} ({named}; the first at {labels.where(labels.place_of(cells[0]))})"


def _listed(values: list[int]) -> str:
    return f"{', '.join(map(str, values[:5]))}{', …' * (len(values) > 5)}"


def one_sided_pairs(layer: Layer, kept: list[int]) -> list[tuple[int, int]]:
    """Return pairs of kept cells that share an edge on one side, but no corner on the other."""
    among = set(kept)
    shared = []
    for side in (FIRST, SECOND):
        meetings = layer.meetings[side]
        edges = {(one, other) for one, other in meetings.pairs.tolist() if one in among and other in among}
        corners = {(one, other) for cells in meetings.cells for one in cells for other in cells if one < other}
        shared.append((edges, corners))
    (first, first_corners), (second, second_corners) = shared
    return sorted((first - second_corners) | (second - first_corners))


def _openings(layer: Layer, kept: list[int]) -> list[list[int]]:
    """Return the columns around openings as small as missing cells leave."""
    free = [(min(edge), max(edge)) for edge, cells in _edges(layer, kept).items() if len(cells) == 1]
    loops = _joined({column for edge in free for column in edge}, free)
    reach = [np.linalg.norm(layer.middle[loop] - layer.middle[loop].mean(axis=0), axis=1).mean() for loop in loops]
    return [loop for loop, far in zip(loops, reach) if far < OPENING * layer.width]
