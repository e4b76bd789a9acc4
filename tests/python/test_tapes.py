"""Recorded runs: gradients agree with differences, and recover what made a shape."""
import warnings

import numpy as np
import plica
import pytest
from plica.tapes import CHECK_CHANGES, _checked
from scipy.optimize import minimize

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
saturation_ratio = 0.2
[time]
end_s = 60
[stop]
at_equilibrium = false
[monitor.top]
quantity = "area"
over = "sum"
[monitor.ratio]
quantity = "area_ratio"
over = "rms"
[monitor.moved]
quantity = "displacement"
[monitor.side]
quantity = "position"
axis = "x"
face = "apical"
over = "rms"
[monitor.smallest]
quantity = "area"
over = "min"
"""
OUTCOMES = ["top.area_um2", "ratio.area_ratio", "moved.displacement_um", "side.position_um", "mean_height_um"]


@pytest.fixture(scope="module")
def tape():
    return plica.record(BLOCK, at_min=0.5)


def test_a_tape_is_the_run(tape):
    sim = plica.Simulation(BLOCK)
    sim.run(until_min=0.5)
    assert np.array_equal(tape.positions(0.5), sim.positions)
    sim.run()
    assert np.array_equal(tape.positions(), sim.positions)
    assert tape.times_min[0] == 0 and tape.times_min[-1] == 1
    assert tape.value("top.area_um2") == pytest.approx(sim.measures["top.area_um2"], rel=1e-12)
    assert "steps to 1 min" in repr(tape)


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_gradients_of_monitors_agree_with_differences(tape, outcome):
    keys = ["cortex.apical.tension_mN_per_m", "elasticity.young_modulus_Pa", "dynamics.surface_drag_Pa_s_per_um"]
    for check in plica.check_gradient(tape, outcome, of=keys) + plica.check_gradient(tape, outcome, of="cortex.apical", by="cell"):
        assert check.error < 1e-6, check


def test_outcomes_of_the_furrow_agree_with_differences():
    tape = plica.record("drosophila", until_min=0.5)
    for outcome in ["furrow_depth_um", "vml_apical_area_ratio"]:
        [check] = plica.check_gradient(tape, outcome, of="contraction.apical.stiffness_nN_per_um")
        assert check.error < 1e-6, check


@pytest.mark.parametrize("slope, value_at, change, error, uncertainty", [
    (1, lambda part: np.sin(2000 * part) / 2000, 1e-6, 1e-6, 1e-4),           # curved: right at the third change
    (1.01, lambda part: np.sin(2000 * part) / 2000, 1e-7, 0.0101, 1e-6),      # wrong slope: two differences agree
    (1, lambda part: part, 1e-3, 1e-12, np.nan),                              # right at once
    (1, lambda part: part + 1e-2 * np.sign(part), 1e-4, 1, 1),                # a jump: no difference agrees with another
])
def test_a_check_finds_the_change_that_an_outcome_allows(slope, value_at, change, error, uncertainty):
    check = _checked("key", slope, CHECK_CHANGES, lambda part: ((value_at(part) - value_at(-part)) / (2 * part), np.nan))
    assert check.change == change or uncertainty == 1
    assert 0.5 * error < check.error <= error or error < 1e-5 and check.error <= error
    assert np.isnan(uncertainty) and np.isnan(check.uncertainty) or 0.4 * uncertainty < check.uncertainty <= uncertainty
    assert f"{check.change:.0e}" in repr(check) and ("±" in repr(check)) != np.isnan(uncertainty)


def test_a_check_warns_of_a_tolerance_too_coarse_for_slopes():
    scenario = plica.Scenario("furrow-slice")
    scenario.update({"embryo.mirror": ["y"], "time.tolerance_um": 0.1})
    tape = plica.record(scenario)
    key = "cortex.apical.tension_mN_per_m"
    with pytest.warns(UserWarning, match=f"time.tolerance_um = 0.1 is too coarse for slopes: that by {key} is -12.*set time.tolerance_um to 0.025"):
        [check] = plica.check_gradient(tape, "furrow_depth_um", of=key, change=1e-5)
    scenario["time.tolerance_um"] = 0.025
    finer = plica.record(scenario)
    assert check.finer == pytest.approx(finer.gradient("furrow_depth_um", of=key), rel=1e-6)
    assert 14 < check.snap_min < 15 and "snap at 14." in repr(check)  # the lips meet
    # As coarse, before contact: no warning. Given steps have no tolerance.
    block = plica.Scenario(BLOCK)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        [check] = plica.check_gradient(plica.record(block), "top.area_um2", of=key)
        assert check.finer == pytest.approx(check.gradient, rel=0.05) and np.isnan(check.snap_min)
        block["time.step_s"] = 5
        [check] = plica.check_gradient(plica.record(block), "top.area_um2", of=key)
        assert np.isnan(check.finer)


def test_a_check_warns_of_a_wrong_derivative(tape):
    with pytest.warns(UserWarning, match="the derivative by elasticity.young_modulus_Pa is .*, but runs differ by .*; do not use it"):
        plica.check_gradient(tape, lambda x: ((x**2).sum(), 3 * x), of="elasticity.young_modulus_Pa")
    with pytest.raises(ValueError, match="target: .*; give positions of all nodes, of shape"):
        tape.distance_to(np.ones((3, 3)))


def test_a_check_changes_cells_with_their_images():
    scenario = plica.Scenario("furrow-slice")
    scenario["embryo.mirror"] = ["y"]
    tape = plica.record(scenario, until_min=2)
    checks = plica.check_gradient(tape, "furrow_depth_um", of="cortex.apical", by="cell")
    assert max(check.error for check in checks) < 1e-5


@pytest.mark.parametrize("name, changes, keys", [
    ("drosophila", {}, ["contraction.apical.stiffness_nN_per_um"]),
    ("furrow-slice", {"embryo.mirror": ["y"]}, ["cortex.apical.tension_mN_per_m", "elasticity.young_modulus_Pa"]),
    ("drosophila-egg", {"embryo.cell_count": 300}, []),
    ("wing-disc", {"embryo.cell_count": 200}, []),
    ("growing-disc", {"embryo.cell_count": 60}, []),
    ("convergent-extension", {"embryo.cell_count": 20}, ["elasticity.relaxation_s", "cortex.lateral.noise.spread"]),
])
def test_gradients_of_built_in_scenarios_agree_with_differences(name, changes, keys):
    scenario = plica.Scenario(name)
    scenario.update(changes)
    tape = plica.record(scenario, until_min=1)
    for check in plica.check_gradient(tape, moved(tape), of=["dynamics.surface_drag_Pa_s_per_um", *keys]):
        assert check.error < 1e-5, check


def test_a_function_of_several_times(tape):
    first, last = tape.positions(0.5), tape.positions(1)
    loss = tape.distance_to(np.stack([first + 0.1, last - 0.2]), surface="all")
    assert tape.value(loss, at_min=[0.5, 1]) == pytest.approx((3 * 0.01 + 3 * 0.04) / 2)
    for check in plica.check_gradient(tape, loss, of="cortex.apical", by="cell", at_min=[0.5, 1]):
        assert check.error < 1e-6, check
    # A gradient alone, of one time.
    by_array = tape.gradient(np.ones((len(last), 3)), of="elasticity.young_modulus_Pa")
    by_function = tape.gradient(lambda x: (x.sum(), np.ones_like(x)), of="elasticity.young_modulus_Pa")
    assert by_array == by_function


def moved(tape):
    """Outcome of all positions, with random weights."""
    rest = tape.positions(0)
    weights = np.random.default_rng(1).uniform(-1, 1, rest.shape)
    return lambda positions: (float((weights * (positions - rest)).sum()), weights)


def test_keys_of_signals_agree_with_differences():
    scenario = plica.Scenario("wave")
    scenario.update({"embryo.length_um": 60, "embryo.width_um": 20, "embryo.cell_count": 60, "signal.u.initial": 0.5,
        "signal.u.source": {"region": "left-end", "per_min": 0.1}, "cortex.apical.program": {"time_min": [0, 0.2], "activity": [0, 1]}})
    tape = plica.record(scenario, until_min=0.5)
    keys = ["signal.u.diffusion_um2_per_min", "signal.u.constants.k", "signal.u.initial", "cortex.apical.follow.to"]
    for check in plica.check_gradient(tape, moved(tape), of=keys):
        assert abs(check.gradient) > 0.1 and check.error < 1e-6, check


def test_strengths_in_growing_cells_agree_with_differences():
    scenario = plica.Scenario(BLOCK)
    scenario.update({"growth.all": {"region": "all", "rate_per_h": 60}})
    tape = plica.record(scenario, until_min=0.5, strengths={"cortex.apical": [1.3, 0.7, 1.1, 0.8, 1.2, 0.9]})
    checks = plica.check_gradient(tape, moved(tape), of="cortex.apical", by="cell")
    for check in checks + plica.check_gradient(tape, moved(tape), of="growth.all.rate_per_h"):
        assert check.error < 1e-6, check


@pytest.mark.parametrize("model", ["corotational", "neo-hookean"])
def test_stiffness_of_cells_agrees_with_differences(model):
    scenario = plica.Scenario(BLOCK)
    scenario["elasticity.model"] = model
    factors = [1.3, 0.7, 1.1, 0.8, 1.2, 0.9]
    tape = plica.record(scenario, strengths={"elasticity": factors})
    for check in plica.check_gradient(tape, moved(tape), of="elasticity", by="cell"):
        assert check.error < 1e-6, check
    # All together are the modulus.
    by_cell = tape.gradient(moved(tape), of="elasticity", by="cell")
    by_key = tape.gradient(moved(tape), of="elasticity.young_modulus_Pa") * scenario["elasticity.young_modulus_Pa"]
    assert by_cell @ factors == pytest.approx(by_key, rel=1e-6)


def growing(**changes):
    """Return a block that grows and flows, of which each cell grows by another factor."""
    scenario = plica.Scenario(BLOCK)
    scenario.update({"growth.all": {"region": "all", "rate_per_h": 60, "in_plane": 0.8}, "cortex.walls": {
        "region": "all", "faces": "lateral", "stiffness_mN_per_m": 2, "relaxation_min": 0.2}, **changes})
    return scenario, {"growth.all": [1.3, 0.7, 1.1, 0.8, 1.2, 0.9]}


def test_growth_of_cells_agrees_with_differences():
    scenario, factors = growing()
    tape = plica.record(scenario, strengths=factors)
    for check in plica.check_gradient(tape, moved(tape), of="growth.all", by="cell"):
        assert check.error < 1e-6, check
    by_cell = tape.gradient(moved(tape), of="growth.all", by="cell")
    again = plica.record(scenario, strengths=factors, threads=2).gradient(moved(tape), of="growth.all", by="cell")
    assert np.array_equal(by_cell, again)
    # All together are the rate.
    assert by_cell @ factors["growth.all"] == pytest.approx(60 * tape.gradient(moved(tape), of="growth.all.rate_per_h"), rel=1e-6)
    # Where no cell grows, too.
    assert plica.record(scenario, strengths={"growth.all": np.zeros(6)}).gradient("top.area_um2", of="growth.all", by="cell").min() > 0


def test_growth_of_cells_through_division_agrees_with_differences():
    scenario, factors = growing(**{"division.all": {"region": "all", "at_s": 30, "growth_s": 18}})
    tape = plica.record(scenario, strengths=factors)
    assert tape._core.changes > 0
    checks = plica.check_gradient(tape, "top.area_um2", of="growth.all", by="cell")
    assert max(check.error for check in checks) < 1e-6, checks


def test_growth_of_cells_through_exchange_agrees_with_differences():
    scenario = plica.Scenario("convergent-extension")
    scenario.update({**SHEET, "embryo.cell_count": 20, "embryo.length_um": 20, "embryo.width_um": 20})
    tape = plica.record(scenario, until_min=1)
    assert tape._core.changes > 0
    checks = plica.check_gradient(tape, "length.position_um", of="growth.all", by="cell")
    assert max(check.error for check in checks) < 1e-6, checks


def test_growth_that_follows_a_signal_is_refused():
    scenario, factors = growing(**{"signal.u": {"decay_per_min": 1, "initial": 1}})
    scenario["growth.all.follow"] = {"signal": "u", "from": 0, "to": 1}
    with pytest.raises(ValueError, match="growth that follows a signal has no gradient; remove follow"):
        plica.record(scenario, strengths=factors)


def test_one_way_back_gives_all_keys(tape):
    keys = ["cortex.apical.tension_mN_per_m", "elasticity.young_modulus_Pa"]
    both = tape.gradient("top.area_um2", of=keys)
    assert both.shape == (2,) and both[0] < 0 < both[1]
    assert both[1] == pytest.approx(tape.gradient("top.area_um2", of=keys[1]), rel=1e-9)


def test_jacobians_are_gradients(tape):
    keys = ["cortex.apical.tension_mN_per_m", "elasticity.young_modulus_Pa", "dynamics.surface_drag_Pa_s_per_um"]
    slopes = tape.jacobian(OUTCOMES, of=keys, at_min=[0.5, 1])
    by_way_back = [[tape.gradient(outcome, of=keys, at_min=time) for time in (0.5, 1)] for outcome in OUTCOMES]
    assert slopes.shape == (len(OUTCOMES), 2, 3)
    assert slopes == pytest.approx(np.array(by_way_back), rel=1e-7)
    mean = tape.jacobian(lambda x: (x.mean(), np.full_like(x, 1 / x.size)), of=keys[0])
    assert mean.shape == (1, 1, 1) and mean[0, 0, 0] == pytest.approx(tape.gradient(lambda x: (x.mean(), np.full_like(x, 1 / x.size)), of=keys[0]))
    with pytest.raises(ValueError, match="no step ends at 0.7 min"):
        tape.jacobian(OUTCOMES, of=keys, at_min=0.7)


def test_tensions_are_recovered_from_a_shape():
    truth = np.array([1.3, 0.7, 1.1, 0.8, 1.2, 0.9])
    shape = plica.record(BLOCK, strengths={"cortex.apical": truth}).positions()

    def misfit(logs):
        factors = np.exp(logs)
        tape = plica.record(BLOCK, strengths={"cortex.apical": factors})
        loss = tape.distance_to(shape)
        return 1e4 * tape.value(loss), 1e4 * factors * tape.gradient(loss, of="cortex.apical", by="cell")

    found = minimize(misfit, np.zeros(6), jac=True, method="L-BFGS-B", options={"maxiter": 30})
    assert np.abs(np.exp(found.x) - truth).max() < 0.01


SHEET = {"embryo.cell_count": 60, "embryo.length_um": 36, "embryo.width_um": 36, "exchange.below_um": 1.2, "exchange.new_length_um": 1.3,
         "growth.all": {"region": "all", "rate_per_h": 1, "in_plane": 1},
         "monitor.length": {"quantity": "position", "axis": "x", "over": "rms"}}


def test_gradients_of_a_sheet_that_grows_and_exchanges_neighbours():
    scenario = plica.Scenario("convergent-extension")
    scenario.update(SHEET)
    tape = plica.record(scenario, until_min=1.5)
    assert tape._core.changes >= 3
    simulation = plica.Simulation(scenario)
    simulation.run(until_min=1.5)
    assert np.array_equal(tape.positions(), simulation.positions)
    keys = ["growth.all.rate_per_h", "cortex.lateral.direction.strongest", "elasticity.relaxation_s", "elasticity.young_modulus_Pa"]
    checks = plica.check_gradient(tape, "length.position_um", of=keys)
    print(checks)
    assert max(check.error for check in checks) < 1e-5


def test_gradients_by_cell_through_division():
    scenario = plica.Scenario(BLOCK)
    scenario.update({"division.all": {"region": "all", "at_s": 30, "growth_s": 18}})
    tape = plica.record(scenario, at_min=0.2)
    checks = plica.check_gradient(tape, "top.area_um2", of="cortex.apical", by="cell")
    assert max(check.error for check in checks) < 1e-6
    with pytest.raises(ValueError, match="cells divide between these times"):
        tape.value(lambda x: (x.sum(), np.ones_like(x)), at_min=[0.2, 1])
    with pytest.raises(ValueError, match="outcome \"ratio.area_ratio\": is relative to the reference state"):
        tape.gradient("ratio.area_ratio", of="elasticity.young_modulus_Pa")
    with pytest.raises(ValueError, match="division.all.growth_s: has no gradient"):
        tape.gradient("top.area_um2", of="division.all.growth_s")
    with pytest.raises(ValueError, match="infer: cells divide or exchange neighbours before the last shape"):
        plica.infer(scenario, {1: tape.positions(0.2)}, of="cortex.apical", noise_um=0.1)


WRONG = [
    (dict(outcome="max_node_speed_um_per_s", of="elasticity.young_modulus_Pa"), "has no gradient; those with a gradient: mean_height_um, moved.displacement_um, ratio.area_ratio, side.position_um, smallest.area_um2, top.area_um2;"),
    (dict(outcome="top.area_um2", of="embryo.length_um"), "embryo.length_um: has no gradient, since it changes the tissue"),
    (dict(outcome="top.area_um2", of="elasticity.young"), "of: elasticity.young: has no value in this scenario; nearest matches: elasticity.model, elasticity.young_modulus_Pa"),
    (dict(outcome="top.area_um2", of="self_contact.distance_um"), "self_contact.distance_um: has no gradient, since which surfaces"),
    (dict(outcome="top.area_um2", of="cortex.apical.region"), 'cortex.apical.region: \'all\'; choose a key that has a number'),
    (dict(outcome="top.area_um2", of="cortex.apical.stiffness_mN_per_m"), "is 0, where its change has no scale"),
    (dict(outcome="top.area_um2", of="cortex.apica", by="cell"), 'no law "cortex.apica"; laws: '),
    (dict(outcome="top.area_um2", of="drag", by="cell"), "drag: has no strengths of cells; choose a contraction, a cortex, growth or elasticity"),
    (dict(outcome="top.area_um2", of=["cortex.apical"], by="cell"), "give one contraction or cortex"),
    (dict(outcome="top.area_um2", of="cortex.apical", by="face"), 'by: \'face\'; give "cell"'),
    (dict(outcome="top.area_um2", of="elasticity.young_modulus_Pa", at_min=0.7), "no step ends at 0.7 min"),
    (dict(outcome=np.ones((3, 3)), of="elasticity.young_modulus_Pa"), "give a gradient of shape"),
    (dict(outcome=lambda x: x, of="elasticity.young_modulus_Pa"), "return its value and its gradient"),
]


@pytest.mark.parametrize("arguments, message", WRONG)
def test_bad_arguments_are_told(tape, arguments, message):
    arguments = dict(arguments)
    with pytest.raises(ValueError) as raised:
        tape.gradient(arguments.pop("outcome"), **arguments)
    assert message in str(raised.value)


REFUSED = [
    ({"cortex.apical.trigger": {"measure": "apical_area_ratio", "below": 0.9}}, "cortex.apical: a jump at a time given by a trigger"),
    ({"cortex.apical.follow": {"measure": "stress_Pa", "from": 0, "to": 9}}, "cortex.apical: activity by stress has no"),
    ({"signal.u": {"initial": 0.1}, "cortex.apical.trigger": {"signal": "u", "above": 0.5}}, "cortex.apical: a trigger by a signal has no"),
    ({"dynamics.density_kg_per_m3": 1000, "time.integrator": "backward-euler"}, "inertia: this law has no derivatives yet"),
    ({"time.scheme": "linearly-implicit", "volume.method": "projection"}, "only Newton's steps"),
]


@pytest.mark.parametrize("changes, message", REFUSED)
def test_what_has_no_derivatives_refuses_by_name(changes, message):
    scenario = plica.Scenario(BLOCK)
    scenario.update(changes)
    with pytest.raises(ValueError) as raised:
        plica.record(scenario)
    assert message in str(raised.value)


def test_strengths_are_checked():
    with pytest.raises(ValueError, match="one number per cell"):
        plica.record(BLOCK, strengths={"cortex.apical": [1, 2]})
    with pytest.raises(ValueError, match="the strength of cell 1 is -1"):
        plica.record(BLOCK, strengths={"cortex.apical": [1, -1, 1, 1, 1, 1]})


def test_threads_give_the_same_bits(tape):
    other = plica.record(BLOCK, at_min=0.5, threads=3)
    one, three = (t.gradient("top.area_um2", of="cortex.apical", by="cell") for t in (tape, other))
    assert np.array_equal(one, three)
