#!/usr/bin/python3
"""Runs every command and snippet of a page as it stands, in order; page.py says how, and what a page may mark.

Usage: page_test.py PAGE PROGRAM [--slow] [--keep DIRECTORY]. With --slow, blocks that are marked slow are run, too. With
--keep, what the page makes stays in DIRECTORY, which must be new. Needs Debian's python3-pandas and python3-matplotlib.

A page of docs/scenarios has a table of numbers beside keys of summary.json: these are compared within 1 % with the run in
results/NAME. "0.74 to 0.78" stands for what differs between processors.
"""
import argparse
import json
import sys
import tempfile
from pathlib import Path

from page import PageError, run_page, stated_numbers


def check_numbers(page, place):
    """Compares the table of a scenario's page with its run. Returns how many numbers."""
    summary = json.loads((place / "results" / page.stem / "summary.json").read_text(encoding="utf-8"))
    stated = stated_numbers(page.read_text(encoding="utf-8"))
    if not stated:
        raise PageError("has no table of numbers")
    for key, (least, most) in stated.items():
        found = summary.get(key)
        allowed = max(0.01 * abs(found or 0), 1e-6)
        if found is None or not least - allowed <= found <= most + allowed:
            raise PageError(f"says {key} = {least:g}{f' to {most:g}' if most > least else ''}; the run comes to {found}")
    return len(stated)


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
