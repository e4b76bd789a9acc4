"""Write fits.csv and held-out.csv of what fit.py and held_out.py wrote.

Usage: tables.py FITS HELD-OUT, two folders with one folder per hypothesis. A hypothesis without results is left out.
"""
import csv
import json
import sys
from pathlib import Path

import fit


def write(name, rows, columns):
    with (fit.HERE / name).open("w", newline="") as file:
        table = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print(f"{name}: {len(rows)} rows")


def fits_table(found):
    """Rows of fits.csv, one per hypothesis (keys, outcomes, how the fit ended), and its columns."""
    lights = list(dict.fromkeys(target.get("light_min") for target in fit.PLAN["target"]))
    rows, keys, outcomes = [], [], []
    for one in found:
        values = {key: f"{value:.4g}" for key, value in one["values"].items()}
        reached = {(f"light-{lights[scenario]:g}." if lights[scenario] else "") + f"{outcome}@{at:g}": f"{value:.4g}"
                   for scenario, outcome, at, _, _, value in one["targets"]}
        keys, outcomes = (list(dict.fromkeys([*known, *new])) for known, new in ((keys, values), (outcomes, reached)))
        rows.append({"hypothesis": one["hypothesis"], **values, **reached, "misfit": f"{one['misfit']:.1f}",
                     "log_evidence": f"{one['log_evidence']:.1f}", "runs": one["runs"], "end": one["end"]})
    return rows, ["hypothesis", *keys, *outcomes, "misfit", "log_evidence", "runs", "end"]


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
    fits, held_out = Path(sys.argv[1]), Path(sys.argv[2])
    names = fit.PLAN["hypothesis"]
    write("fits.csv", *fits_table([json.loads(path.read_text()) for name in names if (path := fits / name / "evidence.json").exists()]))
    write("held-out.csv", *held_out_table({name: held_out / name for name in names if (held_out / name / "runs/experiments.csv").exists()}))
