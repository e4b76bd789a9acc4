#!/usr/bin/python3
"""Put the results of `plica reproduce paper` into docs/science/reproduction.md.

Usage: update_reproduction.py DIR, the --out directory of a full (not --quick) run. Needs Matplotlib, and `plica` (or the program that
PLICA names). Written are docs/science/reproduction.csv, the page's table between <!-- errors --> (from
reproduction-errors.csv, by docs/science/readings.py) and <!-- end -->, the counts of verdicts on three pages, and docs/images/reproduction/.
"""
import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

SCIENCE = Path(__file__).resolve().parent.parent / "docs/science"
PAGE, IMAGES = SCIENCE / "reproduction.md", SCIENCE.parent / "images/reproduction"
COUNTS = {PAGE: "Of {} claims, {} are reproduced, {} under this reading, and {} are not",
          SCIENCE / "README.md": "of {}, {} hold, {} under one reading, {} do not",
          SCIENCE.parent / "developers/verification.md": "{} claims of Demongeot et al. (2016) | {} hold, {} under one reading, {} do not"}
VERDICTS = ("reproduced", "under this reading", "not reproduced")
SUBJECTS = ("2.1", "2.3", "2.5", "2.6", "2.7", "3.1", "3.2", "3.3", "4", "5", "note")  # sections of the paper, in order
# Outcomes beside their printed value, for the trade-off.
LINES = {("pill", "peak-ratio"): ("pill's speed ratio / 3.65", 3.65), ("sphere", "peak-ratio"): ("sphere's speed ratio / 1.23", 1.23),
         ("sphere", "depth"): ("sphere's depth / 27.44 µm", 27.44), ("pill", "vce-at-equal-speeds"): ("VCE at equal speeds / 15 µm", 15),
         ("pill", "vml-at-equal-speeds"): ("VML at equal speeds / 8.5 µm", 8.5), ("pill", "area-loss"): ("VML area loss / 30 %", 30)}
RATIOS = (0.35, 0.2, 0.3, 0.4, 0.6, 1)  # of the draws, which are 5 rows


def read(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def subject_of(source):
    return re.match(r"note|\d(\.\d)?", source)[0]


def table(header, rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [header, ["---"] * len(header), *rows]) + "\n"


def fill(page, name, text):
    """The page with this text between the marker of that name and its end."""
    filled, count = re.subn(rf"(<!-- {name} -->\n).*?(?=<!-- end -->)", lambda found: f"{found[1]}\n{text}\n", page, flags=re.S)
    if count != 1:
        sys.exit(f"{PAGE}: no text between <!-- {name} --> and <!-- end -->")
    return filled


def save(figure, name):
    figure.savefig(IMAGES / f"{name}.svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)


def draw_speeds(results, embryo, name):
    series = read(results / "runs" / embryo / "draw-1/series.csv")[1:]
    figure, axes = plt.subplots(figsize=(6.4, 4))
    for column, text in (("vml_speed_um_per_s", "VML, the middle"), ("vce_speed_um_per_s", "VCE, second-last cell")):
        axes.loglog([float(row["time_s"]) for row in series], [float(row[column]) for row in series], label=text)
    for time_s, text in ((30, "largest difference, paper"), (900, "equal speeds and rest, paper")):
        axes.axvline(time_s, color="0.6", linestyle=":")
        axes.text(time_s, 1.2e-4, f" {text}", rotation=90, fontsize=8, ha="right")
    axes.set(xlabel="time, s", ylabel="speed, µm/s", xlim=(0.05, 1200), ylim=(1e-4, None))
    axes.legend(frameon=False)
    save(figure, name)


def draw_trade_off(results):
    numbers = {(row["experiment"], row["outcome"], int(row["draw"])): float(row["number"]) for row in read(results / "experiments.csv") if row["number"]}
    figure, axes = plt.subplots(figsize=(6.4, 4))
    for (experiment, outcome), (text, printed) in LINES.items():
        points = sorted((ratio, numbers[experiment, outcome, i + 1] / printed) for i, ratio in enumerate(RATIOS) if (experiment, outcome, i + 1) in numbers)
        axes.plot(*zip(*points), marker="o", label=text)
    axes.axhspan(0.85, 1.15, color="0.9", label="printed, within 15 %")
    axes.axvline(0.35, color="0.6", linestyle=":")
    axes.set(xlabel="springs across / springs along", ylabel="ours / printed")
    axes.legend(frameon=False, fontsize=8)
    save(figure, "trade-off")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    results = Path(sys.argv[1])
    rows = sorted(read(results / "outcomes.csv"), key=lambda row: SUBJECTS.index(subject_of(row["source"])))
    with (SCIENCE / "reproduction.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["section", "claim", "printed", "ours", "other_readings", "verdict", "because", "experiment", "outcome"])
        writer.writerows([row[key] for key in ("source", "question", "observed", "number", "all_draws", "verdict", "because", "experiment", "outcome")]
                         for row in rows)

    counts = [sum(row["verdict"] == verdict for row in rows) for verdict in VERDICTS]
    with (SCIENCE / "reproduction-errors.csv").open(newline="", encoding="utf-8") as file:
        header, *errors = csv.reader(file)
    page = fill(PAGE.read_text(encoding="utf-8"), "errors", table(header, errors))
    PAGE.write_text(page, encoding="utf-8")
    for path, text in COUNTS.items():
        pattern = re.escape(text).replace(r"\{\}", r"\d+")
        page, found = re.subn(pattern, text.format(len(rows), *counts), path.read_text(encoding="utf-8"))
        if found != 1:
            sys.exit(f"{path}: has {found} counts of verdicts, as in: {text}")
        path.write_text(page, encoding="utf-8")

    plt.rcParams.update({"svg.hashsalt": "plica", "svg.fonttype": "none"})
    draw_speeds(results, "pill", "fig8a-speeds")
    draw_speeds(results, "sphere", "fig8b-speeds")
    draw_trade_off(results)
    moments = ["--view", "antero-ventral,ventral", "--time", "0s,1min,5min,15min", "--overwrite"]
    subprocess.run([os.environ.get("PLICA", "plica"), "render", results / "runs/pill/draw-1",
                    *moments, "--out", IMAGES / "fig7-pill.png"], check=True)


if __name__ == "__main__":
    main()
