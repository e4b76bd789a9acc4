"""Write what closing.toml needs: cells between those of egg.toml and of the measured embryo.

Usage: beds.py FOLDER. bricks.obj is the egg with rows that are shifted by half a cell in turn on the ventral side, and hexagonal cells in
them. atlas-quads.obj has the four-sided cells of the egg on the shape of drosophila-atlas, to which they are moved along rays from the
centre. quads.csv has the genes of these cells. Needs egg.obj (mesh.py).
"""
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np

from plica.results import Frame

HERE = Path(__file__).resolve().parent
HALF_AXES = np.array([250.0, 90.0, 90.0])
GENES = ("sna", "twi")
ALONG, ACROSS = 32, 22  # cells of the ventral side of egg.obj, its first faces
# Of the box around each shape, µm; the egg's is at 0.
ATLAS_CENTRE = np.array([-14.0, 0.0, -6.5])


def directions(points, centre):
    """Unit vectors of shape (n, 3) from the centre, in units of the half axes, and the lengths before scaling to 1."""
    scaled = (points - centre) / HALF_AXES
    length = np.linalg.norm(scaled, axis=1)
    return scaled / length[:, None], length


class Shape:
    """Radius of a shape by direction: polynomials of degree 8, even in y, fitted to its vertices."""

    def __init__(self, points, centre):
        self.centre = centre
        unit, length = directions(points, centre)
        self.weights = np.linalg.lstsq(self._terms(unit), length, rcond=None)[0]
        misses = np.abs(self._terms(unit) @ self.weights - length) * HALF_AXES[1]
        print(f"{len(points)} vertices, largest miss {misses.max():.2f} µm")

    @staticmethod
    def _terms(unit):
        x, y, z = unit.T
        return np.stack([x**i * z**k * y**j for i, k, j in product(range(9), range(9), (0, 2, 4, 6, 8)) if i + j + k in (7, 8)], axis=1)

    def places(self, unit):
        return self.centre + (self._terms(unit) @ self.weights)[:, None] * unit * HALF_AXES


def read_obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    points = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float)
    return points, [np.array(line[1:], dtype=int) - 1 for line in lines if line[0] == "f"]


def bricks(points, faces, surface, bulge=0.2):
    """Points and faces of the egg with bricks on its ventral side: every second row from the midline is shifted by half a cell.

    Where two cells of one row meet one of the next, the vertex moves by `bulge` of a row into the former, as in a foam.
    """
    grid = np.arange((ACROSS + 1) * (ALONG + 1)).reshape(ACROSS + 1, ALONG + 1)
    assert np.array_equal(faces[0], [grid[1, 0], grid[1, 1], grid[0, 1], grid[0, 0]])
    middle = ALONG // 2

    def ends(row):
        """Places of the transverse edges of a row, in cells."""
        if row < 0 or row >= ACROSS or (row - ACROSS // 2 if row >= ACROSS // 2 else ACROSS // 2 - 1 - row) % 2 == 0:
            return set(range(ALONG + 1))
        return {0, middle, ALONG} | {i + 0.5 for i in range(1, ALONG - 1) if i not in (middle - 1, middle)}

    added, number = list(points), {}
    for line in range(ACROSS + 1):
        below, above = ends(line - 1), ends(line)
        for place in sorted(below | above):
            low, high = int(place), int(np.ceil(place))
            other = line + (bulge if place not in below else -bulge if place not in above else 0)
            at = [points[grid[k, [low, high]]].mean(axis=0) for k in sorted({line, int(np.floor(other)), int(np.ceil(other))})]
            moved = at[0] + (other - np.floor(other)) * (at[-1] - at[0])
            if np.allclose(moved, points[grid[line, low]]):
                number[line, place] = grid[line, low]
                continue
            moved = surface.places(directions(moved[None], surface.centre)[0])[0]
            if place == int(place):
                number[line, place] = grid[line, low]
                added[grid[line, low]] = moved
            else:
                number[line, place] = len(added)
                added.append(moved)
    cells = []
    for row in range(ACROSS):
        edges = sorted(ends(row))
        for low, high in zip(edges, edges[1:]):
            sides = [[number[line, at] for at in sorted(ends(line - 1) | ends(line)) if low <= at <= high] for line in (row, row + 1)]
            cells.append(np.array(sides[1] + sides[0][::-1]))
    rest = faces[ALONG * ACROSS :]
    return np.array(added), cells + rest


def write_mesh(path, points, faces):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in points + 0.0] + ["f " + " ".join(map(str, face + 1)) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    print(f"{path.name}: {len(faces)} cells")


def write_genes(path, unit, faces, atlas):
    """Genes of cells: means of the three cells of the atlas that are nearest by direction, equal on both sides."""
    known = np.abs(directions(atlas.points, ATLAS_CENTRE)[0] * [0, 1, 0]) + directions(atlas.points, ATLAS_CENTRE)[0] * [1, 0, 1]
    known = np.array([known[face].mean(axis=0) for face in atlas.faces])
    of_cells = np.array([unit[face].mean(axis=0) for face in faces])
    of_cells[:, 1] = np.abs(of_cells[:, 1])
    nearest = np.array([np.argpartition(((known - one) ** 2).sum(axis=1), 3)[:3] for one in of_cells])
    genes = np.stack([atlas.cell_data[name][nearest].mean(axis=1) for name in GENES], axis=1)
    path.write_text("\n".join([",".join(GENES), *(",".join(f"{value:.4f}" for value in row) for row in genes)]) + "\n")


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["plica", "mesh", "drosophila-atlas", "--out", folder / "atlas.vtu", "--overwrite"], check=True, capture_output=True)
    atlas = Frame(folder / "atlas.vtu", 0).polygons("apical")
    points, faces = read_obj(HERE / "egg.obj")
    unit, _ = directions(points, np.zeros(3))
    write_mesh(folder / "bricks.obj", *bricks(points, faces, Shape(points, np.zeros(3))))
    write_mesh(folder / "atlas-quads.obj", Shape(atlas.points, ATLAS_CENTRE).places(unit), faces)
    write_genes(folder / "quads.csv", unit, faces, atlas)
