"""Is the furrow straight whose cells differ? The best slices of each hypothesis as short embryos with 20 % of noise.

Usage: straight.py STUDIED SHORT PICTURE.png [--best 10], where STUDIED holds clock, floor and own, as `plica study
docs/science/living/fit-clock.toml --out STUDIED/clock` has left it. Leaves the embryos in SHORT, half an hour; what is there already
is not run again. Prints how uneven their floors are, and draws them, the best of each in a section along its midline.
"""
import argparse
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from PIL import Image  # noqa: E402

import plica  # noqa: E402
from drawing import few_colours, render  # noqa: E402
from targets import TARGETS, score  # noqa: E402

# What makes a slice a short embryo, not mirrored, whose cells pull by 20 % more or less than the next: as in short.toml.
HERE = Path(__file__).resolve().parent
changed = plica.Scenario(HERE / "short.toml").diff(plica.Scenario(HERE / "../../../scenarios/living/embryo.toml"))
SHORT = {"embryo.shape": "pill", "furrow.vce_cell": 2}
SHORT.update({key: short for key, (short, _) in changed.items() if short is not None and key != "title"})

parser = argparse.ArgumentParser()
parser.add_argument("studied", type=Path)
parser.add_argument("short", type=Path)
parser.add_argument("picture")
parser.add_argument("--best", type=int, default=10)
options = parser.parse_args()


def section_of(run):
    """Its embryo at the end, cut along the midline, without legends."""
    with tempfile.TemporaryDirectory() as folder:
        section = render(run, f"{folder}/section.png", "--view", "sagittal-section", "--range", "0:60", "--size", "800x520")
        return Image.open(section).convert("RGB").crop((50, 50, 650, 440))


figure, panels = plt.subplots(3, 2, figsize=(10, 7.5), sharex="col", width_ratios=[1, 1.4], layout="constrained")
for (drawn, plotted), hypothesis in zip(panels, ("clock", "floor", "own")):
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
    runs = sorted((out / "points").iterdir())
    for run in runs:
        midline = plica.open(run).midline
        end = midline[midline.time_s == midline.time_s.max()].dropna()
        plotted.plot(end.ap_um, end.depth_um, ".-", linewidth=1, markersize=3)
    minutes = SHORT["time.end_s"] / 60
    plotted.set_title(f"{hypothesis}: floors of {len(runs)} furrows at {minutes:.0f} min", loc="left")
    plotted.set_xlim(-115, 115)
    plotted.set_ylim(0, 50)
    plotted.set_ylabel("depth, µm")
    drawn.imshow(section_of(runs[0]))
    drawn.set_title("the best of them, cut along", loc="left")
    drawn.axis("off")
panels[-1][1].set_xlabel("along the axis, µm (anterior to the left)")
figure.savefig(options.picture, dpi=90)
few_colours(Image.open(options.picture)).save(options.picture, optimize=True)
