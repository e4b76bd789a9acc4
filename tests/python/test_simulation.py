"""The simulation from Python: the same bits as the command line's, and what Python people expect of an object."""
import copy
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import plica
import pytest

QUICK = {"time.end_min": 1}


def scenario(**changes):
    s = plica.Scenario("drosophila")
    s.update({**QUICK, **changes})
    return s


@pytest.fixture()
def sim():
    return plica.Simulation(scenario(), threads=1)


def program():
    return os.environ["PLICA"]


def test_steps_have_measures(sim):
    step = sim.step()
    assert step.time_s == sim.time_s > 0
    assert step.newton_iterations > 0 and step.volume_error < 1e-6
    assert step["furrow_depth_um"] == sim.measures["furrow_depth_um"]
    while not sim.finished:
        step = sim.step()
    assert sim.status == "end_time" and sim.time_min == 1 and sim.step() is None


def test_same_bits_and_files_as_the_command_line(tmp_path):
    run = plica.Simulation(scenario()).run(out=tmp_path / "python")
    subprocess.run([program(), "run", "drosophila", "--out", tmp_path / "program", "--quiet", "--set", "time.end_min=1"], check=True)
    names = sorted(p.relative_to(tmp_path / "program") for p in (tmp_path / "program").rglob("*") if p.is_file())
    assert names == sorted(p.relative_to(tmp_path / "python") for p in (tmp_path / "python").rglob("*") if p.is_file())
    same = [n for n in names if n.suffix in (".vtu", ".pvd", ".toml") or n.name in ("cells.csv", "midline.csv", "cross_section.csv")]
    assert len(same) > 6
    for name in same:
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name
    assert run.summary["furrow_depth_um"] == plica.open(tmp_path / "program").summary["furrow_depth_um"]


def test_a_run_that_loses_energy_warns(tmp_path):
    sim = plica.Simulation({"embryo": {"shape": "block", "cells": [1, 2, 1], "length_um": 8, "width_um": 16, "cell_height_um": 12},
                            "contraction": {"apical": {"region": "all", "stiffness_nN_per_um": 2}}, "time": {"step_s": 2}})
    with pytest.warns(UserWarning, match="time steps lose .* % of the energy .*; set time.step_s to \"adaptive\"") as warned:
        run = sim.run(out=tmp_path / "run")
    assert [str(one.message) for one in warned] == list(run.summary["warnings"].values()) and "energy_imbalance" in run.summary["warnings"]


def test_forces_are_of_now():
    """A cortex whose rest area flows within a second pulls as its mean tension says."""
    sim = plica.Simulation({"embryo": {"shape": "block", "cells": [1, 1, 1], "length_um": 10, "width_um": 10, "cell_height_um": 10},
                            "pressure": {"p": {"region": "all", "pressure_Pa": 300}},
                            "cortex": {"top": {"region": "all", "stiffness_mN_per_m": 1, "relaxation_s": 1}},
                            "time": {"end_min": 1, "step_s": 0.01, "integrator": "backward-euler"}, "dynamics": {"surface_drag_Pa_s_per_um": 1}}, threads=1)
    top, rest_area, r = sim.hexahedra[0][4:], 100, 0.01
    for _ in range(40):
        sim.step()
        a, b, c, d = sim.positions[top]
        area = np.linalg.norm(np.cross(c - a, d - b)) / 2
        rest_area = (rest_area + r * area) / (1 + r)
    tension = area / rest_area - 1
    assert tension > 0.02
    assert np.abs(sim.forces("cortex.top")[top, 0]) == pytest.approx(tension * np.sqrt(area) / 2, rel=1e-6)


def test_arrays(sim):
    sim.run(until_min=0.2)
    nodes, elements, cells = len(sim.positions), len(sim.hexahedra), len(sim.pressures)
    assert sim.positions.shape == sim.velocities.shape == sim.rest_positions.shape == (nodes, 3)
    assert sim.hexahedra.shape == (elements, 8) and sim.hexahedra.max() == nodes - 1
    assert sim.hexahedron_cell.shape == (elements,) and cells == 756
    assert sim.regions["furrow"].dtype == bool and 0 < sim.regions["furrow"].sum() < cells
    pairs = sim.neighbours
    assert pairs.shape[1] == 2 and (pairs[:, 0] < pairs[:, 1]).all() and len(np.unique(pairs, axis=0)) == len(pairs)
    data = sim.cell_data
    assert all(len(values) == cells for values in data.values())
    assert np.allclose(data["pressure_Pa"], sim.pressures)
    with pytest.raises(ValueError):
        sim.positions[0] = 0
    before = sim.positions
    kept = before.copy()
    sim.step()
    assert np.array_equal(before, kept) and not np.array_equal(sim.positions, kept)
    del sim
    assert np.array_equal(before, kept)  # outlives the simulation


def test_a_periodic_sheet_has_six_neighbours_a_cell():
    sheet = {"shape": "sheet", "length_um": 40, "width_um": 50, "cell_count": 60, "cell_height_um": 10, "periodic": ["x", "y"]}
    sim = plica.Simulation({"format": 1, "embryo": sheet, "cortex": {"walls": {"region": "all", "faces": "lateral", "tension_mN_per_m": 1}}})
    assert len(sim.neighbours) == 3 * 60  # walls: each of two cells
    sim.step()
    forces = sim.forces("cortex.walls")
    assert np.allclose(forces.sum(axis=0), 0, atol=1e-9 * np.abs(forces).max())


def test_forces_and_energies(sim):
    sim.run(until_min=0.5)
    assert "contraction.apical" in sim.laws
    pull = sim.forces("contraction.apical")
    assert pull.shape == sim.positions.shape and np.abs(pull).max() > 1
    assert np.allclose(pull.sum(axis=0), 0, atol=1e-9)
    energy = sim.energies
    active = sum(row["active"] for row in energy.values())
    assert active > 0 and active >= sum(row["stored"] for row in energy.values())
    with pytest.raises(ValueError, match="contraction.apical"):
        sim.forces("contraction.basal")


def test_copies_go_their_own_ways(sim):
    sim.run(until_min=0.3)
    fork, twin = sim.copy(), copy.deepcopy(sim)
    fork.set_activity("apical", 0)
    for one in (sim, fork, twin):
        one.run()
    assert np.array_equal(sim.positions, twin.positions)
    assert sim.measures["furrow_depth_um"] > fork.measures["furrow_depth_um"] + 0.1


@pytest.mark.parametrize("way", ["pickle", "file"])
def test_saved_goes_on_to_the_same_bits(sim, tmp_path, way):
    sim.run(until_min=0.3)
    x = sim.cell_data["x_um"]
    sim.set_activity("apical", np.where(x > 0, 0.5, np.nan))
    sim.step()
    if way == "pickle":
        again = pickle.loads(pickle.dumps(sim))
    else:
        sim.save(tmp_path / "moment.h5")
        again = plica.load(tmp_path / "moment.h5", threads=1)
        assert list(tmp_path.iterdir()) == [tmp_path / "moment.h5"]
    assert again.time_s == sim.time_s and again.measures == sim.measures
    sim.run()
    again.run()
    assert np.array_equal(sim.positions, again.positions) and np.array_equal(sim.velocities, again.velocities)


def test_a_fork_may_be_recorded(sim, tmp_path):
    sim.run(until_min=0.3)
    fork = sim.copy()
    fork.set_activity("apical", 0)
    run = fork.run(out=tmp_path / "fork")
    series = run.series
    assert series["time_s"].iloc[0] == pytest.approx(18) and series["time_s"].iloc[-1] == 60
    assert run.frames[0].time_s == pytest.approx(18) and run.status == "end_time"
    # And gone on with, told what it was told.
    again = plica.load(tmp_path / "fork" / "checkpoint.h5")
    assert np.array_equal(again.activity("apical"), fork.activity("apical"), equal_nan=True)


def test_activity(sim):
    activity = sim.activity("contraction.apical")
    assert np.isnan(activity).sum() == (~sim.regions["furrow"]).sum()
    sim.set_activity("apical", 0.5)
    assert np.nanmax(sim.activity("apical")) == 0.5
    sim.set_activity("apical", None)
    assert np.array_equal(sim.activity("apical"), activity, equal_nan=True)
    for wrong in ([1, 2], -1.0, np.full(756, np.inf), "much"):
        with pytest.raises(ValueError):
            sim.set_activity("apical", wrong)
    with pytest.raises(ValueError, match="contraction.apical"):
        sim.set_activity("basal", 1.0)


def test_callback_and_progress(sim, capfd):
    seen = []
    sim.run(progress=True, callback=lambda s, step: seen.append(step.time_s) or len(seen) == 3)
    assert len(seen) == 3 and sim.steps == 3
    assert "depth 0.0 µm" in capfd.readouterr().err


def test_time_left_in_words(sim):
    left = sim._core.time_left(np.inf)
    assert left.text == ""
    for _ in range(10):
        step = sim.step()
        left.add(10 * step.time_s, step.time_s, step["max_node_speed_um_per_s"])
    assert left.text.startswith("about ") and left.text.endswith(" left")


def test_record_resumes(tmp_path):
    plica.Simulation(scenario()).run(out=tmp_path / "whole")
    plica.Simulation(scenario()).run(out=tmp_path / "parts", until_min=0.4)
    with pytest.raises(plica.FileError, match="overwrite"):
        plica.Simulation(scenario()).run(out=tmp_path / "parts")
    plica.Simulation(scenario()).run(out=tmp_path / "parts", resume=True)
    a, b = plica.open(tmp_path / "whole"), plica.open(tmp_path / "parts")
    assert a.status == b.status == "end_time"
    assert 24 in b.series["time_s"].tolist() and b.summary["steps"] == len(b.series) - 1
    # Steps end elsewhere, so not to the bit: by the tolerance of a step.
    assert np.abs(a.frames[-1].points - b.frames[-1].points).max() < 0.05
    # What is finished is left alone.
    sim = plica.Simulation(scenario())
    again = sim.run(out=tmp_path / "parts", resume=True)
    assert sim.steps == 0 and again.status == "end_time"
    sim.step()
    with pytest.raises(ValueError, match="a new Simulation"):
        sim.run(out=tmp_path / "parts", resume=True)


def test_numerics_give_up():
    s = scenario(**{"contraction.apical.stiffness_nN_per_um": 1e6, "contraction.apical.program": {"time_min": [0, 0.1], "activity": [0, 1]},
                    "volume.method": "none"})
    sim = plica.Simulation(s)
    with pytest.raises(plica.NumericsError) as caught:
        sim.run()
    assert caught.value.time_s == sim.time_s and sim.status == "failed" and sim.finished
    assert np.isfinite(sim.positions).all()
    assert str(caught.value) and pickle.loads(pickle.dumps(caught.value)).cell == caught.value.cell


def test_ctrl_c_saves_everything(tmp_path):
    s = plica.Scenario("drosophila")
    sim = plica.Simulation(s)
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        while True:
            sim.run(out=tmp_path / "run", overwrite=True)
            sim = plica.Simulation(s)
    run = plica.open(tmp_path / "run")
    assert run.summary["status"] == "interrupted" and len(run.series) > 1


def test_two_simulations_in_two_threads(sim):
    others = [plica.Simulation(scenario(), threads=2) for _ in range(2)]
    workers = [threading.Thread(target=one.run) for one in others]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    sim.run()
    for one in others:
        assert np.array_equal(sim.positions, one.positions)


def test_one_simulation_belongs_to_one_thread():
    sim = plica.Simulation("drosophila")
    failures = []

    def step():
        try:
            for _ in range(5):
                sim.step()
        except RuntimeError as error:
            failures.append(str(error))

    workers = [threading.Thread(target=step) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert failures and "another thread" in failures[0]


def test_python_goes_on_while_a_step_is_solved():
    s = plica.Scenario("drosophila")
    s["embryo.elements_per_cell"] = [2, 2, 2]
    sim = plica.Simulation(s, threads=1)
    ticks = []
    worker = threading.Thread(target=sim.step)
    worker.start()
    while worker.is_alive():
        ticks.append(time.monotonic())
        time.sleep(0.005)
    assert len(ticks) > 5


def _in_child(queue):
    sim = plica.Simulation(scenario(), threads=2)
    sim.run()
    queue.put(sim.positions)


def test_a_fork_after_use_does_not_hang(sim):
    first = plica.Simulation(scenario(), threads=2)
    first.run()
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_in_child, args=(queue,))
    child.start()
    positions = queue.get(timeout=60)
    child.join(timeout=60)
    assert child.exitcode == 0 and np.array_equal(positions, first.positions)


def test_looks(sim):
    sim.run(until_min=0.2)
    assert "drosophila" in repr(sim) and "12 s" in repr(sim)
    assert "furrow_depth_um" in sim._repr_html_()
    assert "Newton" in repr(sim.step())


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "two", 10_000])
def test_wrong_threads(threads):
    with pytest.raises(ValueError, match="threads"):
        plica.Simulation("drosophila", threads=threads)


def test_a_time_that_has_come(sim):
    sim.run(until_min=0.5)
    before = sim.steps
    assert sim.step(until_min=0.5) is None and sim.step(until_min=0.1) is None
    sim.run(until_min=0.2)
    assert sim.steps == before and sim.time_min == 0.5 and not sim.finished


def test_a_tissue_that_has_divided_is_saved_with_its_regions():
    s = plica.Scenario("division-demo")
    cells = len(plica.Simulation(s).pressures)
    s.set_region("some", np.arange(cells) < 3)
    sim = plica.Simulation(s)
    while len(sim.pressures) == cells:
        assert sim.step() is not None
    again = pickle.loads(pickle.dumps(sim))
    assert np.array_equal(again.positions, sim.positions) and again.regions["some"].sum() >= 3


def test_wrong_times(sim):
    for wrong in (float("nan"), "soon", True):
        with pytest.raises(ValueError, match="until_min"):
            sim.run(until_min=wrong)
    with pytest.raises(ValueError, match="out"):
        sim.run(resume=True)


def test_signals_are_read_and_written():
    sim = plica.Simulation({"embryo": {"shape": "sheet", "length_um": 30, "width_um": 30, "cell_height_um": 10, "cell_count": 20},
                            "dynamics": {"surface_drag_Pa_s_per_um": 30}, "time": {"end_min": 2}, "stop": {"at_equilibrium": False},
                            "signal": {"u": {"decay_per_min": 0.5}, "v": {"initial": 2, "reaction": "k * u", "constants": {"k": 3}}},
                            "cortex": {"a": {"region": "all", "tension_mN_per_m": 1, "follow": {"signal": "u", "from": 0, "to": 1}}}})
    assert set(sim.signals) == {"u", "v"} and (sim.signals["v"] == 2).all()
    with pytest.raises(ValueError, match='no signal "w"; signals: u, v'):
        sim.signals["w"] = 1
    with pytest.raises(ValueError, match="signals"):
        sim.signals["u"] = [1, 2]
    with pytest.raises(ValueError, match="finite"):
        sim.signals["u"] = np.nan
    sim.signals["u"] = sim.cell_data["x_um"] > 0
    assert (sim.activity("cortex.a") == sim.signals["u"]).all() and sim.signals["u"].sum() > 5
    fork = pickle.loads(pickle.dumps(sim))
    sim.run(), fork.run()
    assert (sim.signals["u"] == fork.signals["u"]).all() and (sim.cell_data["signal_u"] == sim.signals["u"]).all()
    assert sim.signals["u"].max() == pytest.approx(np.exp(-1)) and sim.signals["v"].max() > 4
    with pytest.raises(TypeError, match="signals: arrays cannot be removed"):
        del sim.signals["u"]


def test_walls_are_read_and_their_factors_written(tmp_path):
    pandas = pytest.importorskip("pandas")
    sim = plica.Simulation({"embryo": {"shape": "sheet", "length_um": 30, "width_um": 30, "cell_height_um": 10, "cell_count": 20},
                            "dynamics": {"surface_drag_Pa_s_per_um": 30}, "time": {"end_min": 0.5}, "stop": {"at_equilibrium": False},
                            "cortex": {"a": {"region": "all", "tension_mN_per_m": 1},
                                       "walls": {"region": "all", "faces": "lateral", "tension_mN_per_m": 0.5}}})
    walls = sim.walls
    between = walls[walls["other"] >= 0]
    assert np.array_equal(np.column_stack([between["cell"], between["other"]]), sim.neighbours)
    assert len(np.unique(walls[["cell", "other"]])) == len(walls) and (walls["cell"] < 20).all() and (walls["other"] == -1).any()
    assert np.allclose(between["area_um2"], 10 * between["length_um"]) and np.allclose(walls["tension_mN_per_m"], 0.5)
    assert list(pandas.DataFrame(walls)) == list(walls.dtype.names) and not walls.flags.writeable
    assert (sim.wall_factors("walls") == 1).all()

    weak = np.where(walls["length_um"] < np.median(walls["length_um"]), 0.5, 2.0)
    sim.set_wall_factors("cortex.walls", weak)
    assert (sim.wall_factors("walls") == weak).all() and np.allclose(sim.walls["tension_mN_per_m"], 0.5 * weak)
    sim.step()
    sim.save(tmp_path / "saved.h5")
    forks = [sim.copy(), pickle.loads(pickle.dumps(sim)), plica.load(tmp_path / "saved.h5")]
    plain = sim.copy()
    plain.set_wall_factors("walls", None)
    for one in (sim, plain, *forks):
        one.run()
    assert all((one.positions == sim.positions).all() and (one.wall_factors("walls") == weak).all() for one in forks)
    assert abs(plain.positions - sim.positions).max() > 0.01 and (plain.wall_factors("walls") == 1).all()
    sim.set_wall_factors("walls", 3)
    assert (sim.wall_factors("walls") == 3).all()
    for law, factors, text in (("a", 1, "cortex.a"), ("apical", 1, "cortex.walls"), ("walls", [1, 2], "one number per wall"),
                               ("walls", -1, "give a number >= 0"), ("walls", np.nan, "is nan"), ("walls", "x", "one number per wall")):
        with pytest.raises(ValueError, match=text):
            sim.set_wall_factors(law, factors)


def test_arrays_of_ones_own_are_kept(sim, tmp_path):
    signal = np.random.default_rng(1).random(756)
    sim.cell_data["signal"] = signal
    assert (sim.cell_data["signal"] == signal).all() and (sim.cells["signal"] == signal).all()

    def grow(one, step):
        one.cell_data["signal"] = one.cell_data["signal"] + 1

    run = sim.run(out=tmp_path / "run", callback=grow)
    first, last = (frame.cell_data["signal"] for frame in (run.frames[0], run.frames[-1]))
    assert np.allclose(first, signal) and np.allclose(last, signal + sim.steps - 1)  # assigned before its step
    for other in (sim.copy(), pickle.loads(pickle.dumps(sim)), plica.load(tmp_path / "run" / "checkpoint.h5")):
        assert np.allclose(other.cell_data["signal"] % 1, signal)
    data = sim.cell_data
    data |= {"more": 2}
    assert (sim.cell_data["more"] == 2).all() and type(copy.deepcopy(data)) is dict
    with pytest.raises(TypeError, match="cannot be removed"):
        del data["more"]


def test_arrays_of_ones_own_go_on_with_a_run(tmp_path):
    first = plica.Simulation(scenario())
    first.cell_data["signal"] = np.arange(756)
    first.run(out=tmp_path / "run", until_min=0.4)
    again = plica.Simulation(scenario())
    run = again.run(out=tmp_path / "run", resume=True)
    assert run.status == "end_time" and (run.frames[-1].cell_data["signal"] == np.arange(756)).all()


@pytest.mark.parametrize("name, values, said", [
    ("signal", np.ones(3), r"cell_data\['signal'\]: .*\(3,\); give one number per cell \(756\)"),
    ("signal", np.full(756, np.nan), "cell 0 is nan; give a finite number"),
    ("signal", ["a"] * 756, "one number per cell"),
    ("signal", None, "None"),
    ("x_um", 1, "is an output variable"),
    (3, 1, "give a str"),
])
def test_arrays_that_do_not_fit_are_refused(sim, name, values, said):
    with pytest.raises((ValueError, TypeError), match=said):
        sim.cell_data[name] = values
    assert "signal" not in sim.cell_data


def test_a_warning_is_shown_once_a_process():
    code = ("import logging, plica\n"
            "logging.basicConfig(format='%(message)s')\n"
            "s = plica.Scenario('division-demo'); s['time.end_s'] = 6\n"
            "sims = [plica.Simulation(s), plica.Simulation(s), plica.Simulation(s).copy()]\n")
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stderr.splitlines()
    assert len(told) == len(set(told)) > 0, told
