"""What a fit fits: scenarios, targets and keys, and the runs made so far."""
from __future__ import annotations

import hashlib
import json
import math
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from statistics import NormalDist
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import NDArray

from ._core import version
from .arguments import number_from, pair_of, pairs_of, text_of, told
from .errors import FileError, NumericsError
from .local_energy import LocalEnergy, laws_of, number_of
from .scenario import Scenario
from .simulation import Simulation
from .tapes import Tape, record

Array = NDArray[np.float64]
Source = Union[Scenario, str, os.PathLike[str], Mapping[str, Any]]
Outcome = Union[str, Callable[..., Any]]
ACCURACY = 1e-7  # of slopes


class Scale(NamedTuple):
    """Coordinate of a key: its logarithm if its bounds are above 0."""

    is_log: bool
    low: float
    high: float

    @classmethod
    def of(cls, low: float, high: float) -> Scale:
        return cls(True, math.log(low), math.log(high)) if low > 0 else cls(False, low, high)

    @property
    def spread(self) -> float:
        """Standard deviation between the bounds."""
        return (self.high - self.low) / math.sqrt(12)

    def to(self, value: float) -> float:
        return math.log(value) if self.is_log else value

    def back(self, place: float) -> float:
        return math.exp(place) if self.is_log else place


class Row(NamedTuple):
    outcome: Outcome
    at_min: Optional[float]
    value: float
    sd: float


class Experiment(NamedTuple):
    scenario: Scenario
    rows: list[Row]


class Problem:
    """Scenarios, targets and keys; places are coordinates of the keys. Each run is kept."""

    def __init__(self, experiments: list[Experiment], of: Mapping[str, tuple[float, float]],
                 priors: Optional[Mapping[str, tuple[float, float]]], threads: int,
                 energies: Optional[Mapping[str, LocalEnergy]] = None) -> None:
        laws_of(energies)
        self.experiments, self.threads, self.energies = experiments, threads, dict(energies or {})
        self.bounds = pairs_of(of, "of", "(low, high)")
        self.keys = list(self.bounds)
        if not self.keys:
            raise ValueError("of: give keys as {key: (low, high)}")
        for key, (low, high) in self.bounds.items():
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise ValueError(f"of[{told(key)}]: {low} to {high}; give finite bounds, the lower one first")
        self.scales = [Scale.of(*ends) for ends in self.bounds.values()]
        self.low, self.high = (np.array([getattr(scale, end) for scale in self.scales]) for end in ("low", "high"))
        first = experiments[0].scenario
        self.start = np.array([self._first_place(first, key, scale) for key, scale in zip(self.keys, self.scales)])
        self.priors = self._priors(pairs_of({} if priors is None else priors, "priors", "(value, sd)"))
        self.known: dict[tuple[float, ...], dict[str, Any]] = {}
        self.tapes: tuple[tuple[float, ...], list[Tape]] = ((), [])
        self.has_slopes = False  # of all targets, at some place
        self.file: Optional[Path] = None

    def _first_place(self, scenario: Scenario, key: str, scale: Scale) -> float:
        value = self._value(scenario, key)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"of: {key} is {told(value)}; choose keys that have a number")
        low, high = self.bounds[key]
        if not low <= value <= high:
            raise ValueError(f"of: {key} is {value:g}, outside {low:g} to {high:g}; set it within the bounds in the first scenario")
        return scale.to(float(value))

    def _value(self, scenario: Scenario, key: str) -> Any:
        if of_energy := number_of(self.energies, key):
            value = self.energies[of_energy[0]]._value(of_energy[1])
            if value == 0:
                raise ValueError(f"of: {key} is 0, where its change has no scale; give its LocalEnergy a number within the bounds, not 0")
            return value
        try:
            return scenario[key]
        except KeyError as error:
            raise ValueError(f"of: {error.args[0]}; choose another key, or set this one in the first scenario") from None

    def _priors(self, given: Mapping[str, tuple[float, float]]) -> list[tuple[int, float, float]]:
        """Return index, place and standard deviation of each prior."""
        found = []
        for key, (value, sd) in given.items():
            if key not in self.keys:
                raise ValueError(f"priors: {key} is not fitted; keys: {', '.join(self.keys)}")
            k = self.keys.index(key)
            if not (math.isfinite(value) and 0 < sd < math.inf and (value > 0 or not self.scales[k].is_log)):
                raise ValueError(f"priors: {key} has {value} ± {sd}; give (value, sd), both above 0")
            found.append((k, self.scales[k].to(value), sd / value if self.scales[k].is_log else sd))
        return found

    def values_at(self, place: Array) -> dict[str, float]:
        return {key: scale.back(float(one)) for key, scale, one in zip(self.keys, self.scales, place)}

    def of_scenario(self, place: Array) -> dict[str, float]:
        """Return the values of the keys of scenarios."""
        return {key: value for key, value in self.values_at(place).items() if not number_of(self.energies, key)}

    def _unit(self, key: str, value: float) -> float:
        """Return the unit of a tape's derivative: for a number that differs between groups, its present value."""
        of_energy = number_of(self.energies, key)
        return value if of_energy and np.ptp(self.energies[of_energy[0]].numbers[of_energy[1]]) > 0 else 1.0

    def energies_at(self, place: Array) -> dict[str, LocalEnergy]:
        energies = dict(self.energies)
        for key, value in self.values_at(place).items():
            if of_energy := number_of(energies, key):
                name, number_name = of_energy
                energies[name] = energies[name]._scaled(number_name, value / self.energies[name]._value(number_name))
        return energies

    def count_until(self, until: Optional[float]) -> int:
        return sum(len(targets_until(one, until)) for one in self.experiments)

    def residuals(self, place: Array, until: Optional[float]) -> Optional[Array]:
        """Return deviations of targets and priors; none if a run fails."""
        found = self.run(place, until)["found"]
        if found is None:
            return None
        rows = [row for one in self.experiments for row in targets_until(one, until)]
        deviations = [(value - row.value) / row.sd for value, row in zip(found, rows)]
        return np.array(deviations + [(place[k] - at) / sd for k, at, sd in self.priors])

    def slopes(self, place: Array, until: Optional[float]) -> Array:
        """Return the derivatives of residuals by coordinates. NumericsError if they cannot be computed."""
        run = self.run(place, until)
        if run["slopes"] is None:
            if self.tapes[0] != self._name(place, until):
                self._record(place, until)
            used = zip(self._used(until), self.tapes[1])
            try:
                rows = [self._slopes_of(targets_until(one, until), tape) for one, tape in used]
            except RuntimeError as error:  # a linear system of the run is singular, as at a snap
                raise NumericsError(str(error)) from error
            values = self.values_at(place)
            by_place = np.array([(values[key] if scale.is_log else 1.0) / self._unit(key, values[key])
                                 for key, scale in zip(self.keys, self.scales)])
            slopes = np.concatenate(rows) * by_place
            if until is None and not self.has_slopes and not slopes.any(axis=0).all():
                key = self.keys[int(np.argmin(slopes.any(axis=0)))]
                raise ValueError(f"of: {key} changes no target; fit another key, or give a target that it changes")
            self.has_slopes = self.has_slopes or until is None
            run["slopes"] = slopes.tolist()
            self._write(place, until)
        of_priors = np.zeros((len(self.priors), len(self.keys)))
        for row, (k, _, sd) in enumerate(self.priors):
            of_priors[row, k] = 1 / sd
        return np.concatenate([np.array(run["slopes"]), of_priors])

    def _slopes_of(self, targets: list[Row], tape: Tape) -> Array:
        slopes = tape._rows([(target.outcome, target.at_min) for target in targets], self.keys, ACCURACY)[1]
        return np.asarray(slopes / np.array([[target.sd] for target in targets]))

    def _used(self, until: Optional[float]) -> list[Experiment]:
        return [one for one in self.experiments if targets_until(one, until)]

    def _name(self, place: Array, until: Optional[float]) -> tuple[float, ...]:
        return (-1.0 if until is None else until, *place.tolist())

    def run(self, place: Array, until: Optional[float]) -> dict[str, Any]:
        """Return what is known of a run: values found (none if it failed), slopes if asked before, reason of a failure."""
        name = self._name(place, until)
        if name not in self.known:
            self.known[name] = {"found": None, "slopes": None, "reason": ""}
            try:
                tapes = self._record(place, until)
                self.known[name]["found"] = [tape._evaluate(row.outcome, row.at_min)[0]
                                             for one, tape in zip(self._used(until), tapes) for row in targets_until(one, until)]
            except NumericsError as error:
                self.known[name]["reason"] = str(error)
            self._write(place, until)
        return self.known[name]

    def _record(self, place: Array, until: Optional[float]) -> list[Tape]:
        tapes = []
        for one in self._used(until):
            scenario = one.scenario.copy()
            scenario.update(self.of_scenario(place))
            times = [row.at_min for row in targets_until(one, until)]
            known = sorted({time for time in times if time is not None})
            tapes.append(record(scenario, at_min=known, until_min=known[-1] if None not in times else None, threads=self.threads,
                                energies=self.energies_at(place)))
        self.tapes = (self._name(place, until), tapes)
        return tapes

    # The folder has one line per run, after one that identifies the fit. A later line of the same place replaces the earlier one.
    def keep_in(self, folder: Path) -> None:
        told_of: list[Any] = [
            version, self.keys, list(self.bounds.values()), self.priors,
            [[one.scenario.to_toml(), [[_print_of(row.outcome, one.scenario), *row[1:]] for row in one.rows]] for one in self.experiments]]
        for one, energy in self.energies.items():
            formula = energy.energy
            if not isinstance(formula, str):
                formula = _digest(energy(_moved(self.experiments[0].scenario)[energy.groups].reshape(len(energy.groups), -1), 1))
            numbers = {number: values.tolist() for number, values in energy.numbers.items()}
            told_of.append([one, formula, energy.groups.tolist(), numbers])
        name = hashlib.sha256(json.dumps(told_of).encode()).hexdigest()
        self.file = folder / "runs.jsonl"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            lines = self.file.read_text(encoding="utf-8").splitlines() if self.file.exists() else []
            if not lines:
                begun = self.file.with_suffix(".new")
                begun.write_text(json.dumps({"fit": name}) + "\n", encoding="utf-8")
                begun.replace(self.file)
        except OSError as error:
            raise FileError(f"{folder}: {error.strerror}") from error
        for number_of, line in enumerate(lines):
            try:
                row = json.loads(line)
            except ValueError:
                if number_of == 0:
                    raise FileError(f"{self.file}:1: cannot be read, so its fit is unknown; give another folder") from None
                continue  # written when the fit was killed
            if number_of == 0 and row.get("fit") != name:
                raise FileError(f"{folder}: holds another fit; give another folder")
            if number_of > 0:
                self.known[tuple(row.pop("place"))] = row

    def _write(self, place: Array, until: Optional[float]) -> None:
        if self.file is None:
            return
        name = self._name(place, until)
        try:
            with self.file.open("a", encoding="utf-8") as file:
                file.write("\n" * (not self.file.read_bytes().endswith(b"\n")) + json.dumps({"place": name, **self.known[name]}) + "\n")
        except OSError as error:
            raise FileError(f"{self.file}: {error.strerror}") from error


def experiments_of(scenario: Any, targets: Optional[Mapping[Any, Any]]) -> list[Experiment]:
    if targets is not None:
        given = [(scenario, targets)]
    elif isinstance(scenario, (Scenario, str, os.PathLike, Mapping)):
        raise ValueError("targets: None; give targets as {outcome: (value, sd)} or {outcome: {minute: (value, sd)}}")
    else:
        given = list(scenario)
    if not given:
        raise ValueError("scenario: an empty list; give at least one scenario")
    found = []
    for index, one in enumerate(given):
        if not isinstance(one, tuple) or len(one) != 2:
            raise ValueError(f"scenario[{index}]: {told(one)}; give (scenario, targets)")
        source, of_one = one
        found.append(Experiment(source.copy() if isinstance(source, Scenario) else Scenario(source), _rows(of_one)))
    return found


def _rows(targets: Any) -> list[Row]:
    if not isinstance(targets, Mapping) or not targets:
        raise ValueError(f"targets: {told(targets)}; give {{outcome: (value, sd)}} or {{outcome: {{minute: (value, sd)}}}}")
    rows = []
    for outcome, at in targets.items():
        if not callable(outcome):
            text_of(outcome, "targets")
        name = name_of(outcome)
        for minute, pair in at.items() if isinstance(at, Mapping) else [(None, at)]:
            where = f"targets[{told(name)}]" + ("" if minute is None else f" at {minute} min")
            value, sd = pair_of(pair, where, "(value, sd)")
            if sd <= 0:
                raise ValueError(f"{where}: sd is {sd}; give a standard deviation above 0")
            time = None if minute is None else number_from(minute, 0, where, "a time in minutes, above 0", above=True)
            rows.append(Row(outcome, time, value, sd))
    return rows


def targets_until(experiment: Experiment, until: Optional[float]) -> list[Row]:
    if until is None:
        return experiment.rows
    return [row for row in experiment.rows if row.at_min is not None and row.at_min <= until]


def _moved(scenario: Scenario) -> Array:
    """Return positions of the start, each moved a little at random, where functions show what they compute."""
    positions = Simulation(scenario).positions
    return np.asarray(positions + np.random.default_rng(0).normal(scale=0.1, size=positions.shape))


def _digest(values: Any) -> str:
    return hashlib.sha256(np.ascontiguousarray(values, np.float64).tobytes()).hexdigest()


def _print_of(outcome: Outcome, scenario: Scenario) -> Any:
    """Return what tells an outcome from others: a function's name, value and gradient, which change when it is edited."""
    if isinstance(outcome, str):
        return outcome
    try:
        value, gradient = outcome(_moved(scenario))
        return [name_of(outcome), float(value), _digest(gradient)]
    except (IndexError, TypeError, ValueError):  # made for a later number of nodes, or told as wrong by the first run
        return name_of(outcome)


def name_of(outcome: Outcome) -> str:
    return outcome if isinstance(outcome, str) else getattr(outcome, "__name__", "function")


def largest_by_chance(free: float) -> float:
    """Return the sum of as many squared normal numbers of variance 1 that 0.1 % exceed (chi-square; Wilson and Hilferty 1931)."""
    spread = 2 / (9 * free)
    return free * (1 - spread + NormalDist().inv_cdf(0.999) * math.sqrt(spread)) ** 3
