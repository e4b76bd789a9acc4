"""The same scenario gives the same results: to the bit for any number of threads and again and again; with any kernels, and from
another build, but for what rounding does.

By hand, beside another build: sameness_test.py PROGRAM --beside OTHER_PROGRAM with Sameness.test_debug_build and
Sameness.test_debug_build_with_multigrid (the same bits), or Sameness.test_another_build (but for rounding).
"""
import os
import re
import subprocess

import support
from resuming import Resuming, results
from support import plica, table

# So many elements that every loop is shared between threads.
LARGE = ["drosophila", "--set", "embryo.elements_per_cell=[2,2,2]", "--set", "time.end_s=0.1", "--set", "output.frame_every_s=0.05"]
# How far columns of series.csv may be apart, of the largest value of each: rounding, carried through a whole run.
ROUNDING = 1e-7
OTHER_PROGRAM = None


class Sameness(Resuming):
    def test_any_number_of_threads_and_again(self):
        expected = None
        for threads in (1, 2, 4, 2):
            out = self.folder / f"threads_{threads}"
            # What is set for all tests would win.
            environment = {key: value for key, value in os.environ.items() if key != "OMP_NUM_THREADS"}
            self.call("run", *LARGE, "--threads", threads, "--out", out, "--overwrite", env=environment, timeout=280)
            found = results(out)
            expected = expected or found
            with self.subTest(threads=threads):
                self.assertEqual(sorted(found), sorted(expected))
                self.assertEqual([name for name in found if found[name] != expected[name]], [])

    # The program begins anew to tell GCC's OpenMP so (src/app/threads.hpp), once, and not where the user has.
    def test_several_threads_wait_shortly(self):
        scenario = self.write(support.BLOCK)
        usual = {name: value for name, value in os.environ.items() if not name.startswith(("OMP_", "GOMP_"))}

        def spin_counts(threads, **variables):
            result = self.call("run", scenario, "--threads", threads, "--out", self.out, "--overwrite",
                               env={**usual, **variables, "OMP_DISPLAY_ENV": "verbose"})
            return re.findall(r"GOMP_SPINCOUNT = '(\w+)'", result.stderr)

        alone = spin_counts(1)
        if not alone:
            self.skipTest("not GCC's OpenMP")
        self.assertEqual(len(alone), 1)
        self.assertEqual(spin_counts(2), [*alone, "2000"])
        self.assertEqual(spin_counts(2, GOMP_SPINCOUNT="77"), ["77"])
        self.assertEqual(spin_counts(2, OMP_WAIT_POLICY="PASSIVE"), ["0"])

    def test_several_threads_read_a_scenario_from_a_pipe(self):
        usual = {name: value for name, value in os.environ.items() if not name.startswith(("OMP_", "GOMP_"))}
        resolved = []
        for threads in (1, 2):
            end, beginning = os.pipe()
            os.write(beginning, support.BLOCK.encode())
            os.close(beginning)
            self.call("run", f"/dev/fd/{end}", "--threads", threads, "--out", self.out, "--overwrite", env=usual, pass_fds=(end,))
            os.close(end)
            resolved.append((self.out / "scenario.toml").read_text())
        self.assertEqual(*resolved)

    def available_kernels(self):
        refusal = plica("run", "drosophila", "--out", self.out, env=os.environ | {"PLICA_KERNELS": "?"})
        return refusal.stderr.split("this machine has ")[1].strip().split(", ")

    def test_any_kernels_but_for_rounding(self):
        series = {}
        for kernels in self.available_kernels():
            out = self.folder / kernels
            self.call("run", "drosophila", "--out", out, env=os.environ | {"PLICA_KERNELS": kernels}, timeout=120)
            series[kernels] = table(out / "series.csv")
        apart = max(self.assert_same_but_for_rounding(rows, series["generic"]) for rows in series.values())
        print(f"kernels {', '.join(series)}: series agree to {apart:.1e} of the largest value of a column")

    def assert_same_but_for_rounding(self, rows, expected):
        """How far two series are apart, of the largest value of a column."""
        self.assertEqual(len(rows), len(expected))
        largest = 0
        for column in expected[0]:
            if column in ("max_volume_error", "max_shell_penetration_um", "newton_iterations", "linear_iterations", "refused_steps",
                          "highest_points_distance_um"):
                continue  # of how it is computed; of two points as high, rounding decides which is the highest
            values = [[float(row[column] or "nan") for row in of] for of in (rows, expected)]
            self.assertEqual([value == value for value in values[0]], [value == value for value in values[1]], column)
            scale = max((abs(value) for value in values[1] if value == value), default=0)
            difference = max((abs(a - b) for a, b in zip(*values) if a == a), default=0)
            self.assertLessEqual(difference, ROUNDING * scale, column)
            largest = max(largest, difference / scale if scale else 0)
        return largest

    def run_other(self, arguments):
        """Runs a scenario with this program, into folder/whole, and with the other one, into out."""
        if OTHER_PROGRAM is None:
            self.skipTest("by hand, with --beside")
        support.count_case()
        self.whole_run(arguments)
        result = subprocess.run([OTHER_PROGRAM, "run", *arguments, "--out", self.out], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_debug_build(self):
        self.run_other(["drosophila"])
        self.assert_same(self.out, results(self.folder / "whole"))

    def test_debug_build_with_multigrid(self):
        self.run_other(LARGE)
        self.assert_same(self.out, results(self.folder / "whole"))

    def test_another_build(self):
        self.run_other(["drosophila"])
        apart = self.assert_same_but_for_rounding(table(self.out / "series.csv"), table(self.folder / "whole" / "series.csv"))
        print(f"the other build's series is {apart:.1e} of the largest value of a column apart")


if __name__ == "__main__":
    OTHER_PROGRAM = support.option("--beside")
    support.main()
