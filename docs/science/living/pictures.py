"""Draw cuts.png and gradient.png of docs/science/living-embryo.md.

Usage: pictures.py RESULTS GRADIENT IMAGES [MEASURED]. RESULTS is of `plica reproduce living`, GRADIENT of `plica run
docs/science/living/gradient.toml`. With MEASURED, of `plica reproduce scenarios/living/measured.toml`, atlas.png is drawn, too.
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.cm import ScalarMappable
from matplotlib.patches import Rectangle

from drawing import COLOURS, SAGITTAL, SCALE, TRANSVERSE, draw_section, draw_ventral, few_colours, scale_bar
from style import APICAL, BASAL, FORCE, LATERAL, TEXT

results, gradient, images = map(Path, sys.argv[1:4])
measured = Path(sys.argv[4]) if len(sys.argv) > 4 else None

# (title, where apical surfaces are cut, (colour, from, to) of a bar) of each experiment; marks are below the belly, um along the axis.
CUTS = {
    "reference": ("undisturbed", [], None),
    "cut-out": ("apical cuts", [-63.5, 63.5], None),
    "walls-cut": ("lateral faces cut", [], (LATERAL, -60, 60)),
    "cut-out-and-walls-cut": ("both cuts", [-63.5, 63.5], (LATERAL, -60, 60)),
    "block": ("apical tension blocked", [], (FORCE, -60, 60)),
    "floor-kept": ("basal cortex kept stiff", [], (BASAL, -240, 240)),
}


def colour_bar(figure, place):
    bar = figure.colorbar(ScalarMappable(SCALE, COLOURS), cax=figure.add_axes(place), orientation="horizontal", ticks=[0, 20, 40, 60])
    bar.set_label("displacement, µm", labelpad=2)
    bar.outline.set_visible(False)


def draw_cuts(path):
    figure, panels = plt.subplots(3, 2, figsize=(760 / 72, 590 / 72))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.95, bottom=0.12, wspace=0.03, hspace=0.2)
    for panel, (experiment, (title, cuts, bar)) in zip(panels.flat, CUTS.items()):
        draw_section(panel, results / "runs" / experiment / "draw-1", 20, SAGITTAL)
        panel.set_title(title, pad=2)
        panel.set_xlim(-255, 255)
        panel.set_ylim(-118, 95)
        panel.plot(cuts, [-106] * len(cuts), "^", color=APICAL, markersize=11)
        if bar:
            colour, start, end = bar
            panel.add_patch(Rectangle((start, -113), end - start, 12, color=colour, linewidth=0))
    scale_bar(panels[0, 0], -110, 20)
    for x, letter in ((-190, "A"), (190, "P")):
        panels[0, 0].text(x, 20, letter, ha="center", va="center", weight="bold")
    colour_bar(figure, (0.3, 0.075, 0.4, 0.025))
    figure.savefig(path, dpi=144)
    few_colours(path)


def draw_embryo(path, folder, times, at):
    """Ventral view, sagittal section and cross-section at each time, min; the last is cut at a place along the axis, um."""
    figure, panels = plt.subplots(3, len(times), figsize=(760 / 72, 560 / 72), height_ratios=[1, 1, 1.5])
    figure.subplots_adjust(left=0.045, right=0.995, top=0.94, bottom=0.14, wspace=0.03, hspace=0.04)
    for column, minute in zip(panels.T, times):
        draw_ventral(column[0], folder, minute)
        draw_section(column[1], folder, minute, SAGITTAL)
        draw_section(column[2], folder, minute, TRANSVERSE, at)
        column[0].set_title(f"{minute} min", pad=2)
    for panel, name in zip(panels[:, 0], ("ventral", "sagittal", "cross")):
        box = panel.get_position()
        figure.text(0.002, (box.y0 + box.y1) / 2, name, rotation=90, va="center", color=TEXT)
    long, across = panels[1, 0], panels[2, 0]
    scale_bar(long, -110, 10)
    scale_bar(across, -90, across.get_ylim()[0] - 6, 50)
    colour_bar(figure, (0.42, 0.085, 0.42, 0.025))
    figure.savefig(path, dpi=144)
    few_colours(path)


images.mkdir(parents=True, exist_ok=True)
draw_cuts(images / "cuts.png")
draw_embryo(images / "gradient.png", gradient, (9, 14, 24), -60)
if measured:
    draw_embryo(images / "atlas.png", measured / "runs/atlas/draw-1", (9, 14, 20), 30)
