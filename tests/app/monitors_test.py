"""[monitor.NAME] and [stop.NAME] from outside: columns, the summary, references, when and why a run stops."""
import math

import support
from support import BLOCK, CommandLine, table

SOFT = BLOCK.replace("end_s = 0.5\nstep_s = 0.1", "end_s = 5\nstep_s = 0.5").replace("frame_every_s = 0.2", "frame_every_s = 1")
MONITORS = """\
[region.first]
ids = [0]
[monitor.floor]
quantity = "position"
axis = "z"
face = "apical"
over = "max"
[monitor.motion]
quantity = "displacement"
[monitor.first]
quantity = "area"
region = "first"
[monitor.pull]
quantity = "force"
over = "max"
[monitor.clock]
quantity = "time"
[monitor.all]
quantity = "volume"
over = "sum"
"""
COLUMNS = ["all.volume_um3", "clock.time_s", "first.area_um2", "floor.position_um", "motion.displacement_um", "pull.force_nN"]


def without_wall(path):
    """The rows of a series less what the contract lets differ."""
    return [{key: value for key, value in row.items() if ".wall_" not in key} for row in table(path)]


class Monitors(CommandLine):
    def test_each_monitor_is_a_column_and_its_last_value_is_in_the_summary(self):
        self.run_scenario(BLOCK + MONITORS)
        rows = table(self.out / "series.csv")
        self.assertEqual(list(rows[0])[-len(COLUMNS) :], COLUMNS)
        self.assertEqual([float(rows[0][name]) for name in COLUMNS[:3]], [96000, 0, 400])
        self.assertEqual(float(rows[0]["motion.displacement_um"]), 0)
        self.assertGreater(float(rows[-1]["motion.displacement_um"]), 0)
        summary = self.summary()
        for name in COLUMNS:
            self.assertAlmostEqual(summary[name], float(rows[-1][name]), delta=1e-9 * abs(summary[name]), msg=name)
            self.assertEqual(float(rows[-1]["clock.time_s"]), float(rows[-1]["time_s"]))
        self.assertIsNone(summary["stopped_by"])
        self.assert_whole(self.out)
        again = self.folder / "again"
        self.call("run", self.out / "scenario.toml", "--out", again)
        self.same_csv(again, self.out, "series.csv")

    def test_a_monitor_may_be_read_at_a_time(self):
        def text(keys):
            return BLOCK + f'[monitor.motion]\nquantity = "displacement"\n{keys}\n'

        self.run_scenario(text("at_s = 0.25"))
        rows = {float(row["time_s"]): float(row["motion.displacement_um"]) for row in table(self.out / "series.csv")}
        before, after = max(t for t in rows if t <= 0.25), min(t for t in rows if t >= 0.25)
        self.assertLess(before, after)
        part = (0.25 - before) / (after - before)
        expected = (1 - part) * rows[before] + part * rows[after]
        self.assertAlmostEqual(self.summary()["motion.displacement_um"], expected, delta=1e-8)
        for keys, value in (("at_s = 0.2", rows[0.2]), ("at_min = 0", 0), ("at_s = 9", None), ("", rows[max(rows)])):
            self.run_scenario(text(keys), "--overwrite")
            found = self.summary()["motion.displacement_um"]
            self.assertIsNone(found) if value is None else self.assertAlmostEqual(found, value, delta=1e-8)

    def test_only_computing_time_differs_between_runs(self):
        text = BLOCK + MONITORS + '[monitor.cpu]\nquantity = "wall"\n'
        other = self.folder / "other"
        self.run_scenario(text)
        self.run_scenario(text, "--threads", "2", out=other)
        self.assertEqual(without_wall(self.out / "series.csv"), without_wall(other / "series.csv"))
        spent = [float(row["cpu.wall_s"]) for row in table(self.out / "series.csv")]
        self.assertEqual(spent, sorted(spent))
        self.assertGreater(spent[-1], 0)
        self.assertIn("cpu.wall_s", self.summary())

    def test_against_a_reference_run(self):
        self.run_scenario(BLOCK, out=self.folder / "reference")
        monitors = "".join(
            f'[monitor.{name}]\nquantity = "{quantity}"\nreference = "reference"\n{more}\n'
            for name, quantity, more in (("apart", "deviation", 'over = "max"'), ("end", "deviation", 'reference_at = "end"'),
                                         ("norm", "relative_energy_norm", "")))
        self.run_scenario(BLOCK + monitors)
        rows = table(self.out / "series.csv")
        at_frames = [row for row in rows if row["apart.deviation_um"] != ""]
        # Steps of 0.1 s, frames at 0, 0.2, 0.4 and 0.5 s: the same run is no distance away from itself.
        self.assertEqual([float(row["time_s"]) for row in at_frames], [0, 0.2, 0.4, 0.5])
        self.assertEqual({float(row["apart.deviation_um"]) for row in at_frames}, {0})
        self.assertEqual([row["norm.relative_energy_norm"] for row in at_frames], ["", "0", "0", "0"], "nothing is relative to rest")
        ends = [float(row["end.deviation_um"]) for row in rows]
        self.assertEqual(ends, sorted(ends, reverse=True))
        self.assertEqual(ends[-1], 0)
        # Half the force, about half the way.
        half = self.folder / "half"
        self.run_scenario(BLOCK + monitors, "--set", "contraction.all.stiffness_nN_per_um=0.5", out=half)
        self.assertAlmostEqual(self.summary(half)["norm.relative_energy_norm"], 0.5, delta=0.1)
        self.assertGreater(self.summary(half)["apart.deviation_um"], 0)
        # Another mesh has no nodes to compare: empty, and null.
        other = self.folder / "other"
        self.run_scenario((BLOCK + monitors).replace("[3, 2, 1]", "[4, 2, 1]"), out=other)
        self.assertEqual({row["apart.deviation_um"] for row in table(other / "series.csv")}, {""})
        self.assertIsNone(self.summary(other)["apart.deviation_um"])

    def test_distance_to_a_reference_surface(self):
        mesh = self.folder / "rest.vtu"
        self.call("mesh", self.write(BLOCK), "--out", mesh)
        self.run_scenario(BLOCK + '[monitor.skin]\nquantity = "surface_distance"\nreference = "rest.vtu"\nover = "max"\nface = "apical"\n')
        distances = [float(row["skin.surface_distance_um"]) for row in table(self.out / "series.csv")]
        self.assertLess(distances[0], 1e-9)
        moved = max(math.hypot(*(float(x) for x in point)) for point in self.last_displacements())
        self.assertGreater(distances[-1], 1e-3)
        self.assertLessEqual(distances[-1], moved + 1e-9)

    def last_displacements(self):
        values = support.read_vtu(sorted((self.out / "frames").iterdir())[-1])["displacement_um"][1]
        return zip(values[0::3], values[1::3], values[2::3])

    def test_references_that_cannot_be_used(self):
        empty = self.folder / "empty"
        empty.mkdir()
        (self.folder / "text.stl").write_text("nothing")
        no_frames = self.folder / "no_frames"
        no_frames.mkdir()
        (no_frames / "frames.pvd").write_text("<VTKFile><Collection></Collection></VTKFile>")
        for quantity, reference, part in (("deviation", "missing", "directory does not exist"), ("deviation", "empty", "frames.pvd"),
                                          ("deviation", "scenario.toml", "not a directory"), ("deviation", "no_frames", "no snapshot"),
                                          ("surface_distance", "missing.stl", "No such file"),
                                          ("surface_distance", "text.stl", "text.stl")):
            with self.subTest(reference):
                text = f'[monitor.a]\nquantity = "{quantity}"\nreference = "{reference}"\n' + BLOCK.replace("format = 1\n", "", 1)
                text = text.replace('title = "A small block"\n', "")
                self.assert_refused(text, part, line=3, key="monitor.a.reference")
        self.run_scenario(BLOCK)
        before = support.tree(self.out)
        own = f'[monitor.a]\nquantity = "deviation"\nreference = "{self.out}"\n'
        self.assert_says(self.run_scenario(BLOCK + own, "--overwrite", status=2), "reference")
        self.assertEqual(support.tree(self.out), before)

    def test_empty_regions_and_sides_name_their_line(self):
        self.assert_refused(BLOCK + '[region.none]\nx_um = [500, 600]\n[monitor.a]\nquantity = "speed"\nregion = "none"\n',
                            "no cell", line=19, key="region.none")
        two_layers = BLOCK.replace("[3, 2, 1]", "[3, 2, 2]")
        low = '[region.low]\nz_um = [-100, -1]\n[monitor.a]\nquantity = "area"\nregion = "low"\nface = "apical"\n'
        self.assert_refused(two_layers + low, "low", line=24, key="monitor.a.face")

    def test_an_expectation_of_a_monitor(self):
        expect = "[expect]\nall.volume_um3 = { value = 96000, within = 1e-3 }\n"
        self.run_scenario(BLOCK + MONITORS + expect)
        result = self.run_scenario(BLOCK + MONITORS + expect.replace("96000", "96001"), "--overwrite", status=1)
        self.assertIn("expect.all.volume_um3", result.stderr)


class Criteria(CommandLine):
    def stops(self, criteria, *arguments, text=SOFT, **options):
        """The last row and the summary of a run with these criteria."""
        self.run_scenario(text + MONITORS + criteria, "--overwrite", *arguments, **options)
        return table(self.out / "series.csv"), self.summary()

    def rows_of_the_whole_run(self):
        rows, summary = self.stops("")
        self.assertEqual((summary["status"], summary["stopped_by"], len(rows)), ("end_time", None, 11))
        return rows

    def test_a_run_stops_at_the_first_step_beyond_a_bound(self):
        whole = self.rows_of_the_whole_run()
        bound = (float(whole[4]["motion.displacement_um"]) + float(whole[5]["motion.displacement_um"])) / 2
        rows, summary = self.stops(f'[stop.moved]\nmonitor = "motion"\nabove = {bound}\n')
        self.assertEqual(rows, whole[:6])
        self.assertEqual((summary["status"], summary["stopped_by"], summary["time_s"]), ("end_time", "moved", 2.5))
        self.assertEqual(float(table(self.out / "cells.csv")[-1]["time_s"]), 2.5, "the last moment is a frame")
        rows, summary = self.stops(f'[stop.weak]\nmonitor = "first"\nbelow = {float(whole[3]["first.area_um2"]) + 1e-6}\n')
        self.assertEqual((rows, summary["stopped_by"]), (whole[:4], "weak"))

    def test_the_terminal_names_the_criterion(self):
        result = self.run_scenario(SOFT + MONITORS + '[stop.early]\nmonitor = "clock"\nabove = 0.9\n')
        self.assertIn("stopped by early", result.stdout)


if __name__ == "__main__":
    support.main()
