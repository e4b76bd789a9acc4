"""Studies from Python: the same rows whoever runs them."""
import os
import signal
import subprocess
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import pandas as pd
import pytest

import plica

# A coarse embryo.
SET = {"time.end_min": 1, "embryo.cells": [12, 7, 6], "region.furrow.cells_along": 8, "region.furrow.cells_across": 3, "furrow.vce_cell": 1}
SETTINGS = "\n".join(f'"{key}" = {value}' for key, value in SET.items())
STUDY = f"""
format = 1
scenario = "drosophila"
[set]
{SETTINGS}
[vary]
"elasticity.young_modulus_Pa" = {{ low = 400, high = 1200 }}
"elasticity.poisson_ratio" = {{ values = [0.3, 0.45] }}
[design]
kind = "sobol"
points = 8
seed = 3
[keep]
measures = ["furrow_depth_um", "max_volume_error", "lips_closed_time_s"]
"""


def same(a, b):
    return a.drop(columns="wall_s").equals(b.drop(columns="wall_s"))


@pytest.fixture(scope="module")
def table():
    return plica.Study(STUDY).run(jobs=1)


def test_the_table(table):
    assert list(table.columns) == ["point", "elasticity.young_modulus_Pa", "elasticity.poisson_ratio", "replicate", "status",
                                   "furrow_depth_um", "max_volume_error", "lips_closed_time_s", "steps", "wall_s", "reason"]
    assert table.point.tolist() == list(range(1, 9)) and (table.status == "end_time").all()
    assert table["elasticity.young_modulus_Pa"].between(400, 1200).all() and table.furrow_depth_um.nunique() == 8
    assert table["elasticity.poisson_ratio"].value_counts().to_dict() == {0.3: 4, 0.45: 4}
    assert table.lips_closed_time_s.isna().all()


def test_a_row_is_what_the_run_says(table):
    scenario = plica.Scenario("drosophila")
    scenario.update({**SET, "elasticity.young_modulus_Pa": table["elasticity.young_modulus_Pa"][2],
                     "elasticity.poisson_ratio": table["elasticity.poisson_ratio"][2]})
    sim = plica.Simulation(scenario, threads=1)
    sim.run()
    assert table.furrow_depth_um[2] == sim.measures["furrow_depth_um"]


def test_processes_executors_and_the_command_line_give_the_same_rows(table, tmp_path):
    assert same(plica.Study(STUDY).run(jobs=2), table)
    with ThreadPoolExecutor(2) as threads:
        assert same(plica.Study(STUDY).run(executor=threads), table)
    import multiprocessing

    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as processes:
        assert same(plica.Study(STUDY).run(executor=processes), table)
    (tmp_path / "a.toml").write_text(STUDY)
    subprocess.run([os.environ["PLICA"], "study", tmp_path / "a.toml", "--out", tmp_path / "out", "--quiet"], check=True)
    assert same(pd.read_csv(tmp_path / "out/runs.csv", float_precision="round_trip"), table)
    opened = plica.Study(tmp_path / "out")
    assert same(opened.table, table) and repr(opened) == repr(plica.Study(tmp_path / "a.toml"))


def test_a_process_that_is_killed_costs_its_run_only(table):
    study = plica.Study(STUDY)
    killed = []

    def kill():
        while not killed:
            children = subprocess.run(["pgrep", "-P", str(os.getpid())], capture_output=True, text=True).stdout.split()
            workers = [c for c in children if "plica.study_workers" in Path(f"/proc/{c}/cmdline").read_text().replace("\0", " ")]
            if len(workers) == 2:
                time.sleep(0.2)
                os.kill(int(workers[0]), signal.SIGKILL)
                killed.append(workers[0])
            time.sleep(0.02)

    thread = threading.Thread(target=kill)
    thread.start()
    found = study.run(jobs=2)
    thread.join()
    assert killed and same(found, table)


def test_what_is_in_a_directory_goes_on(table, tmp_path):
    study = plica.Study(STUDY)
    study.run(out=tmp_path / "s", jobs=1)
    # Its page, where this plica can make one.
    told = subprocess.run([os.environ["PLICA"], "report", tmp_path / "s", "--out", tmp_path / "s.html"], capture_output=True, check=False)
    assert (tmp_path / "s/report.html").exists() == (told.returncode == 0)
    with pytest.raises(ValueError, match="contains a study; continue it with resume=True, replace it with overwrite=True, or give another out$"):
        plica.Study(STUDY).run(out=tmp_path / "s")
    (rows,) = (tmp_path / "s/rows").iterdir()
    text = rows.read_text()
    rows.write_text(text[: len(text) // 2])  # what a kill leaves: three rows and a half
    again = plica.Study(STUDY)
    assert same(again.run(out=tmp_path / "s", resume=True, progress=True), table)
    plica.Study(STUDY + "# a word\n").run(out=tmp_path / "s", resume=True)
    assert len(list((tmp_path / "s/rows").iterdir())) == 2
    with pytest.raises(ValueError, match="has changed since its start: design.seed was 3 and is now 4; .*overwrite=True"):
        plica.Study(STUDY.replace("seed = 3", "seed = 4")).run(out=tmp_path / "s", resume=True)


def test_a_line_of_progress_says_what_is_left(capsys):
    from plica.study import _Line

    line = _Line(4, 1)
    line.start -= 10
    line.update()
    line.close()
    assert "2 of 4 runs, 20 s left" in capsys.readouterr().err


def test_as_an_array(table):
    pytest.importorskip("xarray")
    study = plica.Study({
        "scenario": "division-demo", "set": {"time.end_min": 0.5}, "design": {"kind": "grid"},
        "vary": {"elasticity.young_modulus_Pa": {"values": [500, 1000]}, "elasticity.poisson_ratio": {"values": [0.3, 0.4, 0.45]}},
    })
    study.run(jobs=2)
    data = study.to_xarray()
    assert dict(data.sizes) == {"elasticity.young_modulus_Pa": 2, "elasticity.poisson_ratio": 3}
    assert data.max_volume_error.shape == (2, 3)
    assert dict(plica.Study(STUDY).to_xarray().sizes) == {"point": 8}


@pytest.mark.parametrize("change, told", [
    (("young_modulus_Pa", "young_modulus"), "young_modulus_Pa"), (("\"sobol\"", "\"sobbol\""), "use \"sobol\""),
    (("\"drosophila\"", "\"drosophil\""), "neither"), (("seed = 3", "seed = 3\nreplicates = 4"), "nothing is random"),
])  # all others: StudyInput.WhatIsNoStudySaysWhere
def test_what_is_no_study(change, told):
    with pytest.raises(plica.ScenarioError, match=told):
        plica.Study(STUDY.replace(*change))
