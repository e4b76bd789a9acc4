#!/usr/bin/python3
"""Runs every command and snippet of docs/tutorial.md as it stands, in their order.

Usage: tutorial_test.py TUTORIAL PROGRAM [--keep DIRECTORY]. Needs Debian's python3-pandas and python3-matplotlib. With
--keep, results and pictures stay in DIRECTORY.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

page = Path(sys.argv[1]).read_text(encoding="utf-8")
program = Path(sys.argv[2]).resolve()
snippets = re.findall(r"^```(sh|python)\n(.*?)^```", page, re.S | re.M)
if [kind for kind, text in snippets].count("sh") < 4:
    sys.exit("the tutorial has lost its commands")
with tempfile.TemporaryDirectory() as temporary:
    place = Path(sys.argv[4] if len(sys.argv) > 4 else temporary)
    (place / "build/release").mkdir(parents=True)
    (place / "build/release/plica").symlink_to(program)
    environment = dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=temporary, OMP_NUM_THREADS="1")
    # One shell for all, as a reader has: what it sets stays set.
    script = "set -e\nset -o pipefail\n"
    for number, (kind, text) in enumerate(snippets):
        if kind == "python":
            (place / f"snippet{number}.py").write_text(text, encoding="utf-8")
            text = f"/usr/bin/python3 snippet{number}.py\n"
        script += text
    # `| head` ends what writes to it.
    script = script.replace("| head -20", "| sed -n 1,20p")
    result = subprocess.run(["bash", "-c", script], cwd=place, env=environment, text=True, capture_output=True)
    print(result.stdout)
    if result.returncode != 0:
        sys.exit(f"a command of the tutorial failed:\n{result.stderr[-3000:]}")
    for name in ("deep.png", "region.png", "depth.png", "three.html"):
        if not (place / name).exists():
            sys.exit(f"the tutorial left no {name}")
    depths = [float(depth) for depth in re.findall(r"nN/um: ([\d.]+) um deep", result.stdout)]
    if len(depths) != 3 or not depths[0] < depths[1] < depths[2]:
        sys.exit(f"the three depths of the tutorial: {depths}")
print(f"Ran {len(snippets)} snippets.")
