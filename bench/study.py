#!/usr/bin/python3
"""What a study costs: points of `drosophila` to equilibrium, rows only, beside what their solver alone takes; more workers
than cores; and the memory that gathers many rows. Needs a quiet machine.

Usage: study.py PROGRAM [--points 100] [--thousand] [--rows 10000]. With --thousand, also 1000 embryos on all cores. Prints
lines of Markdown.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

STUDY = """\
format = 1
scenario = "drosophila"
[vary]
"contraction.apical.stiffness_nN_per_um" = { low = 4.6, high = 5.0 }
[design]
kind = "sobol"
points = %d
[keep]
measures = ["furrow_depth_um", "vml_apical_area_ratio"]
each = "%s"
"""


def study(place, name, points, jobs, each="row"):
    """Its wall time and its processes' time, s."""
    (place / f"{name}.toml").write_text(STUDY % (points, each), encoding="utf-8")
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([program, "study", place / f"{name}.toml", "--out", place / name, "--jobs", str(jobs), "--quiet"], check=True,
                   env={**os.environ, "OMP_NUM_THREADS": "1"})
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def solver_s(place):
    """Of all runs of a study that kept summaries."""
    return sum(json.loads(file.read_text())["wall_solver_s"] for file in place.glob("points/*/summary.json"))


def memory_of_gathering(place, rows):
    """MB at most, of `plica study gather` over so many rows."""
    directory = place / "many"
    (place / "many.toml").write_text((STUDY % (rows, "row")).replace('scenario = "drosophila"', 'scenario = "division-demo"')
                                     .replace("contraction.apical.stiffness_nN_per_um", "elasticity.young_modulus_Pa")
                                     .replace('measures = ["furrow_depth_um", "vml_apical_area_ratio"]\n', ""), encoding="utf-8")
    process = subprocess.Popen([program, "study", place / "many.toml", "--out", directory, "--jobs", "1", "--quiet"])
    while not list(directory.glob("rows/*")):
        time.sleep(0.1)
    process.terminate()
    process.wait()
    one = next(directory.glob("rows/*")).read_text().splitlines()[0].split(",", 2)[2]
    with open(directory / "rows/made.csv", "w", encoding="utf-8") as file:
        file.writelines(f"{run},{run + 1},{one}\n" for run in range(rows))
    wrapped = [sys.executable, "-c",
               "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True);"
               "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"]
    start = time.monotonic()
    peak = subprocess.run([*wrapped, program, "study", "gather", directory], capture_output=True, text=True, check=True).stdout
    return int(peak.split()[-1]) / 1024, time.monotonic() - start


parser = argparse.ArgumentParser()
parser.add_argument("program", type=Path)
parser.add_argument("--points", type=int, default=100)
parser.add_argument("--thousand", action="store_true")
parser.add_argument("--rows", type=int, default=10000)
options = parser.parse_args()
program = str(options.program.resolve())
with tempfile.TemporaryDirectory() as temporary:
    place = Path(temporary)
    ratios = []
    for turn in range(3):  # in turns, since machines are noisy
        summaries, _ = study(place, f"summaries{turn}", options.points, 1, "summary")
        bare = solver_s(place / f"summaries{turn}")
        wall, one_worker = study(place, f"rows{turn}", options.points, 1)
        ratios.append(wall / bare)
    print(f"| cost of a point over its solver, median of 3 | {100 * statistics.median(ratios) - 100:.1f} % |"
          f" {1000 * wall / options.points:.0f} ms a point, {1000 * bare / options.points:.0f} ms of solver |")
    _, one_worker = study(place, "one", options.points, 1)
    _, four_workers = study(place, "four", options.points, 4)
    print(f"| 4 workers for 1, processor time | {100 * four_workers / one_worker - 100:+.1f} % | on {os.cpu_count()} cores |")
    peak, seconds = memory_of_gathering(place, options.rows)
    print(f"| gathering {options.rows} rows | {peak:.0f} MB | {seconds:.1f} s |")
    if options.thousand:
        wall, used = study(place, "thousand", 1000, os.cpu_count())
        print(f"| 1000 embryos to equilibrium | {wall / 60:.2f} min | {used:.0f} s of processor time, {os.cpu_count()} cores |")
