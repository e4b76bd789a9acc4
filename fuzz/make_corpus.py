"""Recreate the seeds of fuzz/corpus: small scenarios, meshes and checkpoints from which the fuzzers start.

Usage: make_corpus.py PROGRAM. Needed when a format has changed: checkpoints of another format are refused at once, and
tests/hostile/corpus_test.cpp says so. What a fuzzer found is put into
fuzz/found/TARGET by hand, once it is mended, and stays there.
"""
import itertools
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parent
sys.path.insert(0, str(root.parent / "tests/hostile"))
from random_scenario import Drawer  # noqa: E402
from scenario_table import read_table  # noqa: E402

program = str(Path(sys.argv[1]).resolve())

OVERRIDES = """\
base = "drosophila"
#! embryo.cells=[3, 3, 3]
#! contraction.apical.across_ratio = 2
#! time.linear_solver=direct
#! region.a.ids=[1,2]
"""
BLOCK = """\
[embryo]
shape = "block"
length_um = 40
cells = [2, 2, 1]
[vitelline]
enabled = false
[contraction.all]
region = "all"
stiffness_nN_per_um = 1
[division.d]
region = "all"
at_s = 0.1
growth_s = 1
[furrow]
vce_cell = 1
[time]
step_s = 0.1
end_s = 0.4
"""
SHELL = """\
[embryo]
shape = "sphere"
diameter_um = 200
cell_height_um = 30
cells = [1, 1, 1]
[furrow]
vce_cell = 1
[contraction.all]
region = "all"
stiffness_nN_per_um = 1
[monitor.m]
quantity = "volume"
[stop.s]
monitor = "m"
above = -1
[time]
step_s = 0.1
end_s = 0.3
"""


def write(target, name, content):
    folder = root / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content)


def scenarios():
    table = read_table(program)
    files = {"base": ["drosophila", "xenopus"], "embryo.file": ["mesh.vtu"], "monitor.reference": ["run"]}
    for number in range(16):
        write("scenario", f"drawn_{number}.toml", Drawer(random.Random(number), *table, files).draw().text().encode())
    write("scenario", "overrides.toml", OVERRIDES.encode())
    write("scenario", "block.toml", BLOCK.encode())
    write("scenario", "shell.toml", SHELL.encode())
    write("scenario", "strings.toml", b'title = """\na "quoted" \\u00b5 """""\n["region".\'a\']\nids = [0x1, 1_0]\n# "\n')


def studies():
    for file in sorted((root.parent / "docs/science/studies").glob("*.toml")):
        write("study", file.name, file.read_bytes())
    write("study", "drawn.toml", b'scenario = "xenopus"\n[set]\ntime.end_min = 1\n[vary]\ncontraction.apical.stiffness_nN_per_um = '
          b'{ mean = 5, sd = 1, low = 3 }\ntime.tolerance_um = { low = 0.01, high = 1, scale = "log" }\nembryo.cells = '
          b'{ values = [[5, 5, 4], [7, 7, 4]] }\n[design]\nkind = "latin-hypercube"\npoints = 7\nseed = 3\n[keep]\neach = "full"\n')
    write("study", "experiments.toml", b'title = "t"\nscenario = "xenopus"\n[experiment.a.outcome.depth]\nquestion = "How deep?"\nrole = "fitted"\n'
          b'quantity = "furrow_depth_um"\nhit = [1, inf]\nundecided = 0.5\n[experiment.b]\nquestion = "Deeper?"\nprediction = "hit"\ndraws = 3\n'
          b'slow = true\nset = { "time.end_min" = 2 }\n[experiment.b.outcome.depth]\nquantity = "furrow_depth_um"\nover = "a"\nhit_if_none = true\n')
    write("study", "points.csv", b'run,point,replicate,a.b,c,seeds\n0,1,1,"[1, 2]",3.5,a.seed=1 b.seed=2\n1,2,1,"""x""",1e9,\n')


def items(form, values):
    return struct.pack("<Q", len(values)) + b"".join(struct.pack("<" + form, *value) for value in values)


def mesh(points, cells, faces, arrays=(), groups=((), (), (), (), ())):
    """Encode as tissue/files/child_reading.hpp, without remarks."""
    data = items("3d", points) + items("8i", cells)
    for numbers in (faces, *groups):
        data += items("i", [(number,) for number in numbers])
    data += items("Q", [(len(arrays),)])
    for name, values in arrays:
        data += struct.pack("<Q", len(name)) + name + items("d", [(value,) for value in values])
    return data + items("Q", [(0,)])


def meshes():
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    one = mesh([tuple(10.0 * c for c in corner) for corner in corners], [tuple(range(8))], [5], [(b"marked", [1])])
    write("mesh", "one_cell", b"\0" + one)
    write("mesh", "one_cell_of_eight_elements", b"\5" + one)
    grid = [(10.0 * x, 10.0 * y, 20.0 * z) for z, y, x in itertools.product((0, 1), (0, 1, 2), (0, 1, 2))]
    index = lambda x, y, z: x + 3 * y + 9 * z
    four = [tuple(index(x + a, y + b, z) for z in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
            for x, y in itertools.product((0, 1), (0, 1))]
    write("mesh", "four_cells", b"\0" + mesh(grid, four, [5] * 4, [(b"left", [1, 0.5, 0, 0])]))
    pairs = ([0, 0, 1, 1], [], [12, 12], [*(index(x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (1, 2), (0, 2), (0, 1))),
                                         *(index(x, y, 1) for x, y in ((0, 0), (1, 0), (1, 1), (1, 2), (0, 2), (0, 1))),
                                         *(index(x, y, 0) for x, y in ((1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (1, 1))),
                                         *(index(x, y, 1) for x, y in ((1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (1, 1)))], [])
    write("mesh", "two_cells_of_two", b"\0" + mesh(grid, four, [], [(b"left", [1, 1, 0, 0])], pairs))
    write("mesh", "one_grid_cell_of_four", b"\0" + mesh(grid, [four[i] for i in (0, 2, 1, 3)], [], [],
                                                       ([0] * 4, [2, 2, 1], [], [], [])))
    # A cube with a hollow cube in it: six cells around, and what is outside is found.
    shell = [tuple(size * (2 * c - 1.0) for c in corner) for size in (10, 20) for corner in corners]
    sides = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
    hollow = [tuple(reversed(side)) + tuple(8 + corner for corner in reversed(side)) for side in sides]
    write("mesh", "hollow_cube", b"\0" + mesh(shell, hollow, []))


def polygons():
    corners = [(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    faces = ((3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    lines = lambda rows: "".join(" ".join(map(str, row)) + "\n" for row in rows)
    write("polygons", "cube.obj", ("o" + lines(("v", *c) for c in corners) + lines(("f", *(v + 1 for v in f)) for f in faces)).encode())
    write("polygons", "soup.obj", ("o" + "".join(lines(("v", *corners[v]) for v in f) + "f -4 -3 -2 -1\n" for f in faces)).encode())
    write("polygons", "patch.off", b"fOFF 6 2 0\n0 0 0\n1 0 0\n2 0 0.1\n0 1 0\n1 1 0\n2 1 0\n4 0 1 4 3\n4 1 4 5 2 9 9 9\n")
    head = "ply\nformat %s 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n" \
           "property list uchar int vertex_indices\nproperty short height\nend_header\n"
    write("polygons", "cube.ply", ("p" + head % "ascii" + lines(corners) + lines((4, *f, 2) for f in faces)).encode())
    write("polygons", "cube_of_bytes.ply", ("p" + head % "binary_little_endian").encode()
          + b"".join(struct.pack("<3f", *c) for c in corners) + b"".join(struct.pack("<B4ih", 4, *f, 2) for f in faces))


def checkpoints():
    for name, text in (("divided", BLOCK), ("shell", SHELL)):
        with tempfile.TemporaryDirectory() as folder:
            scenario = Path(folder) / "scenario.toml"
            scenario.write_text(text)
            subprocess.run([program, "run", scenario, "--out", Path(folder) / "out", "--quiet"], check=True)
            whole = (Path(folder) / "out/checkpoint.h5").read_bytes()
        write("checkpoint", f"{name}.whole", b"f" + whole)
        write("checkpoint", f"{name}.hdf5", b"h" + whole[:-64])


scenarios()
studies()
meshes()
polygons()
checkpoints()
print(f"{sum(f.stat().st_size for f in (root / 'corpus').rglob('*') if f.is_file())} bytes in {root / 'corpus'}")
