"""Exchanges of neighbours of one flat sheet in plica and in tyssue: their number, and their order (docs/developers/sheets.md).

Usage: tyssue_exchange.py plica [--cells N] [--end-s S] [--seed K] FILE.npz   with the package plica of PYTHONPATH, then
       tyssue_exchange.py tyssue [--rule-of-plica] FILE.npz ...  with a Python that has tyssue, scikit-image, NumPy, SciPy, pandas.

A free sheet (80 cells, or N) relaxes under line tensions that are constant in time and differ between pairs of cells (log-normal).
The order of events is compared within each sheet, over all sheets together: Kendall's tau of the times of pairs of cells that part in
both programs, and how often random orders reach it. Orders agree (set before the first run) if tau >= 0.5 and p < 0.01.
plica: lateral cortices, factors by Simulation.set_wall_factors, soft cells of fixed volume. tyssue: the same tensions times the
height of cells, areas kept by elasticity; a vertex has the drag of half a cell, so nothing is fitted. In both, an edge shorter than
0.35 µm that shrinks turns to 0.6 µm, and cells that meet have the mean tension. In plica, and by its rule in tyssue, it turns only
if forces then lengthen the new edge and energy falls; else it waits for 5 s.
"""
import argparse
from itertools import combinations

import numpy as np

HEIGHT, TENSION, DRAG = 10.0, 0.5, 0.14  # µm, nN/µm, nN s/µm³: of one surface
BELOW, NEW, SPREAD, AGAIN_S = 0.35, 0.6, 0.6, 5.0
END_S = 60.0


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


def by_plica(path, cells, end_s, seed):
    import plica

    side = float(np.sqrt(36.45 * cells))
    simulation = plica.Simulation({
        "embryo": {"shape": "sheet", "length_um": side, "width_um": side, "cell_count": cells, "cell_height_um": HEIGHT, "seed": seed},
        "elasticity": {"model": "neo-hookean", "young_modulus_Pa": 20, "poisson_ratio": 0, "relaxation_s": 12, "corner_barrier_Pa": 10},
        "dynamics": {"surface_drag_Pa_s_per_um": 1000 * DRAG},
        "exchange": {"below_um": BELOW, "new_length_um": NEW},
        "cortex": {"lateral": {"region": "all", "faces": "lateral", "tension_mN_per_m": TENSION},
                   "apical": {"region": "all", "tension_mN_per_m": 0.39},
                   "basal": {"region": "all", "faces": "basal", "tension_mN_per_m": 0.39}},
        "time": {"end_s": end_s, "max_step_s": 5},
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


def events_of_tyssue(data, by_rule_of_plica):
    """Return the time at which each pair of cells parts, s, and the number of short edges that shrink at the end."""
    sheet = TyssueSheet(data)
    step_s, time_s, parted_s, judged_s = 0.05, 0.0, {}, {}
    while time_s < END_S:
        length = sheet.lengths()
        sheet.move(step_s)
        time_s += step_s
        new = sheet.lengths()
        short = [e for e in np.argsort(new) if new[e] < BELOW and new[e] < length[e] and sheet.pairs[e][0] >= 0
                 and not (by_rule_of_plica and time_s < judged_s.get(sheet.pairs[e], -AGAIN_S) + AGAIN_S)]
        if short:
            judged_s[sheet.pairs[short[0]]] = time_s
            for pair in sheet.turn(short[0], by_rule_of_plica):
                parted_s.setdefault(pair, time_s)
    return parted_s, sum(1 for length in sheet.lengths() if length < BELOW) // 2


def concordance(ours, theirs):
    """Return the pairs of events in the same order minus those in the opposite order, and their number, over sheets of times."""
    signs = [np.sign((a[i] - a[j]) * (b[i] - b[j])) for a, b in zip(ours, theirs) for i, j in combinations(range(len(a)), 2)]
    return np.sum(signs), np.count_nonzero(signs)


def by_tyssue(paths, by_rule_of_plica):
    ours, theirs, counts = [], [], np.zeros(5, dtype=int)
    for path in paths:
        data = np.load(path, allow_pickle=True)
        plica = {(int(a), int(b)): t for t, a, b in data["events"][::-1] if t <= END_S}
        tyssue, short = events_of_tyssue(data, by_rule_of_plica)
        both = sorted(plica.keys() & tyssue.keys(), key=plica.get)
        first = [set(sorted(times, key=times.get)[:3]) for times in (plica, tyssue)]
        of_sheet = [len(plica), len(tyssue), len(both), len(first[0]), len(first[0] & first[1])]
        counts += of_sheet
        print(f"{path}: pairs that part within {END_S:.0f} s: plica {of_sheet[0]}, tyssue {of_sheet[1]}, both {of_sheet[2]}; "
              f"of the first {of_sheet[3]}: {of_sheet[4]}; {short} short edges of tyssue at the end")
        print("  " + ", ".join(f"{a}-{b} {plica[a, b]:.1f} and {tyssue[a, b]:.1f} s" for a, b in both))
        ours.append(np.array([plica[pair] for pair in both]))
        theirs.append(np.array([tyssue[pair] for pair in both]))
    print(f"all {len(paths)}: plica {counts[0]}, tyssue {counts[1]}, both {counts[2]}; of plica's first three in each sheet, "
          f"{counts[4]} of {counts[3]} are tyssue's first three")
    excess, compared = concordance(ours, theirs)
    if compared:
        random = np.random.default_rng(1)
        chance = [concordance(ours, [random.permutation(times) for times in theirs])[0] >= excess for _ in range(2000)]
        print(f"order of common events: Kendall's tau {excess / compared:.2f} ({compared} comparisons), p = {np.mean(chance):.4f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("program", choices=["plica", "tyssue"])
    parser.add_argument("files", nargs="+")
    parser.add_argument("--cells", type=int, default=80)
    parser.add_argument("--end-s", type=float, default=END_S)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rule-of-plica", action="store_true")
    options = parser.parse_args()
    if options.program == "plica":
        by_plica(options.files[0], options.cells, options.end_s, options.seed)
    else:
        by_tyssue(options.files, options.rule_of_plica)
