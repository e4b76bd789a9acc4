"""plica calibrate from outside: what it prints, writes and refuses."""
import re
import signal
import time

import support
from support import BLOCK, CommandLine, ended, running

TARGETS = """\
[monitor.end]
quantity = "position"
axis = "x"
face = "apical"
over = "max"
[monitor.side]
quantity = "position"
axis = "y"
face = "apical"
over = "max"
"""
SOFT = BLOCK.replace("end_s = 0.5\nstep_s = 0.1", "end_s = 5\nstep_s = 0.5") + TARGETS
STIFFNESS = "contraction.all.stiffness_nN_per_um"
ACROSS = "contraction.all.across_ratio"


class Calibrate(CommandLine):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "calibrated.toml"

    def calibrate(self, *arguments, status=0, text=SOFT):
        return self.call("calibrate", self.write(text), *arguments, status=status)

    def test_one_key_one_target(self):
        result = self.calibrate("--vary", f"{STIFFNESS}=0.1:20", "--target", "end.position_um=28~0.001", "--out", self.file)
        self.assertEqual(result.stderr, "")
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0].split()[:3], ["trial", STIFFNESS, "end.position_um"])
        trials = [line.split() for line in lines[1:] if re.match(r" +\d+ ", line)]
        self.assertEqual([float(row[1]) for row in trials[:2]], [0.1, 20], "the ends come first")
        self.assertEqual(trials[-1][-1], "met")
        self.assertLess(len(trials), 9)
        # The file repeats the trial, and says what was expected of it.
        self.call("run", self.file, "--out", self.out, "--quiet")
        self.assertAlmostEqual(self.summary()["end.position_um"], 28, delta=0.001)
        self.assertIn('base = "scenario.toml"', self.file.read_text())

    def test_two_keys_two_targets_are_the_same_for_any_number_of_threads(self):
        arguments = ("--vary", f"{STIFFNESS}=0.1:40", "--vary", f"{ACROSS}=0.1:4", "--target", "end.position_um=28~0.01",
                     "--target", "side.position_um=19.5~0.01", "--overwrite", "--out", self.file)  # fmt: skip
        self.calibrate(*arguments, "--threads", 1)
        one = self.file.read_text()
        self.assertIn("# Calibrated", one)
        self.calibrate(*arguments, "--threads", 2)
        self.assertEqual(self.file.read_text(), one)

    def test_a_target_that_cannot_be_met(self):
        result = self.calibrate("--vary", f"{STIFFNESS}=0.1:2", "--target", "end.position_um=25", "--out", self.file, status=1)
        first, *rest = result.stderr.splitlines()
        self.assertIn("not met: no values within the bounds", first)
        self.assertIn(f"best: {STIFFNESS} = 2", rest[0])
        self.assertRegex(rest[1], r"results: end.position_um = 26\.\d+ \(\+5\.\d+ %\)")
        self.assertIn("is at its bound 2", rest[2])
        self.assertIn("# Best result found", self.file.read_text())
        self.assertNotIn("expect", self.file.read_text())

    def test_bad_usage_is_refused_before_the_first_run(self):
        vary, target = f"{STIFFNESS}=1:2", "end.position_um=28"
        cases = (
            (f"{STIFFNESS}=2:1", target, f"low is above high; write {STIFFNESS}=1:2"),
            (vary, "end.positon_um=28", 'use "end.position_um"'),
        )
        for key, wanted, words in cases:
            with self.subTest(key=key, wanted=wanted):
                result = self.calibrate("--vary", key, "--target", wanted, "--out", self.file, status=2)
                self.assert_says(result, words)
                self.assertEqual(result.stdout, "")
        self.assertFalse(self.file.exists())
        self.calibrate("--vary", vary, status=2)
        self.calibrate("--target", target, status=2)

    def test_files_are_not_replaced(self):
        arguments = ("--vary", f"{STIFFNESS}=0.1:20", "--target", "end.position_um=28")
        self.file.write_text("mine")
        self.assertIn("--overwrite", self.calibrate(*arguments, "--out", self.file, status=4).stderr)
        self.assertEqual(self.file.read_text(), "mine")
        self.calibrate(*arguments, "--out", self.file, "--overwrite")
        self.calibrate(*arguments, "--out", self.folder / "scenario.toml", "--overwrite", status=2)
        self.calibrate(*arguments, "--out", self.folder / "none" / "x.toml", status=4)
        self.calibrate(*arguments, "--out", self.folder / "x.txt", status=2)

    def test_options_of_gradients_need_the_method(self):
        result = self.calibrate("--vary", f"{STIFFNESS}=0.1:2", "--target", "end.position_um=25", "--starts", 2, status=2)
        self.assertIn("--starts: needs --method gradient", result.stderr)
        result = self.calibrate("--vary", f"{STIFFNESS}=0.1:2", status=2)
        self.assertIn("no target; give --target", result.stderr)

    def test_interrupted_it_leaves_the_best_so_far(self):
        slow = SOFT.replace("step_s = 0.5", "step_s = 0.001")
        with running("calibrate", self.write(slow), "--vary", f"{STIFFNESS}=0.1:20", "--target", "end.position_um=28~1e-12", "--out", self.file) as process:
            process.stdout.readline()
            process.stdout.readline()  # the first trial
            time.sleep(0.05)
            process.send_signal(signal.SIGINT)
            result = ended(process)
        self.assertEqual(result.returncode, 130, result.stderr)
        self.assertIn("interrupted after", result.stderr)
        self.assertIn("# Best result found", self.file.read_text())


if __name__ == "__main__":
    support.main()
