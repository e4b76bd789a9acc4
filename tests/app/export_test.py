"""`plica export` and what `plica mesh` shows: polygons read back with VTK's reader, tables, arrays, pictures."""
import math

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

import support
from support import BLOCK, CommandLine

EGG = """\
format = 1
[embryo]
shape = "egg"
length_um = 200
diameter_um = 100
cell_count = 150
cell_height_um = 18
layers = 2
[region.mesoderm]
rows = 5
[region.mesectoderm]
neighbours_of = "mesoderm"
[elasticity.apex]
region = "mesoderm"
height_percent = [50, 100]
young_modulus_Pa = 4000
[contraction.apical]
region = "mesoderm"
stiffness_nN_per_um = 4
profile = { shape = "gaussian", axis = "angle", sigma_deg = 25 }
pulse = { period_s = 60, amplitude = 0.5 }
[time]
end_s = 2
[output]
frame_every_s = 1
"""


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def numbers(path):
    return [{key: float(value) for key, value in row.items()} for row in support.table(path)]


class Export(CommandLine):
    def path(self, name):
        return self.folder / name

    def run_of(self, scenario):
        self.run_scenario(scenario, "--quiet")
        return self.out

    def test_a_surface_reads_back(self):
        run = self.run_of(EGG)
        self.assertIn("150 polygons, 296 vertices at 2 s", self.call("export", run, "--out", self.path("cells.vtp")).stdout)
        surface = read(vtkXMLPolyDataReader(), self.path("cells.vtp"))
        self.assertEqual((surface.GetNumberOfPolys(), surface.GetNumberOfPoints()), (150, 296))
        self.assertEqual(surface.GetFieldData().GetArray("TimeValue").GetValue(0), 2)
        ids, strength = (surface.GetCellData().GetArray(name) for name in ("cell_id", "strength"))
        self.assertEqual([ids.GetValue(c) for c in range(150)], list(range(150)))
        self.assertGreater(max(strength.GetValue(c) for c in range(150)), 0.9)
        # The points are nodes of the frame, which the frame's displacements have carried there.
        grid = read(vtkXMLUnstructuredGridReader(), sorted((run / "frames").glob("*.vtu"))[-1])
        nodes = {grid.GetPoint(n) for n in range(grid.GetNumberOfPoints())}
        self.assertTrue(all(surface.GetPoint(p) in nodes for p in range(296)))

    def test_tables_are_those_of_the_surface(self):
        run = self.run_of(EGG)
        self.assertIn("at 1 s", self.call("export", run, "--out", self.path("tables"), "--time", "1s", "--side", "basal").stdout)
        vertices, edges, faces = (numbers(self.path("tables") / f"{name}.csv") for name in ("vert", "edge", "face"))
        self.assertEqual((len(vertices), len(edges), len(faces)), (296, 888, 150))
        self.assertEqual(list(edges[0]), ["edge", "srce", "trgt", "face", "opposite", "dx", "dy", "dz", "length"])
        self.assertEqual(list(faces[0])[:7], ["face", "x", "y", "z", "num_sides", "area", "perimeter"])
        self.assertLess(abs(sum(face["area"] for face in faces) / (math.pi * 4 * 32 * 82) - 1), 0.35)

    def test_what_is_wrong_is_said(self):
        run = self.run_of(BLOCK)
        out = self.path("cells.vtp")
        for arguments, status, said in [
                (("nowhere", "--out", out), 4, "nowhere"),
                ((run, "--out", self.path("cells.stl")), 2, "neither FILE.vtp (surface) nor a directory"),
                ((run, "--out", out, "--time", "soon"), 2, "--time soon: not a time; give 5min"),
                ((run, "--out", out, "--time", "9min"), 2, "--time 9min: the run has snapshots from 0 s to 0.5 s"),
                ((run, "--out", out, "--side", "left"), 2, "--side"),
                ((run,), 2, "--out")]:
            self.assertIn(said, self.call("export", *arguments, status=status).stderr)
        self.assertFalse(out.exists())
        out.write_text("mine")
        self.assertIn("already exists", self.call("export", run, "--out", out, status=4).stderr)
        self.assertEqual(out.read_text(), "mine")
        self.call("export", run, "--out", out, "--overwrite")

    def test_meshes_have_what_is_said_of_cells(self):
        scenario = self.write(EGG)
        self.call("mesh", scenario, "--out", self.path("rest.vtu"))
        grid = read(vtkXMLUnstructuredGridReader(), self.path("rest.vtu"))
        data = grid.GetCellData()
        strength, modulus, rows, beside = (
            [data.GetArray(name).GetTuple1(e) for e in range(grid.GetNumberOfCells())]
            for name in ("strength_contraction.apical", "young_modulus_Pa", "region_mesoderm", "region_mesectoderm"))
        self.assertEqual({value for value, row in zip(strength, rows) if not row}, {0})
        self.assertGreater(max(strength), 0.95)
        # Half of the elements of these cells are their apices.
        self.assertEqual(modulus.count(4000), sum(rows) / 2)
        self.assertEqual(set(modulus), {1000, 4000})
        self.assertFalse(any(a and b for a, b in zip(rows, beside)))
        self.assertIsNotNone(data.GetArray("pulse_phase_contraction.apical"))
        for file, colour, said in (("rest.png", "apica", "use strength_contraction.apical (nearest match); available: region, "),
                                   ("rest.jpg", "apical", "must end in .vtu, or in .png")):
            refused = self.call("mesh", scenario, "--out", self.path(file), "--colour", f"strength_contraction.{colour}", status=2)
            self.assertIn(said, refused.stderr)
        self.call("mesh", scenario, "--out", self.path("rest.png"), "--color", "strength_contraction.apical", "--view", "ventral,cross-section")
        self.assertEqual(self.path("rest.png").read_bytes()[:4], b"\x89PNG")


if __name__ == "__main__":
    support.main()
