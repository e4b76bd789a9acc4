#!/usr/bin/env python3
"""Recover the apical tension of each cell of a whole living embryo from noisy shapes before closure, made with another mesh
and tolerance, by plica.infer. Shapes are displacements and ratios of areas since the start, which is known without noise.

Wanted of --part 1: correlation above 0.9 within 60 runs.

usage: infer_living.py [--part 0.5] [--elements 1 1 3] [--model-elements 1 1 2] [--noise 0.02] [--threads N] [--keep DIR], with
a Python that finds plica, as build/venv's with PYTHONPATH=build/release/python. --part 1 is drosophila-living with 6256 cells,
0.5 has cells of twice the width; --elements are those of a cell of the target. Prints JSON: cells, runs, correlation of found and
true factors, in all cells and in the ventral third, coverage of 90 % intervals, misfits (found; of the true factors, by mesh and
steps), and seconds of processor time of the target, the inference and one run. DIR keeps target and search, so an interrupted
inference continues; its seconds are those of the last session.
"""
import argparse
import json
import sys
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
    """Return centres and areas at the start and at all times, and seconds of processor time of the run."""
    simulation = plica.Simulation(scenario, threads=threads)
    start = time.process_time()
    tape = plica.record(scenario, at_min=TIMES_MIN, strengths={LAW: factors}, threads=threads)
    run_s = time.process_time() - start
    faces = ApicalFaces(simulation, tape._core.surface_nodes("apical"), len(factors))
    return [faces.of(tape.positions(time_min)) for time_min in [0.0, *TIMES_MIN]], run_s


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", type=float, default=0.5)
    parser.add_argument("--elements", type=int, nargs=3, default=[1, 1, 3])
    parser.add_argument("--model-elements", type=int, nargs=3, default=[1, 1, 2])
    parser.add_argument("--noise", type=float, default=0.02, help="of the root mean square displacement")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()

    model = embryo(given.part, given.model_elements, 0.05)
    simulation = plica.Simulation(model)
    factors, is_ventral = hidden_factors(simulation)
    kept, target_s = given.keep and given.keep / "target.npz", 0.0
    if kept and kept.exists():
        shapes = list(zip(*(np.load(kept)[name] for name in ("centres", "areas"))))
    else:
        shapes, target_s = apical_shapes(embryo(given.part, given.elements, 0.02), factors, given.threads)
        if kept:
            given.keep.mkdir(parents=True, exist_ok=True)
            np.savez(kept, centres=[centres for centres, _ in shapes], areas=[areas for _, areas in shapes])
    of_model, run_s = apical_shapes(model, factors, given.threads)
    (first_centres, first_areas), (own_centres, own_areas) = shapes[0], of_model[0]
    moved_um = np.sqrt(((shapes[-1][0] - first_centres) ** 2).sum(axis=1).mean())
    noise_um = given.noise * moved_um
    rng = np.random.default_rng(7)
    targets, of_truth = {}, []
    for time_min, (centres, areas), (same_centres, same_areas) in zip(TIMES_MIN, shapes[1:], of_model[1:]):
        centres, areas = own_centres + centres - first_centres, own_areas * areas / first_areas
        centres = centres + noise_um * rng.normal(size=centres.shape)
        areas = areas + noise_um * np.sqrt(2 * areas) * rng.normal(size=areas.shape)
        targets[time_min] = {"centres_um": centres, "areas_um2": areas}
        apart = np.column_stack([same_centres - centres, (same_areas - areas) / np.sqrt(2 * areas)]) / noise_um
        of_truth.append(np.sqrt((apart**2).mean()))
    print(f"misfit of the true factors {np.round(of_truth, 2)}; run {run_s:.0f} s", file=sys.stderr, flush=True)

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
        "misfit": found.misfit.tolist(), "misfit_of_truth": of_truth, "scale": found.scale / factors.mean(), "spread": found.spread[LAW],
        "target_s": target_s, "run_s": run_s, "infer_s": infer_s, "infer_over_run": infer_s / run_s}, indent=1))


if __name__ == "__main__":
    main()
