"""Fit the hypotheses of hypotheses.toml, run the held-out tests of experiments.toml with each, and compare them.

Usage: compare.py RESULTS [--runs 8] [--tables], with a folder per hypothesis in RESULTS/fits and RESULTS/held-out. The same command continues
after an interruption. --tables runs nothing. Writes fits.csv and held-out.csv, and prints the tables of docs/developers/four-hypotheses.md.
"""
import argparse
import csv
import json
import subprocess
import sys
import tomllib
from pathlib import Path

import fit

TESTS = tomllib.loads((fit.HERE / "experiments.toml").read_text())["experiment"]
JUDGED = {"hit": "agrees", "miss": "disagrees", "undecided": "inconclusive"}


def write(name, rows, columns):
    with (fit.HERE / name).open("w", newline="") as file:
        table = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print(f"{name}: {len(rows)} rows\n")


def show(rows, columns):
    """Print rows as a table in Markdown: their first columns, then one per hypothesis."""
    for row in [columns, ["---"] * len(columns), *([row.get(column, "") for column in columns] for row in rows)]:
        print("| " + " | ".join(row) + " |")
    print()


def outcome_of(target, lights):
    scenario, outcome, at = target[:3]
    return (f"light-{lights[scenario]:g}." if lights[scenario] else "") + f"{outcome}@{at:g}"


def fits_table(found, lights):
    """Rows of fits.csv, one per hypothesis (keys, outcomes, evidence, how the fit ended), and its columns."""
    rows, keys, outcomes = [], [], []
    formats = {"misfit": ".1f", "prior": ".1f", "log_det": ".1f", "log_evidence": ".1f", "keys": "d", "keys_used": ".1f", "promised": ".1f",
               "converged": "", "runs": "d", "end": ""}
    for one in found:
        values = {key: f"{value:.4g}" for key, value in one["values"].items()}
        reached = {outcome_of(target, lights): f"{target[5]:.4g}" for target in one["targets"]}
        keys, outcomes = (list(dict.fromkeys([*known, *new])) for known, new in ((keys, values), (outcomes, reached)))
        rows.append({"hypothesis": one["hypothesis"], **values, **reached, **{name: format(one[name], form) for name, form in formats.items()}})
    return rows, ["hypothesis", *keys, *outcomes, *formats]


def show_fits(rows, found, lights):
    targets = {outcome_of(target, lights): f"{target[3]:g} ± {target[4]:g}" for target in found[0]["targets"]}
    by_row = [{"": name, "target": targets.get(name, ""), **{row["hypothesis"]: row.get(name, "") for row in rows}}
              for name in rows[0] | {key: "" for row in rows for key in row} if name != "hypothesis"]
    show(by_row, ["", "target", *(row["hypothesis"] for row in rows)])


def held_out_table(folders):
    """Rows of held-out.csv, one per outcome, and its columns; `folders` by hypothesis."""
    rows = {}
    for name, folder in folders.items():
        for row in csv.DictReader((folder / "runs/experiments.csv").open()):
            number = f"{float(row['number']):.3g}" if row["number"] else ""
            key = (row["experiment"], row["outcome"])
            rows.setdefault(key, dict(zip(("experiment", "outcome"), key))).update({name: number, f"{name}_judgement": row["judgement"]})
    return list(rows.values()), ["experiment", "outcome", *(column for name in folders for column in (name, f"{name}_judgement"))]


def show_held_out(rows, names):
    shown, right = [], dict.fromkeys(names, 0)
    for row in rows:
        outcome = TESTS[row["experiment"]]["outcome"][row["outcome"]]
        ends = [f"{end:g}" for end in outcome["hit"]]
        role = outcome.get("role", TESTS[row["experiment"]].get("role", "held out"))
        shown.append({"outcome": f"{row['experiment']}: {row['outcome']}", "role": role, "agrees if": " to ".join(ends),
                      **{name: f"{row[name]}: {JUDGED[row[name + '_judgement']]}" for name in names}})
        for name in names:
            right[name] += role == "held out" and row[name + "_judgement"] == "hit"
    count = sum(row["role"] == "held out" for row in shown)
    shown.append({"outcome": f"**agree, of {count} held out**", **{name: f"**{number}**" for name, number in right.items()}})
    show(shown, ["outcome", "role", "agrees if", *names])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("results", type=Path)
    parser.add_argument("--runs", default="8")
    parser.add_argument("--tables", action="store_true")
    options = parser.parse_args()
    fits, held_out = options.results / "fits", options.results / "held-out"
    names = list(fit.PLAN["hypothesis"])
    for name in [] if options.tables else names:
        subprocess.run([sys.executable, fit.HERE / "fit.py", name, fits / name, "--runs", options.runs], check=True)
        subprocess.run([sys.executable, fit.HERE / "held_out.py", fits / name, held_out / name], check=True)
    lights = list(dict.fromkeys(target.get("light_min") for target in fit.PLAN["target"]))
    found = [json.loads(path.read_text()) for name in names if (path := fits / name / "evidence.json").exists()]
    rows, columns = fits_table(found, lights)
    write("fits.csv", rows, columns)
    show_fits(rows, found, lights)
    tested = {name: held_out / name for name in names if (held_out / name / "runs/experiments.csv").exists()}
    rows, columns = held_out_table(tested)
    write("held-out.csv", rows, columns)
    show_held_out(rows, tested)
