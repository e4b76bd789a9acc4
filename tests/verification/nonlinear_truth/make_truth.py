#!/usr/bin/env python3
"""Rest states of blocks of cells and a pill at large strains, by finite elements that are not plica's.

    python3 -m venv venv
    venv/bin/pip install felupe==11.3.0 numpy==2.4.6 scipy==1.17.1 pypardiso==0.4.7
    OMP_NUM_THREADS=1 venv/bin/python make_truth.py          # all cases; or: make_truth.py bending pill

reads the scenarios (*.toml) and the cells of the pill at rest (pill_cells.json) beside it and writes
nonlinear_truth.json. All cases take some ten minutes.

Meshes, triquadratic elements, quadrature and assembly are felupe's (https://github.com/adtzlr/felupe). What is here
are the energies, as plica's theory pages document them for the limit of small elements, and Newton's method. With the
deformation gradient F = R U:

- cells: mu |dev(U - I)|^2 + kappa/2 (J - 1)^2 per volume, J = det F, mu and kappa from Young's modulus and Poisson's
  ratio; model "neo-hookean": mu/2 (tr C - 3 - 2 ln J) + lambda/2 (J - 1)^2, C = F^T F, lambda Lame's;
- the volume of each cell (of all of its elements together) is that at rest, with a multiplier, the cell's pressure;
- contraction: an active film on the face of a contractile cell. Along either direction of the face lie lines with the
  stretch l and the length L at rest; a cell's two edges of stiffness k are spread over them. With a rest length of r L
  the energy is k L (l - r)^2 per length of line and per unit of the coordinate across (0 to 1), where l > r;
- pressure: a dead load on the face at rest.

Elements are integrated in full (3 x 3 x 3 points). Displacements are continuous and quadratic, so kappa does not lock
them; pressures are constant in a cell. What is mirrored is cut away: y < 0 and, but for the cantilever, x < 0.

Each case is solved on three meshes of n x n x n elements a cell (`divisions`) and extrapolated.
"""
import datetime
import importlib.metadata
import json
import pathlib
import sys
import time
import tomllib

import felupe as fem
import numpy as np
import scipy.sparse as sparse

from energies import Cells, Film, NeoHookeanCells, check_energies

try:
    from pypardiso import spsolve
except ImportError:  # the same results, but the finer meshes take long
    from scipy.sparse.linalg import spsolve

here = pathlib.Path(__file__).resolve().parent
Q2 = fem.TriQuadraticHexahedron()
axes = "xyz"


# --- Cells at rest ---


def linear(rules, distance):
    """The linear profile, falling from 1 in the middle to `edge` at the half-width."""
    profile = rules["profile"]
    assert profile["shape"] == "linear"
    return 1 - (1 - profile.get("edge", 0)) * np.minimum(1, distance / profile["half_width_um"])


def range_of(rules, axis):
    return rules.get(f"{axis}_um", [-np.inf, np.inf])


class Block:
    """The cells of a block that are not mirrored; u along x, v along y, w along z (apical is above)."""

    def __init__(self, embryo, mirrored):
        self.size = np.array([embryo["length_um"], embryo["width_um"], embryo["cell_height_um"] * embryo["cells"][2]])
        counts = np.array(embryo["cells"])
        self.step = self.size / counts
        places = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), -1).reshape(-1, 3)
        self.low = places * self.step - self.size / 2
        keep = np.all([self.low[:, axes.index(a)] > -1e-9 for a in mirrored], axis=0)
        self.low = self.low[keep]
        self.count = len(self.low)

    def at(self, cell, uvw):
        return self.low[cell] + uvw * self.step

    def strengths(self, scenario, rules):
        """Factor of each cell on the stiffness: 0 outside the region, else by the profile."""
        centre = self.low + self.step / 2
        region = scenario["region"][rules["region"]] if rules["region"] != "all" else {}
        inside = np.all([(x > low) & (x < high) for x, (low, high) in
                         zip(centre.T, (range_of(region, a) for a in axes))], axis=0)
        return inside * linear(rules, np.abs(centre[:, {"along": 0, "across": 1}[rules["profile"]["axis"]]]))


class Pill:
    """The cells of a pill. A face's point in the surface halfway between base and apex is that of the bilinear face
    through its corners there, put on that surface (a capsule) along its normal; base and apex lie half a height off."""

    def __init__(self, embryo, mirrored):
        self.height = embryo["cell_height_um"]
        self.half_axis = (embryo["length_um"] - embryo["diameter_um"]) / 2
        self.radius = (embryo["diameter_um"] - self.height) / 2
        stored = json.loads((here / "pill_cells.json").read_text())
        corners = np.array(stored["basal_corners_um"])  # cells x 4 x 3, u first, then counter-clockwise from outside
        self.furrow = stored["furrow_cells"]
        centre = corners.mean(1)
        self.ids = np.flatnonzero(np.all([centre[:, axes.index(a)] > 0 for a in mirrored], axis=0))
        self.corners = self.on_capsule(corners[self.ids], 0)
        self.count = len(self.ids)

    def on_capsule(self, points, offset):
        foot = np.zeros_like(points)
        foot[..., 0] = np.clip(points[..., 0], -self.half_axis, self.half_axis)
        normal = points - foot
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        return foot + normal * (self.radius + offset)

    def strengths(self, scenario, rules):
        """As in a block; the distance across is the arc about the x axis from the belly, at the mean of the corners."""
        corners = np.stack([self.at(c, np.array([[u, v, w] for u in (0, 1) for v in (0, 1) for w in (0, 1)]))
                            for c in range(self.count)])
        _, y, z = corners.mean(1).T
        assert rules["profile"]["axis"] == "across"
        return np.isin(self.ids, self.furrow) * linear(rules, np.hypot(y, z) * np.abs(np.arctan2(y, -z)))

    def at(self, cell, uvw):
        u, v, w = np.moveaxis(uvw, -1, 0)
        a, b, c, d = (self.corners[cell, i] for i in range(4))
        weights = [(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v]
        flat = sum(weight[..., None] * corner for weight, corner in zip(weights, (a, b, c, d)))
        return self.on_capsule(flat, (self.height * (w - 0.5))[..., None])


# --- One mesh ---


def graded(t):
    """Place in the cell for the even place t: elements are smaller towards its faces, where films begin and end."""
    return 0.4 * t + 0.6 * (1 - np.cos(np.pi * t)) / 2


def graded_slope(t):
    return 0.4 + 0.6 * np.pi / 2 * np.sin(np.pi * t)


class Model:
    """A case on a mesh with n triquadratic elements a cell and direction."""

    def __init__(self, case, n):
        scenario, mirrored = case["scenario"], case["mirrored"]
        embryo = scenario["embryo"]
        self.n = n
        self.cells = (Block if embryo["shape"] == "block" else Pill)(embryo, mirrored)
        self.make_mesh()
        elasticity = scenario["elasticity"]
        E, nu = elasticity["young_modulus_Pa"] * 1e-3, elasticity["poisson_ratio"]  # nN/um^2
        mu = E / (2 * (1 + nu))
        law = (NeoHookeanCells(mu, 2 * mu * nu / (1 - 2 * nu)) if elasticity.get("model") == "neo-hookean"
               else Cells(mu, E / (3 * (1 - 2 * nu))))
        region = fem.RegionTriQuadraticHexahedron(self.mesh)
        volumes = fem.Mesh(np.zeros((self.cells.count, 3)), self.element_cell[:, None], "vertex")
        of_cells = fem.RegionConstantHexahedron(volumes, quadrature=region.quadrature, grad=False)
        self.field = fem.FieldContainer([fem.Field(region, dim=3), fem.Field(of_cells, dim=1)])
        self.solid = fem.SolidBody(law, self.field)
        contractions = scenario.get("contraction", {}).values()
        self.films = [film for rules in contractions for film in self.make_films(case, rules)]
        self.load = np.zeros((len(self.mesh.points), 3))
        for rules in scenario.get("pressure", {}).values():
            self.add_pressure(rules)
        self.make_supports(case)

    def make_mesh(self):
        n, cells = self.n, self.cells
        local = (Q2.points + 1) / 2
        starts = np.stack(np.meshgrid(*(np.arange(n),) * 3, indexing="ij"), -1).reshape(-1, 3)
        self.element_cell = np.repeat(np.arange(cells.count), n**3)
        self.element_start = np.tile(starts, (cells.count, 1))
        points = np.empty((cells.count, n**3, 27, 3))
        for c in range(cells.count):
            points[c] = cells.at(c, graded((starts[:, None] + local) / n))
        flat = points.reshape(-1, 3)
        _, first, inverse = np.unique(np.round(flat / 1e-4).astype(np.int64), axis=0, return_index=True,
                                      return_inverse=True)
        self.mesh = fem.Mesh(flat[first], inverse.reshape(-1, 27), "hexahedron27")

    def face(self, chosen, side):
        """Region of the apical or basal faces of the chosen elements: with face points, areas for volumes."""
        gauss = fem.GaussLegendre(order=2, dim=2)
        w = {"apical": 1.0, "basal": -1.0}[side]
        points = np.column_stack([gauss.points, np.full(len(gauss.points), w)])
        mesh = fem.Mesh(self.mesh.points, self.mesh.cells[chosen], "hexahedron27")
        region = fem.Region(mesh, Q2, fem.quadrature.Scheme(points, gauss.weights))
        outward = w * np.cross(region.dXdr[:, 0], region.dXdr[:, 1], axis=0)
        region.dV = np.linalg.norm(outward, axis=0) * gauss.weights[:, None]
        return region, outward / np.linalg.norm(outward, axis=0)

    def on_side(self, side):
        return self.element_start[:, 2] == {"apical": self.n - 1, "basal": 0}[side]

    def make_films(self, case, rules):
        strength = self.cells.strengths(case["scenario"], rules)
        chosen = np.flatnonzero(self.on_side(rules["edges"]) & (strength > 0)[self.element_cell])
        region, _ = self.face(chosen, rules["edges"])
        w = {"apical": 1.0, "basal": 0.0}[rules["edges"]]
        n = self.n
        area = np.linalg.norm(np.cross(region.dXdr[:, 0], region.dXdr[:, 1], axis=0), axis=0) * (2 * n) ** 2
        at = (self.element_start[chosen, None, :2] + (region.quadrature.points[:, :2] + 1) / 2) / n  # element, point
        for direction, ratio in enumerate((rules.get("along_ratio", 1), rules.get("across_ratio", 1))):
            if ratio == 0:
                continue
            by_xi = region.dXdr[:, direction] * 2 * n
            speed = np.linalg.norm(by_xi, axis=0)
            # lengths at rest of the lines through the points
            t = np.linspace(0, 1, 201)
            whole = np.empty(at.shape[:2])
            for e, cell in enumerate(self.element_cell[chosen]):
                uvw = np.full((at.shape[1], len(t), 3), w)
                uvw[:, :, direction] = t
                uvw[:, :, 1 - direction] = graded(at[e, :, None, 1 - direction])
                whole[e] = np.linalg.norm(np.diff(self.cells.at(cell, uvw), axis=1), axis=-1).sum(1)
            stiffness = rules["stiffness_nN_per_um"] * ratio * strength[self.element_cell[chosen]]
            weight = stiffness * whole.T * speed / area * graded_slope(at[..., 1 - direction]).T
            film = Film(by_xi / speed, weight, rules.get("rest_length_ratio", 0))
            yield fem.SolidBody(film, fem.FieldContainer([fem.Field(region, dim=3)]))

    def add_pressure(self, rules):
        chosen = np.flatnonzero(self.on_side(rules["face"]))
        region, normal = self.face(chosen, rules["face"])
        push = -rules["pressure_Pa"] * 1e-3 * normal * region.dV
        nodal = np.einsum("aq,iqc->cai", region.element_h, push)
        np.add.at(self.load, region.mesh.cells, nodal)

    def make_supports(self, case):
        X, fixed = self.mesh.points, np.zeros((len(self.mesh.points), 3), dtype=bool)
        near = 1e-3
        for a in case["mirrored"]:
            fixed[np.abs(X[:, axes.index(a)]) < near, axes.index(a)] = True
        for rules in case["scenario"]["hold"].values():
            inside = np.all([(X[:, i] > range_of(rules, a)[0] - near) & (X[:, i] < range_of(rules, a)[1] + near)
                             for i, a in enumerate(axes)], axis=0)
            for a in rules.get("directions", axes):
                fixed[inside, axes.index(a)] = True
        self.free = np.flatnonzero(np.concatenate([~fixed.ravel(), np.ones(self.cells.count, dtype=bool)]))

    def set(self, u, p):
        self.field[0].values[:] = u
        self.field[1].values[:] = p
        for film in self.films:
            film.field[0].values[:] = u

    def residual(self, part):
        f = self.solid.assemble.vector(self.field).toarray()[:, 0]
        size = self.load.size
        for film in self.films:
            film.umat.scale = part
            f[:size] += film.assemble.vector(film.field).toarray()[:, 0]
        f[:size] -= part * self.load.ravel()
        return f

    def tangent(self):
        K = self.solid.assemble.matrix(self.field)
        grown = K.shape
        for film in self.films:
            B = film.assemble.matrix(film.field).tocsr()
            B.resize(grown)
            K = K + B
        return K

    def newton(self, part, u, p, log):
        """Displacements and pressures of balance under a part of the load, from these; None where the way is lost."""
        for iteration in range(14):
            self.set(u, p)
            f = self.residual(part)[self.free]
            size = np.linalg.norm(f)
            if not np.isfinite(size):
                return None
            K = self.tangent()[self.free][:, self.free].tocsr()
            d = np.zeros(u.size + len(p))
            d[self.free] = spsolve(K, -f)
            du = d[: u.size].reshape(u.shape)
            step = np.abs(du).max()
            log.append(f"    {iteration}: residual {size:.2e} nN, step {step:.2e} um")
            if not np.isfinite(step) or step > 500:
                return None
            u, p = u + du, p + d[u.size:, None]
            if step < 1e-6:  # the next would be below rounding, as convergence is quadratic
                return u, p
            if iteration > 8 and step > 1e-2:
                return None
        return None

    def interpolate(self, coarse, u):
        """Displacements of a coarser mesh at the points of this one."""
        result = np.empty_like(self.mesh.points)
        where = (self.element_start[:, None] + (Q2.points + 1) / 2) / self.n * coarse.n  # in coarse elements
        start = np.clip(np.floor(where + 1e-9), 0, coarse.n - 1).astype(int)
        element = self.element_cell[:, None] * coarse.n**3 + start @ [coarse.n**2, coarse.n, 1]
        for e, nodes in enumerate(self.mesh.cells):
            for a, node in enumerate(nodes):
                shape = Q2.function(2 * (where[e, a] - start[e, a]) - 1)
                result[node] = shape @ u[coarse.mesh.cells[element[e, a]]]
        return result

    def solve(self, start=None, verbose=True):
        zero = np.zeros_like(self.mesh.points), np.zeros((self.cells.count, 1))
        log = []
        if start is not None and (found := self.newton(1.0, *start, log)):
            return found
        state, before, part, step = zero, None, 0.0, 0.1
        while part < 1:
            goal = min(1.0, part + step)
            guess = state
            if before is not None:  # go on as in the last step
                factor = (goal - part) / (part - before[0])
                guess = tuple(s + factor * (s - b) for s, b in zip(state, before[1]))
            found = self.newton(goal, *guess, log)
            if found is None:
                step /= 2
                before = None if step < 0.02 else before
                if step < 1e-3:
                    raise RuntimeError("no balance beyond %.3f of the load\n" % part + "\n".join(log[-30:]))
                continue
            before, state, part, step = (part, state), found, goal, step * 1.3
            if verbose:
                print(f"  part {part:.3f}, largest displacement {np.abs(state[0]).max():.4f} um", flush=True)
        return state

    def stretches(self):
        F = self.field.extract()[0]
        s = np.linalg.svd(np.moveaxis(F, (0, 1), (-2, -1)), compute_uv=False)
        centre = s[13]  # the middle one of the 27 Gauss points
        return float(centre.min()), float(centre.max())

    def displacement(self, u, point):
        distance = np.linalg.norm(self.mesh.points - point, axis=1)
        nearest = distance.argmin()
        assert distance[nearest] < 1e-3, (point, distance[nearest])
        return u[nearest]


# --- The cases ---


def read_scenario(name):
    """Of a scenario with a base, what it says on top of that, table by table."""
    scenario = tomllib.loads((here / f"{name}.toml").read_text())
    if "base" not in scenario:
        return scenario
    base = read_scenario(scenario.pop("base").removesuffix(".toml"))
    for key, value in scenario.items():
        base[key] = base[key] | value if isinstance(value, dict) and key in base else value
    return base


def cases():
    scenarios = {name: read_scenario(name)
                 for name in ("bending", "stretching", "folding", "pill", "neo_bending", "neo_stretching")}
    found = {
        "bending": {
            "scenario": scenarios["bending"], "mirrored": "y", "divisions": [3, 4, 6],
            "points": {"end, apical": [120, 0, 20], "end, basal": [120, 0, -20], "end, basal corner": [120, 20, -20],
                       "half-way, apical": [0, 0, 20], "half-way, basal": [0, 0, -20],
                       "a sixth, apical": [-80, 0, 20]}},
        "stretching": {
            "scenario": scenarios["stretching"], "mirrored": "xy", "divisions": [3, 4, 6],
            "points": {"middle, apical": [0, 0, 7.5], "middle, basal": [0, 0, -7.5], "middle, apical rim": [0, 20, 7.5],
                       "a quarter, apical": [24, 0, 7.5], "a quarter, basal": [24, 0, -7.5],
                       "half-way, apical": [40, 0, 7.5], "half-way, basal rim": [40, 20, -7.5],
                       "three quarters, apical": [64, 0, 7.5], "three quarters, basal": [64, 0, -7.5]}},
        "folding": {
            "scenario": scenarios["folding"], "mirrored": "xy", "divisions": [3, 4, 6],
            "points": {"middle, apical": [0, 0, 15], "middle, apical rim": [0, 15, 15],
                       "half-way, apical": [45, 0, 15], "half-way, basal": [45, 0, -15],
                       "end, apical": [90, 0, 15], "end, basal": [90, 0, -15], "end, basal corner": [90, 15, -15]}},
        "pill": {
            "scenario": scenarios["pill"], "mirrored": "xy", "divisions": [2, 3, 4],
            "points": {"belly, apical": [0, 0, -70], "belly, basal": [0, 0, -40],
                       "second row, apical": [0, 26.49031154, -64.7940074],
                       "fourth row, apical": [0, 51.16663859, -47.77002298],
                       "edge of furrow, apical": [0, 61.04133176, -34.26303864], "side, apical": [0, 70, 0],
                       "furrow along, apical": [35.47174846, 0, -70],
                       "end of furrow, apical": [56.58869376, 0, -68.00599414], "end, apical": [110, 0, 0]}},
    }
    for name in ("bending", "stretching"):
        found[f"neo_{name}"] = found[name] | {"scenario": scenarios[f"neo_{name}"]}
    return found


def order_of(coarse, middle, fine, divisions):
    """The power of the size of elements with which the error falls, from the differences of three meshes."""
    sought = np.linalg.norm(middle - coarse) / np.linalg.norm(fine - middle)
    a, b, c = (1 / n for n in divisions)
    orders = np.linspace(1, 4, 301)
    ratios = (a**orders - b**orders) / (b**orders - c**orders)
    return float(orders[np.abs(ratios - sought).argmin()])


def solve_case(name, case):
    """The case's entry in the file: solved on its meshes, extrapolated. The error is how far that is from the finest
    mesh, or how far the finest is from the one before, whichever is larger: three meshes may show too high an order."""
    coarse, values, unknowns = None, [], []
    for n in case["divisions"]:
        begin = time.time()
        model = Model(case, n)
        print(f"{name}: {n} elements a cell and direction, {len(model.free)} unknowns", flush=True)
        start = None if coarse is None else (model.interpolate(coarse, found[0]), found[1])
        found = model.solve(start)
        coarse = model
        values.append(np.array([model.displacement(found[0], X) for X in case["points"].values()]))
        unknowns.append(len(model.free))
        print(f"  {time.time() - begin:.0f} s, stretches {model.stretches()}", flush=True)
        for (point, X), u in zip(case["points"].items(), values[-1]):
            print(f"    {point:28s} {X} -> {np.round(u, 4).tolist()}")
    order = order_of(*values, case["divisions"])
    b, c = (1 / n for n in case["divisions"][-2:])
    beyond = (values[-1] - values[-2]) / ((b / c) ** order - 1)
    limit = values[-1] + beyond
    error = np.maximum(np.linalg.norm(beyond, axis=1), np.linalg.norm(values[-1] - values[-2], axis=1))
    largest = np.linalg.norm(found[0], axis=1).max()
    low, high = model.stretches()
    print(f"  errors fall with power {order:.2f} of the size; largest displacement {largest:.3f} um", flush=True)
    return {
        "scenario": f"{name}.toml",
        "elements_per_cell_each_way": case["divisions"], "unknowns": unknowns, "order_of_convergence": round(order, 2),
        "largest_displacement_um": round(float(largest), 4),
        "principal_stretches": [round(low, 2), round(high, 2)],
        "points": [{"name": point, "rest_um": X, "displacement_um": np.round(u, 5).tolist(),
                    "error_um": round(float(e), 5), "finest_mesh_um": np.round(f, 5).tolist()}
                   for (point, X), u, e, f in zip(case["points"].items(), limit, error, values[-1])],
    }


def main():
    check_energies()
    names = sys.argv[1:]
    path = here / "nonlinear_truth.json"
    truth = json.loads(path.read_text()) if names and path.exists() else {"cases": {}}
    packages = ("felupe", "numpy", "scipy")
    truth = {"what": "Displacements at rest by finite elements with felupe, made by make_truth.py",
             "made_on": datetime.date.today().isoformat(),
             "versions": {"python": sys.version.split()[0]} | {p: importlib.metadata.version(p) for p in packages},
             "cases": truth["cases"]}
    for name, case in cases().items():
        if not names or name in names:
            truth["cases"][name] = solve_case(name, case)
            path.write_text(json.dumps(truth, indent=1) + "\n")


if __name__ == "__main__":
    main()
