"""Run random sheets under random loads and check that none ends with a wrong tissue in silence, and that few fail.

A sheet has 20 to 2000 cells 3 to 12 um wide and 3 to 40 um high, a Young's modulus of 10 to 3000 Pa, diagonals or kites, one
layer or (up to 700 cells) two, a free or a fixed boundary. One kind of load acts in a stripe or in all cells: springs, tension
or cortex of one kind of faces, or pressure; 0.03 to 3 times Young's modulus times height (pressure: a tenth of the modulus), in
half of the sheets at full strength from the start. Each run must

- end with cell volumes and element shapes that hold, finite numbers, and a warning where the sheet passes through itself, or
- fail with status 3; then one of the remedies that its message names must carry the run further, alone.

A run that takes more than MOST_CPU_S of processor time crawls, which is a failure of the program, too.

Usage: random_sheets.py PROGRAM [--count N] [--seed S] [--first I] [--keep DIR]
"""
import json
import math
import re
import resource
import shutil
import signal
import subprocess
import sys

import trials
from trials import Broken

END_S = 180
MOST_FAIL = 0.05
MOST_CPU_S = 300


def even(r, low, high):
    """A number between two, evenly on a logarithm."""
    return math.exp(r.uniform(math.log(low), math.log(high)))


def draw(r):
    """The text of one scenario."""
    cells, width, height, modulus = round(even(r, 20, 2000)), even(r, 3, 12), even(r, 3, 40), even(r, 10, 3000)
    area, aspect = cells * width**2, even(r, 0.5, 2)
    length = math.sqrt(area * aspect)
    load = r.choice(["springs", "tension", "cortex", "pressure"])
    side = r.choice(["apical", "apical", "basal", "lateral"])
    strength = even(r, 0.03, 3) * modulus * 1e-3 * height
    if load == "pressure":
        side = r.choice(["apical", "basal"])
        table, keys = "pressure", f'face = "{side}"\npressure_Pa = {0.1 * strength / height * 1e3:.4g}'
    elif load == "cortex":
        saturation = r.choice([0, 0.16])
        table, keys = "cortex", f'faces = "{side}"\ntension_mN_per_m = {strength:.4g}\nsaturation_ratio = {saturation}'
    else:
        if load == "tension" and side == "lateral":
            load = "springs"
        key = "stiffness_nN_per_um" if load == "springs" else "tension_mN_per_m"
        table, keys = "contraction", f'edges = "{side}"\n{key} = {strength:.4g}'
    if r.random() < 0.5:
        keys += "\nprogram = { time_min = [0, 1], activity = [0, 1] }"
    where = r.choice(["all", "stripe", "stripe"])
    text = f"""format = 1
[embryo]
shape = "sheet"
length_um = {length:.4g}
width_um = {area / length:.4g}
cell_count = {cells}
cell_height_um = {height:.4g}
seed = {r.randrange(1000)}
elements = "{r.choice(["diagonals", "kites"])}"
layers = {min(r.choice([1, 1, 2]), 1 + (cells < 700))}
rim = "{r.choice(["free", "held"])}"
[region.stripe]
y_um = [{-1.5 * width:.4g}, {1.5 * width:.4g}]
[elasticity]
young_modulus_Pa = {modulus:.4g}
poisson_ratio = {r.choice([0.3, 0.45])}
[{table}.load]
region = "{where}"
{keys}
[time]
end_s = {END_S}
[output]
frame_every_s = 0
"""
    return text


def limit_processor_time():
    """Let the system end a process after MOST_CPU_S."""
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_S, MOST_CPU_S + 5))


def run(program, folder, text, *overrides):
    """Return the finished process, the summary and what was said."""
    out, scenario = folder / "out", folder / "draw.toml"
    shutil.rmtree(out, ignore_errors=True)
    scenario.write_text(text)
    sets = [word for override in overrides for word in ("--set", override)]
    done = subprocess.run([program, "run", scenario, "--out", out, "--threads", "1", *sets], capture_output=True, text=True,
                          preexec_fn=limit_processor_time, check=False)
    if done.returncode == -signal.SIGXCPU:
        reached = (out / "series.csv").read_text().splitlines()[-1].split(",")[0]
        raise Broken(f"crawls: at {reached} s of {END_S} after {MOST_CPU_S} s of processor time")
    said = done.stdout + done.stderr
    if done.returncode not in (0, 3):
        raise Broken(f"status {done.returncode}: {done.stderr.strip()[-800:]}")
    if re.search(r"\b(nan|inf)\b", (out / "series.csv").read_text().lower()):
        raise Broken("a number in series.csv is not finite")
    return done, json.loads((out / "summary.json").read_text()), said


def judge_end(summary, said):
    """A run that ended on its own."""
    if summary["max_volume_error"] > 1e-6 or summary["min_corner_jacobian_ratio"] <= 0:
        raise Broken(f"ends with volumes off by {summary['max_volume_error']}, corners at {summary['min_corner_jacobian_ratio']}")
    if summary["self_intersections"] > 0 and not re.search("self-?intersect", said):
        raise Broken(f"{summary['self_intersections']} crossings, in silence")
    return "passes through itself, told" if summary["self_intersections"] > 0 else summary["status"]


def remedies(said):
    """The settings of each remedy that a failure names: "...; set KEY = VALUE and KEY = VALUE (effect), or KEY = VALUE (effect)"."""
    last = re.search(r"solver failed: .*; set (.*)", said)
    alternatives = re.split(r"\), or ", last[1]) if last else []
    return [[f"{key}={value}" for key, value in re.findall(r"([\w.]+) = (\{.*?\}|[^\s(]+)", text)] for text in alternatives]


def judge_remedies(program, folder, text, summary, said):
    """A run that failed: one of its remedies must carry it further, alone."""
    for remedy in remedies(said):
        done, other, _ = run(program, folder, text, *remedy)
        if done.returncode == 0 or other["time_s"] > 2 * summary["time_s"]:
            return "fails, helped by " + ", ".join(setting.split("=")[0] for setting in remedy)
    raise Broken(f"fails, and no remedy helps: {said.strip().splitlines()[-1]}")


def main():
    given = trials.arguments(__doc__, "sheet", 200).parse_args()

    def prepare(folder):
        def trial(r):
            text = draw(r)
            done, summary, said = run(given.program, folder, text)
            return judge_end(summary, said) if done.returncode == 0 else judge_remedies(given.program, folder, text, summary, said)

        return trial

    counts = trials.run(given, "sheet", prepare)
    failed = sum(count for outcome, count in counts.items() if outcome.startswith("fails"))
    sys.exit(1 if counts["FAILED"] or failed > MOST_FAIL * given.count else 0)


if __name__ == "__main__":
    main()
