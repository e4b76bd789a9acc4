"""Run random scenarios and check the guarantees of plica for arbitrary input.

A scenario is drawn from the whole key table (random_scenario.py). Keys that `plica check` rejects are usually removed;
sometimes the scenario is run as it is. Each run must then, within a time limit, without a crash and without NaN in any
file,

- end at equilibrium, at a criterion or at its end time (status 0, or 1 if it misses an expectation),
- fail with status 3 and one line that names cell, time and cause,
- or be refused with status 2 and lines of the form FILE:LINE: KEY: PROBLEM; REMEDY.

Scenarios that violate this are kept. Scenario I of a seed does not depend on the count.

Usage: random_scenarios.py PROGRAM [--count N] [--seed S] [--first I] [--keep DIR]
"""
import re
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "app"))
import support  # noqa: E402
import trials  # noqa: E402
from random_scenario import Drawer  # noqa: E402
from scenario_table import read_table  # noqa: E402
from trials import Broken  # noqa: E402

LONGEST_WAIT_S = 600  # wall-clock limit, for a run that waits forever
FAILED = re.compile(r"plica: solver failed: .*(cell \d+|whole surface).* at t = [\d.e+-]+ s(, with steps down to [\d.e+-]+ s)?; ")
REFUSED = re.compile(r"(?P<where>[^:\n]+):(?:\d+: )?\s?(?P<key>[^:]*): (?P<problem>.+)")


longest_s = 120  # CPU time of one run; the slowest takes 34 s on an idle machine


def limit_time():
    resource.setrlimit(resource.RLIMIT_CPU, (longest_s, longest_s + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def plica(*arguments):
    try:
        result = support.plica(*arguments, timeout=LONGEST_WAIT_S, preexec_fn=limit_time)
    except subprocess.TimeoutExpired:
        raise Broken(f"waits forever: {' '.join(map(str, arguments))}") from None
    if result.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise Broken(f"exceeds {longest_s} s of CPU time: plica {arguments[0]}")
    return result


def refused_keys(result):
    """Return the keys that a refusal names; Broken if a line lacks place or problem."""
    if not result.stderr.strip():
        raise Broken("refused without a message")
    keys = []
    for line in result.stderr.splitlines():
        if line.startswith(("warning", "note")):
            continue
        match = REFUSED.fullmatch(line)
        if not match:
            raise Broken(f"a refusal without a place: {line}")
        keys.append(match["key"])
    return keys


def cause(message):
    """Return the cause of a failure without numbers."""
    text = re.sub(r"^plica: solver failed: | at t = .*$", "", message)
    return re.sub(r"[\d.]+(e[+-]?\d+)?", "N", text)


def judge(result, out):
    """Return the kind of outcome; Broken if it is not allowed."""
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
        raise Broken(f"an incomplete file: {error}") from None
    if result.returncode == 3:
        lines = [line for line in result.stderr.splitlines() if line.startswith("plica: ")]
        if len(lines) != 1 or not FAILED.match(lines[0]):
            raise Broken(f"failed without cell, time and cause: {result.stderr.strip()}")
        if summary["status"] != "failed":
            raise Broken(f"status 3, but the summary has {summary['status']}")
        return "failed: " + cause(lines[0])
    ends = {"equilibrium": "equilibrium", "end_time": "end time", "criterion": "criterion"}
    if summary["status"] not in ends:
        raise Broken(f"status {result.returncode}, but the summary has {summary['status']}")
    return ends[summary["status"]]


def repaired(drawer, scenario, chance):
    """Remove rejected keys until `plica check` accepts the scenario, or stop early by chance."""
    draft = drawer.draft
    for _ in range(8):
        scenario.write_text(draft.text())
        result = plica("check", scenario)
        if result.returncode != 2:
            return
        keys = refused_keys(result)
        if chance.random() < 0.05:
            return
        for key in keys:
            # A missing key cannot be removed; remove its table.
            if not draft.drop(key):
                draft.drop(key.rsplit(".", 1)[0])
        drawer.make_small()


def prepare_files(folder):
    """Write meshes and a run that scenarios may refer to."""
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


def main():
    global longest_s
    parser = trials.arguments(__doc__, "scenario", 100)
    parser.add_argument("--longest", type=int, default=longest_s, metavar="S", help="CPU time of one run; sanitizers need far more")
    given = parser.parse_args()
    longest_s = given.longest
    support.PROGRAM = str(given.program)

    def prepare(folder):
        table, files = read_table(support.PROGRAM), prepare_files(folder)
        scenario, out = folder / "draw.toml", folder / "out"

        def trial(chance):
            shutil.rmtree(out, ignore_errors=True)
            drawer = Drawer(chance, *table, files)
            drawer.draw()
            repaired(drawer, scenario, chance)
            return judge(plica("run", scenario, "--out", out, "--quiet"), out)

        return trial

    sys.exit(1 if trials.run(given, "scenario", prepare)["FAILED"] else 0)


if __name__ == "__main__":
    main()
