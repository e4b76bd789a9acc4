"""Fit the hypotheses of hypotheses.toml, and run the held-out tests of experiments.toml with each.

Usage: compare.py RESULTS [--runs 8] [--early] [--tables], with a folder per hypothesis in RESULTS/fits and RESULTS/held-out. The same command
continues after an interruption. --tables runs nothing. Writes fits.csv and held-out.csv; with --early, the third round, early-fits.csv and
early-held-out.csv. paper.py makes tables and figures of them.
"""
import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

import fit


def write(name, rows, columns):
    with (fit.HERE / name).open("w", newline="") as file:
        table = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print(f"{name}: {len(rows)} rows")


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


def held_out_table(folders):
    """Rows of held-out.csv, one per outcome, and its columns; `folders` by hypothesis."""
    rows = {}
    for name, folder in folders.items():
        for row in csv.DictReader((folder / "runs/experiments.csv").open()):
            number = f"{float(row['number']):.3g}" if row["number"] else ""
            key = (row["experiment"], row["outcome"])
            rows.setdefault(key, dict(zip(("experiment", "outcome"), key))).update({name: number, f"{name}_judgement": row["judgement"]})
    return list(rows.values()), ["experiment", "outcome", *(column for name in folders for column in (name, f"{name}_judgement"))]


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("results", type=Path)
    parser.add_argument("--runs", default="8")
    parser.add_argument("--early", action="store_true")
    parser.add_argument("--tables", action="store_true")
    options = parser.parse_args()
    fits, held_out = options.results / "fits", options.results / "held-out"
    names, prefix = list(fit.PLAN["hypothesis"]), "early-" if options.early else ""
    for name in [] if options.tables else names:
        subprocess.run([sys.executable, fit.HERE / "fit.py", name, fits / name, "--runs", options.runs, *["--early"][: options.early]], check=True)
        subprocess.run([sys.executable, fit.HERE / "held_out.py", fits / name, held_out / name], check=True)
    lights = list(dict.fromkeys(target.get("light_min") for target in fit.PLAN["target"]))
    found = [json.loads(path.read_text()) for name in names if (path := fits / name / "evidence.json").exists()]
    rows, columns = fits_table(found, lights)
    write(f"{prefix}fits.csv", rows, columns)
    tested = {name: held_out / name for name in names if (held_out / name / "runs/experiments.csv").exists()}
    rows, columns = held_out_table(tested)
    write(f"{prefix}held-out.csv", rows, columns)
