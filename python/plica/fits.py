"""Fits of keys to many outcomes at many times in several scenarios, by slopes of runs.

The method is Gauss–Newton within a trust region and bounds, on logarithms of keys (descent.py). scipy.optimize.least_squares knows
no errors of targets: here a fit ends where no step gains more than a fraction of a standard deviation.
"""
from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from statistics import NormalDist
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .arguments import number, number_from, path_of, told, whole
from .descent import End, descend
from .errors import NumericsError, needed
from .fit_files import write_tables
from .fit_problem import Problem, Scale, Source, experiments_of, largest_by_chance, name_of
from .local_energy import LocalEnergy
from .names import in_columns, label, name_and_unit
from .progress import Counter
from .scenario import Scenario

__all__ = ["Combination", "Fit", "Miss", "fit"]

Array = NDArray[np.float64]
SOFT = 0.5  # part of the spread within the bounds above which a combination is open


class Miss(NamedTuple):
    """Target and what the fit has there.

    Attributes
    ----------
    scenario : int
        Index of the scenario.
    outcome : str
        Output variable, or name of the function.
    at_min : float or None
        Time, minutes; None for the end of the run.
    value, sd : float
        The target.
    found : float
        Value of the fit.
    """

    scenario: int
    outcome: str
    at_min: Optional[float]
    value: float
    sd: float
    found: float

    @property
    def deviations(self) -> float:
        """Difference from the target in standard deviations."""
        return (self.found - self.value) / self.sd


class Combination(NamedTuple):
    """Product of powers of keys that targets determine, or keys that may change together.

    Attributes
    ----------
    powers : dict of str to float
        Power of each key in the product; the largest is 1. If open: powers of a common factor by which the keys may change.
    sd : float
        Standard deviation of the logarithm of the product or factor (0.1 is about 10 %).
    is_open : bool
        Whether targets determine it to no better than half of the range of the bounds.
    """

    powers: dict[str, float]
    sd: float
    is_open: bool

    def __str__(self) -> str:
        large = sorted(((key, power) for key, power in self.powers.items() if abs(power) >= 0.25), key=lambda one: -abs(one[1]))
        names = [name_and_unit(key)[0] + ("" if round(power, 2) == 1 else f"^{power:.2g}") for key, power in large]
        return (", " if self.is_open else " · ").join(names)


@dataclass(frozen=True)
class Fit:
    """Result of `fit`.

    Attributes
    ----------
    values : dict of str to float
        Keys at the best place found.
    scenarios : list of Scenario
        The scenarios with these values.
    misses : list of Miss
        Targets, and what the fit has there.
    jacobian : ndarray of float
        A row per target, a column per key: derivatives in standard deviations of targets by logarithms of keys (by the key for
        one whose bounds include 0).
    covariance : ndarray of float
        Covariance of these logarithms near the best place, bounds apart; a row and a column per key.
    runs : int
        Runs of all scenarios together, over all starts.
    end : str
        "converged", "no better place nearby" (a kink, or slopes that are too coarse) or "runs spent".
    starts : list of (float, dict)
        Score and values at the end of each start.
    bounds : dict of str to (float, float)
        Bounds of each key.
    energies : dict of str to LocalEnergy
        The force laws that were given, with these values.
    """

    values: dict[str, float]
    scenarios: list[Scenario]
    misses: list[Miss]
    jacobian: Array
    covariance: Array
    runs: int
    end: str
    starts: list[tuple[float, dict[str, float]]]
    bounds: dict[str, tuple[float, float]]
    _information: Array = field(repr=False)  # of targets and priors, in logarithms
    energies: dict[str, LocalEnergy] = field(default_factory=dict, repr=False)

    @property
    def score(self) -> float:
        """Sum of squared deviations of all targets; about their number minus that of keys if model and errors are right."""
        return sum(one.deviations**2 for one in self.misses)

    @property
    def has_model_error(self) -> bool:
        """Whether targets are missed by more than their errors: a right model has such a score with a probability below 0.1 %, by the
        chi-square distribution for targets without identified combinations. Intervals are then too narrow."""
        return self.score > largest_by_chance(max(len(self.misses) - sum(not one.is_open for one in self.combinations), 1))

    def intervals(self, level: float = 0.9) -> dict[str, tuple[float, float]]:
        """Return the interval of each key at a level, within its bounds (normal in the logarithm).

        Parameters
        ----------
        level : float
            Probability, above 0 and below 1.
        """
        if not 0 < number(level, "level") < 1:
            raise ValueError(f"level: {told(level)}; give a number above 0 and below 1")
        width = NormalDist().inv_cdf(0.5 + level / 2) * np.sqrt(np.diag(self.covariance))
        found = {}
        for (key, value), away in zip(self.values.items(), width):
            scale = Scale.of(*self.bounds[key])
            at = scale.to(value)
            low, high = (scale.back(float(np.clip(end, scale.low, scale.high))) for end in (at - away, at + away))
            found[key] = (low, high)
        return found

    @property
    def combinations(self) -> list[Combination]:
        """Independent combinations of keys, best known first."""
        keys = list(self.values)
        spread = np.array([Scale.of(*self.bounds[key]).spread for key in keys])
        known, directions = np.linalg.eigh(self._information * np.outer(spread, spread))
        found = []
        for one, direction in sorted(zip(known, directions.T), key=lambda pair: -float(pair[0])):
            part = min(1 / math.sqrt(max(float(one), 1e-30)), 1.0)  # of the spread
            is_open = part > SOFT
            powers = direction * spread if is_open else direction / spread
            largest = powers[np.argmax(np.abs(powers))]
            sd = part * abs(float(largest if is_open else 1 / largest))
            found.append(Combination(dict(zip(keys, (powers / largest).tolist())), sd, is_open))
        return found

    def plot(self) -> Any:
        """Plot deviations of targets, and intervals of keys within their bounds.

        Returns
        -------
        matplotlib.figure.Figure
        """
        plt = needed("matplotlib.pyplot", "plot")
        figure, (left, right) = plt.subplots(1, 2, figsize=(10, 1.5 + 0.25 * max(len(self.misses), len(self.values))), layout="constrained")
        places = range(len(self.misses))
        left.barh(places, [one.deviations for one in self.misses], color="#0072B2")
        left.set_yticks(places, [_title(one) for one in self.misses], fontsize=7)
        left.set(xlabel="found - target (standard deviations)")
        left.axvspan(-1, 1, color="0.9", zorder=0)
        for place, (key, ends) in enumerate(self.intervals().items()):
            scale = Scale.of(*self.bounds[key])
            low, at, high = ((scale.to(value) - scale.low) / (scale.high - scale.low) for value in (ends[0], self.values[key], ends[1]))
            right.plot([low, high], [place, place], color="#0072B2", lw=3)
            right.plot(at, place, "o", color="black", ms=4)
        right.set_yticks(range(len(self.values)), [label(key) for key in self.values], fontsize=7)
        right.set(xlim=(0, 1), xticks=[0, 1], xticklabels=["lower bound", "upper bound"], title="90 % intervals")
        for ax in (left, right):
            ax.invert_yaxis()
        return figure

    def write(self, folder: Union[str, os.PathLike[str]]) -> None:
        """Write the result into a folder: ``keys.csv``, ``targets.csv``, ``fit.txt``, each scenario, and with Matplotlib ``fit.png``.

        Parameters
        ----------
        folder : str or path
            Made if it does not exist; files of an earlier fit there are replaced.

        Raises
        ------
        FileError
            If a file cannot be written.
        """
        write_tables(self, Path(path_of(folder, "folder")))

    def __str__(self) -> str:
        rows: list[tuple[str, ...]] = [
            (key, f"{self.values[key]:.4g}", *(f"{end:.4g}" for end in ends), _at_bound(self.values[key], self.bounds[key]))
            for key, ends in self.intervals().items()]
        goals: list[tuple[str, ...]] = [
            (_title(one), f"{one.value:.4g}", f"{one.sd:.2g}", f"{one.found:.4g}") for one in self.misses]
        told_of = [f"Fit: {self.end} after {self.runs} runs; score {self.score:.3g} of {len(self.misses)} targets",
                   *in_columns(rows, ("key", "value", "5 %", "95 %", "")), *in_columns(goals, ("target", "value", "sd", "found"))]
        for is_open, heading in ((False, "Identified (relative sd):"), (True, "Left open by the targets (keys that may change together):")):
            here = [f"  {one.sd:8.2g}  {one}" for one in self.combinations if one.is_open == is_open]
            told_of += [heading, *here] if here else []
        if self.has_model_error:
            told_of.append("Targets are missed by more than their errors: the model differs, and intervals are too narrow.")
        return "\n".join(told_of)

    __repr__ = __str__


def fit(
    scenario: Union[Source, Iterable[tuple[Source, Mapping[Any, Any]]]],
    targets: Optional[Mapping[Any, Any]] = None,
    *,
    of: Mapping[str, tuple[float, float]],
    priors: Optional[Mapping[str, tuple[float, float]]] = None,
    energies: Optional[Mapping[str, LocalEnergy]] = None,
    early_min: Optional[float] = None,
    starts: int = 1,
    seed: int = 1,
    runs: int = 30,
    tolerance: float = 0.01,
    folder: Union[None, str, os.PathLike[str]] = None,
    threads: int = 1,
    progress: bool = False,
) -> Fit:
    """Fit keys to targets, by slopes of runs (`Tape.jacobian`).

    Parameters
    ----------
    scenario : Scenario, str, path, mapping, or list of (scenario, targets)
        Scenario, or several that share the keys, each with its targets.
    targets : mapping
        Of one scenario: outcomes (as for `Tape.gradient`), each with (value, sd) at the end of the run, or with a mapping of
        minutes to (value, sd). `sd` is the standard deviation of measurement and model error.
    of : mapping of str to (float, float)
        Keys, each with its bounds. The first start has the values of the (first) scenario. Keys with bounds above 0 are fitted by
        their logarithms.
    priors : mapping of str to (float, float), optional
        Normal priors of keys: value and standard deviation, in the key's unit.
    energies : dict of str to LocalEnergy, optional
        Force laws by name, as for `record`. Their numbers are keys, ``"energy.NAME.NUMBER"``; of one that differs between groups,
        a factor on all is fitted, which starts at 1.
    early_min : float, optional
        Fit the targets up to this time first, then all. Advised where later frames depend on contact or a snap.
    starts : int
        Number of starts; those after the first are drawn between the bounds (`seed`). The best is returned.
    runs : int
        Most runs of each start; one run includes all scenarios.
    tolerance : float
        A start ends when the next step would lower the score by less.
    folder : path, optional
        Folder that keeps each run, so that the same call after an interruption continues; at the end also the files of
        `Fit.write`.
    threads : int
        Threads per step.
    progress : bool
        Whether to show progress.

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        If a key, outcome or target is not valid, or the run has no gradient (see `record`).
    NumericsError
        If the first run of every start fails. Later runs that fail shorten the step.
    FileError
        If the folder holds another fit.

    Warns
    -----
    UserWarning
        If targets are missed by more than their errors (`Fit.has_model_error`).

    Examples
    --------
    >>> import plica
    >>> block = plica.Scenario({
    ...     "format": 1, "time": {"end_s": 60}, "stop": {"at_equilibrium": False},
    ...     "cortex": {"top": {"region": "all", "tension_mN_per_m": 2}},
    ...     "embryo": {"shape": "block", "length_um": 60, "width_um": 40, "cell_height_um": 20, "cells": [3, 2, 1]},
    ...     "monitor": {"top": {"quantity": "area", "over": "sum"}}})
    >>> key = "cortex.top.tension_mN_per_m"
    >>> area = plica.record(block).value("top.area_um2")
    >>> block[key] = 1
    >>> found = plica.fit(block, {"top.area_um2": (area, 1)}, of={key: (0.5, 5)})
    >>> round(found.values[key], 2)
    2.0
    """
    problem = Problem(experiments_of(scenario, targets), of, priors, threads, energies)
    whole(starts, "starts"), whole(runs, "runs", 2), whole(seed, "seed", 0, 2**32 - 1)
    least = number_from(tolerance, 0, "tolerance", "a number above 0", above=True)
    early = None if early_min is None else number_from(early_min, 0, "early_min", "a time in minutes")
    if early is not None and not problem.count_until(early):
        raise ValueError(f"early_min: {told(early_min)}; give a time at or after the first target")
    if folder is not None:
        problem.keep_in(Path(path_of(folder, "folder")))
    places = [problem.start, *np.random.default_rng(seed).uniform(problem.low, problem.high, (starts - 1, len(problem.keys)))]
    ends: list[End] = []
    failure: Optional[NumericsError] = None
    stages: list[Optional[float]] = [None] if early is None else [early, None]
    with Counter("fit", "run", progress) as counter:
        for place in places:
            try:
                end = End(place, math.inf, 0, "")
                for until in stages:
                    end = descend(problem, end, until, runs, least, counter)
                ends.append(end)
            except NumericsError as error:
                failure = error
    if not ends:
        assert failure is not None
        raise failure
    found = _result(problem, ends)
    if folder is not None:
        found.write(folder)
    if found.has_model_error:
        warnings.warn(f"fit: the score is {found.score:.3g} for {len(found.misses)} targets, which are missed by more than their "
                      "errors; another model or larger errors are needed", stacklevel=2)
    return found


def _result(problem: Problem, ends: list[End]) -> Fit:
    best = min(ends, key=lambda end: end.score)
    found, slopes = problem.run(best.place, None)["found"], problem.slopes(best.place, None)
    information = slopes.T @ slopes
    spread = np.array([scale.spread for scale in problem.scales])
    misses = [Miss(index, name_of(row.outcome), row.at_min, row.value, row.sd, value) for (index, row), value
              in zip([(index, row) for index, one in enumerate(problem.experiments) for row in one.rows], found)]
    scenarios = []
    for one in problem.experiments:
        scenarios.append(one.scenario.copy())
        scenarios[-1].update(problem.of_scenario(best.place))
    return Fit(
        values=problem.values_at(best.place), scenarios=scenarios, misses=misses, jacobian=slopes[:len(misses)],
        covariance=np.asarray(np.linalg.inv(information + np.diag(1e-9 / spread**2)), dtype=np.float64),
        runs=sum(end.runs for end in ends), end=best.end,
        starts=[(end.score, problem.values_at(end.place)) for end in ends], bounds=problem.bounds, _information=information,
        energies=problem.energies_at(best.place))


def _title(one: Miss) -> str:
    return f"{one.scenario}: {one.outcome}" + ("" if one.at_min is None else f" at {one.at_min:g} min")


def _at_bound(value: float, bounds: tuple[float, float]) -> str:
    return "at its bound" if any(math.isclose(value, end, rel_tol=1e-6) for end in bounds) else ""
