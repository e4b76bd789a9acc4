"""Is the furrow straight whose cells differ? The best slices of each hypothesis as short embryos with 20 % of noise.

Usage: straight.py STUDIED PICTURE.png [--best 10], where STUDIED holds clock, floor and own, as `plica study
docs/living/fit-clock.toml --out STUDIED/clock` has left it. Runs 30 embryos, prints how uneven their floors are, and draws them.
"""
import argparse
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

import plica  # noqa: E402
from targets import TARGETS, score  # noqa: E402

# What makes a slice a short embryo, not mirrored, whose cells pull by 20 % more or less than the next: as in short.toml.
HERE = Path(__file__).resolve().parent
changed = plica.Scenario(HERE / "short.toml").diff(plica.Scenario(HERE / "../../scenarios/living/embryo.toml"))
SHORT = {"embryo.shape": "pill", "furrow.vce_cell": 2}
SHORT.update({key: short for key, (short, _) in changed.items() if short is not None and key != "title"})

parser = argparse.ArgumentParser()
parser.add_argument("studied", type=Path)
parser.add_argument("picture")
parser.add_argument("--best", type=int, default=10)
options = parser.parse_args()

figure, panels = plt.subplots(3, 1, figsize=(8, 6.5), sharex=True, sharey=True, layout="constrained")
for panel, hypothesis in zip(panels, ("clock", "floor", "own")):
    study = plica.Study(options.studied / hypothesis)
    best = study.table.assign(score=score(study.table, TARGETS)).sort_values("score").head(options.best)
    with tempfile.TemporaryDirectory() as folder:
        best[study.keys].to_csv(f"{folder}/points.csv", index=False)
        short = plica.Study({
            "format": 1,
            "scenario": str((options.studied / hypothesis / "scenario.toml").resolve()),
            "set": SHORT,
            "design": {"kind": "file", "file": f"{folder}/points.csv"},
            "keep": {"measures": ["midline_waviness_um", "self_intersections"], "each": "full"},
        })
        table = short.run(out=f"{folder}/short", jobs=2)
        for run in sorted(Path(folder, "short", "points").iterdir()):
            midline = plica.open(run).midline
            end = midline[midline.time_s == midline.time_s.max()].dropna()
            panel.plot(end.ap_um, end.depth_um, ".-", linewidth=1, markersize=3)
    print(hypothesis)
    print(table.assign(point=best.point.to_numpy())[["point", "status", "midline_waviness_um", "self_intersections"]].round(2).to_string())
    panel.set_title(f"{hypothesis}: floor of the furrow at {SHORT['time.end_s'] / 60:.0f} min", loc="left")
    panel.set_ylabel("depth, µm")
panels[-1].set_xlim(-115, 115)
panels[-1].set_xlabel("along the axis, µm (anterior to the left)")
figure.savefig(options.picture, dpi=90)
