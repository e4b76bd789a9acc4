"""plica.jax and plica.torch: gradients of runs inside other programs, and a network that learns where cells contract."""
import numpy as np
import plica
import pytest
from plica.differentiable import Run

LAW, KEYS, TIMES = "cortex.apical", ["cortex.apical.tension_mN_per_m", "elasticity.young_modulus_Pa"], [0.5, 1]
BLOCK = {"embryo": {"shape": "block", "length_um": 32, "width_um": 32, "cell_height_um": 10, "cells": [4, 4, 1]},
         "cortex": {"apical": {"region": "all", "tension_mN_per_m": 1, "saturation_ratio": 0.2}},
         "time": {"end_min": 1}, "stop": {"at_equilibrium": False}}
FACTORS = np.linspace(0.7, 1.3, 16)


def loss_and_slope(at_min):
    """Return the loss sum(weights * positions**2) and its gradient by factors, from the tape itself."""
    tape = plica.record(BLOCK, at_min=TIMES, strengths={LAW: FACTORS})
    positions = np.stack([tape.positions(time) for time in at_min])
    weights = np.random.default_rng(0).normal(size=positions.shape)
    return weights, (weights * positions**2).sum(), tape.gradient(2 * weights * positions, of=LAW, by="cell", at_min=at_min)


def test_jax_has_the_gradient_of_the_tape():
    jax = pytest.importorskip("jax")
    import plica.jax

    jax.config.update("jax_enable_x64", True)
    weights, value, slope = loss_and_slope(TIMES)
    run = plica.jax.positions(BLOCK, of=LAW, by="cell", at_min=TIMES)
    for loss in (lambda factors: (weights * run(factors) ** 2).sum(), jax.jit(lambda factors: (weights * run(factors) ** 2).sum())):
        found, gradient = jax.value_and_grad(loss)(jax.numpy.array(FACTORS))
        assert float(found) == pytest.approx(value, rel=1e-12) and np.asarray(gradient) == pytest.approx(slope, rel=1e-6)
    by_key = jax.grad(lambda values: plica.jax.positions(BLOCK, of=KEYS)(values)[:, 2].max())(jax.numpy.array([1.5, 800.0]))
    changed = plica.Scenario(BLOCK)
    changed.update(dict(zip(KEYS, [1.5, 800])))
    tape = plica.record(changed)
    top = np.zeros_like(tape.positions())
    top[tape.positions()[:, 2].argmax(), 2] = 1
    assert np.abs(np.asarray(by_key)) == pytest.approx(np.abs(tape.gradient(top, of=KEYS)), rel=1e-6)


def test_a_network_learns_where_cells_contract():
    jax = pytest.importorskip("jax")
    import plica.jax

    jnp = jax.numpy
    jax.config.update("jax_enable_x64", True)
    cells = plica.Simulation(BLOCK).cell_data
    places = jnp.stack([cells["x_um"], cells["y_um"]], axis=1) / 16
    run = plica.jax.positions(BLOCK, of=LAW, by="cell")
    wanted = run(1 + 0.4 * jnp.sin(2 * places[:, 0]))
    random = np.random.default_rng(1)
    weights = [jnp.array(random.normal(size=shape) * 0.5) for shape in ((2, 6), (6,), (6,))]

    def loss(weights):
        first, bias, last = weights
        return ((run(jnp.exp(jnp.tanh(places @ first + bias) @ last)) - wanted) ** 2).mean()

    values = []
    for _ in range(40):
        value, slope = jax.value_and_grad(loss)(weights)
        values.append(float(value))
        weights = [one - 0.5 * by / max(np.sqrt(value), 0.05) for one, by in zip(weights, slope)]
    assert min(values) < 0.05 * values[0]


def test_torch_has_the_gradient_of_the_tape():
    torch = pytest.importorskip("torch")
    import plica.torch

    weights, value, slope = loss_and_slope([1])
    run = plica.torch.positions(BLOCK, of=LAW, by="cell")
    factors = torch.tensor(FACTORS, requires_grad=True)
    loss = (torch.from_numpy(weights[0]) * run(factors) ** 2).sum()
    loss.backward()
    assert loss.item() == pytest.approx(value, rel=1e-6) and factors.grad.numpy() == pytest.approx(slope, rel=1e-4)


def test_a_gradient_needs_no_second_run(monkeypatch):
    made = []
    monkeypatch.setattr("plica.differentiable.record", lambda *given, **more: made.append(1) or plica.record(*given, **more))
    run = Run(BLOCK, LAW, "cell", TIMES)
    assert run.positions(FACTORS).shape == run.shape == (2, 50, 3)
    run.pull_back(FACTORS, np.ones(run.shape))
    assert len(made) == 1
    run.positions(FACTORS + 0.1)
    assert len(made) == 2
    with pytest.raises(ValueError, match=r"argument of shape \(3,\); give one of shape \(16,\)"):
        run.positions(np.ones(3))
    with pytest.raises(ValueError, match='by: \'node\'; give "cell"'):
        Run(BLOCK, LAW, "node")


@pytest.mark.parametrize("name", ["jax", "torch"])
def test_a_missing_framework_is_told(name, monkeypatch):
    import importlib

    module = importlib.import_module(f"plica.{name}")
    monkeypatch.setitem(__import__("sys").modules, name, None)
    with pytest.raises(plica.MissingExtra, match=f"pip install {name}"):
        module.positions(BLOCK, of=LAW, by="cell")
