"""Commands and options: help, usage, --quiet; scenarios, meshes and surfaces that cannot be run: refused with a line that says where
and what instead."""
import os
import pty
import select
import shutil

import support
from support import BLOCK, SPHERE, CommandLine, plica, running


class Usage(CommandLine):
    def test_help_of_every_command_has_an_example(self):
        top = self.call("--help")
        for command in ("run", "check", "mesh", "scenarios", "compare", "labels"):
            with self.subTest(command):
                self.assertIn(command, top.stdout)
                self.assertRegex(self.call(command, "--help").stdout, rf"Example.*plica {command}")

    def test_version_names_version_commit_and_compiler(self):
        result = self.call("--version")
        self.assertRegex(result.stdout, r"^plica \d+\.\d+\.\d+ \([^,]+, .*(GNU|Clang).*\)$")

    def test_scenarios_are_listed_one_a_line(self):
        result = self.call("scenarios")
        names = [line.split()[0] for line in result.stdout.splitlines()]
        self.assertIn("drosophila", names)
        self.assertIn("xenopus", names)
        for name in names:
            with self.subTest(name):
                self.call("check", name)

    def test_check_estimates_the_time_of_a_run(self):
        for scenario in ("division-demo", "drosophila", self.write(BLOCK)):
            with self.subTest(scenario):
                self.assertRegex(self.call("check", scenario).stderr, r"note: a run takes (a few seconds|about \d+ (s|min))\n")
        endless = self.write(BLOCK.replace("end_s = 0.5", "end_min = 900"))
        self.assertRegex(self.call("check", endless).stderr, r"note: a run takes between a?.* and about [\d.]+ (s|min|h), very roughly\n")

    def test_bad_usage_is_status_2(self):
        scenario = self.write(BLOCK, "small.toml")
        run = ["run", scenario, "--out", self.out]
        for arguments in ([], ["rum", scenario], ["run"], ["run", scenario], ["run", scenario, "--out"], ["run", scenario, "--out", ""],
                          [*run, "--threads", "0"], [*run, "--threads", "many"], [*run, "--unknown"], [*run, scenario],
                          ["mesh", scenario], ["scenarios", "more"]):
            with self.subTest(arguments):
                result = self.call(*arguments, cwd=self.folder, status=2)
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
            result = self.call(*arguments, status=2)
            self.assertTrue(result.stderr.startswith(f"plica: {said}"), result.stderr)

    def test_a_mesh_is_named_as_one(self):
        for name, text in (("cells.ply", "ply\nformat ascii 1.0\n"), ("cells.vtp", "<VTKFile>\n  a.b.c.d.e\n"), ("large.vtp", " " * 20_000_000)):
            mesh = self.write(text, name)
            for words in (["run", mesh, "--out", self.out], ["check", mesh]):
                said = self.call(*words, status=2).stderr
                self.assertIn(f'{name}: is a mesh, not a scenario; write a scenario with [embryo], file = "{name}"', said)

    def test_threads_are_an_option_of_whatever_computes(self):
        scenario = self.write(BLOCK)
        self.assertEqual(plica("check", scenario, "--threads", "2").stdout, plica("check", scenario).stdout)
        self.call("mesh", scenario, "--threads", "2", "--out", self.folder / "rest.vtu")
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
                self.assert_says(self.call("run", path, "--out", self.out, status=(2, 4)), str(path))
                self.assertFalse(self.out.exists())

    def test_building_that_takes_long_is_not_silent(self):
        path = self.write('format = 1\n[embryo]\nshape = "egg"\ncell_count = 90000\n[vitelline]\nenabled = false\n')
        terminal, end = pty.openpty()
        with running("check", path, stderr=end):
            self.assertTrue(select.select([terminal], [], [], 60)[0], "not a word in a minute")
            self.assertEqual(os.read(terminal, 100), b"building the embryo ...")

    def test_quiet_is_quiet_and_piped_progress_has_no_control_characters(self):
        result = self.run_scenario(BLOCK, "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        result = self.run_scenario(BLOCK, out=self.folder / "loud")
        self.assertIn("end_time", result.stdout)
        self.assertNotRegex(result.stdout + result.stderr, r"[\r\x1b]")


class BadScenario(CommandLine):
    """What cannot be run is refused with status 2, a line that says where and what instead, and no output folder."""

    def test_one_thing_wrong(self):
        # What is replaced, by what, line of the message, key, words of the message.
        embryo = "[embryo]\n"  # replaced by a table in front of it
        for old, new, line, key, part in (
            ("width_um = 40", "widht_um = 40", 6, "embryo.widht_um", '"width_um"'),
            ("[time]", "[tiem]", 12, "tiem", "time"),
            ("width_um = 40", "width_um = -inf", 6, "embryo.width_um", "inf"),
            ("[3, 2, 1]", "6", 8, "embryo.cells", "type"),
            ("format = 1", "formatt = 1", 1, "formatt", '"format"'),
            (embryo, "[region.a]\nx_um = [1000, 2000]\n" + embryo, 3, "region.a", "no cell"),
            (embryo, '[region.a]\nids = [0]\nexcept = ["all"]\n' + embryo, 3, "region.a", "no cell"),
        ):
            with self.subTest(f"{old} -> {new}"):
                self.assert_refused(BLOCK.replace(old, new, 1), part, line=line, key=key)

    def test_a_mesh_that_would_be_inverted(self):
        for height in ("100", "300", "1e300", "1e-300"):
            with self.subTest(height):
                self.assert_refused(SPHERE.replace("cell_height_um = 30", f"cell_height_um = {height}"), "embryo.")
        self.assert_refused(SPHERE.replace("diameter_um = 200", "diameter_um = 1e300"), "embryo.")
        egg = 'format = 1\n[embryo]\nshape = "egg"\nlength_um = 300\ndiameter_um = 60\ncell_count = 60\ncell_height_um = 29\n'
        self.assert_refused(egg, "the mesh is invalid: cell ", ") um is inverted or flat", "reduce cell_height_um",
                            line=7, key="embryo.cell_height_um")

    def test_hundreds_of_millions_of_cells_are_refused_before_any_is_made(self):
        for cells in ("[100000, 100000, 1]", "[20000, 20000, 1]"):
            with self.subTest(cells):
                self.assert_refused(BLOCK.replace("[3, 2, 1]", cells), "embryo.cells", line=8, key="embryo.cells")

    def test_syntax_errors_name_their_line(self):
        for text, line in (("format = 1\n[time\n", 2), ("format = 1\nx = \n", 2), ("a = 1\na = 2\n", 2), (b"\xff\xfe\n", 1),
                           ("a = " + "[" * 10000, 1)):
            with self.subTest(text[:40]):
                self.assert_refused(text, line=line)

    def test_nesting_without_end_is_refused(self):
        deep = ".".join(["a"] * 200000)
        for text in (f"[{deep}]\n", f"{deep} = 1\n", f"x = {{{deep} = 1}}\n", f"x = [1, {{ y = {{{deep} = 1}} }}]\n"):
            with self.subTest(text[:10]):
                self.assert_refused(BLOCK + text, "too many parts", line=1 + BLOCK.count("\n"))
        self.assert_refused(BLOCK, "--set", arguments=["--set", deep[:60000] + "=1"])
        self.assert_refused(BLOCK.replace("A small block", "." * 1000) + "wrong = 1\n", "output.wrong")

    def test_a_file_without_end_is_refused(self):
        self.write("#" * (5 << 20), "long.toml")
        for name in ("/dev/zero", "long.toml"):
            with self.subTest(name):
                self.assert_refused(f'base = "{name}"\n', "base", "MiB")
                self.assert_says(self.call("check", self.folder / name, status=4), "cannot be read")

    def test_a_chain_of_bases_has_an_end(self):
        for i in range(40):
            self.write(f'base = "{i + 1}.toml"\n', f"{i}.toml")
        self.write("", "40.toml")
        self.assert_refused('base = "1.toml"\n', "base", "too many")

    def test_a_message_is_one_line_whatever_the_scenario_holds(self):
        for text, part in (('base = "a\\nb\\u001B[2J"\n', "a\\nb\\u001B[2J"), (BLOCK + '"\\u009B\\r" = 1\n', "\\u009B\\u000D")):
            with self.subTest(text):
                self.assert_refused(text, part)

    def test_bad_set(self):
        for assignment, part in (("time.", "time."), ("=3", ""), ("", ""), ("time.end_s=soon", "soon"), ("embryo.cells=[1,2", "embryo.cells"),
                                 ("time=3", "time"), ("contraction.new.edges=apical", "region"), ("time.end_s=1=2", "time.end_s")):
            with self.subTest(assignment):
                self.assert_refused(BLOCK, "--set", part, arguments=["--set", assignment])

    def test_check_and_mesh_refuse_the_same(self):
        path = self.write(BLOCK.replace("width_um", "widht_um"))
        for command in (["check", path], ["mesh", path, "--out", self.folder / "rest.vtu"]):
            result = self.call(*command, status=2)
            self.assert_says(result, f"{path}:6: embryo.widht_um: ")
            self.assertEqual(result.stdout, "")
        self.assertFalse((self.folder / "rest.vtu").exists())

    def test_check_refuses_what_only_the_tissue_shows(self):
        self.assert_says(self.call("check", "furrow-slice", "--set", "furrow.vce_cell=4", status=2), "furrow.vce_cell: the midline of region")


class BadMesh(CommandLine):
    """Mesh files that are none: status 2 or 4, a line that names the file, and no output folder."""

    def test_mesh_files_that_are_none(self):
        """What is wrong within a mesh: tests/tissue/files, and tests/hostile/bad_files.py."""
        rest = self.folder / "rest.vtu"
        self.call("mesh", self.write(BLOCK), "--out", rest)
        whole = rest.read_bytes()
        meshes = {"text.vtu": b"hello\n", "empty.vtu": b"", "half.vtu": whole[: len(whole) // 2], "data.vtu": whole[:-60],
                  "zero.vtu": whole[:-200] + bytes(150) + whole[-50:], "noise.vtu": bytes(range(256)) * 20}
        scenario = 'format = 1\n[embryo]\nshape = "file"\nfile = "MESH"\n[vitelline]\nenabled = false\n'
        for name, content in meshes.items():
            with self.subTest(name):
                (self.folder / name).write_bytes(content)
                self.assert_says(self.run_scenario(scenario.replace("MESH", name), status=(2, 4)), name)
                self.assertFalse(self.out.exists())
        self.assert_says(self.run_scenario(scenario.replace("MESH", "missing.vtu"), status=4), "missing.vtu")

    def test_a_mesh_that_passes_through_itself_has_no_contact(self):
        # Two cubes, one tilted, whose upper faces cross.
        first = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        second = [(x + 0.3, 0.8 * y - 0.6 * z + 0.5, 0.6 * y + 0.8 * z) for x, y, z in first]
        points = " ".join(f"{10 * value:g}" for point in first + second for value in point)
        self.write(f"# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 16 double\n{points}\n"
                   "CELLS 2 18\n8 0 1 2 3 4 5 6 7\n8 8 9 10 11 12 13 14 15\nCELL_TYPES 2\n12 12\n"
                   "CELL_DATA 2\nSCALARS apical int 1\nLOOKUP_TABLE default\n5 5\n", "cubes.vtk")
        scenario = ('format = 1\n[embryo]\nshape = "file"\nfile = "cubes.vtk"\napical_array = "apical"\n'
                    "[vitelline]\nenabled = false\n")
        self.call("check", self.write(scenario))
        self.assert_refused(scenario + '[self_contact]\nsurface = "both"\n', "the reference mesh self-intersects",
                            "cell 0", line=9, key="self_contact.surface")


class BadSurface(CommandLine):
    """Surfaces of polygons that cannot become cells: status 2, and a line with the scenario's line, its key, the file and the place in it."""

    SCENARIO = 'format = 1\n[embryo]\nshape = "surface"\nfile = "NAME"\ncell_height_um = 0.3\nleast_edge_ratio = 0\n'

    def test_one_thing_wrong(self):
        self.write("OFF\n3 1 0\n0 0 0\n", "a.off")
        self.assert_refused(self.SCENARIO.replace("NAME", "a.off"), "embryo.file: ", "a.off", "the file ends after 1 of 3 vertices", line=4)
        self.assert_refused(self.SCENARIO.replace("NAME", "missing.obj"), "missing.obj", line=4)

    def test_keys(self):
        (self.folder / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
        scenario = self.SCENARIO.replace("NAME", "a.obj")
        self.assert_refused(scenario + 'cell_height_array = "height"\n', "remove cell_height_array", line=7, key="embryo.cell_height_array")
        sheet = 'format = 1\n[embryo]\nshape = "sheet"\nlength_um = 50\nwidth_um = 50\ncell_count = 20\ncell_height_um = 9\n'
        self.assert_refused(sheet + "curvature_per_um = [0.1]\n", "set curvature_per_um to two", line=8, key="embryo.curvature_per_um")
        self.assert_refused(sheet + "mend = false\n", "is not used", line=8, key="embryo.mend")
        self.assert_refused(sheet + "[vitelline]\nenabled = true\n", "a sheet is open", line=9, key="vitelline.enabled")


if __name__ == "__main__":
    support.main()
