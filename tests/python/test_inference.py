"""Strengths of cells from shapes: recovered from another mesh with noise, with unseen parts, and refusals."""
import numpy as np
import plica
import pytest
from plica import inference_search
from plica.inference import _residuals
from plica.inference_problem import Field, Problem
from plica.knots import divided
from plica.shape_targets import ApicalFaces, CellTarget, NodeTarget, Residuals, target_of
from plica.whole_cells import WholeCells

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
    with pytest.warns(UserWarning, match="times the noise at 2 min, more than chance explains; the model differs"):
        found = plica.infer(model, shapes, of=LAW, noise_um=noise_um, probes=6)
    assert np.corrcoef(np.log(found.factors[LAW]), np.log(truth))[0, 1] > 0.95
    assert found.runs < 30 and found.excess > 2  # the coarse model does not fit to the noise


def noisy_six_cells(seed):
    """Return a block of six cells, its noisy shape, and the noise."""
    block, rng = BLOCK.copy(), np.random.default_rng(seed)
    block.update({"embryo.length_um": 24, "embryo.width_um": 16, "embryo.cells": [3, 2, 1]})
    shape = plica.record(block, strengths={LAW: np.exp(0.25 * rng.normal(size=6))}).positions()
    noise_um = 0.02 * np.sqrt(((shape - plica.Simulation(block).positions) ** 2).sum(axis=1).mean())
    return block, {1: shape + noise_um * rng.normal(size=shape.shape)}, noise_um


@pytest.mark.filterwarnings("error::UserWarning")
def test_a_right_model_is_not_blamed():
    for seed in range(20):
        block, shapes, noise_um = noisy_six_cells(seed)
        found = plica.infer(block, shapes, of=LAW, noise_um=noise_um)
        assert not found.has_model_error and "exceed" not in repr(found)


def test_a_doubled_modulus_is_told():
    block, shapes, noise_um = noisy_six_cells(0)
    block["elasticity.young_modulus_Pa"] *= 2
    with pytest.warns(UserWarning, match="or noise_um is too small$"):
        found = plica.infer(block, shapes, of=LAW, noise_um=noise_um)
    assert found.has_model_error and "Residuals exceed the noise: the model differs" in repr(found)
    with pytest.warns(UserWarning, match="did not converge: set a larger most_runs first"):
        assert "or more runs are needed" in repr(plica.infer(block, shapes, of=LAW, noise_um=noise_um, most_runs=3))


def test_nodes_that_are_not_seen(block_shape, tmp_path, capsys):
    truth, shape = block_shape
    shape = shape.copy()
    shape[shape[:, 0] > 4] = np.nan  # both nodes of the last cells
    settings = dict(of="apical", noise_um=0.02, file=tmp_path / "search.npz", progress=True)
    begun = plica.infer(BLOCK, {1: shape}, most_runs=6, **settings)
    assert not begun.converged and "not converged" in repr(begun)
    with np.load(settings["file"]) as stored:  # as of a machine with other eigenvectors
        state = {**stored, "v": -stored["v"]}
    assert np.exp(state["logs"]) == pytest.approx(begun.strengths[LAW])
    np.savez(settings["file"], **state)
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
    pytest.importorskip("matplotlib")
    assert [ax.get_title() for ax in found.plot().axes[:3]] == ["cortex.apical: log2 of the factor", "sd of the logarithm", "not seen: 1"]
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
    whole = WholeCells(simulation, 16)
    assert faces.of(simulation.positions)[1] == pytest.approx(simulation.cell_data["apical_area_um2"], rel=1e-12)
    rng = np.random.default_rng(0)
    positions = simulation.positions + 0.3 * rng.normal(size=simulation.positions.shape)
    direction = rng.normal(size=positions.shape)
    for measures, known in ((faces, 16 * 4 - 4), (whole, 16 * 9 - 9)):
        middles, sizes = measures.of(simulation.positions)
        sizes[3] = middles[5] = np.nan
        target = CellTarget(measures, middles + 0.1, 1.1 * sizes, 0.5)
        assert target.seen.sum() == known
        first = CellTarget(measures, middles, np.where(sizes > 2, sizes, np.nan), 0.4)
        for begin, drift in ((None, []), (first, []), (None, [0, 2]), (first, [0, 1])):
            residuals = Residuals([target, CellTarget(measures, middles, sizes, 0.4)], begin, drift)
            both = [positions, simulation.positions]
            slope = (residuals.gradients(both)[0] * direction).sum()
            ends = [residuals.of([positions + sign * 1e-5 * direction, both[1]])[1].sum() for sign in (1, -1)]
            assert slope == pytest.approx((ends[0] - ends[1]) / 4e-5, rel=1e-8)


@pytest.mark.parametrize("known, weights", [(True, [[2, 0, -1], [0, 0, 0], [-1, 0, 2]]), (False, [[1.5, 0, -1.5], [0, 0, 0], [-1.5, 0, 1.5]])])
def test_a_first_shape_shares_its_noise(known, weights):
    rng = np.random.default_rng(0)
    first, *later = 0.1 * rng.normal(size=(4, 40_000, 3))
    targets = [NodeTarget(one - known * first, 0.1) for one in later]
    targets[1].seen[:] = False
    begin = NodeTarget(first if known else np.full_like(first, np.nan), 0.1)
    still = [np.zeros((40_000, 3))] * 3
    residuals = Residuals(targets, begin)
    counts = residuals.counts(3)
    assert residuals.of(still)[1].sum() == pytest.approx(counts.sum(), rel=0.02) and counts.sum() == 120_000 * (2 if known else 1)
    probes = np.stack([one.ravel() for one in residuals.probe(still, rng)]) * 0.1
    assert np.cov(probes) == pytest.approx(np.array(weights) / 3, abs=0.02)


@pytest.mark.parametrize("has_first", [True, False])
def test_drift_and_offsets_are_least_squares(has_first):
    rng = np.random.default_rng(0)
    shapes = rng.normal(size=(4, 6, 3))
    shapes[rng.uniform(size=shapes.shape) < 0.2] = np.nan
    first, *later = [NodeTarget(one, 1.0) for one in shapes]
    residuals = Residuals(later, first if has_first else None, [0, 2])
    still = [np.zeros((6, 3))] * 3
    values = np.concatenate([np.zeros((1, 18)), [target.residuals(one) for target, one in zip(later, still)]])
    seen = np.stack([target.seen for target in (first, *later)])
    times, places = np.nonzero(seen[1 - has_first:])
    times += 1 - has_first
    moved = [(times == time) & (places % 3 == axis) for time in (1, 2, 3) for axis in (0, 2)]
    own = [has_first & (places == place) for place in range(18)]
    design, given = np.array(moved + own, dtype=float).T, values[times, places]
    apart = given - design @ np.linalg.lstsq(design, given, rcond=None)[0]
    found, misfits = residuals.of(still)
    assert misfits.sum() == pytest.approx((apart**2).sum())
    assert np.array(found)[times[times > 0] - 1, places[times > 0]] == pytest.approx(apart[times > 0])
    probes = [np.concatenate([one.ravel() for one in residuals.probe(still, rng)])[seen[1:].ravel()] for _ in range(4000)]
    later_ones = times > 0
    assert np.cov(np.transpose(probes)) == pytest.approx((np.eye(len(given)) - design @ np.linalg.pinv(design))[np.ix_(later_ones, later_ones)], abs=0.1)


def test_shapes_that_drift(block_shape):
    start, shape = plica.Simulation(BLOCK).positions, block_shape[1]
    how = dict(of=LAW, noise_um=0.02)
    still = plica.infer(BLOCK, {0: start, 1: shape}, drift="xyz", **how)
    moved = plica.infer(BLOCK, {0: start, 1: shape + [5, -3, 1]}, drift="xyz", **how)
    assert moved.factors[LAW] == pytest.approx(still.factors[LAW], rel=1e-4) and moved.sd[LAW] == pytest.approx(still.sd[LAW], rel=1e-4)
    assert np.abs(np.log(still.factors[LAW] / block_shape[0] * block_shape[0].mean())).max() < 0.15
    with pytest.warns(UserWarning, match="more than chance explains"):
        pushed = plica.infer(BLOCK, {0: start, 1: shape + [0.3, 0, 0]}, **how)
    assert np.abs(np.log(pushed.factors[LAW] / still.factors[LAW])).max() > 0.1


def test_curvature_is_that_of_the_misfit(block_shape):
    """At the factors that made the shapes, the Gauss-Newton Hessian is the derivative of the gradient."""
    simulation = plica.Simulation(BLOCK)
    times, residuals = _residuals(BLOCK, simulation, {0: simulation.positions, 0.5: plica.record(BLOCK, at_min=0.5, strengths={LAW: block_shape[0]}).positions(0.5),
                                                      1: block_shape[1]}, "apical", 0.1, [0])
    problem = Problem(BLOCK, [Field(simulation, LAW, None)], times, residuals, 1)
    vectors, log = problem.fields[0].vectors, np.log(block_shape[0])
    tape = problem.run(vectors.T @ log, 2)
    found = problem.curvature(tape, vectors.T @ log, 2)
    for cell in (0, 6):
        ends = []
        for sign in (1, -1):
            v = vectors.T @ (log + sign * 1e-3 * (np.arange(16) == cell))
            ends.append(vectors @ problem.gradient(tape._with_strengths(problem.factors(v)), v, 2))
        assert found[cell] == pytest.approx((ends[0] - ends[1]) / 2e-3, abs=0.01 * found[cell, cell])
        product = vectors @ problem.product(tape, vectors.T @ log, vectors[cell], 2)
        assert product == pytest.approx(found[cell], abs=0.005 * found[cell, cell])


def test_many_factors_take_gauss_newton_steps(block_shape, tmp_path, monkeypatch):
    """They reach the minimum of L-BFGS in fewer runs; with any threads, and after an interruption, bitwise."""
    shapes, how = {1: block_shape[1]}, dict(of=LAW, noise_um=0.02, spread=0.3, probes=6)
    few = plica.infer(BLOCK, shapes, **how)
    monkeypatch.setattr(inference_search, "MOST_WHOLE", 10)
    found = plica.infer(BLOCK, shapes, **how)
    assert found.converged and found.runs < few.runs
    assert np.log(found.factors[LAW]) == pytest.approx(np.log(few.factors[LAW]), abs=0.3 * few.sd[LAW].min())
    kept = tmp_path / "search.npz"
    assert not plica.infer(BLOCK, shapes, most_runs=2, file=kept, **how).converged
    for again in (plica.infer(BLOCK, shapes, file=kept, **how), plica.infer(BLOCK, shapes, threads=3, **how)):
        assert again.converged and np.array_equal(again.factors[LAW], found.factors[LAW])


@pytest.mark.parametrize("most_whole, tries", [(200, 1), (10, 2)])
def test_a_search_ends_where_no_step_helps(block_shape, monkeypatch, most_whole, tries):
    """Few factors: derivatives are those of the last run, also for the final curvature. Many: a step by that run itself is tried first."""
    monkeypatch.setattr(inference_search, "MOST_WHOLE", most_whole)
    simulation = plica.Simulation(BLOCK)
    times, residuals = _residuals(BLOCK, simulation, {1: block_shape[1]}, "apical", 0.02, [])
    search = inference_search.Search(Problem(BLOCK, [Field(simulation, LAW, None)], times, residuals, 1), 0.3, 6)
    search.fit(2, lambda: None)
    assert 2 <= search.problem.runs < 9 and (search.linear is search.tape) == (tries == 1)
    failed = []
    monkeypatch.setattr(search, "step", lambda: failed.append(search.linear is search.tape))
    monkeypatch.setattr(search, "begin", lambda times: None)
    search.fit(9, lambda: None)
    assert failed == [False, True][-tries:] and not search.converged


def test_a_coarse_run_that_fails_is_replaced(block_shape, monkeypatch):
    def fails(*_):
        raise plica.NumericsError("no step converges", None, 0.0)

    monkeypatch.setattr(inference_search, "MOST_WHOLE", 10)
    monkeypatch.setattr(Problem, "run_coarsely", fails)
    assert plica.infer(BLOCK, {1: block_shape[1]}, of=LAW, noise_um=0.02, probes=6).converged


def test_whole_cells_are_bricks_and_turn():
    simulation = plica.Simulation(BLOCK)
    whole = WholeCells(simulation, 16)
    centroids, moments = whole.of(simulation.positions)
    assert centroids == pytest.approx(np.stack([simulation.cell_data[f"{axis}_um"] for axis in "xyz"], axis=1), abs=1e-9)
    assert moments == pytest.approx(np.tile(np.array([64, 64, 100, 0, 0, 0]) / 12, (16, 1)), abs=1e-9)
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    turned = turn @ np.diag([64, 64, 100]) @ turn.T / 12
    assert whole.of(simulation.positions @ turn.T)[1] == pytest.approx(
        np.tile(turned[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (16, 1)), abs=1e-9)


def test_tensions_follow_from_whole_cells(block_shape):
    truth, shape = block_shape
    whole = WholeCells(plica.Simulation(BLOCK), 16)
    values = [dict(zip(("centroids_um", "moments_um2"), whole.of(where))) for where in (plica.Simulation(BLOCK).positions, shape)]
    found = plica.infer(BLOCK, dict(enumerate(values)), of=LAW, noise_um=0.002)
    assert np.log(found.factors[LAW]) == pytest.approx(np.log(truth / truth.mean()), abs=0.1)


def test_polygons_are_centres_and_areas(tmp_path):
    simulation, faces = faces_of(BLOCK)
    frame = plica.Simulation(BLOCK).run(out=tmp_path / "run").frames[-1]
    tape = plica.record(BLOCK)
    centres, areas = faces.of(tape.positions())
    for shape in (frame, frame.polygons("apical")):
        target = target_of(shape, "shape", faces, WholeCells(simulation, 16), len(tape.positions()), np.arange(4), 0.1)
        assert target.middles == pytest.approx(centres, abs=1e-4) and target.sizes == pytest.approx(areas, rel=1e-4)


WRONG = [
    (dict(shapes={}), "shapes: is empty; give a mapping of times in minutes to shapes"),
    (dict(shapes={0: np.zeros((50, 3))}), "shapes: has no time after 0"),
    (dict(shapes={1: np.zeros((7, 3))}), "shapes[1]: an array of float64 and shape (7, 3) for a tissue of 50 nodes; give positions"),
    (dict(shapes={1: {"areas_um2": np.ones(3)}}), "areas_um2 of shape (3,) for 16 cells; give (16,), one row per cell"),
    (dict(shapes={1: {"moments_um2": np.ones((16, 3, 3))}}), "moments_um2 of shape (16, 3, 3) for 16 cells; give (16, 6)"),
    (dict(shapes={1: {"area": np.ones(16)}}), "shapes[1]: area; give centres_um, areas_um2 or both, or centroids_um"),
    (dict(shapes={1: {"areas_um2": np.ones(16), "centroids_um": np.ones((16, 3))}}), "has values of apical faces and of whole cells"),
    (dict(shapes={0: {"areas_um2": np.ones(16)}, 1: {"centroids_um": np.ones((16, 3))}}), "are of different kinds; give both as nodes"),
    (dict(shapes={1: np.full((50, 3), np.nan)}), "shapes[1]: has no finite value"),
    (dict(shapes={1: np.full((50, 3), 1e4)}), "µm from the tissue of the scenario, which is 32 µm long"),
    (dict(shapes={2: np.zeros((50, 3))}), "shapes: 2 min is after the end of the run, 1 min"),
    (dict(of="cortex.apica"), 'cortex.apica'),
    (dict(of=["apical", LAW]), "give one contraction or cortex, or several different ones"),
    (dict(of="growth.none"), "of: growth.none grows at an absolute rate"),
    (dict(knots_min=[1]), "knots_min: 1; give two or more increasing times"),
    (dict(knots_min=[1, 0.5]), "knots_min: 1, 0.5; give two or more increasing times"),
    (dict(knots_min=[-1, 0.5]), "knots_min: -1; give times in minutes"),
    (dict(noise_um=0), "noise_um: 0; give a number above 0, in µm"),
    (dict(drift="xx"), "drift: 'xx'; give axes, such as \"xy\", each once"),
    (dict(probes=0), "probes: 0"),
    (dict(spread=-1), "spread: -1; give a number above 0"),
    (dict(surface="top"), 'surface: "top"; give "apical", "basal" or "all"'),
]


@pytest.mark.parametrize("arguments, message", WRONG)
def test_bad_arguments_are_told(arguments, message):
    given = {"shapes": {1: plica.Simulation(BLOCK).positions}, "of": LAW, "noise_um": 0.1, **arguments}
    with pytest.raises((ValueError, TypeError)) as raised:
        plica.infer(BLOCK, **given)
    assert message in str(raised.value)
