"""Draws changes of a tissue, its symmetries, signals and energies: one function per page of theory (docs/images/theory).

Usage: changes.py [NAME...]; without names all. Curves are the formulas of docs/theory with the numbers given here.
"""
import sys

import numpy as np
from matplotlib.patches import Wedge

from shapes import cell, dots, inset, line, plain, polygon, ring, spring, turned
from style import (APICAL, BASAL, CELL, FAINT, FORCE, LATERAL, TEXT, WHITE, YOLK, arrow, canvas, label, leader, save)

BIG = 20  # formulas


def division():
    figure, axes = canvas(760, 340)
    for number, title in enumerate(("mother", "cut: halves", "growth")):
        x, wide = 125 + 255 * number, (75, 75, 95)[number]
        low, high, bend = 110, 220, (0, 0, 8)[number]
        walls = [[(x - wide, y + s * bend), (x, y), (x + wide, y + s * bend)] for y, s in ((low, 1), (high, -1))]
        if number == 2:
            walls = [[(x - 85, 106), (x, 94), (x + 85, 106)], [(x - 85, 224), (x, 236), (x + 85, 224)]]
        lower, upper = walls
        polygon(axes, [*lower, *upper[::-1]], fill="#f3c9bd" if number else "#eab0a0")
        for wall, y in ((lower, 30), (upper, 300)):
            far = [(x - 75, y), (x, y), (x + 75, y)]
            polygon(axes, [*wall, *far[::-1]])
            if number:
                line(axes, wall[1], far[1], color=FAINT, width=2, linestyle=(0, (3, 3)))
                dots(axes, [far[1]], FAINT, 10, markerfacecolor=WHITE, markeredgewidth=2)
        if number:
            line(axes, lower[1], upper[1], color=LATERAL, width=5)
            dots(axes, [lower[1], upper[1]], FORCE, 11)
        label(axes, (x, 322), title)
    for x in (233, 488):
        arrow(axes, (x - 24, 165), (x + 18, 165), TEXT)
    label(axes, (468, 240), "stop", FORCE, ha="left")
    leader(axes, (462, 238), (388, 221), FORCE, dot=False)
    label(axes, (464, 62), "hanging", "#5a6b80", ha="left")
    leader(axes, (459, 57), (390, 33), "#5a6b80", dot=False)
    for x, way in ((568, -1), (702, 1)):
        arrow(axes, (x, 165), (x + 30 * way, 165))
    save(figure, "theory/division.svg")


def exchange():
    figure, axes = canvas(760, 330)
    for number, (title, half) in enumerate((("short and shrinking", (0, 14)), ("turned by a quarter", (24, 0)),
                                            ("lengthened by forces", (46, 0)))):
        middle = np.array((125 + 255 * number, 170))
        # Columns, then the far corners of left, right, lower and upper cell.
        begin, end = middle - half, middle + half
        if number:
            begin, end = end, begin
        corners = {name: middle + at for name, at in {"nw": (-62, 78), "ne": (62, 78), "sw": (-62, -78), "se": (62, -78)}.items()}
        left, right = (begin, end) if number == 0 else (min(begin, end, key=lambda x: x[0]), max(begin, end, key=lambda x: x[0]))
        sides = [middle + (-110, 50), middle + (-110, -50)], [middle + (110, -50), middle + (110, 50)]
        if number == 0:
            polygons = ([corners["nw"], *sides[0], corners["sw"], begin, end], [corners["se"], *sides[1], corners["ne"], end, begin],
                        [corners["sw"], middle + (-35, -118), middle + (35, -118), corners["se"], begin],
                        [corners["ne"], middle + (35, 118), middle + (-35, 118), corners["nw"], end])
        else:
            polygons = ([corners["nw"], *sides[0], corners["sw"], left], [corners["se"], *sides[1], corners["ne"], right],
                        [corners["sw"], middle + (-35, -118), middle + (35, -118), corners["se"], right, left],
                        [corners["ne"], middle + (35, 118), middle + (-35, 118), corners["nw"], left, right])
        for points, fill in zip(polygons, ("#f3c9bd", "#f3c9bd", CELL, CELL)):
            polygon(axes, np.array(points), fill=fill)
        line(axes, begin, end, color=LATERAL, width=5)
        dots(axes, [begin, end], FORCE, 11)
        label(axes, (middle[0], 316), title)
        for name, at in {"1": (-75, 0), "2": (75, 0), "3": (0, -85), "4": (0, 85)}.items():
            label(axes, middle + at, name)
        if number == 2:
            for at, way in ((left, -1), (right, 1)):
                arrow(axes, at, at + (24 * way, 0))
    save(figure, "theory/exchange.svg")


def growth():
    figure, axes = canvas(760, 300)

    def box(x, wide, high, color=None):
        low, left = 60, x - wide / 2
        corners = [(left, low + high), (left + wide, low + high), (left + wide, low), (left, low)]
        cell(axes, *corners, width=4)
        return corners

    def ghost(x):
        corners = [(x - 40, 160), (x + 40, 160), (x + 40, 60), (x - 40, 60)]
        for a, b in zip(corners, [*corners[1:], corners[0]]):
            line(axes, a, b, color=TEXT, width=1.5, linestyle=(0, (4, 3)))
    box(125, 130, 130)
    ghost(125)
    for end in ((188, 125), (62, 125), (125, 188)):
        arrow(axes, (125, 125), end, FORCE)
    label(axes, (172, 145), "$e_1$", FORCE, BIG)
    label(axes, (146, 172), "$e_3$", FORCE, BIG)
    label(axes, (125, 250), "rest shape")
    label(axes, (125, 25), "$G$", TEXT, BIG)
    box(370, 130, 130)
    label(axes, (370, 250), "free")
    label(axes, (370, 25), "$F=G$", TEXT, BIG)
    box(630, 80, 170)
    for x, sign in ((590, -1), (670, 1)):
        polygon(axes, [(x, 50), (x, 240), (x + 16 * sign, 240), (x + 16 * sign, 50)], fill="#94a3b8", edge="none")
        arrow(axes, (x + 55 * sign, 145), (x + 18 * sign, 145), FORCE)
    label(axes, (630, 265), "between walls")
    label(axes, (630, 25), "$F=F_eG$", TEXT, BIG)
    save(figure, "theory/growth.svg")


def ties():
    figure, axes = canvas(760, 320)
    planes, inside = [], []
    for shift in ((0, 0), (210, 50)):
        centre = np.array((190, 130)) + shift
        planes.append([centre + (95 * np.cos(w), 95 * np.sin(w)) for w in np.radians(np.arange(0, 360, 30))])
        inner = [centre + (62 * np.cos(w), 62 * np.sin(w)) for w in np.radians(np.arange(0, 360, 30))]
        inside.append(inner)
        for k in range(12):
            n = (k + 1) % 12
            cell(axes, planes[-1][k], planes[-1][n], inner[n], inner[k], width=3)
    for k in range(1, 12, 2):
        spring(axes, planes[0][k], planes[1][k], FORCE, turns=7, sway=6, width=2)
    for k in (4, 10):
        spring(axes, inside[0][k], inside[1][k], FORCE, turns=7, sway=6, width=2)
    for plane, inner in zip(planes, inside):
        dots(axes, plane[1::2], TEXT, 8)
        dots(axes, [inner[4], inner[10]], TEXT, 8)
    label(axes, (190, 22), "first plane, $x_a$")
    label(axes, (430, 300), "other plane, $x_b$")
    label(axes, (640, 175), "tie: one at every\nnode (some drawn)", FORCE)
    arrow(axes, (560, 70), (680, 98), TEXT)
    label(axes, (640, 62), "axis $x$", ha="left")
    save(figure, "theory/ties.svg")


def mirror():
    figure, axes = canvas(760, 330)
    centre = (250, 165)
    axes.add_patch(Wedge(centre, 100, -90, 90, facecolor=YOLK, edgecolor="none"))
    axes.add_patch(Wedge(centre, 100, 90, 270, facecolor=YOLK, edgecolor="none", alpha=0.28))
    ring(axes, centre, 100, 145, -90, 90, 12)
    ring(axes, centre, 100, 145, 90, 270, 12, alpha=0.28)
    line(axes, (250, 5), (250, 325), color=FORCE, width=3, linestyle=(0, (5, 3)))
    node = np.array((centre[0] + 145 * np.cos(np.radians(30)), centre[1] + 145 * np.sin(np.radians(30))))
    image = node * (-1, 1) + (500, 0)
    dots(axes, [node], TEXT, 11)
    dots(axes, [image], WHITE, 11, markeredgecolor=TEXT, markeredgewidth=2.5)
    arrow(axes, node, node + (48, -12))
    arrow(axes, image, image + (-48, -12), FORCE, alpha=0.5)
    label(axes, (314, 165), "solved", rim=YOLK)
    label(axes, (190, 165), "image", "#5a6b80")
    label(axes, node + (34, 22), "$x$", TEXT, BIG)
    label(axes, image + (-34, 22), "$S\\,x$", TEXT, BIG)
    leader(axes, (455, 268), (252, 300), FORCE)
    label(axes, (465, 268), "mirror plane:", FORCE, ha="left")
    label(axes, (465, 234), "nodes on it stay on it", FORCE, ha="left")
    label(axes, (465, 120), "$E_{\\mathrm{side}}(x)=2^{-m}E(Sx)$", ha="left", size=BIG)
    label(axes, (465, 80), "for $m$ planes", ha="left")
    save(figure, "theory/mirror.svg")


def periodic():
    figure, axes = canvas(760, 300)
    size = 38
    hexagon = np.array([(size * np.cos(w), size * np.sin(w)) for w in np.radians(np.arange(30, 390, 60))])
    step = size * np.sqrt(3)
    for row in range(3):
        for column in range(-1, 9):
            centre = (150 + step * (column + 0.5 * (row % 2)), 80 + 1.5 * size * row)
            polygon(axes, hexagon + centre, fill=CELL if 0 <= column < 7 else "#fcfaf4",
                    edge=LATERAL if 0 <= column < 7 else "#b9d3c5", width=3)
    free = np.array((150 + step * -0.5, 80 - size / 2))
    image = free + (7 * step, 0)
    dots(axes, [free], FORCE, 13)
    dots(axes, [image], WHITE, 13, markeredgecolor=FORCE, markeredgewidth=3)
    arrow(axes, free + (10, -24), image + (-4, -24), FORCE)
    label(axes, ((free + image) / 2) + (0, -44), "$p$", FORCE, BIG)
    label(axes, free + (-6, -30), "$x_f$", FORCE, BIG)
    label(axes, image + (8, -30), "$x_h=x_f+p$", FORCE, BIG, ha="left")
    label(axes, (150 + 3 * step, 270), "one period")
    arrow(axes, (150 + 2 * step, 270), (150 - 0.4 * step, 270), TEXT)
    arrow(axes, (150 + 4 * step, 270), (150 + 6.6 * step, 270), TEXT)
    label(axes, (60, 270), "images", "#5a6b80")
    label(axes, (705, 270), "images", "#5a6b80")
    save(figure, "theory/periodic.svg")


def signals():
    figure, axes = canvas(760, 300)
    size = 34
    hexagon = np.array([(size * np.cos(w), size * np.sin(w)) for w in np.radians(np.arange(30, 390, 60))])
    step = size * np.sqrt(3)
    amber, pale = np.array((0.85, 0.55, 0.15)), np.array((0.98, 0.96, 0.9))
    centres = {}
    for row in range(4):
        for column in range(6):
            centres[row, column] = np.array((45 + step * (column + 0.5 * (row % 2)), 60 + 1.5 * size * row))
            much = np.exp(-max(0, centres[row, column][0] - 75) / 110)
            polygon(axes, hexagon + centres[row, column], fill=tuple(pale + much * (amber - pale)), edge=LATERAL, width=3)
    one, other = centres[1, 3], centres[1, 4]
    dots(axes, [one, other])
    arrow(axes, one + (8, 0), other - (8, 0), FORCE)
    label(axes, (300, 272), "$D\\,A/d\\,(c_1-c_2)$", FORCE, BIG)
    leader(axes, (300, 250), (one + other) / 2 + (0, 8), FORCE, dot=False)
    label(axes, (60, 272), "source")
    curve = inset(figure, (505, 55, 235, 220), "distance from the source", "concentration")
    distance = np.linspace(0, 4, 200)
    curve.plot(distance, np.exp(-distance), color=APICAL)
    curve.plot([1, 1, 0], [0, np.exp(-1), np.exp(-1)], color=TEXT, linewidth=1.5, linestyle=(0, (3, 2)))
    curve.set(xlim=(0, 4), ylim=(0, 1.1))
    curve.set_xticks([1], ["$\\sqrt{D/k}$"])
    curve.set_yticks([np.exp(-1)], ["$c_0/e$"])
    save(figure, "theory/signals.svg")


def energy():
    figure, axes = canvas(760, 330)

    def band(left, right, thick, color):
        (x0, y0), (x1, y1) = left, right
        s = np.linspace(0, 1, 40)
        y = y0 + (y1 - y0) * (3 * s**2 - 2 * s**3)
        x = x0 + (x1 - x0) * s
        axes.fill(np.r_[x, x[::-1]], np.r_[y, (y - thick)[::-1]], color=color, linewidth=0, alpha=0.55)
    band((230, 260), (480, 310), 100, LATERAL)
    band((230, 160), (480, 165), 84, BASAL)
    band((230, 76), (480, 40), 14, FAINT)
    axes.fill([20, 230, 230, 20], [260, 260, 62, 62], color=APICAL, alpha=0.6, linewidth=0)
    plain(axes, (125, 200), "active work")
    plain(axes, (125, 125), "contraction\ncortical tension\napplied pressure")
    plain(axes, (490, 284), "stored", LATERAL, ha="left")
    plain(axes, (490, 238), "elasticity, cortex,\nyolk, contact", TEXT, 16, ha="left")
    plain(axes, (490, 143), "dissipated", BASAL, ha="left")
    plain(axes, (490, 98), "drag, viscosity,\nrelaxation, friction", TEXT, 16, ha="left")
    plain(axes, (490, 33), "error of the time steps", "#5a6b80", ha="left")
    save(figure, "theory/energy.svg")


CHANGES = (division, exchange, growth, ties, mirror, periodic, signals, energy)

if __name__ == "__main__":
    for change in CHANGES:
        if len(sys.argv) == 1 or change.__name__ in sys.argv[1:]:
            change()
