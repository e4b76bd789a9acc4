"""Files of a fit: a table of targets that it reads; keys, targets, scenarios and a figure that it leaves."""
from __future__ import annotations

import csv
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _core
from .errors import FileError, MissingExtra, ScenarioError
from .scenario import GIVEN, Scenario, _toml_value

if TYPE_CHECKING:
    from .fits import Fit

COLUMNS = {"scenario", "outcome", "at_min", "value", "sd"}
NEEDED = ("outcome", "value", "sd")
Pairs = dict[str, dict[Optional[float], tuple[float, float]]]  # outcome, minutes, (value, sd)


def read_targets(file: Union[str, os.PathLike[str]]) -> dict[str, Pairs]:
    """Read a table (CSV) of targets: by scenario, outcome and minutes; "" is the scenario of rows that name none.

    Other scenarios are built-in names, or files beside the table.
    """
    path = Path(file)
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            table = csv.DictReader(stream)
            heads = [head.strip() for head in table.fieldnames or []]
            table.fieldnames = heads
            rows = [{name: (text or "").strip() for name, text in row.items() if name in COLUMNS} for row in table]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise FileError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
    missing = [name for name in NEEDED if name not in heads]
    if missing or set(heads) - COLUMNS:
        raise FileError(f"{path}:1: columns {', '.join(heads) or 'none'}; give outcome, value, sd, and if needed scenario, at_min")
    found: dict[str, Pairs] = {}
    for line, row in enumerate(rows, 2):
        minute = _number(row["at_min"], "at_min", path, line) if row.get("at_min") else None
        pair = (_number(row["value"], "value", path, line), _number(row["sd"], "sd", path, line))
        if pair[1] <= 0:
            raise FileError(f"{path}:{line}: sd: {pair[1]:g}; give a standard deviation above 0")
        name = row.get("scenario", "")
        if name and name not in _core.scenarios:
            name = str(path.parent / name)
        of_outcome = found.setdefault(name, {}).setdefault(row["outcome"], {})
        if minute in of_outcome:
            raise FileError(f"{path}:{line}: {row['outcome']}: has two targets at one time; remove one")
        of_outcome[minute] = pair
    if not found:
        raise FileError(f"{path}: has no row; give one per target")
    return found


def _number(text: str, column: str, path: Path, line: int) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise FileError(f"{path}:{line}: {column}: {text!r}; give a number")
    return number


def write_scenario(fit: Fit, index: int, file: Path) -> None:
    """Write a fitted scenario: its source as base, and what differs; the complete scenario if that would not be the same."""
    scenario = fit.scenarios[index]
    head = f"# Fitted by plica in {fit.runs} runs; score {fit.score:.4g} of {len(fit.misses)} targets.\n"
    head += "".join(f"# {key}: {low:.4g} to {high:.4g} (90 %)\n" for key, (low, high) in fit.intervals().items())
    source = scenario._source[1]
    if source != GIVEN and not (scenario._regions or scenario._arrays or scenario.tissue):
        base = source if source in _core.scenarios else os.path.relpath(Path(source).resolve(), file.resolve().parent)
        lines = [f"{key} = {text}\n" for key, text in scenario._changes.items()]
        _write(file, f"{head}format = 1\nbase = {_toml_value(base, 'base')}\n{''.join(lines)}")
        try:
            if not Scenario(file).diff(scenario):
                return
        except ScenarioError:
            pass
    _write(file, head + scenario.to_toml().partition("\n[expect.")[0] + "\n")


def write_tables(fit: Fit, folder: Path) -> None:
    """Write keys.csv, targets.csv, fit.txt, a file per scenario, and with Matplotlib fit.png."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder}: cannot be made: {error.strerror}") from error
    names = [one.name if sum(other.name == one.name for other in fit.scenarios) == 1 else f"{one.name}-{index}"
             for index, one in enumerate(fit.scenarios)]
    ends = fit.intervals()
    _write_table(folder / "keys.csv", ["key", "value", "low", "high", "lower_bound", "upper_bound"],
                 [[key, value, *ends[key], *fit.bounds[key]] for key, value in fit.values.items()])
    _write_table(folder / "targets.csv", ["scenario", "outcome", "at_min", "value", "sd", "found", "deviations"],
                 [[names[one.scenario], *one[1:], one.deviations] for one in fit.misses])
    _write(folder / "fit.txt", f"{fit}\n")
    for index, name in enumerate(names):
        write_scenario(fit, index, folder / f"{name}.toml")
    try:
        fit.plot().savefig(folder / "fit.png", dpi=150)
    except MissingExtra:
        pass


def _write_table(file: Path, heads: list[str], rows: list[list[Any]]) -> None:
    try:
        with file.open("w", encoding="utf-8", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerows([heads, *rows])
    except OSError as error:
        raise FileError(f"{file}: cannot be written: {error.strerror}") from error


def _write(file: Path, text: str) -> None:
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(f"{file}: cannot be written: {error.strerror}") from error
