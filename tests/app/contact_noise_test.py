"""Nothing passes through anything, by a test of triangles that is not plica's (tests/crossings.py): furrows that close,
with every cell's apical cortex stronger or weaker by a third, one and two elements high."""
import sys
from pathlib import Path

import support
from support import CommandLine

sys.path.insert(0, str(Path(__file__).parents[1]))
from crossings import crossings, crossings_of_run  # noqa: E402

SLICE = """
base = "furrow-slice"
[cortex.apical]
variation = { spread = 0.3, seed = 1 }
"""
# drosophila-living with 1096 cells: profiles are in numbers of cells. It closes later.
COARSE = """
base = "drosophila-living"
[embryo]
cells = [28, 9, 8]
[region.mesoderm]
face = "ventral"
cells_across = 7
[cortex.apical]
profile = { shape = "gaussian", axis = "across", sigma_cells = 1.86, full_length_um = 390, fade_um = 45 }
variation = { spread = 0.3, seed = 1 }
[cortex.shortening]
profile = { shape = "plateau", about = "mesoderm", full_cells = 6.21, fade_cells = 1.49, full_length_um = 390, fade_um = 45 }
[cortex.floor]
profile = { shape = "plateau", about = "mesoderm", full_cells = 7.45, fade_cells = 1.99, full_length_um = 390, fade_um = 45 }
[cortex.floor-elsewhere]
profile = { shape = "plateau", about = "mesoderm", full_cells = 7.45, fade_cells = 1.99, full_length_um = 390, fade_um = 45, \
middle = 0, edge = 1 }
[time]
end_min = 24
"""


class ContactNoise(CommandLine):
    def check(self, text, high):
        # What the base expects is of a tissue without noise: a missed expectation ends in status 1.
        self.run_scenario(text, "--quiet", "--overwrite", "--set", f"embryo.elements_per_cell=[1, 1, {high}]", timeout=300, status=(0, 1))
        found = crossings_of_run(self.out)
        self.assertGreater(len(found), 20)
        self.assertEqual([frame for frame in found if frame[1]], [])
        self.assertEqual(self.summary()["self_intersections"], 0)
        self.assertGreater(max(int(row["contact_pairs"]) for row in support.table(self.out / "series.csv")), 10)

    def test_of_a_slice(self):
        for high in (1, 2):
            self.check(SLICE, high)

    def test_of_a_whole_embryo(self):
        """Without contact of edges, facets of this size cut each other two elements high (docs/theory/self_contact.md)."""
        self.check(COARSE, 1)
        self.check(COARSE, 2)

    def test_crossings_are_found(self):
        """Two squares that pass through each other, lie beside each other, or have a node in common."""
        import numpy as np

        flat = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
        upright = np.array([[0.3, 0.4, -1], [0.3, 0.4, 1], [2, 0.6, 1], [2, 0.6, -1]])
        facets = np.array([[0, 1, 2, 3], [4, 5, 6, 7]])
        self.assertEqual(crossings(np.vstack([flat, upright]), facets), 1)
        self.assertEqual(crossings(np.vstack([flat, upright + [1, 0, 0]]), facets), 0)
        self.assertEqual(crossings(np.vstack([flat, upright]), np.array([[0, 1, 2, 3], [4, 5, 6, 0]])), 0)


if __name__ == "__main__":
    support.main()
