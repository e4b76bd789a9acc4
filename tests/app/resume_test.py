"""Nothing is lost: runs that are killed, interrupted or damaged, and go on by `plica run --resume` to the same bits.

By hand, kills spread over the whole run: resume_test.py PROGRAM --kills 200 [--seed N]
"""
import os
import random
import re
import shutil
import signal
import sys
import time
from pathlib import Path

import support
from resuming import CHANGING, DIVIDING, LOST, Resuming
from support import BLOCK, CHECKPOINTS, SPHERE, rows_in, running, tree

KILLS, SEED, KILLS_IN_A_ROW = 8, 1, 8


class Kills(Resuming):
    def test_killed_runs_with_divisions_go_on_to_the_same_bits(self):
        self.check_kills(DIVIDING)

    def test_killed_runs_of_tissues_that_change_go_on_to_the_same_bits(self):
        self.check_kills([self.write(CHANGING)])
        events = self.summary()
        for key in ("exchanges", "extruded_cells", "divisions"):
            self.assertGreater(events[key], 0, key)

    def check_kills(self, scenario):
        """In chains: a run is killed, goes on, is killed further on, and so on to its end. The kills of all chains lie
        evenly over the steps; one in ten falls on the start of the program instead, while it reads and cuts back."""
        chance = random.Random(SEED)
        began = time.monotonic()
        whole = self.whole_run(scenario)
        seconds = time.monotonic() - began
        steps = rows_in(self.folder / "whole")
        chains = max(1, KILLS // KILLS_IN_A_ROW)
        # Not in the last steps, nor long after the start: on a quick machine the run ends before it is killed.
        places = [(steps - 10) * (k + chance.random()) / KILLS for k in range(KILLS)]
        done, early, lost_rows, steps_hit = 0, 0, 0, set()
        for chain in range(chains):
            shutil.rmtree(self.out, ignore_errors=True)
            known = 0  # rows at the last kill
            for place in places[chain::chains]:
                at_start = chance.random() < 0.1
                delay = chance.uniform(0, min(0.3, 0.15 * seconds)) if at_start else chance.uniform(0, 2 * seconds / steps)
                process = self.after_rows(scenario, 0 if at_start else int(place), signal.SIGKILL, delay)
                if process.returncode != -signal.SIGKILL:
                    self.assertEqual(process.returncode, 0, process.stderr)  # it came to its end before
                    continue
                lost_rows = max(lost_rows, self.rows_lost(process, known))
                known = rows_in(self.out)
                done, early = done + 1, early + at_start
                steps_hit.add(known)
            lost_rows = max(lost_rows, self.rows_lost(self.resumed(scenario), known))
            self.assert_same(self.out, whole)
            self.assertEqual([], [path for path in self.out.rglob("*.part")], "left-overs")
        print(f"{done} kills in {chains} chains of a run of {steps} steps and {seconds:.1f} s, seed {SEED}: {early} at the start "
              f"of the program, the others after {len(steps_hit)} different steps; at most {lost_rows} rows cut back; every "
              "chain ended in the same bits")
        self.assertGreaterEqual(done, KILLS * 0.9)

    def rows_lost(self, process, rows):
        """How many rows a resumed run cut back: the steps since the last resumable one whose checkpoint was written."""
        found = re.search(r"resuming after step (\d+)", process.stdout)
        if not found:
            return 0
        lost = rows - int(found.group(1))
        self.assertIn(lost, LOST, "more is lost than the steps since the last checkpoint")
        return lost


class Signals(Resuming):
    def test_interrupted_runs_say_how_to_go_on_and_do(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with self.subTest(number):
                shutil.rmtree(self.folder / "whole", ignore_errors=True)
                shutil.rmtree(self.out, ignore_errors=True)
                block = [self.write(BLOCK), "--set", "time.end_s=30"]
                whole = self.whole_run(block)
                for rows in (0, 20, 150):  # 0: perhaps before the first step
                    if rows > 0:  # one of its own at least: it has begun, however many the one before has left
                        rows = max(rows, rows_in(self.out) + 1)
                    process = self.after_rows(block, rows, number, 0.05 if rows == 0 else 0)
                    if rows == 0 and process.returncode == -number:
                        continue  # it had not begun
                    self.assertEqual(process.returncode, status, process.stderr)
                    self.assertIn("--resume", process.stderr)
                    self.assertEqual(self.summary()["status"], "interrupted")
                self.resumed(block)
                self.assert_same(self.out, whole)


class Directories(Resuming):
    """What --resume finds in DIR."""

    def test_nothing_there_begins_and_a_finished_run_is_left_alone(self):
        block = [self.write(BLOCK)]
        whole = self.whole_run(block)
        self.resumed(block)
        self.assert_same(self.out, whole)
        before = tree(self.out)
        self.assertIn("already complete", self.resumed(block).stdout)
        self.assertEqual(tree(self.out), before)

    def test_an_ending_that_was_not_written_is_made_up_for(self):
        block = [self.write(BLOCK)]
        whole = self.whole_run(block)
        self.resumed(block)
        for name in ("summary.json", "report.html"):
            with self.subTest(name):
                (self.out / name).unlink()
                self.resumed(block)
                self.assertTrue((self.out / name).exists())
                self.assert_same(self.out, whole)

    def test_another_scenario_is_refused_by_its_key(self):
        block = [self.write(BLOCK)]
        self.resumed(block)
        before = tree(self.out)
        for setting, parts in (("elasticity.young_modulus_Pa=123", ["elasticity.young_modulus_Pa", "123"]),
                               ("embryo.length_um=70", ["embryo.length_um", "60", "70"]),
                               ("contraction.all.stiffness_nN_per_um=2", ["contraction.all.stiffness_nN_per_um"])):
            with self.subTest(setting):
                self.assert_says(self.resumed(block, "--set", setting, status=2), *parts)
                self.assertEqual(tree(self.out), before)

    def test_another_mesh_under_the_same_name_is_refused(self):
        mesh = self.folder / "mesh.vtu"
        sphere = self.write(SPHERE)
        self.call("mesh", sphere, "--out", mesh)
        text = 'format = 1\n[embryo]\nshape = "file"\nfile = "mesh.vtu"\n[time]\nend_s = 0.5\nstep_s = 0.1\n'
        scenario = [self.write(text, "of_mesh.toml")]
        self.resumed(scenario)
        self.call("mesh", sphere, "--set", "embryo.diameter_um=210", "--out", mesh, "--overwrite")
        self.assertIn("another mesh", self.resumed(scenario, status=2).stderr)

    def test_time_stop_and_output_may_change(self):
        block = [self.write(BLOCK)]
        whole = self.whole_run(block, "--set", "time.end_s=5")
        self.resumed(block, "--set", "time.end_s=2")
        self.assertEqual(self.summary()["time_s"], 2)
        self.resumed(block, "--set", "time.end_s=5")  # on from a finished run
        self.assert_alike(whole)
        self.resumed(block, "--set", "time.end_s=6", "--set", "time.step_s=0.05", "--set", "output.frame_every_s=0")
        self.assertAlmostEqual(self.summary()["time_s"], 6)
        self.resumed(block, "--set", "time.end_s=6.5", "--set", 'time.linear_solver="direct"', "--set", "output.cells_csv=false")
        self.assertAlmostEqual(self.summary()["time_s"], 6.5)
        self.assert_whole(self.out)

    def test_a_criterion_that_ended_a_run_is_asked_again_when_it_changes(self):
        block = [self.write(BLOCK + '[monitor.all]\nquantity = "area"\nface = "apical"\nregion = "all"\n'), "--set", "time.end_s=3"]
        never = ["--set", 'stop.small.monitor="all"', "--set", "stop.small.below=1"]
        soon = ["--set", 'stop.small.monitor="all"', "--set", "stop.small.below=1e9"]
        whole = self.whole_run(block, *never)
        self.resumed(block, *soon)
        self.assertEqual(self.summary()["stopped_by"], "small")
        self.resumed(block, *never)
        self.assertIsNone(self.summary()["stopped_by"])
        self.assert_alike(whole)

    def test_results_without_a_checkpoint_are_kept(self):
        block = [self.write(BLOCK)]
        self.resumed(block)
        for name in CHECKPOINTS:
            (self.out / name).unlink()
        for missing in ("", "summary.json"):
            (self.out / missing).unlink() if missing else None
            before = tree(self.out)
            self.assert_says(self.resumed(block, status=4), "--overwrite")
            self.assertEqual(tree(self.out), before)

    def test_only_one_run_at_a_time_writes_there(self):
        endless = [self.write(BLOCK), "--set", "time.end_s=1e9"]
        with running("run", *endless, "--out", self.out, "--quiet") as process:
            while process.poll() is None and rows_in(self.out) < 5:
                time.sleep(0.01)
            for option in ("--resume", "--overwrite"):
                self.assert_says(self.call("run", *endless, "--out", self.out, option, status=4), "another process of plica")
            self.assertIsNone(process.poll())
        self.resumed([self.write(BLOCK), "--set", "time.end_s=1"])

    def test_resume_and_overwrite_exclude_each_other(self):
        self.call("run", self.write(BLOCK), "--out", self.out, "--resume", "--overwrite", status=2)
        self.assertFalse(self.out.exists())

    def test_files_that_are_cut_or_gone_are_told_of(self):
        block = [self.write(BLOCK), "--set", "time.end_s=30"]
        for name, harm in (("series.csv", lambda path: os.truncate(path, 300)), ("midline.csv", Path.unlink),
                           ("frames/frame_00001.vtu", Path.unlink)):
            with self.subTest(name):
                shutil.rmtree(self.out, ignore_errors=True)
                self.after_rows(block, 100, signal.SIGTERM)
                harm(self.out / name)
                self.assert_says(self.resumed(block, status=4), name)

    def test_another_way_to_solve_may_go_on(self):
        sphere = [self.write(SPHERE), "--set", "stop.at_equilibrium=false"]
        for solver in ("direct", "cholesky", "multigrid"):
            with self.subTest(solver):
                shutil.rmtree(self.out, ignore_errors=True)
                self.call("run", *sphere, "--set", "time.end_s=3", "--out", self.out)
                more = ("--set", "time.end_s=6", "--set", f'time.linear_solver="{solver}"')
                self.assertIn("resuming after step", self.resumed(sphere, *more).stdout)
                self.assertEqual(self.summary()["time_s"], 6)


class Damage(Resuming):
    """Checkpoints that are not what they were."""

    def setUp(self):
        super().setUp()
        self.block = [self.write(BLOCK), "--set", "time.end_s=60"]
        self.after_rows(self.block, 60, signal.SIGTERM)
        self.newest, self.previous = self.out / "checkpoint.h5", self.out / "checkpoint.previous.h5"

    def test_the_one_before_is_taken_and_the_bits_are_the_same(self):
        whole = self.whole_run(self.block)
        content = bytearray(self.newest.read_bytes())
        content[len(content) // 2] ^= 4
        self.newest.write_bytes(content)
        self.assert_says(self.resumed(self.block, "--quiet"), "checkpoint.h5", "damaged", "the previous checkpoint")
        self.assert_same(self.out, whole)

    def test_a_newest_one_that_is_gone_leaves_the_one_before(self):
        whole = self.whole_run(self.block)
        self.newest.unlink()  # as between two renames
        self.resumed(self.block)
        self.assert_same(self.out, whole)

    def test_when_none_can_be_read_nothing_is_touched(self):
        self.newest.write_bytes(b"nothing of the kind")
        self.previous.write_bytes(self.previous.read_bytes()[:-1])
        before = tree(self.out)
        self.assert_says(self.resumed(self.block, status=4), "checkpoint.h5", "checkpoint.previous.h5", "--overwrite")
        self.assertEqual(tree(self.out), before)

    def test_a_newer_format_is_named(self):
        for path in (self.newest, self.previous):
            path.write_bytes(re.sub(rb"\nplica checkpoint \d+ ", b"\nplica checkpoint 99 ", path.read_bytes()))
        self.assert_says(self.resumed(self.block, status=4), "format")


if __name__ == "__main__":
    SEED = int(support.option("--seed", SEED))
    if (kills := support.option("--kills")) is not None:
        KILLS = int(kills)
        sys.argv.append("Kills")
    support.main()
