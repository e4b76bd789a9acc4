"""Print how well the slices of a hypothesis fit, and how many continue when light inhibits apical tension.

Usage: light.py STUDIED [--best 30] [--points POINTS.csv]. STUDIED is the output of `plica study docs/science/living/fit-floor.toml
--out STUDIED`, or of another of those files. Inhibited are its best slices, or the points of a file.
"""
import argparse
import tempfile
from pathlib import Path

import pandas as pd

import plica
from targets import TARGETS, score

MINUTES = (5, 6, 6.5, 7, 8)
CONTINUES_UM = 20  # deeper than this at 22 min

parser = argparse.ArgumentParser()
parser.add_argument("studied")
parser.add_argument("--best", type=int, default=30)
parser.add_argument("--points")
options = parser.parse_args()

study = plica.Study(options.studied)
table = study.table.assign(score=score(study.table, TARGETS)).sort_values("score")
scores = table.score.to_numpy()
print(f"{table.lips_closed_time_s.notna().sum()} of {len(table)} close; scores: best {scores[0]:.1f}, tenth {scores[9]:.1f}, "
      f"{options.best}th {scores[options.best - 1]:.1f}; medians of the best ten:")
print(table[list(TARGETS)].head(10).median().round(2).to_string(), "\n")

points = pd.read_csv(options.points) if options.points else table[study.keys].head(options.best)
scenario = Path(options.studied, "scenario.toml").resolve()
with tempfile.TemporaryDirectory() as folder:
    points.to_csv(f"{folder}/points.csv", index=False)
    for minute in MINUTES:
        lit = plica.Study({
            "format": 1,
            "scenario": str(scenario),
            "set": {"ablation.light.region": "mesoderm", "ablation.light.only": ["cortex.apical"],
                    "ablation.light.at_min": minute, "time.end_min": 22},
            "design": {"kind": "file", "file": f"{folder}/points.csv"},
            "keep": {"measures": ["furrow_depth_um"]},
        }).run(jobs=2)
        print(f"inhibited from {minute} min on: {(lit.furrow_depth_um > CONTINUES_UM).sum()} of {len(lit)} continue")
