"""Tissue from surfaces of polygons: every format gives the same cells, and what `plica mesh` has written comes back to the same bytes.

Run: surface_test.py PROGRAM
"""
import gzip
import math
from pathlib import Path

import support
from support import CommandLine, plica

HERE = Path(__file__).parent
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


def honeycomb():
    """Corners of 12 hexagons, each vertex once, and the faces."""
    places, vertices, faces = {}, [], []
    for row in range(3):
        for column in range(4):
            face = []
            for corner in range(6):
                turn = math.radians(60 * corner + 30)
                point = (6 * (column + row % 2 / 2) + 6 / math.sqrt(3) * math.cos(turn),
                         6 * row * math.sqrt(0.75) + 6 / math.sqrt(3) * math.sin(turn), 0.25)
                key = tuple(round(c, 6) for c in point)
                if key not in places:
                    places[key] = len(vertices)
                    vertices.append(point)
                face.append(places[key])
            faces.append(face)
    return vertices, faces


def rows(values, front=""):
    return "".join(front + " ".join(map(repr, row)) + "\n" for row in values)


class Formats(CommandLine):
    def mesh_of(self, name, content, *arguments):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        out = self.folder / "rest.vtu"
        result = plica("mesh", self.write(SCENARIO.replace("NAME", name)), "--out", out, "--overwrite", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return out.read_bytes(), result.stdout

    def test_all_formats_give_the_same_mesh(self):
        vertices, faces = honeycomb()
        counted = [(6, *face) for face in faces]
        numbers = [c for p in vertices for c in p]
        legacy = (f"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS {len(vertices)} double\n{rows(vertices)}"
                  f"POLYGONS 12 {12 * 7}\n{rows(counted)}")
        vtp = ('<?xml version="1.0"?><VTKFile type="PolyData" version="0.1"><PolyData><Piece '
               f'NumberOfPoints="{len(vertices)}" NumberOfPolys="12"><Points><DataArray type="Float64" NumberOfComponents="3" '
               f'format="ascii">{" ".join(map(repr, numbers))}</DataArray></Points><Polys><DataArray type="Int64" '
               f'Name="connectivity" format="ascii">{" ".join(str(v) for f in faces for v in f)}</DataArray><DataArray '
               f'type="Int64" Name="offsets" format="ascii">{" ".join(str(6 * (i + 1)) for i in range(12))}</DataArray>'
               "</Polys></Piece></PolyData></VTKFile>")
        contents = {
            "a.obj": rows(vertices, "v ") + rows([[v + 1 for v in f] for f in faces], "f "),
            "a.off": f"OFF\n{len(vertices)} 12 0\n" + rows(vertices) + rows(counted),
            "a.ply": f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\n"
                     "property double z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n"
                     + rows(vertices) + rows(counted),
            "a.vtk": legacy, "a.vtp": vtp,
        }
        first, table = self.mesh_of("a.obj", contents["a.obj"])
        self.assertIn("12 cells, 24 elements,", table)
        self.assertIn("corners                   6: 100.0 %", table)
        for name, content in contents.items():
            with self.subTest(name):
                self.assertEqual(self.mesh_of(name, content)[0], first)

    def test_a_sheet_of_tyssue(self):
        # Two triangles by pandas' HDFStore, with heights of 7.5 and 8 and names.
        table = self.mesh_of("a.hf5", gzip.decompress((HERE / "tyssue_two_faces.hf5.gz").read_bytes()),
                             "--set", "embryo.scale=[10, 10, 10]", "--set", "embryo.cell_height_array=height")[1]
        self.assertIn("2 cells, 6 elements,", table)
        self.assertRegex(table, r"cell height, um +7\.500 +7\.750 +8\.000")

    def test_a_patch_runs_and_its_rim_stays(self):
        vertices, faces = honeycomb()
        (self.folder / "a.obj").write_text(rows(vertices, "v ") + rows([[v + 1 for v in f] for f in faces], "f "))
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
                self.assertEqual(plica("mesh", path, "--out", rest).returncode, 0)
                back = ["--set", "embryo.shape=file", "--set", f"embryo.file={rest}", "--set", "embryo.elements_per_cell=[1,1,1]"]
                result = plica("mesh", path, *back, "--out", again)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(rest.read_bytes(), again.read_bytes())
                series = []
                for arguments in ([], back):
                    out = self.folder / f"{name}{len(series)}"
                    result = plica("run", path, *arguments, "--out", out, "--quiet")
                    self.assertEqual(result.returncode, 0, result.stderr)
                    series.append((out / "series.csv").read_bytes())
                self.assertEqual(*series)

    def test_a_shell_is_there_by_default_only_where_the_tissue_is_closed(self):
        for shape, extra, closed in (("sheet", "width_um = 40\ncell_count = 40\n", False), ("sphere", "cells = [2, 2, 2]\n", True)):
            with self.subTest(shape):
                size = "diameter_um = 60\n" if shape == "sphere" else "length_um = 60\n"
                rest = self.folder / f"{shape}.vtu"
                built = self.write(f'format = 1\n[embryo]\nshape = "{shape}"\n{size}{extra}cell_height_um = 9\n')
                self.assertEqual(plica("mesh", built, "--out", rest).returncode, 0)
                acting = ('[region.r]\nids = [0, 1]\n[cortex.a]\nregion = "r"\ntension_mN_per_m = 1\n'
                          'profile = { shape = "linear", axis = "across", half_width_um = 9 }\n')
                text = f'format = 1\n[embryo]\nshape = "file"\nfile = "{rest.name}"\n{acting}'
                result = plica("check", self.write(text))
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn(f"[vitelline]\nenabled = {str(closed).lower()}\n", result.stdout)
                self.assertIn("cortex.a: profile runs along " + ("the arc about x" if closed else "y, since"), result.stderr)
                drag = text + "[vitelline]\ndrag_Pa_s_per_um = 5\n"
                if closed:
                    self.assertEqual(plica("check", self.write(drag)).returncode, 0)
                else:
                    self.assert_refused(drag, "an open tissue has none by default", line=12, key="vitelline.drag_Pa_s_per_um")

    def test_without_corners_it_is_refused(self):
        sheet = 'format = 1\n[embryo]\nshape = "sheet"\nlength_um = 60\nwidth_um = 40\ncell_count = 40\ncell_height_um = 9\n'
        path, rest = self.write(sheet + "[time]\nend_s = 1\n"), self.folder / "rest.vtu"
        self.assertEqual(plica("mesh", path, "--out", rest).returncode, 0)
        whole = rest.read_bytes()
        rest.write_bytes(whole.replace(b'Name="cell_corner_counts"', b'Name="other_corner_cnts"'))
        scenario = 'format = 1\n[embryo]\nshape = "file"\nfile = "rest.vtu"\n[vitelline]\nenabled = false\n'
        self.assert_refused(scenario, "embryo.file: ", "rest.vtu: the array cell_id joins", line=4)
        rest.write_bytes(whole.replace(b'Name="cell_id"', b'Name="id_cell"'))
        self.assert_refused(scenario, "rest.vtu: the file lists the corners of its cells but has no cell array cell_id", line=4)


if __name__ == "__main__":
    support.main()
