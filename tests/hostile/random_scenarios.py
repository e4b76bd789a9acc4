"""Runs random scenarios, and holds each to what plica promises of any input.

A scenario is drawn from the whole input table (random_scenario.py). What `plica check` refuses is mostly mended, by
taking out the keys that it names, and sometimes run as it is. Then each run

- ends at equilibrium, at a criterion or at its end time (status 0, or 1 when it misses an expectation),
- gives up with status 3 and one line that names cell, time and cause,
- or is refused with status 2 and lines of FILE:LINE: KEY: PROBLEM; REMEDY,

within a time, without a crash, without a number that is none in any file. What breaks that is a failure; its scenario
is kept. Scenario I of a seed is the same whatever the count.

Usage: random_scenarios.py PROGRAM [--count N] [--seed S] [--first I] [--keep DIR]
"""
import argparse
import collections
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "app"))
import support  # noqa: E402
from random_scenario import Drawer  # noqa: E402
from scenario_table import read_table  # noqa: E402

LONGEST_WAIT_S = 600  # by the clock: a run that waits for ever
GAVE_UP = re.compile(r"plica: gave up: .*(cell \d+|whole surface).* at t = [\d.e+-]+ s, with steps down to [\d.e+-]+ s; ")
REFUSED = re.compile(r"(?P<where>[^:\n]+):(?:\d+: )?\s?(?P<key>[^:]*): (?P<problem>.+)")


class Broken(Exception):
    """A promise that was not kept."""


longest_s = 120  # of the processor, for one run; the slowest takes 34 s on an idle machine


def limit_time():
    resource.setrlimit(resource.RLIMIT_CPU, (longest_s, longest_s + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def plica(*arguments):
    try:
        result = support.plica(*arguments, timeout=LONGEST_WAIT_S, preexec_fn=limit_time)
    except subprocess.TimeoutExpired:
        raise Broken(f"waits for ever: {' '.join(map(str, arguments))}") from None
    if result.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Broken(f"is not over after {longest_s} s of the processor: plica {arguments[0]}")
    return result


def refused_keys(result):
    """The keys that a refusal names; Broken when it does not say where and what."""
    if not result.stderr.strip():
        raise Broken("refused without a word")
    keys = []
    for line in result.stderr.splitlines():
        if line.startswith(("warning", "note")):
            continue
        match = REFUSED.fullmatch(line)
        if not match:
            raise Broken(f"a refusal that does not say where: {line}")
        keys.append(match["key"])
    return keys


def cause(message):
    """A failure's cause without its numbers."""
    text = re.sub(r"^plica: gave up: | at t = .*$", "", message)
    return re.sub(r"[\d.]+(e[+-]?\d+)?", "N", text)


def judge(result, out):
    """The kind of outcome; Broken when it is none that is allowed."""
    noise = [word for word in ("terminate called", "runtime error", "Sanitizer", "Assertion") if word in result.stderr]
    if result.returncode < 0 or noise:
        raise Broken(f"crashed, status {result.returncode}: {result.stderr[-1500:]}")
    if result.returncode == 2:
        refused_keys(result)
        if out.exists():
            raise Broken("refused, and something was written")
        return "refused"
    if result.returncode not in (0, 1, 3):
        raise Broken(f"status {result.returncode}: {result.stderr.strip()}")
    try:
        checks = support.CommandLine()
        checks.assert_whole(out)
        summary = checks.summary(out)
    except (AssertionError, ValueError, KeyError, OSError) as error:
        raise Broken(f"a file is not whole: {error}") from None
    if result.returncode == 3:
        lines = [line for line in result.stderr.splitlines() if line.startswith("plica: ")]
        if len(lines) != 1 or not GAVE_UP.match(lines[0]):
            raise Broken(f"gave up without saying in which cell, when and why: {result.stderr.strip()}")
        if summary["status"] != "failed":
            raise Broken(f"status 3, and the summary says {summary['status']}")
        return "gave up: " + cause(lines[0])
    ends = {"equilibrium": "equilibrium", "end_time": "end time", "criterion": "criterion"}
    if summary["status"] not in ends:
        raise Broken(f"status {result.returncode}, and the summary says {summary['status']}")
    return ends[summary["status"]]


def mended(drawer, scenario, chance):
    """Takes out what `plica check` refuses, while there is anything, or mostly. The number of refusals."""
    draft = drawer.draft
    for refusals in range(8):
        scenario.write_text(draft.text())
        result = plica("check", scenario)
        if result.returncode != 2:
            return refusals
        keys = refused_keys(result)
        if chance.random() < 0.05:
            return refusals
        for key in keys:
            # What is missing cannot be taken out; then the table goes.
            if not draft.drop(key):
                draft.drop(key.rsplit(".", 1)[0])
        drawer.make_small()
    return refusals


def prepare(folder):
    """Meshes and a run that scenarios may refer to."""
    files = {"base": ["drosophila"], "embryo.file": [], "embryo.apical_array": ["apical", "mother_id"],
             "region.array": ["cell_id", "generation"], "monitor.reference": []}
    for name, text in (("block", support.BLOCK), ("sphere", support.SPHERE)):
        scenario = folder / f"{name}.toml"
        scenario.write_text(text)
        for command, out in (("mesh", folder / f"{name}.vtu"), ("run", folder / f"{name}_run")):
            result = support.plica(command, scenario, "--out", out)
            if result.returncode != 0:
                sys.exit(result.stderr)
        files["embryo.file"].append(f"{name}.vtu")
        files["monitor.reference"] += [f"{name}.vtu", f"{name}_run"]
    return files


def run_one(number, seed, table, files, folder):
    """The kind of outcome of one scenario, how often it was refused before, and its time."""
    chance = random.Random(f"{seed}/{number}")
    scenario, out = folder / "scenario.toml", folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    drawer = Drawer(chance, *table, files)
    drawer.draw()
    refusals = mended(drawer, scenario, chance)
    started = time.monotonic()
    kind = judge(plica("run", scenario, "--out", out, "--quiet"), out)
    return kind, refusals, time.monotonic() - started


def main():
    global longest_s
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first scenario: to repeat one")
    parser.add_argument("--keep", type=Path, default=Path("random_scenarios_failed"), help="where failures' scenarios go")
    parser.add_argument("--longest", type=int, default=longest_s, metavar="S", help="of the processor, for one run; "
                        "sanitizers take far longer")
    given = parser.parse_args()
    longest_s = given.longest
    support.PROGRAM = str(given.program.resolve())
    table = read_table(support.PROGRAM)
    counts, failures, refusals, slowest = collections.Counter(), 0, 0, (0, 0)
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="plica_random_") as name:
        folder = Path(name)
        files = prepare(folder)
        for number in range(given.first, given.first + given.count):
            try:
                kind, refused, seconds = run_one(number, given.seed, table, files, folder)
                refusals += refused
                slowest = max(slowest, (seconds, number))
            except Broken as error:
                kind = "FAILED"
                failures += 1
                given.keep.mkdir(parents=True, exist_ok=True)
                kept = given.keep / f"seed{given.seed}_{number}.toml"
                shutil.copy(folder / "scenario.toml", kept)
                print(f"scenario {number} of seed {given.seed}: {error}\n  kept in {kept}", flush=True)
            counts[kind] += 1
            if sum(counts.values()) % 100 == 0 and given.count > 100:
                print(f"{sum(counts.values())} scenarios after {time.monotonic() - started:.0f} s", flush=True)
    print(f"{given.count} scenarios of seed {given.seed} in {time.monotonic() - started:.0f} s; {refusals} more were refused and "
          f"mended; the slowest took {slowest[0]:.1f} s (number {slowest[1]})")
    for kind, count in counts.most_common():
        print(f"{count:6} {kind}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
