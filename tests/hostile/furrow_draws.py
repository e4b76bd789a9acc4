#!/usr/bin/python3
"""Run a closing furrow with all parameters drawn at random within 25 %; count closures, and check that no run fails.

By default, 100 draws of furrow-slice from one seed.

Usage: furrow_draws.py PROGRAM [--scenario NAME] [--count N] [--seed S] [--spread 0.25] [--keep DIRECTORY]
                       [--only NUMBER ...]
"""
import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# Tables whose numbers, and times of programs after the first, are drawn.
TABLES = ("elasticity", "vitelline", "dynamics", "cortex", "enclosed")
NOT_DRAWN = {"poisson_ratio", "middle", "edge", "compression_ratio", "seed", "attractor_preload_length_um"}


def numbers(table, path=()):
    for key, value in table.items():
        if key in ("pulse", "direction", "noise"):  # off, whatever their keys
            continue
        if isinstance(value, dict):
            yield from numbers(value, (*path, key))
        elif isinstance(value, bool) or key in NOT_DRAWN:
            continue
        elif isinstance(value, (int, float)) and value > 0:
            yield ".".join((*path, key)), value
        elif key in ("time_s", "time_min") and isinstance(value, list):
            yield ".".join((*path, key)), value


def draw(base, generator, spread):
    sets = []
    for key, value in base:
        factor = generator.uniform(1 - spread, 1 + spread)
        drawn = [time * factor for time in value] if isinstance(value, list) else value * factor
        sets += ["--set", f"{key}={json.dumps(drawn)}"]
    return sets


def run(program, scenario, sets, out):
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    command = [program, "run", scenario, "--threads", "1", "--quiet", "--out", out, *sets]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=3600)
    summary = out / "summary.json"
    return done, json.loads(summary.read_text(encoding="utf-8")) if summary.is_file() else None


parser = argparse.ArgumentParser()
parser.add_argument("program", type=Path)
parser.add_argument("--scenario", default="furrow-slice")
parser.add_argument("--count", type=int, default=100)
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--spread", type=float, default=0.25)
parser.add_argument("--keep", type=Path)
parser.add_argument("--only", type=int, nargs="+", help="numbers of draws to run")
options = parser.parse_args()
program = options.program.resolve()
resolved = tomllib.loads(subprocess.run([program, "check", options.scenario], capture_output=True, text=True, check=True).stdout)
base = [entry for table in TABLES for entry in numbers(resolved.get(table, {}), (table,))]
generator = random.Random(options.seed)
draws = [draw(base, generator, options.spread) for _ in range(options.count)]
chosen = options.only or range(options.count)

with tempfile.TemporaryDirectory() as temporary:
    place = options.keep or Path(temporary)
    place.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        ended = list(pool.map(lambda n: run(program, options.scenario, draws[n], place / f"draw_{n}"), chosen))

closed, crossed, failed, worst_refused = 0, [], [], 0
for number, (done, summary) in zip(chosen, ended):
    if done.returncode != 0 or summary is None:
        failed.append(f"draw {number} (status {done.returncode}): {done.stderr.strip().splitlines()[-1]}")
        continue
    closed += summary["lips_closed_time_s"] is not None
    worst_refused = max(worst_refused, summary["refused_steps"] / summary["steps"])
    if summary["self_intersections"] > 0:
        crossed.append(number)
print(f"{len(chosen)} draws of {len(base)} parameters of {options.scenario}, each within {options.spread:.0%}: "
      f"{closed} close, {len(failed)} fail, {len(crossed)} self-intersect {crossed}; at most {worst_refused:.0%} "
      "of the steps of a run were rejected")
print("\n".join(failed))
sys.exit(1 if failed else 0)
