"""Numbers of the measured embryo, as docs/living-embryo.md tells them: its cells by rows, its furrow's length, and how apices pull.

Usage: measured.py RUN, the folder of a run: of `plica reproduce scenarios/living/measured.toml --out MEASURED`,
MEASURED/runs/atlas/draw-1, or of docs/living/gradient.toml.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import plica
from plica.results import Frame

PROGRAM, SCENARIO = "build/release/plica", "drosophila-atlas-living"
PROFILES = {
    "twist from 0.65 to 0.95": {"from": 0.65, "to": 0.95},
    "twist from 0.72 to 0.97": {},
    "twist from 0.80 to 0.97": {"from": 0.80, "to": 0.97},
    "the Gaussian, in cells": {"shape": "gaussian", "sigma_cells": 3.436},
    "a Gaussian of 15°": {"shape": "gaussian", "axis": "angle", "sigma_deg": 15},
}
ANGLES = (0, 10, 20, 25, 30)  # from the ventral midline, degrees
MIDDLE_UM, ROWS = 125, 12

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
    print(f"{n:3}: apical area {of_row.apical_area_ratio.mean():.2f} of that at rest, height {of_row.height_um.mean():.1f} µm")

midline = run.midline
deep = midline[(midline.time_s == 1200) & (midline.depth_um > 20)]
print(f"\nAt 20 min deeper than 20 µm from x = {deep.ap_um.min():.0f} to {deep.ap_um.max():.0f} µm,",
      f"{np.ptp(deep.ap_um):.0f} µm long; depth there:")
print(deep[["ap_um", "depth_um"]].round(0).astype(int).to_string(index=False))

print("\nPull of apices up to 50 µm from the middle, by degrees from the ventral midline:")
with tempfile.TemporaryDirectory() as folder:
    for number, (name, profile) in enumerate(PROFILES.items()):
        mesh = Path(folder, f"{number}.vtu")
        sets = [word for key, value in profile.items() for word in ("--set", f"cortex.apical.profile.{key}={value}")]
        subprocess.run([PROGRAM, "mesh", SCENARIO, "--out", mesh, *sets], check=True, capture_output=True)
        frame = Frame(mesh, 0)
        x, y, z = frame.points[frame.hexahedra].mean(axis=1).T
        angle = np.degrees(np.arctan2(np.abs(y), -z))

        def across(values):
            return ", ".join(f"{at}° {values[(np.abs(x) < 50) & (np.abs(angle - at) < 2.5)].mean():.2f}" for at in ANGLES)

        print(f"{name}:", across(frame.cell_data["strength_cortex.apical"]))
print("twist itself:", across(frame.cell_data["twi"]))
print("and along the midline:", ", ".join(
    f"{at} µm {frame.cell_data['twi'][(np.abs(x - at) < 12.5) & (angle < 10)].mean():.2f}" for at in range(-200, 201, 25)))
