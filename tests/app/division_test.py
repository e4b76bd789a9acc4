"""[division.NAME] from outside: lineage, frames, series, rules, what is refused."""
import math

import support
from support import BLOCK, CommandLine, block, table

ROW = "format = 1\n" + block(60, 20, 40, [3, 1, 1]) + """\
[region.middle]
ids = [1]
[time]
end_s = 60
[stop]
at_equilibrium = false
[output]
frame_every_s = 20
"""
CUT = '[division.cut]\nregion = "middle"\nat_s = 15\nplane = "transverse"\ngrowth_s = 30\n'


class Divisions(CommandLine):
    def test_a_held_cell_that_is_to_grow_is_named(self):
        held = BLOCK.replace("end_s = 0.5", "end_s = 20") + """
[hold.all]
region = "all"
[region.one]
ids = [1]
[division.one]
region = "one"
at_s = 1
growth_s = 10
"""
        result = self.run_scenario(held, "--quiet", status=3)
        self.assertRegex(result.stderr, r"cell \d+ must change its volume, but all its corners are fixed: fix fewer")

    def test_a_cell_becomes_two_with_a_lineage(self):
        self.run_scenario(ROW + CUT)
        summary = self.summary()
        self.assertEqual((summary["cells"], summary["divisions"], summary["nodes"]), (4, 1, 20))
        self.assertLessEqual(summary["max_volume_error"], 1e-9)
        self.assertEqual([tuple(row.values()) for row in table(self.out / "lineage.csv")],
                         [("3", "1", "1", "15"), ("4", "1", "1", "15")])
        series = table(self.out / "series.csv")
        for row in series:
            self.assertEqual(row["cells"], "3" if float(row["time_s"]) <= 15 else "4")
        cells = table(self.out / "cells.csv")
        frames = sorted({float(row["time_s"]) for row in cells})
        self.assertEqual(frames, [0, 15, 20, 40, 60])
        for time in frames:
            at = [row for row in cells if float(row["time_s"]) == time]
            self.assertEqual(sorted(row["cell_id"] for row in at), ["0", "1", "2"] if time == 0 else ["0", "2", "3", "4"])
            daughters = [row for row in at if row["mother_id"]]
            self.assertTrue(all(row["generation"] == "1" and row["mother_id"] == "1" for row in daughters))
            expected = 8000 + 8000 * min(1, (time - 15) / 30)
            for row in daughters:
                self.assertAlmostEqual(float(row["volume_um3"]) / expected, 1, delta=1e-9)
        self.assert_whole(self.out)

    def test_rounds_follow_each_other_and_mothers_are_named(self):
        self.run_scenario(ROW + CUT + CUT.replace("cut", "again").replace("at_s = 15", "at_s = 30"))
        rows = {row["cell_id"]: row for row in table(self.out / "lineage.csv")}
        self.assertEqual(len(rows), 6)
        self.assertEqual({rows[cell]["mother_id"] for cell in "5678"}, {"3", "4"})
        self.assertEqual({rows[cell]["generation"] for cell in "5678"}, {"2"})

    def test_what_cannot_be_is_refused(self):
        cases = {
            "region": CUT.replace("middle", "midle"),
            "at and when": CUT + 'when = "area_above_um2"\nthreshold = 3\n',
            "when without threshold": CUT.replace("at_s = 15", 'when = "area_above_um2"'),
            "threshold without when": CUT + "threshold = 3\n",
            "every_s without when": CUT + "every_s = 3\n",
            "no time": CUT.replace("at_s = 15\n", ""),
            "at the start": CUT.replace("at_s = 15", "at_s = 0"),
            "plane": CUT.replace("transverse", "vertical"),
            "ratio": CUT + "daughter_volume_ratio = 0\n",
        }
        for what, text in cases.items():
            with self.subTest(what):
                self.assert_refused(ROW + text, "division.cut")
        self.assert_refused(ROW.replace("cells = [3, 1, 1]", "cells = [3, 1, 1]\nelements_per_cell = [2, 2, 2]") + CUT,
                            "division.cut")
        self.assert_refused(BLOCK.replace("cells = [3, 2, 1]", "cells = [3, 1, 2]") + CUT.replace("middle", "all"),
                            "division.cut")
        self.assert_refused(ROW.replace("end_s = 60", 'end_s = 60\nscheme = "linearly-implicit"') +
                            '[volume]\nmethod = "projection"\n' + CUT, "volume.method")


EGG = """\
format = 1
[embryo]
shape = "egg"
length_um = 300
diameter_um = 160
cell_count = 150
cell_height_um = 20
[elasticity]
corner_barrier_Pa = 100
[region.belly]
angle_deg = [-60, 60]
[time]
end_s = 80
[stop]
at_equilibrium = false
[output]
frame_every_s = 20
"""
ROUND = """\
[division.at_{0}]
region = "belly"
at_s = {0}
plane = "longest-axis"
daughter_volume_ratio = 0.5
growth_s = 10
max_generation = 3
"""


class Polygons(CommandLine):
    """150 polygons on an egg, of which 50 divide three times: 350 divisions."""
    TEXT = EGG + "".join(ROUND.format(at) for at in (10, 30, 50))

    def test_three_generations_keep_volumes_and_go_on_alike(self):
        self.run_scenario(self.TEXT)
        summary = self.summary()
        self.assertGreater(summary["divisions"], 200)
        self.assertLessEqual(summary["max_volume_error"], 1e-9)
        self.assertEqual(summary["self_intersections"], 0)
        self.assertEqual({row["generation"] for row in table(self.out / "lineage.csv")}, {"1", "2", "3"})
        rows = table(self.out / "cells.csv")
        volume_at = lambda time: sum(float(row["volume_um3"]) for row in rows if float(row["time_s"]) == time)
        self.assertAlmostEqual(volume_at(80) / volume_at(0), 1, delta=1e-9)  # halves have grown to halves
        self.assert_whole(self.out)

        part, other = self.folder / "part", self.folder / "other"
        self.run_scenario(self.TEXT.replace("end_s = 80", "end_s = 40"), out=part)
        self.run_scenario(self.TEXT, "--resume", out=part)
        self.run_scenario(self.TEXT, "--threads", "2", out=other)
        self.same_csv(self.out, other, "series.csv", "cells.csv", "lineage.csv")
        for extended, row in zip(table(part / "cells.csv"), rows, strict=True):
            for column in ("time_s", "volume_um3", "x_um", "apical_area_um2"):
                value = float(row[column])
                self.assertAlmostEqual(float(extended[column]), value, delta=1e-8 * max(1, abs(value)))


class BuiltIn(CommandLine):
    def test_division_demo_ends_with_four_equal_cells(self):
        self.call("run", "division-demo", "--out", self.out, "--quiet")
        rows = table(self.out / "cells.csv")
        end = max(float(row["time_s"]) for row in rows)
        last = [row for row in rows if float(row["time_s"]) == end]
        self.assertEqual(len(last), 4)
        for row in last:
            self.assertTrue(math.isclose(float(row["volume_um3"]), 16000, rel_tol=1e-9))
            self.assertTrue(math.isclose(float(row["apical_area_um2"]), 400, rel_tol=0.01))
            self.assertTrue(math.isclose(float(row["height_um"]), 40, rel_tol=0.01))


if __name__ == "__main__":
    support.main()
