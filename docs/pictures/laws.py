"""Draws what pulls on what: one function per force law (docs/images/theory).

Usage: laws.py [NAME...]; without names all. Curves are the formulas of docs/theory with the numbers given here.
"""
import sys

import numpy as np
from matplotlib.patches import Wedge

from shapes import cell, dots, inset, line, polygon, ring, spring, turned
from style import (APICAL, BASAL, CELL, FAINT, FORCE, LATERAL, TEXT, VITELLINE, WHITE, YOLK, arrow, canvas, label, leader, plt, save)

BIG = 20  # formulas
LAYER = "#0e7c86"  # extracellular matrix
SQUARE = np.array([(-55, -75), (55, -75), (55, 75), (-55, 75)])


def contraction():
    figure, axes = canvas(760, 330)
    wide, deep = np.array((165, 0)), np.array((75, 70))
    for k in range(2):
        top, bottom = np.array((25, 175)) + k * wide, np.array((25, 40)) + k * wide
        polygon(axes, [top, top + wide, top + wide + deep, top + deep], edge="none")
        polygon(axes, [bottom, bottom + wide, top + wide, top], fill="#efe1c4", edge="none")
        for x in (top, top + wide):
            line(axes, x, x - (0, 135), color=LATERAL)
        line(axes, bottom, bottom + wide, color=BASAL)
        corners = [top, top + wide, top + wide + deep, top + deep]
        middle = np.mean(corners, axis=0)
        for a, b in zip(corners, [*corners[1:], corners[0]]):
            line(axes, a, b, color="#d8a79c", width=1.5)
            inward = np.array((np.sign(middle[0] - (a + b)[0] / 2) * 13, 0)) if a[1] != b[1] else \
                np.array((0, np.sign(middle[1] - a[1]) * 9))
            spring(axes, a + 0.05 * (b - a) + inward, b - 0.05 * (b - a) + inward, sway=5, width=2)
    right = np.array((25, 40)) + 2 * wide
    polygon(axes, [right, right + deep, right + deep + (0, 135), right + (0, 135)], fill="#e5d4b0", edge="none")
    line(axes, right, right + deep, color=BASAL)
    line(axes, right + deep, right + deep + (0, 135), color=LATERAL)
    line(axes, right, right + (0, 135), color=LATERAL)
    nodes = [np.array((25, 175)) + k * wide + s * deep for k in range(3) for s in (0, 1)]
    dots(axes, nodes)
    arrow(axes, (32, 158), (92, 158))
    arrow(axes, (183, 158), (123, 158))
    label(axes, (107, 138), "$T$", FORCE, BIG)
    arrow(axes, (194, 158), (351, 158), TEXT, width=2, head=10, arrowstyle="<|-|>,head_length=0.3,head_width=0.17")
    label(axes, (272, 138), "$\\ell$", TEXT, BIG)
    leader(axes, (228, 275), (228, 210), APICAL, dot=False)
    label(axes, (228, 298), "shared edge: two springs", APICAL)
    label(axes, (107, 90), "cell 1")
    label(axes, (272, 90), "cell 2")
    curve = inset(figure, (515, 62, 230, 248), "edge length $\\ell$", "tension $T$")
    length = np.linspace(0, 3, 200)
    for a in (1, 0.5):
        curve.plot(length, a * (np.maximum(0, length - 1) + 0.7), color=APICAL, alpha=0.4 + 0.6 * (a == 1))
    curve.plot(length, length, color=TEXT, linewidth=2, linestyle=(0, (3, 2)))
    curve.set(xlim=(0, 3.3), ylim=(0, 3.2))
    curve.set_xticks([1], ["$U$"])
    curve.set_yticks([0.35, 0.7], ["$P/2$", "$P$"])
    label(curve, (2.85, 1.95), "$a=1$", APICAL)
    label(curve, (2.6, 0.8), "$a=0.5$", APICAL)
    label(curve, (1.25, 2.6), "default:\n$U=P=0$", TEXT)
    save(figure, "theory/contraction.svg")


def cortex():
    figure, axes = canvas(760, 320)
    tops, bottoms = [(30, 240), (115, 252), (205, 252), (290, 240)], [(20, 60), (110, 52), (210, 52), (300, 60)]
    for k in range(3):
        cell(axes, tops[k], tops[k + 1], bottoms[k + 1], bottoms[k], width=7)
    for (a, b), color in (((tops[1], tops[2]), APICAL), ((bottoms[1], bottoms[2]), BASAL), ((tops[1], bottoms[1]), LATERAL),
                          ((tops[2], bottoms[2]), LATERAL)):
        a, b = np.array(a, float), np.array(b, float)
        way = (b - a) / np.hypot(*(b - a))
        inside = np.array((160, 152)) - (a + b) / 2
        inside = inside / np.hypot(*inside) * 14
        skip = 36 if color == LATERAL else 14
        arrow(axes, a + inside + skip * way, a + inside + (skip + 28) * way, FORCE, head=13)
        arrow(axes, b + inside - skip * way, b + inside - (skip + 28) * way, FORCE, head=13)
    label(axes, (160, 285), "apical", APICAL)
    label(axes, (160, 24), "basal", BASAL)
    label(axes, (338, 150), "lateral", LATERAL)
    curve = inset(figure, (455, 62, 285, 245), "face area $A/A_0$", "tension $T$")
    area = np.linspace(0.05, 1.75, 400)
    active, elastic, crowding = area / (area + 0.25), 0.9 * (area - 1) * np.where(area < 1, 0.5, 1), -0.02 / area**2
    curve.axhline(0, color=FAINT, linewidth=1.5)
    for values, color, text, at in ((active, "#b7791f", "active", (1.45, 0.66)), (elastic, "#0e7c86", "elastic", (1.45, 0.12)),
                                    (crowding, "#9b2c6f", "crowding", (0.62, -0.62))):
        curve.plot(area, values, color=color, linewidth=2.5)
        label(curve, at, text, color)
    total = active + elastic + crowding
    curve.plot(area, total, color=TEXT, linewidth=4)
    label(curve, (1.02, 1.22), "total", TEXT)
    curve.set(xlim=(0, 1.78), ylim=(-0.85, 1.6))
    curve.set_xticks([0, 1], ["0", "1"])
    curve.set_yticks([0], ["0"])
    save(figure, "theory/cortex.svg")


def corotational():
    figure, axes = canvas(760, 310)
    square = 0.86 * SQUARE
    rest, here = square + (90, 150), np.array((365, 150))
    polygon(axes, rest)
    dots(axes, rest)
    label(axes, (90, 150), "rest\n$X_i$")
    label(axes, (205, 192), "turn by $R$")
    arrow(axes, (165, 150), (250, 150), TEXT)
    placed = turned(square, 35) + here
    now = turned(square * (1.2, 0.9) + [(-14, 4), (12, -12), (16, 8), (-14, 0)], 35) + here
    polygon(axes, now)
    polygon(axes, placed, fill="none", edge="#5a6b80", linestyle=(0, (4, 3)))
    for a, b in zip(placed, now):
        arrow(axes, a, b, LATERAL, head=12)
    dots(axes, now)
    label(axes, here, "$u_i$", LATERAL, BIG)
    label(axes, (380, 22), "strained by $u_i$ in the turned frame")
    here = np.array((625, 150))
    now = now - (365, 150) + here
    polygon(axes, now)
    for a, b in zip(placed - (365, 150) + here, now):
        arrow(axes, b, b + 2.2 * (a - b) + 0.01, FORCE, head=14)
    dots(axes, now)
    label(axes, here, "$f_i=-R\\,g_i$", FORCE)
    label(axes, (625, 22), "forces", FORCE)
    arrow(axes, (472, 150), (520, 150), TEXT)
    save(figure, "theory/corotational.svg")


def neo_hookean():
    figure, axes = canvas(760, 310)
    for x, (wide, high), (rest_wide, rest_high), text in (
            (70, (70, 110), (70, 110), "$t<0$"), (215, (125, 62), (70, 110), "$t=0$"), (392, (125, 62), (118, 66), "$t=3\\tau$")):
        for w, h, shape in ((wide, high, {}), (rest_wide, rest_high, {"fill": "none", "edge": FORCE, "linestyle": (0, (4, 3)),
                                                                     "width": 3})):
            polygon(axes, np.array([(-w, -h), (w, -h), (w, h), (-w, h)]) / 2 + (x, 165), **shape)
        label(axes, (x, 80), text)
        if wide > 100:
            arrow(axes, (x + wide / 2, 165), (x + wide / 2 + (24 if x < 300 else 10), 165), TEXT, head=12)
            arrow(axes, (x - wide / 2, 165), (x - wide / 2 - (24 if x < 300 else 10), 165), TEXT, head=12)
    label(axes, (215, 285), "cell")
    leader(axes, (215, 272), (190, 180), TEXT)
    label(axes, (200, 34), "rest shape $C_p$ follows the cell", FORCE)
    curve = inset(figure, (545, 62, 195, 225), "time", "stress")
    time = np.linspace(0, 3.4, 100)
    curve.plot([-0.8, 0], [0, 0], color=TEXT)
    curve.plot([0, *time], [0, *np.exp(-time)], color=TEXT)
    curve.set(xlim=(-0.8, 3.5), ylim=(-0.02, 1.15))
    curve.set_xticks([0, 1, 3], ["0", "$\\tau$", "$3\\tau$"])
    label(curve, (1.95, 0.72), "$e^{-t/\\tau}$", TEXT, BIG)
    label(curve, (1.95, 0.98), "small strain:", TEXT)
    save(figure, "theory/neo_hookean.svg")


def shape_memory():
    figure, axes = canvas(760, 320)
    rest, here = SQUARE + (120, 160), np.array((400, 160))
    polygon(axes, rest)
    dots(axes, rest)
    label(axes, (120, 160), "rest")
    arrow(axes, (205, 160), (270, 160), TEXT)
    now = turned(SQUARE * 1.05 + [(-55, -25), (45, 30), (45, 25), (-50, -38)], 20) + here
    placed = turned(SQUARE, 20) + here + np.mean(now - turned(SQUARE, 20) - here, axis=0)
    polygon(axes, now)
    polygon(axes, placed, fill=WHITE, edge="#5a6b80", linestyle=(0, (4, 3)), alpha=0.65)
    for a, b in zip(placed, now):
        spring(axes, a, b, FORCE, turns=4, sway=7)
    dots(axes, now)
    dots(axes, placed, "#5a6b80", 8)
    label(axes, np.mean(placed, axis=0), "attractor")
    leader(axes, (590, 262), now[2], TEXT)
    label(axes, (600, 262), "node $x_i$", ha="left")
    leader(axes, (590, 175), (placed[2] + now[2]) / 2, FORCE)
    label(axes, (600, 175), "spring\n$f_i=-k\\,d_i$", FORCE, ha="left")
    label(axes, (600, 85), "rest shape at\nbest-fit centre\nand rotation", "#5a6b80", ha="left", size=17)
    leader(axes, (590, 85), placed[1], "#5a6b80")
    save(figure, "theory/shape_memory.svg")


def corner_barrier():
    figure, axes = canvas(760, 300)
    for number, (ratio, text) in enumerate(((1, "1"), (0.15, "0.15"), (0.0, "0"))):
        x = 25 + 140 * number
        corner = np.array((50 + 50 * ratio, 50 + 50 * ratio)) + (x, 110)
        points = [np.array(p) + (x, 110) for p in ((0, 0), (100, 0))] + [corner, np.array((x, 210))]
        polygon(axes, points)
        dots(axes, [corner], APICAL, 12)
        line(axes, points[1], points[3], color="#5a6b80", width=1.5, linestyle=(0, (4, 3)), zorder=8)
        if ratio < 0.15:
            arrow(axes, corner, corner + (38, 38))
        label(axes, (x + 52, 78), text)
    label(axes, (217, 38), "corner Jacobian $J/J_0$")
    label(axes, (217, 262), "a corner becomes flat (dashed)", APICAL)
    curve = inset(figure, (510, 62, 230, 225), "$J/J_0$", "energy $E$")
    r = np.linspace(0.012, 2, 400)
    curve.plot(0.15 * r, np.where(r < 1, -(r - 1)**2 * np.log(r), 0), color=FORCE)
    curve.set(xlim=(0, 0.3), ylim=(-0.05, 3))
    curve.set_xticks([0, 0.15, 0.3], ["0", "0.15", "0.3"])
    label(curve, (0.165, 2.2), "$-(r-1)^2\\,\\ln\\,r$", FORCE)
    label(curve, (0.165, 1.5), "$r=J/(0.15J_0)$", FORCE)
    save(figure, "theory/corner_barrier.svg")


def cell_volume():
    figure, axes = canvas(760, 330)
    cell(axes, (75, 250), (165, 250), (165, 80), (75, 80))
    arrow(axes, (200, 165), (275, 165), TEXT)
    left, right = [(350, 285), (332, 89)], [(410, 285), (428, 89)]  # of the same area
    cell(axes, left[0], right[0], right[1], left[1])
    centre = np.array((380, 180))
    for at, way in (((380, 285), (0, 1)), ((380, 85), (0, -1)), ((420, 185), (1, 0.1)), ((340, 185), (-1, 0.1)),
                    ((425, 130), (1, 0.1)), ((335, 130), (-1, 0.1)), ((415, 240), (1, 0.1)), ((345, 240), (-1, 0.1))):
        arrow(axes, np.array(at) - 2 * np.array(way), np.array(at) + 36 * np.array(way), FORCE, head=14)
    label(axes, centre, "$\\lambda_c$", FORCE, BIG)
    label(axes, (120, 165), "$V_c$", TEXT, BIG)
    label(axes, (120, 35), "reference")
    label(axes, (380, 22), "narrow apex, same volume")
    label(axes, (520, 225), "cell pressure $\\lambda_c$", FORCE, ha="left")
    label(axes, (520, 185), "so large that", ha="left")
    label(axes, (520, 145), "$V_c(x)=V_c^{\\,\\mathrm{target}}$", ha="left", size=BIG)
    save(figure, "theory/cell_volume.svg")


def vitelline():
    figure, axes = canvas(760, 300)
    centre, radius = np.array((230, -438)), 680
    places = [np.radians(90 + w) for w in (16, 9.6, 3.2, -3.2, -9.6, -16)]
    gaps = [0, 0, 0, 30, 48, 24]

    def at(w, r):
        return centre + r * np.array((np.cos(w), np.sin(w)))
    apex = [at(w, radius - g) for w, g in zip(places, gaps)]
    base = [at(w, radius - 160) for w in places]
    for k in range(5):
        cell(axes, apex[k], apex[k + 1], base[k + 1], base[k], width=4)
    line(axes, *(at(w, radius + 5) for w in np.radians(np.linspace(110, 70, 60))), color=VITELLINE, width=10)
    for k in range(3):
        arrow(axes, apex[k], at(places[k], radius - 70))
    dots(axes, apex)
    arrow(axes, at(places[4], radius), at(places[4], radius - 46), TEXT, head=10, arrowstyle="<|-|>,head_length=0.3,head_width=0.17")
    label(axes, at(np.radians(77.8), radius - 25), "$g$", TEXT, BIG)
    label(axes, (146, 150), "$N$", FORCE, BIG, rim=CELL)
    label(axes, (230, 278), "vitelline membrane", VITELLINE)
    curve = inset(figure, (540, 62, 200, 225), "gap $g$", "contact force $N$")
    curve.plot([0, 0, 1], [1, 0, 0], color=FORCE, linewidth=6, clip_on=False, solid_capstyle="round")
    curve.set(xlim=(0, 1), ylim=(0, 1))
    label(curve, (0.07, 0.7), "in contact", FORCE, ha="left")
    label(curve, (0.55, 0.12), "free", FORCE)
    save(figure, "theory/vitelline.svg")


def shell_drag():
    figure, axes = canvas(760, 290)
    polygon(axes, [(20, 232), (450, 232), (450, 258), (20, 258)], fill=VITELLINE, edge="none")
    polygon(axes, [(20, 178), (450, 178), (450, 232), (20, 232)], fill="#dbe7f5", edge="none")
    for x, drop in ((60, 30), (160, 22), (260, 28)):
        cell(axes, (x, 232 - drop), (x + 100, 232 - (22 if x < 150 else 28 if x < 250 else 40)), (x + 100, 60), (x, 60), width=4)
    dots(axes, [(260, 204)])
    arrow(axes, (260, 204), (345, 204), TEXT)
    label(axes, (365, 207), "$v$", TEXT, BIG)
    arrow(axes, (260, 204), (175, 204))
    label(axes, (235, 276), "vitelline membrane", VITELLINE)
    label(axes, (408, 205), "film", BASAL)
    label(axes, (235, 30), "force  $f=-c\\,A\\,\\phi(g)\\,T\\,v$", FORCE)
    curve = inset(figure, (540, 62, 200, 205), "gap $g$", "drag factor $\\phi$")
    curve.plot([-0.6, 0, 1, 2], [1, 1, 0, 0], color=FORCE)
    curve.set(xlim=(-0.6, 2), ylim=(0, 1.15))
    curve.set_xticks([0, 1], ["0", "$w$"])
    curve.set_yticks([0, 1], ["0", "1"])
    save(figure, "theory/shell_drag.svg")


def coulomb():
    figure, axes = canvas(760, 320)
    polygon(axes, [(20, 30), (390, 30), (390, 80), (20, 80)], fill="#e2e8f0", edge="none")
    line(axes, (20, 80), (390, 80), color=VITELLINE, width=4)
    polygon(axes, [(110, 82), (300, 82), (300, 190), (110, 190)])
    axes.add_patch(Wedge((205, 82), 150, 90 - 27, 90 + 27, facecolor=FORCE, alpha=0.22, edgecolor="none", zorder=5))
    arrow(axes, (205, 82), (205, 220), FORCE)
    label(axes, (205, 244), "$N$", FORCE, BIG)
    arrow(axes, (205, 82), (135, 82), FORCE)
    label(axes, (85, 108), "$\\mu N$", FORCE, BIG)
    arrow(axes, (300, 136), (368, 136), TEXT)
    label(axes, (380, 136), "$v$", TEXT, BIG)
    label(axes, (345, 238), "cone of\nallowed forces", FORCE)
    curve = inset(figure, (500, 62, 240, 240), "sliding speed $v$", "friction")
    v = np.linspace(0, 3, 200)
    curve.plot(v, np.where(v < 1, 2 * v - v**2, 1), color=FORCE)
    curve.axvspan(0, 1, color="#e2e8f0")
    curve.set(xlim=(0, 3), ylim=(0, 1.25))
    curve.set_xticks([1], ["$s$"])
    curve.set_yticks([0, 1], ["0", "$\\mu N$"])
    label(curve, (0.5, 0.14), "creeps", rim="#e2e8f0")
    label(curve, (2.1, 0.14), "slides")
    save(figure, "theory/coulomb.svg")


def self_contact():
    figure, axes = canvas(760, 540)
    left = [(40, 510), (120, 482), (168, 415), (178, 330), (150, 260)]
    right = [(420, 510), (335, 485), (280, 405), (266, 300), (300, 260)]
    polygon(axes, [(20, 510), *left, (20, 260)], edge="none")
    polygon(axes, [(440, 510), *right, (440, 260)], edge="none")
    line(axes, *left, color=APICAL, width=5)
    line(axes, *right, color=APICAL, width=5)
    dots(axes, left[1:4] + right[1:4], TEXT, 8)

    def push(point, one, other, on_q=True):
        """The nearest place q of a point on a segment, and forces on both."""
        point, one, other = (np.array(x, float) for x in (point, one, other))
        way = (other - one) / np.hypot(*(other - one))
        foot = one + way * np.dot(point - one, way)
        line(axes, foot, point, color=TEXT, width=2, linestyle=(0, (2, 2)))
        dots(axes, [foot], WHITE, 10, markeredgecolor=TEXT, markeredgewidth=2)
        length = 58 * (point - foot) / np.hypot(*(point - foot))
        arrow(axes, point, point + length)
        if on_q:
            arrow(axes, foot, foot - length)
        return point, foot
    point, foot = push(right[2], left[2], left[3])
    label(axes, point + (6, 30), "$p$", TEXT, BIG)
    label(axes, foot + (-18, 24), "$q$", TEXT, BIG)
    label(axes, (point + foot) / 2 + (0, 17), "$g$", TEXT, BIG)
    point, foot = push(left[3], right[2], right[3])
    label(axes, point + (-26, -22), "$p$", TEXT, BIG)
    label(axes, foot + (18, -26), "$q$", TEXT, BIG)
    label(axes, (72, 425), "facet")
    leader(axes, (104, 428), (138, 452), TEXT, dot=False)
    label(axes, (228, 526), "two lips of a furrow", APICAL)

    # Three cases.
    line(axes, (20, 232), (740, 232), color=FAINT, width=1.5)
    polygon(axes, [(20, 150), (128, 65), (236, 150), (236, 50), (20, 50)], edge="none")
    line(axes, (20, 150), (128, 65), (236, 150), color=APICAL, width=4)
    polygon(axes, [(70, 215), (128, 110), (186, 215)], edge="none")
    line(axes, (70, 215), (128, 110), (186, 215), color=APICAL, width=4)
    for one, other in (((20, 150), (128, 65)), ((128, 65), (236, 150))):
        push((128, 110), one, other, on_q=False)
    dots(axes, [(128, 110)], TEXT, 9)
    label(axes, (128, 24), "ridge: two places")

    polygon(axes, [(275, 125), (485, 125), (485, 50), (275, 50)], edge="none")
    line(axes, (275, 125), (485, 125), color=APICAL, width=4)
    polygon(axes, [(325, 215), (380, 95), (435, 215)], edge="none", alpha=0.8)
    line(axes, (325, 215), (380, 95), (435, 215), color=APICAL, width=4)
    arrow(axes, (380, 95), (380, 165))
    dots(axes, [(380, 95)], TEXT, 9)
    dots(axes, [(380, 125)], WHITE, 10, markeredgecolor=TEXT, markeredgewidth=2)
    label(axes, (432, 92), "$g<0$", TEXT, BIG)
    label(axes, (380, 24), "behind: pushed out")

    polygon(axes, [(525, 130), (722, 145), (630, 60)], edge="none", fill="#eab0a0", alpha=0.7)
    polygon(axes, [(525, 130), (722, 145), (600, 215)], edge="none", fill="#eab0a0", alpha=0.7)
    polygon(axes, [(570, 55), (680, 215), (740, 110)], edge="none", fill=CELL, alpha=0.85)
    polygon(axes, [(570, 55), (680, 215), (545, 190)], edge="none", fill=CELL, alpha=0.85)
    line(axes, (525, 130), (722, 145), color=APICAL, width=4)
    line(axes, (570, 55), (680, 215), color=APICAL, width=4)
    dots(axes, [(625, 137)], WHITE, 11, markeredgecolor=TEXT, markeredgewidth=2, zorder=10)
    label(axes, (540, 148), "$a$", TEXT, BIG)
    label(axes, (668, 170), "$b$", TEXT, BIG)
    label(axes, (632, 24), "edges, from above")

    curve = inset(figure, (525, 300, 215, 225), "gap $g$", "pressure")
    curve.plot([-0.25, 1, 1.6], [1.25, 0, 0], color=FORCE)
    curve.plot([-0.25, 0.5, 1.6], [0.75, 0, 0], color="#b7791f", linestyle=(0, (3, 2)))
    curve.axvline(0, color=FAINT, linewidth=1.5)
    curve.set(xlim=(-0.25, 1.6), ylim=(-0.02, 1.3))
    curve.set_xticks([0, 0.5, 1], ["0", "$d/2$", "$d$"])
    label(curve, (1.0, 0.95), "points of one\nside: $k\\,(d-g)$", FORCE)
    label(curve, (1.25, 0.3), "edges", "#b7791f")
    curve.plot([1.0, 0.3], [0.28, 0.21], color="#b7791f", linewidth=1.5)
    save(figure, "theory/self_contact.svg")


def enclosed_volume():
    figure, axes = canvas(760, 330)
    axes.add_patch(plt.Circle((200, 165), 105, facecolor=YOLK, edgecolor="none"))
    ring(axes, (200, 165), 105, 150)
    for w in np.radians(np.arange(0, 360, 45)):
        way = np.array((np.cos(w), np.sin(w)))
        arrow(axes, (200, 165) + 62 * way, (200, 165) + 100 * way, FORCE, head=14)
    label(axes, (200, 165), "$V,\\ p$", TEXT, BIG, rim=YOLK)
    for y, name, law in ((235, "held", "$V=V_0$,  $p$ is the multiplier"), (125, "compliant", "$p=K\\,(1-V/V_0)$")):
        label(axes, (400, y), name, FORCE, ha="left")
        label(axes, (400, y - 36), law, ha="left")
    leader(axes, (392, 292), (250, 210), TEXT)
    label(axes, (400, 292), "yolk or lumen", ha="left")
    save(figure, "theory/enclosed_volume.svg")


def surroundings():
    figure, axes = canvas(760, 280)
    for x, title, formula, color in ((130, "drag", "$-c_i\\,v_i$", TEXT), (380, "inertia", "$-m_i\\,\\dot v_i,\\ m_i=\\rho V_e/8$", TEXT),
                                     (630, "pressure", "$-p\\int N_i\\,n\\,dA$", TEXT)):
        if title == "drag":
            polygon(axes, [(x - 105, 60), (x + 105, 60), (x + 105, 225), (x - 105, 225)], fill="#dbe7f5", edge="none")
        cell(axes, (x - 45, 190), (x + 45, 190), (x + 45, 80), (x - 45, 80))
        label(axes, (x, 255), title)
        label(axes, (x, 32), formula, FORCE, 18)
    for y in (190, 80):
        arrow(axes, (85, y), (35, y))
        arrow(axes, (175, y), (125, y))
    arrow(axes, (160, 135), (222, 135), TEXT)
    label(axes, (140, 135), "$v$", TEXT, BIG)
    for x in (335, 425):
        for y in (80, 190):
            dots(axes, [(x, y)], TEXT, 20)
    for x in (592, 630, 668):
        arrow(axes, (x, 236), (x, 194), FORCE, head=14)
    save(figure, "theory/surroundings.svg")


def foundation():
    figure, axes = canvas(760, 300)
    polygon(axes, [(20, 20), (470, 20), (470, 70), (20, 70)], fill="#e2e8f0", edge="none")
    line(axes, (20, 70), (470, 70), color=FAINT, width=3)
    for x, low, next_low in ((50, 150, 108), (180, 108, 108), (310, 108, 150)):
        cell(axes, (x, low + 120), (x + 130, next_low + 120), (x + 130, next_low), (x, low), width=4)
        line(axes, (x, low), (x + 130, next_low), color=BASAL, width=4)
    for x, low in ((50, 150), (180, 108), (310, 108), (440, 150)):
        spring(axes, (x - 9, 70), (x - 9, low), sway=6, width=2)
        dots(axes, [(x, 70)], TEXT, 18)
        dots(axes, [(x, low)])
        arrow(axes, (x + 9, 70), (x + 9, low), TEXT, width=2, head=9)
    label(axes, (466, 108), "$d$", TEXT, BIG)
    label(axes, (245, 44), "anchors: reference positions", TEXT)
    label(axes, (245, 168), "cells")
    curve = inset(figure, (545, 62, 200, 220), "displacement along $n$", "pressure on the face")
    d = np.linspace(-1, 1, 100)
    curve.plot(d, d, color=FORCE)
    curve.plot(d, np.maximum(0, d), color=APICAL, linestyle=(0, (4, 3)))
    curve.axhline(0, color=FAINT, linewidth=1)
    curve.set(xlim=(-1, 1), ylim=(-1.05, 1.15))
    curve.set_xticks([0], ["0"])
    curve.set_yticks([0], ["0"])
    label(curve, (0.38, 0.75), "$k\\,d$", FORCE)
    label(curve, (-0.45, 0.2), "one-sided", APICAL)
    save(figure, "theory/foundation.svg")


def matrix():
    figure, axes = canvas(760, 300)
    place = np.linspace(30, 450, 8)
    base = 175 - 105 * np.exp(-((place - 240) / 80) ** 2)
    layer = np.linspace(30, 450, 200)
    below = np.interp(layer, place, base) - 12
    for k in range(7):
        tops = [(x, y + 80) for x, y in zip(place, base)]
        cell(axes, tops[k], tops[k + 1], (place[k + 1], base[k + 1]), (place[k], base[k]), width=3)
    for part, how in ((layer < 175, {}), (layer > 305, {}), ((layer > 175) & (layer < 305), {"linestyle": (0, (1, 1.2)), "alpha": 0.6})):
        line(axes, *zip(layer[part], below[part]), color=LAYER, width=6, **{"solid_capstyle": "butt", **how})
    label(axes, (88, 110), "layer", LAYER)
    label(axes, (240, 22), "digested: program, region", LAYER)
    label(axes, (240, 118), "cells")
    curve = inset(figure, (545, 62, 200, 220), "stretch $\\lambda$", "force / reference width")
    stretch = np.linspace(0.9, 2, 100)
    curve.axhline(0, color=FAINT, linewidth=1)
    curve.plot(stretch, stretch - stretch**-5, color=LAYER)
    curve.plot(stretch, stretch - stretch**-2, color=APICAL)
    curve.set(xlim=(0.9, 2), ylim=(-0.6, 2.1))
    curve.set_xticks([1], ["1"])
    curve.set_yticks([0, 1], ["0", "$\\mu h$"])
    label(curve, (1.3, 1.7), "in all\ndirections", LAYER)
    label(curve, (1.65, 0.7), "in one", APICAL)
    save(figure, "theory/matrix.svg")


LAWS = (contraction, cortex, corotational, neo_hookean, shape_memory, corner_barrier, cell_volume, vitelline, shell_drag, coulomb, self_contact, enclosed_volume, surroundings, foundation, matrix)

if __name__ == "__main__":
    for law in LAWS:
        if len(sys.argv) == 1 or law.__name__ in sys.argv[1:]:
            law()
