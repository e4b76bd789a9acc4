#!/usr/bin/env python3
"""How often 90 % intervals of plica.infer hold the true factor: 36 cells, shapes at two times with 2 % noise, factors drawn from
a prior of its kind, whose spread it does not know.

usage: infer_coverage.py [--repetitions 20] [--knots 0 3] [--wrong KEY=VALUE...], with a Python that finds plica, as build/venv's with
PYTHONPATH=build/release/python. Prints one line per repetition, then means. With knots, factors change linearly between these
minutes, and each knot has its own. --wrong: keys of the model, as in TOML, in which it differs from the target's. Strengths
are compared then: factors times the profile.
"""
import argparse
import tomllib

import numpy as np
import plica
from plica.inference_problem import Field
from plica.knots import divided

LAW = "cortex.apical"
TIMES_MIN = (1, 3)
BLOCK = {"embryo": {"shape": "block", "length_um": 48, "width_um": 48, "cell_height_um": 10, "cells": [6, 6, 1]},
         "elasticity": {"young_modulus_Pa": 500, "corner_barrier_Pa": 20},
         "cortex": {"apical": {"region": "all", "tension_mN_per_m": 0.5, "saturation_ratio": 0.2}},
         "time": {"end_min": 3, "tolerance_um": 0.02}, "stop": {"at_equilibrium": False}}


def repetition(scenario, wrong, knots_min, seed):
    """Return the part of the cells whose interval holds their strength, the correlation of logarithms, the slope of found by true
    ones, the scale, the misfit relative to the noise, and the number of runs."""
    own, rng, factors = scenario.copy(), np.random.default_rng(seed), {}
    laws = divided(own, LAW, knots_min) if knots_min else [LAW]
    simulation = plica.Simulation(own)
    for law in laws:
        field = Field(simulation, law, None)
        coefficients = rng.normal(size=len(field.acting)) / np.sqrt(field.precision(0.25))
        factors[law] = np.exp(field.vectors @ (coefficients * ~field.is_common))
    tape = plica.record(own, at_min=TIMES_MIN, strengths=factors)
    moved_um = np.sqrt(((tape.positions() - simulation.positions) ** 2).sum(axis=1).mean())
    shapes = {time: tape.positions(time) + 0.02 * moved_um * rng.normal(size=simulation.positions.shape) for time in TIMES_MIN}
    model = scenario.copy()
    model.update(wrong)
    found = plica.infer(model, shapes, of=LAW, noise_um=0.02 * moved_um, knots_min=knots_min)
    ours, theirs = (np.concatenate([of._core.strength(law) for law in laws]) for of in (plica.Simulation(found.scenario), simulation))
    low, high = ours * np.hstack([found.interval(law) for law in laws])
    truth, inferred = (np.concatenate([of[law] for law in laws]) for of in (factors, found.factors))
    truth, inferred = truth * theirs, inferred * ours
    ratio = inferred.mean() / truth.mean()
    truth *= ratio
    logs = np.log(truth), np.log(inferred)
    return (np.mean((low < truth) & (truth < high)), np.corrcoef(*logs)[0, 1], np.polyfit(*logs, 1)[0], found.scale * ratio,
            found.misfit.max(), found.runs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repetitions", type=int, default=20)
    parser.add_argument("--knots", type=float, nargs="+", metavar="MIN")
    parser.add_argument("--wrong", nargs="+", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    wrong = {key: tomllib.loads(f"value = {value}")["value"] for key, value in (one.split("=", 1) for one in options.wrong)}
    scenario, rows = plica.Scenario(BLOCK), []
    line = "{}: coverage {:.3f}, correlation {:.3f}, slope {:.3f}, scale {:.3f}, misfit {:.2f}, {:.1f} runs"
    for seed in range(options.repetitions):
        rows.append(repetition(scenario, wrong, options.knots, seed))
        print(line.format(seed, *rows[-1]), flush=True)
    print(line.format("mean", *np.mean(rows, axis=0)))


if __name__ == "__main__":
    main()
