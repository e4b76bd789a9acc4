"""Layers of napari from cells and runs of plica. Coordinates are µm in the order of napari: (frame,) z, y, x."""
from __future__ import annotations

from typing import Any, NamedTuple, Sequence

import numpy as np
from numpy.typing import NDArray

FIELDS = {"apical area / reference": "apical_area_ratio", "height (µm)": "height_um", "pressure (Pa)": "pressure_Pa",
          "activity": "activity"}  # arrays of frames

Floats = NDArray[np.float64]


class Solid(NamedTuple):
    """Faces of all cells as triangles; no vertex belongs to two cells."""

    vertices: Floats               # (n, 3): z, y, x
    triangles: NDArray[np.int64]
    cell: NDArray[np.int64]        # of each vertex


def solid(apical: Floats, basal: Floats, rings: Sequence[NDArray[Any]]) -> Solid:
    """Return the faces of cells between apical and basal corners (x, y, z); `rings` are the columns of each cell."""
    vertices, triangles, cell, count = [], [], [], 0
    for number, ring in enumerate(rings):
        top, bottom, size = apical[ring], basal[ring], len(ring)
        one = np.arange(size)
        after = (one + 1) % size
        vertices += [top, bottom, top.mean(axis=0)[None], bottom.mean(axis=0)[None]]
        faces = [(one, after, 0 * one + 2 * size), (after + size, one + size, 0 * one + 2 * size + 1),
                 (one + size, after + size, after), (one + size, after, one)]
        triangles += [count + np.column_stack(part) for part in faces]
        cell.append(np.full(2 * size + 2, number))
        count += 2 * size + 2
    return Solid(np.concatenate(vertices)[:, ::-1], np.concatenate(triangles), np.concatenate(cell))


def cells_layer(tissue: Any, values: Any = None, name: str = "cells") -> tuple[Any, dict[str, Any], str]:
    """Return the surface layer of the cells of a `plica.LabelledTissue`, coloured by a number per cell, such as inferred tensions; by
    default by height."""
    body = solid(tissue.apical, tissue.basal, tissue.cells)
    shown = np.asarray(tissue.heights if values is None else values, dtype=float)
    if shown.shape != (len(tissue.cells),):
        raise ValueError(f"values: shape {shown.shape}; give one number per cell, of shape ({len(tissue.cells)},)")
    return ((body.vertices, body.triangles, shown[body.cell]),
            {"name": name, "colormap": "viridis", "opacity": 0.7, "metadata": {"remarks": list(tissue.remarks)}}, "surface")


def frames_layer(run: Any, field: str = "apical_area_ratio", name: str = "fold") -> tuple[Any, dict[str, Any], str]:
    """Return the surface layer of a run, with the frame as first coordinate, coloured by an array of its frames."""
    vertices, triangles, values, count = [], [], [], 0
    for number, frame in enumerate(run.frames):
        top, bottom = frame.polygons("apical"), frame.polygons("basal")
        ends = np.cumsum([len(face) for face in top.faces])
        columns = np.split(np.arange(ends[-1]), ends[:-1])
        body = solid(top.points[np.concatenate(top.faces)], bottom.points[np.concatenate(bottom.faces)], columns)
        vertices.append(np.column_stack([np.full(len(body.vertices), number), body.vertices]))
        triangles.append(body.triangles + count)
        values.append(np.asarray(top.cell_data[field], dtype=float)[body.cell])
        count += len(body.vertices)
    shown = np.concatenate(values)
    is_ratio = field.endswith("_ratio")
    limits = (0.0, 2.0) if is_ratio else (float(shown.min()), float(max(shown.max(), shown.min() + 1e-9)))
    look = {"name": name, "colormap": "twilight_shifted" if is_ratio else "viridis", "contrast_limits": limits,
            "metadata": {"times_min": [time / 60 for time in run.frames.times_s]}}
    return (np.concatenate(vertices), np.concatenate(triangles), shown), look, "surface"


def labels_layer(run: Any, like: Any, spacing_um: Sequence[float], name: str = "labels of the fold") -> tuple[Any, dict[str, Any], str]:
    """Return the labels layer of a run, with the frame as first axis and the size of a volume `like`; each cell has its own label."""
    volumes = [frame.labels(spacing_um, shape=np.shape(like)).labels for frame in run.frames]
    return np.stack(volumes), {"name": name, "scale": (1.0, *spacing_um)}, "labels"
