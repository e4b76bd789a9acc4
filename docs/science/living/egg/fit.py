"""Fit a hypothesis of hypotheses.toml to its targets by slopes, and print its misfit and evidence.

Usage: fit.py HYPOTHESIS FOLDER [--runs 8] [--early]. It starts from the row of the hypothesis in starts.csv; with --early, the third round, from that
in early-starts.csv, to `early` targets. FOLDER keeps all runs: the same command continues after an interruption, or with more runs.
Writes keys.csv and targets.csv (Fit.write), and evidence.json. Needs egg.obj (mesh.py).
"""
import argparse
import csv
import json
import math
import tomllib
import warnings
from pathlib import Path

import numpy as np

import plica
from plica.descent import bounded_step
from plica.fit_problem import Scale

HERE = Path(__file__).resolve().parent
PLAN = tomllib.loads((HERE / "hypotheses.toml").read_text())
TOLERANCE = 0.5  # of a fit: misfit and prior's misfit that a step must promise
KINK = 2  # what may be promised beyond a kink


def scenario_of(name):
    """Scenario of a hypothesis before its fit, and the bounds of its keys."""
    hypothesis = PLAN["hypothesis"][name]
    scenario = plica.Scenario(HERE / PLAN["scenario"])
    if "set" in hypothesis:
        scenario.update(hypothesis["set"])
    bounds = {key: tuple(ends) for key, ends in PLAN["keys"].items() if key not in hypothesis.get("drop", [])}
    return scenario, bounds | {key: tuple(ends) for key, ends in hypothesis.get("keys", {}).items()}


def prior(low, high):
    """Value and standard deviation, in the key's unit, of a prior that is normal in the logarithm."""
    scale = Scale.of(low, high)
    centre = scale.back(0.5 * (scale.low + scale.high))
    return centre, centre * scale.spread


class Egg:
    """Outcomes of node positions that no column has: height of the midline's cells, and section of the lateral ectoderm."""

    def __init__(self, scenario):
        sim = plica.Simulation(scenario)
        hexahedra, self.rest = np.asarray(sim.hexahedra), np.asarray(sim.rest_positions)
        own = hexahedra[sim.regions["midline"][sim.hexahedron_cell]]
        self.edges = np.stack([own[:, :4].ravel(), own[:, 4:].ravel()], axis=1)
        self.rings = []
        for side, sign in ((slice(4, 8), 1), (slice(0, 4), -1)):  # apical outside, basal inside
            nodes = np.unique(hexahedra[:, side])
            nodes = nodes[np.abs(self.rest[nodes, 0]) < 1e-6]
            angle = np.arctan2(self.rest[nodes, 1], -self.rest[nodes, 2])
            self.rings.append((nodes[np.argsort(angle)], sign))
        self.section = self._section(self.rest)

    def height(self, positions):
        """Mean length of the edges from base to apex of the midline's cells, µm; its gradient."""
        along = positions[self.edges[:, 1]] - positions[self.edges[:, 0]]
        length = np.linalg.norm(along, axis=1)
        gradient = np.zeros_like(positions)
        for column, sign in ((0, -1), (1, 1)):
            np.add.at(gradient, self.edges[:, column], sign * along / length[:, None] / len(length))
        return length.mean(), gradient

    def flank(self, positions):
        """Area of the section x = 0 between 60 and 120 degrees from the ventral midline, relative to reference; its gradient."""
        gradient, h = np.zeros_like(positions), 1e-4
        for ring, sign in self.rings:
            for axis in (1, 2):
                for k in range(len(ring)):
                    moved = positions[ring][:, 1:].copy()
                    ends = []
                    for change in (h, -h):
                        moved[k, axis - 1] = positions[ring[k], axis] + change
                        ends.append(self._sector(moved[[k - 1, k, (k + 1) % len(ring)]]))
                    gradient[ring[k], axis] = sign * (ends[0] - ends[1]) / (2 * h) / self.section
        return self._section(positions) / self.section, gradient

    def _section(self, positions):
        return sum(sign * self._sector(np.concatenate([positions[ring][:, 1:], positions[ring[:1]][:, 1:]])) for ring, sign in self.rings)

    @staticmethod
    def _sector(line):
        """Area between a line of places (y, z) and the axis, within 30 degrees of the y axis on either side."""
        a, b = line[:-1], line[1:]
        total = 0.0
        for side in (1, -1):
            p, q = a * [side, 1], b * [side, 1]
            low, high = np.zeros(len(p)), np.ones(len(p))
            for slope in (1, -1):  # keep slope * z <= y tan 30
                at_p, at_q = (c[:, 0] * math.tan(math.pi / 6) - slope * c[:, 1] for c in (p, q))
                cut = np.divide(at_p, at_p - at_q, out=np.zeros(len(p)), where=at_p != at_q)
                high = np.where((at_q < 0) & (at_p >= 0), np.minimum(high, cut), high)
                low = np.where((at_p < 0) & (at_q >= 0), np.maximum(low, cut), low)
                high = np.where((at_p < 0) & (at_q < 0), 0, high)
            high = np.maximum(high, low)
            r, s = (p + (q - p) * t[:, None] for t in (low, high))
            total += side * 0.5 * float((r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0]).sum())
        return total


def targets_of(early):
    """Targets of hypotheses.toml, of the third round if `early`."""
    return [target | target["early"] if early and "early" in target else target for target in PLAN["target"]]


def experiments(scenario, early=False):
    """Scenario without and with light, each with its targets."""
    egg = Egg(scenario)
    found = {}
    for target in targets_of(early):
        outcome = getattr(egg, target["outcome"], target["outcome"])
        of_one = found.setdefault(target.get("light_min"), {})
        of_one.setdefault(outcome, {})[target["at_min"]] = (target["value"], target["sd"])
    lit = []
    for minute, targets in found.items():
        changed = scenario.copy()
        if minute is not None:
            changed.update({"ablation.light.region": "mesoderm", "ablation.light.only": ["cortex.apical"], "ablation.light.at_min": minute})
        lit.append((changed, targets))
    return lit


def evidence(fit, bounds):
    """Laplace's approximation of the logarithm of the evidence, and what it is made of."""
    scales = [Scale.of(*ends) for ends in bounds.values()]
    place, low, high, spread = (np.array(one) for one in zip(
        *[(scale.to(fit.values[key]), scale.low, scale.high, scale.spread) for key, scale in zip(bounds, scales)]))
    away = (place - 0.5 * (low + high)) / spread
    slopes = fit.jacobian * spread
    promised = promise(fit, away, slopes, (low - place) / spread, (high - place) / spread)
    narrowed = np.linalg.slogdet(np.eye(len(scales)) + slopes.T @ slopes)[1]
    known = np.linalg.eigvalsh(slopes.T @ slopes)
    return {"misfit": fit.score, "prior": float(away @ away), "log_det": float(narrowed), "keys": len(bounds),
            "keys_used": float((known / (1 + known)).sum()), "log_evidence": -0.5 * (fit.score + float(away @ away) + float(narrowed)),
            "promised": promised, "converged": fit.end == "converged" or (fit.end == "no better place nearby" and promised < KINK),
            "runs": fit.runs, "end": fit.end}


def promise(fit, away, slopes, low, high):
    """Decrease of misfit and prior's misfit that a Gauss-Newton step within the bounds promises, by slopes at the end of the fit.

    Places are in standard deviations of the prior: `away` from its centre, `low` and `high` from the end of the fit."""
    residuals = np.concatenate([[one.deviations for one in fit.misses], away])
    rows = np.concatenate([slopes, np.eye(len(away))])
    step = bounded_step(rows, residuals, low, high, 1e3)
    return float(residuals @ residuals - ((residuals + rows @ step) ** 2).sum())


def problem_of(name, early):
    """What is fitted, to which targets, and what is known beforehand: arguments of plica.fit."""
    scenario, bounds = scenario_of(name)
    with (HERE / ("early-starts.csv" if early else "starts.csv")).open() as file:
        start = next(row for row in csv.DictReader(file) if row["hypothesis"] == name)
    scenario.update({key: float(start[key]) for key in bounds})
    return experiments(scenario, early), bounds, {key: prior(*ends) for key, ends in bounds.items()}


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("hypothesis", choices=list(PLAN["hypothesis"]))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--runs", type=int, default=8)
    parser.add_argument("--early", action="store_true")
    options = parser.parse_args()
    tests, bounds, priors = problem_of(options.hypothesis, options.early)
    warnings.simplefilter("ignore")
    fit = plica.fit(tests, of=bounds, priors=priors, runs=options.runs, tolerance=TOLERANCE, folder=options.folder, progress=True)
    found = {"hypothesis": options.hypothesis, **evidence(fit, bounds), "values": fit.values,
             "targets": [[one.scenario, str(one.outcome), one.at_min, one.value, one.sd, one.found] for one in fit.misses]}
    (options.folder / "evidence.json").write_text(json.dumps(found, indent=1) + "\n")
    print(fit)
    print(json.dumps({key: value for key, value in found.items() if key != "targets"}, indent=1))
