#!/usr/bin/python3
"""Runs every command and snippet of a page as it stands, in order; page.py says how, and what a page may mark.

Usage: page_test.py PAGE PROGRAM [--slow] [--keep DIRECTORY]. With --slow, blocks that are marked slow are run, too. With
--keep, what the page makes stays in DIRECTORY, which must be new. Needs Debian's python3-pandas and python3-matplotlib.

On a page of docs/scenarios each section about a scenario has a table of numbers beside keys of summary.json: these are
compared within 1 % with the run in results/NAME, which must be there unless its block is marked. "0.74 to 0.78" stands for
what differs between processors.
"""
import argparse
import json
import sys
import tempfile
from pathlib import Path

from page import PageError, mark_of_run, run_page, scenario_sections, stated_numbers


def check_numbers(name, section, place):
    """Compares the table of a scenario's section with its run. Returns how many numbers."""
    path = place / "results" / name / "summary.json"
    if not path.is_file():
        raise PageError(f"has no results of {name}")
    summary = json.loads(path.read_text(encoding="utf-8"))
    stated = stated_numbers(section)
    if not stated:
        raise PageError(f"has no table of numbers of {name}")
    for key, (least, most) in stated.items():
        found = summary.get(key)
        allowed = max(0.01 * abs(found or 0), 1e-6)
        if found is None or not least - allowed <= found <= most + allowed:
            raise PageError(f"says {key} = {least:g}{f' to {most:g}' if most > least else ''} of {name}; the run has {found}")
    return len(stated)


def check_scenarios(page, place, with_slow):
    """Compares the tables of all scenarios that were run on a page of docs/scenarios."""
    for name, section in scenario_sections(page.read_text(encoding="utf-8")).items():
        mark = mark_of_run(name, section)
        if mark == "" or (mark == "slow" and with_slow):
            print(f"Compared {check_numbers(name, section, place)} numbers of {name}.")


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
        if options.page.resolve().parent.name == "scenarios":
            check_scenarios(options.page, place, options.slow)
    except PageError as error:
        sys.exit(f"{options.page}: {error}")
