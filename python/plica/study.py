"""Parameter studies: many runs of a scenario with varied keys, and their table."""
from __future__ import annotations

import functools
import io
import json
import os
import pickle
import queue
import subprocess
import sys
import threading
import time
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor, as_completed
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

from . import _core, answers
from .arguments import callable_of, path_of, text_of, whole
from .emulator import emulator as emulator_of
from .errors import FileError, needed
from .indices import sobol_indices as sobol_indices_of
from .results import _pandas
from .scenario import GIVEN, _items, _toml_of

if TYPE_CHECKING:
    import pandas

__all__ = ["Study"]


class _Spec(NamedTuple):
    """Description of a study for a worker."""

    name: str
    file: str
    text: str
    points: str
    measures: tuple[str, ...]
    directory: str


class Study:
    """Parameter study: many runs of a scenario with varied keys, and a table with one row per run.

    Parameters
    ----------
    source : str, path or mapping
        TOML file of a study, TOML text (several lines) or dict with ``scenario``, ``vary``, ``design`` and optionally ``set``
        and ``keep`` (docs/how-to/studies.md); or the directory of a finished or running study.

    Raises
    ------
    ScenarioError
        If the study is invalid; lists every error with its key and fix.
    FileError
        If the file cannot be read.

    Examples
    --------
    >>> import plica
    >>> study = plica.Study({
    ...     "scenario": "division-demo",
    ...     "set": {"time.end_min": 1},
    ...     "vary": {"elasticity.young_modulus_Pa": {"values": [500, 1000]}},
    ...     "design": {"kind": "grid"},
    ...     "keep": {"measures": ["furrow_depth_um"]},
    ... })
    >>> study
    Study('study' of division-demo: 2 runs of elasticity.young_modulus_Pa)
    >>> table = study.run(jobs=1)
    >>> list(table.status)
    ['end_time', 'end_time']
    """

    def __init__(self, source: Union[str, os.PathLike[str], Mapping[str, Any]]) -> None:
        if isinstance(source, Mapping):
            name, file, text = "study", GIVEN, _toml_of(source)
        elif isinstance(source, str) and "\n" in source:
            name, file, text = "study", GIVEN, text_of(source, "source")
        else:
            path = Path(path_of(source, "source"))
            name, file, text = path.stem, str(path), "" if path.is_dir() else _text_of(path)
        self._rows: dict[int, str] = {}
        self._directory: Optional[Path] = None
        if text:
            self._core = _core.Study(name, file, text)
        else:
            self._directory = path
            begun = json.loads(_text_of(path / "study.json"))
            name, file, text = begun["name"], begun["file"], _text_of(path / "study.toml")
            directory, self._core = _core.StudyDirectory.open(str(path))
            self._rows = dict(directory.rows)
        self._spec = _Spec(name, file, text, self._core.points_csv, tuple(self._core.measures), "")

    @classmethod
    def _of_table(cls, source: Union[str, Mapping[str, Any]], table: pandas.DataFrame) -> Study:
        """Make a study with given results, a table like ``Study(source).table``; for tests."""
        study = cls(source)
        lines = table.to_csv(index=False).splitlines()
        if lines[0] != study._core.header or len(lines) != len(study) + 1:
            raise ValueError(f"a table of {len(lines) - 1} rows of {lines[0]}; give {len(study)} of {study._core.header}")
        study._rows = dict(enumerate(lines[1:]))
        return study

    @property
    def kind(self) -> str:
        """Kind of the design, such as "grid" or "sobol"."""
        return str(self._given["design.kind"])

    @property
    def _given(self) -> dict[str, Any]:
        """Contents of the study file, by dotted keys."""
        return dict(_items(tomllib.loads(self._spec.text)))

    def _run_directory(self, run: int) -> Path:
        """Return the directory of the kept files of a run, counted from 0."""
        return Path(self._directory or ".") / "points" / self._core.name_of(run)

    @property
    def keys(self) -> list[str]:
        """Keys that vary."""
        return self._core.keys

    @property
    def measures(self) -> list[str]:
        """Output variables in the table."""
        return self._core.measures

    @property
    def points(self) -> pandas.DataFrame:
        """Runs in order: point, replicate, and values of the keys."""
        table = self.table
        return table[["point", "replicate", *self.keys]]

    @property
    def table(self) -> pandas.DataFrame:
        """Results, one row per run: point, keys, replicate, status, output variables, steps, wall_s, reason.

        Runs that have not been made have status ``not_run``.
        """
        rows = [self._rows.get(run) or self._core.not_run(run) for run in range(len(self))]
        text = io.StringIO("\n".join([self._core.header, *rows]))
        table: pandas.DataFrame = _pandas("the table of a study").read_csv(text, float_precision="round_trip")
        return table

    def to_xarray(self) -> Any:
        """Return output variables over the keys: one dimension per key for a grid, else over points.

        Returns
        -------
        xarray.Dataset
        """
        needed("xarray", "a study as an xarray")
        table = self.table
        replicates = ["replicate"] if table.replicate.nunique() > 1 else []
        dimensions = [key for key in self.keys if table[key].nunique() > 1] + replicates
        is_grid = not table.duplicated(dimensions).any() and len(table) == table[dimensions].nunique().prod()
        index = dimensions if is_grid and dimensions else ["point", *replicates]
        kept = [*([] if is_grid else self.keys), "status", *self.measures, "steps"]
        return table.set_index(index)[kept].to_xarray()

    def run(
        self,
        *,
        out: Optional[Union[str, os.PathLike[str]]] = None,
        jobs: Optional[int] = None,
        executor: Optional[Executor] = None,
        overwrite: bool = False,
        resume: bool = False,
        progress: bool = False,
    ) -> pandas.DataFrame:
        """Run all runs that have not been made.

        Parameters
        ----------
        out : str or path, optional
            Directory for the table and kept files, as written by ``plica study --out``. Rows are written as runs end.
        jobs : int, optional
            Number of local processes; by default one per core.
        executor : concurrent.futures.Executor, optional
            Executor used instead: a process pool, Dask's ``Client.get_executor()``, mpi4py, submitit. Its workers require
            plica and, if files are kept, access to `out`.
        overwrite, resume : bool, optional
            Replace, or continue, the study in `out`.
        progress : bool, optional
            Show a progress bar.

        Returns
        -------
        pandas.DataFrame
            `table`.

        Raises
        ------
        ValueError
            If files are kept but `out` is not given, or `out` has another study.
        FileError
            If a file cannot be written.
        KeyboardInterrupt
            On Ctrl-C. Finished runs are in `table` and in `out`, from which the study can be resumed.
        """
        if jobs is not None:
            jobs = whole(jobs, "jobs")
        if executor is not None:
            callable_of(getattr(executor, "submit", executor), "executor.submit")
        if out is None and self._core.keeps_files:
            raise ValueError("out is missing; set it, because keep.each of this study keeps files")
        directory = None
        if out is not None:
            start = "resumed" if resume else "over" if overwrite else "fresh"
            try:
                directory = _core.StudyDirectory.begin(path_of(out, "out"), self._core, start)
            except (ValueError, FileError) as error:
                raise type(error)(_in_python(str(error))) from None
            self._directory = Path(out)
            self._rows = dict(directory.rows)
        spec = self._spec._replace(directory="" if out is None else str(Path(out).resolve()))
        open_runs = [run for run in range(len(self)) if run not in self._rows]
        rows = _by_executor(executor, spec, open_runs) if executor else _by_processes(jobs, spec, open_runs, self._core)
        bar = _bar(len(self), len(self._rows)) if progress else None
        try:
            for run, row in rows:
                if not row:
                    continue  # taken by another process
                self._rows[run] = row
                if directory is not None:
                    directory.add(run, row)
                if bar is not None:
                    bar.update()
        finally:
            if bar is not None:
                bar.close()
            if directory is not None:
                self._rows = dict(directory.rows)
                directory.gather(self._core)
                directory.report()
        return self.table

    curves = answers.curves
    phase_diagram = answers.phase_diagram
    sobol_indices = sobol_indices_of
    emulator = emulator_of

    def __len__(self) -> int:
        return self._core.runs

    def __repr__(self) -> str:
        runs = f"{len(self)} run{'s' if len(self) != 1 else ''}"
        return f"Study({self._spec.name!r} of {self._core.scenario_name}: {runs} of {', '.join(self.keys)})"


def _in_python(message: str) -> str:
    """Translate options in a message of the command line into arguments of `Study.run`."""
    for option, argument in (("--resume", "resume=True"), ("--overwrite", "overwrite=True"), ("--out", "out")):
        message = message.replace(option, argument)
    return message


def _text_of(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: cannot be read: {error}") from error


@functools.lru_cache(maxsize=4)
def _study_of(spec: _Spec) -> _core.Study:
    return _core.Study(spec.name, spec.file, spec.text, spec.points, spec.measures)


def _rows_of(spec: _Spec, runs: list[int]) -> list[tuple[int, str]]:
    study = _study_of(spec)
    return [(run, study.row(run, spec.directory)) for run in runs]


def _by_executor(executor: Executor, spec: _Spec, runs: list[int]) -> Iterator[tuple[int, str]]:
    # Small batches, so that workers end at about the same time.
    size = max(1, min(50, len(runs) // 64))
    futures = [executor.submit(_rows_of, spec, runs[at : at + size]) for at in range(0, len(runs), size)]
    try:
        for future in as_completed(futures):
            yield from future.result()
    finally:
        for future in futures:
            future.cancel()


def _by_processes(jobs: Optional[int], spec: _Spec, runs: list[int], study: _core.Study) -> Iterator[tuple[int, str]]:
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

    def __init__(self, count: int, spec: _Spec, runs: Iterable[int], study: _core.Study) -> None:
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
                [sys.executable, "-c", "from plica.study import _work; _work()"],
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
    spec = _Spec(*pickle.load(sys.stdin.buffer))
    for line in sys.stdin.buffer:
        try:
            ((_, row),) = _rows_of(spec, [int(line)])
            print("row", row, flush=True)
        except FileError as error:
            print("error", " ".join(str(error).split("\n")), flush=True)


def _bar(total: int, done: int) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Line(total, done)
    return tqdm(total=total, initial=done, unit="run")


class _Line:
    """Progress line on the terminal, without tqdm."""

    def __init__(self, total: int, done: int) -> None:
        self.total, self.done, self.before, self.start = total, done, done, time.monotonic()

    def update(self) -> None:
        self.done += 1
        left_s = (time.monotonic() - self.start) * (self.total - self.done) / (self.done - self.before)
        left = f"{left_s:.0f} s" if left_s < 100 else f"{left_s / 60:.0f} min"
        print(f"\r{self.done} of {self.total} runs, {left} left ", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        print(file=sys.stderr)
