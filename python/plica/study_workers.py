"""Processes and executors that make the runs of a study."""
from __future__ import annotations

import functools
import os
import pickle
import queue
import subprocess
import sys
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, as_completed
from typing import NamedTuple, Optional, Union

from . import _core
from .errors import FileError


class Spec(NamedTuple):
    """Description of a study for a worker."""

    name: str
    file: str
    text: str
    points: str
    measures: tuple[str, ...]
    directory: str


@functools.lru_cache(maxsize=4)
def _study_of(spec: Spec) -> _core.Study:
    return _core.Study(spec.name, spec.file, spec.text, spec.points, spec.measures)


def _rows_of(spec: Spec, runs: list[int]) -> list[tuple[int, str]]:
    study = _study_of(spec)
    return [(run, study.row(run, spec.directory)) for run in runs]


def by_executor(executor: Executor, spec: Spec, runs: list[int]) -> Iterator[tuple[int, str]]:
    # Small batches, so that workers end at about the same time.
    size = max(1, min(50, len(runs) // 64))
    futures = [executor.submit(_rows_of, spec, runs[at : at + size]) for at in range(0, len(runs), size)]
    try:
        for future in as_completed(futures):
            yield from future.result()
    finally:
        for future in futures:
            future.cancel()


def by_processes(jobs: Optional[int], spec: Spec, runs: list[int], study: _core.Study) -> Iterator[tuple[int, str]]:
    count = min(jobs or len(os.sched_getaffinity(0)), len(runs))
    if count <= 1:
        yield from ((run, row) for one in runs for run, row in _rows_of(spec, [one]))
        return
    pool = _Processes(count, spec, runs, study)
    try:
        yield from pool.rows()
    finally:
        pool.stop()


class _Processes:
    """Pool of Python processes. If one dies, only its run is lost, and repeated.

    Not from multiprocessing, which runs the script of the caller again in each process, or forks a process with threads.
    """

    def __init__(self, count: int, spec: Spec, runs: Iterable[int], study: _core.Study) -> None:
        self.spec, self.study = spec, study
        self.open: queue.SimpleQueue[int] = queue.SimpleQueue()
        self.done: queue.SimpleQueue[Union[tuple[int, str], BaseException]] = queue.SimpleQueue()
        self.count = 0
        for run in runs:
            self.open.put(run)
            self.count += 1
        self.stopping = threading.Event()
        self.processes: list[Optional[subprocess.Popen[bytes]]] = [None] * count
        self.threads = [threading.Thread(target=self._serve, args=(w,), daemon=True) for w in range(count)]
        for thread in self.threads:
            thread.start()

    def rows(self) -> Iterator[tuple[int, str]]:
        for _ in range(self.count):
            row = self.done.get()
            if isinstance(row, BaseException):
                raise row
            yield row

    def stop(self) -> None:
        self.stopping.set()
        for process in self.processes:
            if process is not None and process.poll() is None:
                process.kill()
        for thread in self.threads:
            thread.join()

    def _serve(self, worker: int) -> None:
        try:
            while not self.stopping.is_set():
                try:
                    run = self.open.get_nowait()
                except queue.Empty:
                    break
                row, how = self._row(worker, run)
                if row is None and not self.stopping.is_set():
                    row, how = self._row(worker, run)
                self.done.put((run, self.study.crashed(run, f"its process ended twice, the second time by {how}") if row is None else row))
        except BaseException as error:
            self.done.put(error)
        self._end(worker)

    def _end(self, worker: int) -> None:
        process = self.processes[worker]
        if process is not None:
            with process:  # closes its pipes and waits for it
                pass

    def _row(self, worker: int, run: int) -> tuple[Optional[str], str]:
        process = self.processes[worker]
        if process is None or process.poll() is not None:
            self._end(worker)
            path = os.pathsep.join(entry for entry in sys.path if entry)
            process = subprocess.Popen(
                [sys.executable, "-c", "from plica.study_workers import _work; _work()"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env={**os.environ, "PYTHONPATH": path},
                start_new_session=True,  # only the parent receives Ctrl-C and ends them
            )
            self.processes[worker] = process
            assert process.stdin is not None
            pickle.dump(tuple(self.spec), process.stdin)
        assert process.stdin is not None and process.stdout is not None
        try:
            process.stdin.write(f"{run}\n".encode())
            process.stdin.flush()
            answer = process.stdout.readline().decode()
        except OSError:
            answer = ""
        if not answer.endswith("\n"):
            return None, f"status {process.wait()}"
        kind, _, text = answer[:-1].partition(" ")
        if kind == "error":
            raise FileError(text)
        return text, ""


def _work() -> None:
    """Main loop of such a process: read numbers of runs, write rows."""
    spec = Spec(*pickle.load(sys.stdin.buffer))
    for line in sys.stdin.buffer:
        try:
            ((_, row),) = _rows_of(spec, [int(line)])
            print("row", row, flush=True)
        except FileError as error:
            print("error", " ".join(str(error).split("\n")), flush=True)
