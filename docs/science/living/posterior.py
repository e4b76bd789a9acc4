"""Print the posterior of the second round of slices; write fifty draws from it.

Usage: posterior.py STUDIED OUT.csv, where STUDIED is the output of `plica study docs/science/living/posterior.toml --out STUDIED`.
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

# Products of powers of keys, the best known first. They are found with each key's logarithm in units of its prior's spread;
# of each, the keys that count are kept, and the spread of that product is measured again.
logs, prior = np.log(values), np.log(table[study.keys])
_, directions = np.linalg.eigh(np.cov(((logs - prior.mean()) / prior.std()).T, aweights=weights))
print()
for direction in directions.T[:3]:
    counts = np.abs(direction) > 0.3 * np.abs(direction).max()
    powers = np.where(counts, direction / prior.std(), 0)
    powers /= powers[np.abs(direction).argmax()]
    known = np.cov(logs @ powers, aweights=weights) ** 0.5 / (prior @ powers).std()
    order = [k for k in np.argsort(-np.abs(direction)) if counts[k]]
    print(f"{known:.2f} of the prior's:", ", ".join(f"{study.keys[k]} ^ {powers[k]:.2f}" for k in order))

draws = found.samples.sample(50, weights="weight", random_state=33)
draws[study.keys].to_csv(sys.argv[2], index=False, float_format="%.4g")
