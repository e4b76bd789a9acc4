#!/usr/bin/python3
"""A study on a real Slurm, tools/slurm_here: an array of tasks, of which one is cancelled, one's slurmstepd is killed and a
node is drained and resumed half-way, leaves the same runs.csv as a study on this machine, wall_s apart.

Usage: slurm_study_test.py PLICA [--points N]. Starts a Slurm of its own, in a temporary directory, and stops it. Minutes:
Slurm needs one to see that a slurmstepd is gone.
"""
import argparse
import csv
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STUDY = """\
format = 1
scenario = "drosophila"
[vary]
"contraction.apical.stiffness_nN_per_um" = { low = 3, high = 8 }
"elasticity.young_modulus_Pa" = { low = 500, high = 1500 }
[design]
kind = "latin-hypercube"
points = %d
[keep]
measures = ["furrow_depth_um", "vml_apical_area_ratio", "peak_speed_ratio_time_s"]
"""


def say(text):
    print(f"{time.monotonic() - began:6.1f} s  {text}", flush=True)


def run(*words, check=True):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=environment, check=False)
    if check and done.returncode != 0:
        raise SystemExit(f"{words}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def table(directory):
    with open(directory / "runs.csv", newline="", encoding="utf-8") as file:
        return [{key: value for key, value in row.items() if key != "wall_s"} for row in csv.DictReader(file)]


def tasks(state, job):
    """The tasks of an array that are in a state."""
    return run("squeue", "--noheader", "--array", f"--states={state}", "--format=%K", f"--jobs={job}", check=False).split()


def wait_for(what, seconds, condition):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise SystemExit(f"not within {seconds} s: {what}")
        time.sleep(0.2)


def steps_of(job, task):
    """The slurmstepd of a task, by its title."""
    numbers = run("squeue", "--noheader", "--format=%A", f"--jobs={job}_{task}", check=False).split()
    found = run("pgrep", "--full", rf"slurmstepd: \[{numbers[0]}\.", check=False).split() if numbers else []
    return [int(process) for process in found]


parser = argparse.ArgumentParser()
parser.add_argument("program", type=Path)
parser.add_argument("--points", type=int, default=200)
options = parser.parse_args()
program = options.program.resolve()
began = time.monotonic()
with tempfile.TemporaryDirectory(prefix="plica-slurm-") as temporary:
    place = Path(temporary)
    slurm = place / "slurm"
    environment = {**os.environ, "SLURM_CONF": str(slurm / "slurm.conf"), "OMP_NUM_THREADS": "1"}
    (place / "study.toml").write_text(STUDY % options.points, encoding="utf-8")
    run(program, "study", place / "study.toml", "--out", place / "here", "--quiet")
    say("the study on this machine has ended")
    run(ROOT / "tools/slurm_here", "start", "--nodes", "2", "--dir", slurm)
    try:
        said = run(program, "study", place / "study.toml", "--out", place / "there", "--engine", "slurm")
        job = said.split("submitted as job ")[1].split(";")[0]
        say(f"submitted as job {job}")
        running = []

        def two_run():
            running[:] = tasks("RUNNING", job)
            return len(running) == 2

        wait_for("two tasks run", 60, two_run)
        cancelled = running[0]
        run("scancel", f"{job}_{cancelled}")
        say(f"task {cancelled} cancelled")
        killed = None

        def one_is_killed():
            global killed
            for task in tasks("RUNNING", job):  # it may end meanwhile: then another
                for process in steps_of(job, task):
                    os.kill(process, signal.SIGKILL)
                    killed = task
                if killed:
                    return True
            return False

        wait_for("a slurmstepd is there", 60, one_is_killed)
        say(f"slurmstepd of task {killed} killed")
        run("scontrol", "update", "nodename=here2", "state=drain", "reason=test")
        time.sleep(5)
        run("scontrol", "update", "nodename=here2", "state=resume")
        say("node here2 drained and resumed")
        last = ""

        def ended():
            global last
            requeued = [task for task in tasks("PENDING", job) if task == killed]
            if requeued:  # Slurm would wait two minutes
                run("scontrol", "update", f"jobid={job}_{killed}", "starttime=now", check=False)
            status = run(program, "study", "status", place / "there")
            if status != last:
                last = status
                say(status.strip().replace("\n", "; "))
            time.sleep(2)
            return (place / "there/slurm/ended").exists()

        wait_for("the study has ended", 900, ended)
    finally:
        run(ROOT / "tools/slurm_here", "stop", "--dir", slurm, check=False)
    here, there = table(place / "here"), table(place / "there")
    if here != there:
        different = [a["point"] for a, b in zip(here, there) if a != b]
        print(f"the tables differ, in points {different[:10]}")
        for log in sorted((place / "there/slurm/log").iterdir()):
            print(f"== {log.name}\n{log.read_text()}")
        sys.exit(1)
    rows = sum(len(file.read_text().splitlines()) for file in (place / "there/rows").iterdir())
    say(f"both tables have the same {len(here)} rows; {rows - len(here)} runs were run twice")
