#!/usr/bin/pvpython
"""Open a run of plica in ParaView with the colours and views of its pictures, or draw or save that state.

    PLICA_RUN=results/drosophila paraview --script=tools/paraview_state.py      # interactive
    pvbatch tools/paraview_state.py results/drosophila --picture fold.png      # a picture; needs a screen or xvfb-run
    pvbatch tools/paraview_state.py results/drosophila --save fold.pvsm        # a state for File > Load State

Colour: displacement; colours and ranges of the other arrays are set as well.
"""
import argparse
import math
import os
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from paraview import simple

# The ends and middles of plica's colour maps in CIE L*a*b*, as in src/show/looks.cpp (a test compares them).
STILL = ((96, -3, 10), (78, -18, 2), (59, -20, -18), (40, -4, -33), (21, 8, -30))
ABOUT = ((25, 8, -38), (60, -10, -32), (95, 0, 3), (60, 22, 42), (25, 24, 32))
# array, where it lives, map, the value in the middle of a two-sided map
ARRAYS = (
    ("displacement_um", "POINTS", STILL, None),
    ("velocity_um_per_s", "POINTS", STILL, None),
    ("volume_um3", "CELLS", STILL, None),
    ("activity", "CELLS", STILL, None),
    ("apical_area_ratio", "CELLS", ABOUT, 1),
    ("pressure_Pa", "CELLS", ABOUT, 0),
    ("volume_error", "CELLS", ABOUT, 0),
)
SIZE = [1400, 900]
SIGHT, UP = (0.55, 0.2, 0.8), (0.15, -0.9, 0.3)  # from below and in front


def srgb(lab):
    """CIE L*a*b* (D65) to sRGB, 0 to 1."""
    fy = (lab[0] + 16) / 116
    f = (fy + lab[1] / 500, fy, fy - lab[2] / 200)
    xyz = [w * (v ** 3 if v > 6 / 29 else 3 * (6 / 29) ** 2 * (v - 4 / 29)) for v, w in zip(f, (0.95047, 1, 1.08883))]
    light = (3.2406 * xyz[0] - 1.5372 * xyz[1] - 0.4986 * xyz[2], -0.9689 * xyz[0] + 1.8758 * xyz[1] + 0.0415 * xyz[2],
             0.0557 * xyz[0] - 0.2040 * xyz[1] + 1.0570 * xyz[2])
    return [min(max(12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055, 0), 1) for c in light]


def colour_points(control, low, high, count=33):
    """[value, r, g, b, ...] at equal steps, as ParaView takes them."""
    points = []
    for i in range(count):
        place = i / (count - 1) * (len(control) - 1)
        k = min(int(place), len(control) - 2)
        lab = [a + (place - k) * (b - a) for a, b in zip(control[k], control[k + 1])]
        points += [low + (high - low) * i / (count - 1), *srgb(lab)]
    return points


def rounded_up(value):
    """The next of 1, 1.2, 1.5, ... times a power of ten."""
    if not value > 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(f * power for f in (1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 8, 10) if f * power * (1 + 1e-9) >= value)


def ranges_over_time(reader):
    """Smallest and greatest value of each array over all frames; of vectors, of their length."""
    ranges = {}
    for time in reader.TimestepValues:
        simple.UpdatePipeline(time, reader)
        information = reader.GetDataInformation()
        for name, where, *_ in ARRAYS:
            data = information.GetPointDataInformation() if where == "POINTS" else information.GetCellDataInformation()
            array = data.GetArrayInformation(name)
            if array is None:
                continue
            low, high = array.GetComponentRange(-1 if array.GetNumberOfComponents() > 1 else 0)
            before = ranges.get(name, (low, high))
            ranges[name] = (min(low, before[0]), max(high, before[1]))
    return ranges


def open_run(run):
    """Reader, display and view of the run's frames."""
    collection = run / "frames.pvd"
    if not collection.exists():
        sys.exit(f"paraview_state.py: {collection}: is not there; give the --out directory of a `plica run`")
    reader = simple.PVDReader(registrationName="run", FileName=str(collection))
    ranges = ranges_over_time(reader)
    view = simple.GetActiveViewOrCreate("RenderView")
    display = simple.Show(reader, view)
    display.Representation = "Surface With Edges"
    display.EdgeColor = [0.11, 0.11, 0.13]
    display.Ambient, display.Diffuse, display.Specular = 0.45, 0.6, 0.0
    display.Interpolation = "Flat"
    # First, because it sets the range of the colours by the frame at hand.
    simple.ColorBy(display, ("POINTS", "displacement_um", "Magnitude"))
    display.SetScalarBarVisibility(view, True)
    for name, _, control, centre in ARRAYS:
        if name not in ranges:
            continue
        low, high = ranges[name]
        reach = rounded_up(high) if centre is None else rounded_up(max(centre - low, high - centre))
        ends = (0, reach) if centre is None else (centre - reach, centre + reach)
        table = simple.GetColorTransferFunction(name)
        table.AutomaticRescaleRangeMode = "Never"
        table.ColorSpace = "RGB"
        table.RGBPoints = colour_points(control, *ends)
    bar = simple.GetScalarBar(simple.GetColorTransferFunction("displacement_um"), view)
    bar.Title, bar.ComponentTitle = "displacement from rest, µm", ""
    bar.Orientation, bar.WindowLocation, bar.ScalarBarLength = "Horizontal", "Lower Center", 0.4
    bar.TitleFontSize = bar.LabelFontSize = 14
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%-#.3g", "%-#.3g"
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    view.ViewSize = SIZE
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesLabelColor = [0.1, 0.1, 0.1]
    view.CameraParallelProjection = 1
    bounds = reader.GetDataInformation().GetBounds()
    centre = [(bounds[2 * i] + bounds[2 * i + 1]) / 2 for i in range(3)]
    size = max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4])
    length = math.hypot(*SIGHT)
    view.CameraFocalPoint = centre
    view.CameraPosition = [c - 4 * size * s / length for c, s in zip(centre, SIGHT)]
    view.CameraViewUp = UP
    view.CameraParallelScale = 0.36 * size
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    simple.Render(view)
    return view


def save_state(file):
    """A state for any run: the frames' file without its folder, and without the parts that ParaView fills in itself."""
    simple.SaveState(file)
    tree = ElementTree.parse(file)
    for element in list(tree.getroot().iter()):
        for child in list(element):
            if child.tag in ("Domain", "Hints"):
                element.remove(child)
        if element.tag == "Element" and element.get("value", "").endswith("/frames.pvd"):
            element.set("value", "frames.pvd")
    ElementTree.indent(tree, " ")
    tree.write(file, encoding="utf-8", xml_declaration=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", nargs="?", default=os.environ.get("PLICA_RUN", "."), help="results of a run; else PLICA_RUN")
    parser.add_argument("--picture", help="FILE.png to write")
    parser.add_argument("--save", help="FILE.pvsm to write")
    options = parser.parse_args([a for a in sys.argv[1:] if not a.startswith("--script")])
    view = open_run(Path(options.run).resolve())
    if options.picture:
        simple.SaveScreenshot(options.picture, view, ImageResolution=SIZE)
    if options.save:
        save_state(options.save)


if __name__ in ("__main__", "__vtkconsole__"):
    main()
