"""A tissue that passes through itself says so: on the terminal, in summary, series, cells and pictures; the report's own
notice is in viewer/tests."""
import support
from support import CommandLine, block, table

# A strip that curls up until its ends pass through it.
SHEET = block(600, 20, 10, [60, 2, 1]) + """\
[dynamics]
surface_drag_Pa_s_per_um = 20
[contraction.apical]
region = "all"
tension_mN_per_m = 2
across_ratio = 0
[time]
end_min = 10
"""
# A small ball whose belly is pushed against its back.
BALL = """
[embryo]
shape = "sphere"
diameter_um = 100
cell_height_um = 10
cells = [6, 6, 6]
[region.belly]
face = "ventral"
[vitelline]
enabled = false
[pressure.push]
region = "belly"
face = "apical"
pressure_Pa = 60
program = { time_min = [0, 5], activity = [0, 1] }
[time]
end_min = 13
tolerance_um = 0.5
"""


class Crossing(CommandLine):
    def test_last_lines_say_since_when_and_a_remedy_that_works(self):
        result = self.run_scenario(BALL)
        self.assertRegex(result.stdout, r"\n  largest displacement [\d.]+ um, .*\n  self-intersects since 1[12]\.?\d* min \(20 pairs of faces "
                                        r"at most\); later results are unphysical; .*\n")
        remedy = '; set self_contact.surface to "both" to prevent it (except at the rim of an open tissue)\n'
        for told in (result.stdout, result.stderr):
            self.assertEqual(told.count(remedy), 1, told)
        self.assertTrue(660 < self.summary()["self_intersections_time_s"] < 780)
        result = self.run_scenario(BALL, "--overwrite", "--set", "self_contact.surface=both")
        self.assertNotIn("self-intersect", result.stdout + result.stderr)
        self.assertEqual((self.summary()["self_intersections"], self.summary()["self_intersections_time_s"]), (0, None))

    def test_of_a_sheet(self):
        result = self.run_scenario(SHEET, "--quiet")
        warnings = [line for line in result.stderr.splitlines() if line.startswith("warning: the tissue self-intersects")]
        self.assertEqual(len(warnings), 1, result.stderr)
        self.assertRegex(warnings[0], r"at t = [\d.]+ min \w+ faces of cells \d+ and \d+ cross at x = .* um \(\d+ pairs")
        pairs = [int(row["self_intersections"]) for row in table(self.out / "series.csv")]
        self.assertEqual(pairs[0], 0)
        self.assertEqual(self.summary()["self_intersections"], max(pairs))
        self.assertGreater(max(pairs), 0)
        rows = table(self.out / "cells.csv")
        flagged = [row for row in rows if row["self_intersecting"] == "1"]
        self.assertTrue(0 < len(flagged) < len(rows))
        last = [row for row in rows if row["time_s"] == rows[-1]["time_s"]]
        self.assertEqual(len(last), 120)
        picture = self.folder / "last.png"
        self.call("render", self.out, "--out", picture, "--time", "last", "--color", "self-intersections")
        self.assertTrue(picture.exists())
        self.assertIn('id="crossing"', (self.out / "report.html").read_text(encoding="utf-8"))

    def test_of_a_furrow_there_is_none(self):
        result = self.run_scenario('base = "drosophila"\n[time]\nend_min = 1\n', "--quiet")
        self.assertNotIn("self-intersect", result.stderr)
        self.assertEqual(self.summary()["self_intersections"], 0)


if __name__ == "__main__":
    support.main()
