"""Draw cuts.png and gradient.png of docs/science/living-embryo.md.

Usage: pictures.py RESULTS GRADIENT IMAGES. RESULTS is of `plica reproduce living` (--quick is enough), GRADIENT of `plica run
docs/science/living/gradient.toml`. With - for RESULTS or GRADIENT, its picture is left out.
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle

import plica
from drawing import COLOURS, SAGITTAL, SCALE, draw_section, few_colours, scale_bar
from style import APICAL, BASAL, CELL, FORCE, LATERAL, TEXT, VITELLINE, canvas, label
from tissue import Camera, cut, draw_cut, draw_outside, fill_inside, rings_of

results, gradient, images = sys.argv[1:4]

MESODERM = "#e9a58e"  # cells that contract, as in docs/pictures/hero.py

# (title, where apical surfaces are cut, (colour, from, to) of a bar) of each experiment; marks are below the belly, um along the axis.
CUTS = {
    "reference": ("undisturbed", [], None),
    "cut-out": ("apical cuts", [-63.5, 63.5], None),
    "walls-cut": ("lateral faces cut", [], (LATERAL, -60, 60)),
    "cut-out-and-walls-cut": ("both cuts", [-63.5, 63.5], (LATERAL, -60, 60)),
    "block": ("apical tension blocked", [], (FORCE, -60, 60)),
    "floor-kept": ("basal cortex kept stiff", [], (BASAL, -240, 240)),
}


# (marker, colour, text) of each kind of mark.
KEY = (("^", APICAL, "apical surfaces cut"), ("s", LATERAL, "lateral faces cut"),
       ("s", FORCE, "apical tension blocked"), ("s", BASAL, "basal cortex kept stiff"))


def colour_bar(figure, place):
    bar = figure.colorbar(ScalarMappable(SCALE, COLOURS), cax=figure.add_axes(place), orientation="horizontal", ticks=[0, 20, 40, 60])
    bar.set_label("displacement, µm", labelpad=2)
    bar.outline.set_visible(False)


def draw_cuts(path):
    figure, panels = plt.subplots(3, 2, figsize=(760 / 72, 620 / 72))
    figure.subplots_adjust(left=0.01, right=0.99, top=0.955, bottom=0.15, wspace=0.03, hspace=0.2)
    for panel, (experiment, (title, cuts, bar)) in zip(panels.flat, CUTS.items()):
        draw_section(panel, Path(results, "runs", experiment, "draw-1"), 20, SAGITTAL)
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
    marks = [plt.Line2D([], [], marker=marker, color=colour, linestyle="", markersize=12) for marker, colour, _ in KEY]
    figure.legend(marks, [text for _, _, text in KEY], loc="lower left", bbox_to_anchor=(0, 0), ncols=2, frameon=False,
                  handletextpad=0.1, columnspacing=0.8, borderpad=0.2)
    colour_bar(figure, (0.7, 0.085, 0.27, 0.022))
    figure.savefig(path, dpi=144)
    few_colours(path, 128)


def draw_furrow(axes, run, minute, at_um, corner, size, per_um):
    """Draw the ventral part of a cross-section in a box (lower left corner, size), pixels."""
    frame, rest = run.frames.at(minute), run.frames[0]
    cells = frame.cell_data["cell_id"].astype(int)
    colours = colours_of(frame)
    lowest = rest.points[:, 2].min()

    def place(points):
        return np.array([corner[0] + size[0] / 2, corner[1] + 8]) + per_um * (np.asarray(points) - (0, lowest))

    known = len(axes.collections), len(axes.lines)
    for ring in rings_of(cut(rest.points, rest.hexahedra, cells, 0, at_um)[2]["apical"]):
        axes.plot(*place(ring * 1.012).T, color=VITELLINE, linewidth=1.5, zorder=1)
    pieces = cut(frame.points, frame.hexahedra, cells, 0, at_um)
    fill_inside(axes, pieces[2], place)
    draw_cut(axes, *pieces, colours, 1.3, place)
    box = Rectangle(corner, *size, transform=axes.transData, visible=False)
    axes.add_patch(box)
    for drawn in [*axes.collections[known[0]:], *axes.lines[known[1]:]]:
        drawn.set_clip_path(box)
    label(axes, (corner[0] + 4, corner[1] + size[1] - 12), f"{minute} min", size=20, weight="bold", ha="left", rim="white")


def colours_of(frame):
    """Colour of each cell: the mesoderm's or the others'."""
    cells = frame.cell_data["cell_id"].astype(int)
    contracting = np.zeros(cells.max() + 1, dtype=bool)
    contracting[cells] = frame.cell_data["region_mesoderm"] > 0
    return np.where(contracting[:, None], to_rgb(MESODERM), to_rgb(CELL))


def draw_gradient(path, folder, times, at_um):
    """The furrow in cross-sections at four times, and the last of them from the ventral side."""
    run = plica.open(folder)
    figure, axes = canvas(760, 800)
    per_um = 2.1
    for number, minute in enumerate(times):
        column, row = number % 2, number // 2
        draw_furrow(axes, run, minute, at_um, (10 + 375 * column, 560 - 235 * row), (365, 225), per_um)
    axes.plot([60, 60 + 50 * per_um], [312, 312], color=TEXT, linewidth=4, solid_capstyle="butt")
    label(axes, (180, 312), "50 µm", ha="left")
    frame = run.frames.at(times[-1])
    apical = frame.polygons("apical")
    per_um, middle = 1.36, np.array((402, 150))
    draw_outside(axes, [apical.points[face] for face in apical.faces], colours_of(frame)[apical.cell_data["cell_id"].astype(int)],
                 Camera(back=(0, 0, -1), up=(0, -1, 0)), (-0.2, -0.4, -0.9), 0.5, lambda points: middle + per_um * points)
    label(axes, (14, 284), f"{times[-1]} min, ventral side", size=20, weight="bold", ha="left")
    x = middle[0] + per_um * at_um
    axes.plot([x, x], [16, 284], color=TEXT, linewidth=2, linestyle=(0, (4, 3)), zorder=9)
    label(axes, (x + 8, 282), "place of the sections", ha="left")
    label(axes, (20, 150), "A", size=20, weight="bold")
    label(axes, (744, 150), "P", size=20, weight="bold")
    axes.plot([530, 530 + 100 * per_um], [20, 20], color=TEXT, linewidth=4, solid_capstyle="butt")
    label(axes, (540 + 100 * per_um, 20), "100 µm", ha="left")
    for at, text in (((192, 720), "yolk"), ((192, 640), "mesoderm"), ((77, 695), "ectoderm")):
        label(axes, at, text, rim="white")
    figure.savefig(path, dpi=100)
    few_colours(path, 90)


Path(images).mkdir(parents=True, exist_ok=True)
if results != "-":
    draw_cuts(Path(images, "cuts.png"))
if gradient != "-":
    draw_gradient(Path(images, "gradient.png"), gradient, (9, 14, 20, 24), -60)
