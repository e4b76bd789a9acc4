#!/usr/bin/python3
"""How many runs `plica.fit` takes: twelve keys of `furrow-slice` from twelve outcomes in three scenarios (control; myosin of the
mesoderm inhibited; floor of the mesoderm cut), before closure. Drag is known, since only ratios of forces are identified. Targets
come from finer elements and tighter time steps, optionally another Poisson ratio, and have noise.

Usage: fit_furrow.py [--starts 10] [--first 0] [--runs 20] [--noise 0.2] [--poisson 0] [--until 12] [--elements 1 2 2]
[--fit-elements 1 1 1] [--mesh-error] [--wrong KEY=VALUE...] [--keep DIR]. Prints lines of Markdown. --elements: of a cell of the target;
--mesh-error adds to the errors of targets how much they differ between both meshes at the start; --wrong: keys of the model that differ
from the target's and are not fitted. DIR keeps runs, so that the same command continues.
"""
import argparse
import time
from pathlib import Path

import numpy as np
import plica

TRUTH = {"cortex.apical.tension_mN_per_m": 1.4, "cortex.apical.saturation_ratio": 0.16, "cortex.apical.profile.sigma_cells": 4.469,
         "cortex.shortening.tension_mN_per_m": 0.45, "cortex.floor.stiffness_mN_per_m": 0.7,
         "cortex.floor-elsewhere.stiffness_mN_per_m": 0.3, "cortex.floor-elsewhere.relaxation_s": 900,
         "cortex.surface.stiffness_mN_per_m": 0.02, "cortex.surface.relaxation_s": 360, "cortex.walls.stiffness_mN_per_m": 0.02,
         "cortex.walls.tension_mN_per_m": 0.015, "elasticity.young_modulus_Pa": 5}
BANDS = {"mid": [0, 10], "outer": [15, 35], "flank": [60, 110]}  # degrees from the ventral midline
WIDTHS = {"position_um": 0.5, "depth_um": 0.5, "area_ratio": 0.02, "area_um2": 1}
TREATED = {"control": {}, "light": {"region": "mesoderm", "at_min": 7, "only": ["cortex.apical"], "remaining": 0.3},
           "cut": {"region": "mesoderm", "at_min": 7, "only": ["cortex.floor"]}}


def scenario(treatment, **changes):
    made = plica.Scenario("furrow-slice")
    changed = {"embryo.mirror": ["y"], "time.tolerance_um": 0.02}
    for band, angles in BANDS.items():
        changed[f"region.{band}.angle_deg"] = angles
        for face in ("apical", "basal"):
            changed[f"monitor.{band}_{face}_area"] = {"quantity": "area", "over": "mean", "region": band, "face": face}
            changed[f"monitor.{band}_{face}"] = {"quantity": "position", "axis": "y" if band == "flank" else "z", "over": "mean",
                                                 "region": band, "face": face}
    if TREATED[treatment]:
        changed["ablation.treatment"] = TREATED[treatment]
    made.update({**changed, **changes})
    return made


def outcomes():
    names = ["furrow_depth_um", "vml_apical_area_ratio"]
    for band in BANDS:
        names += [f"{band}_apical_area.area_um2", f"{band}_basal_area.area_um2", f"{band}_apical.position_um"]
    return names + ["mid_basal.position_um"]


def values_of(treatment, times, changes):
    tape = plica.record(scenario(treatment, **changes), at_min=times, until_min=times[-1])
    return {(name, at): tape.value(name, at_min=at) for name in outcomes() for at in times}


def targets_of(values, noise, mesh_error, random):
    """Return targets from values with noise; the errors include that of the mesh."""
    found = {}
    for (name, at), value in values.items():
        width = next(width for ending, width in WIDTHS.items() if name.endswith(ending))
        pair = (value + noise * width * random.standard_normal(), np.hypot(width, mesh_error.get((name, at), 0)))
        found.setdefault(name, {})[at] = pair
    return found


parser = argparse.ArgumentParser()
parser.add_argument("--starts", type=int, default=10)
parser.add_argument("--first", type=int, default=0)
parser.add_argument("--runs", type=int, default=20)
parser.add_argument("--noise", type=float, default=0.2)
parser.add_argument("--poisson", type=float, default=0)
parser.add_argument("--until", type=float, default=12)
parser.add_argument("--elements", type=int, nargs=3, default=[1, 2, 2])
parser.add_argument("--fit-elements", type=int, nargs=3, default=[1, 1, 1])
parser.add_argument("--mesh-error", action="store_true")
parser.add_argument("--wrong", nargs="+", default=[], metavar="KEY=VALUE")
parser.add_argument("--keep", type=Path)
wanted = parser.parse_args()
times = [time for time in (5, 9, 12) if time <= wanted.until]
of_fit, changes = {"embryo.elements_per_cell": wanted.fit_elements}, {"embryo.elements_per_cell": wanted.elements}
if wanted.poisson:
    changes["elasticity.poisson_ratio"] = wanted.poisson
observed = {treatment: values_of(treatment, times, {**changes, "time.tolerance_um": 0.005}) for treatment in TREATED}
wrong = {key: float(value) for key, value in (one.split("=") for one in wanted.wrong)}
bounds = {key: (value / 2.2, value * 2.2) for key, value in TRUTH.items() if key not in wrong}

print("| start | end | runs | score | CPU (s) | largest error of a key | keys outside 95 % | open combinations |\n|" + "---|" * 8)
for start in range(wanted.first, wanted.first + wanted.starts):
    away = np.exp(np.random.default_rng(100 + start).choice([-1, 1], len(TRUTH)) * np.log(1.5))
    at = {key: value * factor for (key, value), factor in zip(TRUTH.items(), away)} | wrong
    begin, experiments, random = time.process_time(), [], np.random.default_rng(0)
    for treatment, values in observed.items():
        error = {}
        if wanted.mesh_error:
            fine, coarse = (values_of(treatment, times, {**at, **mesh}) for mesh in (changes, of_fit))
            error = {one: coarse[one] - fine[one] for one in coarse}
        experiments.append((scenario(treatment, **at, **of_fit), targets_of(values, wanted.noise, error, random)))
    found = plica.fit(experiments, of=bounds, runs=wanted.runs, folder=wanted.keep and wanted.keep / str(start))
    errors = {key: value / TRUTH[key] - 1 for key, value in found.values.items()}
    worst = max(errors, key=lambda key: abs(errors[key]))
    outside = [key for key, (low, high) in found.intervals(0.95).items() if not low <= TRUTH[key] <= high]
    print(f"| {start} | {found.end} | {found.runs} | {found.score:.3g} of {len(found.misses)} | {time.process_time() - begin:.0f} | "
          f"{100 * errors[worst]:+.1f} % ({worst}) | {', '.join(outside) or 'none'} | {sum(one.is_open for one in found.combinations)} |",
          flush=True)
print(found)
