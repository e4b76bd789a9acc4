"""Draws the pictures of docs/gallery.md and of the first Python of README.md, into docs/images/gallery.

Usage: gallery.py RESULTS [NAME...], of the names in CARDS below; without, all. Runs that are not in RESULTS are made there
first: minutes for `living` and `phases`, seconds for the others. Needs the package plica with Matplotlib, Pillow and scikit-image:
PYTHONPATH=build/release/python build/venv/bin/python docs/pictures/gallery.py build/gallery
"""
import io
import re
import runpy
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import colormaps, rcParamsDefault
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgb
from PIL import Image

sys.path.insert(0, str(Path(__file__).parent))
from style import APICAL, BASAL, CELL, IMAGES, LATERAL, TEXT, VITELLINE, arrow, canvas, label  # noqa: E402
from tissue import Camera, cut, draw_cut, draw_half, draw_outside, fill_inside, palette_of, rings_of  # noqa: E402

import plica  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
RESULTS = Path(sys.argv[1] if len(sys.argv) > 1 else "build/gallery")
FOLDER = IMAGES / "gallery"
WIDTH, HEIGHT = 800, 480
LETTERS = 26  # 13 pixels where a picture is shrunk to 400
AREA = LinearSegmentedColormap.from_list("area", ["#123f6d", "#5b9bd0", "#f7f4ee", "#dd9a62", "#8a3b0c"])


def result(name, scenario, **keys):
    """The run of a scenario with these keys changed; made if it is not there."""
    if not (RESULTS / name / "summary.json").is_file():
        changed = plica.Scenario(scenario)
        changed.update({key.replace("__", "."): value for key, value in keys.items()})
        plica.Simulation(changed).run(out=RESULTS / name, overwrite=True)
    return plica.open(RESULTS / name)


def scenario_of_page(page, name):
    """The TOML of the block "# NAME.toml" of a page, in RESULTS."""
    (text,) = re.findall(rf"^```toml\n# {name}.toml\n(.*?)^```", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.M | re.S)
    path = RESULTS / f"{name}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def image_of(figure, width=WIDTH):
    """The figure as an image, drawn twice as large and made smaller."""
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=144)
    plt.close(figure)
    whole = Image.open(memory).convert("RGB")
    return whole.resize((width, round(whole.height * width / whole.width)), Image.Resampling.LANCZOS)


def write(figure, name, colours=224, width=1000):
    """Writes docs/images/gallery/NAME.png in few colours."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"{name}.png"
    image = image_of(figure, width)
    image.quantize(palette=palette_of(image, colours), dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


def write_movie(images, name, ms=160, last_ms=2000, colours=48):
    """Writes an animation of images: one palette for all, so that what stands still costs nothing."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"{name}.gif"
    palette = palette_of(images[len(images) * 3 // 4], colours)
    frames = [one.quantize(palette=palette, dither=Image.Dither.NONE) for one in images]
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=[ms] * (len(frames) - 1) + [last_ms], loop=0, optimize=False)
    print(f"{path}: {path.stat().st_size / 1000:.0f} kB")


def at_place(centre, scale, of=(0.0, 0.0)):
    """Function that brings µm to pixels."""
    return lambda points: np.asarray(centre) + scale * (np.asarray(points) - np.asarray(of))


def bar(axes, x, y, um, scale, right=False):
    """Scale bar that begins (or ends) at x, with its length above."""
    start = x - um * scale if right else x
    axes.plot([start, start + um * scale], [y, y], color=TEXT, linewidth=5, solid_capstyle="butt", zorder=9)
    label(axes, (start + um * scale / 2, y + 20), f"{um:g} µm", size=LETTERS - 4)


def words(axes, x, y, named, step=34):
    """Legend of coloured words, one per line."""
    for number, (text, colour) in enumerate(named):
        label(axes, (x, y - number * step), text, colour, size=LETTERS - 3, weight="bold", ha="left")


def colour_bar(axes, x, y, colours, low, high, text, width=200, ticks=()):
    """Horizontal colour scale with its quantity above and values below."""
    axes.imshow(np.linspace(0, 1, 128)[None], cmap=colours, extent=(x, x + width, y, y + 14), aspect="auto", zorder=9)
    axes.set_xlim(0, axes.plica_size[0])
    axes.set_ylim(0, axes.plica_size[1])
    label(axes, (x + width / 2, y + 34), text, size=LETTERS - 5)
    for value in ticks or (low, high):
        label(axes, (x + width * (value - low) / (high - low), y - 16), f"{value:g}", size=LETTERS - 6)


def new(width=WIDTH, height=HEIGHT):
    figure, axes = canvas(width, height)
    axes.plica_size = (width, height)
    return figure, axes


def cells_of(frame):
    """For each cell: its number of the first element, to colour it by what elements have."""
    return frame.cell_data["cell_id"].astype(int)


def by_cell(frame, name):
    """An array of elements as one of cells."""
    cells = cells_of(frame)
    values = np.full(cells.max() + 1, np.nan)
    values[cells] = frame.cell_data[name]
    return values


def section(axes, frame, place, axis=0, at=0.0, colour_of_cell=None, width=2.0, yolk=True, rest=None, plain=False, row=False):
    """Draws a cut of a closed embryo, with its yolk and, from the frame at rest, the vitelline membrane.

    row: cut the cells that were in the plane at rest, so that all of them are of one row.
    """
    def placed(points):
        return place(np.asarray(points))
    if rest is not None:
        for ring in rings_of(cut(rest.points, rest.hexahedra, cells_of(rest), axis, at)[2]["apical"]):
            axes.plot(*placed(ring * 1.015).T, color=VITELLINE, linewidth=1.5, zorder=1)
    pieces = cut(frame.points, frame.hexahedra, cells_of(frame), axis, at, rest.points if row else None)
    if yolk:
        fill_inside(axes, pieces[2], placed)
    draw_cut(axes, *pieces, colour_of_cell, width, placed, plain=plain)


def area_colours(frame):
    return AREA(Normalize(0, 2)(by_cell(frame, "apical_area_ratio")))[:, :3]


# The cards.


def closing():
    """The closing furrow's cross-section, moving; and the first page's door to the first furrow."""
    run = result("slice", "furrow-slice", output__frame_every_min=0.5)
    rest, images = run.frames[0], []
    for frame in run.frames:
        figure, axes = new()
        section(axes, frame, at_place((285, 240), 2.4), rest=rest, width=2.6)
        label(axes, (560, 420), f"{frame.time_min:.0f} min", size=LETTERS + 6, weight="bold", ha="left")
        words(axes, 560, 340, [("apical", APICAL), ("basal", BASAL), ("lateral", LATERAL), ("yolk", "#a87f12"), ("membrane", VITELLINE)])
        bar(axes, 560, 60, 50, 2.4)
        label(axes, (40, 440), "D", size=LETTERS)
        label(axes, (40, 40), "V", size=LETTERS)
        images.append(image_of(figure))
        if abs(frame.time_min - 14) < 0.01:
            figure, axes = new(500, 300)
            section(axes, frame, at_place((250, 150), 1.56), rest=rest, width=1.8)
            write(figure, "door-fold", 64, 700)
    write_movie(images, "slice")


def measured():
    """The measured embryo from the ventral side and cut across, at 9 min and at the end."""
    run = plica.open(RESULTS / "gradient")  # of `plica run docs/science/living/gradient.toml`
    camera = Camera(back=(0, 0, -1), up=(0, -1, 0))
    figure, axes = new()
    for row, minutes in enumerate((9, 24)):
        frame, y = run.frames.at(minutes), 388 - 185 * row
        apical = frame.polygons("apical")
        colours = AREA(Normalize(0, 2)(apical.cell_data["apical_area_ratio"]))[:, :3]
        draw_outside(axes, [apical.points[face] for face in apical.faces], colours, camera, (0, -0.3, -1), width=0.25,
                     place=at_place((340, y), 0.82))
        section(axes, frame, at_place((695, y), 0.82), at=-60, colour_of_cell=area_colours(frame), width=1.2, plain=True)
        label(axes, (10, y + 70), f"{frame.time_min:.0f} min", size=LETTERS, weight="bold", ha="left")
        label(axes, (90, y - 30), "A", size=LETTERS - 4)
        label(axes, (585, y - 30), "P", size=LETTERS - 4)
    area_bar(axes, 480, 52)
    bar(axes, 60, 48, 100, 0.82)
    write(figure, "measured", 96, 900)


def living():
    """Three rows of cells of a whole embryo, from the middle towards a pole."""
    run = result("living", "drosophila-living", embryo__mirror=["x", "y"])
    figure, axes = new()
    frame, rest = run.frames.at(20), run.frames[0]
    for number, at in enumerate((3.15, 129.2, 173.9)):
        x = 142 + 258 * number
        section(axes, frame, at_place((x, 265), 1.36), at=at, colour_of_cell=area_colours(frame), width=2, rest=rest, plain=True, row=True)
        label(axes, (x, 440), f"x = {at:.0f} µm", size=LETTERS - 2)
    label(axes, (22, 400), "D", size=LETTERS - 2)
    label(axes, (22, 130), "V", size=LETTERS - 2)
    area_bar(axes, 480, 52)
    bar(axes, 60, 48, 50, 1.36)
    write(figure, "living")


def area_bar(axes, x, y):
    colour_bar(axes, x, y, AREA, 0, 2, "apical area / reference", 260, (0, 1, 2))


VIEW = Camera(back=(-0.55, -0.42, -0.68), up=(0.3, 0, 1))  # from the anterior, the left and below
SUN = (-0.3, -0.9, -0.5)


def deep():
    """A deep furrow: the embryo cut across, and cut along its midline."""
    run = result("deep", "drosophila-deep")
    figure, axes = new()
    frame, rest = run.frames[-1], run.frames[0]
    scale = draw_half(axes, frame, area_colours(frame), VIEW, SUN, 0.01, (235, 290, 430, 350), rest, 2.0)
    for one, y in ((rest, 375), (frame, 200)):
        section(axes, one, at_place((628, y), 0.6), axis=1, at=0.01, width=1.8)
        label(axes, (628, y), f"{one.time_min:.1f} min".replace(".0", ""), size=LETTERS - 4)
        label(axes, (477, y), "A", size=LETTERS - 4)
        label(axes, (778, y), "P", size=LETTERS - 4)
    for place, letter in (((115, 448), "D"), ((205, 180), "V"), ((645, 430), "D"), ((645, 318), "V")):
        label(axes, place, letter, size=LETTERS - 4, rim="white")
    area_bar(axes, 40, 52)
    bar(axes, 345, 48, 100, scale)
    bar(axes, 600, 48, 100, 0.6)
    write(figure, "deep")


def twist():
    """Expression of twist on the measured embryo at rest, from the ventral side."""
    frame = plica.open(RESULTS / "gradient").frames[0]
    apical = frame.polygons("apical")
    figure, axes = new()
    camera = Camera(back=(0, 0, -1), up=(0, -1, 0))
    values = apical.cell_data["twi"]
    colours = colormaps["YlGnBu"](Normalize(0, 1.2)(values))[:, :3]
    draw_outside(axes, [apical.points[face] for face in apical.faces], colours, camera, (0, -0.2, -1), place=at_place((400, 270), 1.36))
    label(axes, (40, 400), "A", size=LETTERS)
    label(axes, (760, 400), "P", size=LETTERS)
    colour_bar(axes, 480, 52, "YlGnBu", 0, 1.2, "expression of $twi$", 260, (0, 0.6, 1.2))
    bar(axes, 60, 48, 100, 1.36)
    write(figure, "twist")


def prisms(frame, keep):
    """Closed surfaces of some cells, as polygons in space, with their cells."""
    apical, basal = frame.polygons("apical"), frame.polygons("basal")
    polygons, owners = [], []
    for cell, (above, below) in enumerate(zip(apical.faces, basal.faces)):
        if keep[cell]:
            top, bottom = apical.points[above], basal.points[below]
            polygons += [top, bottom[::-1]]
            polygons += [np.array([bottom[one], bottom[one - 1], top[one - 1], top[one]])[::-1] for one in range(len(top))]
            owners += [cell] * (2 + len(top))
    return polygons, np.array(owners)


def sheet_picture(axes, frame, place, camera, keep=None, colours=None, width=0.5):
    apical = frame.polygons("apical")
    keep = np.ones(len(apical.faces), dtype=bool) if keep is None else keep
    colours = AREA(Normalize(0, 2)(apical.cell_data["apical_area_ratio"]))[:, :3] if colours is None else colours
    polygons, owners = prisms(frame, keep)
    draw_outside(axes, polygons, colours[owners], camera, (-0.3, -0.5, 1), width=width, place=place, two_sided=True)


def wing_disc():
    """A patch with a fold, cut open."""
    run = result("wing-disc", "wing-disc")
    frame = run.frames[-1]
    figure, axes = new(800, 480)
    start = run.frames[0].polygons()
    camera = Camera(back=(0.75, -0.5, 0.62), up=(0, 0, 1))
    sheet_picture(axes, frame, at_place((420, 265), 2.95), camera, start.centres[:, 0] < 20)
    bar(axes, 60, 48, 50, 2.95)
    area_bar(axes, 480, 52)
    write(figure, "wing-disc")
    figure, axes = new(500, 300)
    sheet_picture(axes, frame, at_place((250, 150), 2.05), camera, start.centres[:, 0] < 20)
    write(figure, "door-gallery", 96, 700)


def growing():
    """A sheet whose middle has grown, cut open."""
    run = result("growing-disc", "growing-disc")
    figure, axes = new(800, 480)
    start = run.frames[0].polygons()
    camera = Camera(back=(0.8, -0.35, 0.55), up=(0, 0, 1))
    sheet_picture(axes, run.frames[-1], at_place((420, 285), 4.1), camera, start.centres[:, 0] < 12)
    bar(axes, 60, 48, 50, 4.1)
    area_bar(axes, 480, 52)
    write(figure, "growing")


def wave():
    """A groove that goes along with a signal."""
    run = result("wave", "wave")
    figure, axes = new(800, 480)
    camera = Camera(back=(0.2, -0.85, 0.5), up=(0, 0, 1))
    for time, height in ((10, 380), (20, 260), (30, 140)):
        frame = run.frames.at(time)
        colours = colormaps["YlGnBu"](frame.polygons("apical").cell_data["signal_u"])[:, :3]
        sheet_picture(axes, frame, at_place((440, height), 2.5), camera, colours=colours, width=0.4)
        label(axes, (90, height), f"{time} min", size=LETTERS, weight="bold")
    bar(axes, 60, 34, 50, 2.5)
    colour_bar(axes, 560, 40, "YlGnBu", 0, 1, "signal", 200)
    write(figure, "wave")


def endless():
    """One period of an endless fold."""
    run = result("endless", scenario_of_page("how-to/sheet.md", "endless"))
    figure, axes = new()
    camera = Camera(back=(0.75, -0.3, 0.6), up=(0, 0, 1))
    for frame, place in ((run.frames[0], (250, 355)), (run.frames[-1], (555, 225))):
        sheet_picture(axes, frame, at_place(place, 3.4), camera)
        label(axes, (place[0] - 220, place[1] + 60), f"{frame.time_min:.1f} min".replace(".0", ""), size=LETTERS, weight="bold",
              ha="left")
    area_bar(axes, 60, 52)
    bar(axes, 600, 48, 20, 3.4)
    write(figure, "endless")


def directions():
    """A patch that pulls evenly, along fibres, and by a cable around it."""
    path = scenario_of_page("how-to/direction.md", "patch")
    even, fibres, cable = {"weakest": 0.999, "nN": 0}, {"weakest": 0, "nN": 0}, {"weakest": 0, "nN": 10}
    figure, axes = new(860, 400)
    camera = Camera(back=(0, 0, 1), up=(0, 1, 0))
    for number, (name, one) in enumerate((("even", even), ("fibres", fibres), ("cable", cable))):
        run = result(f"direction-{name}", path, cortex__apical__direction__weakest=one["weakest"],
                     cortex__apical__tension_mN_per_m=0 if name == "cable" else 1, contraction__cable__preload_nN=one["nN"])
        apical = run.frames[-1].polygons("apical")
        middle = (np.abs(apical.centres[:, 0]) < 44) & (np.abs(apical.centres[:, 1]) < 36)
        colours = AREA(Normalize(0, 2)(apical.cell_data["apical_area_ratio"]))[:, :3]
        shown = [apical.points[face] for face, inside in zip(apical.faces, middle) if inside]
        x = 150 + 280 * number
        draw_outside(axes, shown, colours[middle], camera, (0, 0, 1), width=0.8, place=at_place((x, 225), 2.7))
        label(axes, (x, 375), name, size=LETTERS, weight="bold")
    colour_bar(axes, 560, 40, AREA, 0, 2, "apical area / reference", width=260, ticks=(0, 1, 2))
    bar(axes, 60, 54, 20, 2.7)
    write(figure, "directions", 224, 900)


def ablation():
    """A cut in a sheet under tension."""
    run = result("experiments-cut", scenario_of_page("how-to/experiments.md", "cut"))
    figure, axes = new(800, 480)
    camera = Camera(back=(0, 0, 1), up=(1, 0, 0))
    for number, (minutes, text) in enumerate(((50 / 60, "before"), (70 / 60, "10 s after"), (3.5, "2.5 min after"))):
        frame = run.frames.at(minutes)
        apical = frame.polygons("apical")
        x = 140 + 260 * number
        colours = AREA(Normalize(0, 2)(apical.cell_data["apical_area_ratio"]))[:, :3]
        middle = np.all(np.abs(apical.centres[:, :2]) < (48, 39), axis=1)
        shown = [apical.points[face] for face, one in zip(apical.faces, middle) if one]
        draw_outside(axes, shown, colours[middle], camera, (0, 0, 1), width=0.8, place=at_place((x, 263), 3.15))
        label(axes, (x, 452), text, size=LETTERS, weight="bold")
    area_bar(axes, 480, 52)
    bar(axes, 60, 48, 20, 3.15)
    write(figure, "ablation")


def light():
    """Slices in which myosin was inhibited from 5 and from 8 min on."""
    scenario = scenario_of_page("how-to/experiments.md", "light")
    figure, axes = new()
    for number, minutes in enumerate((5, 8)):
        run = result(f"light-{minutes}", scenario, ablation__light__at_min=minutes)
        x = 210 + 380 * number
        section(axes, run.frames[-1], at_place((x, 235), 1.95), width=2.4, rest=run.frames[0])
        label(axes, (x, 448), f"inhibited from {minutes} min", size=LETTERS, weight="bold")
    label(axes, (400, 400), "D", size=LETTERS)
    label(axes, (400, 100), "V", size=LETTERS)
    bar(axes, 352, 25, 50, 1.95)
    write(figure, "light")


def division():
    """The furrow bottom before and after its cells divide."""
    run = result("division", "drosophila-division")
    figure, axes = new()
    for number, minutes in enumerate((15, 20, 40)):
        frame, x = run.frames.at(minutes), 142 + 258 * number
        colours = np.where((by_cell(frame, "generation") > 0)[:, None], to_rgb("#e8a33d"), to_rgb(CELL))
        section(axes, frame, at_place((x, 260), 0.89), at=0.01, colour_of_cell=colours, width=1.8, rest=run.frames[0])
        label(axes, (x, 430), f"{minutes} min", size=LETTERS, weight="bold")
    label(axes, (600, 60), "daughters", "#b9770a", size=LETTERS, weight="bold")
    bar(axes, 60, 48, 100, 0.89)
    write(figure, "division")


def feedback():
    """A wave of contraction that stretch carries: what the Python of the gallery runs."""
    if not (RESULTS / "wave" / "summary.json").is_file():
        (block,) = re.findall(r"^```python\n(import numpy.*?)^```", (ROOT / "docs/gallery.md").read_text(encoding="utf-8"), re.M | re.S)
        exec(compile(block.replace("results/wave", str(RESULTS / "wave")), "gallery.md", "exec"), {})
    run = plica.open(RESULTS / "wave")
    figure, axes = new()
    camera = Camera(back=(-0.25, -1, 0.25), up=(0, 0, 1))
    for number, minutes in enumerate((1, 2, 3)):
        frame, x, y = run.frames.at(minutes), 150 + 250 * number, 355 - 65 * number
        apical = frame.polygons("apical")
        colours = colormaps["YlOrRd"](Normalize(0, 1.2)(apical.cell_data["activity"]))[:, :3]
        draw_outside(axes, [apical.points[one] for one in apical.faces], colours, camera, (-0.2, -1, 0.5), width=0.8,
                     place=at_place((x, y), 0.5))
        label(axes, (x, y + 95), f"{minutes} min", size=LETTERS, weight="bold")
    shades = LinearSegmentedColormap.from_list("activity", colormaps["YlOrRd"](np.linspace(0, 1 / 1.2, 64)))
    colour_bar(axes, 60, 52, shades, 0, 1, "activity", 260, (0, 0.5, 1))
    bar(axes, 620, 48, 100, 0.5)
    write(figure, "feedback")


def law():
    """A sheet that a law from a formula folds, by law.py."""
    if not (RESULTS / "law" / "summary.json").is_file():
        runpy.run_path(str(Path(__file__).parent / "law.py"))["fold"](RESULTS / "law")
    run = plica.open(RESULTS / "law")
    figure, axes = new()
    camera = Camera(back=(0.35, -0.75, 0.75), up=(0, 0, 1))
    start = run.frames[0].polygons("apical")
    sheet_picture(axes, run.frames[-1], at_place((415, 255), 4.6), camera, start.centres[:, 1] > -12)
    bar(axes, 60, 48, 20, 4.6)
    area_bar(axes, 480, 52)
    write(figure, "law")


LABELS = """\
format = 1
region.bright = { array = "reporter", above = 0.5 }
elasticity = { corner_barrier_Pa = 100 }
time = { end_min = 20 }

[contraction.apical]
region = "bright"
edges = "apical"
stiffness_nN_per_um = 10
profile = { shape = "array", array = "reporter", from = 0.2, to = 1 }
program = { time_min = [0, 3], activity = [0, 1] }

[contraction.lateral]
region = "bright"
edges = "lateral"
stiffness_nN_per_um = 0.5
program = { time_min = [0, 3], activity = [0, 1] }

[embryo]
shape = "surface"
file = "cells.ply"
cell_height_um = 25
rim = "held"
"""


def labels():
    """A label image whose cells are bright along a band, and the sheet that these cells fold."""
    from scipy.spatial import cKDTree
    from skimage.segmentation import find_boundaries

    rows, columns, number, um = 600, 750, 560, 0.2
    rng = np.random.default_rng(7)
    pixels = np.indices((rows, columns)).reshape(2, -1).T
    points = rng.uniform(0, (rows, columns), (number, 2))
    for _ in range(2):
        nearest = cKDTree(points).query(pixels)[1]
        size = np.bincount(nearest, minlength=number)
        points = np.column_stack([np.bincount(nearest, pixels[:, axis], number) / size for axis in (0, 1)])
    drawn = cKDTree(points).query(pixels)[1].reshape(rows, columns)
    from_band_um = um * (points[:, 0] - rows / 2 - 40 * np.cos(2 * np.pi * points[:, 1] / columns))
    level = np.exp(-0.5 * (from_band_um / 7) ** 2)
    image = np.where(find_boundaries(drawn, mode="inner"), 0, drawn + 1)

    if not (RESULTS / "labels" / "summary.json").is_file():
        cells = plica.polygons_of_labels(image, um)
        cells.cell_data["reporter"] = level[cells.cell_data["label"].astype(int) - 1]
        middle = (cells.points.min(axis=0) + cells.points.max(axis=0)) / 2
        plica.Polygons(cells.points - middle, cells.faces, cells.cell_data).write(RESULTS / "cells.ply")
        (RESULTS / "labels.toml").write_text(LABELS, encoding="utf-8")
        plica.Simulation(RESULTS / "labels.toml").run(out=RESULTS / "labels", overwrite=True)
    frame = plica.open(RESULTS / "labels").frames[-1]
    figure, axes = new()
    shown = np.where((image > 0)[..., None], colormaps["magma"](0.15 + 0.8 * level[drawn])[..., :3], 0.0)
    axes.imshow(shown, extent=(20, 370, 110, 390), zorder=2)
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, HEIGHT)
    label(axes, (195, 430), "reporter", size=LETTERS, weight="bold")
    label(axes, (590, 430), "folded sheet", size=LETTERS, weight="bold")
    start = plica.open(RESULTS / "labels").frames[0].polygons()
    camera = Camera(back=(-0.45, -0.75, 0.62), up=(0, 0, 1))
    sheet_picture(axes, frame, at_place((568, 262), 2.3), camera, start.centres[:, 0] > -25)
    bar(axes, 20, 48, 50, 350 / (um * columns))
    area_bar(axes, 480, 52)
    write(figure, "labels")


VERDICTS = {"closed": "#44337a", "furrowed": "#a78bd4", "flattened": "#cfd4dc"}  # none of the colours of a cell


def phases():
    """Which slices close, over two keys, with a cross-section of each outcome."""
    study = plica.Study(RESULTS / "phases") if (RESULTS / "phases").is_dir() else None
    if study is None:
        study = plica.Study(scenario_of_page("how-to/answers.md", "phases"))
        study.run(out=RESULTS / "phases")
    table = study.table
    first, second = study.keys
    xs, ys = sorted(table[first].unique()), sorted(table[second].unique())
    figure, axes = new()
    left, low, wide, high = 105, 110, 44, 52
    chosen = {}
    for _, row in table.iterrows():
        word = plica.verdict(row)
        column, line = xs.index(row[first]), ys.index(row[second])
        axes.add_patch(plt.Rectangle((left + wide * column, low + high * line), wide, high, facecolor=VERDICTS[word],
                                     edgecolor="white", linewidth=2))
        chosen.setdefault(word, []).append(int(row["point"]))
    for column in range(0, len(xs), 2):
        label(axes, (left + wide * (column + 0.5), low - 20), f"{xs[column]:g}", size=LETTERS - 6)
    for line in range(len(ys)):
        label(axes, (left - 12, low + high * (line + 0.5)), f"{ys[line]:.3g}", size=LETTERS - 6, ha="right")
    label(axes, (left + wide * len(xs) / 2, low - 58), "lateral tension (mN/m)", size=LETTERS - 5)
    label(axes, (24, low + high * len(ys) / 2), "Young's modulus (Pa, log)", size=LETTERS - 5, rotation=90)
    for number, (word, points) in enumerate((word, chosen[word]) for word in VERDICTS if word in chosen):
        frame = plica.open(RESULTS / f"phases/points/{points[len(points) // 2]:06d}").frames[-1]
        y = 375 - 145 * number
        section(axes, frame, at_place((590, y), 0.68), width=1.2)
        label(axes, (665, y), word, {"closed": "#44337a", "furrowed": "#7a5bb5", "flattened": "#5a6472"}[word], size=LETTERS - 6, weight="bold", ha="left")
    write(figure, "phases")


def report():
    """The report of a run as a narrow browser window shows it. Needs Chromium."""
    run = result("deep", "drosophila-deep")
    path = RESULTS / "report.png"
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--hide-scrollbars", "--window-size=720,690",
                    "--virtual-time-budget=20000", "--force-device-scale-factor=2", f"--screenshot={path}",
                    (run.directory / "report.html").resolve().as_uri()], check=True, stderr=subprocess.DEVNULL)
    image = Image.open(path).convert("RGB").resize((1000, 958), Image.Resampling.LANCZOS)
    image.quantize(160, dither=Image.Dither.NONE).save(FOLDER / "report.png", optimize=True)
    print(f"{FOLDER / 'report.png'}: {(FOLDER / 'report.png').stat().st_size / 1000:.0f} kB")


def doors():
    """The first page's door to what plica can do: cells that fold; cells that exchange neighbours, before and after."""
    figure, axes = new(500, 300)

    def cell(corners, mark=None):
        axes.fill(*np.transpose(corners), facecolor=mark or CELL, edgecolor=LATERAL, linewidth=3, zorder=3)

    centre, inner, outer = np.array([100, 150]), 18, 75  # a groove between two shoulders
    angles = np.linspace(np.pi, 2 * np.pi, 8)
    for one, other in zip(angles, angles[1:]):
        turn = np.array([[np.cos(one), np.sin(one)], [np.cos(other), np.sin(other)]])
        cell([*(centre + inner * turn), *(centre + outer * turn)[::-1]])
    for side in (-1, 1):
        cell([(100 + side * inner, 150), (100 + side * outer, 150), (100 + side * outer, 190), (100 + side * inner, 190)])
    curve = np.linspace(np.pi, 2 * np.pi, 60)
    for radius, colour in ((inner, APICAL), (outer, BASAL)):
        line = [(100 - radius, 190), *(centre + radius * np.column_stack([np.cos(curve), np.sin(curve)])), (100 + radius, 190)]
        axes.plot(*np.transpose(line), color=colour, linewidth=6, zorder=5, solid_capstyle="round")

    half, grey, blue = 55, "#d5dae2", "#8fb3dd"  # four cells: the blue ones touch before, the grey ones after
    for x, turned in ((285, False), (435, True)):
        def placed(corners, x=x, turned=turned):
            return np.array([x, 132]) + np.array([(b, a) if turned else (a, b) for a, b in corners])

        for sign in (-1, 1):
            cell(placed([(-half, sign * 25), (-14, 0), (14, 0), (half, sign * 25), (half, sign * half), (-half, sign * half)]), grey if turned else blue)
            cell(placed([(sign * 14, 0), (sign * half, 25), (sign * half, -25)]), blue if turned else grey)
    arrow(axes, (346, 132), (374, 132), TEXT)
    for x, sign, colour, text in ((100, "✓", LATERAL, "folding"), (360, "✗", APICAL, "swapping places")):
        label(axes, (x, 250), sign, colour, size=54, weight="bold")
        label(axes, (x, 34), text, size=27)
    write(figure, "door-decide", 64, 700)


def readme():
    """What the Python of README.md draws."""
    (block,) = re.findall(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text(encoding="utf-8"), re.M | re.S)
    names = {}
    with plt.rc_context(rcParamsDefault):
        block = block.replace('"furrow.png"', "'/dev/null', format='png'").replace('"slice"', f'"{RESULTS}/readme"')
        exec(compile(block, "README.md", "exec"), names)
        write(names["figure"], "readme", 64)


CARDS = {one.__name__: one for one in (closing, measured, living, deep, twist, wing_disc, growing, wave, directions, endless, ablation, light, division, feedback, law, labels, phases, report, doors, readme)}

if __name__ == "__main__":
    for card in sys.argv[2:] or CARDS:
        CARDS[card]()
