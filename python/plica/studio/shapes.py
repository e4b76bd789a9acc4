"""Shape and values of a tissue as the page draws them: facets, outlines, regions, arrays."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..simulation import Simulation
from .messages import packed

# Faces of a hexahedron in VTK's order, corners counter-clockwise seen from outside; the last two are basal and apical.
FACES = np.array([[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]])
NODE_FIELDS = ("displacement", "speed")
CELL_FIELDS = ("area-ratio", "pressure", "volume", "contraction", "generation", "self-intersections")
STRENGTH, SIGNAL = "strength of ", "signal "  # begin the names of fields that laws and signals have
Floats = NDArray[np.float32]


def ends_of_colours(name: str, low: float, high: float) -> tuple[float, float]:
    """Return the ends of the colours of a field."""
    return _core.colour_range("strength" if name.startswith(STRENGTH) else name, low, high)


def surface(hexahedra: NDArray[np.int32], cell_of: NDArray[np.int32]) -> dict[str, NDArray[np.uint32]]:
    """Return the facets that bound a tissue (4 nodes each), their elements, and the edges between cells (2 nodes)."""
    nodes = int(hexahedra.max()) + 1
    faces = hexahedra[:, FACES].reshape(-1, 4)
    # Three nodes tell a face; as one number they sort ten times as fast.
    a, b, c = np.sort(faces, axis=1)[:, :3].T.astype(np.int64)
    _, place, count = np.unique((a * nodes + b) * nodes + c, return_inverse=True, return_counts=True)
    at = np.flatnonzero(count[place] == 1)
    facets, elements = faces[at], at // 6
    edges = np.sort(np.stack([facets, np.roll(facets, -1, axis=1)], axis=2).reshape(-1, 2), axis=1).astype(np.int64)
    owner = np.repeat(cell_of[elements] * 6 + at % 6, 4)
    each, place = np.unique(edges[:, 0] * nodes + edges[:, 1], return_inverse=True)
    least, most = np.full(len(each), np.iinfo(np.int64).max), np.full(len(each), -1)
    np.minimum.at(least, place, owner)
    np.maximum.at(most, place, owner)
    inside = (np.bincount(place) == 2) & (least == most)
    return {"facets": facets.astype("u4"), "element_of_facet": elements.astype("u4"),
        "outlines": np.column_stack(np.divmod(each[~inside], nodes)).astype("u4")}


def shape_message(sim: Simulation, name: str) -> bytes:
    """Pack everything about a tissue that stays while its cells neither divide nor exchange neighbours."""
    rest, data = sim.rest_positions, sim.cell_data
    regions = sim.regions
    known = {field["array"] for field in _core.colour_fields().values()} | _core_columns()
    known |= {f"signal_{name}" for name in sim._core.signals}
    own = {k: v for k, v in data.items() if k not in known and np.isfinite(v).all()}
    shell = sim._scenario._core.shell(rest)
    arrays: dict[str, Any] = {
        "elements": sim.hexahedra.astype("u4"), "cell_of_element": sim.hexahedron_cell.astype("u4"),
        **surface(sim.hexahedra, sim.hexahedron_cell),
        "cell_id": data["cell_id"].astype("u4"), "rest": rest.astype("f4"),
        **{f"field/{k}": v.astype("f4") for k, v in own.items()},
        **{f"region/{k}": mask.astype("u4") for k, mask in regions.items()},
    }
    reach = np.abs(rest).max(axis=0) * 0.15
    return packed({
        "kind": "shape", "shape": name, "nodes": len(rest), "cells": len(sim.pressures), "regions": list(regions),
        "changing": [*(STRENGTH + law for law in sim._core.laws(True)), *(SIGNAL + name for name in sim._core.signals)],
        "own_fields": {k: _core.colour_range("volume", float(v.min()), float(v.max())) for k, v in own.items()},
        "box": {"low": (rest.min(axis=0) - reach).tolist(), "high": (rest.max(axis=0) + reach).tolist()},
        "shell": shell and {"half_axis_um": shell[0], "radius_um": shell[1]},
        "views": _core.views(np.ascontiguousarray(rest), sim.hexahedra),
    }, arrays)


def _core_columns() -> set[str]:
    return {"time_s", "cell_id", "mother_id", "x_um", "y_um", "z_um", "apical_area_um2", "basal_area_um2", "height_um",
        "speed_um_per_s"}


def values_now(sim: Simulation) -> dict[str, Floats]:
    """Return the values of all fields that change: by node, then by cell."""
    data, fields = sim.cell_data, _core.colour_fields()
    values = {"displacement": np.linalg.norm(sim.positions - sim.rest_positions, axis=1),
              "speed": np.linalg.norm(sim.velocities, axis=1)}
    for name in CELL_FIELDS:
        values[name] = np.nan_to_num(data[fields[name]["array"]])
    values |= {f"{SIGNAL}{name}": array for name, array in sim._core.signals.items()}
    return {name: array.astype("f4") for name, array in (values | strengths_now(sim)).items()}


def strengths_now(sim: Simulation, at_rest: bool = False) -> dict[str, NDArray[np.float64]]:
    """Return the strength of each active law by cell: profile, variation and, in a run, activity."""
    core = sim._core
    return {f"{STRENGTH}{law}": np.nan_to_num(core.strength(law) * (1.0 if at_rest else core.activity(law)))
            for law in core.laws(True)}
