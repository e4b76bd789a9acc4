"""Style shared by the drawings of the documentation: palette, letters, labels, arrows, and one way to write SVG.

A drawing is a script of this folder that needs Matplotlib only, such as cell.py: run it with Python from anywhere, and it
writes its files into docs/images. Lengths are pixels of a drawing as wide as `canvas` is given; 760 fits a page. Letters of
size 17 are then readable where the drawing is shrunk to 400 pixels. Letters are written as outlines, so a drawing looks the
same everywhere, and the same script writes the same bytes.
"""
import re
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.patheffects as patheffects  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402

IMAGES = Path(__file__).resolve().parents[1] / "images"

APICAL = "#c8452f"
BASAL = "#2b6cb0"
LATERAL = "#2f855a"
CELL = "#f4ead5"
YOLK = "#f3cf6b"
VITELLINE = "#4a5568"
TEXT = "#1a202c"
FORCE = "#6b46c1"  # forces and contact
FAINT = "#a0aec0"  # leaders, axes, what is at rest
WHITE = "#ffffff"

LETTERS = 17  # smallest that is readable at 400 pixels
SMALL = 15  # keys of tables in the fixed-width font, which is wider

plt.rcParams.update({
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "font.size": LETTERS,
    "text.color": TEXT,
    "axes.edgecolor": TEXT,
    "axes.labelcolor": TEXT,
    "xtick.color": TEXT,
    "ytick.color": TEXT,
    "axes.linewidth": 1.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 3,
    "lines.solid_joinstyle": "round",
    "figure.dpi": 72,
    "savefig.facecolor": WHITE,
    "svg.fonttype": "path",
    "svg.hashsalt": "plica",
})


def canvas(width=760, height=400):
    """Figure and axes without frame, in pixels from the lower left corner, equally scaled."""
    figure = plt.figure(figsize=(width / 72, height / 72))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_xlim(0, width)
    axes.set_ylim(0, height)
    axes.set_axis_off()
    return figure, axes


def plot(width=760, height=400, left=90, right=20, top=20, bottom=70):
    """Figure and axes of a curve, with margins in pixels."""
    figure = plt.figure(figsize=(width / 72, height / 72))
    axes = figure.add_axes((left / width, bottom / height, (width - left - right) / width, (height - top - bottom) / height))
    return figure, axes


def label(axes, at, text, color=TEXT, size=LETTERS, **how):
    """Text at a point, centred unless `ha` and `va` say otherwise.

    rim: colour of a rim that keeps the text readable on lines. It costs about 10 kB per word.
    """
    how = {"ha": "center", "va": "center", "zorder": 10, **how}
    rim = how.pop("rim", None)
    effects = [patheffects.withStroke(linewidth=4, foreground=rim)] if rim else None
    return axes.text(*at, text, color=color, fontsize=size, path_effects=effects, **how)


def key(axes, at, text, color=TEXT, size=SMALL, **how):
    """Name of a table or key of a scenario, in the fixed-width font."""
    return label(axes, at, text, color, size, family="DejaVu Sans Mono", **how)


def leader(axes, start, end, color=FAINT, dot=True):
    """Thin line from a label to what it names, which ends in a dot."""
    axes.plot(*zip(start, end), color=color, linewidth=1.5, zorder=8)
    if dot:
        axes.plot(*end, "o", color=color, markersize=6, zorder=8)


def arrow(axes, start, end, color=FORCE, width=3, head=18, **how):
    """Arrow of a force, a motion or an axis."""
    axes.annotate("", end, start, zorder=9, arrowprops={
        "arrowstyle": f"-|>,head_length={head / 30},head_width={head / 60}", "mutation_scale": 30, "color": color, "linewidth": width,
        "shrinkA": 0, "shrinkB": 0, **how})


def save(figure, name):
    """Writes docs/images/NAME (.svg) and closes the figure."""
    path = IMAGES / name
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    plt.close(figure)
    text = path.read_text(encoding="utf-8")
    text = re.sub(r'(width|height)="([\d.]+)pt"', r'\1="\2"', text, count=2)  # pixels
    path.write_text(re.sub(r" +$", "", text, flags=re.M), encoding="utf-8")
    print(f"{path}: {path.stat().st_size / 1024:.0f} KiB")
