"""What a run leaves, and with which status it ends."""
import xml.etree.ElementTree
from pathlib import Path

import support
from support import BLOCK, CELL_DATA, CELLS, MIDLINE, POINT_DATA, RESULTS, SECTION, SERIES, SPHERE, SUMMARY
from support import CommandLine, block, read_vtu, table


class Outcomes(CommandLine):
    """What a run leaves, and with which status it ends."""

    def test_a_run_leaves_the_files_of_the_contract(self):
        self.run_scenario(SPHERE)
        self.assertEqual({path.name for path in self.out.iterdir()}, RESULTS)
        self.assert_whole(self.out)
        series = table(self.out / "series.csv")
        self.assertEqual(list(series[0])[: len(SERIES)], SERIES)
        self.assertEqual(list(series[0])[len(SERIES) :], [], "a column without a monitor")
        self.assertEqual(float(series[0]["time_s"]), 0)
        self.assertEqual(series[0]["speed_ratio"], "", "what has no value is left empty")
        self.assertTrue(all(float(a["time_s"]) < float(b["time_s"]) for a, b in zip(series, series[1:])))
        frames = sorted((self.out / "frames").iterdir())
        cells = table(self.out / "cells.csv")
        self.assertEqual(list(cells[0]), CELLS)
        self.assertEqual(len(cells), 130 * len(frames))
        self.assertEqual({row["activity"] for row in cells}, {"0", "1"})
        midline = table(self.out / "midline.csv")
        self.assertEqual(list(midline[0]), MIDLINE)
        self.assertEqual(len({row["time_s"] for row in midline}), len(frames))
        sections = table(self.out / "cross_section.csv")
        self.assertEqual(list(sections[0]), SECTION)
        self.assertEqual(len({row["time_s"] for row in sections}), len(frames))
        self.assertEqual({row["place_percent"] for row in sections}, {"25", "50", "75"})
        summary = self.summary()
        self.assertEqual([key for key in SUMMARY if key not in summary], [])
        self.assertEqual((summary["status"], summary["cells"], summary["nodes"]), ("end_time", 130, 264))
        self.assertEqual(summary["steps"], len(series) - 1)
        self.assertIsNone(summary["equilibrium_time_s"])
        self.assertLessEqual(summary["max_volume_error"], 1e-9)
        self.assertLessEqual(summary["max_shell_penetration_um"], 1e-6)
        for key in ("furrow_depth_um", "lip_distance_um", "vml_displacement_um", "vml_apical_area_ratio"):
            self.assertAlmostEqual(summary[key], float(series[-1][key]), delta=1e-8 * max(1, abs(summary[key])), msg=key)
        self.assertTrue({"version", "commit", "compiler", "threads"} <= set(summary["provenance"]))
        for key, value in summary.items():
            self.assertNotIsInstance(value, list)
            tables = ("provenance", "energy_by_law_nN_um", "tension_by_law_mN_per_m", "warnings")
            self.assertTrue(key in tables or not isinstance(value, dict), "flat")

    def test_rest_from_the_first_step_on_is_no_success_in_silence(self):
        result = self.run_scenario(BLOCK, "--set", "stop.at_equilibrium=true", "--set", "stop.equilibrium_speed_um_per_min=1e9")
        self.assertIn("after 1 step in", result.stdout)
        self.assert_says(result, "stop.equilibrium_speed_um_per_min (1e+09)")
        self.assertEqual(self.summary()["status"], "equilibrium")

    def test_every_column_is_in_the_documentation(self):
        page = (Path(__file__).resolve().parents[2] / "docs" / "reference" / "measures.md").read_text(encoding="utf-8")
        self.run_scenario(BLOCK + '[division.d]\nregion = "all"\nat_s = 0.2\n')
        frame = read_vtu(sorted((self.out / "frames").iterdir())[-1])
        arrays = {name for name, (section, _) in frame.items() if section in ("PointData", "CellData")}
        names = set(self.summary()) | {name for name in arrays if not name.startswith("region_")}
        tables = [self.out / f"{name}.csv" for name in ("series", "cells", "midline", "cross_section", "lineage")]
        for file in tables:
            names |= set(file.read_text().splitlines()[0].split(","))
        self.assertGreater(len(names), 60)
        self.assertEqual([name for name in sorted(names) if f"`{name}`" not in page], [])

    def test_frames_hold_the_fields_of_the_contract(self):
        self.run_scenario(BLOCK)
        frames = sorted((self.out / "frames").iterdir())
        pvd = list(xml.etree.ElementTree.parse(self.out / "frames.pvd").iter("DataSet"))
        self.assertEqual([float(entry.get("timestep")) for entry in pvd], [0, 0.2, 0.4, 0.5])
        self.assertEqual([self.out / entry.get("file") for entry in pvd], frames)
        arrays = read_vtu(frames[-1])
        self.assertLessEqual(POINT_DATA, {name for name, (section, _) in arrays.items() if section == "PointData"})
        self.assertLessEqual(CELL_DATA, {name for name, (section, _) in arrays.items() if section == "CellData"})
        self.assertEqual(set(arrays["region_all"][1]), {1})
        self.assertEqual(set(arrays["types"][1]), {12})
        self.assertEqual(arrays["cell_id"][1], tuple(range(6)))
        rest = {name: values for name, (_, values) in read_vtu(frames[0]).items()}
        moved = [p - q for p, q in zip(arrays["positions"][1] if "positions" in arrays else arrays["Points"][1],
                                       rest["positions"] if "positions" in rest else rest["Points"])]
        self.assertLess(max(abs(a - b) for a, b in zip(moved, arrays["displacement_um"][1])), 1e-9)
        self.assertGreater(max(map(abs, moved)), 1e-3)

    def test_scenario_as_given_and_as_resolved(self):
        text = "# a comment to keep\n" + BLOCK
        self.run_scenario(text, "--set", "time.end_s=0.3")
        self.assertEqual((self.out / "scenario.input.toml").read_text(), text)
        again = self.folder / "again"
        self.call("run", self.out / "scenario.toml", "--out", again)
        self.same_csv(again, self.out, "series.csv")

    def test_runs_are_repeatable_to_the_byte_with_any_number_of_threads(self):
        self.assert_repeatable(SPHERE, [], [], ["--threads", "1"], ["--threads", "2"])

    def test_a_missed_expectation_is_status_1_and_says_by_how_much(self):
        text = BLOCK + "[expect]\nmin_apical_area_ratio = { value = 0.5, within_percent = 1 }\n"
        text += "cells = { value = 6, within = 0 }\n"
        result = self.run_scenario(text, status=1)
        line = [line for line in (result.stdout + result.stderr).splitlines() if "min_apical_area_ratio" in line]
        self.assertEqual(len(line), 1, result.stdout + result.stderr)
        value = self.summary()["min_apical_area_ratio"]
        self.assertIn("0.5", line[0])
        self.assertIn(f"{value:.3f}"[:-1], line[0])
        self.assert_whole(self.out)
        self.run_scenario(text.replace("0.5, within_percent = 1", f"{value}, within_percent = 0.001"), "--overwrite")
        # What never happened cannot meet an expectation.
        self.run_scenario(BLOCK + "[expect]\nequilibrium_time_s = { value = 1, within = 1e9 }\n", "--overwrite", status=1)

    def test_each_warning_of_a_run_is_in_its_summary(self):
        text = (block(10, 60, 12, [2, 12, 1]) + '[contraction.apical]\nregion = "all"\nstiffness_nN_per_um = 1.5\nacross_ratio = 1\n[time]\nend_min = 8\n')
        for topic, *more in (("bending",), ("equilibrium", "--set", "stop.equilibrium_speed_um_per_min=1e9")):
            stderr = self.run_scenario(text, "--quiet", "--overwrite", *more).stderr
            lines = [line.removeprefix("warning: ") for line in stderr.splitlines() if line.startswith("warning: ")]
            self.assertEqual(list(self.summary()["warnings"].values()), lines)
            self.assertIn(topic, self.summary()["warnings"])

    def test_hostile_names_and_titles(self):
        for name in ("with spaces", "ünï-β", "it's \"quoted\"", "$HOME;x&<y>", "a\nb", "-dash"):
            with self.subTest(name):
                self.run_scenario(BLOCK, out=self.folder / name)
                self.assertEqual({path.name for path in (self.folder / name).iterdir()}, RESULTS)
                self.assert_whole(self.folder / name)
        title = "x" * 100000 + ' \\"quoted\\" \\u001b[31m ü <b>&amp;'
        self.run_scenario(BLOCK.replace("A small block", title))
        self.assertEqual(self.summary()["title"], title.replace('\\"', '"').replace("\\u001b", "\x1b"))
        self.call("check", self.out / "scenario.toml")


if __name__ == "__main__":
    support.main()
