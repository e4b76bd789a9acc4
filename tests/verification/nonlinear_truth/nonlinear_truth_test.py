#!/usr/bin/env python3
"""Rest states of plica at large strains against finite elements made by another program (nonlinear_truth.md).

    nonlinear_truth_test.py PLICA            runs the scenarios and prints a table; exit status 1 where one misses
    nonlinear_truth_test.py PLICA --refine   measures plica's own discretisation errors, into nonlinear_truth.json;
                                             of some cases only: --refine CASE...

A point misses when its displacement differs by more than 1 % of the case's largest displacement, or, where that is
larger, by more than the stated discretisation errors: the truth's and plica's, each from three meshes of its own.
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import vtk

here = pathlib.Path(__file__).resolve().parent
truth_path = here / "nonlinear_truth.json"
refinements = {"bending": (3, 4, 6), "stretching": (3, 4, 6), "folding": (4, 6, 8), "pill": (2, 3, 4),
               "neo_bending": (3, 4, 6), "neo_stretching": (3, 4, 6)}


def points_of(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    points = reader.GetOutput().GetPoints()
    return [points.GetPoint(i) for i in range(points.GetNumberOfPoints())]


def displacements(plica, name, places, elements=None):
    """Displacements at rest of the nodes that begin at these places."""
    with tempfile.TemporaryDirectory() as directory:
        out = pathlib.Path(directory) / name
        command = [plica, "run", str(here / f"{name}.toml"), "--out", str(out), "--quiet"]
        if elements:
            command += ["--set", f"embryo.elements_per_cell=[{elements}, {elements}, {elements}]"]
        subprocess.run(command, check=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
        status = json.loads((out / "summary.json").read_text())["status"]
        if status != "equilibrium":
            raise SystemExit(f"{name} did not come to rest: {status}")
        frames = sorted((out / "frames").glob("frame_*.vtu"))
        first, last = points_of(frames[0]), points_of(frames[-1])
    found = []
    for place in places:
        node = min(range(len(first)), key=lambda i: math.dist(first[i], place))
        if math.dist(first[node], place) > 1e-3:  # the mesh at rest is not the one that the truth is made for
            raise SystemExit(f"{name} has no node at {place} um")
        found.append([b - a for a, b in zip(first[node], last[node])])
    return found


def text(vector):
    return " ".join(f"{x:9.3f}" for x in vector)


def compare(plica, truth):
    missed = 0
    print(f"{'case':11}{'point':24}{'truth, um':>30}{'plica, um':>30}{'difference':>12}{'allowed':>9}")
    for name, case in truth["cases"].items():
        scale, points = case["largest_displacement_um"], case["points"]
        for point, u in zip(points, displacements(plica, name, [p["rest_um"] for p in points])):
            difference = math.dist(u, point["displacement_um"])
            allowed = max(0.01 * scale, point["error_um"] + point.get("plica_error_um", 0))
            bad = not difference <= allowed
            missed += bad
            note = "  MISSED" if bad else "  above 1 %, discretisation" if difference > 0.01 * scale else ""
            print(f"{name:11}{point['name']:24}{text(point['displacement_um']):>30}{text(u):>30}"
                  f"{100 * difference / scale:10.2f} %{100 * allowed / scale:7.2f} %{note}", flush=True)
    print(f"{missed} missed" if missed else "all within what is allowed")
    return missed


def order_of(coarse, middle, fine, sizes):
    """The power of the size of elements with which a point's error falls, from three meshes: low where films end."""
    apart = [math.dist(coarse, middle), math.dist(middle, fine)]
    a, b, c = (1 / n for n in sizes)
    return min((q / 100 for q in range(50, 301)),
               key=lambda q: abs((a**q - b**q) / (b**q - c**q) - apart[0] / apart[1]))


def refine(plica, truth, names):
    """Extrapolates plica from three meshes of n x n x n elements a cell: its limit, and the scenario's error."""
    print(f"{'case':11}{'point':24}" + "".join(f"{f'mesh {i}':>9}" for i in (1, 2, 3))
          + f"{'limit':>9}{'order':>7}   truth's error")
    for name, case in truth["cases"].items():
        if names and name not in names:
            continue
        scale, points, sizes = case["largest_displacement_um"], case["points"], refinements[name]
        places = [p["rest_um"] for p in points]
        meshes = [displacements(plica, name, places, n) for n in sizes]
        as_shipped = displacements(plica, name, places)
        for i, point in enumerate(points):
            order = order_of(*(mesh[i] for mesh in meshes), sizes)
            grow = 1 / ((sizes[2] / sizes[1]) ** order - 1)
            limit = [f + (f - m) * grow for m, f in zip(meshes[1][i], meshes[2][i])]
            point["plica_order_of_convergence"] = order
            point["plica_error_um"] = round(math.dist(as_shipped[i], limit), 5)
            off = [100 * math.dist(u, point["displacement_um"]) / scale for u in (*(mesh[i] for mesh in meshes), limit)]
            print(f"{name:11}{point['name']:24}" + "".join(f"{x:7.2f} %" for x in off)
                  + f"{order:7.2f}{100 * point['error_um'] / scale:10.2f} %")
        print(f"{name:11}meshes of {', '.join(map(str, sizes))} elements a cell and direction", flush=True)
    version = subprocess.run([plica, "--version"], check=True, capture_output=True, text=True).stdout.split("\n")[0]
    truth["plica_errors_from"] = version
    truth_path.write_text(json.dumps(truth, indent=1) + "\n")


def main():
    if len(sys.argv) < 2 or sys.argv[2:3] not in ([], ["--refine"]):
        raise SystemExit(__doc__)
    truth = json.loads(truth_path.read_text())
    plica = str(pathlib.Path(sys.argv[1]).resolve())
    if sys.argv[2:]:
        return refine(plica, truth, sys.argv[3:])
    return 1 if compare(plica, truth) else 0


if __name__ == "__main__":
    sys.exit(main())
