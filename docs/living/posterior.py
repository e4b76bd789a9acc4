"""The posterior of the second round of slices, and fifty draws from it.

Usage: posterior.py STUDIED OUT.csv, where STUDIED is what `plica study docs/living/posterior.toml --out STUDIED` has left.
"""
import sys

import numpy as np

import plica
from targets import TARGETS

study = plica.Study(sys.argv[1])
table = study.table
found = plica.posterior(study, targets=TARGETS, on="runs")
print(f"{len(table)} slices; the lips of {table.lips_closed_time_s.notna().sum()} meet; worth {found.effective_size:.0f} samples\n")
print(found.targets.round(3).to_string(), "\n")

values, weights = found.samples[study.keys], found.samples.weight
mean = np.average(values, axis=0, weights=weights)
covariance = np.cov(values.T, aweights=weights)
spread = np.sqrt(np.diag(covariance))
for k, key in enumerate(study.keys):
    low, high = table[key].min(), table[key].max()
    print(f"{key:42} {mean[k]:7.3f} ± {spread[k]:6.3f}, {spread[k] / (high - low) * 12**0.5:.2f} of the prior's")

# In logarithms, in units of the prior's spread: products of powers of keys, the best known first.
logs, prior = np.log(values), np.log(table[study.keys])
fixed, powers = np.linalg.eigh(np.cov(((logs - prior.mean()) / prior.std()).T, aweights=weights))
print()
for spread, power in list(zip(fixed**0.5, powers.T))[:3]:
    most = sorted(zip(power / np.abs(power).max(), study.keys), key=lambda one: -abs(one[0]))[:5]
    print(f"{spread:.2f} of the prior's:", ", ".join(f"{key} ^ {one:.1f}" for one, key in most))

draws = found.samples.sample(50, weights="weight", random_state=33)
draws[study.keys].to_csv(sys.argv[2], index=False, float_format="%.4g")
