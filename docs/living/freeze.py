"""Ten sets of parameters for the experiments: of fifty that were drawn by their slices, by what their embryos do.

A set was drawn by the likelihood of its slice; here it is weighted by the likelihood of its embryo over that, so that the ten
are a sample of what embryos allow.

Usage: freeze.py STUDIED CONFIRMED OUT.csv, where STUDIED and CONFIRMED are what `plica study` has left of posterior.toml and
confirm.toml.
"""
import sys

import numpy as np

import plica
from targets import OF_EMBRYO, TARGETS, score

slices, embryos = plica.Study(sys.argv[1]).table, plica.Study(sys.argv[2]).table
keys = plica.Study(sys.argv[1]).keys
of_slices, of_embryos = score(slices, TARGETS), score(embryos, OF_EMBRYO).to_numpy()
drawn_from = [int(((slices[keys] / row - 1) ** 2).sum(axis=1).argmin()) for _, row in embryos[keys].iterrows()]
weights = np.exp(-(of_embryos - of_slices.to_numpy()[drawn_from]) / 2)
weights /= weights.sum()
print(f"{len(embryos)} embryos, worth {1 / (weights**2).sum():.0f}; scores {of_embryos.min():.1f} to {of_embryos.max():.1f}")

chosen = np.random.default_rng(34).choice(len(embryos), 10, replace=False, p=weights)
chosen = sorted(chosen, key=lambda row: of_embryos[row])
print("chosen, the nearest first:", ", ".join(f"{embryos.point[row]} ({of_embryos[row]:.1f})" for row in chosen))
embryos[keys].iloc[chosen].to_csv(sys.argv[3], index=False, float_format="%.4g")
