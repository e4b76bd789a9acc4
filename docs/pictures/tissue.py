"""Tissue of a saved frame, drawn with Matplotlib: cells in a plane cut, and cells from outside."""
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from PIL import Image

from style import APICAL, BASAL, CELL, LATERAL, TEXT, YOLK

FACES = {"basal": (0, 1, 2, 3), "apical": (4, 5, 6, 7), "side 0": (0, 1, 5, 4), "side 1": (1, 2, 6, 5),
         "side 2": (2, 3, 7, 6), "side 3": (3, 0, 4, 7)}


def cut(points, hexahedra, cells, axis, at, rest=None):
    """Cells in the plane where coordinate `axis` is `at`; with `rest`, of one row: what was in this plane at rest.

    Returns the polygons of the cut elements (shape (corners, 2)), their cells, and segments by kind: apical, basal, lateral.
    """
    across = [one for one in range(3) if one != axis]
    level = (points if rest is None else rest)[:, axis]
    place = level[hexahedra]
    touched = np.flatnonzero((place.min(axis=1) < at) & (place.max(axis=1) >= at))
    faces_of = {}  # elements of each side face, to tell walls of cells from faces inside a cell
    for element in touched:
        for name, corners in FACES.items():
            if name.startswith("side"):
                faces_of.setdefault(frozenset(hexahedra[element][list(corners)].tolist()), []).append(cells[element])
    polygons, owners, segments = [], [], {"apical": [], "basal": [], "lateral": []}

    def crossing(one, other):
        share = (at - level[one]) / (level[other] - level[one])
        return (points[one] + share * (points[other] - points[one]))[across]

    for element in touched:
        nodes = hexahedra[element].tolist()
        links = {}
        for name, corners in FACES.items():
            ring = [nodes[corner] for corner in corners]
            cuts = [tuple(sorted(edge)) for edge in zip(ring, ring[1:] + ring[:1])
                    if (level[edge[0]] < at) != (level[edge[1]] < at)]
            for one, other in zip(cuts[::2], cuts[1::2]):
                links.setdefault(one, []).append(other)
                links.setdefault(other, []).append(one)
                kind = name
                if name.startswith("side"):
                    kind = "lateral" if faces_of[frozenset(ring)].count(cells[element]) == 1 else None
                    if rest is not None:  # a wall to the next row, which the plane barely touched
                        normal = np.cross(rest[ring[2]] - rest[ring[0]], rest[ring[3]] - rest[ring[1]])
                        kind = None if abs(normal[axis]) > 0.7 * np.linalg.norm(normal) else kind
                if kind:
                    segments[kind].append((crossing(*one), crossing(*other)))
        while links:
            start, near = next(iter(links.items()))
            loop, last, here = [start], start, near[0]
            while here != start and here in links:
                loop.append(here)
                last, here = here, next((one for one in links[here] if one != last), start)
            for one in loop:
                links.pop(one, None)
            polygons.append(np.array([crossing(*edge) for edge in loop]))
            owners.append(cells[element])
    return polygons, np.array(owners, dtype=int), segments


def draw_cut(axes, polygons, owners, segments, colour_of_cell=None, width=2.0, place=lambda points: points, z=3, plain=False):
    """Draws a cut: cells filled; apical, basal and lateral faces in the colours of the palette, or all dark if `plain`."""
    fills = [colour_of_cell[one] if colour_of_cell is not None else to_rgb(CELL) for one in owners]
    axes.add_collection(PolyCollection([place(one) for one in polygons], facecolors=fills, edgecolors=fills, linewidths=0.4, zorder=z))
    for kind, colour, thickness in (("lateral", LATERAL, 0.5), ("basal", BASAL, 1.0), ("apical", APICAL, 1.2)):
        lines = [place(np.array(one)) for one in segments[kind]]
        colour, thickness = (TEXT, 0.5) if plain else (colour, thickness)
        axes.add_collection(LineCollection(lines, colors=colour, linewidths=thickness * width, capstyle="round", zorder=z + 1))


def fill_inside(axes, segments, place=lambda points: points, colour=YOLK, z=2):
    """Fills what the basal faces of a closed cut enclose: the largest loop of their segments."""
    rings = rings_of(segments["basal"])
    if rings:
        axes.add_collection(PolyCollection([place(max(rings, key=len))], facecolors=colour, zorder=z))


def rings_of(segments):
    """Chains segments that share their ends, to loops of points."""
    ends, points = {}, {}
    for index, (one, other) in enumerate(segments):
        for at in (one, other):
            key = tuple(np.round(at, 4))
            points[key] = at
            ends.setdefault(key, []).append(index)
    left, rings = set(range(len(segments))), []
    while left:
        index = left.pop()
        ring = [tuple(np.round(end, 4)) for end in segments[index]]
        while True:
            following = next((one for one in ends[ring[-1]] if one in left), None)
            if following is None:
                break
            left.discard(following)
            one, other = (tuple(np.round(end, 4)) for end in segments[following])
            ring.append(other if one == ring[-1] else one)
        rings.append(np.array([points[key] for key in ring]))
    return rings


def palette_of(image, colours, kept=(APICAL, BASAL, LATERAL, YOLK, CELL, TEXT, "#ffffff", "#a87f12", "#b4533a", "#b9770a")):
    """Image in few colours whose palette has those of the drawings as they are; for `Image.quantize(palette=...)`."""
    few = image.quantize(colours - len(kept), kmeans=1, dither=Image.Dither.NONE)
    values = few.getpalette()[:3 * (colours - len(kept))] + [round(255 * one) for colour in kept for one in to_rgb(colour)]
    values = [255 if min(values[one // 3 * 3:one // 3 * 3 + 3]) > 246 else values[one] for one in range(len(values))]
    palette = Image.new("P", (1, 1))
    palette.putpalette(values)
    return palette


class Camera:
    """Parallel projection along `back`, which points towards the viewer; `up` is upwards in the picture."""

    def __init__(self, back, up):
        self.back = np.array(back, dtype=float) / np.linalg.norm(back)
        right = np.cross(up, self.back)
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.back, self.right)

    def flat(self, points):
        return np.column_stack([points @ self.right, points @ self.up])

    def depth(self, points):
        return points @ self.back


def keep_beyond(polygons, owners, axis, at):
    """The parts of polygons where coordinate `axis` is over `at`, with their cells."""
    kept, kept_owners = [], []
    for points, owner in zip(polygons, owners):
        over = points[:, axis] - at
        if over.max() <= 0:
            continue
        if over.min() < 0:
            parts = []
            for one, other, of_one, of_other in zip(points, np.roll(points, -1, axis=0), over, np.roll(over, -1)):
                if of_one >= 0:
                    parts.append(one)
                if (of_one >= 0) != (of_other >= 0):
                    parts.append(one + of_one / (of_one - of_other) * (other - one))
            points = np.array(parts)
        kept.append(points)
        kept_owners.append(owner)
    return kept, np.array(kept_owners, dtype=int)


def draw_outside(axes, polygons, colours, camera, light, width=0.35, place=lambda points: points, z=1, two_sided=False):
    """Draws polygons (arrays of points in space) that face the viewer, from back to front, shaded by `light` (towards it)."""
    light = np.array(light, dtype=float) / np.linalg.norm(light)
    centres = np.array([one.mean(axis=0) for one in polygons])
    arms = [one - middle for one, middle in zip(polygons, centres)]
    normals = np.array([np.cross(one, np.roll(one, -1, axis=0)).sum(axis=0) for one in arms])
    normals /= np.linalg.norm(normals, axis=1)[:, None] + 1e-12
    facing = normals @ camera.back
    if two_sided:
        normals[facing < 0] *= -1
    seen = np.arange(len(polygons)) if two_sided else np.flatnonzero(facing > 0)
    seen = seen[np.argsort(camera.depth(centres[seen]))]
    shade = 0.66 + 0.34 * np.clip(normals[seen] @ light, 0, 1)
    shown = np.clip(np.asarray(colours)[seen] * shade[:, None], 0, 1)
    axes.add_collection(PolyCollection([place(camera.flat(polygons[one])) for one in seen], facecolors=shown,
                                       edgecolors=np.clip(shown * 0.55, 0, 1), linewidths=width, zorder=z))


def draw_half(axes, frame, colour_of_cell, camera, light, at, box, rest, width=1.0, plain=False):
    """Draws the part of a closed embryo where x is over `at`, with its cut face and yolk.

    `box` is centre and size in pixels of what the part has room for at rest. Returns pixels per µm.
    """
    cells = frame.cell_data["cell_id"].astype(int)
    outline = camera.flat(rest.points[rest.points[:, 0] > at])
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2
    scale = min(box[2] / np.ptp(outline[:, 0]), box[3] / np.ptp(outline[:, 1]))

    def placed(flat):
        return np.array(box[:2]) + scale * (np.asarray(flat) - middle)

    def in_space(points):  # of (y, z) in the cut
        return placed(camera.flat(np.column_stack([np.full(len(points), at), points])))

    apical = frame.polygons("apical")
    polygons, owners = keep_beyond([apical.points[one] for one in apical.faces], apical.cell_data["cell_id"].astype(int), 0, at)
    draw_outside(axes, polygons, colour_of_cell[owners], camera, light, width=0.35 * width, place=placed)
    pieces = cut(frame.points, frame.hexahedra, cells, 0, at)
    fill_inside(axes, pieces[2], in_space)
    draw_cut(axes, *pieces, colour_of_cell, width, in_space, z=5, plain=plain)
    return scale
