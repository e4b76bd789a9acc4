"""Run the variations of closing.toml and print their table.

Usage: closing.py length|axis BEDS OUT [NAME...], BEDS being the folder that beds.py wrote. Each run is kept in OUT/NAME; the same command
continues after an interruption. Writes OUT/length.csv or OUT/axis.csv with all runs that have ended.
"""
import csv
import sys
import tomllib
from pathlib import Path

import numpy as np

import plica

HERE = Path(__file__).resolve().parent
PLAN = tomllib.loads((HERE / "closing.toml").read_text())
END_MIN = {"length": 20, "axis": 9}
COLUMNS = {
    "length": {f"{name}@{minute}": (column, minute) for name, column in (("closed", "closed_length_ratio"), ("depth", "furrow_depth_um")) for minute in (16, 18, 20)},
    "axis": {"depth@9": ("furrow_depth_um", 9)},
}


def scenario_of(variation, beds):
    """The scenario of a variation."""
    scenario = plica.Scenario(HERE / "egg.toml")
    changes = dict(PLAN["bed"][variation["bed"]])
    if "embryo.file" in changes:
        changes["embryo.file"] = str(beds / changes["embryo.file"])
    if "genes" in variation:
        changes["embryo.cell_arrays"] = str(beds / variation["genes"])
    scenario.update(changes | variation.get("set", {}))
    return scenario


def row(name, kind, run):
    """One line of the table: the last row of each quantity up to its minute."""
    series = run.series
    found = {"variation": name}
    for title, (column, minute) in COLUMNS[kind].items():
        times = series.time_s[series[column].notna()]
        reached = times.max() >= 60 * minute - 1
        found[title] = round(float(np.interp(60 * minute, series.time_s, series[column])), 3) if reached else ""
    elongation = series["elongation.apical_elongation"]
    found["elongation@9"] = round(float(np.interp(540, series.time_s, elongation) / elongation.iloc[0]), 2)
    found["area@9"] = round(float(np.interp(540, series.time_s, series["inner.area_ratio"])), 3)
    if kind == "length":
        found["closed_min"] = round(run.summary["lips_closed_time_s"] / 60, 1) if run.summary.get("lips_closed_time_s") else ""
    else:
        found |= lengths(run)
    return found


def lengths(run):
    """Mean length of apices of the inner rows along the axis, relative to reference: in the middle, and from 125 µm on, where they end."""
    reference, now = run.frames[0], run.frames.at(9)
    apices = reference.hexahedra[:, 4:]
    places = reference.points[apices]
    order = np.argsort(places[:, :, 0], axis=1)[..., None]
    ratio = np.ones(len(apices))
    for points, power in ((now.points, 1), (reference.points, -1)):
        corners = np.take_along_axis(points[apices], order, axis=1)
        ratio *= np.linalg.norm(corners[:, 2:].mean(axis=1) - corners[:, :2].mean(axis=1), axis=1) ** power
    x, y, z = places.mean(axis=1).T
    x, rows = np.abs(x), (z < 0) & (np.abs(y) < 40)
    return {f"length@9, {low} to {high} µm": round(float(ratio[rows & (x >= low) & (x < high)].mean()), 3) for low, high in ((0, 75), (125, 200))}


if __name__ == "__main__":
    kind, beds, out, *names = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]), *sys.argv[4:]
    for name in names or PLAN[kind]:
        if (out / kind / name / "summary.json").exists():
            continue
        simulation = plica.Simulation(scenario_of(PLAN[kind][name], beds), threads=1)
        simulation.run(until_min=END_MIN[kind], out=out / kind / name, resume=True)
    rows = [row(name, kind, plica.open(out / kind / name)) for name in PLAN[kind] if (out / kind / name / "summary.json").exists()]
    with (out / f"{kind}.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print((out / f"{kind}.csv").read_text())
