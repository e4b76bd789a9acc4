#!/usr/bin/python3
"""The same continuum in polygonal and in quadrilateral cells: an ellipsoid of one modulus whose belly has an apical tension
that fades with the angle and along the axis. Depth at rest by the number of cells, for both.

Usage: polygons_against_quadrilaterals.py PROGRAM OUT [--cells 756 1500 3000 6000] [--seeds 1 2]. Prints a table in Markdown;
runs stay in OUT.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
from pathlib import Path

parser = argparse.ArgumentParser()
parser.add_argument("program", type=Path)
parser.add_argument("out", type=Path)
parser.add_argument("--cells", type=int, nargs="+", default=[756, 1500, 3000, 6000])
parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
options = parser.parse_args()

LENGTH, DIAMETER = 460, 280
SCENARIO = """format = 1
[embryo]
{embryo}
cell_height_um = 35
[elasticity]
young_modulus_Pa = 1000
poisson_ratio = 0.45
[region.belly]
angle_deg = [-60, 60]
[cortex.apical]
region = "all"
tension_mN_per_m = 4
profile = {{ shape = "gaussian", axis = "angle", sigma_deg = 20, full_length_um = 160, fade_um = 160 }}
program = {{ time_min = [0, 3], activity = [0, 1] }}
[furrow]
region = "belly"
[vitelline]
enabled = false
[time]
integrator = "bdf2"
end_min = 60
[output]
frame_every_min = 60
"""


def ellipsoid_of_quadrilaterals(count: int, path: Path) -> int:
    """A box of a x b x b squares, by equal angles on a ball, stretched. Returns how many squares there are."""
    b = max(2, round(math.sqrt(count / (2 + 4 * LENGTH / DIAMETER * 1.1))))
    a = round((count - 2 * b * b) / (4 * b))
    sides = (a, b, b)
    number: dict[tuple[int, int, int], int] = {}
    places = []

    def corner(at: tuple[int, int, int]) -> int:
        if at not in number:
            u = [math.tan(math.pi / 4 * (2 * i / n - 1)) for i, n in zip(at, sides)]
            r = math.sqrt(sum(c * c for c in u))
            places.append([c / r * half for c, half in zip(u, (LENGTH / 2, DIAMETER / 2, DIAMETER / 2))])
            number[at] = len(places)
        return number[at]

    faces = []
    for axis in range(3):
        v, w = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, sides[axis]):
            for i in range(sides[v]):
                for j in range(sides[w]):
                    ring = []
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        at = [0, 0, 0]
                        at[axis], at[v], at[w] = end, i + di, j + dj
                        ring.append(corner((at[0], at[1], at[2])))
                    faces.append(ring if end else ring[::-1])
    path.write_text("".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in places)
                    + "".join("f " + " ".join(map(str, face)) + "\n" for face in faces), encoding="utf-8")
    return len(faces)


def run(name: str, embryo: str) -> dict:
    scenario = options.out / f"{name}.toml"
    scenario.write_text(SCENARIO.format(embryo=embryo), encoding="utf-8")
    out = options.out / name
    subprocess.run([options.program.resolve(), "run", scenario, "--out", out, "--quiet", "--overwrite"], check=True,
                   env={"OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive", **os.environ})
    return json.loads((out / "summary.json").read_text(encoding="utf-8"))


options.out.mkdir(parents=True, exist_ok=True)
print("| cells | depth, polygons (µm) | quadrilaterals | difference |\n|---|---|---|---|")
for cells in options.cells:
    squares = ellipsoid_of_quadrilaterals(cells, options.out / f"quads-{cells}.obj")
    quads = run(f"quads-{cells}-run", f'shape = "surface"\nfile = "quads-{cells}.obj"')
    depths = []
    for seed in options.seeds:
        egg = f'shape = "egg"\nlength_um = {LENGTH}\ndiameter_um = {DIAMETER}\ncell_count = {squares}\nseed = {seed}'
        depths.append(run(f"polygons-{cells}-seed-{seed}", egg)["furrow_depth_um"])
    depth = statistics.mean(depths)
    print(f"| {squares} | {', '.join(f'{d:.2f}' for d in depths)} | {quads['furrow_depth_um']:.2f} |"
          f" {depth / quads['furrow_depth_um'] - 1:+.1%} |", flush=True)
