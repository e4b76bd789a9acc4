"""Parameter studies: many runs of a scenario with varied keys, and their table."""
from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _core
from .answers import curves as curves_of
from .answers import phase_diagram as phase_diagram_of
from .arguments import callable_of, path_of, whole
from .emulator import emulator as emulator_of
from .errors import FileError
from .indices import sobol_indices as sobol_indices_of
from .study_table import StudyTable
from .study_workers import by_executor, by_processes

if TYPE_CHECKING:
    import pandas

__all__ = ["Study"]


class Study(StudyTable):
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
    ...     "keep": {"measures": ["max_displacement_um"]},
    ... })
    >>> study
    Study('study' of division-demo: 2 runs of elasticity.young_modulus_Pa)
    >>> table = study.run(jobs=1)
    >>> list(table.status)
    ['end_time', 'end_time']
    """

    @classmethod
    def _of_table(cls, source: Union[str, Mapping[str, Any]], table: pandas.DataFrame) -> Study:
        """Make a study with given results, a table like ``Study(source).table``; for tests."""
        study = cls(source)
        lines = table.to_csv(index=False).splitlines()
        if lines[0] != study._core.header or len(lines) != len(study) + 1:
            raise ValueError(f"a table of {len(lines) - 1} rows of {lines[0]}; give {len(study)} of {study._core.header}")
        study._rows = dict(enumerate(lines[1:]))
        return study

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
        rows = by_executor(executor, spec, open_runs) if executor else by_processes(jobs, spec, open_runs, self._core)
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

    curves = curves_of
    phase_diagram = phase_diagram_of
    sobol_indices = sobol_indices_of
    emulator = emulator_of

    def __repr__(self) -> str:
        runs = f"{len(self)} run{'s' if len(self) != 1 else ''}"
        return f"Study({self._spec.name!r} of {self._core.scenario_name}: {runs} of {', '.join(self.keys)})"


def _in_python(message: str) -> str:
    """Translate options in a message of the command line into arguments of `Study.run`."""
    for option, argument in (("--resume", "resume=True"), ("--overwrite", "overwrite=True"), ("--out", "out")):
        message = message.replace(option, argument)
    return message


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
