#!/usr/bin/python3
"""Pictures of a run, without a screen: a strip of five times, and single views at the end.

Reads DIR/frames.pvd and the frames it lists, writes PNG files. Needs Debian's python3-vtk9, and xvfb where there is no
screen. Displacements are of the apical (outer) surface, from the rest state.

Example: tools/pictures.py results/drosophila --out results/drosophila/pictures
"""
import argparse
import math
import os
import shutil
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

try:
    import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the renderer)
    from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkMath, vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
    from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkPolyDataMapper, vtkRenderer,
                                             vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter, vtkActor2D,
                                             vtkPolyDataMapper2D, vtkCoordinate)
except ImportError as error:
    sys.exit(f"pictures.py: VTK's Python modules are missing ({error}); apt-get install python3-vtk9, "
             "and run this with /usr/bin/python3")

STRIP_TIMES_MIN = (0, 0.5, 2, 5, None)  # None: the end
APICAL_FACE = (4, 5, 6, 7)              # of a hexahedron in VTK's order
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
# L*a*b* of the colours at 0, 1/4, .. 1 of the scale: lightness falls evenly from cream to navy, by which the map reads
# with any kind of colour vision and in grey; what has not moved stays light. (viridis was tried: its yellow end turns
# muddy in the shade.)
LAB = ((96, -3, 10), (78, -18, 2), (59, -20, -18), (40, -4, -33), (21, 8, -30))
INK = (0.12, 0.12, 0.12)
GREY = (0.55, 0.55, 0.55)


class View:
    """A way to look: direction of sight, what is up, and optionally a plane (axis 0 or 1, at the middle) that cuts."""

    def __init__(self, title, sight, up, cut=None):
        self.title, self.sight, self.up, self.cut = title, sight, up, cut


# +x posterior, +y right, +z dorsal.
VIEWS = {
    "ventral": View("from below, anterior to the left", (0, 0, 1), (0, -1, 0)),
    "side": View("from the left side, anterior to the left", (0, 1, 0), (0, 0, 1)),
    "anteroventral": View("from below and in front", (0.55, 0.2, 0.8), (0.15, -0.9, 0.3)),
    "cross_section": View("cross-section at x = 0", (1, 0, 0), (0, 0, 1), cut=0),
    "sagittal_section": View("section at y = 0, anterior to the left", (0, 1, 0), (0, 0, 1), cut=1),
}


class Frame:
    """Positions, displacements and hexahedra of one frame, as plain lists."""

    def __init__(self, file, time_s):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        grid = reader.GetOutput()
        displacement = grid.GetPointData().GetArray("displacement_um") if grid else None
        if displacement is None:
            sys.exit(f"pictures.py: {file}: holds no point array displacement_um; is it a frame of plica?")
        count = grid.GetNumberOfPoints()
        self.time_s = time_s
        self.points = [grid.GetPoint(i) for i in range(count)]
        self.displacements = [math.hypot(*displacement.GetTuple3(i)) for i in range(count)]
        self.hexahedra = []
        for i in range(grid.GetNumberOfCells()):
            ids = grid.GetCell(i).GetPointIds()
            self.hexahedra.append([ids.GetId(k) for k in range(ids.GetNumberOfIds())])
        self.faces = outer_faces(self.hexahedra)


def outer_faces(hexahedra):
    """The apical faces of the outer layer of elements: those that no other element shares."""
    times = {}
    for nodes in hexahedra:
        for face in (APICAL_FACE, (0, 1, 2, 3)):
            key = frozenset(nodes[i] for i in face)
            times[key] = times.get(key, 0) + 1
    faces = ([nodes[i] for i in APICAL_FACE] for nodes in hexahedra)
    return [face for face in faces if times[frozenset(face)] == 1]


def read_frames(directory):
    """[(time in s, file)] of frames.pvd, in order of time."""
    collection = directory / "frames.pvd"
    try:
        entries = ElementTree.parse(collection).getroot().iter("DataSet")
        frames = sorted((float(entry.get("timestep")), directory / entry.get("file")) for entry in entries)
    except (OSError, ElementTree.ParseError, TypeError, ValueError) as error:
        sys.exit(f"pictures.py: {collection}: cannot be read ({error}); give the directory of a plica run")
    if not frames:
        sys.exit(f"pictures.py: {collection}: lists no frames")
    return frames


def nearest(frames, time_min):
    if time_min is None:
        return frames[-1]
    return min(frames, key=lambda frame: abs(frame[0] - 60 * time_min))


def poly_data(points, polygons, scalars=None, lines=False):
    data, vtk_points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    for point in points:
        vtk_points.InsertNextPoint(point)
    for polygon in polygons:
        cells.InsertNextCell(len(polygon))
        for node in polygon:
            cells.InsertCellPoint(node)
    data.SetPoints(vtk_points)
    (data.SetLines if lines else data.SetPolys)(cells)
    if scalars is not None:
        array = vtkDoubleArray()
        array.SetName("displacement")
        for value in scalars:
            array.InsertNextValue(value)
        data.GetPointData().SetScalars(array)
    return data


def cut_cells(frame, axis, at=0.01):
    """The polygons in which the plane cuts the elements, with displacements interpolated along the cut edges.

    `at` is off the middle by next to nothing, because the plane of symmetry may hold whole faces.
    """
    points, values, polygons, outlines = [], [], [], []
    across = [i for i in range(3) if i != axis]
    for nodes in frame.hexahedra:
        cuts = []
        for a, b in EDGES:
            p, q = frame.points[nodes[a]], frame.points[nodes[b]]
            s, t = p[axis] - at, q[axis] - at
            if (s < 0) == (t < 0):
                continue
            w = s / (s - t)
            point = [p[i] + w * (q[i] - p[i]) for i in range(3)]
            value = (1 - w) * frame.displacements[nodes[a]] + w * frame.displacements[nodes[b]]
            cuts.append((point, value, a >= 4 and b >= 4))
        if len(cuts) < 3:
            continue
        centre = [sum(cut[0][i] for cut in cuts) / len(cuts) for i in range(3)]
        cuts.sort(key=lambda cut: math.atan2(cut[0][across[0]] - centre[across[0]],
                                             cut[0][across[1]] - centre[across[1]]))
        first = len(points)
        points += [cut[0] for cut in cuts]
        values += [cut[1] for cut in cuts]
        polygons.append(list(range(first, len(points))))
        outlines.append([first + i for i, cut in enumerate(cuts) if cut[2]])
    return points, values, polygons, [line for line in outlines if len(line) == 2]


def colours(largest):
    function = vtkColorTransferFunction()
    function.SetColorSpaceToLab()
    rgb = [0, 0, 0]
    for i, lab in enumerate(LAB):
        vtkMath.LabToRGB(lab, rgb)
        function.AddRGBPoint(largest * i / (len(LAB) - 1), *rgb)
    return function


def fanned(points, polygons, values):
    """Each polygon as triangles around its middle, so that a symmetric body is drawn symmetric."""
    points, values, triangles = list(points), list(values), []
    for polygon in polygons:
        n, middle = len(polygon), len(points)
        points.append([sum(points[node][i] for node in polygon) / n for i in range(3)])
        values.append(sum(values[node] for node in polygon) / n)
        triangles += [(polygon[i], polygon[(i + 1) % n], middle) for i in range(n)]
    return poly_data(points, triangles, values)


def surface_actor(data, function, flat):
    """`flat` colours as they are in the legend, without light and shade."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetLookupTable(function)
    mapper.SetUseLookupTableScalarRange(True)
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetInterpolationToFlat()
    look.SetAmbient(1.0 if flat else 0.45)
    look.SetDiffuse(0.0 if flat else 0.6)
    look.SetSpecular(0)
    return actor


def line_actor(data, colour, width):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetLineWidth(width)
    actor.GetProperty().LightingOff()
    return actor


def text_actor(text, x, y, size, centred=True, bold=False):
    actor = vtkTextActor()
    actor.SetInput(text)
    look = actor.GetTextProperty()
    look.SetColor(*INK)
    look.SetFontSize(size)
    look.SetFontFamilyToArial()
    look.SetBold(bold)
    if centred:
        look.SetJustificationToCentered()
    actor.SetPosition(x, y)
    return actor


def scale_bar(length_px, x, y, width):
    bar = poly_data([(x, y, 0), (x + length_px, y, 0)], [[0, 1]], lines=True)
    coordinate = vtkCoordinate()
    coordinate.SetCoordinateSystemToViewport()
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(bar)
    mapper.SetTransformCoordinate(coordinate)
    actor = vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*INK)
    actor.GetProperty().SetLineWidth(width)
    return actor


def moved(points, view, away_um):
    """The points further from the eye: in parallel projection that changes only what is in front of what."""
    length = math.hypot(*view.sight)
    return [[p[i] + away_um * view.sight[i] / length for i in range(3)] for p in points]


def add_frame(renderer, frame, rest, view, function, line_width):
    """The embryo itself: its apical surface, or where a plane cuts it with the outline at rest as a grey line."""
    if view.cut is None:
        points, values, polygons = frame.points, frame.displacements, frame.faces
    else:
        points, values, polygons, _ = cut_cells(frame, view.cut)
        rest_points, _, _, outline = cut_cells(rest, view.cut)
        # Behind the cells, so that it shows where they have left it.
        renderer.AddActor(line_actor(poly_data(moved(rest_points, view, 1), outline, lines=True), GREY, line_width * 1.8))
    renderer.AddActor(surface_actor(fanned(points, polygons, values), function, flat=view.cut is not None))
    edges = [(*polygon, polygon[0]) for polygon in polygons]
    renderer.AddActor(line_actor(poly_data(moved(points, view, -1), edges, lines=True), INK, line_width))


def aim(renderer, view, half_height_um):
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    length = math.hypot(*view.sight)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*(-2000 * s / length for s in view.sight))
    camera.SetViewUp(*view.up)
    camera.SetParallelScale(half_height_um)
    renderer.ResetCameraClippingRange()


def new_window(width, height):
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(width, height)
    window.SetMultiSamples(8)
    window.SetNumberOfLayers(2)
    return window


def new_renderer(window, box, size):
    """A white part of the window; `box` is left, bottom, right, top in pixels."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(box[0] / size[0], box[1] / size[1], box[2] / size[0], box[3] / size[1])
    window.AddRenderer(renderer)
    return renderer


def add_legend(renderer, function, height_px, width_px, font):
    legend = vtkScalarBarActor()
    legend.SetLookupTable(function)
    legend.SetNumberOfLabels(round(function.GetRange()[1] / 5) + 1)
    legend.SetLabelFormat("%.0f")
    legend.SetUnconstrainedFontSize(True)
    legend.SetWidth(0.55)
    legend.SetHeight(0.72)
    legend.SetPosition(0.18, 0.08)
    legend.SetBarRatio(0.35)
    look = legend.GetLabelTextProperty()
    look.SetColor(*INK)
    look.SetFontSize(font)
    look.SetItalic(False)
    look.SetShadow(False)
    look.SetBold(False)
    renderer.AddActor2D(legend)
    renderer.AddActor2D(text_actor("displacement", width_px / 2, height_px * 0.92, font))
    renderer.AddActor2D(text_actor("\u00b5m", width_px / 2, height_px * 0.92 - 1.3 * font, font))


def save(window, file):
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGB()
    grab.ReadFrontBufferOff()
    grab.Update()
    writer = vtkPNGWriter()
    writer.SetFileName(str(file))
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    if writer.GetErrorCode() or not file.exists():
        sys.exit(f"pictures.py: {file}: cannot be written")
    print(f"{file} ({file.stat().st_size // 1024} kB)")


def half_size(points, sight, up):
    """How far the points reach from the centre, to the sides and up and down, as seen."""
    def unit(v):
        return [c / math.hypot(*v) for c in v]
    sight = unit(sight)
    along = sum(u * s for u, s in zip(up, sight))
    up = unit([u - along * s for u, s in zip(up, sight)])
    right = [sight[1] * up[2] - sight[2] * up[1], sight[2] * up[0] - sight[0] * up[2],
             sight[0] * up[1] - sight[1] * up[0]]
    return (max(abs(sum(a * b for a, b in zip(p, right))) for p in points),
            max(abs(sum(a * b for a, b in zip(p, up))) for p in points))


def draw_strip(frames, times_min, function, file, rows=("anteroventral", "cross_section"), panel_px=270):
    """Times from left to right, a view a row, all panels of a row at one scale."""
    legend_px, font = 140, 18
    rest = Frame(frames[0][1], frames[0][0])
    shown = [Frame(path, time) for time, path in (nearest(frames, t) for t in times_min)]
    halves = {name: half_size(rest.points, VIEWS[name].sight, VIEWS[name].up) for name in rows}
    half_width = max(h[0] for h in halves.values()) * 1.04
    um_per_px = 2 * half_width / panel_px
    heights = [math.ceil(2 * 1.06 * halves[name][1] / um_per_px) for name in rows]
    caption_px, bar_px = 40, 34
    size = (panel_px * len(shown) + legend_px, sum(heights) + caption_px + bar_px)
    window = new_window(*size)
    top = size[1] - caption_px
    header = new_renderer(window, (0, top, size[0], size[1]), size)
    for column, frame in enumerate(shown):
        minutes = f"{frame.time_s / 60:.3g} min"
        label = f"{minutes} (rest)" if frame.time_s == 0 else minutes
        header.AddActor2D(text_actor(label, (column + 0.5) * panel_px, 8, font + 2, bold=True))
    for name, height in zip(rows, heights):
        for column, frame in enumerate(shown):
            box = (column * panel_px, top - height, (column + 1) * panel_px, top)
            renderer = new_renderer(window, box, size)
            add_frame(renderer, frame, rest, VIEWS[name], function, 1.0)
            aim(renderer, VIEWS[name], height / 2 * um_per_px)
        top -= height
    footer = new_renderer(window, (0, 0, size[0], bar_px), size)
    footer.AddActor2D(scale_bar(100 / um_per_px, 20, bar_px / 2, 3))
    footer.AddActor2D(text_actor("100 \u00b5m", 28 + 100 / um_per_px, bar_px / 2 - 7, font - 2, centred=False))
    captions = "; ".join(VIEWS[name].title for name in rows)
    footer.AddActor2D(text_actor(f"Rows: {captions}; grey: at rest", 40 + 200 / um_per_px,
                                 bar_px / 2 - 7, font - 2, centred=False))
    legend = new_renderer(window, (size[0] - legend_px, bar_px, size[0], size[1] - caption_px), size)
    add_legend(legend, function, sum(heights), legend_px, font - 2)
    save(window, file)


def draw_view(frame, rest, name, function, file, width_px=900):
    legend_px, caption_px, font = 150, 44, 20
    view = VIEWS[name]
    half = half_size(rest.points, view.sight, view.up)
    um_per_px = 2 * 1.05 * half[0] / width_px
    height = math.ceil(2 * 1.06 * half[1] / um_per_px)
    size = (width_px + legend_px, height + caption_px)
    window = new_window(*size)
    renderer = new_renderer(window, (0, caption_px, width_px, size[1]), size)
    add_frame(renderer, frame, rest, view, function, 1.4)
    aim(renderer, view, height / 2 * um_per_px)
    footer = new_renderer(window, (0, 0, size[0], caption_px), size)
    footer.AddActor2D(scale_bar(100 / um_per_px, 20, caption_px / 2, 4))
    footer.AddActor2D(text_actor("100 \u00b5m", 30 + 100 / um_per_px, caption_px / 2 - 8, font, centred=False))
    shell = "; grey: at rest" if view.cut is not None else ""
    footer.AddActor2D(text_actor(f"{frame.time_s / 60:.3g} min, {view.title}{shell}", 150 + 100 / um_per_px,
                                 caption_px / 2 - 8, font, centred=False))
    legend = new_renderer(window, (width_px, caption_px, size[0], size[1]), size)
    add_legend(legend, function, height, legend_px, font)
    save(window, file)


def ensure_display(arguments):
    """VTK draws through X. A virtual screen is taken where there is one, the same picture then on every machine."""
    if "--on-this-display" in arguments:
        return
    if shutil.which("xvfb-run") and shutil.which("Xvfb"):
        # -noreset: else the server starts anew when a window closes, and the next may come too early.
        os.execvp("xvfb-run", ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24 -noreset", sys.executable,
                               os.path.abspath(__file__), *arguments, "--on-this-display"])
    if not os.environ.get("DISPLAY"):
        sys.exit("pictures.py: no screen to draw on: DISPLAY is not set and xvfb-run is missing; apt-get install xvfb xauth")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", type=Path, help="the results of a run")
    parser.add_argument("--out", type=Path, help="where the pictures go (default: DIRECTORY/pictures)")
    parser.add_argument("--times", type=float, nargs="+", metavar="MIN", help="times of the strip's panels, in minutes")
    parser.add_argument("--on-this-display", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    frames = read_frames(options.directory)
    ensure_display(sys.argv[1:])

    out = options.out or options.directory / "pictures"
    out.mkdir(parents=True, exist_ok=True)
    rest, last = (Frame(path, time) for time, path in (frames[0], frames[-1]))
    # One scale for all pictures, up to a round number over the largest displacement of the surface.
    largest = max(last.displacements[node] for face in last.faces for node in face)
    function = colours(max(5 * math.ceil(largest / 5), 5))
    draw_strip(frames, options.times or STRIP_TIMES_MIN, function, out / "strip.png")
    for name in VIEWS:
        draw_view(last, rest, name, function, out / f"{name}.png")


if __name__ == "__main__":
    main()
