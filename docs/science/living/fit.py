"""Draw fit.png of docs/science/living-embryo.md: the targets of the fit beside the results of the ten frozen sets.

Usage: fit.py [--run] [--picture PICTURE.png]. Reads fit.csv of this folder: the ten sets as slices; as embryos, the first set and the
range of all. With --run, writes that file first (seconds for the slices, five minutes of one core for the embryos).
"""
import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd

from drawing import few_colours
from style import BASAL, LETTERS, TEXT, VITELLINE
from targets import OF_EMBRYO, TARGETS

HERE = Path(__file__).resolve().parent
TABLE = HERE / "fit.csv"
SCENARIOS = {"slice": HERE / "chosen.toml", "embryo": HERE / "../../../scenarios/living/embryo.toml"}
# (name, unit, factor to that unit) of each measure.
NAMES = {
    "furrow_depth_um": ("furrow depth at 20 min", "µm", 1),
    "knee_depth_um": ("depth at onset of fast phase", "µm", 1),
    "knee_time_s": ("time of that onset", "min", 60),
    "lips_closed_time_s": ("time of closure", "min", 60),
    "vml_height_um": ("greatest height, midline cells", "µm", 1),
    "flank_section_area_ratio": ("area of lateral ectoderm", "× initial", 1),
    "inner5.area_ratio": ("apical area at 5 min, inner rows", "× initial", 1),
    "inner9.area_ratio": ("apical area at 9 min, inner rows", "× initial", 1),
    "outer9.area_ratio": ("apical area at 9 min, outer rows", "× initial", 1),
}


def run(kind):
    """Run the ten sets as slices or as whole embryos; return their measures."""
    import plica
    study = plica.Study({
        "format": 1, "scenario": str(SCENARIOS[kind].resolve()),
        "design": {"kind": "file", "file": str((HERE / "../../../scenarios/living/draws.csv").resolve())},
        "keep": {"measures": list(TARGETS)},
    })
    return study.run(jobs=1)[list(TARGETS)]


def run_all():
    slices, embryos = run("slice"), run("embryo")
    rows = {("slice", number + 1): row for number, row in slices.iterrows()}
    rows |= {("embryo", "first"): embryos.iloc[0], ("embryo", "least"): embryos.min(), ("embryo", "most"): embryos.max()}
    pd.DataFrame(rows.values(), index=pd.MultiIndex.from_tuples(rows, names=["run", "set"])).to_csv(TABLE, float_format="%.4g")


def draw(table, picture):
    figure, axes = plt.subplots(figsize=(760 / 72, 600 / 72))
    figure.subplots_adjust(left=0.46, right=0.98, top=0.92, bottom=0.11)
    axes.axvspan(-1, 1, color="#e2e8f0")
    axes.axvline(0, color=TEXT, linewidth=1)
    for row, (measure, (name, unit, factor)) in enumerate(NAMES.items()):
        value, width = OF_EMBRYO[measure]
        first, least, most = ((table.loc["embryo", one][measure] - value) / width for one in ("first", "least", "most"))
        axes.plot([least, most], [row, row], color=BASAL, linewidth=9, alpha=0.45, solid_capstyle="butt", label="ten embryos" if row == 0 else None)
        axes.plot(first, row, "o", color=BASAL, markersize=10)
        value, width = TARGETS[measure]
        x = (table.loc["slice"][measure] - value) / width
        axes.plot(x, [row + 0.3] * len(x), "o", color=BASAL, fillstyle="none", markersize=6, mew=1.3, label="ten slices" if row == 0 else None)
        value, width = OF_EMBRYO[measure]
        for text, y, colour in ((name, row - 0.2, TEXT), (f"target {value / factor:.2g} ± {width / factor:.2g} {unit}", row + 0.25, VITELLINE)):
            axes.text(-0.02, y, text, color=colour, ha="right", va="center", transform=axes.get_yaxis_transform(), fontsize=LETTERS)
    axes.set_ylim(len(NAMES) - 0.4, -0.6)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("result − target, in widths")
    axes.legend(loc="lower right", bbox_to_anchor=(1.02, 1.0), ncols=2, frameon=False, borderpad=0, handletextpad=0.2)
    figure.savefig(picture, dpi=144)


parser = argparse.ArgumentParser()
parser.add_argument("--run", action="store_true")
parser.add_argument("--picture", type=Path, default=HERE / "../../images/living/fit.png")
options = parser.parse_args()
if options.run:
    run_all()
frame = pd.read_csv(TABLE, index_col=["run", "set"])
print(frame.round(3).T.to_string())
draw(frame, options.picture)
few_colours(options.picture)
