"""Compare fifty embryos with the slices that their sets were drawn from; write ten of the sets for the experiments.

A set was drawn by the likelihood of its slice; here it is weighted by the likelihood of its embryo divided by that of its slice,
so the ten are a sample of the posterior of embryos.

Usage: freeze.py STUDIED CONFIRMED OUT.csv, where STUDIED and CONFIRMED are the outputs of `plica study` for posterior.toml and
confirm.toml.
"""
import sys

import numpy as np
import pandas as pd

import plica
from targets import OF_EMBRYO, TARGETS, score

slices, embryos = plica.Study(sys.argv[1]).table, plica.Study(sys.argv[2]).table
keys = plica.Study(sys.argv[1]).keys
of_slices, of_embryos = score(slices, TARGETS), score(embryos, OF_EMBRYO).to_numpy()
drawn_from = [int(((slices[keys] / row - 1) ** 2).sum(axis=1).argmin()) for _, row in embryos[keys].iterrows()]

drawn = slices.iloc[drawn_from].reset_index(drop=True)
shown = [*TARGETS, "closed_length_ratio"]
table = pd.DataFrame({
    "slices": drawn.reindex(columns=shown).mean(), "±": drawn.reindex(columns=shown).std(),
    "embryos": embryos[shown].median(), "from": embryos[shown].min(), "to": embryos[shown].max(),
})
print(table.round(3).to_string())
deeper, later = embryos.furrow_depth_um - drawn.furrow_depth_um, embryos.lips_closed_time_s - drawn.lips_closed_time_s
print(f"An embryo is deeper than its slice by {deeper.mean():.1f} ± {deeper.std():.1f} µm, and closes {later.mean():.0f} ± {later.std():.0f} s later.")
print(f"Close: {embryos.lips_closed_time_s.notna().sum()} of {len(embryos)}; pass through themselves: {(embryos.self_intersections > 0).sum()}; "
      f"take {embryos.wall_s.min():.0f} to {embryos.wall_s.max():.0f} s.")
deep = np.nan_to_num(np.exp(-score(slices, OF_EMBRYO) / 2))
print(f"Slices weighted for {OF_EMBRYO['furrow_depth_um'][0]} µm come to {np.average(slices.furrow_depth_um, weights=deep):.1f} µm.\n")

weights = np.exp(-(of_embryos - of_slices.to_numpy()[drawn_from]) / 2)
weights /= weights.sum()
print(f"{len(embryos)} embryos, worth {1 / (weights**2).sum():.0f}; scores {of_embryos.min():.1f} to {of_embryos.max():.1f}")

chosen = np.random.default_rng(34).choice(len(embryos), 10, replace=False, p=weights)
chosen = sorted(chosen, key=lambda row: of_embryos[row])
print("chosen, the nearest first:", ", ".join(f"{embryos.point[row]} ({of_embryos[row]:.1f})" for row in chosen))
embryos[keys].iloc[chosen].to_csv(sys.argv[3], index=False, float_format="%.4g")
