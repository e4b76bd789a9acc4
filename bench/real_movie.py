#!/usr/bin/env python3
"""Tensions from a real movie: five segmented frames of the mucociliary epithelium of a frog embryo, which come with ForSys.

usage: real_movie.py DIR, with a Python that finds plica, as build/venv's with PYTHONPATH=build/release/python. DIR is
examples/data/in_vivo of https://github.com/borgesaugusto/forsys at commit 18cf553 (BSD 3-Clause; Borges et al., "ForSys: non-invasive
stress inference from time-lapse microscopy", doi:10.5281/zenodo.11282555): t_0.tif to t_4.tif, 1.9 MB each, outlines one pixel wide.

The files have neither the size of a pixel nor times, so lengths are in units of a cell, set to 10 µm, and a frame counts as a minute.
Heights and elasticity are guesses as well: an elastic sheet with apical tension that is on from the first frame. Tensions come from
frames 0 to 3; the last one is predicted. What all cells move together is left out. Prints JSON: cells, spread of their sizes, noise,
doubtful cells, movement since frame 3, and error of its prediction (root mean squares).
"""
import json
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np
import plica
from label_movies import tracked
from plica.shape_targets import ApicalFaces
from skimage.measure import label
from tifffile import imread

LAW = "cortex.apical"
CELL_UM = 10


def labels_of(path):
    """Return labels of the outlined cells; the line around the image and what it encloses are background."""
    labels = label(imread(path)[..., 0] == 0, connectivity=1)
    labels[labels == np.argmax(np.bincount(labels.ravel())[1:]) + 1] = 0
    return labels


def main():
    frames = [labels_of(Path(sys.argv[1]) / f"t_{number}.tif") for number in range(5)]
    size_px = np.sqrt(np.median(np.bincount(frames[0].ravel())[1:]))
    pixel_um = CELL_UM / size_px
    with warnings.catch_warnings(), tempfile.TemporaryDirectory() as folder:
        warnings.simplefilter("ignore")
        cells = plica.polygons_of_labels(frames[0], pixel_um)
        shapes = plica.shapes_of_labels(dict(enumerate(frames)), pixel_um, cells=cells, links=tracked(dict(enumerate(frames)), size_px / 2))
        print(shapes, *shapes.remarks, sep="\n", flush=True)
        cells.write(Path(folder) / "cells.ply")
        scenario = plica.Scenario({
            "embryo": {"shape": "surface", "file": str(Path(folder) / "cells.ply"), "cell_height_um": CELL_UM, "elements": "kites"},
            "elasticity": {"young_modulus_Pa": 200, "poisson_ratio": 0.45},
            "cortex": {"apical": {"region": "all", "tension_mN_per_m": 0.2, "saturation_ratio": 0.2},
                       "passive": {"region": "all", "stiffness_mN_per_m": 1}},
            "foundation": {"below": {"region": "all", "stiffness_nN_per_um3": 0.5, "resists": "normal"}},
            "dynamics": {"surface_drag_Pa_s_per_um": 500}, "time": {"end_min": 4}, "stop": {"at_equilibrium": False}})
        found = plica.infer(scenario, {time: shapes[time] for time in range(4)}, of=LAW, noise_um=shapes.noise_um, drift="xy")
        print(found, flush=True)
        tape = plica.record(scenario, at_min=[3, 4], strengths=found.strengths)
        faces = ApicalFaces(plica.Simulation(scenario), tape._core.surface_nodes("apical"), len(cells))
    places = [faces.of(tape.positions(time))[0].copy() for time in (3, 4)]
    moved = (shapes[4]["centres_um"] - shapes[3]["centres_um"])[:, :2]
    off = (places[1] - places[0])[:, :2] - moved
    moved, off = moved - np.nanmean(moved, axis=0), off - np.nanmean(off, axis=0)
    print(json.dumps({"cells": len(cells), "spread_of_log_areas": float(np.log(cells.areas).std()), "noise_um": shapes.noise_um,
                      "doubtful": shapes.doubtful.sum(axis=1).tolist(), "excess": found.excess, "runs": found.runs,
                      "moved_um": float(np.sqrt(np.nanmean(moved**2))), "off_um": float(np.sqrt(np.nanmean(off**2)))}, indent=1))


if __name__ == "__main__":
    main()
