"""Sections of runs, drawn with Matplotlib for the pictures of docs/science/living-embryo.md."""
import collections
import functools
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from PIL import Image

import plica

sys.path.append(str(Path(__file__).resolve().parents[2] / "pictures"))
from style import TEXT, VITELLINE  # noqa: E402  sets letters and palette

COLOURS = LinearSegmentedColormap.from_list("displacement", ["#f4f4df", "#a8d3c0", "#4aa0b0", "#1f6b97", "#1b2f5b"])
SCALE = Normalize(0, 60)  # displacement, um
FACES = np.array([[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])  # of a hexahedron in VTK's order
APICAL_FACE = 1
SAGITTAL, TRANSVERSE = 1, 0  # axis along which a section has its normal


def few_colours(path, count=256):
    """Reduce the number of colours of the picture in a file."""
    Image.open(path).convert("RGB").quantize(count, dither=Image.Dither.NONE).save(path, optimize=True)


def cut(points, hexahedra, axis, at):
    """Cut elements by the plane where a coordinate equals `at`.

    Returns a list of (element, face, segment), a segment being two points in the plane, shape (2, 2): horizontal, z.
    """
    kept = [1, 2] if axis == TRANSVERSE else [0, 2]
    side = points[:, axis] - at
    side[side == 0] = 1e-9  # no node lies in the plane
    of_element = side[hexahedra]
    segments = []
    for element in np.flatnonzero((of_element.min(axis=1) < 0) & (of_element.max(axis=1) > 0)):
        for face, corners in enumerate(hexahedra[element][FACES]):
            crossings = []
            for a, b in zip(corners, np.roll(corners, -1)):
                if side[a] * side[b] < 0:
                    part = side[a] / (side[a] - side[b])
                    crossings.append((points[a] + part * (points[b] - points[a]))[kept])
            if len(crossings) == 2:
                segments.append((element, face, np.array(crossings)))
    return segments


def polygon_of(segments):
    """The corners of an element's section, in order about their mean."""
    corners = np.unique(np.concatenate(segments).round(6), axis=0)
    x, y = (corners - corners.mean(axis=0)).T
    return corners[np.argsort(np.arctan2(y, x))]


@functools.cache
def read(folder, minute):
    """The frame of a run at a time, and how far its nodes have moved from the first, um."""
    frames = plica.open(folder).frames
    frame = frames.at(minute)
    return frame, np.linalg.norm(frame.points - frames[0].points, axis=1)


def draw_section(axes, folder, minute, axis, at=0.01):
    """Draw the cells of a run cut by a plane, coloured by displacement, and the vitelline membrane as a grey line."""
    (frame, moved), (rest, _) = read(folder, minute), read(folder, 0)
    segments = cut(frame.points.copy(), frame.hexahedra, axis, at)
    elements = sorted({element for element, _, _ in segments})
    polygons = [polygon_of([segment for other, _, segment in segments if other == element]) for element in elements]
    colours = COLOURS(SCALE(moved[frame.hexahedra[elements]].mean(axis=1)))
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors="face", linewidths=0.3))
    cells_at = collections.defaultdict(list)  # of the nodes of a face; two of the same cell make no outline
    faces = [tuple(sorted(frame.hexahedra[element][FACES[face]])) for element, face, _ in segments]
    for nodes, (element, _, _) in zip(faces, segments):
        cells_at[nodes].append(frame.cell_data["cell_id"][element])
    outlines = [segment for nodes, (_, _, segment) in zip(faces, segments) if len(cells_at[nodes]) == 1 or len(set(cells_at[nodes])) > 1]
    axes.add_collection(LineCollection(outlines, colors=TEXT, linewidths=0.5))
    shell = [segment for _, face, segment in cut(rest.points.copy(), rest.hexahedra, axis, at) if face == APICAL_FACE]
    axes.add_collection(LineCollection(shell, colors=VITELLINE, linewidths=0.8, zorder=0))
    frame_axes(axes)


def frame_axes(axes):
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")


def scale_bar(axes, x, y, length=100):
    """A bar with its length in um, its left end at (x, y)."""
    axes.plot([x, x + length], [y, y], color=TEXT, linewidth=3, solid_capstyle="butt", clip_on=False)
    axes.text(x + length + 12, y, f"{length} µm", va="center", clip_on=False)
