#!/usr/bin/python3
"""plica without VTK, HDF5 and the report's page runs with the same results, and names what it lacks.

Usage: minimal_test.py MINIMAL PLICA, both built from one source (cmake/minimal.cmake).
"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

minimal, whole = (Path(one).resolve() for one in sys.argv[1:])
files = Path(__file__).resolve().parent
refused = 0


def run(program, *arguments):
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)


def rows(folder, name):
    with open(folder / name, newline="", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    return [{key: value for key, value in row.items() if not key.startswith("wall_")} for row in table]


def refuses(status, message, *arguments):
    global refused
    refused += 1
    done = run(minimal, *arguments)
    assert done.returncode == status and message in done.stderr, (arguments, done.returncode, done.stderr)


libraries = run("ldd", minimal).stdout
assert "libopenblas" in libraries or "libblas" in libraries, libraries
assert "vtk" not in libraries and "hdf5" not in libraries, libraries

with tempfile.TemporaryDirectory() as folder:
    ours, theirs = Path(folder) / "minimal", Path(folder) / "whole"
    for program, out in ((minimal, ours), (whole, theirs)):
        done = run(program, "run", "drosophila", "--out", out, "--set", "time.end_min=1")
        assert done.returncode == 0, done.stderr
    for name in ("series.csv", "cells.csv", "midline.csv"):
        assert rows(ours, name) == rows(theirs, name) and rows(ours, name), name
    frames = sorted(path.name for path in (theirs / "frames").iterdir())
    assert frames and all((ours / "frames" / name).read_bytes() == (theirs / "frames" / name).read_bytes() for name in frames)
    lacking = {path.name for path in theirs.iterdir()} - {path.name for path in ours.iterdir()}
    assert {name for name in lacking if not name.startswith("checkpoint")} == {"report.html"} and "checkpoint.h5" in lacking, lacking

    refuses(2, "HDF5", "run", "drosophila", "--out", ours, "--resume")
    refuses(4, "VTK", "render", ours, "--out", Path(folder) / "fold.png")
    refuses(4, "VTK", "compare", ours, theirs)
    refuses(4, "VTK", "report", ours, "--out", Path(folder) / "report.html")
    mesh = Path(folder) / "mesh.vtu"
    assert run(whole, "mesh", "drosophila", "--out", mesh).returncode == 0
    scenario = Path(folder) / "own.toml"
    scenario.write_text('format = 1\n[embryo]\nshape = "file"\nfile = "mesh.vtu"\n', encoding="utf-8")
    refuses(4, "VTK", "run", scenario, "--out", Path(folder) / "own")

print(f"The same results in {len(frames)} frames and 3 tables; {refused} things refused.")
