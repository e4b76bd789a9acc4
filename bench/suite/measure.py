"""Run the measuring programs and read their output."""
import csv
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

BYTES_PER_ELEMENT_AT_LEAST = 6_000  # in memory; what would not fit is left out


class Missing(Exception):
    """Missing prerequisite of the suite, with a remedy."""


class Failed(Exception):
    """Failed measurement, with the text for the table."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def memory_available_bytes():
    found = re.search(r"MemAvailable:\s+(\d+) kB", Path("/proc/meminfo").read_text())
    return int(found.group(1)) * 1024


def median(values):
    return statistics.median(values)


class Runner:
    def __init__(self, timeout_s):
        self.timeout_s = timeout_s

    def run(self, program, *arguments, threads=1, under=(), good=(0,)):
        """Standard output, standard error, and what the process took: wall and CPU time and peak memory."""
        command = [*map(str, under), str(program), *map(str, arguments)]
        environment = os.environ | {"OMP_NUM_THREADS": str(threads)}
        with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as errors:
            start = time.perf_counter()
            process = subprocess.Popen(command, stdout=out, stderr=errors, env=environment)
            try:
                status, usage = self.wait(process, start)
            finally:
                if process.poll() is None:
                    process.kill()
                    process.wait()
            wall_s = time.perf_counter() - start
            out.seek(0), errors.seek(0)
            text, complaint = out.read(), errors.read().strip()
        if status < 0:
            raise Failed(f"ended by signal {-status}")
        if status not in good:
            raise Failed((complaint.splitlines() or [f"exit status {status}"])[-1])
        return text, complaint, {"process_s": wall_s, "process_cpu_s": usage.ru_utime + usage.ru_stime,
                                 "process_peak_MiB": usage.ru_maxrss / 1024}

    def wait(self, process, start):
        while True:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            if done:
                process.returncode = os.waitstatus_to_exitcode(status)
                return process.returncode, usage
            if time.perf_counter() - start > self.timeout_s:
                raise Failed(f"more than {self.timeout_s:g} s")
            time.sleep(min(0.02, self.timeout_s))

    def instructions(self, run, *options):
        """Those of `run(under)`, by valgrind's callgrind, which emulates: about fifty times slower, and without AVX-512."""
        valgrind = shutil.which("valgrind")
        if not valgrind:
            raise Missing("counting instructions needs valgrind: apt-get install valgrind")
        with tempfile.TemporaryDirectory() as folder:
            complaint = run([valgrind, "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out", *options])[1]
        found = re.search(r"Collected : (\d+)", complaint)
        if not found:
            raise Failed("callgrind counted nothing")
        return int(found.group(1))


class Suite(Runner):
    def __init__(self, build, timeout_s):
        super().__init__(timeout_s)
        self.build = Path(build).resolve()
        self.plica, self.step, self.kernels = (self.build / name for name in ("plica", "bench/step", "bench/kernels"))
        for program in (self.plica, self.step):
            if not os.access(program, os.X_OK):
                raise Missing(f"{program} is missing; build it: cmake --preset release && cmake --build --preset release")

    def has_kernels(self):
        if not self.kernels.exists():
            say(f"kernels: {self.kernels} was not built; they are left out")
        return self.kernels.exists()

    def machine(self):
        cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
        return {
            "cpu": cpu.group(1) if cpu else "unknown",
            "cores": len(os.sched_getaffinity(0)),
            "program": subprocess.run([self.plica, "--version"], capture_output=True, text=True).stdout.strip(),
            "date": time.strftime("%Y-%m-%d"),
            "load": os.getloadavg()[0],
        }

    def measure_kernels(self, embryo, threads, rounds):
        """Each kernel and the machine's ceilings, in turns in one process: bench/kernels prints `elements`, `threads`,
        `multiply_add_rate` (operations/s), `reading_rate` (bytes/s) and `kernels`, a list of `kernel`, `ns_per_element`,
        `ceiling` (its name), `share` (of it) and, where it has one, `yardsticks`."""
        self.require_memory(embryo)
        text, _, _ = self.run(self.kernels, "--elements-per-cell", embryo.across, embryo.layers, "--threads", threads,
                              "--rounds", rounds, threads=threads)
        return json.loads(text) | {"embryo": str(embryo)}

    def measure_step(self, embryo, threads, repeats):
        """Measure the first step; medians of times. Results must be bitwise identical each time."""
        self.require_memory(embryo)
        results = [json.loads(self.run(self.step, *embryo.options, "--threads", threads, threads=threads)[0])
                   for _ in range(repeats)]
        if len({result["checksum"] for result in results}) != 1:
            raise Failed("two runs differ in their bits")
        times = {key: median([result[key] for result in results]) for key in ("model_s", "step_s")}
        return results[0] | times | {"embryo": str(embryo), "refined_by": embryo.refined_by, "repeats": repeats}

    def measure_run(self, embryo, threads, repeats):
        """The whole Drosophila run with all its files."""
        self.require_memory(embryo)
        return self.measure_runs(lambda folder: self.run_plica(embryo, threads, folder), repeats) | {
            "embryo": str(embryo), "elements": embryo.elements, "threads": threads}

    def measure_furrow(self, furrow, threads, repeats):
        """A furrow that closes, with all its files."""
        options = [word for setting in furrow.settings for word in ("--set", setting)]
        return self.measure_runs(lambda folder: self.run(
            self.plica, "run", furrow.scenario, "--out", Path(folder) / "out", "--overwrite", "--quiet", *options,
            threads=threads), repeats) | {"embryo": str(furrow), "threads": threads}

    def measure_runs(self, run, repeats):
        """What runs leave: counts of the first, medians of times."""
        results = []
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(repeats):
                _, _, process = run(folder)
                summary = json.loads((Path(folder) / "out/summary.json").read_text())
                with open(Path(folder) / "out/series.csv", encoding="utf-8") as file:
                    rows = list(csv.DictReader(file))
                results.append(process | {
                    "wall_s": summary["wall_s"], "solver_s": summary["wall_solver_s"], "status": summary["status"],
                    "steps": summary["steps"], "refused_steps": summary["refused_steps"],
                    "cells": summary["cells"], "elements": summary["elements"],
                    "lips_closed_time_s": summary["lips_closed_time_s"], "newton_iterations": sum(int(row["newton_iterations"] or 0) for row in rows),
                    "linear_iterations": sum(int(row["linear_iterations"] or 0) for row in rows)})
        times = {key: median([result[key] for result in results]) for key in ("process_s", "wall_s", "solver_s")}
        return results[0] | times | {"repeats": repeats}

    def run_plica(self, embryo, threads, folder, under=()):
        k, n, m = embryo.scale, embryo.across, embryo.layers
        settings = [] if embryo.elements == 756 else [
            f"embryo.cells=[{18 * k},{9 * k},{8 * k}]", f"embryo.length_um={460 * k}", f"embryo.diameter_um={280 * k}",
            f"embryo.elements_per_cell=[{n},{n},{m}]", f"region.furrow.cells_along={14 * k}",
            f"region.furrow.cells_across={5 * k}"]
        options = [word for setting in settings for word in ("--set", setting)]
        return self.run(self.plica, "run", "drosophila", "--out", Path(folder) / "out", "--overwrite", "--quiet", *options,
                        threads=threads, under=under, good=(0, 1))  # 1: another depth than the paper's cells have

    def count_instructions(self, what, embryo):
        if what == "step":
            return self.instructions(lambda under: self.run(self.step, *embryo.options, under=under),
                                     "--toggle-collect=*take_step*")
        with tempfile.TemporaryDirectory() as folder:
            return self.instructions(lambda under: self.run_plica(embryo, 1, folder, under))

    def require_memory(self, embryo):
        needed, available = embryo.elements * BYTES_PER_ELEMENT_AT_LEAST, memory_available_bytes()
        if needed > available:
            raise Failed(f"needs {needed / 2**30:.0f} GiB or more, {available / 2**30:.0f} GiB are free")
