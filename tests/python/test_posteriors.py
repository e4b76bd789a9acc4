"""Posteriors, compared with those of which everything is known."""
import numpy as np
import pytest

import plica
from plica.posteriors import _about, _proposed, population_monte_carlo

from filled_studies import DEPTH, MATRIX, POISSON, SD, TARGETS, TRUTH, YOUNG, filled, linear, no_figure_stays_open, source, texts_of  # noqa: F401


def hold_against_the_exact_one(found, tolerance):
    """Of a linear model with normal errors and an even prior: normal, with a known mean and covariance."""
    size = np.array([800, 0.2])
    covariance = np.linalg.inv(MATRIX.T @ np.diag(1 / SD**2) @ MATRIX) * np.outer(size, size)
    deviation = np.sqrt(np.diag(covariance))
    assert (abs(found.mean - (TRUTH * size + [400, 0.2])) < tolerance * deviation).all()
    assert (abs(found.covariance - covariance) < 2 * tolerance * np.outer(deviation, deviation)).all(axis=None)


def test_posterior_of_a_linear_model():
    pytest.importorskip("sklearn")
    found = plica.posterior(linear(32), targets=TARGETS)
    assert len(str(found).splitlines()) == 3 + len(found.keys) + len(TARGETS)
    assert f"{found.mean.iloc[0]:.4g}" in repr(found) and DEPTH in repr(found)
    assert found.effective_size > 1000 and found.samples.weight.sum() == pytest.approx(1)
    hold_against_the_exact_one(found, 0.1)
    assert np.allclose(found.targets["mean"], found.targets.value, atol=0.1) and np.allclose(found.targets.posterior_sd, SD, rtol=0.1)
    assert plica.posterior(linear(32), targets=TARGETS).samples.equals(found.samples)
    figure = found.plot()
    assert len(figure.axes) == 4 and any("Pa" in text for text in texts_of(figure))


def test_posterior_on_runs():
    found = plica.posterior(linear(4096), targets=TARGETS, on="runs")
    hold_against_the_exact_one(found, 0.2)
    assert 100 < found.effective_size < 300
    with pytest.warns(UserWarning, match="effective samples; take more runs"):
        plica.posterior(linear(64), targets=TARGETS, on="runs")


def test_posterior_with_a_boundary_and_an_answer_that_does_not_exist():
    pytest.importorskip("sklearn")
    study = linear(32)
    found = plica.posterior(study, {YOUNG: (400, 700)}, {DEPTH: TARGETS[DEPTH]})
    assert found.samples[YOUNG].between(400, 700).all() and found.ranges[POISSON][:2] == (0.2, 0.4)
    with pytest.warns(UserWarning, match="furrow_depth_um is .* no values"):
        plica.posterior(study, targets={DEPTH: (60, 1)})


def test_samples_around_two_peaks():
    """Each of half the weight; neither is lost."""
    def log_likelihood(places):
        peaks = [-0.5 * (((places - centre) / 0.03) ** 2).sum(axis=1) for centre in ([0.2, 0.3], [0.8, 0.7])]
        return np.logaddexp(*peaks)

    places, logs = population_monte_carlo(log_likelihood, 2, 4000, np.random.default_rng(3))
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    first = places[:, 0] < 0.5
    assert abs(weights[first].sum() - 0.5) < 0.05 and 1 / (weights**2).sum() > 400
    assert np.allclose(weights[first] @ places[first] / weights[first].sum(), [0.2, 0.3], atol=0.003)


def test_the_density_of_proposals_is_one():
    """The mean of 1 over it, in a part of the cube, is the volume of that part; also where much that is drawn falls outside."""
    random = np.random.default_rng(4)
    places = random.random((4000, 2))
    places[:12] *= 0.1  # twelve samples in a corner, and so wide distributions around them
    drawn, log_density = _proposed(places, np.where(np.arange(4000) < 12, 1 / 12, 0), random)
    corner = (drawn < 0.1).all(axis=1)
    assert np.exp(-log_density).mean() == pytest.approx(1, rel=0.1)
    assert (corner * np.exp(-log_density)).mean() == pytest.approx(0.01, rel=0.05)


def test_posterior_at_the_edge_of_the_prior():
    """Half a normal distribution: mean sqrt(2/π) sd."""
    places, logs = population_monte_carlo(lambda p: -0.5 * (p[:, 0] / 0.05) ** 2, 1, 4000, np.random.default_rng(2))
    weights = np.exp(logs - logs.max())
    assert np.average(places[:, 0], weights=weights) == pytest.approx(0.05 * np.sqrt(2 / np.pi), rel=0.03)


def test_posterior_of_a_scenario():
    """Runs 16 embryos, each for a few steps."""
    pytest.importorskip("sklearn")
    scenario = plica.Scenario("division-demo")
    scenario["time.end_min"] = 0.5
    found = plica.posterior(scenario, {YOUNG: (300, 1500)}, {"max_volume_error": (1e-9, 1.0)}, runs=8, jobs=1)
    assert len(found.samples) == 10000 and found.mean[YOUNG] == pytest.approx(900, rel=0.05)


BLOCK = {"embryo": {"shape": "block", "length_um": 60, "width_um": 40, "cell_height_um": 20, "cells": [3, 2, 1], "elements_per_cell": [1, 1, 2]},
         "cortex": {"top": {"region": "all", "tension_mN_per_m": 2}}, "time": {"end_s": 60}, "stop": {"at_equilibrium": False},
         "monitor": {"top": {"quantity": "area", "over": "sum"}}}


def test_posterior_by_gradients():
    """Of one key, against a sum over its values; and of a second key that the target leaves open."""
    key, area = "cortex.top.tension_mN_per_m", "top.area_um2"

    def area_at(tension):
        sim = plica.Simulation({**BLOCK, "cortex": {"top": {"region": "all", "tension_mN_per_m": float(tension)}}})
        sim.run()
        return sim.measures[area]

    tensions, target = np.linspace(1.5, 4, 201), (area_at(2.5), 40.0)
    few = np.linspace(1.5, 4, 9)
    areas = np.polynomial.Polynomial.fit(few, [area_at(one) for one in few], 6)(tensions)
    weights = np.exp(-0.5 * ((areas - target[0]) / target[1]) ** 2)
    weights /= weights.sum()
    mean, sd = weights @ tensions, np.sqrt(weights @ tensions**2 - (weights @ tensions) ** 2)
    found = plica.posterior(plica.Scenario(BLOCK), {key: (1.5, 4)}, {area: target}, on="gradients", jobs=1)
    assert found.effective_size > 120
    assert found.mean[key] == pytest.approx(mean, abs=0.25 * sd) and np.sqrt(found.covariance.loc[key, key]) == pytest.approx(sd, rel=0.2)
    # The area depends on the ratio of tension and stiffness, so both are known less well than the ratio.
    both = plica.posterior(plica.Scenario(BLOCK), {key: (1.5, 4), YOUNG: (800, 1250)}, {area: target}, on="gradients", runs=120, jobs=1)
    spread = np.sqrt(np.diag(both.covariance))
    assert both.effective_size > 40 and spread[0] > 1.5 * sd and spread[1] > 90
    assert both.covariance.loc[key, YOUNG] > 0.5 * spread.prod()


def test_posteriors_by_gradients_that_are_none():
    with pytest.raises(ValueError, match="has no gradient; those with a gradient"):
        plica.posterior(plica.Scenario(BLOCK), {YOUNG: (400, 1200)}, {"max_volume_error": (0, 1)}, on="gradients")
    with pytest.raises(ValueError, match="give a scenario instead of a study"):
        plica.posterior(linear(32), targets=TARGETS, on="gradients")


@pytest.mark.parametrize("key, message", [
    ("elasticity.young_modulus", "keys: elasticity.young_modulus: has no value in this scenario; nearest matches: elasticity.young_modulus_Pa, "),
    ("cortex.top.region", "keys: cortex.top.region is 'all'; choose keys that have a number"),
    ("cortex.top.relaxation_s", "keys: cortex.top.relaxation_s is 'none'; choose keys that have a number"),
])
def test_wrong_keys_of_posteriors_by_gradients_are_told(key, message):
    with pytest.raises(ValueError) as raised:
        plica.posterior(plica.Scenario(BLOCK), {key: (400, 1200)}, {"top.area_um2": (2400, 100)}, on="gradients")
    assert message in str(raised.value)


def test_remedies_of_a_target_without_a_gradient_help():
    """The emulator, and another monitor."""
    pytest.importorskip("sklearn")
    without = {**BLOCK, "monitor": {"top": {"quantity": "apical_elongation"}}}
    with pytest.raises(ValueError) as raised:
        plica.posterior(plica.Scenario(without), {YOUNG: (400, 1200)}, {"top.apical_elongation": (1.05, 0.1)}, on="gradients")
    assert str(raised.value).endswith('or surface_distance, or give on="emulator"') and "function" not in str(raised.value)
    with pytest.warns(UserWarning):
        assert plica.posterior(plica.Scenario(without), {YOUNG: (400, 1200)}, {"top.apical_elongation": (1.05, 0.1)}, runs=8, samples=50, jobs=1)
    mean = {**BLOCK, "monitor": {"top": {"quantity": "area", "over": "mean"}}}
    with pytest.warns(UserWarning):
        assert plica.posterior(plica.Scenario(mean), {YOUNG: (400, 1200)}, {"top.area_um2": (390, 20)}, on="gradients", runs=10, jobs=1)


def test_the_density_about_a_fit_is_one():
    """The mean of 1 over it is the volume of the cube, and of a part of it; also where half of what is drawn falls outside."""
    places, logs = _about(np.array([0.02, 0.5]), np.array([[0.01, 0.004], [0.004, 0.02]]), 20000, np.random.default_rng(5))
    assert np.exp(-logs).mean() == pytest.approx(1, rel=0.05)
    part = (places < [0.2, 0.6]).all(axis=1)
    assert (part * np.exp(-logs)).mean() == pytest.approx(0.12, rel=0.05)


@pytest.mark.parametrize("arguments, told", [
    ({"targets": {}}, "sd > 0"), ({"targets": {DEPTH: (1, 0)}}, "sd > 0"), ({"on": "run"}, "emulator"),
    ({"keys": {"yolk": (0, 1)}}, "yolk does not vary"), ({"keys": {YOUNG: (100, 500)}}, "the study covers 400 to 1200"),
    ({"keys": {YOUNG: (900, 500)}}, "900 to 500; give finite bounds, the lower one first"),
])
def test_posteriors_that_are_none(arguments, told):
    with pytest.raises(ValueError, match=told):
        plica.posterior(linear(32), **{"targets": TARGETS, **arguments})


def test_runs_that_are_no_prior():
    with pytest.raises(ValueError, match="do not follow the prior"):
        plica.posterior(filled(source({YOUNG: {"values": [400, 500]}})), targets={DEPTH: (1, 1)}, on="runs")
    with pytest.raises(ValueError, match="normal distribution"):
        plica.posterior(filled(source({YOUNG: {"mean": 500, "sd": 10}}, "sobol", points=8)), targets={DEPTH: (1, 1)}, on="runs")
