"""Whether the surface in a frame passes through itself, by a test of triangles that shares nothing with plica's: every
facet of the outer and the inner surface is four triangles from its edges to the mean of its corners, and where an edge of
one passes through another, they cross.

Usage: crossings.py OUT   prints the crossings in every frame of a run. Needs Debian's python3-vtk9 (with numpy).
"""
import sys
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

# Of a hexahedron of plica's: the faces that are basal and apical where they are no other's.
BASAL, APICAL = [0, 3, 2, 1], [4, 5, 6, 7]


def read(path):
    """Points, and the corners of hexahedra."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    return vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 8)


def surface_facets(hexahedra):
    """The basal and apical faces that are one hexahedron's only."""
    faces = np.concatenate([hexahedra[:, BASAL], hexahedra[:, APICAL]])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]


def near_pairs(low, high):
    """Pairs of boxes that overlap, by sweeping along x."""
    order = np.argsort(low[:, 0], kind="stable")
    starts = low[order, 0]
    ends = np.searchsorted(starts, high[order, 0], side="right")
    for begin in range(0, len(order), 500):
        rows = np.arange(begin, min(begin + 500, len(order)))
        counts = ends[rows] - rows - 1
        a = np.repeat(rows, counts)
        b = np.concatenate([np.arange(row + 1, end) for row, end in zip(rows, ends[rows])])
        a, b = order[a], order[b]
        overlap = np.all((low[a][:, 1:] <= high[b][:, 1:]) & (low[b][:, 1:] <= high[a][:, 1:]), axis=1)
        yield a[overlap], b[overlap]


def passes_through(p, q, a, b, c):
    """Whether segments p q pass through triangles a b c: by the signs of five volumes."""
    def volume(u, v, w, x):
        return np.einsum("ij,ij->i", np.cross(v - u, w - u), x - u)

    sides = volume(a, b, c, p) * volume(a, b, c, q)
    around = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)]
    inside = (np.minimum.reduce(around) > 0) | (np.maximum.reduce(around) < 0)
    return (sides < 0) & inside


def crossings(points, facets):
    """How many pairs of facets without a common node cross."""
    corners = points[facets].astype(float)
    middles = corners.mean(axis=1)
    found = 0
    for a, b in near_pairs(corners.min(axis=1), corners.max(axis=1)):
        apart = ~(facets[a][:, :, None] == facets[b][:, None, :]).any(axis=(1, 2))
        a, b = a[apart], b[apart]
        cross = np.zeros(len(a), dtype=bool)
        for one, other in ((a, b), (b, a)):
            for i in range(4):
                ends = [corners[one, i], corners[one, (i + 1) % 4], middles[one]]
                for k in range(4):
                    triangle = corners[other, k], corners[other, (k + 1) % 4], middles[other]
                    cross |= passes_through(ends[0], ends[1], *triangle) | passes_through(ends[0], ends[2], *triangle)
        found += int(cross.sum())
    return found


def crossings_of_run(out):
    """A list of (frame's name, crossings)."""
    frames = sorted((Path(out) / "frames").glob("*.vtu"))
    facets = surface_facets(read(frames[0])[1])
    return [(frame.stem, crossings(read(frame)[0], facets)) for frame in frames]


if __name__ == "__main__":
    for name, count in crossings_of_run(sys.argv[1]):
        print(name, count)
