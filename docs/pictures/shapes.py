"""Shapes that several drawings share: cells in section, springs, frames of curves."""
import numpy as np
from matplotlib.patches import Polygon

from style import APICAL, BASAL, CELL, LATERAL, TEXT


def inset(figure, box, across, up):
    """Axes of a curve in the box (left, bottom, width, height), in pixels, with the names of both axes."""
    width, height = figure.get_size_inches() * 72
    axes = figure.add_axes((box[0] / width, box[1] / height, box[2] / width, box[3] / height))
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.set_xticks([])
    axes.set_yticks([])
    return axes


def polygon(axes, points, fill=CELL, edge=TEXT, width=2, **how):
    axes.add_patch(Polygon(points, closed=True, facecolor=fill, edgecolor=edge, linewidth=width, joinstyle="round", **how))


def line(axes, *points, color=TEXT, width=2, **how):
    axes.plot(*zip(*points), color=color, linewidth=width, **{"solid_capstyle": "round", **how})


def dots(axes, points, color=TEXT, size=9, **how):
    axes.plot(*zip(*points), "o", color=color, markersize=size, **{"zorder": 9, **how})


def spring(axes, start, end, color=APICAL, turns=6, sway=8, width=2.5):
    start, end = np.array(start, float), np.array(end, float)
    along = end - start
    across = np.array([-along[1], along[0]]) / np.hypot(*along) * sway
    places = [0, 0.15, *(0.15 + 0.7 * (np.arange(2 * turns) + 0.5) / (2 * turns)), 0.85, 1]
    signs = [0, 0, *(np.tile([1, -1], turns)), 0, 0]
    line(axes, *(start + p * along + s * across for p, s in zip(places, signs)), color=color, width=width, zorder=6)


def cell(axes, apex_left, apex_right, base_right, base_left, width=5):
    """Section of a cell with coloured apical, basal and lateral faces."""
    polygon(axes, [apex_left, apex_right, base_right, base_left], edge="none")
    line(axes, apex_left, base_left, color=LATERAL, width=width)
    line(axes, apex_right, base_right, color=LATERAL, width=width)
    line(axes, base_left, base_right, color=BASAL, width=width)
    line(axes, apex_left, apex_right, color=APICAL, width=width)


def turned(points, degrees, about=(0, 0)):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return (np.array(points, float) - about) @ np.array([[c, s], [-s, c]]) + about


def ring(axes, centre, inner, outer, begin=0, end=360, cells=24, alpha=1.0):
    """Section of an embryo, apical side outside; angles in degrees from the right, counter-clockwise."""
    for a, b in zip(*(lambda e: (e[:-1], e[1:]))(np.radians(np.linspace(begin, end, cells + 1)))):
        at = [(centre[0] + r * np.cos(w), centre[1] + r * np.sin(w)) for r, w in
              ((outer, a), (outer, b), (inner, b), (inner, a))]
        polygon(axes, at, edge="none", alpha=alpha)
        for one, other, color in ((0, 3, LATERAL), (1, 2, LATERAL), (2, 3, BASAL), (0, 1, APICAL)):
            line(axes, at[one], at[other], color=color, width=2.5, alpha=alpha)


def plain(axes, at, text, color=TEXT, size=17, **how):
    """Text without a rim, on an even ground."""
    axes.text(*at, text, color=color, fontsize=size, zorder=10, **{"ha": "center", "va": "center", "linespacing": 1.15, **how})
