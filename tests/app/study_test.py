"""plica study from outside: the table, whatever is killed and whoever runs it."""
import contextlib
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from pathlib import Path

import support
from support import CommandLine, running, table

# A short run of a coarse embryo.
SET = {"time.end_min": 0.2, "output.frame_every_min": 0.1, "embryo.cells": [12, 7, 6], "region.furrow.cells_along": 8,
       "region.furrow.cells_across": 3, "furrow.vce_cell": 1}
SETTINGS = "\n".join(f'"{key}" = {value}' for key, value in SET.items())
STUDY = f"""\
format = 1
scenario = "drosophila"
[set]
{SETTINGS}
[vary]
"contraction.apical.stiffness_nN_per_um" = {{ low = 3, high = 7 }}
[design]
kind = "latin-hypercube"
points = 24
[keep]
measures = ["furrow_depth_um", "max_volume_error"]
"""
# A longer trial: PLICA_STUDY_KILLS=100 PLICA_STUDY_POINTS=200.
KILLS = int(os.environ.get("PLICA_STUDY_KILLS", "5"))
POINTS = int(os.environ.get("PLICA_STUDY_POINTS", "24"))


def children(process):
    pids = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False).stdout
    return [int(pid) for pid in pids.split()]


class Study(CommandLine):
    def study(self, *arguments, text=STUDY, **options):
        self.file = self.write(text)
        return self.call("study", self.file, "--out", self.out, *arguments, **options)

    def table(self):
        """All but wall_s."""
        return [{key: value for key, value in row.items() if key != "wall_s"} for row in table(self.out / "runs.csv")]

    def rows_written(self):
        return sum(len(file.read_text().splitlines()) for file in (self.out / "rows").iterdir())

    def test_the_table(self):
        result = self.study("--jobs", 1)
        self.assertRegex(result.stdout, r"24 runs: 24 end_time in .*; sum of run times .* s\n  table in .*runs\.csv(; open .*report\.html in a browser)?\n")
        rows = self.table()
        self.assertEqual(list(rows[0]), ["point", "contraction.apical.stiffness_nN_per_um", "replicate", "status",
                                         "furrow_depth_um", "max_volume_error", "steps", "reason"])
        self.assertEqual([row["point"] for row in rows], [str(n) for n in range(1, 25)])
        first = self.folder / "first"
        key = "contraction.apical.stiffness_nN_per_um"
        settings = [f"--set={name}={value}" for name, value in {**SET, key: rows[0][key]}.items()]
        self.call("run", "drosophila", *settings, "--out", first, "--quiet")
        self.assertEqual(float(rows[0]["furrow_depth_um"]), self.summary(first)["furrow_depth_um"])

    def test_any_number_of_jobs_and_any_kill_leave_the_same_table(self):
        text = STUDY.replace("points = 24", f"points = {POINTS}")
        self.study("--jobs", 1, "--quiet", text=text)
        truth = self.table()
        chance = random.Random(5)
        shutil.rmtree(self.out)
        for _ in range(KILLS):
            with running("study", self.file, "--out", self.out, "--resume", "--jobs", 3, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                time.sleep(chance.uniform(0.1, 0.5))
                at = chance.choice(["parent", "child", "interrupt"])
                victims = children(process)
                if at == "child" and victims and process.poll() is None:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(chance.choice(victims), signal.SIGKILL)
                    time.sleep(0.2)
                if process.poll() is None:
                    process.send_signal(signal.SIGINT if at == "interrupt" else signal.SIGKILL)
                process.wait()
            for _ in range(100):  # children end with their parent
                if not any(Path(f"/proc/{pid}").exists() for pid in victims):
                    break
                time.sleep(0.05)
            else:
                self.fail("a worker outlives its study")
        self.study("--resume", "--jobs", 2, "--quiet", text=text)
        self.assertEqual(self.table(), truth)
        self.assertEqual(self.rows_written(), len(truth))  # none was run again that had a row

    def test_an_interruption_leaves_a_table(self):
        self.file = self.write(STUDY)
        with running("study", self.file, "--out", self.out, "--jobs", 1) as process:
            while not list(self.out.glob("rows/*")):
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            result = support.ended(process)
        self.assertEqual(result.returncode, 130)
        self.assertIn("--resume", result.stderr)
        statuses = {row["status"] for row in self.table()}
        self.assertEqual(statuses, {"end_time", "not_run"})
        told = self.call("study", "status", self.out)
        self.assertRegex(told.stdout, r"24 runs: \d+ end_time, \d+ not run")
        self.assertIn(f"plica study {self.file} --out {self.out} --resume", told.stdout)
        self.assertIn(f"plica study gather {self.out}", told.stdout)
        # As after a kill, which leaves no table: it is there as soon as the study goes on.
        (self.out / "runs.csv").unlink()
        with running("study", self.file, "--out", self.out, "--resume", "--jobs", 1, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
            for _ in range(1000):
                if (self.out / "runs.csv").exists():
                    break
                time.sleep(0.01)
        self.assertEqual(len(self.table()), 24)
        self.call("study", "status", self.folder, status=4)

    def test_a_failed_point_is_a_row(self):
        # Each of these steps is one, but not every pair.
        text = STUDY.replace("{ low = 3, high = 7 }", '{ values = [3, 100] }\n"time.first_step_s" = { values = [2, 5] }\n'
                             '"time.max_step_s" = { values = [4, 10] }').replace('"latin-hypercube"\npoints = 24', '"grid"')
        result = self.study(text=text)
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["end_time", "end_time", "refused", "end_time", "failed", "failed", "refused", "failed"])
        self.assertIn("5 is above max_step_s, 4", rows[2]["reason"])
        self.assertIn("2 x ", result.stdout)
        checked = self.call("check", self.file)
        self.assertIn("2 points are invalid", checked.stdout)
        self.assertIn("estimate for all runs", checked.stdout)

    def test_what_each_run_leaves(self):
        text = STUDY.replace("points = 24", "points = 3")
        self.study(text=text + 'each = "summary"\n')
        self.assertEqual(self.summary(self.out / "points/000002")["status"], "end_time")
        shutil.rmtree(self.out)
        self.study("--jobs", 3, text=text + 'each = "full"\n')
        for point in range(1, 4):
            self.assertTrue((self.out / f"points/{point:06}/report.html").is_file())
        table = self.table()
        shutil.rmtree(self.out / "rows")
        (self.out / "rows").mkdir()
        self.study("--resume", text=text + 'each = "full"\n')  # from what is there
        self.assertEqual(self.table(), table)

    def test_what_does_not_go_on(self):
        few = STUDY.replace("points = 24", "points = 2")
        self.study(text=few)
        self.assertIn("--resume", self.study(text=few, status=2).stderr)
        self.study("--resume", text=few + "\n# a word\n")
        self.assertIn("has changed since its start: vary.contraction.apical.stiffness_nN_per_um.high was 7 and is now 8; revert the change",
                      self.study("--resume", text=few.replace("high = 7", "high = 8"), status=2).stderr)
        own = self.folder / "own.toml"
        own.write_text('base = "drosophila"\ntime.end_min = 0.2\n')
        of_own = few.replace('"drosophila"', '"own.toml"').replace('"time.end_min" = 0.2\n', "")
        self.study("--overwrite", text=of_own)
        own.write_text('base = "drosophila"\ntime.end_min = 0.3\n')
        self.assertRegex(self.study("--resume", text=of_own, status=2).stderr,
                         r"own\.toml has changed since .* time\.end_s was 12.* and is now 18.*--overwrite")
        self.study("--overwrite", text=few)
        for flags in ([], ["--overwrite"], ["--resume"]):
            refused = self.call("run", "drosophila", "--set", "time.end_min=0.1", "--out", self.out, *flags, status=2)
            self.assertIn("contains a study; give another --out", refused.stderr)
        before = (self.out / "runs.csv").read_bytes()
        begun = self.out / "study.json"
        begun.write_text(begun.read_text().replace('"plica": "', '"plica": "9.'))
        self.assertIn("begun by plica 9.", self.study("--resume", text=few, status=2).stderr)
        begun.write_text("{")
        self.assertIn("damaged", self.study("--resume", text=few, status=4).stderr)
        self.assertEqual((self.out / "runs.csv").read_bytes(), before)
        self.study("--overwrite", text=few)
        foreign = self.folder / "foreign"
        foreign.mkdir()
        (foreign / "thesis.txt").write_text("mine")
        (foreign / "points").mkdir()
        for flags in ([], ["--resume"], ["--overwrite"]):
            self.call("study", self.file, "--out", foreign, *flags, status=2)
            self.assertEqual(sorted(p.name for p in foreign.iterdir()), ["points", "thesis.txt"])
        (self.folder / "own.toml").write_text('base = "drosophila"\n')
        (self.folder / "owl.toml").write_text(STUDY.replace('"drosophila"', '"onw.toml"'))
        for arguments, told in [(["study", self.folder / "own.toml", "--out", "x"], "is a scenario, not a study; run it with plica run"),
                                (["study", "drosophila", "--out", "x"], "is a scenario, not a study; run it with plica run"),
                                (["run", self.file, "--out", "x"], "is a study, not a scenario; run it with plica study"),
                                (["study", self.folder / "owl.toml", "--out", "x"], 'use "own.toml"')]:
            self.assertIn(told, self.call(*arguments, status=2).stderr)
        for arguments, told in [([], "STUDY: missing"), ([self.file], "--out"), (["none.toml", "--out", "x"], "none.toml")]:
            self.assertIn(told, self.call("study", *arguments, status=(2, 4)).stderr)

    def test_a_full_disk(self):
        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (900, 900))

        text = STUDY.replace("points = 24", "points = 12")
        self.study("--jobs", 1, "--quiet", text=text)
        truth = self.table()
        shutil.rmtree(self.out / "rows")
        (self.out / "rows").mkdir()
        result = self.study("--resume", "--jobs", 1, text=text, preexec_fn=small_files, status=4)
        self.assertIn("cannot be written", result.stderr)
        self.study("--resume", "--jobs", 1, "--quiet", text=text)
        self.assertEqual(self.table(), truth)

    def test_points_of_a_file(self):
        (self.folder / "points.csv").write_text("contraction.apical.stiffness_nN_per_um,contraction.apical.region\n3.5,furrow\n4,all\n")
        text = STUDY[:STUDY.index("[vary]")] + '[design]\nkind = "file"\nfile = "points.csv"\n[keep]\nmeasures = ["furrow_depth_um"]\n'
        self.study(text=text)
        self.assertEqual([row["contraction.apical.region"] for row in self.table()], ["furrow", "all"])
        (self.folder / "points.csv").write_text("contraction.apical.stiffness_nN_per_um\n3.5,furrow\n")
        self.assertRegex(self.study("--overwrite", text=text, status=2).stderr, r"points\.csv:2: has 2 values")
        (self.folder / "points.csv").write_text("")
        self.assertIn("no points", self.study("--overwrite", text=text, status=2).stderr)


if __name__ == "__main__":
    support.main()
