"""plica calibrate --method gradient: what the program hands over to the package, what it writes and refuses."""
import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import plica
import pytest
from plica.__main__ import main
from plica.fit_files import read_targets

BLOCK = """
format = 1
embryo = {shape = "block", length_um = 60, width_um = 40, cell_height_um = 20, cells = [3, 2, 1]}
elasticity.young_modulus_Pa = 1000
cortex.apical = {region = "all", tension_mN_per_m = 2}
time.end_s = 60
stop.at_equilibrium = false
monitor.top = {quantity = "area", over = "sum"}
"""
APICAL, DRAG, TOP = "cortex.apical.tension_mN_per_m", "dynamics.surface_drag_Pa_s_per_um", "top.area_um2"
TRUTH = {APICAL: 4, DRAG: 300}
LIGHT = {"cortex.apical.program": {"time_s": [0, 6, 6], "activity": [1, 1, 0]}}
VARY = ["--vary", f"{APICAL}=0.5:8", "--vary", f"{DRAG}=30:900"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "block.toml").write_text(BLOCK)
    (tmp_path / "light.toml").write_text('base = "block.toml"\ncortex.apical.program = {time_s = [0, 6, 6], activity = [1, 1, 0]}\n')
    return tmp_path


def area_of(at_min, changes):
    scenario = plica.Scenario(BLOCK)
    scenario.update({**TRUTH, **changes})
    return plica.record(scenario, at_min=at_min, until_min=at_min).value(TOP, at_min=at_min)


def test_targets_of_two_scenarios(folder, capsys):
    (folder / "tables").mkdir()
    (folder / "tables/areas.csv").write_text(f"scenario,outcome,at_min,value,sd\n,{TOP},0.1,{area_of(0.1, {})},1\n"
                                      f"../light.toml,{TOP},0.2,{area_of(0.2, LIGHT)},1\n")
    words = ["calibrate", "block.toml", *VARY, "--targets", "tables/areas.csv", "--target", f"{TOP}={area_of(1, {})}~0.1%",
             "--out", "found.toml", "--folder", "kept"]
    assert main(words) == 0
    assert "Fit: converged" in capsys.readouterr().out
    fitted = plica.Scenario("found.toml")
    assert {key: fitted[key] for key in TRUTH} == pytest.approx(TRUTH, rel=5e-3)
    assert 'base = "block.toml"' in (folder / "found.toml").read_text()
    assert plica.Scenario("kept/light.toml").diff(fitted).keys() >= {"cortex.apical.program.time_s"}
    with open("kept/targets.csv") as stream:
        rows = list(csv.DictReader(stream))
    assert [(row["scenario"], row["at_min"]) for row in rows] == [("block", "0.1"), ("block", ""), ("light", "0.2")]
    assert all(abs(float(row["deviations"])) < 0.5 for row in rows)
    with open("kept/keys.csv") as stream:
        assert [row["key"] for row in csv.DictReader(stream)] == list(TRUTH)
    made = len((folder / "kept/runs.jsonl").read_text().splitlines())
    assert main([*words, "--overwrite"]) == 0 and len((folder / "kept/runs.jsonl").read_text().splitlines()) == made


def test_a_killed_command_continues(folder, capsys, monkeypatch):
    words = ["calibrate", "block.toml", "--vary", f"{APICAL}=0.5:8", "--target", f"{TOP}={area_of(1, {DRAG: 131})}~1", "--folder", "kept"]
    made = []

    def record(scenario, **more):
        made.append(scenario[APICAL])
        if len(made) == 3:
            raise KeyboardInterrupt
        return plica.record(scenario, **more)

    monkeypatch.setattr("plica.fit_problem.record", record)
    assert main(words) == 130
    assert "repeat the command to continue" in capsys.readouterr().err
    assert main(words) == 0 and made[2] == made[3] and len(set(made)) == len(made) - 1


def test_a_prior_and_a_bound_decide(folder):
    beyond, common = area_of(1, {DRAG: 131}), ["calibrate", "block.toml", "--vary", f"{APICAL}=1:3", "--overwrite", "--out", "found.toml"]
    assert main([*common, "--target", f"{TOP}={beyond}~1"]) == 1  # missed
    assert plica.Scenario("found.toml")[APICAL] == pytest.approx(3)
    known = ["--prior", f"{APICAL}=2~0.001", "--set", f"{DRAG}=200", "--trials", "10", "--starts", "2"]
    assert main([*common, "--target", f"{TOP}={beyond}~500", *known]) == 0
    found = plica.Scenario("found.toml")
    assert found[APICAL] == pytest.approx(2, rel=0.01) and found[DRAG] == 200


def test_a_scenario_of_python_is_written_whole(folder):
    found = plica.fit(BLOCK, {TOP: (area_of(1, {DRAG: 131}), 1)}, of={APICAL: (0.5, 8)}, folder=folder / "kept")
    assert plica.Scenario(folder / "kept/scenario.toml").diff(found.scenarios[0]) == {}
    assert json.loads((folder / "kept/runs.jsonl").read_text().splitlines()[0])


def test_changes_that_no_file_can_list_are_written_whole(folder):
    scenario = plica.Scenario("block.toml")
    scenario["cortex.apical.program"] = {"time_s": [0, 60], "activity": [1, 1]}
    scenario["cortex.apical.program.activity"] = [1, 0.9]
    found = plica.fit(scenario, {TOP: (area_of(1, {DRAG: 131}), 1)}, of={APICAL: (0.5, 8)}, folder=folder / "kept")
    assert plica.Scenario(folder / "kept/block.toml").diff(found.scenarios[0]) == {}


@pytest.mark.skipif("PLICA" not in os.environ, reason="PLICA names the program")
def test_the_program_hands_over(folder):
    path = {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    words = [os.environ["PLICA"], "calibrate", "block.toml", *VARY, "--target", f"{TOP}@0.1={area_of(0.1, {})}~1",
             "--target", f"{TOP}={area_of(1, {})}~1", "--prior", f"{APICAL}=4~1", "--prior", f"{DRAG}=300~100", "--out", "found.toml", "--overwrite"]
    ended = subprocess.run([*words, "--method", "gradient"], env={**os.environ, **path}, capture_output=True, text=True)
    assert ended.returncode == 0 and "Fit: converged" in ended.stdout, ended.stderr
    assert plica.Scenario("found.toml")[DRAG] == pytest.approx(300, rel=0.01)
    ended = subprocess.run([*words, "--method", "gradient"], env={**os.environ, **path, "PYTHONPATH": "/"}, capture_output=True, text=True)
    assert ended.returncode == 2 and "needs the Python package of plica" in ended.stderr
    ended = subprocess.run(words, capture_output=True, text=True)
    assert ended.returncode == 2 and "--prior: needs --method gradient" in ended.stderr


WRONG = [
    (["--target", f"{TOP}=1"], "--vary", None),
    (["--vary", f"{APICAL}=0.5:8"], "no target; give --target or --targets", 2),
    (["--vary", f"{APICAL}=0.5", "--target", f"{TOP}=1"], f"--vary {APICAL}=0.5: ''; give a number", 2),
    ([*VARY, "--target", TOP], f"--target {TOP}: give NAME=VALUE~SD", 2),
    ([*VARY, "--target", f"{TOP}=0"], "standard deviation 0; give one above 0", 2),
    ([*VARY, "--target", f"{TOP}@x=1"], f"--target {TOP}@x=1: 'x'; give a number", 2),
    ([*VARY, "--target", f"{TOP}=1", "--target", f"{TOP}=2"], "has two targets at one time; remove one", 2),
    ([*VARY, "--target", "nothing=1"], "nothing", 2),
    ([*VARY, "--target", f"{TOP}=1", "--set", "time.end=1"], "time.end", 2),
    ([*VARY, "--target", f"{TOP}=1", "--out", "block.toml"], "block.toml: exists; set --overwrite", 4),
    ([*VARY, "--target", f"{TOP}=1", "--out", "found.txt"], "give a name that ends in .toml", 2),
    ([*VARY, "--targets", "nowhere.csv"], "nowhere.csv: cannot be read", 4),
]


@pytest.mark.parametrize("words, message, status", WRONG)
def test_bad_words_are_told(folder, capsys, words, message, status):
    try:
        assert main(["calibrate", "block.toml", *words]) == status
    except SystemExit as ended:
        assert ended.code == 2 and status is None
    assert message in capsys.readouterr().err


TABLES = [
    ("outcome,value\na,1\n", ":1: columns outcome, value; give outcome, value, sd"),
    ("outcome,value,sd,time\na,1,1,1\n", ":1: columns outcome, value, sd, time; give"),
    ("", ":1: columns none; give"),
    ("outcome,value,sd\n", "has no row; give one per target"),
    ("outcome,value,sd\na,1,1\na,x,1\n", ":3: value: 'x'; give a number"),
    ("outcome,value,sd\na,1,1\na,1,1\n", ":3: a: has two targets at one time"),
    ("outcome,value,sd\na,1\n", ":2: sd: ''; give a number"),
    ("outcome,value,sd\na,nan,1\n", ":2: value: 'nan'; give a number"),
    ("outcome,value,sd\na,1,0\n", ":2: sd: 0; give a standard deviation above 0"),
]


@pytest.mark.parametrize("text, message", TABLES)
def test_bad_tables_are_told(tmp_path, text, message):
    file = tmp_path / "targets.csv"
    file.write_text(text)
    with pytest.raises(plica.FileError) as raised:
        read_targets(file)
    assert message in str(raised.value)
    file.write_bytes(b"outcome,value,sd\n\xff,1,1\n")
    with pytest.raises(plica.FileError, match="cannot be read"):
        read_targets(file)
