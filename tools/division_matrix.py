#!/usr/bin/python3
"""Run drosophila with different cells dividing; print the table of lip distances of docs/how-to/division.md.

Every row is `plica run` of scenarios/drosophila.toml to 40 min with one division at 15 min and, in some rows, a second one
at 25 min, each grown in 5 min. Takes a few minutes on two cores; finished runs are kept.

Example: tools/division_matrix.py build/release/plica --out results/divisions
"""
import argparse
import concurrent.futures
import json
import os
import subprocess
from pathlib import Path

REGIONS = """format = 1
base = "drosophila"
[region.row-1]
face = "ventral"
cells_along = 14
cells_across = 1
[region.rows-3]
face = "ventral"
cells_along = 14
cells_across = 3
[region.rows-7]
face = "ventral"
cells_along = 14
cells_across = 7
[region.lip-rows]
intersect = ["furrow"]
except = ["rows-3"]
[region.flank-rows]
intersect = ["rows-3"]
except = ["row-1"]
[region.border-rows]
intersect = ["rows-7"]
except = ["furrow"]
[time]
end_min = 40
[stop]
at_equilibrium = false
[output]
frame_every_s = 600
"""

# (cells, plane, final volume of a daughter / volume of the mother) of each division, in order.
FLOOR = ("rows-3", "longest-axis", 1.0)
DIVISIONS = ([()]
             + [((cells, plane, 1.0),) for cells in ("row-1", "rows-3", "furrow", "flank-rows", "lip-rows", "border-rows")
                for plane in ("transverse", "sagittal")]
             + [(("rows-3", "longest-axis", ratio),) for ratio in (0.6, 0.8, 0.9, 1.0)]
             + [(FLOOR, ("border-rows", "transverse", 0.6)), (FLOOR, ("border-rows", "sagittal", 0.6)),
                (FLOOR, ("lip-rows", "sagittal", 0.7)), (FLOOR, ("lip-rows", "transverse", 0.7))])


def run(plica, out, scenario, divisions):
    name = "+".join("-".join(map(str, division)) for division in divisions) or "none"
    summary = out / name / "summary.json"
    if not summary.exists():
        command = [plica, "run", scenario, "--out", out / name, "--quiet", "--overwrite"]
        for number, (cells, plane, ratio) in enumerate(divisions):
            table = f"division.round{number + 1}"
            for key, value in {"region": cells, "plane": plane, "daughter_volume_ratio": ratio,
                               "at_min": 15 + 10 * number, "growth_min": 5}.items():
                command += ["--set", f"{table}.{key}={value}"]
        subprocess.run(command, check=False, stderr=subprocess.DEVNULL, env=os.environ | {"OMP_NUM_THREADS": "1"})
    return divisions, json.loads(summary.read_text(encoding="utf-8"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plica", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    scenario = options.out / "divisions.toml"
    scenario.write_text(REGIONS, encoding="utf-8")
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        results = list(pool.map(lambda divisions: run(options.plica.resolve(), options.out, scenario, divisions),
                                DIVISIONS))
    print("| cells that divide | plane | final volume | lips, µm | highest points, µm | floor below lips, µm | cells | end |")
    print("|---|---|---|---|---|---|---|---|")
    for divisions, summary in results:
        columns = [", then ".join(str(division[i]) for division in divisions) or "–" for i in range(3)]
        ended = summary["status"] == "end_time"
        figures = [f"{summary[key]:.1f}" if ended else "" for key in
                   ("lip_distance_um", "highest_points_distance_um", "furrow_depth_below_lips_um")]
        end = "40 min" if ended else f"fails at {summary['time_s'] / 60:.1f} min: {summary['failure'].split(' at t')[0]}"
        print("| " + " | ".join(columns + figures + [str(summary["cells"]), end]) + " |")


if __name__ == "__main__":
    main()
