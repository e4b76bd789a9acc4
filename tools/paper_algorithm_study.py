#!/usr/bin/python3
"""Run `drosophila` to equilibrium under each scheme and time step; tabulate and plot the depths.

  tools/paper_algorithm_study.py run --out results/paper_algorithm    about 25 minutes on one core; finished runs are kept
  tools/paper_algorithm_study.py plot results/paper_algorithm/study.csv --out docs/images/paper_algorithm.png

docs/developers/paper-algorithm.md has the results.
"""
import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

PROGRAM = Path(__file__).resolve().parent.parent / "build/release/plica"
# The paper's schemes are of first order in time. 2500 s: ten of the slowest time constants. With equal weights there is no
# exact equilibrium (the embryo slides in its vitelline membrane).
COMMON = ["time.integrator=backward-euler", "stop.equilibrium_speed_um_per_min=0.001", "time.end_s=2500",
          "output.frame_every_s=0"]
PROJECTION, LINEAR = "volume.method=projection", "time.scheme=linearly-implicit"
MOBILITY = "volume.projection_weights=mobility"
# Settings of each scheme, and its time steps.
SCHEMES = {
    "coupled": ([], (20, 5, 1)),
    "paper": ([LINEAR, PROJECTION], (20, 10, 5, 2, 1, 0.5)),
    "newton, projection": ([PROJECTION], (20, 10, 5, 2)),
    "paper, projection by mobility": ([LINEAR, PROJECTION, MOBILITY], (20, 10, 5, 2, 1, 0.5)),
    "newton, projection by mobility": ([PROJECTION, MOBILITY], (20, 10, 5, 2)),
    "tissue as one volume": ([LINEAR, PROJECTION, "volume.projection_surface=tissue"], (20, 5, 1)),
    "no volume kept": ([LINEAR, "volume.method=none"], (20, 5, 1)),
}
POISSON = (0.49, 0.499)
COLUMNS = ("scheme", "poisson_ratio", "step_s", "status", "furrow_depth_um", "vml_apical_area_ratio",
           "slow_at_s", "peak_speed_ratio", "max_volume_error", "steps", "linear_iterations", "projection_sweeps",
           "cubic_solves", "cubic_three_real_roots", "wall_s")


def slow_at(series):
    """First time at which every node is slower than 0.2 um/min, the paper's stop as we read it; "" if never."""
    for row in csv.DictReader(series.read_text().splitlines()):
        if float(row["time_s"]) > 0 and float(row["max_node_speed_um_per_s"]) < 0.2 / 60:
            return row["time_s"]
    return ""


def run_one(program, out, scheme, poisson, step):
    name = f"{scheme}_{poisson}_{step}".replace(", ", "_").replace(" ", "_")
    folder = out / name
    if not (folder / "summary.json").exists():
        sets = [*COMMON, *SCHEMES[scheme][0], f"elasticity.poisson_ratio={poisson}", f"time.step_s={step}"]
        command = [program, "run", "drosophila", "--out", folder, "--quiet", "--overwrite"]
        for assignment in sets:
            command += ["--set", assignment]
        status = subprocess.run(command, check=False).returncode
        if status not in (0, 3):
            sys.exit(f"{name}: exit status {status}")
    summary = json.loads((folder / "summary.json").read_text())
    row = {key: summary.get(key) for key in COLUMNS}
    row |= {"scheme": scheme, "poisson_ratio": poisson, "step_s": step, "slow_at_s": slow_at(folder / "series.csv")}
    print(*(f"{key}={row[key]}" for key in COLUMNS), flush=True)
    return row


def run(program, out):
    cases = [(scheme, 0.45, step) for scheme, (_, steps) in SCHEMES.items() for step in steps]
    cases += [(scheme, poisson, step) for poisson in POISSON for scheme, step in
              (("coupled", 20), ("newton, projection", 20), ("newton, projection", 5))]
    cases.sort(key=lambda case: -case[2])  # the short ones first
    out.mkdir(parents=True, exist_ok=True)
    rows = [run_one(program, out, *case) for case in cases]
    with open(out / "study.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def plot(table, out):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    rows = [row for row in csv.DictReader(table.read_text().splitlines()) if row["status"] != "failed"]
    looks = {
        "coupled": ("k", "o", "-"),
        "newton, projection": ("tab:blue", "s", "-"),
        "paper": ("tab:red", "o", "-"),
        "newton, projection by mobility": ("tab:blue", "s", "--"),
        "paper, projection by mobility": ("tab:red", "o", "--"),
        "tissue as one volume": ("tab:green", "^", "-"),
        "no volume kept": ("0.6", "v", "-"),
    }
    pyplot.rcParams["font.size"] = 13  # readable at 400 pixels
    figure, axes = pyplot.subplots(figsize=(7.5, 5.2), constrained_layout=True)
    for scheme, (colour, marker, line) in looks.items():
        points = [(float(row["step_s"]), float(row["furrow_depth_um"])) for row in rows
                  if row["scheme"] == scheme and row["poisson_ratio"] == "0.45"]
        axes.plot(*zip(*sorted(points)), color=colour, marker=marker, linestyle=line, label=scheme)
    axes.axhline(28.89, color="0.5", linewidth=0.8, linestyle=":")
    axes.annotate("28.89, the paper", (0.5, 28.89), color="0.4", va="top")
    axes.set_xscale("log")
    ticks = (20, 10, 5, 2, 1, 0.5)
    axes.set_xticks(ticks, [f"{step:g}" for step in ticks])
    axes.minorticks_off()
    axes.set_xlabel("time step, s")
    axes.set_ylabel("equilibrium depth, µm")
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=11, loc="lower right")
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=104)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    runs = commands.add_parser("run", help="run the study; finished runs are kept")
    runs.add_argument("--out", type=Path, default=Path("results/paper_algorithm"))
    runs.add_argument("--program", type=Path, default=PROGRAM)
    plots = commands.add_parser("plot", help="plot its table")
    plots.add_argument("table", type=Path)
    plots.add_argument("--out", type=Path, default=Path("docs/images/paper_algorithm.png"))
    options = parser.parse_args()
    if options.command == "run":
        run(options.program, options.out)
    else:
        plot(options.table, options.out)


if __name__ == "__main__":
    main()
