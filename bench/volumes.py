"""Figures of plica.tissue_of_labels: drawn tissues of 80 to 1000 cells against their drawings, and time and memory of a large volume.

Usage: volumes.py [--large]; the package is that of PYTHONPATH. The drawings are those of tests/python/drawn_tissues.py.
"""
import resource
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import plica
from scipy import spatial

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests/python"))
from drawn_tissues import Cyst, Tube, disagreement  # noqa: E402

VOXEL_UM = 0.5
TISSUES = {
    "cyst, 80 cells": (lambda: Cyst(80, axes=(24, 24, 24), height=10), "inside"),
    "cyst, 300 cells": (lambda: Cyst(300, axes=(30, 30, 30), height=12), "inside"),
    "egg with sharp poles, 400 cells": (lambda: Cyst(400, axes=(60, 25, 25), height=14), "outside"),
    "tube, 150 cells": (lambda: Tube(150, radius=20, length=80, height=10), "inside"),
    "bent sheet, 200 cells": (lambda: Tube(200, radius=60, length=90, height=15, sector=1.4), "outside"),
    "bent sheet, 1000 cells": (lambda: Tube(1000, radius=100, length=160, height=15, sector=1.6), "outside"),
}


def large():
    """Return an undulating sheet of 6000 cells in 200 planes of 1000 rows and columns."""
    random = np.random.default_rng(1)
    points = random.uniform(0, 1000, (6000, 2))
    rows, columns = np.mgrid[:1000, :1000]
    pixels = np.column_stack([rows.ravel(), columns.ravel()])
    for _ in range(3):
        nearest = spatial.cKDTree(points).query(pixels)[1]
        points = np.column_stack([np.bincount(nearest, pixels[:, axis], 6000) / np.bincount(nearest, minlength=6000) for axis in (0, 1)])
    cells = (1 + spatial.cKDTree(points).query(pixels)[1]).reshape(1000, 1000).astype(np.uint16)
    middle = 100 + 45 * np.sin(columns / 160) * np.cos(rows / 190)
    volume = np.zeros((200, 1000, 1000), np.uint16)
    for plane in range(200):
        volume[plane] = np.where(abs(plane - middle) < 32, cells, 0)
    return volume


def main():
    warnings.simplefilter("ignore")
    if "--large" in sys.argv:
        volume = large()
        begin, cpu = time.perf_counter(), time.process_time()
        tissue = plica.tissue_of_labels(volume, (VOXEL_UM,) * 3, apical="+z")
        print(f"{len(tissue.cells)} cells in {time.perf_counter() - begin:.0f} s ({time.process_time() - cpu:.0f} s of processor), "
              f"peak {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.1f} GB")
        return
    for name, (draw, apical) in TISSUES.items():
        drawing = draw()
        labels, origin = drawing.labels((VOXEL_UM,) * 3)
        begin = time.process_time()
        tissue = plica.tissue_of_labels(labels, (VOXEL_UM,) * 3, apical=apical)
        took = time.process_time() - begin
        right, off = disagreement(tissue, drawing, origin, apical)
        quality = tissue.quality
        print(f"{name}: {len(tissue.cells)} cells, neighbours right {100 * right:.2f} %, corners {np.median(off) / VOXEL_UM:.2f} voxels, "
              f"volumes {100 * np.median(abs(quality.volume_error)):.2f} %, scaled Jacobian {quality.scaled_jacobian.min():.2f}; {took:.0f} s")


if __name__ == "__main__":
    main()
