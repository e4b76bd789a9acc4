"""Draws docs/images/hero.gif and hero.png: an embryo cut across while its furrow closes, and the cut face beside it.

Usage: hero.py RUN [--x-um X] [--out FOLDER], where RUN is what `plica run docs/science/living/gradient.toml --out RUN` left (half
an hour on two threads; unfinished will do). Needs the package plica with Matplotlib and Pillow:
PYTHONPATH=build/release/python build/venv/bin/python docs/pictures/hero.py RUN
"""
import argparse
import io
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

sys.path.insert(0, str(Path(__file__).parent))
from style import CELL, IMAGES, TEXT, VITELLINE, canvas, label  # noqa: E402
from tissue import Camera, cut, draw_cut, draw_half, fill_inside, palette_of, rings_of  # noqa: E402

import plica  # noqa: E402

WIDTH, HEIGHT = 1000, 530
LETTERS = 30  # 12 pixels where the picture is shrunk to 400
MESODERM = "#e9a58e"  # cells that contract
CAMERA = Camera(back=(-0.52, -0.46, -0.72), up=(0.3, 0, 1))
LIGHT = (-0.3, -0.9, -0.5)
BOX = (310, 295, 590, 430)  # centre and size of the embryo, pixels
FACE = (805, 295, 1.95)  # centre of the cut face, pixels, and pixels per µm


def moment(run, frame, at_um):
    """The picture of a frame, cut at x = `at_um`."""
    figure, axes = canvas(WIDTH, HEIGHT)
    rest = run.frames[0]
    cells = frame.cell_data["cell_id"].astype(int)
    contracting = np.zeros(cells.max() + 1, dtype=bool)
    contracting[cells] = frame.cell_data["region_mesoderm"] > 0
    colours = np.where(contracting[:, None], to_rgb(MESODERM), to_rgb(CELL))
    def face(points):  # the same, seen from the anterior
        return np.array(FACE[:2]) + FACE[2] * np.asarray(points) * (-1, 1)

    draw_half(axes, frame, colours, CAMERA, LIGHT, at_um, BOX, rest)
    pieces = cut(frame.points, frame.hexahedra, cells, 0, at_um)
    # The cut face.
    for ring in rings_of(cut(rest.points, rest.hexahedra, cells, 0, at_um)[2]["apical"]):
        axes.plot(*face(ring * 1.012).T, color=VITELLINE, linewidth=2, zorder=1)
    fill_inside(axes, pieces[2], face)
    draw_cut(axes, *pieces, colours, 2.2, face)

    label(axes, (30, 46), f"{frame.time_min:.0f} min", size=LETTERS + 10, weight="bold", ha="left")
    label(axes, (250, 42), "mesoderm", "#b4533a", size=LETTERS, weight="bold", ha="left")
    label(axes, (470, 42), "yolk", "#a87f12", size=LETTERS, weight="bold", ha="left")
    x, y, per_um = FACE
    label(axes, (x - 165, y + 165), "D", size=LETTERS)
    label(axes, (x - 165, y - 165), "V", size=LETTERS)
    axes.plot([x + 60, x + 60 + 50 * per_um], [30, 30], color=TEXT, linewidth=6, solid_capstyle="butt")
    label(axes, (x + 60 + 25 * per_um, 55), "50 µm", size=LETTERS)
    return figure, axes


def image_of(figure):
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=144)
    return Image.open(memory).convert("RGB").resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("--x-um", type=float, default=-60, help="place of the cut along the embryo")
    parser.add_argument("--out", type=Path, default=IMAGES)
    parser.add_argument("--only", type=float, help="draw the moment at this time (min) only")
    options = parser.parse_args()
    run = plica.open(options.run)
    if options.only is not None:
        figure, _ = moment(run, run.frames.at(options.only), options.x_um)
        image_of(figure).save(options.out / "hero-try.png")
        sys.exit()
    images = []
    for frame in run.frames:
        figure, _ = moment(run, frame, options.x_um)
        images.append(image_of(figure))
        plt.close(figure)
    palette = palette_of(images[len(images) * 3 // 4], 80)
    images[-1].quantize(palette=palette_of(images[-1], 128), dither=Image.Dither.NONE).save(options.out / "hero.png", optimize=True)
    frames = [one.quantize(palette=palette, dither=Image.Dither.NONE) for one in images]
    frames[0].save(options.out / "hero.gif", save_all=True, append_images=frames[1:], duration=[250] * (len(frames) - 1) + [3000], loop=0)
    for name in ("hero.png", "hero.gif"):
        print(f"{options.out / name}: {(options.out / name).stat().st_size / 1000:.0f} kB")
