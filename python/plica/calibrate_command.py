"""``plica calibrate --method gradient``, which the program hands over to this package: `fit`, with the words of the command line."""
from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import Any, Optional

from .errors import FileError
from .fit_files import read_targets, write_scenario
from .fits import fit
from .scenario import Scenario

DONE, MISSED, INTERRUPTED = 0, 1, 130
USUAL_PART = 0.005  # standard deviation of a target that gives none, as of the other method


def add_parser(commands: Any) -> None:
    """Add the command, with the options of ``plica calibrate``."""
    parser = commands.add_parser(
        "calibrate", help="fit keys by gradients: plica calibrate --method gradient",
        description="Fit keys of a scenario to targets, by slopes of runs.",
        epilog="example: plica calibrate furrow-slice --method gradient --vary cortex.apical.tension_mN_per_m=1:2 "
               "--target furrow_depth_um@9=8~0.5 --out mine.toml")
    parser.add_argument("scenario", help="TOML file, or built-in name")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of all scenarios; repeatable")
    parser.add_argument("--vary", action="append", default=[], required=True, metavar="KEY=LOW:HIGH", help="key, with bounds; repeatable")
    parser.add_argument("--target", action="append", default=[], metavar="NAME[@MIN]=VALUE[~SD]",
                        help="outcome at the end, or at a time in minutes; SD in its unit or as 2%% (default: 0.5%%); repeatable")
    parser.add_argument("--targets", metavar="FILE.csv", help="targets: outcome, value, sd, and if needed at_min, scenario")
    parser.add_argument("--prior", action="append", default=[], metavar="KEY=VALUE~SD", help="normal prior of a key; repeatable")
    parser.add_argument("--starts", type=int, default=1, help="number of starts (1)")
    parser.add_argument("--early-min", type=float, help="fit targets up to this time first, then all")
    parser.add_argument("--trials", type=int, default=40, help="most runs of each start (40)")
    parser.add_argument("--folder", help="folder for runs, so that the command continues after an interruption, tables and figure")
    parser.add_argument("--out", help="FILE.toml to write: the fitted scenario")
    parser.add_argument("--threads", type=int, default=1, help="number of threads (1)")
    parser.add_argument("--overwrite", action="store_true", help="replace an existing file")


def calibrate(given: argparse.Namespace) -> int:
    """Run the command and return its exit status."""
    out = None if given.out is None else Path(given.out)
    if out is not None:
        if out.suffix != ".toml":
            raise ValueError(f"--out {out}: give a name that ends in .toml")
        if out.exists() and not given.overwrite:
            raise FileError(f"{out}: exists; set --overwrite, or another name")
    bounds = dict(_vary(text) for text in given.vary)
    priors = dict(_value_and_sd(text, "--prior", "KEY=VALUE~SD") for text in given.prior)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # printed with the result
            found = fit(_experiments(given), of=bounds, priors=priors, early_min=given.early_min, starts=given.starts,
                        runs=given.trials, folder=given.folder, threads=given.threads, progress=sys.stderr.isatty())
    except KeyboardInterrupt:
        where = "repeat the command to continue" if given.folder else "set --folder to be able to continue"
        print(f"plica: interrupted; {where}", file=sys.stderr)
        return INTERRUPTED
    print(found)
    if out is not None:
        write_scenario(found, 0, out)
        print(f"The scenario is in {out}")
    return DONE if found.end == "converged" and not found.has_model_error else MISSED


def _experiments(given: argparse.Namespace) -> list[tuple[Scenario, dict[str, Any]]]:
    targets: dict[str, dict[str, Any]] = read_targets(given.targets) if given.targets else {}
    for text in given.target:
        name, pair = _value_and_sd(text, "--target", "NAME=VALUE~SD, NAME@MIN=VALUE~SD or NAME=VALUE~2%")
        outcome, _, minute = name.partition("@")
        of_outcome = targets.setdefault("", {}).setdefault(outcome, {})
        at = _number(minute, f"--target {text}") if minute else None
        if at in of_outcome:
            raise ValueError(f"--target {text}: {outcome} has two targets at one time; remove one")
        of_outcome[at] = pair
    if not targets:
        raise ValueError("no target; give --target or --targets")
    changes = dict(_split(text, "--set", "KEY=VALUE") for text in given.set)
    found = []
    for name, of_one in sorted(targets.items()):  # that of the command line first
        scenario = Scenario(name or given.scenario)
        scenario._load(changes=changes)
        found.append((scenario, of_one))
    return found


def _split(text: str, option: str, form: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not name or not equals:
        raise ValueError(f"{option} {text}: give {form}")
    return name.strip(), value.strip()


def _vary(text: str) -> tuple[str, tuple[float, float]]:
    key, value = _split(text, "--vary", "KEY=LOW:HIGH")
    low, _, high = value.partition(":")
    return key, (_number(low, f"--vary {text}"), _number(high, f"--vary {text}"))


def _value_and_sd(text: str, option: str, form: str) -> tuple[str, tuple[float, float]]:
    name, pair = _split(text, option, form)
    first, tilde, second = pair.partition("~")
    where = f"{option} {text}"
    value = _number(first, where)
    if not tilde:
        sd = USUAL_PART * abs(value)
    elif second.endswith("%"):
        sd = _number(second[:-1], where) / 100 * abs(value)
    else:
        sd = _number(second, where)
    if not sd > 0:
        raise ValueError(f"{where}: standard deviation {sd:g}; give one above 0, as {form}")
    return name, (value, sd)


def _number(text: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{where}: {text!r}; give a number") from None


__all__ = ["add_parser", "calibrate"]
