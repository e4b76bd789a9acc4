"""Depth over time under light from 8 min, on both sides of the jump at which fits of the second round ended: writes jump.csv.

Usage: jump.py. `before` is the first set of cables-push in the second round (starts.csv), `after` the set of its next run (values below, from
that run's record). Half a minute. Needs egg.obj (mesh.py).
"""
import csv

import numpy as np

import fit
import plica

MINUTES = np.arange(8, 14.25, 0.5)
AFTER = [1.1479, 3.8751, 0.24776, 0.36588, 0.34855, 1.4564, 0.4518, 8.0413, 44.683, 2.0448, 0.015008]


def depths(values):
    scenario, _ = fit.scenario_of("cables-push")
    scenario.update(values)
    lit = fit.experiments(scenario)[-1][0]  # light from 8 min
    simulation, series = plica.Simulation(lit, threads=1), [(0.0, 0.0)]
    while series[-1][0] < MINUTES[-1]:
        step = simulation.step()
        series.append((step.time_s / 60, step["furrow_depth_um"]))
    return np.interp(MINUTES, *zip(*series))


if __name__ == "__main__":
    keys = list(fit.scenario_of("cables-push")[1])
    with (fit.HERE / "starts.csv").open() as file:
        start = next(row for row in csv.DictReader(file) if row["hypothesis"] == "cables-push")
    sets = {"before": {key: float(start[key]) for key in keys}, "after": dict(zip(keys, AFTER))}
    columns = {name: depths(values) for name, values in sets.items()}
    with (fit.HERE / "jump.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["minute", *columns])
        table.writerows([f"{minute:g}", *(f"{columns[name][k]:.2f}" for name in columns)] for k, minute in enumerate(MINUTES))
    print((fit.HERE / "jump.csv").read_text())
