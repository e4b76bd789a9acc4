#!/usr/bin/env python3
"""Distances and crossings of random points, triangles and facets by the IPC Toolkit, for contact_test.cpp.

    python3 -m venv venv
    venv/bin/pip install ipctk==1.6.1 numpy==2.4.6
    venv/bin/python make_truth.py                            # the kept files beside this script: some hundred cases
    venv/bin/python make_truth.py --count 10000 --out DIR    # PLICA_CONTACT_TRUTH=DIR plica_tests --gtest_filter=ContactTruth.*

Distances, their gradients and whether an edge meets a triangle are ipctk's (https://github.com/ipc-sim/ipc-toolkit).

point_triangle.csv: kind; point; corners; squared distance; its gradient by the point, then by the corners (0 for
triangles without area, where ipctk has distances to edges only: the least of them is taken).

facets.csv: kind; corners of two facets; whether they cross; whether they cross or touch. A facet is the four triangles
from its edges to the mean of its corners. They cross when an edge of a triangle of one meets a triangle of the other,
all triangles made smaller by a millionth about their centres, so that what only touches does not; nor do triangles that
overlap in one plane, or have no area. They touch when edges and triangles meet as they are.
"""
import argparse
import csv
import itertools
import pathlib

import ipctk
import numpy as np


def unit(random):
    vector = random.normal(size=3)
    return vector / np.linalg.norm(vector)


# --- A point and a triangle, by kind ---


def over(random, weights):
    """A point straight over the place of these weights, at most a size away."""
    corners = random.uniform(-1, 1, (3, 3))
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    return np.vstack([weights @ corners + random.uniform(-1, 1) * normal, corners])


def anywhere(random):
    return random.uniform(-1, 1, (4, 3))


def over_face(random):
    return over(random, random.dirichlet([1, 1, 1]))


def over_edge(random):
    at = random.uniform()
    return over(random, random.permutation([at, 1 - at, 0]))


def over_corner(random):
    return over(random, random.permutation([1.0, 0, 0]))


def in_plane(random):
    points = over(random, random.normal(size=3) + 1 / 3)
    a, b, c = points[1:]
    points[0] = a + random.uniform(-1, 2) * (b - a) + random.uniform(-1, 2) * (c - a)
    return points


def on_it(random):
    points = anywhere(random)
    points[0] = random.dirichlet([1, 1, 1]) @ points[1:]
    return points


def at_corner(random):
    points = anywhere(random)
    points[0] = points[random.integers(1, 4)]
    return points


def needle(random):
    """A triangle a thousandth to a hundred-thousandth as wide as long, by a short edge or by a flat corner."""
    points = anywhere(random)
    width = 10 ** random.uniform(-5, -3)
    points[3] = points[1] + (points[2] - points[1]) * random.choice([0, random.uniform()]) + width * unit(random)
    return points


def far(random):
    points = anywhere(random)
    points[0] = 10 ** random.uniform(2, 5) * unit(random)
    return points


def small_integers(random):
    """Points on corners, edges, planes; triangles without area."""
    return random.integers(-2, 3, (4, 3)).astype(float)


def area(corners):
    return np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) / 2


def distance(points):
    p, corners = points[0], points[1:]
    if area(corners) > 0:
        return ipctk.point_triangle_distance(p, *corners), ipctk.point_triangle_distance_gradient(p, *corners)
    edges = [(corners[i], corners[k]) for i, k in ((0, 1), (1, 2), (2, 0))]
    squared, edge = min(((ipctk.point_edge_distance(p, *edge), k) for k, edge in enumerate(edges)))
    gradient = np.zeros(12)
    gradient[:3] = ipctk.point_edge_distance_gradient(p, *edges[edge])[:3]
    return squared, gradient


# --- Two facets, by kind ---


def facet(random, bend=0.3):
    """A quadrilateral of about size 1, not flat."""
    angles = np.sort(random.uniform(0, 2 * np.pi, 4))
    first, second = unit(random), unit(random)
    return np.array([np.cos(t) * first + np.sin(t) * second + bend * random.normal(size=3) for t in angles])


def near_facets(random, apart=0.7):
    return np.vstack([facet(random), facet(random) + apart * random.normal(size=3)])


def far_facets(random):
    return np.vstack([facet(random), facet(random) + 5 * unit(random)])


def needle_facets(random):
    points = near_facets(random, 0.3)
    middle = points[:4].mean(axis=0)
    along = unit(random)
    points[:4] = middle + np.outer((points[:4] - middle) @ along, along) + 1e-4 * (points[:4] - middle)
    return points


def barely(random):
    """A corner of one that is within a hundred-thousandth of a triangle of the other."""
    points = near_facets(random)
    fan = triangles(points[4:])[random.integers(4)]
    normal = np.cross(fan[1] - fan[0], fan[2] - fan[0])
    place = random.dirichlet([2, 2, 2]) @ fan + random.choice([-1, 1]) * 1e-5 * normal / np.linalg.norm(normal)
    points[:4] += place - points[random.integers(4)]
    return points


def integer_facets(random):
    """Facets that touch in corners, along edges, in planes."""
    return random.integers(-1, 2, (8, 3)).astype(float)


def triangles(corners):
    middle = corners.mean(axis=0)
    return [np.array([corners[i], corners[(i + 1) % 4], middle]) for i in range(4)]


def smaller(triangle):
    return triangle + 1e-6 * (triangle.mean(axis=0) - triangle)


def in_one_plane(s, t):
    """Or one of them has no area."""
    def reach(one, other):
        return max(abs(np.linalg.det([other[1] - other[0], other[2] - other[0], point - other[0]])) for point in one)

    return min(reach(s, t), reach(t, s)) < 1e-9


def meet(s, t):
    return any(ipctk.is_edge_intersecting_triangle(one[i], one[(i + 1) % 3], *other)
               for one, other in ((s, t), (t, s)) for i in range(3))


def crossing(points):
    pairs = list(itertools.product(triangles(points[:4]), triangles(points[4:])))
    cross = any(meet(smaller(s), smaller(t)) for s, t in pairs if not in_one_plane(s, t))
    return cross, cross or any(meet(s, t) for s, t in pairs)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--count", type=int, default=220)
    arguments.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent)
    options = arguments.parse_args()
    random = np.random.default_rng(30)
    options.out.mkdir(parents=True, exist_ok=True)

    def write(name, kinds, truth):
        with open(options.out / name, "w", newline="", encoding="utf-8") as file:
            rows = csv.writer(file, lineterminator="\n")
            for n in range(options.count):
                kind = kinds[n % len(kinds)]
                points = np.round(kind(random), 7)
                rows.writerow([kind.__name__, *(f"{x:.12g}" for x in points.ravel()), *truth(points)])

    def distance_texts(points):
        squared, gradient = distance(points)
        return [f"{squared:.15g}", *(f"{g:.12g}" for g in gradient)]

    write("point_triangle.csv", [anywhere, over_face, over_edge, over_corner, in_plane, on_it, at_corner, needle, far,
                                 small_integers], distance_texts)
    write("facets.csv", [near_facets, far_facets, needle_facets, barely, integer_facets],
          lambda points: [int(it) for it in crossing(points)])


if __name__ == "__main__":
    main()
