"""Experiments that are written down before they are run, and what comes out."""
from __future__ import annotations

import os
import shutil
import subprocess
import sysconfig
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

from ._core import version
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
    """Runs experiments and judges what comes out, as ``plica reproduce`` does; goes on with what `out` holds of them.

    The program ``plica`` does it: that of the same installation, else of PATH, or the one that PLICA in the environment
    names.

    Parameters
    ----------
    what : str or path
        ``"living"``, the living embryo, or a file of experiments (docs/how-to/predictions.md).
    out : str or path
        A directory for the runs, the table ``experiments.csv``, and the page: ``living.html``, or with the file's name.
    jobs : int, optional
        Runs at a time, each on one thread; 2 by default. Results do not depend on it.
    quick : bool, optional
        The first draw only, without slow experiments.
    overwrite : bool, optional
        Replace the experiments in `out`.
    progress : bool, optional
        Show on stderr how many runs have ended.

    Returns
    -------
    pandas.DataFrame
        A row for each outcome and draw: experiment, outcome, draw (from 1), status (of the run), quantity (a number of
        summary.json, its unit in its name), own, other (its values here and in the experiment that it is compared with),
        number (what is judged), judgement (hit, miss, undecided, not solved), reason (of a run without a result).

    Raises
    ------
    ValueError
        The experiments, their scenarios or draws are wrong, each line with file, line, key and what would be right; or
        `out` holds something else.
    FileError
        Something cannot be read or written, or there is no program.
    KeyboardInterrupt
        Ctrl-C. The same call goes on.

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
    if os.fspath(what) == "paper":
        raise ValueError("what: the paper has no table of outcomes; run plica reproduce --out DIR on the command line")
    command = [_program(), "reproduce", os.fspath(what), "--out", os.fspath(out)]
    command += ["--jobs", str(jobs)] if jobs is not None else []
    command += [f"--{name}" for name, given in (("quick", quick), ("overwrite", overwrite)) if given]
    # Not --quiet with a bar: what the command prints at its end is not shown.
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
    """The program of this version. FileError where there is none."""
    beside = Path(sysconfig.get_path("scripts")) / "plica"
    found = os.environ.get("PLICA") or (str(beside) if beside.exists() else shutil.which("plica"))
    if not found:
        raise FileError("the program plica is not found; install it, or name it by PLICA in the environment")
    try:
        told = subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout.split()
    except OSError as error:
        raise FileError(f"{found}: cannot be run: {error}") from error
    if told[1:2] != [version]:
        raise FileError(f"{found}: is plica {' '.join(told[1:2])}, and this is {version}; install the same of both")
    return found
