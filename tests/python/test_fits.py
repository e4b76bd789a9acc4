"""Fits by slopes of runs: recovery from another mesh with noise, model error, several scenarios, failures, continuation."""
import json

import numpy as np
import plica
import pytest
from plica import descent, fit_problem
from plica.progress import Counter

BLOCK = """
format = 1
[embryo]
shape = "block"
length_um = 60
width_um = 40
cell_height_um = 20
cells = [3, 2, 1]
[elasticity]
young_modulus_Pa = 1000
[cortex.apical]
region = "all"
tension_mN_per_m = 2
[cortex.basal]
region = "all"
faces = "basal"
tension_mN_per_m = 1
[time]
end_s = 60
[stop]
at_equilibrium = false
[monitor.top]
quantity = "area"
over = "sum"
[monitor.bottom]
quantity = "area"
face = "basal"
over = "sum"
"""
APICAL, BASAL, DRAG = "cortex.apical.tension_mN_per_m", "cortex.basal.tension_mN_per_m", "dynamics.surface_drag_Pa_s_per_um"
YOUNG = "elasticity.young_modulus_Pa"
KEYS = {APICAL: (0.5, 8), BASAL: (0.2, 6), DRAG: (30, 900)}
TRUTH = {APICAL: 4, BASAL: 2, DRAG: 300}
OUTCOMES = ["top.area_um2", "bottom.area_um2"]
TIMES = [0.05, 0.1, 0.2, 1]


def block(changes={}):
    scenario = plica.Scenario(BLOCK)
    scenario.update(changes)
    return scenario


def targets_of(scenario, sd, noise=0.0, seed=0, times=TIMES):
    """Return targets that a scenario has, with a relative standard deviation."""
    tape, random = plica.record(scenario, at_min=times), np.random.default_rng(seed)
    values = {name: {time: tape.value(name, at_min=time) for time in times} for name in OUTCOMES}
    return {name: {time: (value * (1 + noise * random.standard_normal()), sd * value) for time, value in of_name.items()}
            for name, of_name in values.items()}


@pytest.fixture(scope="module")
def exact():
    return targets_of(block(TRUTH), 1e-3)


def test_keys_are_recovered(exact):
    found = plica.fit(block(), exact, of=KEYS)
    assert found.end == "converged" and found.runs <= 10
    assert found.values == pytest.approx(TRUTH, rel=5e-3)
    assert not found.has_model_error and not any(one.is_open for one in found.combinations)
    assert found.scenarios[0][APICAL] == found.values[APICAL]
    assert max(abs(one.deviations) for one in found.misses) < 0.3
    # The covariance is that of a linear model of the targets.
    assert found.covariance == pytest.approx(np.linalg.inv(found.jacobian.T @ found.jacobian), rel=1e-4)
    assert "Identified" in str(found) and "left open" not in str(found).lower()


# The targets come from a finer mesh and tighter steps, whose areas differ by up to 3 %; the errors include that.
@pytest.mark.parametrize("seed", [1, 2])
def test_keys_are_recovered_from_another_mesh_with_noise(seed):
    fine = block({**TRUTH, "embryo.cells": [9, 6, 3], "time.tolerance_um": 0.01})
    targets = targets_of(fine, 0.03, noise=0.01, seed=seed)
    found = plica.fit(block({"embryo.cells": [6, 4, 2]}), targets, of=KEYS)
    assert found.end == "converged" and found.runs <= 15 and not found.has_model_error
    for key, (low, high) in found.intervals(0.95).items():
        assert low < TRUTH[key] < high, str(found)
        assert low < found.values[key] < high


def test_model_error_is_told():
    stiffer = block({**TRUTH, "elasticity.poisson_ratio": 0, "embryo.cells": [6, 4, 2]})
    with pytest.warns(UserWarning, match="missed by more than their errors"):
        found = plica.fit(block(), targets_of(stiffer, 1e-3), of=KEYS)
    assert found.has_model_error and "intervals are too narrow" in str(found)


@pytest.mark.filterwarnings("error::UserWarning")
def test_a_right_model_is_not_blamed():
    for seed in range(20):
        assert not plica.fit(block(), targets_of(block(TRUTH), 0.01, noise=0.01, seed=seed), of=KEYS).has_model_error


def test_a_doubled_modulus_is_told():
    keys = {key: bounds for key, bounds in KEYS.items() if key != APICAL}  # else all forces would double
    with pytest.warns(UserWarning, match="missed by more than their errors"):
        plica.fit(block({APICAL: TRUTH[APICAL]}), targets_of(block({**TRUTH, YOUNG: 2000}), 0.01, noise=0.01), of=keys)


@pytest.mark.parametrize("free, exceeded", [(1, 10.83), (4, 18.47), (10, 29.59), (100, 149.4)])  # tables of chi-square
def test_what_chance_explains(free, exceeded):
    assert fit_problem.largest_by_chance(free) == pytest.approx(exceeded, rel=0.035)


def test_only_ratios_of_forces_are_identified(exact):
    found = plica.fit(block(), exact, of={**KEYS, YOUNG: (200, 5000)})
    *known, last = found.combinations
    assert last.is_open and not any(one.is_open for one in known)
    assert [last.powers[key] for key in (APICAL, BASAL, DRAG, YOUNG)] == pytest.approx([1, 1, 1, 1], abs=0.05)
    assert found.values[APICAL] / found.values[YOUNG] == pytest.approx(4 / 1000, rel=0.01)
    assert "Left open" in str(found)
    with_prior = plica.fit(block(), exact, of={**KEYS, YOUNG: (200, 5000)}, priors={YOUNG: (1000, 50)})
    assert with_prior.values == pytest.approx({**TRUTH, YOUNG: 1000}, rel=0.01)
    low, high = with_prior.intervals()[YOUNG]
    assert np.log(high / low) == pytest.approx(2 * 1.645 * 0.05, rel=0.02)


def test_scenarios_share_keys():
    # One has no apical tension from 6 s on, as in the light; its later frames give the drag.
    light = {"cortex.apical.program": {"time_s": [0, 6, 6], "activity": [1, 1, 0]}}
    of_light = targets_of(block({**TRUTH, **light}), 1e-3, times=[0.15, 0.2])
    of_dark = targets_of(block(TRUTH), 1e-3, times=[1])
    found = plica.fit([(block(), of_dark), (block(light), of_light)], of=KEYS, early_min=0.5)
    assert found.values == pytest.approx(TRUTH, rel=5e-3)
    assert {one.scenario for one in found.misses} == {0, 1} and len(found.scenarios) == 2
    assert found.jacobian.shape == (6, 3)


def test_functions_are_outcomes(exact):
    def height(x):
        gradient = np.zeros_like(x)
        gradient[:, 2] = 2 * x[:, 2] / len(x)
        return float((x[:, 2] ** 2).mean()), gradient

    tape = plica.record(block({APICAL: 4}))
    found = plica.fit(block(), {height: (tape.value(height), 0.01)}, of={APICAL: (0.5, 8)})
    assert found.values[APICAL] == pytest.approx(4, rel=1e-2)
    assert found.misses[0].outcome == "height" and found.misses[0].at_min is None


def failing_above(limit, monkeypatch):
    tried = []

    def record(scenario, **more):
        tried.append(scenario[APICAL])
        if scenario[APICAL] > limit:
            raise plica.NumericsError("no step converges")
        return plica.record(scenario, **more)

    monkeypatch.setattr(fit_problem, "record", record)
    return tried


def test_a_failed_run_shortens_the_step(exact, monkeypatch):
    tried = failing_above(4.2, monkeypatch)
    monkeypatch.setattr(descent, "FIRST_RADIUS", 3.0)
    found = plica.fit(block(), exact, of=KEYS)
    assert max(tried) > 4.2 and found.values == pytest.approx(TRUTH, rel=5e-3)


class Valley:
    """Residual 1 - place, without slopes from 0.5 and without runs from 0.8 on."""

    low, high = np.array([-2.0]), np.array([2.0])
    tried = []

    def residuals(self, place, until):
        self.tried.append(float(place[0]))
        return None if place[0] > 0.8 else np.array([1 - place[0]])

    def slopes(self, place, until):
        if place[0] > 0.5:
            raise plica.NumericsError("gradient: the linear system of a step is singular")
        return np.array([[-1.0]])


def test_a_place_without_slopes_shortens_the_step():
    end = descent.descend(Valley(), descent.End(np.zeros(1), np.inf, 0, ""), None, 60, 1e-3, Counter("fit", "run", False))
    assert 0.49 < end.place[0] <= 0.5 and end.score == (1 - end.place[0]) ** 2
    assert max(Valley.tried) > 0.5 and end.end == "no better place nearby" and end.runs == len(Valley.tried)


def test_starts(exact, monkeypatch):
    found = plica.fit(block(), exact, of=KEYS, starts=3, seed=2)
    assert len(found.starts) == 3 and found.score == min(score for score, _ in found.starts)
    assert found.values == pytest.approx(TRUTH, rel=5e-3)
    failing_above(0, monkeypatch)
    with pytest.raises(plica.NumericsError, match="no step converges"):
        plica.fit(block(), exact, of=KEYS, starts=2)


def test_a_killed_fit_continues(exact, tmp_path, monkeypatch):
    whole = plica.fit(block(), exact, of=KEYS, folder=tmp_path)
    file = tmp_path / "runs.jsonl"
    lines = file.read_text().splitlines()
    made = []
    monkeypatch.setattr(fit_problem, "record", lambda *a, **k: made.append(1) or plica.record(*a, **k))
    again = plica.fit(block(), exact, of=KEYS, folder=tmp_path)
    assert not made and again.values == whole.values and again.runs == whole.runs
    # Killed in the middle of a line.
    file.write_text("\n".join(lines[:4]) + "\n" + lines[4][:40])
    again = plica.fit(block(), exact, of=KEYS, folder=tmp_path)
    assert again.values == whole.values and 0 < len(made) < whole.runs
    for line in file.read_text().splitlines()[5:]:
        assert json.loads(line)["found"] is not None
    with pytest.raises(plica.FileError, match="holds another fit"):
        plica.fit(block(), exact, of={APICAL: (0.5, 8)}, folder=tmp_path)
    file.write_text("\n".join([lines[0][:20], *lines[1:]]) + "\n")
    with pytest.raises(plica.FileError, match="runs.jsonl:1: cannot be read, so its fit is unknown; give another folder"):
        plica.fit(block(), exact, of=KEYS, folder=tmp_path)


def test_an_edited_function_is_another_fit(exact, tmp_path):
    def fit(part):
        def height(positions):
            return part * positions[:, 2].mean(), np.full(positions.shape, [0, 0, part / len(positions)])
        return plica.fit(block(), {**exact, height: (5, 1)}, of={APICAL: (0.5, 8)}, folder=tmp_path)

    assert fit(1).values == fit(1).values
    with pytest.raises(plica.FileError, match="holds another fit"):
        fit(2)


def test_bounds_hold(exact):
    with pytest.warns(UserWarning, match="missed by more"):
        found = plica.fit(block(), exact, of={**KEYS, APICAL: (0.5, 3)}, tolerance=1)
    assert found.values[APICAL] == pytest.approx(3) and "at its bound" in str(found)


def test_steps_stay_within_radius_and_bounds():
    random = np.random.default_rng(0)
    slopes, residuals = random.normal(size=(8, 4)), random.normal(size=8)
    far = np.full(4, 100.0)
    free = descent.bounded_step(slopes, residuals, -far, far, 1e3)
    assert free == pytest.approx(-np.linalg.lstsq(slopes, residuals, rcond=None)[0])
    short = descent.bounded_step(slopes, residuals, -far, far, 0.1)
    assert np.linalg.norm(short) == pytest.approx(0.1, rel=1e-6)
    damping = (-slopes.T @ (residuals + slopes @ short)) / short  # the same for all components: Levenberg–Marquardt
    assert damping == pytest.approx(np.full(4, damping[0]), rel=1e-5)
    low = np.array([-0.01, -1, -1, -1])
    assert (descent.bounded_step(-slopes, residuals, low, -low, 1) >= low).all()


def test_plot(exact):
    pytest.importorskip("matplotlib").use("Agg")
    figure = plica.fit(block(), exact, of=KEYS).plot()
    assert [len(ax.get_yticks()) for ax in figure.axes] == [8, 3]


WRONG = [
    (dict(targets=None), "targets: None; give targets as"),
    (dict(targets={}), "targets: a value of type dict; give"),
    (dict(targets={"top.area_um2": 3}), "targets['top.area_um2']: 3; give (value, sd)"),
    (dict(targets={"top.area_um2": (1, 0)}), "sd is 0.0; give a standard deviation above 0"),
    (dict(targets={"top.area_um2": {0: (1, 1)}}), "targets['top.area_um2'] at 0 min: 0; give a time in minutes, above 0"),
    (dict(targets={"top.volume": (1, 1)}), 'outcome "top.volume": is no output variable; those with a gradient: '),
    (dict(of={}), "of: give keys as {key: (low, high)}"),
    (dict(of={APICAL: (3, 8)}), f"of: {APICAL} is 2, outside 3 to 8; set it within the bounds"),
    (dict(of={APICAL: (8, 3)}), "give finite bounds, the lower one first"),
    (dict(of={"cortex.apical.region": (1, 2)}), "of: cortex.apical.region is 'all'; choose keys that have a number"),
    (dict(of={"embryo.length_um": (50, 70)}), "embryo.length_um: has no gradient"),
    (dict(of={"self_contact.stiffness_kPa_per_um": (0.5, 2)}), "of: self_contact.stiffness_kPa_per_um changes no target; fit another key"),
    (dict(of={"time.tolerance_um": (0.01, 0.1)}), "time.tolerance_um: has no gradient, since steps are constants of the recorded run"),
    (dict(priors={YOUNG: (1, 1)}), f"priors: {YOUNG} is not fitted; keys: {APICAL}"),
    (dict(priors={APICAL: (1, -1)}), "give (value, sd), both above 0"),
    (dict(early_min=0.01), "early_min: 0.01; give a time at or after the first target"),
    (dict(runs=1), "runs: 1; give a whole number, 2 or more"),
    (dict(scenario=[BLOCK], targets=None), "scenario[0]: "),
    (dict(scenario=[], targets=None), "an empty list"),
]


@pytest.mark.parametrize("changes, message", WRONG)
def test_bad_arguments_are_told(exact, changes, message):
    arguments = {"scenario": block(), "targets": exact, "of": {APICAL: (0.5, 8)}, **changes}
    with pytest.raises(ValueError) as raised:
        plica.fit(arguments.pop("scenario"), arguments.pop("targets"), **arguments)
    assert message in str(raised.value)
