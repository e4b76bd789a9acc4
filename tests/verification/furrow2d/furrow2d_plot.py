#!/usr/bin/env python3
"""Draws depths and heights over time in both programs, the picture of docs/developers/furrow2d.md.

    furrow2d_plot.py PLICA PNG
"""
import concurrent.futures
import os
import pathlib
import sys
import tomllib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from furrow2d_test import here, kept, run

ablations = ["reference", "basal soft from the start", "yolk free", "gap 0.25 um", "mu x 5", "mu x 20", "drag x 5", "no lateral rise",
             "uniform over 18 cells, same total", "basal tension kept high"]
shut_off = [f"apical off at {t} min" for t in (3, 5, 6, 6.5, 7, 8)]
colours = plt.get_cmap("tab10").colors


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    plica = str(pathlib.Path(sys.argv[1]).resolve())
    cases = {case["name"]: case for case in tomllib.loads((here / "cases.toml").read_text())["case"]}
    truth = kept()
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        names = list(dict.fromkeys(ablations + shut_off))
        found = dict(zip(names, pool.map(lambda name: run(plica, cases[name]), names)))

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.6), width_ratios=(1, 1.3, 0.9), layout="constrained")

    def pair(axes, times, line, dots, dot_times, colour, label):
        axes.plot(times, line, color=colour, lw=1.6, label=label)
        axes.plot(dot_times, dots, "o", color=colour, ms=3, mfc="none", mew=0.9)

    reference, other = found["reference"], truth["reference"]["plica's"]
    pair(left, reference.times, reference.depths, other.depths, other.times, colours[0], "depth of the furrow")
    heights = truth["reference, height"]["plica's"]
    pair(left, reference.times, reference.heights, heights.depths[1:], heights.times[1:], colours[1], "height of the middle cells")
    itself = truth["reference"]["its own"]
    left.plot(itself.times, itself.depths, ":", color="0.45", lw=1.2, label="depth, furrow2d with its own laws")
    left.set_title("Reference")
    for number, name in enumerate(ablations):
        course, other = found[name], truth[name]["plica's"]
        pair(middle, course.times, course.depths, other.depths, other.times, colours[number], name)
    middle.set_title("With something changed")
    for number, name in enumerate(shut_off):
        course, other = found[name], truth[name]["plica's"]
        shown = [t for t in other.times if t <= course.times[-1]]
        pair(right, course.times, course.depths, other.depths[:len(shown)], shown, colours[number], name)
    right.set_title("Apical contraction shut off")
    for axes in (left, middle, right):
        axes.set_xlabel("time (min)")
        axes.set_ylabel("depth (µm)" if axes is not left else "µm")
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(fontsize=7, frameon=False)
    figure.suptitle("Lines: plica. Circles: furrow2d with the laws that plica has.", fontsize=10)
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()
