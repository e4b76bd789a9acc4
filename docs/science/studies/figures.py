#!/usr/bin/env python3
"""Draws the figures of docs/developers/four-studies.md and prints its numbers, from studies that have been run.

Usage, with a Python that has plica[study]: figures.py STUDIED IMAGES, where STUDIED holds the results of paper-noise, paper-sobol,
paper-phase and slice-phase (plica study docs/science/studies/NAME.toml --out STUDIED/NAME). The posterior runs 80 embryos by itself.
"""
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import plica  # noqa: E402

studied, images = Path(sys.argv[1]), Path(sys.argv[2])
images.mkdir(parents=True, exist_ok=True)


def save(figure, name):
    figure.savefig(images / f"{name}.png", dpi=90)
    print(f"  drawn: {images / name}.png")


print("Sobol's indices")
sobol = plica.Study(studied / "paper-sobol")
for measure in sobol.measures:
    indices = sobol.sobol_indices(measure, drop_missing=measure == "equilibrium_time_s")  # some do not reach equilibrium in an hour
    print(measure)
    print(indices.table.round(2).to_string())
    save(indices.plot(), f"sobol-{measure}")

def inside_its_lips(row):
    """The verdict by how far the floor lies inside the lips alone: a flattened belly is deep, too, from where it was."""
    word = plica.verdict(row)
    return "flattened" if word == "furrowed" and row.furrow_depth_below_lips_um < 1 else word


print("Phase diagrams")
save(plica.Study(studied / "paper-phase").phase_diagram(measure=inside_its_lips), "paper-phase")
save(plica.Study(studied / "slice-phase").phase_diagram(), "slice-phase")

print("Noise")
table = plica.Study(studied / "paper-noise").table
print(table.groupby("contraction.apical.variation.spread")[["furrow_depth_um", "vml_apical_area_ratio", "min_apical_area_ratio"]]
      .agg(["mean", "std", "min", "max"]).round(3).T.to_string())

print("Posterior")
found = plica.posterior(
    "drosophila",
    {"contraction.apical.stiffness_nN_per_um": (2, 9), "contraction.apical.across_ratio": (0.1, 1.0)},
    {"furrow_depth_um": (28.89, 1.44), "vml_apical_area_ratio": (0.70, 0.02), "peak_speed_ratio": (3.65, 0.55)},
    runs=80,
)
print(found.mean.round(3).to_string())
print(found.covariance.round(5).to_string())
print(found.targets.round(3).to_string(), f"\neffective samples: {found.effective_size:.0f}")
save(found.plot(), "posterior")
