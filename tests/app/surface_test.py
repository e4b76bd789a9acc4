"""Tissue from surfaces of polygons: every format gives the same cells, and what `plica mesh` has written comes back to the same bytes."""
import gzip
import sys
from pathlib import Path

import support
from support import CommandLine

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "hostile"))
from bad_files import FORMATS, POLYGONS, sheet  # noqa: E402

SCENARIO = """\
format = 1
[embryo]
shape = "surface"
file = "NAME"
cell_height_um = 5
rim = "held"
[region.left]
x_um = [-100, 12]
[contraction.apical]
region = "left"
stiffness_nN_per_um = 1
[time]
end_s = 1
"""


class Formats(CommandLine):
    def mesh_of(self, name, content, *arguments):
        self.write(content, name)
        out = self.folder / "rest.vtu"
        result = self.call("mesh", self.write(SCENARIO.replace("NAME", name)), "--out", out, "--overwrite", *arguments)
        return out.read_bytes(), result.stdout

    def test_all_formats_give_the_same_mesh(self):
        tissue = sheet()
        tissue.arrays = {}  # of which not every format has any
        first, table = self.mesh_of("a.obj", FORMATS[POLYGONS]["obj"][1](tissue))
        self.assertIn("12 cells, 24 elements,", table)
        self.assertIn("corners                   6: 100.0 %", table)
        for name, (ending, write) in FORMATS[POLYGONS].items():
            with self.subTest(name):
                self.assertEqual(self.mesh_of(f"a.{ending}", write(tissue))[0], first)

    def test_a_sheet_of_tyssue(self):
        # Two triangles by pandas' HDFStore, with heights of 7.5 and 8 and names.
        table = self.mesh_of("a.hf5", gzip.decompress((HERE / "tyssue_two_faces.hf5.gz").read_bytes()),
                             "--set", "embryo.scale=[10, 10, 10]", "--set", "embryo.cell_height_array=height")[1]
        self.assertIn("2 cells, 6 elements,", table)
        self.assertRegex(table, r"cell height, um +7\.500 +7\.750 +8\.000")

    def test_a_patch_runs_and_its_rim_stays(self):
        self.write(FORMATS[POLYGONS]["obj"][1](sheet()), "a.obj")
        self.run_scenario(SCENARIO.replace("NAME", "a.obj"))
        self.assert_whole(self.out)


class BackFromAFile(CommandLine):
    """A tissue's mesh, read as shape "file", is the same tissue: its mesh has the same bytes, and it folds alike."""

    def test_polygons_and_grids(self):
        sheet = ('format = 1\n[embryo]\nshape = "sheet"\nlength_um = 60\nwidth_um = 40\ncell_count = 40\ncell_height_um = 9\n'
                 "[region.left]\nx_um = [-100, 0]\n[contraction.a]\nregion = \"left\"\nstiffness_nN_per_um = 0.3\n"
                 "profile = { shape = \"gaussian\", axis = \"across\", sigma_um = 8 }\n[time]\nend_s = 2\n")
        block = (sheet.replace('"sheet"', '"block"').replace("cell_count = 40", "cells = [3, 2, 1]\nelements_per_cell = [2, 2, 3]"))
        for name, text in (("diagonals", sheet), ("kites", sheet.replace("cell_count", 'elements = "kites"\nlayers = 2\ncell_count')),
                           ("grid", block)):
            with self.subTest(name):
                rest, again = self.folder / f"{name}.vtu", self.folder / f"{name}_again.vtu"
                path = self.write(text)
                self.call("mesh", path, "--out", rest)
                back = ["--set", "embryo.shape=file", "--set", f"embryo.file={rest}", "--set", "embryo.elements_per_cell=[1,1,1]"]
                self.call("mesh", path, *back, "--out", again)
                self.assertEqual(rest.read_bytes(), again.read_bytes())
                series = []
                for arguments in ([], back):
                    out = self.folder / f"{name}{len(series)}"
                    self.call("run", path, *arguments, "--out", out, "--quiet")
                    series.append((out / "series.csv").read_bytes())
                self.assertEqual(*series)

    def test_a_shell_is_there_by_default_only_where_the_tissue_is_closed(self):
        for shape, extra, closed in (("sheet", "width_um = 40\ncell_count = 40\n", False), ("sphere", "cells = [2, 2, 2]\n", True)):
            with self.subTest(shape):
                size = "diameter_um = 60\n" if shape == "sphere" else "length_um = 60\n"
                rest = self.folder / f"{shape}.vtu"
                built = self.write(f'format = 1\n[embryo]\nshape = "{shape}"\n{size}{extra}cell_height_um = 9\n')
                self.call("mesh", built, "--out", rest)
                acting = ('[region.r]\nids = [0, 1]\n[cortex.a]\nregion = "r"\ntension_mN_per_m = 1\n'
                          'profile = { shape = "linear", axis = "across", half_width_um = 9 }\n')
                text = f'format = 1\n[embryo]\nshape = "file"\nfile = "{rest.name}"\n{acting}'
                result = self.call("check", self.write(text))
                self.assertIn(f"[vitelline]\nenabled = {str(closed).lower()}\n", result.stdout)
                self.assertIn("cortex.a: profile runs along " + ("the arc about x" if closed else "y, since"), result.stderr)
                drag = text + "[vitelline]\ndrag_Pa_s_per_um = 5\n"
                if closed:
                    self.call("check", self.write(drag))
                else:
                    self.assert_refused(drag, "an open tissue has none by default", line=12, key="vitelline.drag_Pa_s_per_um")

    def test_without_corners_it_is_refused(self):
        sheet = 'format = 1\n[embryo]\nshape = "sheet"\nlength_um = 60\nwidth_um = 40\ncell_count = 40\ncell_height_um = 9\n'
        path, rest = self.write(sheet + "[time]\nend_s = 1\n"), self.folder / "rest.vtu"
        self.call("mesh", path, "--out", rest)
        whole = rest.read_bytes()
        rest.write_bytes(whole.replace(b'Name="cell_corner_counts"', b'Name="other_corner_cnts"'))
        scenario = 'format = 1\n[embryo]\nshape = "file"\nfile = "rest.vtu"\n[vitelline]\nenabled = false\n'
        self.assert_refused(scenario, "embryo.file: ", "rest.vtu: the array cell_id joins", line=4)
        rest.write_bytes(whole.replace(b'Name="cell_id"', b'Name="id_cell"'))
        self.assert_refused(scenario, "rest.vtu: the file lists the corners of its cells but has no cell array cell_id", line=4)


if __name__ == "__main__":
    support.main()
