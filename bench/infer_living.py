#!/usr/bin/env python3
"""Recover the apical tension of each cell of a whole living embryo from noisy shapes before closure, made with another mesh
and tolerance, by plica.infer.

usage: infer_living.py [--part 0.5] [--elements 2 2 2] [--noise 0.02] [--threads N] [--keep DIR], with a Python that finds
plica, as build/venv's with PYTHONPATH=build/release/python. --part 1 is drosophila-living with 6256 cells, 0.5 has cells of
twice the width. Prints JSON: cells, runs, correlation of found and true factors, in all cells and in the ventral third,
coverage of 90 % intervals, misfits, and seconds of processor time of the target, the inference and one run. DIR keeps target and search.
"""
import argparse
import json
import time
from pathlib import Path

import numpy as np
import plica
from plica.shape_targets import ApicalFaces

TIMES_MIN = [5.0, 9.0, 12.0]
LAW = "cortex.apical"


def embryo(part, elements, tolerance_um):
    """Return drosophila-living until 12 min with fewer, larger cells; all of them contract, the mesoderm most."""
    scenario = plica.Scenario("drosophila-living")
    changes = {"embryo.cells": [max(2, round(part * count)) for count in scenario["embryo.cells"]],
               "embryo.elements_per_cell": elements, "time.tolerance_um": tolerance_um, "time.end_min": TIMES_MIN[-1],
               "region.mesoderm.cells_across": round(part * scenario["region.mesoderm.cells_across"]),
               f"{LAW}.region": "all", f"{LAW}.profile.edge": 0.2,
               f"{LAW}.profile.sigma_cells": part * scenario[f"{LAW}.profile.sigma_cells"]}
    for name in ("shortening", "floor", "floor-elsewhere"):
        for key in ("full_cells", "fade_cells"):
            changes[f"cortex.{name}.profile.{key}"] = part * scenario[f"cortex.{name}.profile.{key}"]
    scenario.update(changes)
    return scenario


def hidden_factors(simulation):
    """Return factors with patches of several cells, and differences from cell to cell."""
    x, y, z = (simulation.cell_data[f"{axis}_um"] for axis in "xyz")
    angle = np.arctan2(y, -z)
    logs = 0.3 * np.sin(x / 40) * np.cos(3 * angle) + 0.15 * np.random.default_rng(3).normal(size=len(x))
    return np.exp(logs), np.abs(angle) < np.pi / 3


def apical_shapes(scenario, factors, threads):
    """Return times, centres and areas of the run that is to be explained."""
    simulation = plica.Simulation(scenario, threads=threads)
    tape = plica.record(scenario, at_min=TIMES_MIN, strengths={LAW: factors}, threads=threads)
    faces = ApicalFaces(simulation, tape._core.surface_nodes("apical"), len(factors))
    return [faces.of(tape.positions(time_min)) for time_min in [0.0, *TIMES_MIN]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", type=float, default=0.5)
    parser.add_argument("--elements", type=int, nargs=3, default=[2, 2, 2])
    parser.add_argument("--noise", type=float, default=0.02, help="of the root mean square displacement")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()

    model = embryo(given.part, [1, 1, 1], 0.05)
    simulation = plica.Simulation(model)
    factors, is_ventral = hidden_factors(simulation)
    start = time.process_time()
    kept = given.keep and given.keep / "target.npz"
    if kept and kept.exists():
        shapes = list(zip(*(np.load(kept)[name] for name in ("centres", "areas"))))
    else:
        shapes = apical_shapes(embryo(given.part, given.elements, 0.02), factors, given.threads)
        if kept:
            given.keep.mkdir(parents=True, exist_ok=True)
            np.savez(kept, centres=[centres for centres, _ in shapes], areas=[areas for _, areas in shapes])
    target_s = time.process_time() - start
    moved_um = np.sqrt(((shapes[-1][0] - shapes[0][0]) ** 2).sum(axis=1).mean())
    noise_um = given.noise * moved_um
    rng = np.random.default_rng(7)
    targets = {0.0: {"centres_um": shapes[0][0], "areas_um2": shapes[0][1]}}
    for time_min, (centres, areas) in zip(TIMES_MIN, shapes[1:]):
        targets[time_min] = {"centres_um": centres + noise_um * rng.normal(size=centres.shape),
                             "areas_um2": areas + noise_um * np.sqrt(2 * areas) * rng.normal(size=areas.shape)}

    start = time.process_time()
    plica.record(model, strengths={LAW: factors}, threads=given.threads)
    run_s = time.process_time() - start
    start = time.process_time()
    found = plica.infer(model, targets, of=LAW, noise_um=noise_um, threads=given.threads, progress=True,
                        file=given.keep and given.keep / "search.npz")
    infer_s = time.process_time() - start
    truth, log = factors / factors.mean(), np.log(found.factors[LAW])
    low, high = found.interval(LAW)
    print(json.dumps({
        "cells": len(factors), "moved_um": moved_um, "noise_um": noise_um, "runs": found.runs, "converged": found.converged,
        "correlation": np.corrcoef(log, np.log(truth))[0, 1],
        "correlation_ventral": np.corrcoef(log[is_ventral], np.log(truth)[is_ventral])[0, 1],
        "coverage": float(np.mean((low < truth) & (truth < high))), "median_sd": float(np.median(found.sd[LAW])),
        "misfit": found.misfit.tolist(), "scale": found.scale / factors.mean(), "spread": found.spread[LAW],
        "target_s": target_s, "run_s": run_s, "infer_s": infer_s}, indent=1))


if __name__ == "__main__":
    main()
