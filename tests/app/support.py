"""The command line as a user meets it, held to part 1 of the design: exit status, messages, files left behind.

What its tests share: scenarios, the names of the contract, running the program, checks of its messages and files.

Nothing of plica is linked or read here: the program is run as a black box on small blocks and spheres.
Run: FILE_test.py [PROGRAM] [unittest options], or with PLICA=PROGRAM in the environment.
"""
import base64
import contextlib
import csv
import json
import math
import os
import re
import shutil
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


def block(length, width, height, cells):
    """A table [embryo] of a block, in um."""
    return f'[embryo]\nshape = "block"\nlength_um = {length}\nwidth_um = {width}\ncell_height_um = {height}\ncells = {cells}\n'


BLOCK = 'format = 1\ntitle = "A small block"\n' + block(60, 40, 40, [3, 2, 1]) + """\
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

SERIES = (  # of an embryo without contact
    "time_s furrow_depth_um furrow_depth_below_lips_um lip_distance_um vml_speed_um_per_s vce_speed_um_per_s "
    "speed_ratio vml_displacement_um vce_displacement_um vml_apical_area_ratio vce_apical_area_ratio "
    "max_node_speed_um_per_s max_volume_error lumen_volume_ratio cells step_s newton_iterations linear_iterations "
    "self_intersections refused_steps vml_height_um min_apical_area_ratio min_corner_jacobian_ratio "
    "shell_fluid_um3 flank_volume_ratio active_work_nN_um stored_energy_nN_um dissipated_energy_nN_um "
    "energy_imbalance_ratio flank_section_area_ratio short_edges midline_waviness_um bending_error max_displacement_um "
    "mean_height_um tissue_volume_ratio min_scaled_jacobian highest_points_distance_um max_shell_penetration_um"
).split()
CELLS = (
    "time_s cell_id mother_id generation x_um y_um z_um volume_um3 apical_area_um2 basal_area_um2 height_um "
    "apical_area_ratio speed_um_per_s pressure_Pa activity self_intersecting"
).split()
SECTION = (
    "time_s place_percent from_midline cell_id height_um apical_width_um volume_um3 apical_area_ratio "
    "apical_long_axis_um apical_direction_deg apical_anisotropy_ratio"
).split()
MIDLINE = "time_s ap_um depth_um normal_speed_um_per_s apical_area_ratio".split()
SUMMARY = (
    "scenario status failed_cell outcome time_s equilibrium_time_s cells nodes steps wall_s wall_solver_s peak_memory_MB furrow_depth_um "
    "furrow_depth_below_lips_um lip_distance_um vml_apical_area_ratio vce_apical_area_ratio vml_displacement_um "
    "vce_displacement_um peak_speed_ratio peak_speed_ratio_time_s ends_lead_until_s "
    "vml_displacement_at_equal_speed_um vce_displacement_at_equal_speed_um max_volume_error "
    "max_shell_penetration_um min_scaled_jacobian self_intersections "
    "min_apical_area_ratio min_corner_jacobian_ratio lips_closed_time_s knee_depth_um energy_imbalance_ratio "
    "bending_error energy_by_law_nN_um tension_by_law_mN_per_m provenance"
).split()
POINT_DATA = {"displacement_um", "velocity_um_per_s", "force_nN"}
CELL_DATA = {
    "cell_id", "mother_id", "generation", "volume_um3", "volume_error", "apical_area_ratio", "pressure_Pa", "activity",
    "strength", "self_intersecting",
}
RESULTS = {
    "summary.json", "series.csv", "cells.csv", "midline.csv", "cross_section.csv", "frames", "frames.pvd", "scenario.toml",
    "scenario.input.toml", "report.html",
}
CHECKPOINTS = {"checkpoint.h5", "checkpoint.previous.h5"}
RESULTS |= CHECKPOINTS

WITH_WALL_TIMES = {"summary.json", "report.html"} | CHECKPOINTS  # everything else is the same to the byte whenever it is run


def count_case():
    """A program started without running(), by a test that has to handle it itself."""
    global CASES
    CASES += 1


@contextlib.contextmanager
def running(*arguments, **options):
    """The program while it runs, its output kept apart as text; it does not outlive the block."""
    count_case()
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL, "text": True} | options
    process = subprocess.Popen([PROGRAM, *map(str, arguments)], **options)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def ended(process, timeout=60):
    """The finished program: returncode, stdout, stderr."""
    said = process.communicate(timeout=timeout)
    return subprocess.CompletedProcess(process.args, process.returncode, *said)


def plica(*arguments, timeout=240, **options):
    with running(*arguments, **options) as process:
        return ended(process, timeout)


def table(path):
    """The rows of a .csv with a header."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def rows_in(out):
    """Whole rows of series.csv after the one at rest: steps that were reported."""
    series = Path(out) / "series.csv"
    return max(series.read_bytes().count(b"\n") - 2, 0) if series.exists() else 0


def page_data(file):
    """What a report's page holds, but the packed arrays."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', Path(file).read_text(), re.S)[1])


def tree(folder):
    """Every file below a folder and its bytes, so that a change of any of them shows."""
    folder = Path(folder)
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def read_vtu(path):
    """The arrays of a .vtu as plica writes it (base64, zlib): name -> (section, values)."""
    root = xml.etree.ElementTree.parse(path).getroot()
    arrays = {}
    for section in root.iter():
        for array in section.findall("DataArray"):
            text = array.text.strip()
            blocks = struct.unpack("<Q", base64.b64decode(text[:12])[:8])[0]
            letters = -(-(24 + 8 * blocks) // 3) * 4
            sizes = struct.unpack(f"<{3 + blocks}Q", base64.b64decode(text[:letters]))[3:]
            packed, raw = base64.b64decode(text[letters:]), b""
            for size in sizes:
                raw += zlib.decompress(packed[:size])
                packed = packed[size:]
            letter = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}[array.get("type")]
            arrays[array.get("Name")] = (section.tag, struct.unpack(f"<{len(raw) // struct.calcsize(letter)}{letter}", raw))
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

    def call(self, *arguments, status=0, **options):
        """Runs the program and holds it to a status, or to one of several."""
        result = plica(*arguments, **options)
        allowed = status if isinstance(status, tuple) else (status,)
        self.assertIn(result.returncode, allowed, f"{result.args}\n{result.stdout}{result.stderr}")
        return result

    def run_scenario(self, text, *arguments, out=None, name="scenario.toml", **options):
        """Runs a scenario given as text into `out`."""
        return self.call("run", self.write(text, name), "--out", out or self.out, *arguments, **options)

    def same_csv(self, one, other, *names):
        """Holds tables of two runs to the same bytes."""
        for name in names:
            self.assertEqual((one / name).read_bytes(), (other / name).read_bytes(), name)

    def assert_messages(self, result, count=1):
        """`count` lines on stderr beside doubts about results, and nothing that came from a library."""
        doubts = ("warning: the tissue self-intersects", "warning: with one element through the height")
        lines = [line for line in result.stderr.splitlines() if not line.startswith(doubts)]
        self.assertEqual(len(lines), count, result.stderr)
        for noise in ("\x1b", "ERR|", ".cxx", "terminate called", "std::", "Segmentation"):
            self.assertNotIn(noise, result.stderr)
        return lines

    def assert_repeatable(self, text, *ways):
        """Runs a scenario with several lists of options: what they leave is the same to the byte, wall times apart."""
        expected = None
        for number, options in enumerate(ways):
            self.run_scenario(text, *options, out=self.folder / f"way{number}")
            found = {name: content for name, content in tree(self.folder / f"way{number}").items() if name not in WITH_WALL_TIMES}
            expected = expected or found
            self.assertEqual([name for name in found | expected if found.get(name) != expected.get(name)], [], options)

    def assert_says(self, result, *parts):
        """One message, with these words in it."""
        message = self.assert_messages(result)[0]
        for part in parts:
            self.assertIn(part, message)
        return message

    def assert_refused(self, text, *parts, line=None, key=None, arguments=()):
        """Status 2, one message in the contract's format with these words in it, and nothing written."""
        started = time.monotonic()
        result = self.run_scenario(text, *arguments, status=2)
        self.assertLess(time.monotonic() - started, 10)
        message = self.assert_says(result, *parts)
        if line is not None:
            where = re.escape(str(self.folder / "scenario.toml")) + rf":{line}: "
            self.assertRegex(message, where + (re.escape(key) + ": " if key else ""))
            if key:
                self.assertRegex(message, r"[;?]", "a message says what would be right")
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


def option(name, otherwise=None):
    """The value of an option of a test file's own, which is taken from the command line."""
    if name not in sys.argv:
        return otherwise
    at = sys.argv.index(name)
    value = sys.argv[at + 1]
    del sys.argv[at : at + 2]
    return value


def main():
    """Runs the tests of the file that calls this, on the program given to it."""
    global PROGRAM
    PROGRAM = os.environ.get("PLICA", "")
    if len(sys.argv) > 1 and os.path.isfile(sys.argv[1]):
        PROGRAM = sys.argv.pop(1)
    if not PROGRAM:
        sys.exit(f"usage: {os.path.basename(sys.argv[0])} PROGRAM [unittest options], or PLICA=PROGRAM")
    PROGRAM = os.path.abspath(PROGRAM)
    outcome = unittest.main(exit=False)
    print(f"{CASES} cases ran")
    sys.exit(not outcome.result.wasSuccessful())
