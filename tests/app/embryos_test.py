"""The two embryos of the paper, whole: what the built-in scenarios promise, symmetry, and a rest state that no step changes."""
import functools
import json
import tempfile
import unittest
from pathlib import Path

import support


@functools.cache
def run(scenario, *overrides):
    """Runs a scenario; its summary and the last frame's rows of cells.csv. Fails unless plica is satisfied."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        support.plica("run", scenario, "--out", out, "--quiet", *overrides, timeout=300).check_returncode()
        rows = support.table(out / "cells.csv")
        return json.loads((out / "summary.json").read_text()), [row for row in rows if row["time_s"] == rows[-1]["time_s"]]


class Embryos(unittest.TestCase):
    def setUp(self):
        self.drosophila, self.pill = run("drosophila")
        self.xenopus, self.sphere = run("xenopus")

    def test_drosophila_is_what_the_paper_prints(self):
        # The figures and margins of the paper's table; the scenario's own [expect] has been met, or run() had failed.
        s = self.drosophila
        self.assertEqual(s["status"], "equilibrium")
        self.assertAlmostEqual(s["time_s"], 900, delta=45)
        self.assertAlmostEqual(s["furrow_depth_um"], 28.89, delta=0.05 * 28.89)
        self.assertAlmostEqual(s["vml_apical_area_ratio"], 0.70, delta=0.02)
        self.assertGreaterEqual(s["peak_speed_ratio"], 2.5)
        self.assertTrue(7 <= s["vml_displacement_at_equal_speed_um"] <= 10)
        self.assertTrue(13 <= s["vce_displacement_at_equal_speed_um"] <= 17)
        self.assertLessEqual(s["max_volume_error"], 1e-9)
        self.assertLessEqual(s["max_shell_penetration_um"], 1e-6)

    def test_the_sphere_folds_at_once_the_pill_from_its_ends(self):
        s = self.xenopus
        self.assertEqual(s["status"], "equilibrium")
        self.assertAlmostEqual(s["furrow_depth_um"], 27.44, delta=0.10 * 27.44)
        self.assertTrue(1.0 <= s["peak_speed_ratio"] <= 1.6)
        self.assertLess(s["peak_speed_ratio"], self.drosophila["peak_speed_ratio"])
        self.assertLess(s["ends_lead_until_s"], self.drosophila["ends_lead_until_s"])

    def test_folds_under_the_other_elasticity_too(self):
        # Its own [expect] has been met, or run() had failed; here, that it is another law and the same furrow.
        s = run("drosophila-shape-memory")[0]
        self.assertEqual(s["status"], "equilibrium")
        self.assertAlmostEqual(s["furrow_depth_um"], self.drosophila["furrow_depth_um"], delta=0.5)
        self.assertGreater(s["vml_apical_area_ratio"], self.drosophila["vml_apical_area_ratio"] + 0.02)

    def test_deep_furrow_lies_well_below_its_lips(self):
        # Its own [expect] has been met, or run() had failed.
        s = run("drosophila-deep")[0]
        self.assertEqual(s["status"], "equilibrium")
        self.assertGreaterEqual(s["furrow_depth_below_lips_um"], 20)
        self.assertGreaterEqual(s["min_scaled_jacobian"], 0.5)

    def test_symmetric_left_right_and_front_back(self):
        compared = 0
        for rows in (self.pill, self.sphere):
            places = sorted((float(r["x_um"]), float(r["y_um"]), float(r["z_um"]), float(r["volume_um3"]),
                             float(r["apical_area_um2"])) for r in rows)
            for mirror in ((-1, 1), (1, -1)):
                # The nearest cell of the mirrored sheet, among those with about the same z and area.
                for x, y, z, volume, area in places:
                    nearest = min(abs(x * mirror[0] - p[0]) + abs(y * mirror[1] - p[1]) + abs(z - p[2]) for p in places)
                    self.assertLess(nearest, 1e-6)
                    compared += 1
        print(f"{compared} cells compared with their mirror images")

    def test_half_an_embryo_is_shown_as_the_whole(self):
        summary, half = run("drosophila", "--set", 'embryo.mirror=["x"]')
        self.assertEqual(summary["cells"], 756)
        self.assertEqual(len(half), len(self.pill))
        for column, size in (("x_um", 1), ("y_um", 1), ("z_um", 1), ("volume_um3", 1e4), ("apical_area_um2", 500), ("pressure_Pa", 200),
                             ("activity", 1)):
            apart = max(abs(float(a[column]) - float(b[column])) for a, b in zip(half, self.pill))
            self.assertLess(apart, 1e-5 * size, column)


if __name__ == "__main__":
    support.main()
