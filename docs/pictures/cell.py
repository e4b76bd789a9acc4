"""Drawings of docs/concepts: a cell in its sheet, an embryo cut across, and what happens in a time step.

Usage: cell.py [NAME...], of: sheet embryo step; without, all. The embryo is that of furrow-slice at 16 min: needs the package
plica (PYTHONPATH=build/release/python build/venv/bin/python docs/pictures/cell.py).
"""
import sys
from pathlib import Path

import numpy as np
from matplotlib.patches import FancyBboxPatch

sys.path.insert(0, str(Path(__file__).parent))
from style import (APICAL, BASAL, CELL, FAINT, FORCE, LATERAL, LETTERS, SMALL, TEXT, VITELLINE, WHITE, YOLK, arrow, canvas, key,  # noqa: E402
                   label, leader, save)

LEFT, RIGHT = 214, 536  # where the two columns of labels end and begin


def named(axes, side, y, name, tables, target, color):
    """A part's name, what acts on it below, and a leader to it."""
    x, ha = (LEFT, "right") if side == "left" else (RIGHT, "left")
    label(axes, (x, y), name, color, weight="bold", ha=ha)
    for line, table in enumerate(tables):
        key(axes, (x, y - 22 - 19 * line), table, ha=ha)
    leader(axes, (x + (8 if side == "left" else -8), y), target, color)


def sheet():
    """Three columnar cells of a sheet in oblique projection."""
    figure, axes = canvas(760, 480)
    width, height, depth = 74, 190, np.array([34, 46])
    left, base = 250, 158
    corners = [np.array([left + width * number, base]) for number in range(4)]
    top = np.array([0, height])

    def patch(points, color, alpha=1.0, edge="none", linewidth=0.0, zorder=2.0, **how):
        axes.fill(*np.transpose(points), facecolor=color, alpha=alpha, edgecolor=edge, linewidth=linewidth, zorder=zorder,
                  joinstyle="round", **how)

    def line(start, end, color, linewidth=5.0, zorder=5.0, **how):
        axes.plot(*zip(start, end), color=color, linewidth=linewidth, zorder=zorder, solid_capstyle="round", **how)

    # The vitelline membrane above, the yolk below.
    shell = base + height + depth[1] + 26
    patch([(left - 10, shell), (left + 3 * width + 44, shell), (left + 3 * width + 44, shell + 20), (left - 10, shell + 20)], VITELLINE)
    patch([corners[0] - (10, 4), corners[3] + (44, -4), corners[3] + (44, -64), corners[0] + (-10, -64)], YOLK, zorder=1)
    for at in corners[:3]:
        patch([at, at + (width, 0), at + (width, 0) + top, at + top], CELL)
        patch([at + top, at + (width, 0) + top, at + (width, 0) + top + depth, at + top + depth], APICAL, 0.35)
    end = corners[3]
    patch([end, end + top, end + top + depth, end + depth], LATERAL, 0.3)
    for at in corners:
        line(at, at + top, LATERAL)
        line(at + top, at + top + depth, APICAL, 3)
    line(end + depth, end + top + depth, LATERAL, 3)
    line(end, end + depth, BASAL, 3)
    line(corners[0] + top, end + top, APICAL)
    line(corners[0] + top + depth, end + top + depth, APICAL, 3)
    line(corners[0], end, BASAL)

    # Contraction of the middle cell's apical edges.
    middle = corners[1] + top + (width / 2, 0) + depth / 2
    for shift in (np.array([width / 2 + 10, 0]), depth * 0.62):
        for sign in (1, -1):
            arrow(axes, middle + sign * shift, middle + sign * shift * 0.3, width=3, head=15)
    # A laser's cut through the first cell's apex, and the plane in which the last divides.
    line(corners[0] + top + (14, -14), corners[0] + top + depth + (44, 12), TEXT, 2.5, 7, linestyle=(0, (2, 2)))
    line(corners[2] + (width / 2, 0), corners[2] + (width / 2, 0) + top, TEXT, 2.5, 7, linestyle=(0, (4, 3)))
    # Two cells that form a region.
    bracket = base - 90
    axes.plot([left, left, left + 2 * width, left + 2 * width], [bracket + 12, bracket, bracket, bracket + 12], color=TEXT, linewidth=2)

    named(axes, "left", 452, "vitelline membrane", ["[vitelline]"], (left + 4, shell + 10), VITELLINE)
    named(axes, "left", 390, "apical face", ["[cortex.NAME]", 'faces = "apical"'], corners[0] + top + (31, 28), APICAL)
    named(axes, "left", 316, "laser cut", ["[ablation.NAME]"], corners[0] + top + (18, -10), TEXT)
    named(axes, "left", 252, "cell interior", ["[elasticity]", "[volume]"], corners[0] + (37, 80), TEXT)
    named(axes, "left", 168, "basal face", ["[cortex.NAME]", 'faces = "basal"'], corners[0] + (14, 0), BASAL)
    label(axes, (left + width, bracket - 20), "set of cells", weight="bold")
    key(axes, (left + width, bracket - 42), "[region.NAME]")

    named(axes, "right", 404, "perivitelline gap", ["[vitelline] gap_um"], (left + 3 * width + 28, shell - 13), VITELLINE)
    named(axes, "right", 342, "contraction", ["[contraction.NAME]", 'edges = "apical"'], middle + (width / 2 + 6, 0), FORCE)
    named(axes, "right", 264, "lateral face", ["[cortex.NAME]", 'faces = "lateral"'], end + (18, 110), LATERAL)
    named(axes, "right", 190, "division plane", ["[division.NAME]"], corners[2] + (width / 2, 40), TEXT)
    named(axes, "right", 132, "viscous drag", ["[dynamics]"], end + (4, -2), TEXT)
    label(axes, (left + 133, base - 22), "yolk or lumen", "#6b5200", weight="bold")
    key(axes, (left + 133, base - 46), "[enclosed.yolk]")
    save(figure, "concepts/cell.svg")


def furrow():
    """Corners (y, z) in µm of the cells of furrow-slice at 16 min: two basal ones, then the apical ones in reverse
    order; and which of them contract."""
    import plica

    sim = plica.Simulation("furrow-slice")
    sim.run(until_min=16)
    rest, now = sim.rest_positions, sim.positions
    cells = []
    for nodes in sim.hexahedra:
        front = [node for node in nodes if rest[node][0] < 0]
        basal = [node for node in front if node in nodes[:4]]
        above = {node: nodes[list(nodes).index(node) + 4] for node in basal}
        cells.append([now[node][[1, 2]] for node in (basal[0], basal[1], above[basal[1]], above[basal[0]])])
    return np.array(cells), sim.regions["mesoderm"][sim.hexahedron_cell]


def embryo():
    """An embryo from the left with its axes, and its cross-section with a furrow."""
    figure, axes = canvas(760, 500)

    # From the left: anterior is left, dorsal is up.
    centre, half, radius = np.array([150, 322]), 74, 50
    turn = np.linspace(np.pi / 2, 3 * np.pi / 2, 40)

    def pill(size):
        cap = np.column_stack([-half + size * np.cos(turn), size * np.sin(turn)])
        return centre + np.vstack([cap, -cap])

    label(axes, (centre[0], 478), "from the left", weight="bold")
    axes.fill(*pill(radius + 5).T, facecolor=WHITE, edgecolor=VITELLINE, linewidth=2.5)
    axes.fill(*pill(radius).T, facecolor=CELL, edgecolor=APICAL, linewidth=3)
    axes.fill(*pill(radius - 19).T, facecolor=YOLK, edgecolor=BASAL, linewidth=3)
    axes.plot([centre[0]] * 2, [centre[1] - 72, centre[1] + 72], color=TEXT, linewidth=2, linestyle=(0, (4, 3)))
    label(axes, centre + (0, 86), "x = 0")
    label(axes, (18, centre[1] + 78), "anterior", ha="left")
    label(axes, (282, centre[1] + 78), "posterior", ha="right")
    label(axes, centre + (0, -86), "ventral")
    origin = np.array([46, 110])
    arrow(axes, origin, origin + (80, 0), TEXT, 2.5, 15)
    arrow(axes, origin, origin + (0, 66), TEXT, 2.5, 15)
    axes.plot(*origin, "o", color=WHITE, markeredgecolor=TEXT, markersize=16, markeredgewidth=2, zorder=9)
    axes.plot(*origin, "x", color=TEXT, markersize=9, markeredgewidth=2, zorder=10)
    label(axes, origin + (0, 82), "z: dorsal")
    label(axes, origin + (88, 0), "x: posterior", ha="left")
    label(axes, origin + (-14, -28), "y: right, into the page", ha="left")

    # Cut at x = 0, from the front: the embryo's right is on the left.
    middle, scale = np.array([458, 246]), 132 / 90
    cells, contract = furrow()
    cells = middle + scale * cells * (-1, 1)
    inside = {tuple(np.round(corners[0], 3)): tuple(np.round(corners[1], 3)) for corners in cells}
    lumen = [next(iter(inside))]
    while len(lumen) < len(inside):
        lumen.append(inside[lumen[-1]])
    axes.fill(*np.transpose(lumen), facecolor=YOLK, zorder=1)
    for corners in cells:
        axes.fill(*corners.T, facecolor=CELL, edgecolor=LATERAL, linewidth=1.2, zorder=2)
        axes.plot(*corners[2:].T, color=APICAL, linewidth=3, zorder=4, solid_capstyle="round")
        axes.plot(*corners[:2].T, color=BASAL, linewidth=3, zorder=4, solid_capstyle="round")
    ring = np.linspace(0, 2 * np.pi, 200)
    for size, part, color, width in ((133, ring, VITELLINE, 2.5), (144, np.radians(np.linspace(-30, 30, 40)), LATERAL, 4)):
        axes.plot(middle[0] + size * np.cos(part), middle[1] + size * np.sin(part), color=color, linewidth=width, zorder=3)
    for below, above in ((378, 400), (62, 112)):
        axes.plot([middle[0]] * 2, [below, above], color=TEXT, linewidth=2, linestyle=(0, (4, 3)), zorder=3)
    once = [tuple(np.round(place, 2)) for corners in cells[contract] for place in corners[2:]]
    for border in sorted(place for place in once if once.count(place) == 1):
        leader(axes, (350, 96), border, APICAL)
    label(axes, (344, 96), "border of", APICAL, weight="bold", ha="right")
    label(axes, (344, 74), "mesoderm", APICAL, weight="bold", ha="right")
    label(axes, (middle[0] + 40, 478), "cut at x = 0, from the front", weight="bold")
    label(axes, middle + (0, 168), "dorsal")
    label(axes, middle + (0, -198), "ventral midline, y = 0")
    label(axes, middle + (-150, 0), "R")
    label(axes, middle + (0, 62), "yolk", weight="bold")
    key(axes, middle + (0, 36), "[enclosed.yolk]")
    column = 622
    label(axes, (column, 300), "lateral", LATERAL, weight="bold", ha="left")
    label(axes, (column, 278), "ectoderm", LATERAL, weight="bold", ha="left")
    label(axes, (column, 240), "L", ha="left")
    for y, lines, table, target, color in (
            (196, ["furrow bottom"], "", (2, -76), APICAL),
            (150, ["closed lips"], "[self_contact]", (0, -106), APICAL),
            (84, ["vitelline", "membrane"], "[vitelline]", (22, -131), VITELLINE)):
        for number, line in enumerate(lines):
            label(axes, (column - 8, y - 22 * number), line, color, weight="bold", ha="left")
        if table:
            key(axes, (column - 8, y - 22 * len(lines)), table, ha="left")
        leader(axes, (column - 14, y), middle + target, color)
    save(figure, "concepts/embryo.svg")


def step():
    """What happens in a time step, as a flow."""
    figure, axes = canvas(760, 640)
    middle, wide = 395, 330

    def box(y, lines, color=CELL, edge=TEXT, x=middle, w=wide, h=None):
        h = h or 16 + 22 * len(lines)
        axes.add_patch(FancyBboxPatch((x - w / 2, y - h / 2), w, h, boxstyle="round,pad=0,rounding_size=8", facecolor=color,
                                      edgecolor=edge, linewidth=2, zorder=4))
        for number, text in enumerate(lines):
            label(axes, (x, y + 11 * (len(lines) - 1) - 22 * number), text, weight="bold" if number == 0 else "normal")
        return h / 2

    def down(start, end, text=""):
        arrow(axes, (middle, start), (middle, end), TEXT, 2, 14)
        if text:
            label(axes, (middle + 12, (start + end) / 2 + 2), text, ha="left")

    def back(x, start, end, text, color):
        """An arrow round the side, from one box up to another."""
        edge = middle + (wide / 2 if x > middle else -wide / 2)
        last = edge + 20 * (end == 508)
        axes.plot([edge, x, x], [start, start, end], color=color, linewidth=2, zorder=3)
        arrow(axes, (x, end), (last, end), color, 2, 14)
        for number, line in enumerate(text):
            label(axes, (x + (10 if x > middle else -10), (start + end) / 2 + 11 * (len(text) - 1) - 22 * number), line, color,
                  ha="left" if x > middle else "right")

    question = WHITE
    box(600, ["Forecast", "extrapolate the last steps"])
    down(568, 540)
    box(508, ["Sum the forces on every node", "active, elastic, drag, contact, pressure"], w=wide + 40)
    down(476, 448)
    box(416, ["Newton iteration", "move nodes; no element may invert"])
    down(386, 350)
    box(324, ["Balanced, volumes kept?"], question, FORCE, h=48)
    down(300, 262, "yes")
    box(238, ["Error acceptable?"], question, FORCE, h=48)
    down(214, 176, "yes")
    box(146, ["Accept the step", "one row in series.csv"], "#d9f0e2", LATERAL)
    down(116, 84)
    box(60, ["Equilibrium, end or [stop]?"], question, FORCE, h=48)
    arrow(axes, (middle + wide / 2, 60), (middle + wide / 2 + 80, 60), TEXT, 2, 14)
    label(axes, (middle + wide / 2 + 36, 76), "yes")
    box(60, ["End"], x=middle + wide / 2 + 120, w=80, h=44)
    back(middle + wide / 2 + 60, 324, 508, ["no: iterate"], FORCE)
    back(168, 238, 590, ["no: rejected,", "shorter step"], APICAL)
    axes.plot([168, middle - wide / 2], [324, 324], color=APICAL, linewidth=2, zorder=3)
    label(axes, (158, 324), "not solved", APICAL, ha="right")
    box(508, ["exit status 3"], WHITE, APICAL, x=88, w=136, h=40)
    label(axes, (88, 472), "too short", APICAL)
    axes.plot([168, 160], [508, 508], color=APICAL, linewidth=2, zorder=3)
    arrow(axes, (168, 508), (156, 508), APICAL, 2, 14)
    back(16, 60, 610, [], LATERAL)
    label(axes, (28, 108), "no: next step,", LATERAL, ha="left")
    label(axes, (28, 86), "length by error", LATERAL, ha="left")
    save(figure, "concepts/step.svg")


DRAWINGS = {"sheet": sheet, "embryo": embryo, "step": step}

if __name__ == "__main__":
    for name in sys.argv[1:] or DRAWINGS:
        DRAWINGS[name]()
