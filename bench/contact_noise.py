#!/usr/bin/python3
"""drosophila-living with every cell's apical cortex stronger or weaker by a third, on to 27 minutes, one and two elements
high: crossings in every frame, by a test of triangles that is not plica's (tests/crossings.py). Some ten minutes a run.

Usage: contact_noise.py PROGRAM OUT [--seeds 1 2] [--minutes 27] [--spread 0.3]. Prints a table in Markdown; runs stay in
OUT. Needs Debian's python3-vtk9.
"""
import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from crossings import crossings_of_run  # noqa: E402

parser = argparse.ArgumentParser()
parser.add_argument("program", type=Path)
parser.add_argument("out", type=Path)
parser.add_argument("--scenario", default="drosophila-living")
parser.add_argument("--seeds", type=int, nargs="+", default=[1])
parser.add_argument("--minutes", type=float, default=27)
parser.add_argument("--spread", type=float, default=0.3)
options = parser.parse_args()

worst = 0
print("| seed | elements high | status | lips touch (min) | depth (µm) | steps | frames | frames with crossings | most |"
      " by plica, any step |\n|" + "---|" * 10)
for seed in options.seeds:
    for high in (1, 2):
        out = options.out / f"seed-{seed}-high-{high}"
        sets = {"cortex.apical.variation.spread": options.spread, "cortex.apical.variation.seed": seed,
                "embryo.elements_per_cell": f"[1, 1, {high}]", "time.end_min": options.minutes}
        command = [options.program.resolve(), "run", options.scenario, "--out", out, "--quiet", "--overwrite"]
        for key, value in sets.items():
            command += ["--set", f"{key}={value}"]
        done = subprocess.run(command, capture_output=True, text=True,
                              env={"OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive", **os.environ})
        if done.returncode not in (0, 1):  # 1: what the scenario expects is of a tissue without noise
            print(done.stderr, file=sys.stderr)
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        found = [count for _, count in crossings_of_run(out)]
        worst = max(worst, *found)
        touch = summary["lips_closed_time_s"]
        print(f"| {seed} | {high} | {summary['status']} | {'–' if touch is None else f'{touch / 60:.1f}'} |"
              f" {summary['furrow_depth_um']:.1f} | {summary['steps']} | {len(found)} |"
              f" {sum(count > 0 for count in found)} | {max(found)} | {summary['self_intersections']} |", flush=True)
sys.exit(worst > 0)
