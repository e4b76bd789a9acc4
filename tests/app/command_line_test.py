"""The command line as a user meets it, held to part 1 of the design: exit status, messages, files left behind.

Nothing of plica is linked or read here: the program is run as a black box on small blocks and spheres.
Run: command_line_test.py [PROGRAM] [unittest options], or with PLICA=PROGRAM in the environment.
"""
import csv
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree
import zlib
from pathlib import Path

PROGRAM = ""
CASES = 0  # programs started and judged; printed at the end

BLOCK = """\
format = 1
title = "A small block"
[embryo]
shape = "block"
length_um = 60
width_um = 40
cell_height_um = 40
cells = [3, 2, 1]
[contraction.all]
region = "all"
stiffness_nN_per_um = 1
[time]
end_s = 0.5
step_s = 0.1
[stop]
at_equilibrium = false
[output]
frame_every_s = 0.2
"""

SPHERE = """\
format = 1
title = "A small sphere"
[embryo]
shape = "sphere"
diameter_um = 200
cell_height_um = 30
cells = [5, 5, 4]
[region.furrow]
face = "ventral"
cells_along = 3
cells_across = 3
[contraction.apical]
region = "furrow"
stiffness_nN_per_um = 8
across_ratio = 0.35
[time]
end_s = 0.3
"""

SERIES = (
    "time_s furrow_depth_um furrow_depth_below_lips_um lip_distance_um vml_speed_um_per_s vce_speed_um_per_s "
    "speed_ratio vml_displacement_um vce_displacement_um vml_apical_area_ratio vce_apical_area_ratio "
    "max_node_speed_um_per_s max_volume_error lumen_volume_ratio cells step_s newton_iterations linear_iterations"
).split()
CELLS = (
    "time_s cell_id mother_id generation x_um y_um z_um volume_um3 apical_area_um2 basal_area_um2 height_um "
    "apical_area_ratio speed_um_per_s pressure_Pa activity"
).split()
MIDLINE = "time_s ap_um depth_um normal_speed_um_per_s apical_area_ratio".split()
SUMMARY = (
    "scenario status time_s equilibrium_time_s cells nodes steps wall_s wall_solver_s furrow_depth_um "
    "furrow_depth_below_lips_um lip_distance_um vml_apical_area_ratio vce_apical_area_ratio vml_displacement_um "
    "vce_displacement_um peak_speed_ratio peak_speed_ratio_time_s ends_lead_until_s "
    "vml_displacement_at_equal_speed_um vce_displacement_at_equal_speed_um max_volume_error "
    "max_shell_penetration_um min_scaled_jacobian provenance"
).split()
POINT_DATA = {"displacement_um", "velocity_um_per_s", "force_nN"}
CELL_DATA = {
    "cell_id", "mother_id", "generation", "volume_um3", "volume_error", "apical_area_ratio", "pressure_Pa", "activity",
}
RESULTS = {
    "summary.json", "series.csv", "cells.csv", "midline.csv", "frames", "frames.pvd", "scenario.toml",
    "scenario.input.toml",
}


def start(*arguments, **options):
    """The program, started; its output is kept apart as text."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL, "text": True} | options
    return subprocess.Popen([PROGRAM, *map(str, arguments)], **options)


def plica(*arguments, timeout=60, **options):
    """The finished program: returncode, stdout, stderr."""
    global CASES
    CASES += 1
    process = start(*arguments, **options)
    try:
        process.stdout_text, process.stderr_text = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise
    return subprocess.CompletedProcess(process.args, process.returncode, process.stdout_text, process.stderr_text)


def table(path):
    """The rows of a .csv with a header."""
    return list(csv.DictReader(Path(path).read_text().splitlines()))


def tree(folder):
    """Every file below a folder and its bytes, so that a change of any of them shows."""
    folder = Path(folder)
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def read_vtu(path):
    """The arrays of a .vtu that VTK's own writer made (appended raw data, zlib or none): name -> (section, values)."""
    data = Path(path).read_bytes()
    start_of_data = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[: data.index(b"<AppendedData")] + b"</VTKFile>"
    root = xml.etree.ElementTree.fromstring(head)
    word = {"UInt64": "Q", "UInt32": "I"}[root.get("header_type")]
    size_of_word = struct.calcsize(word)

    def words(offset, count):
        return struct.unpack_from(f"<{count}{word}", data, offset)

    arrays = {}
    for section in root.iter():
        for array in section.findall("DataArray"):
            at = start_of_data + int(array.get("offset"))
            if root.get("compressor"):
                blocks, _, _ = words(at, 3)
                sizes = words(at + 3 * size_of_word, blocks)
                at += (3 + blocks) * size_of_word
                raw = b""
                for size in sizes:
                    raw += zlib.decompress(data[at : at + size])
                    at += size
            else:
                raw = data[at + size_of_word : at + size_of_word + words(at, 1)[0]]
            letter = {"Float64": "d", "Float32": "f", "Int64": "q", "Int32": "i", "UInt8": "B", "Int8": "b"}[array.get("type")]
            values = struct.unpack(f"<{len(raw) // struct.calcsize(letter)}{letter}", raw)
            arrays[array.get("Name")] = (section.tag, values)
    if b"</VTKFile>" not in data[-40:]:
        raise ValueError(f"{path} is cut short")
    return arrays


class CommandLine(unittest.TestCase):
    """A folder of its own for every test, and the checks that all tests share."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="plica_command_line_"))
        self.out = self.folder / "out"
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, text, name="scenario.toml"):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def run_scenario(self, text, *arguments, out=None, status=0, name="scenario.toml", **options):
        """Runs a scenario given as text into `out` and holds it to a status."""
        result = plica("run", self.write(text, name), "--out", out or self.out, *arguments, **options)
        self.assertEqual(result.returncode, status, f"{result.args}\n{result.stdout}{result.stderr}")
        return result

    def assert_messages(self, result, count=1):
        """`count` lines on stderr, and nothing that came from a library."""
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), count, result.stderr)
        for noise in ("\x1b", "ERR|", ".cxx", "terminate called", "std::", "Segmentation"):
            self.assertNotIn(noise, result.stderr)
        return lines

    def assert_refused(self, text, *parts, line=None, key=None, arguments=(), lines=1):
        """Status 2, one message in the contract's format with these words in it, and nothing written."""
        started = time.monotonic()
        result = self.run_scenario(text, *arguments, status=2)
        self.assertLess(time.monotonic() - started, 10)
        message = self.assert_messages(result, lines)[0]
        if line is not None:
            where = re.escape(str(self.folder / "scenario.toml")) + rf":{line}: "
            self.assertRegex(message, where + (re.escape(key) + ": " if key else ""))
            if key:
                self.assertRegex(message, r"[;?]", "a message says what would be right")
        for part in parts:
            self.assertIn(part, message)
        self.assertFalse(self.out.exists(), "something was written")

    def assert_whole(self, out):
        """Every file that is there is whole and free of NaN."""
        out = Path(out)
        self.assertEqual([], [str(p) for p in out.rglob("*") if re.search(r"tmp|temp|part|~$", p.name)], "left-overs")
        for path in out.rglob("*.csv"):
            text = path.read_text()
            self.assertTrue(text.endswith("\n"), f"{path} ends in the middle of a row: {text[-80:]!r}")
            rows = list(csv.reader(text.splitlines()))
            for number, row in enumerate(rows):
                self.assertEqual(len(row), len(rows[0]), f"{path}:{number + 1}")
                for value in row if number else ():
                    self.assertTrue(value == "" or math.isfinite(float(value)), f"{path}:{number + 1}: {value}")
        for path in out.rglob("*.json"):
            json.loads(path.read_text(), parse_constant=lambda name: self.fail(f"{path}: {name}"))
        for path in out.rglob("*.vtu"):
            for name, (_, values) in read_vtu(path).items():
                self.assertTrue(all(map(math.isfinite, values)), f"{path}: {name}")
        if (out / "frames.pvd").exists():
            for entry in xml.etree.ElementTree.parse(out / "frames.pvd").iter("DataSet"):
                self.assertTrue((out / entry.get("file")).exists(), entry.get("file"))

    def summary(self, out=None):
        return json.loads((Path(out or self.out) / "summary.json").read_text())


class Usage(CommandLine):
    def test_help_of_every_command_has_an_example(self):
        top = plica("--help")
        self.assertEqual(top.returncode, 0)
        for command in ("run", "check", "mesh", "scenarios"):
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

    def test_an_unknown_scenario_is_answered_with_the_nearest(self):
        result = plica("run", "drosophla", "--out", self.out)
        self.assertEqual(result.returncode, 2)
        self.assertIn('"drosophila"', self.assert_messages(result)[0])
        self.assertFalse(self.out.exists())

    def test_a_scenario_that_cannot_be_read(self):
        for path in (self.folder / "missing.toml", self.folder):
            with self.subTest(path):
                result = plica("run", path, "--out", self.out)
                self.assertIn(result.returncode, (2, 4))
                self.assertIn(str(path), self.assert_messages(result)[0])
                self.assertFalse(self.out.exists())


class BadScenario(CommandLine):
    """What cannot be run is refused with status 2, a line that says where and what instead, and no output folder."""

    def test_one_thing_wrong(self):
        # what is replaced, by what, line of the message, key, words of the message
        embryo = "[embryo]\n"  # replaced by a table in front of it
        cases = [
            ("width_um = 40", "widht_um = 40", 6, "embryo.widht_um", ['"width_um"']),
            ("[time]", "[tiem]", 12, "tiem", ["time"]),
            ("width_um = 40", 'width_um = "40"', 6, "embryo.width_um", ["type"]),
            ("width_um = 40", "width_um = true", 6, "embryo.width_um", ["type"]),
            ("width_um = 40", "width_mm = 40", 6, "embryo.width_mm", ["width_um"]),
            ("width_um = 40", "width = 40", 6, "embryo.width", ["width_um"]),
            ("stiffness_nN_per_um = 1", "stiffness_N_per_m = 1", 11, "contraction.all.stiffness_N_per_m", ["_nN_per_um"]),
            ("end_s = 0.5", "end_h = 1", 13, "time.end_h", ["end_s"]),
            ("end_s = 0.5", "end_s = 1\nend_min = 1", None, None, ["end_s", "end_min"]),
            ("width_um = 40", "width_um = -40", 6, "embryo.width_um", ["-40"]),
            ("width_um = 40", "width_um = 0", 6, "embryo.width_um", ["0"]),
            ("width_um = 40", "width_um = nan", 6, "embryo.width_um", ["nan"]),
            ("width_um = 40", "width_um = inf", 6, "embryo.width_um", ["inf"]),
            ("width_um = 40", "width_um = -inf", 6, "embryo.width_um", ["inf"]),
            ("[3, 2, 1]", "[3, 2]", 8, "embryo.cells", ["3"]),
            ("[3, 2, 1]", "[3, 2, 0]", 8, "embryo.cells", ["0"]),
            ("[3, 2, 1]", "[3, 2.5, 1]", 8, "embryo.cells", ["2.5"]),
            ("[3, 2, 1]", "6", 8, "embryo.cells", ["type"]),
            ('"block"', '"blok"', 4, "embryo.shape", ['"block"']),
            ('"block"', '"sphere"', None, None, ["shape"]),
            ('region = "all"', 'region = "al"', 10, "contraction.all.region", ['"all"']),
            ('region = "all"\n', "", 9, "contraction.all.region", ["missing"]),
            ("format = 1", "format = 2", 1, "format", ["2"]),
            ("format = 1", "formatt = 1", 1, "formatt", ['"format"']),
            (embryo, "[region.a]\nx_um = [1000, 2000]\n" + embryo, 3, "region.a", ["no cell"]),
            (embryo, "[region.a]\nx_um = [2, 1]\n" + embryo, 4, "region.a.x_um", []),
            (embryo, "[region.a]\nids = [6]\n" + embryo, 4, "region.a.ids", ["6", "5"]),
            (embryo, "[region.a]\nids = [-1]\n" + embryo, 4, "region.a.ids", ["-1"]),
            (embryo, "[region.a]\nids = []\n" + embryo, 4, "region.a.ids", ["empty"]),
            (embryo, "[region.a]\n" + embryo, 3, "region.a", []),
            (embryo, '[region.a]\nids = [0]\nexcept = ["all"]\n' + embryo, 3, "region.a", ["no cell"]),
            (embryo, '[region.a]\nunion = ["a"]\n' + embryo, 3, "region.a", ["itself"]),
            (embryo, '[region.a]\nunion = ["b"]\n' + embryo, 4, "region.a.union", ['"b"']),
            (embryo, '[region.a]\nface = "ventral"\ncells_along = 2\n' + embryo, 5, "region.a.cells_along", ["1"]),
            (embryo, "[dynamics]\nsurface_drag_Pa_s_per_um = 0\n" + embryo, 4, "dynamics.surface_drag_Pa_s_per_um", ["density"]),
            (embryo, "[elasticity]\npoisson_ratio = 0.5\n" + embryo, 4, "elasticity.poisson_ratio", ["0.5"]),
            (embryo, "[expect]\nfurow_depth_um = { value = 1, within = 1 }\n" + embryo, 4, "expect.furow_depth_um", ["furrow"]),
            (embryo, "[expect]\nfurrow_depth_um = { value = 1 }\n" + embryo, 4, "expect.furrow_depth_um", ["within"]),
        ]
        for old, new, line, key, parts in cases:
            with self.subTest(f"{old} -> {new}"):
                self.assertIn(old, BLOCK)
                count = None if key is None else 1
                text = BLOCK.replace(old, new, 1)
                if count:
                    self.assert_refused(text, *parts, line=line, key=key)
                else:
                    result = self.run_scenario(text, status=2)
                    for part in parts:
                        self.assertIn(part, result.stderr)
                    self.assertFalse(self.out.exists())

    def test_a_mesh_that_would_be_inverted(self):
        for height in ("100", "300", "1e300", "1e-300"):
            with self.subTest(height):
                self.assert_refused(SPHERE.replace("cell_height_um = 30", f"cell_height_um = {height}"), "embryo.")
        for old, new in (("[5, 5, 4]", "[1, 1, 100]"), ("diameter_um = 200", "diameter_um = 1e300")):
            with self.subTest(new):
                self.assert_refused(SPHERE.replace(old, new).replace("cells_along = 3\ncells_across = 3\n", ""), "embryo.")

    def test_hundreds_of_millions_of_cells_are_refused_before_any_is_made(self):
        for cells in ("[1000, 1000, 1000]", "[100000, 100000, 1]", "[100000, 100000, 100000]", "[20000, 20000, 1]"):
            with self.subTest(cells):
                # 4 GB of address space: building such a mesh would fail differently.
                self.assert_refused(BLOCK.replace("[3, 2, 1]", cells), "embryo.cells", line=8, key="embryo.cells")
        elements = BLOCK.replace("cells = [3, 2, 1]", "cells = [100, 100, 100]\nelements_per_cell = [8, 8, 8]")
        self.assert_refused(elements, "512000000")

    def test_syntax_errors_name_their_line(self):
        for text, line in (("format = 1\n[time\n", 2), ("format = 1\nx = \n", 2), ("a = 1\na = 2\n", 2), (b"\xff\xfe\n", 1),
                           ("a = " + "[" * 10000, 1)):
            with self.subTest(text[:40]):
                self.assert_refused(text, line=line)

    def test_nesting_without_end_is_refused(self):
        self.assert_refused("[" + ".".join(["a"] * 100000) + "]\n")

    def test_all_errors_at_once_in_the_order_of_their_lines(self):
        text = """\
format = 1
[embryo]
shape = "block"
lenght_um = 60
width_um = -40
cells = [3, 2]
[contraction.all]
region = "al"
edges = "apcal"
stiffness_nN_per_um = "strong"
[time]
end_s = nan
"""
        result = self.run_scenario(text, status=2)
        lines = self.assert_messages(result, 7)
        numbers = [int(re.match(r".*?\.toml:(\d+): ", line).group(1)) for line in lines]
        self.assertEqual(numbers, [4, 5, 6, 8, 9, 10, 12])
        self.assertFalse(self.out.exists())

    def test_bad_set(self):
        for assignment, part in (
            ("time", "time"), ("time.", "time."), ("=3", ""), ("", ""), ("time.end_s=", "time.end_s"),
            ("time.end_s=nan", "nan"), ("time.end_s=-1", "-1"), ("time.end_s=soon", "soon"), ("time.edn_s=1", "end_s"),
            ("embryo.cells=[1,2", "embryo.cells"), ("time=3", "time"), ("contraction.new.edges=apical", "region"),
            ("embryo.shape=blok", "block"), ("time.end_s=1=2", "time.end_s"),
        ):
            with self.subTest(assignment):
                self.assert_refused(BLOCK, "--set", part, arguments=["--set", assignment])

    def test_base_in_a_circle_or_nowhere(self):
        self.write('base = "scenario.toml"\n', "other.toml")
        self.assert_refused('base = "scenario.toml"\n', "base")
        self.assert_refused('base = "other.toml"\n', "base")
        self.assert_refused('base = "drosophla"\n', "base", '"drosophila"')
        self.assert_refused('base = "missing.toml"\n', "base", "missing.toml")

    def test_check_and_mesh_refuse_the_same(self):
        path = self.write(BLOCK.replace("width_um", "widht_um"))
        for command in (["check", path], ["mesh", path, "--out", self.folder / "rest.vtu"]):
            result = plica(*command)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"{path}:6: embryo.widht_um: ", self.assert_messages(result)[0])
            self.assertEqual(result.stdout, "")
        self.assertFalse((self.folder / "rest.vtu").exists())


class Files(CommandLine):
    """Status 4: what the file system refuses, and what must not be overwritten."""

    def test_mesh_files_that_are_none(self):
        rest = self.folder / "rest.vtu"
        self.assertEqual(plica("mesh", self.write(BLOCK), "--out", rest).returncode, 0)
        whole = rest.read_bytes()
        meshes = {
            "text.vtu": b"hello\n", "empty.vtu": b"", "half.vtu": whole[: len(whole) // 2], "data.vtu": whole[:-60],
            "zero.vtu": whole[:-200] + bytes(150) + whole[-50:], "noise.vtu": bytes(range(256)) * 20,
            "legacy.vtk": b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n0 0 0 1\n",
            "xml.vtu": b'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0"></VTKFile>\n',
        }
        legacy = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        four = "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\n"
        meshes["tetrahedra.vtk"] = (legacy + four + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n").encode()
        eight = "POINTS 8 double\n0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\n"
        meshes["beyond.vtk"] = (legacy + eight + "CELLS 1 9\n8 0 1 2 3 4 5 6 99\nCELL_TYPES 1\n12\n").encode()
        meshes["nan.vtk"] = (legacy + eight.replace("0 0 1 1 0 1", "0 0 nan 1 0 1") +
                             "CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n").encode()
        meshes["none.vtk"] = (legacy + "POINTS 0 double\nCELLS 0 0\nCELL_TYPES 0\n").encode()
        scenario = 'format = 1\n[embryo]\nshape = "file"\nfile = "MESH"\n[vitelline]\nenabled = false\n'
        for name, content in meshes.items():
            with self.subTest(name):
                (self.folder / name).write_bytes(content)
                result = plica("run", self.write(scenario.replace("MESH", name)), "--out", self.out)
                self.assertIn(result.returncode, (2, 4), result.stdout + result.stderr)
                self.assertIn(name, self.assert_messages(result)[0])
                self.assertFalse(self.out.exists())
        with self.subTest("missing"):
            result = plica("run", self.write(scenario.replace("MESH", "missing.vtu")), "--out", self.out)
            self.assertEqual(result.returncode, 4, result.stderr)
            self.assertIn("missing.vtu", self.assert_messages(result)[0])

    def test_results_are_never_overwritten_unasked(self):
        self.run_scenario(BLOCK)
        before = tree(self.out)
        result = self.run_scenario(SPHERE, status=4)
        self.assertIn("--overwrite", self.assert_messages(result)[0])
        self.assertEqual(tree(self.out), before)

    def test_overwrite_keeps_the_results_when_the_scenario_is_bad(self):
        self.run_scenario(BLOCK)
        before = tree(self.out)
        self.run_scenario(BLOCK + "wrong = 1\n", "--overwrite", status=2)
        self.assertEqual(tree(self.out), before)

    def test_overwrite_replaces_only_plicas_own_files(self):
        self.run_scenario(BLOCK, "--set", "output.frame_every_s=0.1")
        foreign = {"notes.txt": b"mine", "frames/mine.vtu": b"mine", "frames/frame_mine.vtu": b"mine", "data/series.csv": b"mine"}
        for name, content in foreign.items():
            (self.out / name).parent.mkdir(exist_ok=True)
            (self.out / name).write_bytes(content)
        self.run_scenario(BLOCK, "--overwrite", "--set", "output.frame_every_s=0")
        after = tree(self.out)
        for name, content in foreign.items():
            with self.subTest(name):
                self.assertEqual(after.get(name), content)
        for name in foreign:
            (self.out / name).unlink(missing_ok=True)
        self.assert_whole(self.out)
        self.assertEqual(len(list((self.out / "frames").iterdir())), 2, "frames of the run before are left")

    def test_places_that_cannot_be_written(self):
        file = self.write("mine", "file")
        for out in (file, file / "below", Path("/proc/plica"), Path("/dev/null")):
            with self.subTest(out):
                result = self.run_scenario(BLOCK, out=out, status=4)
                self.assertIn(str(out), self.assert_messages(result)[0])
        self.assertEqual(file.read_text(), "mine")
        mesh = self.folder / "rest.vtu"
        scenario = self.write(BLOCK)
        self.assertEqual(plica("mesh", scenario, "--out", file / "rest.vtu").returncode, 4)
        self.assertEqual(plica("mesh", scenario, "--out", mesh).returncode, 0)
        before = mesh.read_bytes()
        self.assertEqual(plica("mesh", scenario, "--set", "embryo.length_um=70", "--out", mesh).returncode, 4)
        self.assertEqual(mesh.read_bytes(), before)
        self.assertEqual(plica("mesh", scenario, "--set", "embryo.length_um=70", "--out", mesh, "--overwrite").returncode, 0)
        self.assertNotEqual(mesh.read_bytes(), before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_standard_output_that_is_full(self):
        scenario = self.write(BLOCK)
        for arguments in (["check", scenario], ["scenarios"]):
            with self.subTest(arguments), open("/dev/full", "w") as full:
                self.assertEqual(plica(*arguments, stdout=full).returncode, 4)

    def small_disk(self, kilobytes):
        disk = self.folder / f"disk{kilobytes}"
        disk.mkdir()
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "plica_test", disk], capture_output=True)
        if mount.returncode != 0:
            return None
        self.addCleanup(subprocess.run, ["umount", disk], capture_output=True)
        return disk

    def test_full_disk_at_the_start_and_in_the_middle(self):
        run = ["--quiet", "--set", "time.end_s=60", "--set", "output.frame_every_s=0.5"]
        for kilobytes in (4, 12, 32, 60, 100, 160):
            with self.subTest(kilobytes):
                disk = self.small_disk(kilobytes)
                if disk is None:
                    self.skipTest("may not mount a small disk here; the file size limit is tried all the same")
                result = self.run_scenario(BLOCK, *run, out=disk / "out", status=4)
                self.assertIn("No space left", self.assert_messages(result)[0])
                self.assert_whole(disk / "out")

    def test_a_file_that_may_not_grow_is_cut_to_whole_rows(self):
        # SIGXFSZ ignored: write then fails in the middle of a row, as on a full disk.
        limit = ["bash", "-c", 'trap "" XFSZ; ulimit -f 12; exec "$0" "$@"', PROGRAM]
        global CASES
        CASES += 1
        command = ["run", self.write(BLOCK), "--out", self.out, "--quiet", "--set", "time.end_s=60", "--set",
                   "output.frame_every_s=0"]
        result = subprocess.run([*limit, *map(str, command)], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("File too large", self.assert_messages(result)[0])
        self.assert_whole(self.out)


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
        midline = table(self.out / "midline.csv")
        self.assertEqual(list(midline[0]), MIDLINE)
        self.assertEqual(len({row["time_s"] for row in midline}), len(frames))
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
            self.assertTrue(key == "provenance" or not isinstance(value, dict), "flat")

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
        self.assertEqual(plica("run", self.out / "scenario.toml", "--out", again).returncode, 0)
        self.assertEqual((again / "series.csv").read_bytes(), (self.out / "series.csv").read_bytes())

    def test_runs_are_repeatable_to_the_byte_with_any_number_of_threads(self):
        outs = [self.folder / name for name in ("once", "again", "one", "two")]
        for out, threads in zip(outs, ([], [], ["--threads", "1"], ["--threads", "2"])):
            self.run_scenario(SPHERE, *threads, out=out)
        expected = tree(outs[0])
        for out in outs[1:]:
            for name, content in tree(out).items():
                if name != "summary.json":  # holds wall clock times
                    with self.subTest(f"{out.name}/{name}"):
                        self.assertEqual(content, expected[name])

    def test_check_prints_a_scenario_that_loads_again(self):
        for text in (BLOCK, SPHERE):
            first = plica("check", self.write(text))
            self.assertEqual(first.returncode, 0, first.stderr)
            for key in ("young_modulus_Pa", "poisson_ratio", "surface_drag_Pa_s_per_um", "equilibrium_speed_um_per_min"):
                self.assertIn(key, first.stdout)
            second = plica("check", self.write(first.stdout, "scenario.toml"))
            self.assertEqual((second.returncode, second.stdout), (0, first.stdout))

    def test_set_reaches_named_tables_and_the_last_one_counts(self):
        result = plica("check", self.write(BLOCK), "--set", "contraction.all.stiffness_nN_per_um=2.5", "--set", "time.end_s=7",
                       "--set", "time.end_s=9", "--set", "region.first.ids=[0, 1]", "--set", 'title="Another title"')
        self.assertEqual(result.returncode, 0, result.stderr)
        for line in ("stiffness_nN_per_um = 2.5", "end_s = 9", "ids = [0, 1]", 'title = "Another title"'):
            self.assertIn(line, result.stdout.splitlines())

    def test_a_missed_expectation_is_status_1_and_says_by_how_much(self):
        text = BLOCK + "[expect]\nvml_apical_area_ratio = { value = 0.5, within_percent = 1 }\n"
        text += "cells = { value = 6, within = 0 }\n"
        result = self.run_scenario(text, status=1)
        line = [line for line in (result.stdout + result.stderr).splitlines() if "vml_apical_area_ratio" in line]
        self.assertEqual(len(line), 1, result.stdout + result.stderr)
        value = self.summary()["vml_apical_area_ratio"]
        self.assertIn("0.5", line[0])
        self.assertIn(f"{value:.3f}"[:-1], line[0])
        self.assert_whole(self.out)
        self.run_scenario(text.replace("0.5, within_percent = 1", f"{value}, within_percent = 0.001"), "--overwrite")
        # What never happened cannot meet an expectation.
        self.run_scenario(BLOCK + "[expect]\nequilibrium_time_s = { value = 1, within = 1e9 }\n", "--overwrite", status=1)

    def test_numerics_that_give_up_are_status_3_and_keep_the_last_good_state(self):
        result = self.run_scenario(BLOCK, "--set", "contraction.all.preload_nN=-1e6", status=3)
        summary = self.summary()
        self.assertEqual(summary["status"], "failed")
        message = [line for line in result.stderr.splitlines() if "gave up" in line]
        self.assertEqual(len(message), 1, result.stderr)
        self.assertRegex(message[0], r"cell \d+")
        self.assertRegex(message[0], r"t = [\d.e+-]+ s")
        self.assertIn("inside out", message[0])
        self.assert_whole(self.out)
        self.assertEqual(summary["steps"], len((self.out / "series.csv").read_text().splitlines()) - 2)

    def test_forces_beyond_all_numbers_leave_no_nan(self):
        self.run_scenario(BLOCK, "--set", "contraction.all.stiffness_nN_per_um=1e300", status=3)
        self.assertEqual(self.summary()["status"], "failed")
        self.assert_whole(self.out)

    def test_a_run_that_is_interrupted_keeps_what_it_has(self):
        for name, number, status in (("INT", signal.SIGINT, 130), ("TERM", signal.SIGTERM, 143)):
            with self.subTest(name):
                result, out = self.stopped_run(number, name)
                self.assertEqual(result.returncode, status, result.stderr)
                self.assertEqual(self.summary(out)["status"], "interrupted")
                self.assertEqual({path.name for path in out.iterdir()}, RESULTS)
                rows = table(out / "series.csv")
                self.assertEqual(self.summary(out)["steps"], len(rows) - 1)
                self.assert_whole(out)

    def test_an_interrupted_step_is_given_up_within_seconds(self):
        # An embryo so thin that Newton's method struggles for minutes within one step: the signal must be heard there.
        global CASES
        CASES += 1
        text = "[embryo]\ncell_height_um = 0.001\n[time]\nend_s = 1e9\n[stop]\nat_equilibrium = false\n"
        process = start("run", self.write(text), "--out", self.out)
        try:
            time.sleep(2)
            if process.poll() is not None:
                self.skipTest("the run was over before the signal")
            process.send_signal(signal.SIGTERM)
            started = time.monotonic()
            process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            self.fail(f"still running {time.monotonic() - started:.0f} s after SIGTERM")
        finally:
            process.kill()
            process.communicate()
        self.assertEqual(process.returncode, 143)
        self.assert_whole(self.out)

    def test_a_killed_run_leaves_whole_files(self):
        result, out = self.stopped_run(signal.SIGKILL, "KILL")
        self.assertEqual(result.returncode, -signal.SIGKILL)
        # What was being written under another name may be left; what has its name is whole.
        for path in out.rglob("*"):
            if re.search(r"tmp|temp|part|~$", path.name):
                path.unlink()
        self.assert_whole(out)

    def stopped_run(self, number, name):
        """A run without end, signalled once its series has a few rows; they are readable while it goes on."""
        global CASES
        CASES += 1
        out = self.folder / name
        process = start("run", self.write(BLOCK), "--out", out, "--set", "time.end_s=1e9", "--quiet")
        try:
            deadline = time.monotonic() + 30
            series = out / "series.csv"
            while time.monotonic() < deadline and not (series.exists() and series.read_bytes().count(b"\n") > 5):
                self.assertIsNone(process.poll())
                time.sleep(0.02)
            self.assertGreater(series.read_bytes().count(b"\n"), 5)
            process.send_signal(number)
            process.stdout_text, process.stderr_text = process.communicate(timeout=30)
        finally:
            process.kill()
            process.communicate()
        return subprocess.CompletedProcess(process.args, process.returncode, process.stdout_text, process.stderr_text), out

    def test_quiet_is_quiet_and_piped_progress_has_no_control_characters(self):
        result = self.run_scenario(BLOCK, "--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        result = self.run_scenario(BLOCK, out=self.folder / "loud")
        self.assertIn("end_time", result.stdout)
        self.assertNotRegex(result.stdout + result.stderr, r"[\r\x1b]")

    def test_mesh_writes_regions_and_can_be_read_back_as_a_scenario(self):
        mesh = self.folder / "rest.vtu"
        result = plica("mesh", self.write(SPHERE), "--out", mesh)
        self.assertEqual(result.returncode, 0, result.stderr)
        arrays = read_vtu(mesh)
        self.assertEqual(sum(arrays["region_furrow"][1]), 9)
        self.assertEqual(len(arrays["region_furrow"][1]), 130)
        text = SPHERE.replace('shape = "sphere"\ndiameter_um = 200\ncell_height_um = 30\ncells = [5, 5, 4]',
                              f'shape = "file"\nfile = "{mesh.name}"')
        text = text.replace('face = "ventral"\ncells_along = 3\ncells_across = 3', 'array = "region_furrow"')
        text += "[vitelline]\nenabled = false\n"
        self.run_scenario(text)
        self.assertEqual((self.summary()["cells"], self.summary()["nodes"]), (130, 264))
        self.assertLess(min(float(row["apical_area_ratio"]) for row in table(self.out / "cells.csv")), 1)
        # The same sheet built directly moves the same way.
        built = self.folder / "built"
        self.run_scenario(SPHERE, "--set", "vitelline.enabled=false", out=built)
        direct, file = self.summary(built), self.summary()
        self.assertAlmostEqual(direct["time_s"], file["time_s"])
        self.assertAlmostEqual(direct["max_node_speed_um_per_s"], file["max_node_speed_um_per_s"], delta=1e-3)

    def test_hostile_names_and_titles(self):
        for name in ("with spaces", "ünï-β", "it's \"quoted\"", "$HOME;x&<y>", "a\nb", "-dash"):
            with self.subTest(name):
                self.run_scenario(BLOCK, out=self.folder / name)
                self.assertEqual({path.name for path in (self.folder / name).iterdir()}, RESULTS)
                self.assert_whole(self.folder / name)
        title = "x" * 100000 + ' \\"quoted\\" \\u001b[31m ü <b>&amp;'
        self.run_scenario(BLOCK.replace("A small block", title))
        self.assertEqual(self.summary()["title"], title.replace('\\"', '"').replace("\\u001b", "\x1b"))
        self.assertEqual(plica("check", self.out / "scenario.toml").returncode, 0)


if __name__ == "__main__":
    PROGRAM = os.environ.get("PLICA", "")
    if len(sys.argv) > 1 and os.path.isfile(sys.argv[1]):
        PROGRAM = sys.argv.pop(1)
    if not PROGRAM:
        sys.exit("usage: command_line_test.py PROGRAM [unittest options], or PLICA=PROGRAM")
    PROGRAM = os.path.abspath(PROGRAM)
    outcome = unittest.main(exit=False)
    print(f"{CASES} cases ran")
    sys.exit(not outcome.result.wasSuccessful())
