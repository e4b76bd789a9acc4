"""Exchanges of neighbours of one flat sheet in plica and in tyssue: their number, and their order (docs/developers/sheets.md).

Usage: tyssue_exchange.py plica FILE.npz [--cells N]           with the package plica of PYTHONPATH, then
       tyssue_exchange.py tyssue FILE.npz [--rule-of-plica]  with a Python that has tyssue, NumPy, SciPy and pandas.

A free sheet (80 cells, or N) relaxes under line tensions that are constant in time and differ between pairs of cells (log-normal).
plica: lateral cortices, factors by Simulation.set_wall_factors, soft cells of fixed volume. tyssue: the same tensions times the
height of cells, areas kept by elasticity; a vertex has the drag of half a cell, so nothing is fitted. In both, an edge shorter than
0.35 µm that shrinks turns to 0.6 µm, and cells that meet have the mean tension. In plica, and by its rule in tyssue, it turns only
if forces then lengthen the new edge and energy falls; else it waits for 5 s.
"""
import sys

import numpy as np

HEIGHT, TENSION, DRAG = 10.0, 0.5, 0.14  # µm, nN/µm, nN s/µm³: of one surface
BELOW, NEW, SPREAD, AGAIN_S = 0.35, 0.6, 0.6, 5.0
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


def by_plica(path, cells):
    import plica

    seed, side = 1, float(np.sqrt(36.45 * cells))
    simulation = plica.Simulation({
        "embryo": {"shape": "sheet", "length_um": side, "width_um": side, "cell_count": cells, "cell_height_um": HEIGHT, "seed": seed},
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


class TyssueSheet:
    """The sheet of a file in tyssue, with the forces of line tensions and of the elasticity of areas."""

    ELASTICITY = 0.3  # nN/µm³: areas change by some per cent

    def __init__(self, data):
        import pandas as pd
        from tyssue import Sheet
        from tyssue.geometry.planar_geometry import PlanarGeometry

        self.geometry = PlanarGeometry
        corners = sorted({node for ring in data["polygons"] for node in ring})
        number = {node: place for place, node in enumerate(corners)}
        vertices = pd.DataFrame(data["points"][corners, :2], columns=["x", "y"])
        sides = [(number[a], number[b], cell) for cell, ring in enumerate(data["polygons"]) for a, b in zip(ring, ring[1:] + ring[:1])]
        edges = pd.DataFrame(sides, columns=["srce", "trgt", "face"])
        faces = pd.DataFrame({"x": 0.0, "y": 0.0, "name": range(len(data["polygons"]))})
        self.sheet = Sheet("sheet", {"vert": vertices, "edge": edges, "face": faces}, coords=["x", "y"])
        self.sheet.settings["threshold_length"] = BELOW
        self.factor = {tuple(sorted(map(int, pair))): value for pair, value in zip(data["walls"], data["factors"])}
        self.follow_topology()
        first = self.sheet.face_df["area"].to_numpy()
        pressed = TENSION * HEIGHT * self.sheet.face_df["perimeter"].to_numpy() / (4 * self.ELASTICITY * first)
        self.wanted = dict(zip(self.sheet.face_df["name"], first + pressed))
        self.friction = DRAG * first.mean() * 2 / 2  # both surfaces of a cell; it has two vertices

    def follow_topology(self):
        """Find the pairs of cells on both sides of each half-edge, by name; -1: none."""
        self.sheet.reset_topo()
        self.geometry.update_all(self.sheet)
        names = self.sheet.face_df["name"].to_numpy()
        half = {(s, t): f for s, t, f in self.sheet.edge_df[["srce", "trgt", "face"]].itertuples(index=False)}
        self.pairs = [tuple(sorted((int(names[f]), int(names[half[t, s]]) if (t, s) in half else -1))) for (s, t), f in half.items()]

    @property
    def places(self):
        return self.sheet.vert_df[["x", "y"]].to_numpy(dtype=float)

    @property
    def ends(self):
        return self.sheet.edge_df["srce"].to_numpy(), self.sheet.edge_df["trgt"].to_numpy()

    def lengths(self):
        srce, trgt = self.ends
        return np.linalg.norm(self.places[trgt] - self.places[srce], axis=1)

    def forces(self):
        """Return the force on each vertex (nN), and the energy (nN µm)."""
        (srce, trgt), face, x = self.ends, self.sheet.edge_df["face"].to_numpy(), self.places
        way = x[trgt] - x[srce]
        length = np.linalg.norm(way, axis=1)
        tension = TENSION * HEIGHT * np.array([self.factor.get(pair, 1.0) * (1.0 if pair[0] < 0 else 0.5) for pair in self.pairs])
        area = 0.5 * np.bincount(face, x[srce, 0] * x[trgt, 1] - x[srce, 1] * x[trgt, 0], len(self.sheet.face_df))
        lacking = np.array([self.wanted[name] for name in self.sheet.face_df["name"]]) - area
        pull = (tension / length)[:, None] * way
        push = 0.5 * self.ELASTICITY * lacking[face][:, None] * np.column_stack([way[:, 1], -way[:, 0]])
        force = np.zeros_like(x)
        for at, sign in ((srce, 1), (trgt, -1)):
            np.add.at(force, at, sign * pull + push)
        return force, tension @ length + 0.5 * self.ELASTICITY * lacking @ lacking

    def move(self, step_s):
        self.sheet.vert_df[["x", "y"]] = self.places + step_s / self.friction * self.forces()[0]

    def turn(self, edge, only_if_forces_open):
        """Turn an edge and return the pairs of cells that part; or, by the rule of plica, leave all as it was and return none."""
        from tyssue.topology.sheet_topology import type1_transition

        before, pairs, energy = self.sheet.copy(), self.pairs, self.forces()[1]
        self.geometry.update_all(self.sheet)
        type1_transition(self.sheet, edge, remove_tri_faces=False, multiplier=NEW / BELOW)
        self.follow_topology()
        met = [e for e, pair in enumerate(self.pairs) if pair in set(self.pairs) - set(pairs)]
        if only_if_forces_open and met:
            srce, trgt = (end[met[0]] for end in self.ends)
            force, now = self.forces()
            if (force[trgt] - force[srce]) @ (self.places[trgt] - self.places[srce]) <= 0 or now >= energy:
                self.sheet, self.pairs = before, pairs
                return []
        return sorted(pair for pair in set(pairs) - set(self.pairs) if pair[0] >= 0)


def by_tyssue(path, by_rule_of_plica):
    from scipy.stats import spearmanr

    data = np.load(path, allow_pickle=True)
    sheet = TyssueSheet(data)
    step_s, time_s, events, judged_s, turns = 0.05, 0.0, [], {}, 0
    while time_s < END_S["tyssue"]:
        length = sheet.lengths()
        sheet.move(step_s)
        time_s += step_s
        new = sheet.lengths()
        short = [e for e in np.argsort(new) if new[e] < BELOW and new[e] < length[e] and sheet.pairs[e][0] >= 0
                 and not (by_rule_of_plica and time_s < judged_s.get(sheet.pairs[e], -AGAIN_S) + AGAIN_S)]
        if short:
            judged_s[sheet.pairs[short[0]]] = time_s
            parted = sheet.turn(short[0], by_rule_of_plica)
            turns += bool(parted)
            events += [(time_s, *pair) for pair in parted]
    theirs = {(int(a), int(b)): t for t, a, b in reversed(events)}
    ours = {(int(a), int(b)): t for t, a, b in data["events"][::-1]}
    both = sorted(ours.keys() & theirs.keys())
    for end_s in (END_S["tyssue"] / 10, END_S["tyssue"]):
        soon, then = ({pair for pair, at_s in when.items() if at_s <= end_s} for when in (ours, theirs))
        print(f"pairs that part within {end_s:.0f} s: plica {len(soon)}, tyssue {len(then)}, both {len(soon & then)}")
    print(f"short edges of tyssue that shrink at the end: {sum(1 for e, l in enumerate(sheet.lengths()) if l < BELOW) // 2}")
    if len(both) > 2:
        print(f"rank correlation of their times: {spearmanr([ours[p] for p in both], [theirs[p] for p in both]).statistic:.2f} (n = {len(both)})")
    for pair in sorted(both, key=ours.get):
        print(f"  cells {pair[0]} and {pair[1]}: plica {ours[pair]:.0f} s, tyssue {theirs[pair]:.0f} s")


if __name__ == "__main__":
    which, file, *options = sys.argv[1:]
    if which == "plica":
        by_plica(file, int(options[1]) if options else 80)
    else:
        by_tyssue(file, options == ["--rule-of-plica"])
