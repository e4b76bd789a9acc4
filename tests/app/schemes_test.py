"""The ways to take a step: every combination of time.scheme and volume.method, or the reason why it is refused."""
import itertools
import math

import support
from support import BLOCK, SPHERE, CommandLine

PAPER = '[volume]\nmethod = "projection"\n'
LINEAR = "[time]\n", '[time]\nscheme = "linearly-implicit"\n'


class Schemes(CommandLine):
    def test_a_projection_of_cells_above_each_other_is_refused(self):
        self.assert_refused(BLOCK.replace("[3, 2, 1]", "[3, 2, 2]") + PAPER, "one layer of cells", "cell 0 at (", "has no",
                            key="volume.method", line=20)

    def test_every_combination_of_force_step_and_volumes(self):
        cases = 0
        for scheme, method, weights, step in itertools.product(
            ("newton", "linearly-implicit"), ("coupled", "projection", "none"), ("equal", "mobility"), ("adaptive", 0.1)
        ):
            if (scheme, method) == ("linearly-implicit", "coupled") or (method != "projection" and weights != "equal"):
                continue
            with self.subTest(f"{scheme}, {method}, {weights}, {step}"):
                text = SPHERE.replace(*LINEAR) if scheme != "newton" else SPHERE
                text += f'[volume]\nmethod = "{method}"\nprojection_weights = "{weights}"\n'
                self.run_scenario(text, "--set", f"time.step_s={step}", "--overwrite")
                self.assert_whole(self.out)
                summary = self.summary()
                self.assertEqual(summary["status"], "end_time")
                self.assertLessEqual(summary["max_shell_penetration_um"], 1e-6)
                self.assertGreater(summary["furrow_depth_um"], 0.01)
                self.assertGreaterEqual(summary["linear_iterations"], summary["newton_iterations"])
                if method == "none":
                    self.assertGreater(summary["max_volume_error"], 1e-5)
                else:
                    self.assertLessEqual(summary["max_volume_error"], 1e-9)
                for key in ("projection_sweeps", "cubic_solves", "cubic_three_real_roots"):
                    self.assertEqual(key in summary, method == "projection", key)
                if method == "projection":
                    self.assertGreater(summary["cubic_solves"], summary["cells"])
                    self.assertLess(summary["cubic_three_real_roots"], summary["cubic_solves"])
                if scheme == "linearly-implicit":
                    self.assertEqual(summary["newton_iterations"], summary["steps"])
                cases += 1
        self.assertEqual(cases, 14)

    def test_whole_surfaces(self):
        for surface in ("tissue", "embryo"):
            with self.subTest(surface):
                text = SPHERE.replace(*LINEAR) + PAPER + f'projection_surface = "{surface}"\n'
                self.run_scenario(text, "--set", "vitelline.enabled=false", "--overwrite")
                summary = self.summary()
                self.assertGreater(summary["max_volume_error"], 1e-5)  # of single cells
                self.assertLess(summary["cubic_solves"], 3 * summary["projection_sweeps"])

    def test_a_volume_that_cannot_be_kept_ends_with_status_3_and_says_which_when_and_why(self):
        # Inside its shell the whole embryo, lumen included, has nowhere to go.
        text = SPHERE.replace(*LINEAR).replace("end_s = 0.3", "end_s = 5\nstep_s = 5") + PAPER
        result = self.run_scenario(text + 'projection_surface = "embryo"\n', status=3)
        self.assert_says(result, "volume of the whole surface", "outside the shell", "1000 sweeps", "t = ")
        self.assert_whole(self.out)

    def test_any_number_of_threads_gives_the_same_bytes(self):
        self.assert_repeatable(SPHERE.replace(*LINEAR) + PAPER, *(["--threads", threads] for threads in "12"))

    def test_what_does_not_go_together_is_refused(self):
        self.assert_refused(BLOCK.replace(*LINEAR), "coupled", "projection", line=13, key="time.scheme")
        self.assert_refused(BLOCK + PAPER + 'projection_surface = "embryo"\n', "block", line=21,
                            key="volume.projection_surface")
        for key, value, needed in (("volume.projection_surface", '"tissue"', "projection"),
                                   ("volume.projection_weights", '"mobility"', "projection"),
                                   ("time.cg_tolerance", "0.001", "linearly-implicit"),
                                   ("time.cg_max_iterations", "7", "linearly-implicit")):
            with self.subTest(key):
                self.assert_refused(BLOCK, key, needed, arguments=["--set", f"{key}={value}"])

    def test_too_few_iterations_end_with_status_3(self):
        text = BLOCK.replace(*LINEAR) + PAPER
        result = self.run_scenario(text, "--set", "time.cg_max_iterations=1", status=3)
        self.assert_says(result, "conjugate gradients do not converge")

    def test_a_rougher_tolerance_takes_fewer_iterations_to_nearly_the_same(self):
        ends = []
        for tolerance in ("1e-3", "1e-9"):
            self.run_scenario(BLOCK.replace(*LINEAR) + PAPER, "--set", f"time.cg_tolerance={tolerance}", "--overwrite")
            ends.append(self.summary())
        self.assertLess(ends[0]["linear_iterations"], ends[1]["linear_iterations"])
        areas = [end["min_apical_area_ratio"] for end in ends]
        self.assertTrue(math.isclose(*areas, rel_tol=1e-3), areas)
        self.assertNotEqual(*areas)


if __name__ == "__main__":
    support.main()
