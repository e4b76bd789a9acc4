#!/usr/bin/python3
"""Score readings of the paper, and the errors of ours: reproduction-readings.csv and reproduction-errors.csv beside this script.

Usage: readings.py OUT. Each reading is the scenario drosophila with some keys changed, as a pill and as a sphere of the same cells;
runs that are not in OUT are made there by `plica` (or the program that PLICA names), in minutes.
"""
import csv
import json
import math
import os
import subprocess
import sys
from pathlib import Path

PLICA = os.environ.get("PLICA", "plica")
COARSE = ["time.tolerance_um=0.05"]
COMMON = ["time.integrator=bdf2", "output.frame_every_s=0", "output.cells_csv=false"]
SPHERE = ["embryo.shape=sphere", "embryo.cells=[9,9,8]", "region.furrow.cells_along=7"]
ACROSS, ROWS, NO_SHELL = "contraction.apical.across_ratio=", "region.furrow.cells_across=", "vitelline.enabled=false"
STIFFNESS, PRELOAD = "contraction.apical.stiffness_nN_per_um=", "contraction.apical.preload_nN="
LARGEST_MISS = 5


def springs(k, *keys):
    """Springs of stiffness k with a proportional preload."""
    return [*keys, f"{STIFFNESS}{k:g}", f"{PRELOAD}{60 / 4.82 * k:.4g}"]


def ramp(end_s):
    return [f"contraction.apical.program.time_s=[0,{end_s}]", "contraction.apical.program.activity=[0,1]"]


def algorithm(step_s):
    return ["volume.method=projection", "time.scheme=linearly-implicit", "time.integrator=backward-euler", f"time.step_s={step_s}"]


CLOCK = ["dynamics.surface_drag_Pa_s_per_um=2870", "time.end_min=900"]
# What is varied, the reading, its keys. Stiffness is fitted to a depth of 28.89 um at equilibrium with the other keys of the row
# (`plica calibrate drosophila --vary ... --target furrow_depth_um=28.89`), except where springs are as chosen.
READINGS = [
    ("chosen", "5 rows, across/along 0.35, k = 4.82, preload 60, drag 131, step on", []),
    ("across/along", "0.2 (k = 6.86)", springs(6.86, ACROSS + "0.2")),
    ("across/along", "0.3 (k = 5.34)", springs(5.34, ACROSS + "0.3")),
    ("across/along", "0.4 (k = 4.395)", springs(4.395, ACROSS + "0.4")),
    ("across/along", "0.6 (k = 3.295)", springs(3.295, ACROSS + "0.6")),
    ("across/along", "1, equal springs (k = 2.17)", springs(2.17, ACROSS + "1")),
    ("across/along", "0, axial springs only (k = 9.64)", springs(9.64, ACROSS + "0")),
    ("across/along", "0, axial springs only (k = 14.46)", springs(14.46, ACROSS + "0")),
    ("preload", "none (k = 7.99)", [STIFFNESS + "7.99", PRELOAD + "0"]),
    ("preload", "nothing else: constant forces of 152.5 nN", [STIFFNESS + "0", PRELOAD + "152.5"]),
    ("rows", "3 rows (k = 7.635)", springs(7.635, ROWS + "3")),
    ("rows", "7 rows (k = 4.31)", springs(4.31, ROWS + "7")),
    ("rows", "3 rows, equal springs, k as chosen", [ROWS + "3", ACROSS + "1"]),
    ("activation", "ramp of 10 s", ramp(10)),
    ("activation", "ramp of 30 s", ramp(30)),
    ("activation", "ramp of 60 s", ramp(60)),
    ("clock", "drag 2870: equal speeds at 15 min", CLOCK),
    ("clock", "the same, to rest by a stop slower in proportion, 0.0091 um/min", [*CLOCK, "stop.equilibrium_speed_um_per_min=0.0091"]),
    ("VCE", "the last cell of the rows", ["furrow.vce_cell=1"]),
    ("VCE", "the third-last cell", ["furrow.vce_cell=3"]),
    ("depth", "from the lips down, springs as chosen", []),
    ("depth", "from the lips down, graded contraction over 7 rows and shortening cells (`drosophila-deep`)", []),
    ("shell", "none, springs as chosen", [NO_SHELL]),
    ("shell", "none (k = 3.33)", springs(3.33, NO_SHELL)),
    ("diagonals", "also the two diagonals of each facet (k = 2.07)", springs(2.07, "contraction.apical.diagonals=true")),
    ("volume", "not held, Poisson's ratio 0.45 (k = 4.61)", springs(4.61, "volume.method=none")),
    ("algorithm", "the paper's: linear solve, then projection; step 20 s", algorithm(20)),
    ("algorithm", "the same, step 5 s", algorithm(5)),
    ("elasticity", "discrete shape memory (k = 5.53)", springs(5.53, "elasticity.model=shape-memory")),
    ("Poisson's ratio", "0.3 (k = 4.45)", springs(4.45, "elasticity.poisson_ratio=0.3")),
    ("Poisson's ratio", "0.49 (k = 5.06)", springs(5.06, "elasticity.poisson_ratio=0.49")),
]
# Printed numbers (embryo, key, middle, tolerance): sections 3.1, 3.2, 2.3 and 4.
NUMBERS = [
    ("pill", "depth", 28.89, 0.05 * 28.89), ("sphere", "depth", 27.44, 0.05 * 27.44), ("pill", "area_loss", 30, 5),
    ("pill", "peak_speed_ratio", 3.65, 0.15 * 3.65), ("sphere", "peak_speed_ratio", 1.23, 0.15 * 1.23),
    ("pill", "vml_displacement_at_equal_speed_um", 8.5, 1.5), ("pill", "vce_displacement_at_equal_speed_um", 15, 2),
    ("pill", "rest_min", 15, 0.75), ("pill", "ends_lead_until_s", 900, 45), ("pill", "peak_speed_ratio_time_s", 30, 15),
    ("sphere", "peak_speed_ratio_time_s", 30, 15),
]
COLUMNS = [
    ("depth, um: pill, sphere", [("pill", "depth"), ("sphere", "depth")]),
    ("pill below lips, um", [("pill", "furrow_depth_below_lips_um")]),
    ("VML area loss, %", [("pill", "area_loss")]),
    ("speed ratio: pill, sphere", [("pill", "peak_speed_ratio"), ("sphere", "peak_speed_ratio")]),
    ("VML, VCE at equal speeds, um", [("pill", "vml_displacement_at_equal_speed_um"), ("pill", "vce_displacement_at_equal_speed_um")]),
    ("pill at rest, min", [("pill", "rest_min")]),
    ("speeds equal, s", [("pill", "ends_lead_until_s")]),
    ("largest difference, s: pill, sphere", [("pill", "peak_speed_ratio_time_s"), ("sphere", "peak_speed_ratio_time_s")]),
]
HEADLINES = [
    ("depth from the shell, um", "28.89; 27.44", "depth"), ("area loss of VML, %", "30; –", "area_loss"), ("at rest, min", "15; –", "rest_min"),
    ("speed ratio at the largest difference", "3.65; 1.23", "peak_speed_ratio"),
    ("VML displaced at equal speeds, um", "7–10; –", "vml_displacement_at_equal_speed_um"),
    ("VCE displaced at equal speeds, um", "13–17; –", "vce_displacement_at_equal_speed_um"),
]


def numbers_of(out, name, scenario, keys, below_lips=False):
    """Numbers of a run at rest; None where it failed."""
    folder = out / name
    if not (folder / "summary.json").exists():
        settings = [word for key in COMMON + keys for word in ("--set", key)]
        subprocess.run([PLICA, "run", scenario, *settings, "--out", folder, "--quiet", "--overwrite"], check=False)
    summary = json.loads((folder / "summary.json").read_text())
    if summary["status"] not in ("equilibrium", "end_time"):
        return {}
    summary["depth"] = summary["furrow_depth_below_lips_um" if below_lips else "furrow_depth_um"]
    summary["area_loss"] = 100 * (1 - summary["vml_apical_area_ratio"])
    rest_s = summary["equilibrium_time_s"]
    summary["rest_min"] = None if rest_s is None else rest_s / 60
    return summary


def shown(value, form=".4g"):
    return "–" if value is None else format(value + 0, form)


def score(embryos):
    """Root mean square of the deviations in tolerances, each at most LARGEST_MISS, and how many are at most 1."""
    values = [(embryos[embryo].get(key), middle, half) for embryo, key, middle, half in NUMBERS]
    misses = [LARGEST_MISS if value is None else min(LARGEST_MISS, abs(value - middle) / half) for value, middle, half in values]
    return math.sqrt(sum(miss * miss for miss in misses) / len(misses)), sum(miss <= 1 for miss in misses)


def rows_of_readings(out):
    for number, (group, text, keys) in enumerate(READINGS):
        below, deep = group == "depth", "deep" in text
        scenario = "drosophila-deep" if deep else "drosophila"
        sphere = SPHERE + (["region.floor.cells_along=7"] if deep else [])
        embryos = {embryo: numbers_of(out, f"{number}-{embryo}", scenario, COARSE + keys + more, below)
                   for embryo, more in (("pill", []), ("sphere", sphere))}
        rms, met = score(embryos)
        values = [", ".join(shown(embryos[embryo].get(key)) for embryo, key in parts) for _, parts in COLUMNS]
        yield rms, [group, text, f"{rms:.2f}", f"{met} of {len(NUMBERS)}", *values]


def rows_of_errors(out):
    runs = {(embryo, which): numbers_of(out, f"{which}-{embryo}", scenario, keys)
            for embryo, scenario in (("pill", "drosophila"), ("sphere", "xenopus"))
            for which, keys in (("ours", ["time.tolerance_um=0.02", "output.frame_every_s=60"]), ("coarse", COARSE), ("fine-time", ["time.tolerance_um=0.005"]),
                                ("fine-space", [*COARSE, "embryo.elements_per_cell=[2,2,2]"]))}
    for text, printed, key in HEADLINES:
        row = [text, printed]
        for embryo in ("pill", "sphere"):
            value = {which: runs[embryo, which].get(key) for which in ("ours", "coarse", "fine-time", "fine-space")}
            row += [shown(value["ours"]), *(shown(None if value[fine] is None else value[fine] - value[coarse], "+.2g")
                                            for fine, coarse in (("fine-space", "coarse"), ("fine-time", "ours")))]
        yield row


def write(name, header, rows):
    with Path(__file__).with_name(name).open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


def main():
    out = Path(sys.argv[1])
    paper = ["", "the paper", "0", f"{len(NUMBERS)} of {len(NUMBERS)}", "28.89, 27.44", "", "30", "3.65, 1.23", "7–10, 13–17", "15", "900", "30, 30"]
    readings = [row for _, row in sorted(rows_of_readings(out), key=lambda one: one[0])]
    write("reproduction-readings.csv", ["varied", "reading", "score", "met", *(name for name, _ in COLUMNS)], [paper, *readings])
    errors = ["error in space", "error in time"]
    write("reproduction-errors.csv", ["headline", "printed (pill; sphere)", "pill", *errors, "sphere", *errors], rows_of_errors(out))


if __name__ == "__main__":
    main()
