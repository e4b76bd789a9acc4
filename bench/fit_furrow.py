#!/usr/bin/python3
"""How many runs `plica.fit` takes: twelve keys of `furrow-slice` from twelve outcomes in three scenarios (control; myosin of the
mesoderm inhibited; floor of the mesoderm cut), before closure. Drag is known, since only ratios of forces are identified. Targets
come from tighter time steps, optionally another Poisson ratio, and have noise.

Usage: fit_furrow.py [--starts 10] [--first 0] [--runs 20] [--noise 0.2] [--poisson 0] [--until 12]. Prints lines of Markdown.
"""
import argparse
import time

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


def targets_of(treatment, times, noise, random, changes):
    tape = plica.record(scenario(treatment, **{"time.tolerance_um": 0.005}, **changes), at_min=times, until_min=times[-1])
    found = {}
    for name in outcomes():
        width = next(width for ending, width in WIDTHS.items() if name.endswith(ending))
        found[name] = {at: (tape.value(name, at_min=at) + noise * width * random.standard_normal(), width) for at in times}
    return found


parser = argparse.ArgumentParser()
parser.add_argument("--starts", type=int, default=10)
parser.add_argument("--first", type=int, default=0)
parser.add_argument("--runs", type=int, default=20)
parser.add_argument("--noise", type=float, default=0.2)
parser.add_argument("--poisson", type=float, default=0)
parser.add_argument("--until", type=float, default=12)
wanted = parser.parse_args()
times = [time for time in (5, 9, 12) if time <= wanted.until]
changes = {"elasticity.poisson_ratio": wanted.poisson} if wanted.poisson else {}
random = np.random.default_rng(0)
targets = {treatment: targets_of(treatment, times, wanted.noise, random, changes) for treatment in TREATED}
bounds = {key: (value / 2.2, value * 2.2) for key, value in TRUTH.items()}

print("| start | end | runs | score | CPU (s) | largest error of a key | keys outside 95 % | open combinations |\n|" + "---|" * 8)
for start in range(wanted.first, wanted.first + wanted.starts):
    away = np.exp(np.random.default_rng(100 + start).choice([-1, 1], len(TRUTH)) * np.log(1.5))
    at = {key: value * factor for (key, value), factor in zip(TRUTH.items(), away)}
    begin = time.process_time()
    found = plica.fit([(scenario(treatment, **at), targets[treatment]) for treatment in TREATED], of=bounds, runs=wanted.runs)
    errors = {key: value / TRUTH[key] - 1 for key, value in found.values.items()}
    worst = max(errors, key=lambda key: abs(errors[key]))
    outside = [key for key, (low, high) in found.intervals(0.95).items() if not low <= TRUTH[key] <= high]
    print(f"| {start} | {found.end} | {found.runs} | {found.score:.3g} of {len(found.misses)} | {time.process_time() - begin:.0f} | "
          f"{100 * errors[worst]:+.1f} % ({worst}) | {', '.join(outside) or 'none'} | {sum(one.is_open for one in found.combinations)} |",
          flush=True)
print(found)
