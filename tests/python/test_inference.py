"""Strengths of cells from shapes: recovered from another mesh with noise, with unseen parts, and refusals."""
import numpy as np
import plica
import pytest
from plica.knots import divided
from plica.shape_targets import ApicalFaces, CellTarget, target_of

LAW = "cortex.apical"
BLOCK = plica.Scenario({
    "embryo": {"shape": "block", "length_um": 32, "width_um": 32, "cell_height_um": 10, "cells": [4, 4, 1]},
    "cortex": {"apical": {"region": "all", "tension_mN_per_m": 1, "saturation_ratio": 0.2},
               "base": {"region": "all", "faces": "basal", "tension_mN_per_m": 1}},
    "time": {"end_min": 1}, "stop": {"at_equilibrium": False}})


def pill(elements, tolerance_um):
    return plica.Scenario({
        "embryo": {"shape": "pill", "length_um": 120, "diameter_um": 60, "cell_height_um": 12, "cells": [8, 3, 3],
                   "elements_per_cell": elements},
        "elasticity": {"young_modulus_Pa": 20, "poisson_ratio": 0, "corner_barrier_Pa": 10},
        "cortex": {"apical": {"region": "all", "tension_mN_per_m": 0.5, "saturation_ratio": 0.2},
                   "surface": {"region": "all", "faces": "apical", "stiffness_mN_per_m": 0.3},
                   "base": {"region": "all", "faces": "basal", "stiffness_mN_per_m": 0.3}},
        "enclosed": {"yolk": {"volume": "compliant", "bulk_modulus_Pa": 5000}}, "vitelline": {"gap_um": 0.5},
        "time": {"end_min": 2, "tolerance_um": tolerance_um}, "stop": {"at_equilibrium": False}})


def faces_of(scenario):
    simulation = plica.Simulation(scenario)
    tape = plica.record(scenario, until_min=1e-6)
    return simulation, ApicalFaces(simulation, tape._core.surface_nodes("apical"), len(simulation.pressures))


@pytest.fixture(scope="module")
def block_shape():
    truth = np.exp(0.3 * np.random.default_rng(1).normal(size=16))
    return truth, plica.record(BLOCK, strengths={LAW: truth}).positions()


def test_tensions_of_a_finer_mesh_are_recovered():
    model, finer = pill([1, 1, 1], 0.05), pill([2, 2, 2], 0.01)
    simulation, (fine, faces) = plica.Simulation(model), faces_of(finer)
    x, y, z = (simulation.cell_data[f"{axis}_um"] for axis in "xyz")
    rng = np.random.default_rng(2)
    truth = np.exp(0.3 * np.sin(2 * np.pi * x / 80) * np.cos(np.arctan2(y, -z)) + 0.15 * rng.normal(size=len(x)))
    tape = plica.record(finer, at_min=[1, 2], strengths={LAW: truth})
    seen = {time: faces.of(tape.positions(time)) for time in (0, 1, 2)}
    noise_um = 0.02 * np.sqrt(((seen[2][0] - seen[0][0]) ** 2).sum(axis=1).mean())
    shapes = {0: {"centres_um": seen[0][0], "areas_um2": seen[0][1]}}
    for time in (1, 2):
        centres, areas = seen[time]
        shapes[time] = {"centres_um": centres + noise_um * rng.normal(size=centres.shape),
                        "areas_um2": areas + noise_um * np.sqrt(2 * areas) * rng.normal(size=areas.shape)}
    found = plica.infer(model, shapes, of=LAW, noise_um=noise_um)
    assert np.corrcoef(np.log(found.factors[LAW]), np.log(truth))[0, 1] > 0.95
    assert found.runs < 30 and found.excess > 2  # the coarse model does not fit to the noise


def test_nodes_that_are_not_seen(block_shape, tmp_path, capsys):
    truth, shape = block_shape
    shape = shape.copy()
    shape[shape[:, 0] > 4] = np.nan  # both nodes of the last cells
    settings = dict(of="apical", noise_um=0.02, file=tmp_path / "search.npz", progress=True)
    begun = plica.infer(BLOCK, {1: shape}, most_runs=6, **settings)
    assert not begun.converged and "not converged" in repr(begun)
    found = plica.infer(BLOCK, {1: shape}, **settings)
    assert found.converged and "misfit / noise" in capsys.readouterr().err
    x = plica.Simulation(BLOCK).cell_data["x_um"]
    ratio = (found.factors[LAW] / truth)[x < 0]
    assert np.abs(ratio / ratio.mean() - 1).max() < 0.1
    assert found.unseen[LAW][x > 8].mean() > 3 * found.unseen[LAW][x < 0].mean()
    assert found.sd[LAW][x > 8].mean() > 1.5 * found.sd[LAW][x < 0].mean()
    low, high = found.interval(LAW)
    assert (low < found.factors[LAW]).all() and (found.factors[LAW] < high).all()
    assert np.array_equal(found.strengths[LAW], found.scale * found.factors[LAW])
    with pytest.raises(ValueError, match="is of a search with another scenario, other shapes or settings"):
        plica.infer(BLOCK, {1: shape + 0.01}, **settings)
    settings["file"].write_text("no search")
    with pytest.raises(plica.FileError, match="is damaged, or not of a search"):
        plica.infer(BLOCK, {1: shape}, **settings)


def test_two_laws_at_once():
    rng = np.random.default_rng(4)
    truth = {law: np.exp(0.2 * rng.normal(size=16)) for law in (LAW, "cortex.base")}
    shape = plica.record(BLOCK, strengths=truth).positions()
    found = plica.infer(BLOCK, {1: shape}, of=list(truth), noise_um=0.01, surface="all")
    mean = np.mean(list(truth.values()))
    for law in truth:
        assert np.abs(found.factors[law] - truth[law] / mean).max() < 0.05
    assert found.scale == pytest.approx(mean, rel=0.02)


def test_knots_in_time():
    scenario = BLOCK.copy()
    scenario.update({"cortex.apical.program": {"time_min": [0, 1], "activity": [0.5, 1]}, "time.tolerance_um": 0.02,
                     "ablation": {"cut": {"region": "all", "at_min": 0.9, "only": [LAW]}}})
    divided_one = scenario.copy()
    first, last = divided(divided_one, LAW, [0, 1])
    assert (first, last) == ("cortex.apical-at-0-min", "cortex.apical-at-1-min")
    assert divided_one["ablation.cut.only"] == [first, last]
    whole, parts = plica.record(scenario), plica.record(divided_one)
    assert parts.positions() == pytest.approx(whole.positions(), abs=0.01)
    rng = np.random.default_rng(5)
    truth = {law: np.exp(0.3 * rng.normal(size=16)) for law in (first, last)}
    times = [0.2, 0.5, 0.8]
    tape = plica.record(divided_one, at_min=times, strengths=truth)
    found = plica.infer(scenario, {time: tape.positions(time) for time in times}, of=LAW, noise_um=0.005, knots_min=[0, 1])
    mean = np.mean(list(truth.values()))
    for law in truth:
        assert np.corrcoef(np.log(found.factors[law]), np.log(truth[law]))[0, 1] > 0.9
    again = plica.record(found.scenario, at_min=times, strengths=found.strengths)
    assert again.positions(0.8) == pytest.approx(tape.positions(0.8), abs=0.05)
    assert found.scale == pytest.approx(mean, rel=0.1)


def test_laws_that_cannot_be_divided():
    for change in ({"cortex.apical.stiffness_mN_per_m": 1}, {"cortex.apical.trigger": {"measure": "apical_area_ratio", "below": 0.9}}):
        scenario = BLOCK.copy()
        scenario.update(change)
        with pytest.raises(ValueError, match="give a law whose tension alone has a time course"):
            divided(scenario, LAW, [0, 1])


def test_a_contraction_is_divided():
    scenario = BLOCK.copy()
    scenario["contraction"] = {"edges": {"region": "all", "stiffness_nN_per_um": 0.1, "preload_nN": 2, "tension_mN_per_m": 0.2}}
    parts = scenario.copy()
    assert len(divided(parts, "contraction.edges", [0, 0.5, 1])) == 3
    assert plica.record(parts).positions() == pytest.approx(plica.record(scenario).positions(), abs=0.01)
    scenario["contraction.edges.damping_nN_s_per_um"] = 5
    with pytest.raises(ValueError, match="contraction.edges has damping_nN_s_per_um; give a law"):
        divided(scenario, "contraction.edges", [0, 1])


def test_mirrors_are_refused():
    scenario = BLOCK.copy()
    scenario["embryo.mirror"] = ["y"]
    with pytest.raises(ValueError, match="embryo.mirror makes cells of both sides equal"):
        plica.infer(scenario, {1: plica.Simulation(scenario).positions}, of=LAW, noise_um=0.1)


def test_a_jump_stays_a_jump():
    scenario = BLOCK.copy()
    scenario["cortex.apical.program"] = {"time_s": [0, 30, 30], "activity": [1, 1, 0.25]}
    parts = [scenario[f"{law}.program"] for law in divided(scenario, LAW, [0, 0.25, 1])]
    times = np.array(parts[0]["time_s"])
    total = np.sum([part["activity"] for part in parts], axis=0)
    assert (times == 30).sum() == 2 and total[times < 30] == pytest.approx(1) and total[times > 30] == pytest.approx(0.25)
    assert parts[1]["activity"][list(times).index(15)] == 1


def test_gradient_of_cells_agrees_with_differences():
    simulation, faces = faces_of(BLOCK)
    rng = np.random.default_rng(0)
    centres, areas = faces.of(simulation.positions)
    assert areas == pytest.approx(simulation.cell_data["apical_area_um2"], rel=1e-12)
    areas[3] = centres[5] = np.nan
    target = CellTarget(faces, centres + 0.1, 1.1 * areas, 0.5)
    assert target.count == 16 * 4 - 4
    positions = simulation.positions + 0.3 * rng.normal(size=simulation.positions.shape)
    direction = rng.normal(size=positions.shape)
    slope = (target.misfit(positions)[1] * direction).sum()
    ends = [target.misfit(positions + sign * 1e-5 * direction)[0] for sign in (1, -1)]
    assert slope == pytest.approx((ends[0] - ends[1]) / 2e-5, rel=1e-8)


def test_polygons_are_centres_and_areas(tmp_path):
    simulation, faces = faces_of(BLOCK)
    frame = plica.Simulation(BLOCK).run(out=tmp_path / "run").frames[-1]
    tape = plica.record(BLOCK)
    centres, areas = faces.of(tape.positions())
    for shape in (frame, frame.polygons("apical")):
        target = target_of(shape, "shape", faces, len(tape.positions()), np.arange(4), 0.1)
        assert target.centres == pytest.approx(centres, abs=1e-4) and target.areas == pytest.approx(areas, rel=1e-4)


WRONG = [
    (dict(shapes={}), "shapes: a value of type dict; give a mapping of times in minutes to shapes"),
    (dict(shapes={0: np.zeros((50, 3))}), "shapes: has no time after 0"),
    (dict(shapes={1: np.zeros((7, 3))}), "shapes[1]: an array of float64 and shape (7, 3) for a tissue of 50 nodes; give positions"),
    (dict(shapes={1: {"areas_um2": np.ones(3)}}), "3 areas for 16 cells; give one per cell"),
    (dict(shapes={1: {"area": np.ones(16)}}), "shapes[1]: area; give centres_um, areas_um2 or both"),
    (dict(shapes={1: np.full((50, 3), np.nan)}), "shapes[1]: has no finite value"),
    (dict(shapes={1: np.full((50, 3), 1e4)}), "µm from the tissue of the scenario, which is 32 µm long"),
    (dict(shapes={2: np.zeros((50, 3))}), "shapes: 2 min is after the end of the run, 1 min"),
    (dict(of="cortex.apica"), 'cortex.apica'),
    (dict(of=["apical", LAW]), "give one contraction or cortex, or several different ones"),
    (dict(knots_min=[1]), "knots_min: 1; give two or more increasing times"),
    (dict(knots_min=[1, 0.5]), "knots_min: 1, 0.5; give two or more increasing times"),
    (dict(knots_min=[-1, 0.5]), "knots_min: -1; give times in minutes"),
    (dict(noise_um=0), "noise_um: 0; give a number above 0, in µm"),
    (dict(spread=-1), "spread: -1; give a number above 0"),
    (dict(surface="top"), 'surface: "top"; give "apical", "basal" or "all"'),
]


@pytest.mark.parametrize("arguments, message", WRONG)
def test_bad_arguments_are_told(arguments, message):
    given = {"shapes": {1: plica.Simulation(BLOCK).positions}, "of": LAW, "noise_um": 0.1, **arguments}
    with pytest.raises((ValueError, TypeError)) as raised:
        plica.infer(BLOCK, **given)
    assert message in str(raised.value)
