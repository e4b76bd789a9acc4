#!/usr/bin/python3
"""Runs every command and snippet of a page as it stands, in order; page.py says how, and what a page may mark.

Usage: page_test.py PAGE PROGRAM [--slow] [--keep DIRECTORY]. With --slow, blocks that are marked slow are run, too. With
--keep, what the page makes stays in DIRECTORY, which must be new. Needs Debian's python3-pandas and python3-matplotlib.

A page of docs/scenarios has a table of numbers beside keys of summary.json: these are compared within 1 % with the run in
results/NAME.
"""
import argparse
import json
import re
import sys
import tempfile
from pathlib import Path

from page import PageError, run_page

# | what | 28.9 µm | `furrow_depth_um` |
ROW = re.compile(r"^\|[^|]+\| (?P<value>-?[\d.]+)(?: (?P<unit>\S+))? \| `(?P<key>\w+)` \|$", re.M)


def check_numbers(page, place):
    """Compares the table of a scenario's page with its run. Returns how many numbers."""
    summary = json.loads((place / "results" / page.stem / "summary.json").read_text(encoding="utf-8"))
    rows = list(ROW.finditer(page.read_text(encoding="utf-8")))
    if not rows:
        raise PageError("has no table of numbers")
    for row in rows:
        value = float(row["value"]) * (60 if row["unit"] == "min" else 1)
        found = summary.get(row["key"])
        if found is None or abs(value - found) > max(0.01 * abs(found), 1e-6):
            raise PageError(f"says {row['key']} = {row['value']} {row['unit'] or ''}; the run comes to {found}")
    return len(rows)


parser = argparse.ArgumentParser()
parser.add_argument("page", type=Path)
parser.add_argument("program", type=Path)
parser.add_argument("--slow", action="store_true")
parser.add_argument("--keep", type=Path)
options = parser.parse_args()
with tempfile.TemporaryDirectory() as temporary:
    place = (options.keep or Path(temporary) / "reader").resolve()
    try:
        number = run_page(options.page, options.program, place, options.slow)
        print(f"Ran {number} blocks of {options.page.name}.")
        # A run that is marked slow is not there without --slow.
        if (place / "results" / options.page.stem / "summary.json").is_file() and options.page.parent.name == "scenarios":
            print(f"Compared {check_numbers(options.page, place)} numbers.")
    except PageError as error:
        sys.exit(f"{options.page}: {error}")
