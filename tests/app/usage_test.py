"""Commands and options: help, usage, what `check` prints, --set, --quiet."""
import os
import pty
import select
import shutil

import support
from support import BLOCK, CommandLine, plica


class Usage(CommandLine):
    def test_help_of_every_command_has_an_example(self):
        top = plica("--help")
        self.assertEqual(top.returncode, 0)
        for command in ("run", "check", "mesh", "scenarios", "compare"):
            with self.subTest(command):
                self.assertIn(command, top.stdout)
                result = plica(command, "--help")
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                self.assertRegex(result.stdout, rf"Example.*plica {command}")

    def test_version_names_version_commit_and_compiler(self):
        result = plica("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^plica \d+\.\d+\.\d+ \([^,]+, .*(GNU|Clang).*\)$")

    def test_scenarios_are_listed_one_a_line(self):
        result = plica("scenarios")
        self.assertEqual(result.returncode, 0)
        names = [line.split()[0] for line in result.stdout.splitlines()]
        self.assertIn("drosophila", names)
        self.assertIn("xenopus", names)
        for name in names:
            with self.subTest(name):
                self.assertEqual(plica("check", name).returncode, 0)

    def test_bad_usage_is_status_2(self):
        scenario = self.write(BLOCK, "small.toml")
        for arguments in (
            [],
            ["rum", scenario],
            ["run"],
            ["run", scenario],
            ["run", scenario, "--out"],
            ["run", scenario, "--out", self.out, "--threads", "0"],
            ["run", scenario, "--out", self.out, "--threads", "many"],
            ["run", scenario, "--out", self.out, "--unknown"],
            ["run", scenario, scenario, "--out", self.out],
            ["run", scenario, "--out", ""],
            ["mesh", scenario],
            ["scenarios", "more"],
        ):
            with self.subTest(arguments):
                result = plica(*arguments, cwd=self.folder)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertTrue(result.stderr.strip())
                written = [path for path in self.folder.iterdir() if path != scenario]
                for path in written:
                    shutil.rmtree(path) if path.is_dir() else path.unlink()
                self.assertEqual(written, [], "something was written")

    def test_a_misspelt_command_or_option_is_answered_with_the_nearest(self):
        for arguments, said in (
            (["runn", "drosophila"], 'unknown command "runn"; use "run" (nearest match)'),
            (["zzz"], 'unknown command "zzz"; use one of: run, compare, calibrate'),
            (["run", "drosophila", "--outt", "x"], "unknown option --outt; use --out (nearest match)"),
            (["mesh", "drosophila", "--out", "x.vtu", "--thread=2"], "unknown option --thread; use --threads (nearest match)"),
            (["study", "status", "--hepl"], "unknown option --hepl; use --help (nearest match)"),
        ):
            result = plica(*arguments)
            self.assertEqual((result.returncode, result.stderr.startswith(f"plica: {said}")), (2, True), result.stderr)

    def test_threads_are_an_option_of_whatever_computes(self):
        scenario = self.write(BLOCK)
        self.assertEqual(plica("check", scenario, "--threads", "2").stdout, plica("check", scenario).stdout)
        self.assertEqual(plica("mesh", scenario, "--threads", "2", "--out", self.folder / "rest.vtu").returncode, 0)
        for command in ("run", "check", "mesh", "calibrate", "study", "reproduce"):
            self.assertIn("--threads", plica(command, "--help").stdout, command)

    def test_early_times_are_in_seconds(self):
        result = self.run_scenario(BLOCK, "--set", "time.end_s=0.1")
        self.assertRegex(result.stdout, r"end_time at 0\.1 s after")

    def test_a_warning_is_shown_once_a_run(self):
        late = [BLOCK, "--set", "time.end_s=1", "--set", "division.late.region=all", "--set", "division.late.plane=transverse",
                "--set", "division.late.at_s=5"]
        first, again = self.run_scenario(*late), self.run_scenario(*late, "--resume")
        self.assertIn("warning: division.late", first.stderr)
        self.assertNotIn("warning", again.stderr)

    def test_a_scenario_that_cannot_be_read(self):
        for path in (self.folder / "missing.toml", self.folder):
            with self.subTest(path):
                result = plica("run", path, "--out", self.out)
                self.assertIn(result.returncode, (2, 4))
                self.assertIn(str(path), self.assert_messages(result)[0])
                self.assertFalse(self.out.exists())

    def test_building_that_takes_long_is_not_silent(self):
        path = self.write('format = 1\n[embryo]\nshape = "egg"\ncell_count = 90000\n[vitelline]\nenabled = false\n')
        terminal, end = pty.openpty()
        process = support.start("check", path, stderr=end)
        support.count_case()
        try:
            self.assertTrue(select.select([terminal], [], [], 60)[0], "not a word in a minute")
            self.assertEqual(os.read(terminal, 100), b"building the embryo ...")
        finally:
            process.kill()
            process.communicate()
            os.close(terminal)
            os.close(end)

    def test_quiet_is_quiet_and_piped_progress_has_no_control_characters(self):
        result = self.run_scenario(BLOCK, "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        result = self.run_scenario(BLOCK, out=self.folder / "loud")
        self.assertIn("end_time", result.stdout)
        self.assertNotRegex(result.stdout + result.stderr, r"[\r\x1b]")


if __name__ == "__main__":
    support.main()
