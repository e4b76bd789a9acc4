"""Print the numbers of the measured embryo for docs/science/living-embryo.md: cells by rows, length of the furrow, apical tension.

Usage: measured.py RUN, the folder of a run: of `plica reproduce scenarios/living/measured.toml --out MEASURED`,
MEASURED/runs/atlas/draw-1, or of docs/science/living/gradient.toml.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import plica
from plica.results import Frame

SCENARIO = "drosophila-atlas-living"
PROFILES = {
    "twist from 0.65 to 0.95": {"from": 0.65, "to": 0.95},
    "twist from 0.72 to 0.97": {},
    "twist from 0.80 to 0.97": {"from": 0.80, "to": 0.97},
    "the Gaussian, in cells": {"shape": "gaussian", "sigma_cells": 3.436},
    "a Gaussian of 15°": {"shape": "gaussian", "axis": "angle", "sigma_deg": 15},
}
ANGLES = (0, 10, 20, 25, 30)  # from the ventral midline, degrees
MIDDLE_UM, ROWS = 125, 12
MINUTES = (14, 16, 18, 20, 24)

run = plica.open(sys.argv[1])

scenario = plica.Scenario(SCENARIO)
scenario.update({f"region.rows-{n}.{key}": value for n in range(1, ROWS + 1)
                 for key, value in (("rows", 2 * n), ("x_um", [-MIDDLE_UM, MIDDLE_UM]))})
regions = plica.Simulation(scenario).regions
cells = run.cells[run.cells.time_s == 540].set_index("cell_id")
print(f"At 9 min, means of the cells up to {MIDDLE_UM} µm from the middle, by row from the midline:")
for n in range(1, ROWS + 1):
    row = regions[f"rows-{n}"] & ~regions[f"rows-{n - 1}"] if n > 1 else regions["rows-1"]
    of_row = cells.loc[np.flatnonzero(row)]
    print(f"{n:3}: relative apical area {of_row.apical_area_ratio.mean():.2f}, height {of_row.height_um.mean():.1f} µm")

print("\nOver time (series.csv):")
shown = {"furrow_depth_um": "depth, µm", "closed_length_ratio": "closed, of the length", "lips_closed": "closed in the middle",
         "flank_section_area_ratio": "flank's section", "flank.displacement_um": "flank moves, µm", "midline_waviness_um": "uneven, µm"}
series = run.series[run.series.time_s.isin([60 * minute for minute in MINUTES])]
print(series.assign(min=series.time_s / 60).set_index("min")[[*shown]].rename(columns=shown).round(3).to_string())
steps = run.series.time_s.diff()[(run.series.time_s > 840) & (run.series.time_s <= 1200)]
print(f"Steps from 14 to 20 min: {steps.median():.1f} s (median)")

print("\nDepth of the midline, µm, means of stretches of 40 µm by their middle (midline.csv):")
midline = run.midline[run.midline.time_s.isin([60 * minute for minute in MINUTES])].dropna()
stretch = (midline.ap_um // 40 * 40 + 20).astype(int)
depths = midline.groupby([midline.time_s / 60, stretch]).depth_um.mean().unstack()
print(depths.rename_axis(index="min", columns="x").round(0).to_string())
for minute, deep in midline[midline.depth_um > 20].groupby(midline.time_s / 60):
    print(f"At {minute:.0f} min deeper than 20 µm on {np.ptp(deep.ap_um):.0f} µm:",
          ", ".join(f"{x:.0f}:{depth:.0f}" for x, depth in zip(deep.ap_um, deep.depth_um)))

print("\nUp to 50 µm from the middle, by degrees from the ventral midline:")
with tempfile.TemporaryDirectory() as folder:
    frames = {}
    for number, (name, profile) in enumerate(PROFILES.items()):
        mesh = Path(folder, f"{number}.vtu")
        sets = [word for key, value in profile.items() for word in ("--set", f"cortex.apical.profile.{key}={value}")]
        subprocess.run(["plica", "mesh", SCENARIO, "--out", mesh, *sets], check=True, capture_output=True)
        frames[name] = Frame(mesh, 0)
shown = {f"pull, {name}": frame.cell_data["strength_cortex.apical"] for name, frame in frames.items()}
frame = next(iter(frames.values()))  # all have the same cells
shown["twist itself"] = frame.cell_data["twi"]
x, y, z = frame.points[frame.hexahedra].mean(axis=1).T
angle = np.degrees(np.arctan2(np.abs(y), -z))
for name, values in shown.items():
    print(f"{name}:", ", ".join(f"{at}° {values[(np.abs(x) < 50) & (np.abs(angle - at) < 2.5)].mean():.2f}" for at in ANGLES))
