"""Damage to volumes of labels, as segmentations have it: each takes a volume and a random generator, and returns a volume.

As a script: makes N random volumes of drawn tissues with one to three damages each, and reports what becomes of them. Of some, cut cells
are kept, which gives the same cells as a margin around the image.
Usage: damaged_volumes.py [N [SEED]]
"""
import sys
import warnings

import numpy as np
from drawn_tissues import Cyst, Tube
from scipy import ndimage


def noise(volume, random):
    """Single voxels of other labels, or of background, anywhere."""
    at = random.uniform(size=volume.shape) < random.choice([0.002, 0.01])
    return np.where(at, random.permutation(volume[at])[np.cumsum(at.ravel()).reshape(at.shape) - 1], volume)


def rough_walls(volume, random):
    """Voxels take the label of a voxel one or two away."""
    for _ in range(random.integers(1, 3)):
        axis, step = random.integers(3), random.choice([-1, 1])
        moved = np.roll(volume, step, axis)
        volume = np.where(random.uniform(size=volume.shape) < 0.3, moved, volume)
    return volume


def holes(volume, random):
    """Balls of background in the tissue."""
    volume = volume.copy()
    places = np.argwhere(volume > 0)
    for place in places[random.integers(len(places), size=random.integers(1, 8))]:
        box = tuple(slice(max(one - 3, 0), min(one + 4, size)) for one, size in zip(place, volume.shape))
        far = sum((part - one)**2 for part, one in zip(np.mgrid[box], place))
        volume[box][far <= random.integers(1, 9)] = 0
    return volume


def gaps(volume, random):
    """Background of a voxel on each side of walls between cells."""
    volume = volume.copy()
    edges = np.zeros(volume.shape, dtype=bool)
    for axis in range(3):
        one, other = np.moveaxis(volume, axis, 0)[:-1], np.moveaxis(volume, axis, 0)[1:]
        np.moveaxis(edges, axis, 0)[:-1] |= (one != other) & (one > 0) & (other > 0)
    volume[edges] = 0
    return volume


def merged(volume, random):
    """Two neighbours have one label."""
    volume = volume.copy()
    for cell in random.choice(np.unique(volume)[1:], random.integers(1, 3)):
        around = np.unique(volume[ndimage.binary_dilation(volume == cell)])
        others = np.setdiff1d(around, [0, cell])
        if len(others):
            volume[volume == random.choice(others)] = cell
    return volume


def split(volume, random):
    """A cell has two labels, or its one label is in two parts by a slit."""
    volume = volume.copy()
    for cell in random.choice(np.unique(volume)[1:], random.integers(1, 3)):
        places = np.argwhere(volume == cell)
        way = random.normal(size=3)
        side = (places - places.mean(axis=0)) @ way / np.linalg.norm(way)
        if random.uniform() < 0.7:
            volume[tuple(places[side > 0].T)] = volume.max() + 1
        else:
            volume[tuple(places[abs(side) < 1].T)] = 0
    return volume


def missing(volume, random):
    """A cell is background."""
    return np.where(np.isin(volume, random.choice(np.unique(volume)[1:], random.integers(1, 3))), 0, volume)


def cut(volume, random):
    """The border of the image cuts the tissue."""
    axis = random.integers(3)
    most = volume.shape[axis] // 4
    low, high = random.integers(0, most), random.integers(0, most)
    return np.moveaxis(np.moveaxis(volume, axis, 0)[low:volume.shape[axis] - high], 0, axis)


def lower(volume, random):
    """A part of a cell belongs to its neighbours: it does not reach one side."""
    volume = volume.copy()
    cell = random.choice(np.unique(volume)[1:])
    places = np.argwhere(volume == cell)
    side = (places - places.mean(axis=0)) @ random.normal(size=3)
    goes = np.zeros(volume.shape, dtype=bool)
    goes[tuple(places[side > np.quantile(side, 0.7)].T)] = True
    others = (volume > 0) & ~goes & (volume != cell)
    nearest = ndimage.distance_transform_edt(~others, return_distances=False, return_indices=True)
    volume[goes] = volume[tuple(nearest)][goes]
    return volume


DAMAGES = {one.__name__: one for one in (noise, rough_walls, holes, gaps, merged, split, missing, cut, lower)}
FLAT = (2.5, 0.5, 0.5)  # planes five times as far as rows


def drawn(kind, spacing, seed, size=1.0):
    """Return labels, the apical side, and the drawing."""
    number = int(80 * size)
    tissue = {"cyst": lambda: Cyst(number, axes=(20, 20, 20), height=8, seed=seed),
              "egg": lambda: Cyst(int(1.5 * number), axes=(32, 16, 16), height=8, seed=seed),
              "tube": lambda: Tube(number, radius=16, length=40, height=8, seed=seed),
              "sheet": lambda: Tube(number, radius=45, length=45, height=10, sector=1.2, seed=seed)}[kind]()
    volume, _ = tissue.labels(spacing)
    return volume, "outside", tissue


def outcome(plica, volume, spacing, apical, keep_cut):
    """Return the tissue, or the error."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            tissue = plica.tissue_of_labels(volume, spacing, apical=apical, keep_cut=keep_cut)
            tissue.quality.scaled_jacobian  # makes the elements
            return tissue
        except (ValueError, plica.PlicaError) as error:
            return error


def differ(one, other, margin):
    """Return whether the second outcome, of the image with a margin in um, has other cells."""
    if isinstance(one, Exception) or isinstance(other, Exception):
        return type(one) is not type(other)
    return one.apical.shape != other.apical.shape or not np.allclose(one.apical + margin[::-1], other.apical)


def main():
    import plica

    count, seed = (int(word) for word in (sys.argv[1:] + ["200", "1"][len(sys.argv) - 1:])[:2])
    volumes = {(kind, spacing): drawn(kind, spacing, 3) for kind in ("cyst", "egg", "tube", "sheet") for spacing in ((0.5, 0.5, 0.5), FLAT)}
    ends = {"tissue": 0, "error": 0, "cut cells kept": 0, "other cells with a margin": 0}
    for number in range(count):
        random = np.random.default_rng([seed, number])
        kind, spacing = list(volumes)[random.integers(len(volumes))]
        volume, apical, tissue = volumes[kind, spacing]
        names = list(random.choice(list(DAMAGES), random.integers(1, 4), replace=False))
        for name in names:
            volume = DAMAGES[name](volume, random)
        keep_cut = random.uniform() < (0.7 if "cut" in names else 0.1)
        found = outcome(plica, volume, spacing, apical, keep_cut)
        what = f"{number:3d} {kind:5s} {spacing[0]:g} {' + '.join(names + ['keep_cut'] * keep_cut):40s}"
        if keep_cut:
            ends["cut cells kept"] += 1
            if differ(found, outcome(plica, np.pad(volume, 2), spacing, apical, False), 2 * np.array(spacing)):
                ends["other cells with a margin"] += 1
                what += " OTHER CELLS WITH A MARGIN"
        if isinstance(found, Exception):
            ends["error"] += 1
            print(f"{what} error: {found}")
        else:
            ends["tissue"] += 1
            quality = found.quality
            print(f"{what} {len(found.cells)} cells, neighbours {100 * quality.neighbours_right:.1f} %, volumes "
                  f"{100 * np.median(abs(quality.volume_error)):.1f} %, Jacobian {quality.scaled_jacobian.min():.2f}; {len(found.remarks)} remarks")
    print(ends)
    return ends["other cells with a margin"] > 0


if __name__ == "__main__":
    sys.exit(main())
