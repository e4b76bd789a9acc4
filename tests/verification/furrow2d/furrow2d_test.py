#!/usr/bin/env python3
"""A closing furrow in plane strain, ablations and shut-offs, against another program (docs/developers/furrow2d.md).

    furrow2d_test.py PLICA    runs the cases and prints a table; exit status 1 where one misses that is not known to

A case is furrow2d.toml with the changes that cases.toml has. The other program's numbers are in furrow2d.csv. A case misses
when only one of the two closes, when they close more than a minute apart, or when the largest height or a depth (after 6,
9, 12 and 16 minutes and at the end) differs by more than 5 % and 0.3 um. Of a shut-off the depths then and five minutes
later are compared, and the verdict is whether the furrow goes on: is twice as deep by then, or has closed. What is known to
miss is written down with the case.
"""
import bisect
import concurrent.futures
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

here = pathlib.Path(__file__).resolve().parent
closed_um, deep_um = 1.0, 15  # lips this near count as closed, in a furrow this deep: the same in both programs
depths_min = (6, 9, 12, 16, 26)
shown_after_min = 5  # what a shut-off does


class Course:
    """Depth and height over time, the largest height, and when the lips meet."""

    def __init__(self, times, depths, highest, closes, heights=None):
        self.times, self.depths, self.highest, self.closes, self.heights = times, depths, highest, closes, heights

    def depth(self, minute):
        i = bisect.bisect_left(self.times, minute - 1e-9)
        i = min(max(i, 1), len(self.times) - 1)
        part = (minute - self.times[i - 1]) / (self.times[i] - self.times[i - 1])
        return self.depths[i - 1] + part * (self.depths[i] - self.depths[i - 1])


def kept():
    """Of furrow2d, by case: as it is, and with the laws that plica has."""
    with open(here / "furrow2d.csv", newline="") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        minutes = [name for name in rows.fieldnames if name.startswith("depth_")]
        result = {}
        for row in rows:
            times = [float(name.removeprefix("depth_").removesuffix("min_um")) for name in minutes]
            course = Course([0, *times], [0, *(float(row[name]) for name in minutes)], float(row["highest_um"]),
                            float(row["closes_min"]) if row["closes_min"] else None)
            result.setdefault(row["case"], {})[row["laws"]] = course
    return result


def closing(rows):
    for before, after in zip(rows, rows[1:]):
        if after["lips"] < closed_um and after["depth"] > deep_um:
            if before["lips"] <= closed_um or before["depth"] <= deep_um:
                return after["time"]
            part = (before["lips"] - closed_um) / (before["lips"] - after["lips"])
            return before["time"] + part * (after["time"] - before["time"])
    return None


def run(plica, case):
    with tempfile.TemporaryDirectory() as directory:
        out = pathlib.Path(directory) / "run"
        command = [plica, "run", str(here / "furrow2d.toml"), "--out", str(out), "--quiet"]
        for change in case.get("set", []):
            command += ["--set", change]
        subprocess.run(command, check=True, capture_output=True,
                       env=dict(os.environ, OMP_NUM_THREADS="1", OMP_WAIT_POLICY="passive"))
        status = json.loads((out / "summary.json").read_text())["status"]
        if status != "end_time":
            raise SystemExit(f"{case['name']}: {status}")
        with open(out / "series.csv", newline="") as file:
            rows = [{"time": float(row["time_s"]) / 60, "depth": float(row["furrow_depth_um"]),
                     "height": float(row["vml_height_um"]), "lips": 2 * float(row["lip.position_um"])}
                    for row in csv.DictReader(file)]
    heights = [row["height"] for row in rows]
    return Course([row["time"] for row in rows], [row["depth"] for row in rows], max(heights), closing(rows), heights)


def minutes_of(case):
    return (case["off_min"], case["off_min"] + shown_after_min) if "off_min" in case else depths_min


def goes_on(case, course):
    """The verdict: whether a furrow closes; of a shut-off, whether it goes on."""
    if "off_min" not in case:
        return course.closes is not None
    then, later = (course.depth(t) for t in minutes_of(case))
    return later > 2 * then or (course.closes or 99) < case["off_min"] + shown_after_min


def differs(a, b):
    return abs(a - b) > max(0.05 * abs(b), 0.3)


def misses(case, found, truth):
    result = []
    if goes_on(case, found) != goes_on(case, truth):
        result.append("verdict")
    elif found.closes and truth.closes and abs(found.closes - truth.closes) > 1:
        result.append("closing")
    if differs(found.highest, truth.highest):
        result.append("height")
    return result + [f"depth at {t} min" for t in minutes_of(case) if differs(found.depth(t), truth.depth(t))]


def text(case, course):
    times = minutes_of(case)
    closes = course.closes and course.closes <= times[-1]
    return ((" yes" if goes_on(case, course) else "  no") + (f"{course.closes:6.1f}" if closes else "     -")
            + f"{course.highest:6.1f}" + "".join(f"{course.depth(t):6.1f}" for t in times))


def compare(plica, cases):
    truth = kept()
    wrong = 0
    heading = " closes   at height" + "".join(f"{f'd({t})':>6}" for t in depths_min)
    last = None
    print(f"{'':36}{'furrow2d':46} plica")
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        for case, found in zip(cases, pool.map(lambda case: run(plica, case), cases)):
            other = truth[case["name"]]["plica's"]
            missed, known = misses(case, found, other), case.get("misses", [])
            new = [what for what in missed if what not in known]
            wrong += bool(new)
            head = "goes on   at height  then later" if "off_min" in case else heading
            if head != last:
                print(f"{'':36}{head:46} {head}")
                last = head
            note = "  misses " + ", ".join(missed) if missed else ""
            if new:
                note += "; known: " + (", ".join(known) or "nothing")
            print(f"{case['name']:36}{text(case, other):46} {text(case, found)}{note}", flush=True)
    print(f"{len(cases)} cases; {wrong} not as expected" if wrong else f"{len(cases)} cases, all as expected")
    return wrong


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    plica = str(pathlib.Path(sys.argv[1]).resolve())
    cases = tomllib.loads((here / "cases.toml").read_text())["case"]
    return 1 if compare(plica, cases) else 0


if __name__ == "__main__":
    sys.exit(main())
