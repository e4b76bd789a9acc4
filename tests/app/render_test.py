"""`plica render`: what it writes, what it refuses, and what it leaves behind."""
import math
import os
import shutil
import signal
import struct
import subprocess
import time

from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

import support
from support import BLOCK, SPHERE, CommandLine

VIEWS = "antero-ventral ventral side cross-section sagittal-section apical".split()


def size_of(path):
    """Width and height from the header of a PNG file."""
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", head[16:])


def pixels_of(path):
    """A PNG file as rows of (r, g, b), the lowest first."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    values = image.GetPointData().GetScalars()
    return [[tuple(map(int, values.GetTuple3(y * width + x))) for x in range(width)] for y in range(height)]


def shift(mesh, moved, distance_um):
    """Writes the mesh of a .vtu again with each coordinate of its points larger by the distance."""
    reader, writer = vtkXMLUnstructuredGridReader(), vtkXMLUnstructuredGridWriter()
    reader.SetFileName(str(mesh))
    reader.Update()
    points = reader.GetOutput().GetPoints()
    for i in range(points.GetNumberOfPoints()):
        points.SetPoint(i, *(x + distance_um for x in points.GetPoint(i)))
    writer.SetFileName(str(moved))
    writer.SetInputData(reader.GetOutput())
    writer.Write()


def servers(ancestor=None):
    """Process ids of the X servers that run: all, or those that a process has started, itself or through others."""
    lines = subprocess.run(["ps", "-eo", "pid=,ppid=,stat=,comm="], capture_output=True, text=True, check=True).stdout.splitlines()
    rows = [line.split(None, 3) for line in lines]
    parents = {int(process): int(parent) for process, parent, _, _ in rows}

    def descends(process):
        return process == ancestor or (process in parents and descends(parents[process]))

    running = {int(process) for process, _, state, name in rows if name == "Xvfb" and state[0] != "Z"}
    return running if ancestor is None else set(filter(descends, running))


def processes_about(words):
    """Process ids of what has these words on its command line."""
    return subprocess.run(["pgrep", "--full", words], capture_output=True, text=True, check=False).stdout.split()


class Render(CommandLine):
    def setUp(self):
        super().setUp()
        self.picture = self.folder / "picture.png"
        self.run_scenario(SPHERE + "[output]\nframe_every_s = 0.1\n", "--quiet")

    def render(self, *arguments, status=0, **options):
        return self.call("render", self.out, "--out", self.picture, *arguments, status=status, **options)

    def refused(self, status, *arguments, **options):
        """The one message of a call that fails and writes nothing."""
        message = self.assert_messages(self.render(*arguments, status=status, **options))[0]
        self.assertFalse(self.picture.exists())
        return message

    def test_a_picture_is_of_the_size_asked_for_and_shows_the_embryo(self):
        result = self.render("--size", "420x300", "--view", "ventral")
        self.assertIn(f"{self.picture} (0.3 s)", result.stdout)
        self.assertEqual(result.stderr, "")
        self.assertEqual(size_of(self.picture), (420, 300))
        rows = pixels_of(self.picture)
        coloured = sum(pixel != (255, 255, 255) for row in rows for pixel in row)
        self.assertGreater(coloured, 420 * 300 / 5)
        self.assertGreater(len({pixel for row in rows for pixel in row}), 200)

    def test_the_same_picture_twice_is_the_same_file(self):
        self.render("--size", "300x250")
        first = self.picture.read_bytes()
        self.render("--size", "300x250", "--overwrite")
        self.assertEqual(self.picture.read_bytes(), first)

    def test_a_mesh_far_from_the_origin_is_in_the_middle(self):
        at_origin, far = self.folder / "at_origin.vtu", self.folder / "far.vtu"
        self.call("mesh", self.write(SPHERE), "--out", at_origin)
        shift(at_origin, far, 1e5)
        pictures = []
        for mesh in (at_origin, far):
            out = self.folder / mesh.stem
            self.run_scenario(
                f'[embryo]\nshape = "file"\nfile = "{mesh.name}"\n[vitelline]\nenabled = false\n[contraction.all]\n'
                'region = "all"\nstiffness_nN_per_um = 8\n[time]\nend_s = 0.3\n', "--quiet", out=out)
            self.call("render", out, "--out", self.picture, "--size", "400x300", "--view", "ventral", "--overwrite")
            pictures.append([pixel for row in pixels_of(self.picture) for pixel in row])
        drawn = [sum(pixel != (255, 255, 255) for pixel in picture) for picture in pictures]
        self.assertGreater(drawn[0], 400 * 300 / 5)
        # But for what rounding of places moves across a pixel's border.
        others = sum(max(abs(a - b) for a, b in zip(*pair)) > 8 for pair in zip(*pictures))
        self.assertLess(others, drawn[0] / 100)

    def test_rows_of_views_and_columns_of_times(self):
        result = self.render("--view", "ventral,side", "--view", "cross-section", "--time", "0,0.1s,0.004min,last", "--shell")
        self.assertIn("(0 s, 0.1 s, 0.2 s, 0.3 s)", result.stdout)  # 0.24 s has no frame
        width, height = size_of(self.picture)
        self.assertEqual(width, 1500)
        self.assertGreater(height, 600)
        self.render("--strip", "--quiet", "--colour", "pressure", "--no-edges", "--overwrite")
        self.assertEqual(size_of(self.picture)[0], 1500)

    # A ball of 200 um: smaller away from its middle, and the same on both sides.
    def test_cuts_elsewhere_along_the_embryo(self):
        drawn = []
        for arguments in (["--at-x-um=-80"], ["--at-x-um", "0"], ["--at-x-um", "80"]):
            self.render("--size", "300x300", "--no-edges", "--range", "0:0.01", "--overwrite", *arguments)
            drawn.append(sum(b > r + 30 for row in pixels_of(self.picture) for r, _, b in row[:230]))
        self.assertGreater(drawn[1], 2000)
        self.assertLess(drawn[0], 0.9 * drawn[1])
        self.assertAlmostEqual(drawn[0], drawn[2], delta=0.1 * drawn[0])
        result = self.render("--sections", "--time", "0,last", "--overwrite")
        self.assertIn("(0 s, 0.3 s)", result.stdout)
        width, height = size_of(self.picture)
        self.assertGreater(height, width, "three rows")
        self.render("--sections", "--movie", "--size", "300x600", "--overwrite", "--quiet")
        self.assertEqual(size_of(self.folder / "picture_00003.png"), (300, 600))

    # A block stands for a sheet: it is seen from its apical side, from above, unless told otherwise.
    def test_an_open_sheet_is_seen_from_its_apical_side(self):
        pictures = {}
        for name, text in (("ball", SPHERE), ("sheet", BLOCK)):
            self.run_scenario(text, "--quiet", out=self.folder / name)
            for view in ("apical", "antero-ventral", ""):
                self.out = self.folder / name
                self.render("--size", "400x300", "--overwrite", *(["--view", view] if view else []))
                pictures[name, view] = self.picture.read_bytes()
        self.assertEqual(pictures["sheet", ""], pictures["sheet", "apical"])
        self.assertEqual(pictures["ball", ""], pictures["ball", "antero-ventral"])
        self.assertNotEqual(pictures["sheet", ""], pictures["sheet", "antero-ventral"])

    def test_what_was_measured_in_cells_colours_them(self):
        rows = ["x_um,y_um,z_um,sna,volume_um3"]
        for i in range(200):
            z = 1 - (2 * i + 1) / 200
            r, turn = math.sqrt(1 - z * z), 2.4 * i
            rows.append(f"{120 * z},{60 * r * math.sin(turn)},{60 * r * math.cos(turn)},{i},7")
        self.write("\n".join(rows) + "\n", "points.csv")
        self.out = self.folder / "genes"
        self.run_scenario('format = 1\n[embryo]\nshape = "points"\nfile = "points.csv"\ncell_height_um = 15\n[vitelline]\n'
                          'enabled = false\n[time]\nend_s = 1\n', "--quiet")
        cells = support.read_vtu(self.out / "frames/frame_00000.vtu")
        by_cell = dict(zip(cells["cell_id"][1], cells["sna"][1]))
        self.assertEqual([by_cell[i] for i in range(200)], list(range(200)))
        self.assertNotIn(7, cells["volume_um3"][1])
        self.render("--colour", "sna", "--size", "400x300", "--view", "ventral")
        self.assertGreater(len({pixel for row in pixels_of(self.picture) for pixel in row}), 200)
        self.picture.unlink()
        self.assertIn("use sna (nearest match)", self.refused(2, "--colour", "snaa"))
        self.assertIn('"name":"sna"', (self.out / "report.html").read_text(encoding="utf-8"))

    def test_what_it_does_not_know_is_refused(self):
        for arguments, parts in (
            (["--view", "ventrl"], ["use ventral (nearest match)", "cross-section"]),
            (["--view", "zzz"], VIEWS),
            (["--colour", "presure"], ["use pressure (nearest match)"]),
            (["--time", "5h"], ["5h", "5min"]),
            (["--time", "1min"], ["1min", "from 0 s to 0.3 s"]),
            (["--time=-1"], ["-1", "from 0 s to 0.3 s"]),
            (["--size", "10x10"], ["10x10", "1200x800"]),
            (["--size", "big"], ["big"]),
            (["--size", "200x200", "--view", "ventral,side,cross-section"], ["200x"]),
            (["--range", "3"], ["LOW:HIGH"]),
            (["--range", "3:3"], ["LOW:HIGH"]),
            (["--range", "0:nan"], ["LOW:HIGH"]),
            (["--movie", "--time", "0"], ["--movie"]),
            (["--at-x-um", "100"], ["100 is outside the embryo", "from -99.01 to 99.01"]),
            (["--at-x-um", "here"], ["--at-x-um", "here"]),
        ):
            message = self.refused(2, *arguments)
            for part in parts:
                self.assertIn(part, message, arguments)

    def test_a_directory_without_frames_is_refused(self):
        for directory, part in ((self.folder, "frames.pvd"), (self.folder / "nowhere", "directory does not exist")):
            self.assert_says(self.call("render", directory, "--out", self.picture, status=4), part)
        for file, part in (("picture.jpg", ".png"), ("fold.gif", f'plica.movie("{self.out}", "fold.gif")'),
                           ("fold.mp4", f'plica.movie("{self.out}", "fold.mp4")')):
            self.assert_says(self.call("render", self.out, "--out", file, status=2), part)

    def test_a_file_that_is_there_is_kept(self):
        self.picture.write_text("mine")
        self.assert_says(self.render(status=4), "--overwrite")
        self.assertEqual(self.picture.read_text(), "mine")

    def test_without_a_display_it_says_what_to_do(self):
        for display in ("", ":97"):
            message = self.refused(4, env={"PATH": "/nonexistent", "DISPLAY": display})
            self.assertIn("apt-get install xvfb, or set DISPLAY", message)

    def test_a_display_that_does_not_answer_is_not_used(self):
        self.render("--size", "300x250", env=dict(os.environ, DISPLAY=":97"))
        self.assertTrue(self.picture.exists())

    def test_a_movie_is_all_frames(self):
        result = self.render("--movie", "--size", "301x250")
        frames = sorted(path.name for path in self.folder.glob("*.png"))
        self.assertEqual(frames, [f"picture_{i:05d}.png" for i in range(4)])
        self.assertIn("4 of 4 pictures", result.stderr)
        self.assertRegex(result.stdout, r"ffmpeg .*picture_%05d.png' -frames:v 4 .*pad")
        self.assertEqual(len({(self.folder / name).read_bytes() for name in frames}), 4)
        self.assert_says(self.render("--movie", status=4), "picture_00000.png")
        if shutil.which("ffmpeg") is None:
            self.assertIn("pip install imageio-ffmpeg", result.stdout)

    def test_no_end_leaves_anything_running(self):
        for how, status in ((None, 0), (signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGKILL, -9)):
            size = "2000x2000" if how else "200x200"  # long enough to be met at work
            with support.running("render", self.out, "--out", self.picture, "--movie", "--size", size, "--overwrite") as process:
                for _ in range(200):
                    own = servers(process.pid)  # other tests have theirs
                    if own:
                        break
                    time.sleep(0.02)
                self.assertTrue(own, "no X server was started")
                if how:
                    time.sleep(0.5)  # until it draws
                    process.send_signal(how)
                self.assertEqual(support.ended(process).returncode, status)
            for _ in range(200):
                if not servers() & own and not processes_about(str(self.folder)):
                    break
                time.sleep(0.02)
            self.assertEqual(servers() & own, set())
            self.assertEqual(processes_about(str(self.folder)), [])


if __name__ == "__main__":
    if os.environ.pop("DISPLAY", None):
        print("DISPLAY is not looked at here")
    support.main()
