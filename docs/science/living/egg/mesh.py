"""Write the egg of egg.toml: rows of four-sided cells on the surface of drosophila-egg, and a shorter one for the rounder embryo.

Usage: mesh.py [FOLDER]. Writes egg.obj, egg-fine.obj (twice the cells along the axis) and round.obj to this folder, or to FOLDER.
"""
import sys
from pathlib import Path

import numpy as np

import plica

HALF_AXES = np.array([250.0, 90.0, 90.0])
SAGS = np.array([17.0, 7.0]) / 90  # of belly and back, by the half height
# Cells along, across the belly, and from belly to back; length, µm.
EGGS = {"egg": ([32, 22, 20], 500), "egg-fine": ([64, 22, 20], 500), "round": ([18, 22, 20], 260)}


def radius(directions, even, odd):
    """Radius of the scaled egg in these directions, shape (n, 3): as shape = "egg" (polygon_embryo.cpp)."""
    x2 = directions[:, 0] ** 2
    return 1 + even * x2 * (1 - x2) + odd * directions[:, 2] * x2 * (1 - x2 / 2)


def outline(even, odd):
    """Half length and sags of an outline, by the half height."""
    angle = np.linspace(0, 2 * np.pi, 200001)
    directions = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    x, _, z = (radius(directions, even, odd)[:, None] * directions).T
    sags = []
    for side in (-1, 1):
        half = (side * z > 0) & (x > 0)
        order = np.argsort(x[half])
        sags.append(1 - abs(np.interp(0.6 * x.max(), x[half][order], z[half][order])))
    return x.max(), np.array(sags)


def terms():
    """The two terms that give the sags, by Newton's method."""
    found = np.zeros(2)
    for _ in range(30):
        sags = outline(*found)[1]
        slopes = np.stack([(outline(*(found + step))[1] - sags) / 1e-3 for step in 1e-3 * np.eye(2)], axis=1)
        change = np.linalg.solve(slopes, SAGS - sags)
        found = found + min(1, 0.1 / np.linalg.norm(change)) * change
    return found


def egg(cells, length_um):
    """Vertices (n, 3) and quadrilaterals (m, 4): apical faces of a pill, moved onto the egg along rays."""
    pill = plica.Simulation(plica.Scenario({"base": "drosophila-living", "embryo": {"cells": cells}}))
    faces = np.asarray(pill.hexahedra)[:, 4:]
    used, faces = np.unique(faces, return_inverse=True)
    even, odd = terms()
    half_axes = HALF_AXES / [outline(even, odd)[0], 1, 1]
    directions = np.asarray(pill.rest_positions)[used] / half_axes
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    places = radius(directions, even, odd)[:, None] * directions * half_axes * [length_um / 500, 1, 1]
    places[np.abs(places) < 1e-9] = 0  # exactly on the mirror planes
    return places, faces.reshape(-1, 4)


folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)
for name, (cells, length_um) in EGGS.items():
    places, faces = egg(cells, length_um)
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in places] + ["f " + " ".join(map(str, face + 1)) for face in faces]
    (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")
    print(f"{name}.obj: {len(faces)} cells")
