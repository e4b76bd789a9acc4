"""Draws the pictures of docs/scenarios and of docs/coming-from-tyssue.md into docs/images.

Usage: scenarios.py RESULTS [NAME...], of the names in PICTURES below; without, all. RESULTS/SCENARIO holds the runs; those that
are not there are made first (seconds; a minute or two for `drosophila-living`, which is solved with mirror planes).
Needs the package plica with Matplotlib and Pillow:
PYTHONPATH=build/release/python build/venv/bin/python docs/pictures/scenarios.py build/scenarios

The pictures of drosophila-egg, drosophila-atlas and drosophila-atlas-living are not here: `plica render` made them, by the
commands of their sections (of drosophila-atlas-living: --view ventral --time 0 --color twi).
"""
import io
import sys
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.colors import LinearSegmentedColormap, Normalize, to_rgb
from PIL import Image

sys.path.insert(0, str(Path(__file__).parent))
from style import CELL, IMAGES, TEXT, VITELLINE, canvas, label  # noqa: E402
from tissue import Camera, cut, draw_cut, draw_outside, fill_inside, keep_beyond, rings_of  # noqa: E402

import plica  # noqa: E402

RESULTS = Path(sys.argv[1] if len(sys.argv) > 1 else "build/scenarios")
LETTERS = 30  # 12 pixels where the picture is shrunk to 400
WIDTH = 1000
AREA = LinearSegmentedColormap.from_list("area", ["#123f6d", "#5b9bd0", "#f7f4ee", "#dd9a62", "#8a3b0c"])
DAUGHTER = "#e69f00"
VENTRAL = Camera(back=(-0.42, 0.25, -0.87), up=(0, -1, 0))
OPEN = Camera(back=(-0.62, -0.34, -0.70), up=(0.3, 0, 1))  # of an embryo that is cut across
ABOVE = Camera(back=(0, 0, 1), up=(0, 1, 0))
LIGHT = (-0.3, -0.6, -0.7)


def run_of(name):
    """The run of a scenario; made if it is not there."""
    folder = RESULTS / name
    if not (folder / "summary.json").is_file():
        scenario = plica.Scenario(name)
        if name == "drosophila-living":
            scenario["embryo.mirror"] = ["x", "y"]
        plica.Simulation(scenario).run(out=folder, overwrite=True)
    return plica.open(folder)


def of_cells(frame, name):
    """An array of elements as one of cells."""
    cells = frame.cell_data["cell_id"].astype(int)
    values = np.full(cells.max() + 1, np.nan)
    values[cells] = frame.cell_data[name]
    return values


def by_area(frame):
    return AREA(Normalize(0, 2)(of_cells(frame, "apical_area_ratio")))[:, :3]


def by_generation(frame):
    return np.where(of_cells(frame, "generation")[:, None] > 0, to_rgb(DAUGHTER), to_rgb(CELL))


def placed(centre, scale, of=(0.0, 0.0)):
    """Function that maps µm to pixels."""
    return lambda points: np.asarray(centre) + scale * (np.asarray(points) - np.asarray(of))


def outside(axes, frame, colours, camera, centre, scale, beyond_um=None, width=0.35):
    """Draws the apical surface; with `beyond_um`, only what is posterior of it, with the cut tissue and the yolk."""
    apical = frame.polygons("apical")
    polygons = [apical.points[face] for face in apical.faces]
    owners = apical.cell_data["cell_id"].astype(int)
    if beyond_um is not None:
        polygons, owners = keep_beyond(polygons, owners, 0, beyond_um)
    flat = camera.flat(np.vstack(polygons))
    place = placed(centre, scale, (flat.min(axis=0) + flat.max(axis=0)) / 2)
    draw_outside(axes, polygons, colours[owners], camera, (0, 0, 1) if camera is ABOVE else LIGHT, place=place, width=width)
    if beyond_um is not None:
        pieces = cut(frame.points, frame.hexahedra, frame.cell_data["cell_id"].astype(int), 0, beyond_um)

        def in_space(points):
            return place(camera.flat(np.column_stack([np.full(len(points), beyond_um), points])))
        fill_inside(axes, pieces[2], in_space)
        draw_cut(axes, *pieces, colours, 0.9, in_space, z=5)


def section(axes, frame, rest, colours, centre, scale, width=1.6, at=0.01, closed=True):
    """Draws a cross-section with the yolk, and the vitelline membrane where `rest`, the reference state, is given."""
    place = placed(centre, scale)
    if rest is not None:
        for ring in rings_of(cut(rest.points, rest.hexahedra, rest.cell_data["cell_id"].astype(int), 0, at)[2]["apical"]):
            axes.plot(*place(ring * 1.012).T, color=VITELLINE, linewidth=2, zorder=1)
    pieces = cut(frame.points, frame.hexahedra, frame.cell_data["cell_id"].astype(int), 0, at)
    if closed:
        fill_inside(axes, pieces[2], place)
    draw_cut(axes, *pieces, colours, width, place)


def bar(axes, x, y, um, scale):
    axes.plot([x, x + um * scale], [y, y], color=TEXT, linewidth=6, solid_capstyle="butt", zorder=9)
    label(axes, (x + um * scale / 2, y + 24), f"{um:g} µm", size=LETTERS - 4)


def area_bar(axes, x, y, width=300):
    """Colour scale of the relative apical area."""
    limits = axes.get_xlim(), axes.get_ylim()
    axes.imshow(np.linspace(0, 1, 128)[None], cmap=AREA, extent=(x, x + width, y, y + 16), aspect="auto", zorder=9)
    axes.set_xlim(limits[0])
    axes.set_ylim(limits[1])
    label(axes, (x + width / 2, y + 40), "apical area / reference", size=LETTERS - 5)
    for value in (0, 1, 2):
        label(axes, (x + width * value / 2, y - 20), f"{value}", size=LETTERS - 5)


def minutes(frame):
    return f"{frame.time_min:.1f} min".replace(".0 ", " ")


def write(figure, path, colours=220):
    """Writes docs/images/PATH in few colours, drawn twice as large and made smaller."""
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=144)
    whole = Image.open(memory).convert("RGB")
    small = whole.resize((WIDTH, round(whole.height * WIDTH / whole.width)), Image.Resampling.LANCZOS)
    (IMAGES / path).parent.mkdir(parents=True, exist_ok=True)
    small.quantize(colours, kmeans=2, dither=Image.Dither.NONE).save(IMAGES / path, optimize=True)
    print(f"{path}: {(IMAGES / path).stat().st_size / 1000:.0f} kB")


def whole_and_cut(name, times, um, scale_out, scale_cut, colour=by_area, height=620):
    """Embryo from below and in front above its cross-section, at three times."""
    run = run_of(name)
    figure, axes = canvas(WIDTH, height)
    for column, time in enumerate(times):
        frame, x = run.frames.at(time), 175 + 325 * column
        outside(axes, frame, colour(frame), VENTRAL, (x, height - 158), scale_out)
        section(axes, frame, run.frames[0], colour(frame), (x, 225), scale_cut, width=1.3)
        label(axes, (x, height - 28), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 34, um, scale_cut)
    if colour is by_area:
        area_bar(axes, 600, 40)
    else:
        label(axes, (640, 50), "daughter cells", DAUGHTER, size=LETTERS, weight="bold")
    write(figure, f"scenarios/{name}.png")


def sections(name, times, um, scale, height=330):
    """Cross-sections at several times in a row."""
    run = run_of(name)
    figure, axes = canvas(WIDTH, height)
    at = 0.01 if name != "furrow-slice" else 0.0
    for column, time in enumerate(times):
        frame, x = run.frames.at(time), 10 + 980 * (column + 0.5) / len(times)
        section(axes, frame, run.frames[0], by_area(frame), (x, 190), scale, width=0.9, at=at)
        label(axes, (x, height - 24), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 30, um, scale)
    area_bar(axes, 620, 36)
    write(figure, f"scenarios/{name}.png")


def closing():
    """The closing furrow: the posterior half of the embryo at three times."""
    run = run_of("drosophila-living")
    figure, axes = canvas(WIDTH, 480)
    for column, time in enumerate((9, 14, 20)):
        frame, x = run.frames.at(time), 165 + 332 * column
        outside(axes, frame, by_area(frame), OPEN, (x, 270), 1.32, beyond_um=60.01, width=0.2)
        label(axes, (x, 455), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 30, 50, 1.32)
    area_bar(axes, 620, 40)
    write(figure, "closing.png")


def variants():
    """Three algorithms and elastic laws at equilibrium."""
    figure, axes = canvas(WIDTH, 480)
    for column, (name, text) in enumerate((("drosophila", "drosophila"), ("drosophila-shape-memory", "shape-memory"),
                                           ("drosophila-paper", "paper"))):
        run, x = run_of(name), 170 + 330 * column
        frame = run.frames[-1]
        section(axes, frame, run.frames[0], by_area(frame), (x, 275), 1.1, width=1.6)
        label(axes, (x, 455), text, size=LETTERS - 2, weight="bold")
        label(axes, (x, 290), f"{run.summary['furrow_depth_um']:.1f} µm", size=LETTERS - 2)
    bar(axes, 30, 34, 100, 1.1)
    area_bar(axes, 620, 40)
    write(figure, "scenarios/drosophila-variants.png")


def strip():
    """Division of the furrow bottom at five times (docs/how-to/division.md)."""
    run = run_of("drosophila-division")
    figure, axes = canvas(WIDTH, 480)
    for column, time in enumerate((15, 17, 20, 25, 40)):
        frame, x = run.frames.at(time), 100 + 200 * column
        outside(axes, frame, by_generation(frame), VENTRAL, (x, 355), 0.38)
        section(axes, frame, run.frames[0], by_generation(frame), (x, 155), 0.6, width=0.9)
        label(axes, (x, 455), minutes(frame), size=LETTERS - 2, weight="bold")
    bar(axes, 30, 24, 100, 0.6)
    label(axes, (780, 36), "daughter cells", DAUGHTER, size=LETTERS, weight="bold")
    write(figure, "division_strip.png")


def wing_disc():
    """A fold of a flat patch, from above and cut across."""
    run = run_of("wing-disc")
    figure, axes = canvas(WIDTH, 760)
    for column, frame in enumerate((run.frames[0], run.frames[-1])):
        x = 250 + 500 * column
        outside(axes, frame, by_area(frame), ABOVE, (x, 480), 2.3, width=0.4)
        section(axes, frame, None, by_area(frame), (x, 175), 2.3, width=1.1, closed=False)
        label(axes, (x, 735), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 34, 50, 2.3)
    area_bar(axes, 620, 40)
    write(figure, "scenarios/wing-disc.png", colours=64)


def growing_disc():
    """A flat patch whose middle grows and folds, from above and cut across."""
    run = run_of("growing-disc")
    figure, axes = canvas(WIDTH, 620)
    for column, time in enumerate((0, 30, 60)):
        frame, x = run.frames.at(time), 168 + 332 * column
        outside(axes, frame, by_area(frame), ABOVE, (x, 400), 2.6, width=0.4)
        section(axes, frame, None, by_area(frame), (x, 190), 2.6, width=1.1, closed=False)
        label(axes, (x, 593), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 30, 50, 2.6)
    area_bar(axes, 620, 36)
    write(figure, "scenarios/growing-disc.png", colours=64)


def bud():
    """A concave sheet cut across at four times, on a membrane that is digested below the growing cells, and on an intact one."""
    run, folder = run_of("bud"), RESULTS / "bud-intact"
    if not (folder / "summary.json").is_file():
        scenario = plica.Scenario("bud")
        scenario["matrix.tip.program.activity"] = [1, 1]
        plica.Simulation(scenario).run(out=folder, overwrite=True)
    figure, axes = canvas(WIDTH, 520)
    scale, end = 1.55, run.frames[-1].time_min
    for y, frames, text in ((360, run.frames, "digested"), (100, plica.open(folder).frames, "intact")):
        for column, time in enumerate((0, 30, 60, end)):
            frame, x = frames.at(time), 128 + 248 * column
            colours = np.where(of_cells(frame, "region_tip")[:, None] > 0, to_rgb(DAUGHTER), to_rgb(CELL))
            pieces = cut(frame.points, frame.hexahedra, frame.cell_data["cell_id"].astype(int), 0, 0.01)
            draw_cut(axes, *pieces, colours, 0.9, placed((x, y + 60), scale))
            if text == "digested":
                label(axes, (x, 495), minutes(frame), size=LETTERS, weight="bold")
        label(axes, (128, y + 5), f"{text} membrane", size=LETTERS - 8)
    bar(axes, 30, 24, 50, scale)
    label(axes, (860, 30), "growing cells", DAUGHTER, size=LETTERS - 2, weight="bold")
    write(figure, "scenarios/bud.png", colours=64)


def convergent_extension():
    """A sheet that narrows and lengthens, from above at four times; cells of the middle are marked."""
    run = run_of("convergent-extension")
    figure, axes = canvas(WIDTH, 560)
    first = run.frames[0]
    centres = np.array([first.polygons("apical").points[face].mean(axis=0) for face in first.polygons("apical").faces])
    marked = np.all(np.abs(centres[:, :2]) < (11, 11), axis=1)
    scale = 3.4
    for (x, y), time in zip(((100, 290), (325, 290), (705, 400), (705, 170)), (0, 10, 20, run.frames[-1].time_min)):
        frame = run.frames.at(time)
        colours = np.where(marked[:, None], to_rgb(DAUGHTER), to_rgb("#dfe7ee"))
        outside(axes, frame, colours, ABOVE, (x, y), scale, width=0.8)
        label(axes, (x, y + 155 if x < 500 else y + 105), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 34, 20, scale)
    write(figure, "scenarios/convergent-extension.png", colours=64)


def germ_band():
    """An egg whose germ band narrows and lengthens, from the side and from below at four times; a stripe of it is marked."""
    run = run_of("germ-band")
    figure, axes = canvas(WIDTH, 340)
    scale = 1.65
    for row, (camera, name) in enumerate(((Camera(back=(0, -1, 0), up=(0, 0, 1)), "side"), (Camera(back=(0, 0, -1), up=(0, -1, 0)), "ventral"))):
        for column, time in enumerate((0, 5, 12.5, run.frames[-1].time_min)):
            frame = run.frames.at(time)
            of_band, of_stripe = (of_cells(frame, f"region_{region}")[:, None] > 0 for region in ("germ-band", "stripe"))
            colours = np.where(of_stripe, to_rgb(DAUGHTER), np.where(of_band, to_rgb("#8db8dc"), to_rgb("#eef0f2")))
            centre = (126 + 249 * column, 225 - 110 * row)
            outside(axes, frame, colours, camera, centre, scale, width=0.8)
            if row == 0:
                label(axes, (centre[0], 310), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 24, 50, scale)
    write(figure, "scenarios/germ-band.png", colours=64)


def division_demo():
    """A row of three cells, of which one divides, from the side."""
    run = run_of("division-demo")
    figure, axes = canvas(WIDTH, 320)
    camera = Camera(back=(-0.25, -0.8, 0.45), up=(0, 0, 1))
    for column, time in enumerate((0.5, 3, 6.5)):
        frame, x = run.frames.at(time), 175 + 325 * column
        cells, colours = frame.cell_data["cell_id"].astype(int), by_generation(frame)
        faces, owners = [], []
        for element, nodes in enumerate(frame.hexahedra):
            for corners in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
                faces.append(frame.points[nodes[list(corners)]])
                owners.append(cells[element])
        middle = camera.flat(frame.points).mean(axis=0)
        draw_outside(axes, faces, colours[owners], camera, (-0.3, -0.8, 0.6), width=1.5, place=placed((x, 160), 3.4, middle))
        label(axes, (x, 296), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 34, 20, 3.4)
    label(axes, (780, 46), "daughter cells", DAUGHTER, size=LETTERS, weight="bold")
    write(figure, "scenarios/division-demo.png")


def ellipsoid():
    """The ellipsoid of docs/coming-from-tyssue.md: cut across, at three times."""
    folder = RESULTS / "ellipsoid"
    if not (folder / "summary.json").is_file():
        page = (IMAGES.parent / "coming-from-tyssue.md").read_text(encoding="utf-8")
        text = page.split("```toml\n# ellipsoid.toml\n")[1].split("```")[0]
        path = RESULTS / "ellipsoid.toml"
        path.write_text(text, encoding="utf-8")
        plica.Simulation(path).run(out=folder, overwrite=True)
    run = plica.open(folder)
    figure, axes = canvas(WIDTH, 430)
    for column, time in enumerate((0, run.frames[-1].time_min / 2, run.frames[-1].time_min)):
        frame, x = run.frames.at(time), 170 + 330 * column
        outside(axes, frame, by_area(frame), OPEN, (x, 245), 1.55, beyond_um=0.01, width=0.4)
        label(axes, (x, 405), minutes(frame), size=LETTERS, weight="bold")
    bar(axes, 30, 30, 50, 1.55)
    area_bar(axes, 620, 36)
    write(figure, "coming-from-tyssue.png")


PICTURES = {
    "closing": closing,
    "division_strip": strip,
    "drosophila": partial(whole_and_cut, "drosophila", (0, 2, 15), 100, 0.6, 0.84),
    "drosophila-variants": variants,
    "xenopus": partial(whole_and_cut, "xenopus", (0, 1, 8.5), 100, 0.7, 0.84),
    "drosophila-deep": partial(whole_and_cut, "drosophila-deep", (0, 10, 28.5), 100, 0.6, 0.84),
    "drosophila-division": partial(whole_and_cut, "drosophila-division", (15, 20, 40), 100, 0.6, 0.84, by_generation),
    "drosophila-division-twice": partial(whole_and_cut, "drosophila-division-twice", (15, 25, 40), 100, 0.6, 0.84, by_generation),
    "drosophila-living": partial(sections, "drosophila-living", (0, 9, 12, 14, 20), 50, 0.98),
    "furrow-slice": partial(sections, "furrow-slice", (0, 9, 12, 15, 20), 50, 0.98),
    "wing-disc": wing_disc,
    "growing-disc": growing_disc,
    "bud": bud,
    "convergent-extension": convergent_extension,
    "germ-band": germ_band,
    "division-demo": division_demo,
    "ellipsoid": ellipsoid,
}

if __name__ == "__main__":
    for name in sys.argv[2:] or PICTURES:
        PICTURES[name]()
