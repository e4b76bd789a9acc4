"""plica reproduce with a file of experiments: verdicts, the report, and the same table whatever is killed."""
import os
import random
import shutil
import signal
import subprocess
import time
import tomllib
from pathlib import Path

import support
from support import BLOCK, CommandLine, ended, page_data, running, table

COARSE = """\
base = "drosophila"
embryo.cells = [12, 7, 6]
region.furrow = { cells_along = 8, cells_across = 3 }
furrow.vce_cell = 1
"""
EXPERIMENTS = """\
format = 1
title = "A small furrow"
scenario = "coarse.toml"
draws = "draws.csv"

[experiment.reference]
question = "Does it bend inward?"
role = "fitted"
set = { "time.end_min" = 0.2, "output.frame_every_min" = 0.1 }
[experiment.reference.outcome.depth]
observed = "It does."
source = "A book, 2020"
quantity = "furrow_depth_um"
hit = [0.1, 100]

[experiment.half]
question = "Half of the time: how deep?"
prediction = "miss"
because = "Half of the time is not enough."
set = { "time.end_min" = 0.1, "output.frame_every_min" = 0.1 }
[experiment.half.outcome.depth]
quantity = "furrow_depth_um"
over = "reference"
hit = [0.9, 1.1]
[experiment.half.outcome.lips]
question = "Do the lips meet?"
role = "seen"
quantity = "lips_closed_time_s"
hit_if_none = true

[experiment.long]
slow = true
draws = 2
question = "A little longer: deeper?"
prediction = "hit"
set = { "time.end_min" = 0.3, "output.frame_every_min" = 0.1 }
[experiment.long.outcome.depth]
quantity = "furrow_depth_um"
minus = "reference"
hit = [0, inf]
"""
DRAWS = "contraction.apical.stiffness_nN_per_um\n4\n5\n6\n7\n"
KILLS = int(os.environ.get("PLICA_STUDY_KILLS", "5"))


class Experiments(CommandLine):
    def setUp(self):
        super().setUp()
        self.file = self.write(EXPERIMENTS, "mine.toml")
        self.write(DRAWS, "draws.csv")
        self.write(COARSE, "coarse.toml")

    def reproduce(self, *arguments, **options):
        return self.call("reproduce", self.file, "--out", self.out, *arguments, **options)

    def rows(self):
        return table(self.out / "experiments.csv")

    def summaries(self):
        """When each run ended."""
        return {path: path.stat().st_mtime_ns for path in self.out.glob("runs/*/*/summary.json")}

    def outcomes(self):
        return table(self.out / "outcomes.csv")

    def test_the_tables_and_the_report(self):
        result = self.reproduce("--jobs", 2)
        self.assertRegex(result.stdout, r"mine: 4 outcomes: 3 hit, 1 miss\n  .*report\.html\n$")
        self.assertRegex(result.stderr, r"10 of 10 runs, 0.0 s left")
        rows = self.rows()
        self.assertEqual([(row["experiment"], row["outcome"], row["draw"]) for row in rows],
                         [(experiment, outcome, str(draw)) for experiment, outcome, draws in
                          (("reference", "depth", 4), ("half", "depth", 4), ("half", "lips", 4), ("long", "depth", 2))
                          for draw in range(1, draws + 1)])
        for row in rows:
            self.assertEqual(row["status"], "end_time")
            if row["experiment"] == "half" and row["outcome"] == "depth":
                self.assertAlmostEqual(float(row["number"]), float(row["own"]) / float(row["other"]), places=12)
                self.assertEqual(row["judgement"], "miss")
            if row["outcome"] == "lips":
                self.assertEqual((row["own"], row["number"], row["judgement"]), ("", "", "hit"))
        # The same numbers as of plica run.
        alone = self.folder / "alone"
        self.call("run", self.folder / "coarse.toml", "--set", "time.end_min=0.2", "--set", "output.frame_every_min=0.1", "--set",
                  "contraction.apical.stiffness_nN_per_um=6", "--out", alone, "--quiet")
        self.assertEqual(float(rows[2]["own"]), self.summary(alone)["furrow_depth_um"])
        short = self.out / "runs/reference/draw-3"
        self.same_csv(short, alone, "series.csv", "scenario.toml")

        table = self.outcomes()
        self.assertEqual([(row["role"], row["experiment"], row["outcome"], row["prediction"], row["verdict"]) for row in table],
                         [("predicted", "half", "depth", "miss", "miss"), ("predicted", "long", "depth", "hit", "hit"),
                          ("seen", "half", "lips", "", "hit"), ("fitted", "reference", "depth", "", "hit")])
        self.assertEqual([(row["hits"], row["draws"], row["probability_of_hit"]) for row in table[:2]],
                         [("0", "4", "1 to 45 %"), ("2", "2", "37 to 98 %")])
        self.assertEqual((table[3]["observed"], table[3]["source"]), ("It does.", "A book, 2020"))
        self.assertEqual(table[1]["criterion"], "furrow_depth_um minus that of reference, 0 or more")
        self.assertRegex(result.stdout, r"(?m)^miss +half, depth +0\.\d+  furrow_depth_um divided by that of reference, 0\.9 to 1\.1$")
        data = page_data(self.out / "report.html")
        self.assertEqual([run["name"] for run in data["runs"]], ["reference", "half", "long"])
        self.assertEqual([dict(zip(data["outcomes"]["columns"], row)) for row in data["outcomes"]["rows"]], table)

        # Nothing is left to do; a criterion may change without a run.
        before = self.summaries()
        self.assertEqual(len(before), 10)
        self.file.write_text(EXPERIMENTS.replace("[0.9, 1.1]", "[0.1, 1.1]"))
        self.assertIn("4 hit", self.reproduce().stdout)
        self.assertEqual(self.summaries(), before)
        # Not so a scenario.
        self.file.write_text(EXPERIMENTS.replace('"time.end_min" = 0.1', '"time.end_min" = 0.15'))
        self.assert_says(self.reproduce("--quiet", status=2), "runs/half/draw-1: was run with another scenario: time.end_s was 6 and is now 9")
        self.assertEqual(self.summaries(), before)
        shutil.rmtree(self.out / "runs/half")
        self.reproduce("--quiet")
        self.assertEqual({path: time for path, time in self.summaries().items() if "half" not in str(path)},
                         {path: time for path, time in before.items() if "half" not in str(path)})
        self.reproduce("--quiet", "--quick", "--overwrite")
        self.assertEqual(len(self.summaries()), 2)

    def test_any_number_of_jobs_and_any_kill_leave_the_same_table(self):
        self.reproduce("--jobs", 1, "--quiet")
        truth, table = (self.out / "experiments.csv").read_bytes(), (self.out / "outcomes.csv").read_bytes()
        shutil.rmtree(self.out)
        chance = random.Random(7)
        for _ in range(KILLS):
            with running("reproduce", self.file, "--out", self.out, "--jobs", 3, stdout=subprocess.DEVNULL) as process:
                time.sleep(chance.uniform(0.1, 0.6))
                process.send_signal(chance.choice([signal.SIGINT, signal.SIGKILL]))
                result = ended(process)
            if result.returncode == 130:
                self.assertIn("interrupted; to continue, repeat the command", result.stderr)
                self.assertLessEqual({row["status"] for row in self.rows()}, {"end_time", "not_run"})
            time.sleep(0.2)  # its workers end with it, and let go of their directories
        self.reproduce("--jobs", 2, "--quiet")
        self.assertEqual((self.out / "experiments.csv").read_bytes(), truth)
        self.assertEqual((self.out / "outcomes.csv").read_bytes(), table)
        self.assertFalse((self.out / "unfinished").exists())
        for run in self.out.glob("runs/*/draw-1"):
            self.assert_whole(run)

    def test_quick_is_the_first_draw_without_slow_experiments(self):
        self.out.mkdir()
        (self.out / "experiments.toml.17-0.part").write_text("ti")  # killed as it began
        self.reproduce("--quick", "--quiet")
        self.assertEqual([(row["experiment"], row["draw"]) for row in self.rows()], [("reference", "1"), ("half", "1"), ("half", "1")])
        before = self.summaries()
        self.reproduce("--quiet")  # and goes on to the others
        self.assertEqual(len(self.rows()), 14)
        self.assertEqual({path: time for path, time in self.summaries().items() if path in before}, before)

    def test_a_run_killed_over_its_report_gets_one(self):
        self.reproduce("--quick", "--quiet")
        before, run = self.summaries(), self.out / "runs/half/draw-1"
        (run / "report.html").rename(run / "report.html.17-0.part")
        self.reproduce("--quick", "--quiet")
        self.assert_whole(run)
        self.assertTrue((run / "report.html").exists())
        self.assertEqual([path.parts[-3] for path, time in self.summaries().items() if time != before[path]], ["half"])

    def test_a_run_that_gives_up_is_no_miss(self):
        self.write(BLOCK, "block.toml")
        self.write("contraction.all.preload_nN\n0\n-1e6\n", "draws.csv")
        self.file.write_text("""\
scenario = "block.toml"
draws = "draws.csv"
[experiment.block]
question = "Does it live?"
prediction = "hit"
[experiment.block.outcome.time]
quantity = "time_s"
hit = [0.4, 0.6]
""")
        result = self.reproduce("--quiet")
        self.assertRegex(self.assert_messages(result)[0], "not solved: block, draw 2: failed: .*cell")
        self.assertEqual([(row["status"], row["own"], row["judgement"]) for row in self.rows()],
                         [("end_time", "0.5", "hit"), ("failed", "", "not solved")])
        row, = self.outcomes()
        self.assertEqual((row["hits"], row["draws"], row["not_solved"], row["verdict"]), ("1", "2", "1", "undecided"))

    def test_what_cannot_be_done_says_so_and_leaves_nothing(self):
        for what, words in (("livign", "not a file or built-in experiments"), (self.folder, "Is a directory")):
            self.assert_says(self.call("reproduce", what, "--out", self.out, status=(2, 4)), words)
        self.write("contraction.apical.stiffness_nN_per_um\n4\n-5\n", "draws.csv")
        message = self.assert_messages(self.reproduce(status=2))[0]
        self.assertRegex(message, r"draws.csv:3: column 1 \(contraction.apical.stiffness_nN_per_um\): -5 is out of range; set ")
        self.assertFalse(self.out.exists())
        self.write(DRAWS, "draws.csv")
        self.out.mkdir()
        (self.out / "mine.txt").write_text("of somebody")
        for more in ((), ("--overwrite",)):
            self.assert_says(self.reproduce(*more, status=2), "contains no experiments; give another --out")
        self.assertEqual([path.name for path in self.out.iterdir()], ["mine.txt"])

    def test_claims_are_reproduced_in_every_reading_or_in_the_first(self):
        claim = """
[experiment.{0}.outcome.depth]
question = "How deep?"
source = "3.1"
quantity = "first(furrow_depth_um > furrow_depth_um@6 / 2)"
hit = [{1}]
"""
        self.file.write_text(EXPERIMENTS.split("[experiment.half]")[0].replace('title', 'kind = "claims"\ntitle').replace(
            "quantity = \"furrow_depth_um\"", "quantity = \"furrow_depth_um@6 / half\"\nbecause = \"It is soft.\"").replace(
            "[experiment.reference]", "[quantity]\nhalf = \"furrow_depth_um@3\"\n\n[experiment.reference]")
            + "[experiment.all]\nset = { \"time.end_min\" = 0.2 }" + claim.format("all", "0, 12")
            + "[experiment.first]\ndraws = 1\nset = { \"time.end_min\" = 0.2 }" + claim.format("first", "0, 12")
            + "[experiment.none]\ndrawn = false\nset = { \"time.end_min\" = 0.2 }" + claim.format("none", "0, 12")
            + "[experiment.late]\nset = { \"time.end_min\" = 0.2 }" + claim.format("late", "12, 20"))
        self.reproduce("--quiet")
        self.assertEqual({row["experiment"]: row["verdict"] for row in self.outcomes()},
                         {"reference": "under this reading", "all": "reproduced", "first": "under this reading", "none": "reproduced",
                          "late": "not reproduced"})

    def test_the_living_embryo_has_one_frozen_set(self):
        """Its values stand in two scenarios, too, which people read and change."""
        scenarios = Path(__file__).resolve().parents[2] / "scenarios"
        for file, not_in in (("living/embryo.toml", []), ("drosophila-atlas-living.toml", ["cortex.apical.profile.sigma_cells"])):
            scenario = tomllib.loads((scenarios / file).read_text())
            for key, value in support.table(scenarios / "living/draws.csv")[0].items():
                table = scenario
                for part in key.split("."):
                    table = table.get(part, {})
                self.assertEqual(table, {} if key in not_in else float(value), f"{file}: {key}")


if __name__ == "__main__":
    support.main()
