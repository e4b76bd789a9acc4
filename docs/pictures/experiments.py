"""Draws the pictures of docs/how-to/experiments.md: a cut in a sheet, and its recoil.

Usage: experiments.py RESULTS. Runs that are not in RESULTS are made there first, in seconds. Needs the package plica:
PYTHONPATH=build/release/python build/venv/bin/python docs/pictures/experiments.py build/gallery
"""
import numpy as np
from matplotlib.colors import Normalize

from gallery import AREA, LETTERS, at_place, bar, colour_bar, image_of, new, result, scenario_of_page
from style import APICAL, BASAL, IMAGES, TEXT, label, plot
from tissue import Camera, draw_outside, palette_of

CUT_S = 60
SCENARIO = scenario_of_page("how-to/experiments.md", "cut")


def write(figure, name, width):
    path = IMAGES / f"{name}.png"
    image = image_of(figure, width)
    image.quantize(palette=palette_of(image, 224)).save(path, optimize=True)
    print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


def cut_sheet():
    """The middle of the sheet from outside, x to the right."""
    run = result("experiments-cut", SCENARIO)
    figure, axes = new(860, 410)
    camera = Camera(back=(0, 0, 1), up=(0, 1, 0))
    for number, after_s in enumerate((-10, 10, 150)):
        frame = run.frames.at((CUT_S + after_s) / 60)
        apical = frame.polygons("apical")
        middle = np.abs(apical.centres[:, 0]) < 44
        colours = AREA(Normalize(0, 2)(apical.cell_data["apical_area_ratio"]))[:, :3]
        shown = [apical.points[face] for face, one in zip(apical.faces, middle) if one]
        x = 150 + 280 * number
        draw_outside(axes, shown, colours[middle], camera, (0, 0, 1), width=0.8, place=at_place((x, 232), 2.9))
        label(axes, (x, 385), f"{abs(after_s)} s {'before' if after_s < 0 else 'after'}", size=LETTERS, weight="bold")
    colour_bar(axes, 560, 34, AREA, 0, 2, "apical area / reference", width=260, ticks=(0, 1, 2))
    bar(axes, 60, 48, 20, 2.9)
    write(figure, "cut", 1000)


def recoil():
    """Opening over the time after the cut."""
    figure, axes = plot(760, 360, left=95, bottom=80)
    for tension, colour in ((1, APICAL), (0.5, BASAL)):
        series = result(f"experiments-{tension}", SCENARIO, cortex__apical__tension_mN_per_m=tension).series
        time_s = np.asarray(series["time_s"]) - CUT_S
        opening = np.asarray(series["right.displacement_um"]) - np.asarray(series["left.displacement_um"])
        axes.plot(time_s, opening, color=colour)
        speed = np.interp(1, time_s, opening)
        label(axes, (30, np.interp(30, time_s, opening) + 1.7), f"{tension} mN/m: {speed:.1f} µm/s at first", colour, size=22,
              weight="bold", ha="center")
    axes.set_xlim(-5, 60)
    axes.set_ylim(0, 18)
    axes.tick_params(labelsize=22)
    axes.set_xlabel("time after the cut (s)", fontsize=24, color=TEXT)
    axes.set_ylabel("opening (µm)", fontsize=24, color=TEXT)
    write(figure, "recoil", 800)


if __name__ == "__main__":
    cut_sheet()
    recoil()
