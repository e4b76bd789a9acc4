#!/usr/bin/env python3
"""What a step from Python costs over one in C++: both loops to the end of a scenario, in turns, on one thread.

usage: python_step.py [--build DIR] [--scenario NAME] [--repeats N], with a Python that finds plica, as build/venv's
with PYTHONPATH=build/release/python. Prints JSON: the medians of both in seconds of
processor time, and the median, least and most of their ratio.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

LOOP = """
import json, sys, time, plica
sim = plica.Simulation(sys.argv[1], threads=1)
begin, total = time.process_time(), 0.0
while not sim.finished:
    step = sim.step()
    if step is not None:
        total += step["furrow_depth_um"] or 0
print(json.dumps({"steps": sim.steps, "loop_s": time.process_time() - begin, "sum": total}))
"""


def main():
    root = Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=root / "build/release")
    parser.add_argument("--scenario", default="drosophila")
    parser.add_argument("--repeats", type=int, default=11)
    chosen = parser.parse_args()

    def loop(*command):
        done = subprocess.run([*command, chosen.scenario], capture_output=True, text=True, check=True,
                              env=os.environ | {"OMP_NUM_THREADS": "1"})
        return json.loads(done.stdout)

    pairs = []
    for repeat in range(chosen.repeats):
        commands = {"cpp": [chosen.build / "bench/loop"], "python": [sys.executable, "-c", LOOP]}
        order = sorted(commands, reverse=repeat % 2 == 1)  # a drift of the machine's speed falls on both
        done = {name: loop(*commands[name]) for name in order}
        first, second = done["cpp"], done["python"]
        if abs(first["sum"] - second["sum"]) > 1e-6 * abs(first["sum"]) or first["steps"] != second["steps"]:
            sys.exit(f"the two are not the same run: {first} {second}")
        pairs.append((first["loop_s"], second["loop_s"]))
    ratios = [python / cpp for cpp, python in pairs]
    print(json.dumps({
        "scenario": chosen.scenario, "steps": first["steps"], "pairs": len(pairs),
        "cpp_s": statistics.median(cpp for cpp, _ in pairs), "python_s": statistics.median(python for _, python in pairs),
        "ratio": statistics.median(ratios), "least": min(ratios), "most": max(ratios)}, indent=2))


if __name__ == "__main__":
    main()
