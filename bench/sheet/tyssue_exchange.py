"""Exchanges of neighbours of one flat sheet in plica and in tyssue: their number, and their order (docs/developers/sheets.md).

Usage: tyssue_exchange.py plica FILE.npz [--seed N] with the package plica of PYTHONPATH, then
       tyssue_exchange.py tyssue FILE.npz        with a Python that has tyssue, NumPy, SciPy and pandas.

A free sheet of 80 cells relaxes under line tensions that are constant in time and differ between pairs of cells (log-normal).
plica: lateral cortices, factors by Simulation.set_wall_factors, soft cells of fixed volume. tyssue: the same tensions times the
height of cells, areas kept by elasticity; a vertex has the drag of half a cell, so nothing is fitted. In both, an edge shorter than
0.35 µm that shrinks turns to 0.6 µm, and cells that meet have the mean tension.
"""
import sys

import numpy as np

HEIGHT, TENSION, DRAG = 10.0, 0.5, 0.14  # µm, nN/µm, nN s/µm³: of one surface
BELOW, NEW, SPREAD = 0.35, 0.6, 0.6
END_S = {"plica": 600.0, "tyssue": 60.0}


def pairs_of(rows):
    return {tuple(sorted(map(int, row))) for row in rows}


def apical_polygons(simulation):
    """Return the corners of the apical polygons, and the corners of each cell, counter-clockwise."""
    tops = {}
    for nodes, cell in zip(simulation.hexahedra[:, 4:], simulation.hexahedron_cell):
        for edge in zip(nodes, np.roll(nodes, -1)):
            sides = tops.setdefault(int(cell), {})
            if sides.pop((int(edge[1]), int(edge[0])), None) is None:
                sides[tuple(map(int, edge))] = True
    polygons = []
    for cell in sorted(tops):
        following = dict(tops[cell].keys())
        ring = [next(iter(following))]
        while following[ring[-1]] != ring[0]:
            ring.append(following[ring[-1]])
        polygons.append(ring)
    return polygons


def by_plica(path, seed):
    import plica

    simulation = plica.Simulation({
        "embryo": {"shape": "sheet", "length_um": 54, "width_um": 54, "cell_count": 80, "cell_height_um": HEIGHT, "seed": seed},
        "elasticity": {"model": "neo-hookean", "young_modulus_Pa": 20, "poisson_ratio": 0, "relaxation_s": 12, "corner_barrier_Pa": 10},
        "dynamics": {"surface_drag_Pa_s_per_um": 1000 * DRAG},
        "exchange": {"below_um": BELOW, "new_length_um": NEW},
        "cortex": {"lateral": {"region": "all", "faces": "lateral", "tension_mN_per_m": TENSION},
                   "apical": {"region": "all", "tension_mN_per_m": 0.39},
                   "basal": {"region": "all", "faces": "basal", "tension_mN_per_m": 0.39}},
        "time": {"end_s": END_S["plica"], "max_step_s": 5},
        "stop": {"at_equilibrium": False},
        "measure": {"sets": ["neighbours"]},
    }, threads=1)
    walls = simulation.walls
    random = np.random.default_rng(seed)
    variance = np.log1p(SPREAD**2)
    factors = np.where(walls["other"] < 0, 1.0, np.exp(np.sqrt(variance) * random.standard_normal(len(walls)) - 0.5 * variance))
    simulation.set_wall_factors("lateral", factors)
    start = dict(points=simulation.positions, polygons=np.array(apical_polygons(simulation), dtype=object),
                 walls=np.column_stack([walls["cell"], walls["other"]]), factors=factors)
    events, pairs = [], pairs_of(simulation.neighbours)
    while simulation.step() is not None:
        now = pairs_of(simulation.neighbours)
        events += [(simulation.time_s, *pair) for pair in sorted(pairs - now)]
        pairs = now
    np.savez(path, **start, events=np.array(events).reshape(-1, 3))
    length = simulation.walls["length_um"][simulation.walls["other"] >= 0]
    print(f"plica: {simulation.measures['exchanges']:.0f} exchanges, {len(events)} pairs part, in {simulation.steps} steps; "
          f"{(length < BELOW).sum()} walls are shorter than {BELOW} µm at the end, {(length < 2 * BELOW).sum()} than {2 * BELOW}")


def by_tyssue(path):
    import pandas as pd
    from scipy.stats import spearmanr
    from tyssue import Sheet
    from tyssue.geometry.planar_geometry import PlanarGeometry as geometry
    from tyssue.topology.sheet_topology import type1_transition

    data = np.load(path, allow_pickle=True)
    corners = sorted({node for ring in data["polygons"] for node in ring})
    number = {node: place for place, node in enumerate(corners)}
    vertices = pd.DataFrame(data["points"][corners, :2], columns=["x", "y"])
    sides = [(number[a], number[b], cell) for cell, ring in enumerate(data["polygons"]) for a, b in zip(ring, ring[1:] + ring[:1])]
    edges = pd.DataFrame(sides, columns=["srce", "trgt", "face"])
    faces = pd.DataFrame({"x": 0.0, "y": 0.0, "name": range(len(data["polygons"]))})
    sheet = Sheet("sheet", {"vert": vertices, "edge": edges, "face": faces}, coords=["x", "y"])
    sheet.settings["threshold_length"] = BELOW
    sheet.reset_topo()
    geometry.update_all(sheet)
    factor = {tuple(sorted(map(int, pair))): value for pair, value in zip(data["walls"], data["factors"])}
    elasticity = 0.3  # nN/µm³: areas change by some per cent

    def links():
        """Pairs of cells on both sides of each half-edge, by name; -1: none."""
        names = sheet.face_df["name"].to_numpy()
        half = {(s, t): f for s, t, f in sheet.edge_df[["srce", "trgt", "face"]].itertuples(index=False)}
        return [tuple(sorted((int(names[f]), int(names[half[t, s]]) if (t, s) in half else -1))) for (s, t), f in half.items()]

    first = sheet.face_df["area"].to_numpy()
    wanted = dict(zip(sheet.face_df["name"], first + TENSION * HEIGHT * sheet.face_df["perimeter"].to_numpy() / (4 * elasticity * first)))
    friction = DRAG * first.mean() * 2 / 2  # both surfaces of a cell; it has two vertices
    step_s, time_s, events, kept = 0.05, 0.0, [], links()
    while time_s < END_S["tyssue"]:
        srce, trgt, face = (sheet.edge_df[name].to_numpy() for name in ("srce", "trgt", "face"))
        x = sheet.vert_df[["x", "y"]].to_numpy(dtype=float)
        way = x[trgt] - x[srce]
        length = np.linalg.norm(way, axis=1)
        tension = TENSION * HEIGHT * np.array([factor.get(pair, 1.0) * (1.0 if pair[0] < 0 else 0.5) for pair in kept])
        area = 0.5 * np.bincount(face, x[srce, 0] * x[trgt, 1] - x[srce, 1] * x[trgt, 0], len(sheet.face_df))
        pressure = elasticity * (np.array([wanted[name] for name in sheet.face_df["name"]]) - area)
        pull = (tension / length)[:, None] * way
        push = 0.5 * pressure[face][:, None] * np.column_stack([way[:, 1], -way[:, 0]])
        force = np.zeros_like(x)
        for at, sign in ((srce, 1), (trgt, -1)):
            np.add.at(force, at, sign * pull + push)
        x = x + step_s / friction * force
        sheet.vert_df[["x", "y"]] = x
        time_s += step_s
        new = np.linalg.norm(x[trgt] - x[srce], axis=1)
        short = [e for e in np.argsort(new) if new[e] < BELOW and new[e] < length[e] and kept[e][0] >= 0]
        if short:
            before = set(kept)
            geometry.update_all(sheet)
            type1_transition(sheet, short[0], remove_tri_faces=False, multiplier=NEW / BELOW)
            sheet.reset_topo()
            geometry.update_all(sheet)
            kept = links()
            events += [(time_s, *pair) for pair in sorted(before - set(kept)) if pair[0] >= 0]
    theirs = {(int(a), int(b)): t for t, a, b in reversed(events)}
    ours = {(int(a), int(b)): t for t, a, b in data["events"][::-1]}
    both = sorted(ours.keys() & theirs.keys())
    soon = [pair for pair, at_s in ours.items() if at_s <= END_S["tyssue"]]
    print(f"pairs that part within {END_S['tyssue']:.0f} s: plica {len(soon)}, of which {len(theirs.keys() & set(soon))} in tyssue, "
          f"tyssue {len(theirs)}; within {END_S['plica']:.0f} s in plica {len(ours)}, of tyssue's {len(both)}")
    if len(both) > 2:
        print(f"rank correlation of their times: {spearmanr([ours[p] for p in both], [theirs[p] for p in both]).statistic:.2f}")
    for pair in sorted(both, key=ours.get)[:10]:
        print(f"  cells {pair[0]} and {pair[1]}: plica {ours[pair]:.0f} s, tyssue {theirs[pair]:.0f} s")


if __name__ == "__main__":
    which, file = sys.argv[1:3]
    if which == "plica":
        by_plica(file, int(sys.argv[4]) if len(sys.argv) > 4 else 1)
    else:
        by_tyssue(file)
