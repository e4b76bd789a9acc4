"""Simulated experiments with predictions registered before they run."""
from __future__ import annotations

import os
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

from ._core import version
from .arguments import path_of, whole
from .errors import FileError, PlicaError
from .results import _pandas

if TYPE_CHECKING:
    import pandas

__all__ = ["reproduce"]


def reproduce(
    what: Union[str, os.PathLike[str]],
    out: Union[str, os.PathLike[str]],
    *,
    jobs: Optional[int] = None,
    quick: bool = False,
    overwrite: bool = False,
    progress: bool = False,
) -> pandas.DataFrame:
    """Run experiments and compare results with observations, as ``plica reproduce`` does.

    Existing results in `out` are continued. The function calls the program ``plica`` of the same installation, else the one on
    PATH; the environment variable ``PLICA`` overrides both.

    Parameters
    ----------
    what : str or path
        ``"paper"``, ``"living"`` (the living embryo), or a file of experiments (docs/how-to/predictions.md).
    out : str or path
        Directory for the runs, the tables ``outcomes.csv`` and ``experiments.csv``, and ``report.html``.
    jobs : int, optional
        Simultaneous runs, each on one thread; by default 2. Results do not depend on it.
    quick : bool, optional
        Run only the first parameter sample, without slow experiments.
    overwrite : bool, optional
        Replace existing results in `out`.
    progress : bool, optional
        Report finished runs on stderr.

    Returns
    -------
    pandas.DataFrame
        One row per outcome and parameter sample: experiment, outcome, draw (sample, from 1), status (of the run), quantity
        (a value of summary.json, unit in the name), own and other (its values here and in the experiment it is compared
        with), number (the compared value), judgement (hit, miss, undecided, not solved), reason (if a run has no result).

    Raises
    ------
    ValueError
        If experiments, scenarios or samples are invalid (each line names file, line, key and fix), or `out` has other
        content.
    FileError
        If a file cannot be read or written, or the program is missing.
    KeyboardInterrupt
        On Ctrl-C. The same call continues.

    Examples
    --------
    >>> import pathlib, tempfile, plica
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = (folder / "growth.toml").write_text('''
    ... scenario = "division-demo"
    ... [experiment.soft]
    ... question = "Does the daughter grow in soft cells?"
    ... prediction = "hit"
    ... set = { "elasticity.young_modulus_Pa" = 500 }
    ... [experiment.soft.outcome.cells]
    ... quantity = "cells"
    ... hit = [4, 4]
    ... ''')
    >>> table = plica.reproduce(folder / "growth.toml", folder / "out", jobs=1)
    >>> table.loc[0, "judgement"]
    'hit'
    """
    what, out = path_of(what, "what"), path_of(out, "out")
    command = [_program(), "reproduce", what, "--out", out]
    command += ["--jobs", str(whole(jobs, "jobs"))] if jobs is not None else []
    command += [f"--{name}" for name, given in (("quick", quick), ("overwrite", overwrite)) if given]
    # With progress, stderr is needed, so only stdout is discarded.
    command += [] if progress else ["--quiet"]
    ran = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, text=True, check=False,
                         stderr=None if progress else subprocess.PIPE)
    if ran.returncode == 130:
        raise KeyboardInterrupt
    if ran.returncode != 0:
        message = (ran.stderr or f"plica reproduce ended with status {ran.returncode}").strip().removeprefix("plica: ")
        raise {2: ValueError, 4: FileError}.get(ran.returncode, PlicaError)(message)
    table: pandas.DataFrame = _pandas("the table of experiments").read_csv(
        Path(out) / "experiments.csv", float_precision="round_trip"
    )
    return table


def _program() -> str:
    """Return the path of the program of this version. FileError if there is none."""
    beside = Path(sysconfig.get_path("scripts")) / "plica"
    found = os.environ.get("PLICA") or (str(beside) if beside.exists() else shutil.which("plica"))
    if not found:
        raise FileError("the program plica was not found; install it, or set the environment variable PLICA to its path")
    try:
        told = subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout.split()
    except OSError as error:
        raise FileError(f"{found}: cannot be run: {error}") from error
    if told[1:2] != [version]:
        raise FileError(f"{found}: is plica {' '.join(told[1:2])}, but the package is {version}; install the same version of both")
    return found
