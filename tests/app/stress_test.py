"""The extremes of docs/developers/hostile_input.md one by one: each run ends, or reports where, when and why it failed."""
import support
from support import SPHERE, CommandLine

STRONG = SPHERE.replace("stiffness_nN_per_um = 8", "stiffness_nN_per_um = 80").replace("end_s = 0.3", "end_s = 600")
SOLVER_FAILED = r"solver failed: .*cell \d+.* at t = [\d.e+-]+ s"


class Stress(CommandLine):
    def outcome(self, text, *overrides):
        """Runs to an end that is allowed; the word for it."""
        sets = [part for override in overrides for part in ("--set", override)]
        result = self.run_scenario(text, "--quiet", "--overwrite", *sets, timeout=120, status=(0, 3))
        self.assert_whole(self.out)
        summary = self.summary()
        if result.returncode == 3:
            self.assertRegex(self.assert_messages(result)[0], SOLVER_FAILED)
            self.assertEqual(summary["status"], "failed")
        else:
            self.assertIn(summary["status"], ("equilibrium", "end_time"))
            self.assertLessEqual(summary["max_volume_error"], 1e-8)
            self.assertLessEqual(summary["max_shell_penetration_um"], 1e-6)
            self.assertGreater(summary["min_scaled_jacobian"], 0)
        return summary["status"]

    def outcomes(self, text, *settings):
        for overrides in settings:
            with self.subTest(overrides):
                print(" ".join(overrides), "->", self.outcome(text, *overrides))

    def test_contraction_ten_times_too_strong(self):
        self.outcomes(STRONG, ["contraction.apical.across_ratio=1"], ["contraction.apical.stiffness_nN_per_um=800"],
                      ["contraction.apical.region=all"])

    def test_nearly_incompressible_cells(self):
        moderate = SPHERE.replace("end_s = 0.3", "end_s = 60")
        for ratio in ("0.4999", "0.4999999999"):
            self.outcomes(moderate, [f"elasticity.poisson_ratio={ratio}"],
                          [f"elasticity.poisson_ratio={ratio}", "embryo.elements_per_cell=[2, 2, 2]"])
        self.run_scenario(moderate, "--set", "elasticity.poisson_ratio=0.4999", "--set", "volume.method=none", "--overwrite")

    def test_cells_flattened_fifty_to_one(self):
        flat = SPHERE.replace("cell_height_um = 30", "cell_height_um = 0.8").replace("end_s = 0.3", "end_s = 5")
        self.outcomes(flat, ["contraction.apical.stiffness_nN_per_um=0.01"], ["contraction.apical.stiffness_nN_per_um=8"])

    def test_steps_of_an_hour(self):
        for step in ("step_s", "max_step_s"):
            self.outcomes(SPHERE, [f"time.{step}=3600", "time.end_s=36000"])
        self.outcomes(STRONG, ["time.step_s=3600", "time.end_s=36000"])

    def test_a_shell_tighter_than_the_embryo(self):
        # A pressure from within, as strong as the cells and far stronger; and cells that grow until the lumen is full.
        pushed = SPHERE + '[pressure.out]\nregion = "all"\nface = "basal"\npressure_Pa = 1e3\n'
        self.outcomes(pushed, ["time.end_s=60"], ["time.end_s=60", "pressure.out.pressure_Pa=1e6"])
        grown = SPHERE + '[division.d]\nregion = "all"\nat_s = 0.1\ngrowth_s = 5\ndaughter_volume_ratio = 2\n'
        thick = ["embryo.cell_height_um=40", "furrow.vce_cell=1"]
        full = self.outcome(grown, "time.end_s=10", *thick)
        self.assertEqual(full, "failed", "four times the cells' volume do not fit into the shell")
        self.assertIn("; set division.d.daughter_volume_ratio = 1 (less growth, ", self.summary()["failure"])
        self.assertEqual(self.outcome(grown, "time.end_s=1", "division.d.daughter_volume_ratio=1", *thick), "end_time")


if __name__ == "__main__":
    support.main()
