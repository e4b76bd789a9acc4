#!/usr/bin/python3
"""Writes the pill of the reference scene: pill_mesh.py REFINEMENT LAYERS > pill.txt.

`1 1` is bench/data/pill756.txt, `4 2` the mesh of 24 192 hexahedra, `8 4` that of 193 536. The surface of a box of
9 x 18 x 8 quads (times the refinement) is laid on a capsule about the y axis: half its straight part 90 um, radii from
100 (inner) to 140 (outer). Quads are even in angle across the axis and even in outer arc length along it. Springs: the
edges and diagonals of the outer quads of a patch of 3 x 14 cells, rest length 0.7 times the initial length.
"""
import math
import sys

CELLS = (9, 18, 8)
STRAIGHT, INNER, OUTER = 90.0, 100.0, 140.0
PATCH_X, PATCH_Y = (3, 6), (2, 16)  # of the face z = 0, in cells
STIFFNESS, SHORTENING = 9000, 0.7


def surface_quads(nx, ny, nz):
    """Quads as four points of the box grid, counter-clockwise from outside."""
    for i in range(nx):
        for j in range(ny):
            a, b, c, d = (i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)
            yield [(x, y, 0) for x, y in (a, b, c, d)]
            yield [(x, y, nz) for x, y in (a, d, c, b)]
    for k in range(nz):
        for j in range(ny):
            a, b, c, d = (j, k), (j, k + 1), (j + 1, k + 1), (j + 1, k)
            yield [(0, y, z) for y, z in (a, b, c, d)]
            yield [(nx, y, z) for y, z in (a, d, c, b)]
    for i in range(nx):
        for k in range(nz):
            a, b, c, d = (i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)
            yield [(x, 0, z) for x, z in (a, b, c, d)]
            yield [(x, ny, z) for x, z in (a, d, c, b)]


def on_capsule(point, counts, radius):
    """Where a point of the box grid lies at `radius` about the capsule's axis."""
    across = [math.tan(math.pi / 4 * (2 * point[c] / counts[c] - 1)) for c in (0, 2)]
    half = STRAIGHT + OUTER * math.pi / 4
    arc = half * (2 * point[1] / counts[1] - 1)
    along, middle = 0.0, arc
    if abs(arc) > STRAIGHT:
        middle = math.copysign(STRAIGHT, arc)
        along = math.copysign(math.tan((abs(arc) - STRAIGHT) / OUTER), arc)
    direction = (across[0], along, across[1])
    size = math.hypot(*direction)
    return [radius * d / size + (middle if c == 1 else 0) for c, d in enumerate(direction)]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    refinement, layers = int(sys.argv[1]), int(sys.argv[2])
    counts = [refinement * n for n in CELLS]
    numbers, quads, patch = {}, [], []
    for corners in surface_quads(*counts):
        quads.append([numbers.setdefault(point, len(numbers)) for point in corners])
        low = [min(point[c] for point in corners) // refinement for c in (0, 1)]
        on_face = all(point[2] == 0 for point in corners)
        if on_face and low[0] in range(*PATCH_X) and low[1] in range(*PATCH_Y):
            patch.append(quads[-1])
    radii = [INNER + (OUTER - INNER) * layer / layers for layer in range(layers + 1)]
    nodes = [on_capsule(point, counts, radius) for radius in radii for point in numbers]
    size = len(numbers)
    print(f"nodes {len(nodes)}")
    print("\n".join("%.12g %.12g %.12g" % tuple(node) for node in nodes))
    print(f"hexes {layers * len(quads)}")
    for layer in range(layers):
        for quad in quads:
            print(*(n + layer * size for n in quad), *(n + (layer + 1) * size for n in quad))
    print(f"springs {6 * len(patch)}")
    for quad in patch:
        a, b, c, d = (n + layers * size for n in quad)
        for i, j in ((a, b), (b, c), (c, d), (d, a), (a, c), (b, d)):
            print(i, j, STIFFNESS, 0, "%.12g" % (SHORTENING * math.dist(nodes[i], nodes[j])))


main()
