"""Measure how straight furrows are whose cells differ: the best slices of each hypothesis as short embryos with 20 % of variation.

Usage: straight.py STUDIED SHORT PICTURE.png [--best 10], where STUDIED holds clock, floor and own, as `plica study
docs/science/living/fit-clock.toml --out STUDIED/clock` leaves it. Writes the embryos to SHORT (half an hour; finished runs are
kept), prints the waviness of their midlines, and draws the best of each hypothesis, cut along its midline.
"""
import argparse
from pathlib import Path

import matplotlib.pyplot as plt

import plica
from drawing import SAGITTAL, draw_section, few_colours, scale_bar
from targets import TARGETS, score

# What makes a slice a short embryo, not mirrored, whose apical tension varies by 20 % between cells: as in short.toml.
HERE = Path(__file__).resolve().parent
changed = plica.Scenario(HERE / "short.toml").diff(plica.Scenario(HERE / "../../../scenarios/living/embryo.toml"))
SHORT = {"embryo.shape": "pill", "furrow.vce_cell": 2}
SHORT.update({key: short for key, (short, _) in changed.items() if short is not None and key != "title"})
TITLES = {"clock": "clock: all at set times", "floor": "floor: basal cortex per cell", "own": "own: lateral faces too"}

parser = argparse.ArgumentParser()
parser.add_argument("studied", type=Path)
parser.add_argument("short", type=Path)
parser.add_argument("picture")
parser.add_argument("--best", type=int, default=10)
options = parser.parse_args()

figure, panels = plt.subplots(1, 3, figsize=(760 / 72, 230 / 72))
figure.subplots_adjust(left=0.005, right=0.995, top=0.9, bottom=0.12, wspace=0.02)
for panel, (hypothesis, title) in zip(panels, TITLES.items()):
    study = plica.Study(options.studied / hypothesis)
    best = study.table.assign(score=score(study.table, TARGETS)).sort_values("score").head(options.best)
    out = options.short / hypothesis
    out.parent.mkdir(parents=True, exist_ok=True)
    points = options.short / f"{hypothesis}.csv"
    best[study.keys].to_csv(points, index=False)
    short = plica.Study({
        "format": 1,
        "scenario": str((options.studied / hypothesis / "scenario.toml").resolve()),
        "set": SHORT,
        "design": {"kind": "file", "file": str(points.resolve())},
        "keep": {"measures": ["midline_waviness_um", "self_intersections"], "each": "full"},
    })
    table = short.run(out=out, jobs=2, resume=out.exists())
    print(hypothesis)
    print(table.assign(point=best.point.to_numpy())[["point", "status", "midline_waviness_um", "self_intersections"]].round(2).to_string())
    draw_section(panel, sorted((out / "points").iterdir())[0], SHORT["time.end_s"] / 60, SAGITTAL, 3)  # through the midline's cells
    panel.set_title(title, fontsize=15, pad=2)
    panel.set_xlim(-165, 165)
    panel.set_ylim(-92, 92)
scale_bar(panels[0], -100, 20)
figure.savefig(options.picture, dpi=144)
few_colours(options.picture)
