#!/usr/bin/env python3
"""Measure how the work of built-in scenarios is spread over simulated time, for the time left and `plica check`.

Usage: tools/work_curves.py PLICA [NAME...]; without names, all built-in scenarios (half an hour). Replaces their rows in
scenarios/work.csv: name, total work in the units of src/record/time_left.cpp, and the times by which each further
twentieth of the processor time of a run on one thread has passed, s. Needs Linux.
"""
import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TABLE = Path(__file__).resolve().parents[1] / "scenarios/work.csv"
PARTS = 20


def processor_s(process):
    """Processor time of the main thread, which takes the steps; None after its end."""
    try:
        return int(Path(f"/proc/{process.pid}/task/{process.pid}/schedstat").read_text().split()[0]) / 1e9
    except (FileNotFoundError, ProcessLookupError, IndexError):
        return None


def measured_run(plica, name, out):
    """Run a scenario; return the rows of series.csv, and the processor time at which each was written."""
    process = subprocess.Popen([plica, "run", name, "--out", out, "--quiet"], env={**os.environ, "OMP_NUM_THREADS": "1"})
    times_s, read, file = [], 0, Path(out) / "series.csv"
    while (now_s := processor_s(process)) is not None and process.poll() is None:
        if file.exists() and file.stat().st_size > read:
            added = file.read_bytes()[read:]
            read += len(added)
            times_s += [now_s] * added.count(b"\n")
        time.sleep(0.001)
    if process.returncode not in (0, None) or process.wait() != 0:
        sys.exit(f"{name}: failed")
    rows = list(csv.DictReader(file.open()))
    times_s += [times_s[-1]] * (len(rows) + 1 - len(times_s))  # rows written just before the end
    return rows, times_s[1:]  # without the header


def curve(rows, spent_s):
    """Total work, and simulated times by which equal parts of the processor time have passed."""
    work = sum(1 + float(row["newton_iterations"]) + float(row["linear_iterations"]) / 10 for row in rows[1:])
    times, i = [], 0
    for part in range(1, PARTS + 1):
        wanted = spent_s[0] + (spent_s[-1] - spent_s[0]) * part / PARTS
        while spent_s[i + 1] < wanted:
            i += 1
        low, high = (float(row["time_s"]) for row in rows[i:i + 2])
        times.append(low + (high - low) * (wanted - spent_s[i]) / (spent_s[i + 1] - spent_s[i]))
    return [f"{work:.0f}", *(f"{t:.4g}" for t in times)]


def main():
    plica, *names = sys.argv[1:]
    table = dict(line.split(",", 1) for line in TABLE.read_text().splitlines()) if TABLE.exists() else {}
    for name in names or subprocess.run([plica, "scenarios"], capture_output=True, text=True, check=True).stdout.split("\n"):
        if not name.strip():
            continue
        name = name.split()[0]
        with tempfile.TemporaryDirectory() as folder:
            table[name] = ",".join(curve(*measured_run(plica, name, f"{folder}/out")))
        TABLE.write_text("".join(f"{row},{table[row]}\n" for row in sorted(table)))


if __name__ == "__main__":
    main()
