#!/usr/bin/env python3
"""Tensions of a flat sheet of 20 to 60 cells from one shape, by plica and by VertAX (docs/developers/inverse-problems.md).

usage: flat_tensions.py plica [--cells 20]  with a Python that finds plica, as build/venv's with PYTHONPATH=build/release/python;
       flat_tensions.py vertax [--cells 20] [--epochs 350]  with a Python that has VertAX.

Both have cells of regular tissue with cell walls under tension, tensions hidden with a relative standard deviation of 0.1, and the
target's vertices without noise. plica: a free sheet of solid cells, one factor per cell on lateral tension. VertAX: its published case,
periodic, two-dimensional, one tension per edge, areas known, equilibrium propagation. The meshes differ. Prints JSON; times are of
the processor. A wall of plica has the mean of its two cells, so r is given for walls, or edges, in both.
"""
import argparse
import json
import math
import time

import numpy as np

SPREAD, ELASTIC = 0.1, 20


def with_plica(cells, _epochs):
    import plica

    law, side_um = "cortex.lateral", 6 * math.sqrt(cells)
    scenario = plica.Scenario({
        "embryo": {"shape": "sheet", "length_um": side_um, "width_um": side_um, "cell_count": cells, "cell_height_um": 10},
        "elasticity": {"young_modulus_Pa": 100, "corner_barrier_Pa": 30},
        "cortex": {"lateral": {"region": "all", "faces": "lateral", "tension_mN_per_m": 0.5}},
        "time": {"end_min": 2, "tolerance_um": 0.02}, "stop": {"at_equilibrium": False}})
    simulation = plica.Simulation(scenario)
    count = len(simulation.pressures)
    truth = np.exp(SPREAD * np.random.default_rng(1).normal(size=count))
    begin = time.process_time()
    target = plica.record(scenario, strengths={law: truth}).positions()
    run_s = time.process_time() - begin
    moved_um = math.sqrt(((target - simulation.positions) ** 2).sum(axis=1).mean())
    begin = time.process_time()
    found = plica.infer(scenario, {2: target}, of=law, noise_um=0.001 * moved_um)
    pairs = simulation.neighbours
    tensions = [of[pairs].mean(axis=1) for of in (truth, found.factors[law])]
    return {"cells": count, "unknowns": count, "runs": found.runs, "run_s": run_s, "infer_s": time.process_time() - begin,
            "r": np.corrcoef(*tensions)[0, 1], "misfit": float(found.misfit[0]), "moved_um": moved_um}


def with_vertax(cells, epochs):
    import jax.numpy as jnp
    import optax
    from jax import vmap
    from vertax import PbcBilevelOptimizer, PbcMesh
    from vertax.cost import cost_v2v
    from vertax.geo import get_area, get_length

    side, most_edges, random = math.sqrt(cells), 20, np.random.default_rng(1)
    mesh = PbcMesh.from_random_seeds(nb_seeds=cells, width=side, height=side, random_key=0)

    def areas_of(vertices, edges, faces):
        return vmap(lambda face: get_area(face, vertices, edges, faces, side, side, most_edges))(jnp.arange(len(faces)))

    def energy_about(areas):
        def energy(vertices, edges, faces, _of_vertices, tensions, _of_faces):
            lengths = vmap(lambda edge: get_length(edge, vertices, edges, faces, side, side))(jnp.arange(len(edges)))
            return jnp.sum(tensions * lengths) + ELASTIC / 2 * jnp.sum((areas_of(vertices, edges, faces) - areas) ** 2)
        return energy

    def hidden():
        return jnp.repeat(jnp.asarray(1.2 + SPREAD * random.normal(size=mesh.nb_edges)), 2)

    optimizer = PbcBilevelOptimizer()
    optimizer.outer_solver = optax.adam(learning_rate=1e-4, nesterov=True)
    optimizer.loss_function_inner, optimizer.loss_function_outer = energy_about(jnp.ones(mesh.nb_faces)), cost_v2v
    mesh.vertices_params, mesh.faces_params, mesh.edges_params = jnp.zeros(mesh.nb_vertices), jnp.ones(mesh.nb_faces), hidden()
    optimizer.inner_optimization(mesh=mesh)
    target = PbcMesh.copy_mesh(mesh)
    truth = hidden()
    target.edges_params = truth
    optimizer.inner_optimization(mesh=target)
    optimizer.vertices_target, optimizer.edges_target, optimizer.faces_target = (
        one.copy() for one in (target.vertices, target.edges, target.faces))
    optimizer.loss_function_inner = energy_about(areas_of(target.vertices, target.edges, target.faces))

    def cost():
        return float(cost_v2v(mesh.vertices, mesh.edges, mesh.faces, side, side, target.vertices, target.edges, target.faces))

    def agreement():
        return float(np.corrcoef(np.asarray(mesh.edges_params)[::2], np.asarray(truth)[::2])[0, 1])

    first_cost, first_r, times = cost(), agreement(), []
    for _ in range(epochs):
        begin = time.process_time()
        optimizer.bilevel_optimization(mesh)
        times.append(time.process_time() - begin)
    return {"cells": cells, "unknowns": int(mesh.nb_edges), "epochs": epochs, "first_epoch_s": times[0], "epoch_s": float(np.median(times)),
            "cost_first": first_cost, "cost": cost(), "r_first": first_r, "r": agreement()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", choices=("plica", "vertax"))
    parser.add_argument("--cells", type=int, default=20)
    parser.add_argument("--epochs", type=int, default=350)
    given = parser.parse_args()
    print(json.dumps((with_plica if given.program == "plica" else with_vertax)(given.cells, given.epochs), indent=1))


if __name__ == "__main__":
    main()
