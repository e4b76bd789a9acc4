"""Force laws from an energy of a few nodes: derivatives, forces in a run, threads, copies and files, refusals."""
import os
import pickle
import shutil
import subprocess

import numpy as np
import pytest

import plica
from plica import FileError, LocalEnergy
from plica.fit_problem import Problem, experiments_of

pytest.importorskip("sympy")

SHEET = {"embryo": {"shape": "block", "length_um": 40, "width_um": 40, "cell_height_um": 20, "cells": [4, 4, 1]},
         "time": {"end_s": 60}}
SPRING = "k / 2 * (length(0, 1) - L) ** 2"


@pytest.fixture(scope="module")
def columns():
    """Nodes at the lower and upper end of an edge of each element."""
    return plica.Simulation(SHEET).hexahedra[:, [0, 4]]


def springs(columns, **numbers):
    return {"springs": LocalEnergy(SPRING, columns, **{"k": 2, "L": 15, **numbers})}


def run(energies, threads=1, seconds=60):
    sim = plica.Simulation(SHEET, threads=threads, energies=energies)
    sim.run(until_min=seconds / 60)
    return sim


@pytest.mark.parametrize("formula, nodes", [
    (SPRING, 2), ("k * (area(0, 1, 2) + exp(-length(0, 2) / L))", 3), ("k * (volume(0, 1, 2, 3) - L) ** 2", 4),
    ("k * x0 * sin(y1 / L) + log(L + z0 ** 2) - atan2(x1, 3)", 2)])
def test_derivatives_agree_with_differences(formula, nodes):
    random = np.random.default_rng(3)
    x = random.normal(size=(5, 3 * nodes))
    energy = LocalEnergy(formula, np.arange(5 * nodes).reshape(5, nodes), k=1.5, L=random.uniform(1, 2, 5))
    h = 1e-5
    for order in (1, 2):
        slopes = energy(x, order)
        for i in range(3 * nodes):
            step = h * np.eye(3 * nodes)[i]
            change = (energy(x + step, order - 1) - energy(x - step, order - 1)) / (2 * h)
            assert np.allclose(slopes[..., i], change, rtol=1e-7, atol=1e-8)


def test_springs_pull_with_their_tension_and_cells_shorten(columns):
    sim = plica.Simulation(SHEET, energies=springs(columns, L=np.full(len(columns), 15.0)))
    assert "energy.springs" in sim.laws
    forces = np.zeros_like(sim.positions)
    np.add.at(forces, columns[:, 0], [0, 0, 2 * 5])  # k (20 - L), towards each other
    np.add.at(forces, columns[:, 1], [0, 0, -2 * 5])
    assert np.allclose(sim.forces("energy.springs"), forces, atol=1e-12)
    sim.run()
    lengths = np.linalg.norm(np.subtract(*sim.positions[columns.T]), axis=1)
    assert 15 < lengths.max() < 19
    stored = (lengths - 15) ** 2 - 5**2
    assert sim.energies["energy.springs"]["stored"] == pytest.approx(stored.sum(), rel=1e-9)
    assert sim.measures["max_volume_error"] < 1e-9


def test_threads_copies_and_files_go_on_to_the_same_bits(columns, tmp_path):
    given = springs(columns)
    whole = run(given, threads=2)
    half = run(given, seconds=30)
    half.save(tmp_path / "half.h5")
    saved = plica.load(tmp_path / "half.h5", energies=given)
    pickled = pickle.loads(pickle.dumps(half))
    for sim in (half.copy(), saved, pickled):
        sim.run()
        assert np.array_equal(sim.positions, whole.positions)
    with pytest.raises(FileError, match="does not fit"):
        plica.load(tmp_path / "half.h5")


def test_a_recorded_run_is_not_continued_without_its_law(columns, tmp_path):
    sim = plica.Simulation(SHEET, energies=springs(columns))
    sim.run(until_min=0.1, out=tmp_path / "out")
    shutil.copy(tmp_path / "out/scenario.toml", tmp_path)
    told = subprocess.run([os.environ["PLICA"], "run", tmp_path / "scenario.toml", "--resume", "--out", tmp_path / "out"], capture_output=True, text=True)
    assert told.returncode != 0 and "does not fit" in told.stderr
    again = plica.Simulation(SHEET, energies=springs(columns))
    again.run(out=tmp_path / "out", resume=True)
    sim.run()
    assert again.finished and np.array_equal(again.positions, sim.positions)


def test_functions_in_jax(columns):
    jnp = pytest.importorskip("jax.numpy")
    by_jax = LocalEnergy(lambda x, k, L: k / 2 * (jnp.linalg.norm(x[1] - x[0]) - L) ** 2, columns, k=2, L=15)
    apart = np.abs(run({"springs": by_jax}).positions - run(springs(columns)).positions).max()
    assert apart < 1e-8


def height(positions):
    """Mean height of all nodes, and its gradient."""
    gradient = np.zeros_like(positions)
    gradient[:, 2] = np.where(positions[:, 2] > 10, 1, -1) / len(positions)
    return float((gradient * positions).sum()), gradient


def test_gradients_by_numbers_agree_with_differences(columns):
    tape = plica.record(SHEET, until_min=0.2, energies=springs(columns))
    assert np.array_equal(tape.positions(), run(springs(columns), seconds=12).positions)
    keys = ["energy.springs.k", "energy.springs.L", "elasticity.young_modulus_Pa"]
    for check in plica.check_gradient(tape, height, of=keys, change=1e-4):
        assert abs(check.gradient) > 1e-5 and check.error < 1e-7, check
    more, less = (plica.record(SHEET, until_min=0.2, energies=springs(columns, k=k)).value(height) for k in (2.02, 1.98))
    assert tape.gradient(height, of="energy.springs.k") == pytest.approx((more - less) / 0.04, rel=0.02)
    assert tape.jacobian(height, of=keys)[0, 0] == pytest.approx(tape.gradient(height, of=keys), rel=1e-7)
    # A number that differs between groups: by a factor on all.
    lengths = plica.record(SHEET, until_min=0.2, energies=springs(columns, L=np.linspace(14, 16, len(columns))))
    [check] = plica.check_gradient(lengths, height, of="energy.springs.L")
    assert check.error < 1e-7 and check.gradient == pytest.approx(15 * tape.gradient(height, of="energy.springs.L"), rel=0.1)


def test_fits_find_numbers(columns, tmp_path):
    """One number, and a factor on numbers that differ; with a key of the scenario; and through another process."""
    lengths = np.linspace(14, 16, len(columns))
    scenario = plica.Scenario({**SHEET, "stop": {"at_equilibrium": False}})
    energies = springs(columns, k=3, L=1.1 * lengths)
    truth = plica.record(scenario, until_min=1, at_min=[0.1, 0.3], energies=energies)
    targets = {height: {minute: (truth.value(height, at_min=minute), 0.001) for minute in (0.1, 0.3, 1)}}
    of = {"energy.springs.k": (1, 6), "energy.springs.L": (0.8, 1.3), "elasticity.young_modulus_Pa": (500, 2000)}
    scenario["elasticity.young_modulus_Pa"] = 1300
    found = plica.fit(scenario, targets, of=of, energies=springs(columns, L=lengths), priors={"elasticity.young_modulus_Pa": (1000, 20)},
                      folder=tmp_path)
    assert found.values["energy.springs.L"] == pytest.approx(1.1, rel=0.01)
    assert found.values["energy.springs.k"] == pytest.approx(3, rel=0.03)
    assert found.energies["springs"].numbers["L"] == pytest.approx(1.1 * lengths, rel=0.01)
    again = plica.fit(scenario, targets, of=of, energies=springs(columns, L=lengths), priors={"elasticity.young_modulus_Pa": (1000, 20)},
                      folder=tmp_path)
    assert again.values == found.values
    problem = Problem(experiments_of(scenario, targets), of, None, 1, springs(columns, L=lengths))
    place, aside = problem.start + [0.2, 0.2, 0], np.array([0, 1e-3, 0])
    difference = (problem.residuals(place + aside, None) - problem.residuals(place - aside, None)) / 2e-3
    assert problem.slopes(place, None)[:, 1] == pytest.approx(difference, rel=0.03)
    with pytest.raises(FileError, match="holds another fit"):
        plica.fit(scenario, targets, of=of, energies=springs(columns, L=2 * lengths), priors={"elasticity.young_modulus_Pa": (1000, 20)},
                  folder=tmp_path)


@pytest.mark.parametrize("key, numbers, message", [
    ("energy.springs.q", {}, "energy.springs.q: not a number of an energy; give one of energy.springs.k, energy.springs.L"),
    ("energy.springs.k", {"k": 0}, "of: energy.springs.k is 0, where its change has no scale"),
    ("energy.springs.k", {"k": 9}, "of: energy.springs.k is 9, outside 1 to 6"),
])
def test_fits_tell_wrong_numbers(columns, key, numbers, message):
    with pytest.raises(ValueError) as raised:
        plica.fit(SHEET, {height: (10, 1)}, of={key: (1, 6)}, energies=springs(columns, **numbers))
    assert message in str(raised.value)


@pytest.mark.parametrize("key", ["energy.springs.q", "energy.other.k", "energy.springs"])
def test_only_numbers_of_energies_have_gradients(columns, key):
    tape = plica.record(SHEET, until_min=0.05, energies=springs(columns))
    with pytest.raises(ValueError, match=f"{key}: not a number of an energy; give one of energy.springs.k, energy.springs.L"):
        tape.gradient(height, of=key)
    with pytest.raises(ValueError, match=f"{key}: not a number of an energy; give its law as energies to record"):
        plica.record(SHEET, until_min=0.05).gradient(height, of=key)


def test_energies_have_names(columns):
    with pytest.raises(TypeError, match="energies: a value of type list; give a mapping of names to LocalEnergy"):
        plica.Simulation(SHEET, energies=[LocalEnergy("length(0, 1)", columns)])


@pytest.mark.parametrize("make, text", [
    (lambda c: LocalEnergy("k * length(0, 1)", c), "'k' has no value"),
    (lambda c: LocalEnergy("2 * length(0, 1", c), "cannot be read"),
    (lambda c: LocalEnergy("length(0, 2)", c), "cannot be read"),
    (lambda c: LocalEnergy("x0; y0", c), "give a formula"),
    (lambda c: LocalEnergy("__import__(0)", c), "has no value"),
    (lambda c: LocalEnergy(3, c), "give a formula, or a function"),
    (lambda c: LocalEnergy("x0", c.ravel()), "groups"),
    (lambda c: LocalEnergy("x0", c + 0.5), "groups"),
    (lambda c: LocalEnergy("k * x0", c, k=[1, 2]), "one for each of the 16 groups"),
    (lambda c: LocalEnergy("k * x0", c, k=np.nan), "all finite"),
    (lambda c: run({"far": LocalEnergy("x0", c + 1000)}), "node 10.*give nodes from 0 to"),
    (lambda c: run({"spring": SPRING}), "give a LocalEnergy"),
    (lambda c: run({"wrong": LocalEnergy("sqrt(x0 - 1000)", c)}), r"gradient of group 0 \(nodes \[.*is not finite"),
])
def test_what_cannot_be_is_refused_with_a_reason(columns, make, text):
    with pytest.raises(ValueError, match=text):
        make(columns)


def test_nodes_have_to_stay(columns):
    for more, text in [({"embryo": {**SHEET["embryo"], "mirror": ["y"]}}, "remove embryo.mirror"),
                       ({"division": {"one": {"at_s": 10, "region": "all"}}}, "remove division")]:
        with pytest.raises(ValueError, match=text):
            plica.Simulation({**SHEET, **more}, energies=springs(columns))


def test_an_error_in_a_function_is_the_users_and_the_state_stays(columns):
    class Faulty(LocalEnergy):
        calls = 0

        def __call__(self, positions, order):
            Faulty.calls += 1
            if Faulty.calls > 20:
                raise KeyError("mine")
            return super().__call__(positions, order)

    sim = plica.Simulation(SHEET, energies={"faulty": Faulty(SPRING, columns, k=2, L=15)})
    with pytest.raises(KeyError, match="mine"):
        sim.run()
    time_s, positions = sim.time_s, sim.positions
    Faulty.calls = -10**9
    sim.run()
    assert time_s < sim.time_s and sim.finished and not np.array_equal(positions, sim.positions)
