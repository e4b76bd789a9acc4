"""What goes wrong on the way: files, full disks, numerics that give up, signals."""
import os
import re
import signal
import subprocess
import time
import unittest
from pathlib import Path

import support
from support import BLOCK, CHECKPOINTS, RESULTS, SPHERE, CommandLine, ended, rows_in, running, table, tree


class Files(CommandLine):
    """Status 4: what the file system refuses, and what must not be overwritten."""

    def test_results_are_never_overwritten_unasked(self):
        self.run_scenario(BLOCK)
        before = tree(self.out)
        result = self.run_scenario(SPHERE, status=4)
        self.assert_says(result, "--overwrite")
        self.assertEqual(tree(self.out), before)

    def test_overwrite_keeps_the_results_when_the_scenario_is_bad(self):
        self.run_scenario(BLOCK)
        before = tree(self.out)
        self.run_scenario(BLOCK + "wrong = 1\n", "--overwrite", status=2)
        self.assertEqual(tree(self.out), before)

    def test_overwrite_replaces_only_plicas_own_files(self):
        self.run_scenario(BLOCK, "--set", "output.frame_every_s=0.1")
        foreign = {"notes.txt": b"mine", "frames/mine.vtu": b"mine", "frames/frame_mine.vtu": b"mine", "data/series.csv": b"mine"}
        for name, content in foreign.items():
            (self.out / name).parent.mkdir(exist_ok=True)
            (self.out / name).write_bytes(content)
        self.run_scenario(BLOCK, "--overwrite", "--set", "output.frame_every_s=0")
        after = tree(self.out)
        for name, content in foreign.items():
            with self.subTest(name):
                self.assertEqual(after.get(name), content)
        for name in foreign:
            (self.out / name).unlink(missing_ok=True)
        self.assert_whole(self.out)
        self.assertEqual(len(list((self.out / "frames").iterdir())), 2, "frames of the run before are left")

    def test_places_that_cannot_be_written(self):
        file = self.write("mine", "file")
        for out in (file, file / "below", Path("/proc/plica"), Path("/dev/null")):
            with self.subTest(out):
                self.assert_says(self.run_scenario(BLOCK, out=out, status=4), str(out))
        self.assertEqual(file.read_text(), "mine")
        mesh = self.folder / "rest.vtu"
        scenario = self.write(BLOCK)
        self.call("mesh", scenario, "--out", file / "rest.vtu", status=4)
        self.call("mesh", scenario, "--out", mesh)
        before = mesh.read_bytes()
        self.call("mesh", scenario, "--set", "embryo.length_um=70", "--out", mesh, status=4)
        self.assertEqual(mesh.read_bytes(), before)
        self.call("mesh", scenario, "--set", "embryo.length_um=70", "--out", mesh, "--overwrite")
        self.assertNotEqual(mesh.read_bytes(), before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_standard_output_that_is_full(self):
        scenario = self.write(BLOCK)
        for arguments in (["check", scenario], ["scenarios"]):
            with self.subTest(arguments), open("/dev/full", "w") as full:
                self.call(*arguments, stdout=full, status=4)

    def small_disk(self, kilobytes):
        disk = self.folder / f"disk{kilobytes}"
        disk.mkdir()
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "plica_test", disk], capture_output=True)
        if mount.returncode != 0:
            return None
        self.addCleanup(subprocess.run, ["umount", disk], capture_output=True)
        return disk

    def test_full_disk_at_the_start_and_in_the_middle(self):
        run = ["--quiet", "--set", "time.end_s=60", "--set", "output.frame_every_s=0.5"]
        for kilobytes in (4, 12, 32, 60, 100, 160):
            with self.subTest(kilobytes):
                disk = self.small_disk(kilobytes)
                if disk is None:
                    self.skipTest("may not mount a small disk here; the file size limit is tried all the same")
                self.assert_says(self.run_scenario(BLOCK, *run, out=disk / "out", status=4), "No space left")
                self.assert_whole(disk / "out")

    def test_a_file_that_may_not_grow_is_cut_to_whole_rows(self):
        # SIGXFSZ ignored: write then fails in the middle of a row, as on a full disk.
        limit = ["bash", "-c", 'trap "" XFSZ; ulimit -f 12; exec "$0" "$@"', support.PROGRAM]
        support.count_case()
        command = ["run", self.write(BLOCK), "--out", self.out, "--quiet", "--set", "time.end_s=60", "--set",
                   "output.frame_every_s=0"]
        # Where temporary files go, the thread sanitizer would write one of its own that is larger.
        result = subprocess.run([*limit, *map(str, command)], capture_output=True, text=True, timeout=60,
                                env={**os.environ, "TMPDIR": "/nonexistent"})
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assert_says(result, "File too large")
        self.assert_whole(self.out)


class Endings(CommandLine):
    """Runs that end early: what they leave is whole, and the status says why."""

    def test_numerics_that_give_up_are_status_3_and_keep_the_last_good_state(self):
        result = self.run_scenario(BLOCK, "--set", "contraction.all.preload_nN=-1e6", status=3)
        summary = self.summary()
        self.assertEqual(summary["status"], "failed")
        message = [line for line in result.stderr.splitlines() if "solver failed" in line]
        self.assertEqual(len(message), 1, result.stderr)
        self.assertRegex(message[0], r"cell \d+")
        self.assertRegex(message[0], r"t = [\d.e+-]+ s")
        self.assertIn("inverted", message[0])
        self.assert_whole(self.out)
        self.assertEqual(summary["steps"], len((self.out / "series.csv").read_text().splitlines()) - 2)

    def test_forces_beyond_all_numbers_leave_no_nan(self):
        self.run_scenario(BLOCK, "--set", "contraction.all.stiffness_nN_per_um=1e300", status=3)
        self.assertEqual(self.summary()["status"], "failed")
        self.assert_whole(self.out)

    def test_forces_beyond_all_numbers_at_rest_are_refused(self):
        for setting in ("contraction.all.stiffness_nN_per_um=1.7e308", "contraction.all.preload_nN=-1.7e308"):
            with self.subTest(setting):
                result = self.run_scenario(BLOCK, "--set", setting, "--set", "contraction.all.diagonals=true", status=2)
                self.assertRegex(self.assert_messages(result)[0], r"force in cell \d+ is not finite in the reference state; reduce ")
                self.assertFalse(self.out.exists())

    def test_a_run_that_is_interrupted_keeps_what_it_has(self):
        for name, number, status in (("INT", signal.SIGINT, 130), ("TERM", signal.SIGTERM, 143)):
            with self.subTest(name):
                result, out = self.stopped_run(number, name)
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertEqual(self.summary(out)["status"], "interrupted")
                self.assertEqual({path.name for path in out.iterdir()} - CHECKPOINTS, RESULTS - CHECKPOINTS)
                rows = table(out / "series.csv")
                self.assertEqual(self.summary(out)["steps"], len(rows) - 1)
                self.assert_whole(out)

    def test_an_interrupted_step_is_finished_if_that_takes_no_longer_than_3_s(self):
        with running("run", "drosophila", "--set", "embryo.elements_per_cell=[2,2,2]", "--out", self.out) as process:
            series = self.out / "series.csv"
            # Its header, the embryo at rest.
            while process.poll() is None and (not series.exists() or len(series.read_text().splitlines()) < 2):
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            signalled = time.monotonic()
            ended(process)
        self.assertEqual(process.returncode, 130)
        if self.summary(self.out)["steps"] == 0:
            self.assertGreater(time.monotonic() - signalled, 3, "the step was given up at once")
        self.assert_whole(self.out)

    def test_an_interrupted_step_is_given_up_within_seconds(self):
        # Forces so strong that Newton's method tries shorter and shorter steps, for most of a minute, and no step succeeds:
        # without the signal, status 3.
        with running("run", "drosophila", "--set", "embryo.elements_per_cell=[2,2,2]", "--set", "time.first_step_s=30",
                     "--set", "contraction.apical.stiffness_nN_per_um=1e6", "--set", "contraction.apical.preload_nN=-1e6",
                     "--out", self.out) as process:
            time.sleep(2)
            self.assertIsNone(process.poll(), "the run was over before the signal")
            process.send_signal(signal.SIGTERM)
            ended(process, 30)
        self.assertEqual(process.returncode, 143)
        self.assertEqual(self.summary(self.out)["steps"], 0)
        self.assert_whole(self.out)

    def test_a_killed_run_leaves_whole_files(self):
        result, out = self.stopped_run(signal.SIGKILL, "KILL")
        self.assertEqual(result.returncode, -signal.SIGKILL)
        # What was being written under another name may be left; what has its name is whole.
        for path in out.rglob("*"):
            if re.search(r"tmp|temp|part|~$", path.name):
                path.unlink()
        self.assert_whole(out)

    def stopped_run(self, number, name):
        """A run without end, signalled once its series has a few rows; they are readable while it goes on."""
        out = self.folder / name
        with running("run", self.write(BLOCK), "--out", out, "--set", "time.end_s=1e9", "--quiet") as process:
            deadline = time.monotonic() + 30
            while time.monotonic() < deadline and rows_in(out) < 4:
                self.assertIsNone(process.poll())
                time.sleep(0.02)
            self.assertGreater(rows_in(out), 3)
            process.send_signal(number)
            return ended(process, 30), out


if __name__ == "__main__":
    support.main()
