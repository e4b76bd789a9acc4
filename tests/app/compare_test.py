"""`plica compare`: two runs beside each other, as a table, as JSON and as a mesh."""
import json
import shutil

import support
from support import BLOCK, SPHERE, CommandLine, read_vtu, table

MONITOR = '[monitor.motion]\nquantity = "displacement"\n[monitor.cpu]\nquantity = "wall"\n'


class Compare(CommandLine):
    def run_as(self, name, text, *arguments, **options):
        out = self.folder / name
        self.run_scenario(text, *arguments, out=out, name=f"{name}.toml", **options)
        return out

    def compare(self, *arguments, status=0):
        return self.call("compare", *arguments, status=status)

    def json_of(self, *arguments):
        return json.loads(self.compare(*arguments, "--json").stdout, parse_constant=lambda name: self.fail(name))

    def test_identical_runs_are_no_distance_apart(self):
        a, b = self.run_as("a", SPHERE + MONITOR), self.run_as("b", SPHERE + MONITOR)
        found = self.json_of(a, b)
        self.assertTrue(found["same_mesh"])
        self.assertEqual({found["nodes"][key] for key in ("mean_um", "rms_um", "max_um")}, {0})
        self.assertEqual(found["relative_energy_norm"], 0)
        for way in ("a_to_b", "b_to_a"):
            for value in found["apical_surface"][way].values():
                self.assertLess(value, 1e-10)
        self.assertLess(found["apical_surface"]["hausdorff_um"], 1e-10)
        for section in ("geometry", "summary", "series"):
            self.assertGreater(len(found[section]), 2)
            for name, pair in found[section].items():
                self.assertEqual(pair["a"], pair["b"], name)
                self.assertIn(pair["difference"], (0, None), name)
        self.assertIn("motion.displacement_um", found["summary"])
        self.assertEqual(found["series"]["motion.displacement_um"]["largest_difference"], 0)
        for name in ("wall_s", "cpu.wall_s"):
            self.assertNotIn(name, found["summary"])
        self.assertNotIn("cpu.wall_s", found["series"])

    def test_runs_that_differ(self):
        a, b = self.run_as("a", BLOCK + MONITOR, "--set", "contraction.all.stiffness_nN_per_um=0.5"), self.run_as("b", BLOCK + MONITOR)
        found = self.json_of(a, b)
        self.assertAlmostEqual(found["relative_energy_norm"], 0.5, delta=0.1)
        self.assertGreater(found["nodes"]["max_um"], found["nodes"]["rms_um"])
        column = found["series"]["motion.displacement_um"]
        rows = [[float(row["motion.displacement_um"]) for row in table(out / "series.csv")] for out in (a, b)]
        self.assertEqual((column["a"], column["b"]), (rows[0][-1], rows[1][-1]))
        self.assertAlmostEqual(column["difference"], rows[0][-1] - rows[1][-1], delta=1e-12)
        self.assertAlmostEqual(column["largest_difference"], max(abs(x - y) for x, y in zip(*rows)), delta=1e-12)
        self.assertEqual(column["largest_at_s"], 0.5)
        early = self.json_of(a, b, "--time_s", "0.2")["series"]["motion.displacement_um"]
        self.assertEqual((early["a"], early["largest_at_s"]), (rows[0][2], 0.2))
        text = self.compare(a, b).stdout
        for part in ("node by node", "apical surfaces", "Hausdorff", "relative energy norm", "motion.displacement_um", "volume_um3"):
            self.assertIn(part, text)
        self.assertLessEqual(max(map(len, text.splitlines())), 120)

    def test_different_meshes_are_compared_by_surface(self):
        fine = SPHERE.replace("[5, 5, 4]", "[5, 5, 4]\nelements_per_cell = [2, 2, 1]")
        a, b = self.run_as("a", fine), self.run_as("b", SPHERE)
        found = self.json_of(a, b)
        self.assertFalse(found["same_mesh"])
        self.assertIsNone(found["nodes"])
        self.assertIsNone(found["relative_energy_norm"])
        # The finer sphere is rounder: up to the height of an arc over its chord away.
        self.assertGreater(found["apical_surface"]["hausdorff_um"], 0.5)
        self.assertLess(found["apical_surface"]["hausdorff_um"], 10)
        self.assertIn("furrow_depth_um", found["series"])
        self.assertIn("meshes differ", self.compare(a, b).stdout)

    def test_a_mesh_coloured_by_distance(self):
        a, b = self.run_as("a", BLOCK, "--set", "contraction.all.stiffness_nN_per_um=0.5"), self.run_as("b", BLOCK)
        mesh = self.folder / "distances.vtu"
        self.compare(a, b, "--out", mesh)
        arrays = read_vtu(mesh)
        section, distances = arrays["distance_um"]
        self.assertEqual((section, len(distances)), ("PointData", 24))
        self.assertGreater(max(distances), 1e-4)
        self.assertIn("deviation_um", arrays)
        before = mesh.read_bytes()
        self.assert_says(self.compare(a, b, "--out", mesh, status=4), "--overwrite")
        self.compare(a, a, "--out", mesh, "--overwrite")
        self.assertNotEqual(mesh.read_bytes(), before)
        self.assertLess(max(read_vtu(mesh)["distance_um"][1]), 1e-12)
        self.compare(a, b, "--out", self.folder / "distances.png", status=2)

    def test_what_is_no_run(self):
        a = self.run_as("a", BLOCK)
        empty, no_frames, torn = (self.folder / name for name in ("empty", "no_frames", "torn"))
        empty.mkdir()
        shutil.copytree(a, no_frames)
        (no_frames / "frames.pvd").write_text("<VTKFile><Collection></Collection></VTKFile>")
        shutil.copytree(a, torn)
        last = sorted((torn / "frames").iterdir())[-1]
        last.write_bytes(last.read_bytes()[:200])
        no_frame_files = self.folder / "no_frame_files"
        shutil.copytree(a, no_frame_files)
        shutil.rmtree(no_frame_files / "frames")
        cases = [(self.folder / "missing", "directory does not exist"), (empty, "frames.pvd"), (no_frames, "lists no snapshot"), (torn, last.name),
                 (no_frame_files, "frame_"), (self.folder / "a.toml", "not a directory")]
        for directory, part in cases:
            for order in ((a, directory), (directory, a)):
                with self.subTest(f"{part} {order}"):
                    self.assert_says(self.compare(*order, status=4), part)
        self.assert_says(self.compare(a, a, "--time_s", "0.3", status=2), "0.2")
        self.compare(a, status=2)
        self.compare(a, a, "--time_s", "nan", status=2)
        # Without a summary, as a killed run leaves it, and without a scenario: what is there is compared.
        killed = self.folder / "killed"
        shutil.copytree(a, killed)
        for name in ("summary.json", "scenario.toml", "series.csv"):
            (killed / name).unlink()
        found = self.json_of(a, killed)
        self.assertEqual((found["nodes"]["max_um"], found["relative_energy_norm"], found["series"]), (0, None, {}))
        self.assertIsNone(found["b"]["status"])
        (killed / "summary.json").write_text("{")
        self.assert_says(self.compare(a, killed, status=4), "summary.json")


if __name__ == "__main__":
    support.main()
