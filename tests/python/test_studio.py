"""plica studio: runs, acts and restarts.

Its drafts: test_studio_drafts.py; its server: test_studio_server.py; its page: viewer/tests/studio.test.mjs.
"""
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import plica
from plica import ScenarioError
from plica.studio import run as studio_run
from plica.studio.draft import STARTS, Draft
from plica.studio.frames import FrameFile
from plica.studio.server import CARDS
from plica.studio.session import Refused, Session
from plica.studio.shapes import surface

SHORT = {"format": 1, "base": "furrow-slice", "time": {"end_s": 120.0}, "output": {"frame_every_s": 15}}
PATIENCE_S = 300
KILLS = int(os.environ.get("STUDIO_KILLS", "8"))


def wait(is_so, what=""):
    start = time.monotonic()
    while not is_so():
        assert time.monotonic() - start < PATIENCE_S, what
        time.sleep(0.01)


@pytest.fixture
def session(tmp_path):
    made = Session(tmp_path, lambda: None, threads=1)
    made.open(Draft.of(plica.Scenario(SHORT)))
    yield made
    made.close()


def run_to(session, number, time_s):
    session.order("go", {"run": number, "until_s": time_s})
    run = session.runs[number]
    wait(lambda: run.is_over or (run.time_s >= time_s and run.status == "paused"), run.summary())
    return run


def last_positions(run):
    return run.file.positions(len(run.file.frames) - 1)


def repeated(text, run, folder):
    """Run a scenario file from rest to the time of a run, in another place."""
    file = folder / "again.toml"
    file.write_text(text)
    sim = plica.Simulation(plica.Scenario(file), threads=1)
    while sim.time_s < run.time_s and sim.step() is not None:
        pass
    assert sim.time_s == run.time_s
    return sim


def test_tissues_to_paint_are_in_the_gallery_with_a_picture_and_fold_once_painted(session):
    titles = session.order("gallery", {})["scenarios"]
    for name, table in STARTS.items():
        assert titles[name] == table["title"] and (CARDS / f"{name}.png").is_file()
        session.order("open", {"source": name})
        session.order("paint", {"region": "stripe", "ids": [1, 2, 3]})
        session.order("set", {"changes": {"cortex.apical": {"region": "stripe", "tension_mN_per_m": 1}}})
        run = session.runs[session.order("start", {"until_s": 1})["run"]]
        wait(lambda run=run: run.time_s >= 1)


def test_the_surface_is_that_of_a_cube_of_cubes():
    sim = plica.Simulation({"embryo": {"shape": "block", "length_um": 20, "width_um": 20, "cell_height_um": 20,
        "cells": [2, 2, 2]},
                            "contraction": {"apical": {"region": "all", "tension_mN_per_m": 1}}})
    shape = surface(sim.hexahedra, sim.hexahedron_cell)
    assert len(shape["facets"]) == 24 and len(shape["outlines"]) == 48
    corners = sim.rest_positions[shape["facets"]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    centres = corners.mean(axis=1) - sim.rest_positions.mean(axis=0)
    assert ((normals * centres).sum(axis=1) > 0).all()  # outward


# Runs and acts


def test_a_run_has_the_bits_of_the_command_line_wherever_it_pauses(session, tmp_path):
    number = session.order("start", {"until_s": 20})["run"]
    run = session.runs[number]
    wait(lambda: run.status == "paused" and run.time_s >= 20)
    session.order("step", {"run": number})
    run_to(session, number, 1e9)
    assert run.status == "end_time" and run.time_s == 120
    sim = repeated(session.scenario_text(number), run, tmp_path)
    assert np.array_equal(last_positions(run), sim.positions.astype("f4").ravel())
    assert len(run.rows) - 1 == sim.steps
    assert run.rows[-1][1:] == [None if v is None else v for v in list(sim.measures.values())[1:]]


def test_the_scenarios_frames_are_kept_however_quick_the_machine_is(session, monkeypatch):
    monkeypatch.setattr(studio_run, "FRAME_APART_S", np.inf)
    run = run_to(session, session.order("start", {"until_s": 1})["run"], 60.0)
    assert [frame.time_s for frame in run.file.frames][-4:] == pytest.approx([15, 30, 45, 60])


def test_acts_are_repeated_to_the_same_bits(session, tmp_path):
    """A cut between snapshots, light, a pull (another law, so from rest) and letting go, each on the run before."""
    number = session.order("start", {"until_s": 52})["run"]
    wait(lambda: session.runs[number].status == "paused" and session.runs[number].time_s >= 52)
    for kind, at_s, more in [("cut", 50.03, {}), ("darken", 61, {"strength": 0.3}), ("pull", 70, {"strength": 30}),
                             ("end", 82.5, {"name": "pressure.pull-1"}), ("end", 95, {"name": "ablation.dark-1"})]:
        run_to(session, number, at_s)
        number = session.order("act", {"run": number, "at_s": at_s, "kind": kind, "cells": [20, 21, 22], **more})["run"]
    run = run_to(session, number, 1e9)
    assert run.status == "end_time"
    table = run.scenario.to_dict()
    assert table["ablation"]["cut-1"]["at_s"] == 50.1 and table["ablation"]["dark-1"]["until_s"] == 95
    sim = repeated(session.scenario_text(number), run, tmp_path)
    assert np.array_equal(last_positions(run), sim.positions.astype("f4").ravel())
    continued = [one for one in session.runs.values() if one.from_s > 0]
    assert len(continued) >= 3, "acts that add no law continue a kept state"


def test_acts_on_daughters_are_acts_on_all_daughters_of_a_cell_at_rest(tmp_path):
    """Cells divide twice; a cut of a granddaughter continues a state before that, bitwise identical."""
    row = {"format": 1, "embryo": {"shape": "block", "length_um": 60, "width_um": 20, "cell_height_um": 20, "cells": [3, 1, 1]},
           "region": {"middle": {"ids": [1]}}, "output": {"frame_every_s": 20},
           "cortex": {"apical": {"region": "all", "tension_mN_per_m": 0.5}}, "time": {"end_s": 200},
           "division": {name: {"region": "middle", "at_s": at_s, "plane": "transverse", "growth_s": 20, "max_generation": generation}
                        for name, at_s, generation in [("once", 20, 1), ("again", 60, 2)]}}
    session = Session(tmp_path, lambda: None, threads=1)
    session.open(Draft.of(plica.Scenario(row)))
    number = session.order("start", {})["run"]
    first = run_to(session, number, 1e9)
    assert set(first.founders().values()) == {1} and len(first.founders()) == 6
    daughter = max(first.founders())
    made = session.order("act", {"run": number, "at_s": 130, "kind": "cut", "cells": [daughter]})["run"]
    run = run_to(session, made, 1e9)
    assert run.scenario.to_dict()["region"]["cut-1"]["ids"] == [1] and "all their daughters" in run.title
    assert 0 < run.from_s <= 20 and run.founders() == first.founders()
    assert not np.array_equal(last_positions(run), last_positions(first))
    sim = repeated(session.scenario_text(made), run, tmp_path)
    assert np.array_equal(last_positions(run), sim.positions.astype("f4").ravel())
    session.close()


def test_an_act_leaves_the_run_it_began_from(session):
    number = session.order("start", {"until_s": 60})["run"]
    first = session.runs[number]
    wait(lambda: first.status == "paused" and first.time_s >= 60)
    end_s, before = first.time_s, last_positions(first).copy()
    other = session.order("act", {"run": number, "at_s": 30, "kind": "cut", "cells": [20]})["run"]
    run_to(session, other, 60)
    assert first.time_s == end_s and np.array_equal(last_positions(first), before)
    assert session.draft.table["ablation"] and not first.scenario.to_dict().get("ablation")
    times = [run.file.frames[i].time_s for run, i in session.runs[other].all_frames()]
    assert times == sorted(times) and times[0] == 0


def test_acts_that_cannot_be_are_refused_with_a_reason(session):
    number = session.order("start", {"until_s": 5})["run"]
    wait(lambda: session.runs[number].status == "paused" and session.runs[number].time_s >= 5)
    for given, text in [({"kind": "cut", "cells": []}, "no cells are selected"),
        ({"kind": "squeeze", "cells": [1]}, "unknown"),
                        ({"kind": "end", "cells": [], "name": "ablation.none"},
                            "not an act"), ({"kind": "cut", "cells": [10**6]}, "ids")]:
        with pytest.raises((Refused, ValueError), match=text):
            session.order("act", {"run": number, "at_s": 5, **given})
            made = session.runs[max(session.runs)]
            wait(lambda: made.is_over)
            raise Refused(made.failure)


def test_strengths_of_laws_are_shown_at_rest_and_at_any_time_of_a_run(session):
    """Profile at rest; profile times program in a run, with nothing where cells have been cut."""
    name = "strength of cortex.apical"
    wait(lambda: session.rest.version > 0)
    core = plica.Simulation(plica.Scenario(session.draft.table))._core
    profile = session.rest._built[3][name]
    assert np.array_equal(profile, core.strength("cortex.apical").astype("f4"))
    assert profile.max() > 0.9 and 0 < profile[profile > 0].min() < 0.5, "a Gaussian over the mesoderm"
    run = run_to(session, session.order("start", {})["run"], 60)
    number = session.order("act", {"run": run.number, "at_s": 30, "kind": "cut", "cells": [20, 21]})["run"]
    cut = run_to(session, number, 60)
    end_s = cut.file.frames[-1].time_s
    shown = cut.file.values(len(cut.file.frames) - 1, name)
    expected = profile * np.float32(end_s / 540)  # its program rises from 0 to 540 s
    expected[[20, 21]] = 0
    assert np.allclose(shown, expected, atol=1e-6)
    head = cut.frame_message({"slot": 0, "field": name, "at_s": None, "rows": 0})[-1]
    assert b'"range"' in head and name in FrameFile(cut.directory / "frames.bin").cell_fields


def test_painting_makes_regions_of_ids_and_can_be_undone(session):
    session.order("paint", {"region": "stripe", "ids": [5, 3, 3, 4]})
    assert session.draft.table["region"]["stripe"]["ids"] == [3, 4, 5]
    session.order("paint", {"region": "mesoderm", "ids": [1]})  # was chosen by selectors
    assert session.draft.table["region"]["mesoderm"] == {"ids": [1]}
    session.order("undo", {})
    session.order("undo", {})
    assert "stripe" not in session.draft.table["region"]
    with pytest.raises(ScenarioError):
        session.order("paint", {"region": "mesoderm", "ids": []})  # tables need it
    with pytest.raises(Refused):
        session.order("paint", {"region": "../x", "ids": [1]})


def test_a_failing_run_says_why_and_keeps_its_frames(tmp_path):
    session = Session(tmp_path, lambda: None, threads=1)
    session.open(Draft.of(plica.Scenario({
        "embryo": {"shape": "sheet", "length_um": 120, "width_um": 100, "cell_height_um": 10, "cell_count": 120},
        "elasticity": {"corner_barrier_Pa": 0}, "region": {"stripe": {"y_um": [-20, 20]}}, "time": {"end_s": 300},
        "contraction": {"apical": {"region": "stripe", "stiffness_nN_per_um": 20}}})))
    run = session.runs[session.order("start", {})["run"]]
    wait(lambda: run.is_over)
    assert run.status == "failed" and "t = " in run.failure and run.file.frames
    session.close()


def test_results_are_written_and_compared(session, tmp_path):
    number = session.order("start", {})["run"]
    wait(lambda: session.runs[number].is_over)
    session.order("results", {"run": number, "name": "taken"})
    wait(lambda: session.jobs["taken"] != "being written")
    assert "same positions" in session.jobs["taken"], session.jobs
    assert (tmp_path / "taken" / "summary.json").exists()
    with pytest.raises(Refused, match="exists"):
        session.order("results", {"run": number, "name": "taken"})


def test_the_exported_script_runs(session):
    text = session.script_text(0)
    assert 'base = "furrow-slice"' in text
    compile(text, "run.py", "exec")


# Restarts


def test_a_session_comes_back_as_it_was(session, tmp_path):
    number = session.order("start", {"until_s": 40})["run"]
    run = session.runs[number]
    wait(lambda: run.status == "paused" and run.time_s >= 40)
    session.order("set", {"changes": {"cortex.apical.tension_mN_per_m": "1.9"}})
    session.close()
    again = Session(tmp_path, lambda: None, threads=1)
    assert again.draft.table == session.draft.table and again.draft.place == session.draft.place
    back = again.runs[number]
    assert len(back.file.frames) == len(run.file.frames) and back.rows == run.rows
    run_to(again, number, 1e9)
    sim = repeated(again.scenario_text(number), back, tmp_path)
    assert np.array_equal(last_positions(back), sim.positions.astype("f4").ravel()) and len(back.rows) - 1 == sim.steps
    again.close()


def test_a_killed_server_loses_nothing_but_the_step_under_way(tmp_path):
    """Killed at any moment, from opening the session on to the end of its run."""
    code = """if True:
        import sys, time, pathlib
        from plica.studio.session import Session
        print("begins", flush=True)
        session = Session(pathlib.Path(sys.argv[1]), lambda: None, threads=1)
        session.runs[1].go()
        while not session.runs[1].is_over:
            time.sleep(0.005)
        session.close()
        print("is over", flush=True)
    """
    first = Session(tmp_path, lambda: None, threads=1)
    first.open(Draft.of(plica.Scenario(SHORT)))
    first.order("start", {"until_s": 0})
    first.close()
    begun = []
    for kill in range(KILLS):
        with subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE,
            text=True) as process:
            process.stdout.readline()
            # Only so long that several are needed to reach the end.
            before = time.monotonic()
            while time.monotonic() - before < 0.02 * (kill + 1) and process.poll() is None:
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
        file = tmp_path / ".plica-studio" / "run-0001" / "frames.bin"
        begun.append(file.exists() and len(FrameFile(file).frames))
    last = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True,
        timeout=PATIENCE_S)
    assert "is over" in last.stdout, (begun, last.stdout, last.stderr)
    session = Session(tmp_path, lambda: None, threads=1)
    run = session.runs[1]
    assert run.status == "end_time", (begun, run.summary())
    sim = repeated(session.scenario_text(1), run, tmp_path)
    assert np.array_equal(last_positions(run), sim.positions.astype("f4").ravel()), begun
    assert len(run.rows) - 1 == sim.steps, begun
    times = [frame.time_s for frame in run.file.frames]
    assert times == sorted(set(times))
    session.close()


def test_a_run_that_ended_unnoted_is_over_with_all_its_frames(session, tmp_path):
    """The server was killed between the end of the run and the note of it."""
    number = session.order("start", {})["run"]
    wait(lambda: session.runs[number].is_over)
    session.close()
    times = [frame.time_s for frame in session.runs[number].file.frames]
    file = tmp_path / ".plica-studio" / "session.json"
    file.write_text(file.read_text().replace('"end_time"', '"paused"'))
    again = Session(tmp_path, lambda: None, threads=1)
    run = again.runs[number]
    assert run.status == "paused"
    again.order("go", {"run": number})
    wait(lambda: run.is_over)
    assert run.status == "end_time" and [frame.time_s for frame in run.file.frames] == times
    again.close()


def test_half_a_frame_is_left_out(tmp_path):
    file = FrameFile(tmp_path / "frames.bin")
    values = {name: np.full(4, 2, "f4") for name in ("displacement", "speed")}
    values |= {name: np.full(2, 3, "f4") for name in ("area-ratio", "pressure", "volume", "contraction", "generation",
        "self-intersections")}
    for time_s in (0.0, 1.0):
        file.add(time_s, 0, np.arange(12, dtype="f4").reshape(4, 3), values)
    with (tmp_path / "frames.bin").open("ab") as out:
        out.write(b"x" * 40)
    read = FrameFile(tmp_path / "frames.bin")
    assert [frame.time_s for frame in read.frames] == [0, 1]
    assert read.positions(1).tolist() == list(range(12)) and read.values(1, "pressure").tolist() == [3, 3]
    read.forget_after(0.5)
    assert len(FrameFile(tmp_path / "frames.bin").frames) == 1


# Files


def test_files_are_those_of_the_folder(session, tmp_path):
    outside = tmp_path.parent / "outside.toml"
    outside.write_text('base = "furrow-slice"\n')
    (tmp_path / "link.toml").symlink_to(outside)
    (tmp_path / "own.toml").write_text('base = "furrow-slice"\n[cortex.apical]\ntension_mN_per_m = 1.1\n')
    (tmp_path / "reaches.toml").write_text('[embryo]\nshape = "surface"\nfile = "/etc/passwd"\n')
    for path in ("../outside.toml", str(outside), "link.toml", "/etc/passwd", ".plica-studio/session.json",
        "reaches.toml", "none.toml"):
        with pytest.raises((Refused, plica.PlicaError, ValueError)):
            session.order("open", {"source": path})
    with pytest.raises(Refused):
        session.order("set", {"changes": {"embryo.file": "/etc/passwd"}})
    with pytest.raises(Refused):
        session.order("set", {"changes": {"embryo": {"shape": "surface", "file": "/etc/passwd"}}})
    with pytest.raises(Refused):
        session.order("set", {"changes": {"base": "/etc/passwd"}})
    session.order("open", {"source": "own.toml"})
    assert session.draft.table["cortex"]["apical"]["tension_mN_per_m"] == 1.1
    assert "own.toml" in session.order("gallery", {})["files"]


def looked_at(session, source, **options):
    session.order("look_at", {"source": source, "options": options})
    wait(lambda: session.candidate.cells or session.candidate.problem)
    return session.candidate.state()


def test_a_mesh_is_looked_at_and_used(session, tmp_path):
    lines = ["OFF", "9 4 0"] + [f"{20 * x} {20 * y} 0" for y in range(3) for x in range(3)]
    lines += [f"4 {i} {i + 1} {i + 4} {i + 3}" for i in (0, 1, 3, 4)]
    (tmp_path / "sheet.off").write_text("\n".join(lines) + "\n")
    before = session.draft.table
    shown = looked_at(session, "sheet.off")
    assert (shown["kind"], shown["cells"], shown["problem"]) == ("polygons", 4, "")
    assert any("4 cells" in remark for remark in shown["remarks"]) and not any("no force" in one for one in shown["remarks"])
    assert session.draft.table is before, "nothing is used before it is accepted"
    assert session.frame_messages({"run": -1, "slot": 0, "field": "region", "known": -1})
    assert looked_at(session, "sheet.off", cell_height_um="12", scale="2")["problem"] == ""
    session.order("look_at", {"source": "sheet.off", "options": {"cell_height_um": "12", "scale": "2"}})
    session.order("use", {})  # before that has been read again
    embryo = session.draft.table["embryo"]
    assert (embryo["shape"], embryo["cell_height_um"], embryo["scale"]) == ("surface", 12, [2, 2, 2])
    wait(lambda: session.rest.cells == 4)
    session.order("undo", {})
    assert session.draft.table == before


def test_a_label_image_becomes_cells_beside_it(session, tmp_path):
    pytest.importorskip("skimage")
    rows, columns = np.mgrid[:100, :120]
    labels = 1 + (rows // 20) * 7 + (columns + 10 * (rows // 20 % 2)) // 20
    np.save(tmp_path / "wing.npy", labels.astype("u2"))
    shown = looked_at(session, "wing.npy", um_per_pixel="0.5")
    assert shown["kind"] == "label image" and shown["cells"] > 9, shown
    for _ in range(2):
        session.order("use", {})
    assert session.draft.table["embryo"]["file"] == str(tmp_path / "wing-cells-2.ply"), "no file is written over"
    width_um = np.ptp(plica.Simulation(plica.Scenario(session.draft.table)).rest_positions[:, 0])
    assert 30 < width_um < 60  # of 120 pixels, without the cells at the border
    assert "not a number" in looked_at(session, "wing.npy", um_per_pixel="much")["problem"]
    with pytest.raises(ValueError):
        session.order("use", {})


def test_a_label_volume_asks_for_its_apical_side(session, tmp_path):
    pytest.importorskip("skimage")
    planes, rows, columns = np.mgrid[:30, :80, :80]
    labels = 1 + (rows // 16) * 6 + (columns + 8 * (rows // 16 % 2)) // 16
    labels[(planes < 6) | (planes >= 24)] = 0
    np.save(tmp_path / "sheet.npy", labels.astype("u2"))
    shown = looked_at(session, "sheet.npy")
    assert shown["kind"] == "label volume" and "apical" in shown["problem"], shown
    assert {one["name"]: one["value"] for one in shown["options"]}["spacing_planes"] == "1"
    shown = looked_at(session, "sheet.npy", kind="label volume", apical="+z", spacing_planes="2")
    assert shown["problem"] == "" and shown["cells"] > 6, shown
    session.order("use", {})
    assert session.draft.table["embryo"]["shape"] == "prisms"


def test_centres_are_those_of_an_open_sheet_or_of_a_closed_embryo(session, tmp_path):
    pytest.importorskip("scipy")
    lines = [f"{8 * (column + row % 2 / 2)},{7 * row},{column}" for row in range(6) for column in range(6)]
    (tmp_path / "sheet.csv").write_text("\n".join(["x_um,y_um,gene", *lines]) + "\n")
    shown = looked_at(session, "sheet.csv", cell_height_um="10")
    assert shown["kind"] == "points on an open sheet" and shown["cells"] == 36, shown
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    assert "x_um" in looked_at(session, "other.csv")["problem"]
    for wrong in ("../sheet.csv", "none.csv", "own.toml"):
        with pytest.raises(Refused):
            session.order("look_at", {"source": wrong})
