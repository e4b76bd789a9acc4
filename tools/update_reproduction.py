#!/usr/bin/python3
"""Puts the output of `plica reproduce` into docs/science/reproduction.md and its figures into docs/images/reproduction/.

Usage: update_reproduction.py DIR, the --out directory of a whole (not --quick) run. What stands in the page above the
marker is written by hand and stays.
"""
import re
import shutil
import sys
from pathlib import Path

MARKER = "<!-- Below: the output of plica reproduce, put here by tools/update_reproduction.py. -->\n"

if len(sys.argv) != 2:
    sys.exit(__doc__)
results = Path(sys.argv[1])
docs = Path(__file__).resolve().parent.parent / "docs"
page, images = docs / "science" / "reproduction.md", docs / "images" / "reproduction"

output = (results / "reproduction.md").read_text(encoding="utf-8")
output = output.split("\n", 1)[1]  # the page has a title of its own
output = output.replace("](figures/", "](../images/reproduction/")
by_hand = page.read_text(encoding="utf-8").split(MARKER)[0]

shutil.rmtree(images, ignore_errors=True)
images.mkdir(parents=True)
names = re.findall(r"\]\(\.\./images/reproduction/([^)]+)\)", output)
for name in names:
    shutil.copy(results / "figures" / name, images / name)
page.write_text(by_hand + MARKER + output, encoding="utf-8")
print(f"{page}: {len(output.splitlines())} lines, {len(names)} figures")
