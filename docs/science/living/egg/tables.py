"""Write fits.csv and held-out.csv of what fit.py and held_out.py wrote.

Usage: tables.py FITS HELD-OUT, two folders with one folder per hypothesis. A hypothesis without results is left out.
"""
import csv
import json
import sys
from pathlib import Path

import fit


def write(name, rows):
    """Write rows, dictionaries whose keys may differ, beside this script."""
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with (fit.HERE / name).open("w", newline="") as file:
        table = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print(f"{name}: {len(rows)} rows")


def of_fit(found):
    """One row of fits.csv: keys, outcomes and how the fit ended."""
    lights = list(dict.fromkeys(target.get("light_min") for target in fit.PLAN["target"]))
    outcomes = {f"{f'light-{lights[scenario]:g}.' if lights[scenario] else ''}{outcome}@{at:g}": f"{value:.4g}"
                for scenario, outcome, at, _, _, value in found["targets"]}
    values = {key: f"{value:.4g}" for key, value in found["values"].items()}
    return {"hypothesis": found["hypothesis"], **outcomes, "misfit": f"{found['misfit']:.1f}",
            "log_evidence": f"{found['log_evidence']:.1f}", "runs": found["runs"], "end": found["end"], **values}


fits, held_out = Path(sys.argv[1]), Path(sys.argv[2])
known = [name for name in fit.PLAN["hypothesis"] if (fits / name / "evidence.json").exists()]
write("fits.csv", [of_fit(json.loads((fits / name / "evidence.json").read_text())) for name in known])
rows = {}
for name in known:
    table = held_out / name / "runs/experiments.csv"
    for row in csv.DictReader(table.open()) if table.exists() else []:
        key = (row["experiment"], row["outcome"])
        number = f"{float(row['number']):.3g}" if row["number"] else ""
        rows.setdefault(key, dict(zip(("experiment", "outcome"), key))).update({name: number, f"{name}_judgement": row["judgement"]})
if rows:
    write("held-out.csv", list(rows.values()))
