#!/usr/bin/env python3
"""How often 90 % intervals of plica.infer hold the true factor: 36 cells, shapes at two times with 2 % noise, factors drawn from
a prior of its kind, whose spread it does not know.

usage: infer_coverage.py [--repetitions 20] [--knots 0 3], with a Python that finds plica, as build/venv's with
PYTHONPATH=build/release/python. Prints one line per repetition, then means. With knots, factors change linearly between these
minutes, and each knot has its own.
"""
import argparse

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


def repetition(scenario, knots_min, seed):
    """Return the part of the cells whose interval holds their factor, the correlation of logarithms, and the number of runs."""
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
    found = plica.infer(scenario, shapes, of=LAW, noise_um=0.02 * moved_um, knots_min=knots_min)
    low, high = np.hstack([found.interval(law) for law in laws])
    truth, inferred = (np.concatenate([of[law] for law in laws]) for of in (factors, found.factors))
    truth = truth / truth.mean()
    return np.mean((low < truth) & (truth < high)), np.corrcoef(np.log(inferred), np.log(truth))[0, 1], found.runs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repetitions", type=int, default=20)
    parser.add_argument("--knots", type=float, nargs="+", metavar="MIN")
    options = parser.parse_args()
    scenario, rows = plica.Scenario(BLOCK), []
    for seed in range(options.repetitions):
        rows.append(repetition(scenario, options.knots, seed))
        print("{}: coverage {:.3f}, correlation {:.3f}, {} runs".format(seed, *rows[-1]), flush=True)
    print("mean: coverage {:.3f}, correlation {:.3f}, {:.1f} runs".format(*np.mean(rows, axis=0)))


if __name__ == "__main__":
    main()
