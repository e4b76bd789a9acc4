#!/usr/bin/python3
"""The reference scene: positions after 1 and 10 steps, residuals, the meshes it is run on. Not timed.

Usage: reference_test.py PROGRAM ROOT
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

program, root = Path(sys.argv[1]), Path(sys.argv[2])
data, generator = root / "bench/data", root / "bench/reference/pill_mesh.py"


def run(*arguments):
    done = subprocess.run([program, *map(str, arguments), "--rounds", "1"], capture_output=True, text=True, check=True)
    result = json.loads(done.stdout)
    print(result)
    for key in ("ms_per_step", "yardstick_us", "yardsticks_per_step", "residual", "peak_MiB"):
        assert math.isfinite(result[key]) and result[key] > 0, key
    assert result["residual"] <= result["tolerance"]
    return result


def numbers(text):
    lines = [line.split() for line in text.splitlines() if not line.startswith("#")]
    return [[word if word.isalpha() else float(word) for word in line] for line in lines]


def generate(folder, refinement, layers):
    file = Path(folder) / f"pill{refinement}{layers}.txt"
    with open(file, "w", encoding="utf-8") as out:
        subprocess.run([sys.executable, generator, str(refinement), str(layers)], stdout=out, check=True)
    return file


# Positions agree with the other program's. One level: the factor.
pill = data / "pill756.txt"
result = run(pill, "--steps", 10, "--tolerance", 1e-10, "--positions", f"{data}/pill756_step1.txt:1",
             "--positions", f"{data}/pill756_step10.txt:10")
assert result["max_position_error"] < 1e-7, result
wrong = run(pill, "--steps", 2, "--tolerance", 1e-10, "--positions", f"{data}/pill756_step1.txt:2")
assert wrong["max_position_error"] > 1e-2, "the comparison sees nothing"
assert "max_position_error" not in run(data / "sphere450.txt", "--steps", 3)

with tempfile.TemporaryDirectory() as folder:
    # The generator makes the reference's own mesh.
    assert numbers(generate(folder, 1, 1).read_text()) == numbers(pill.read_text())
    # Multigrid: two levels.
    mesh = generate(folder, 2, 2)
    refined = run(mesh, "--steps", 3, "--tolerance", 1e-10)
    assert refined["iterations_per_step"] < 30, refined

    broken = Path(folder) / "broken.txt"
    broken.write_text("nodes 1\n0 0 0\nhexes 1\n0 1 2 3 4 5 6 7\n")
    failed = subprocess.run([program, broken], capture_output=True, text=True)
    assert failed.returncode == 4 and f"{broken}:4: no node 1" in failed.stderr, failed
print("Reference scene: 4 runs")
