"""Recorded runs, and gradients of their outcomes with respect to keys of the scenario and strengths of cells."""
from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import mapping_of, number, number_from, numbers, per_cell, text_of, texts_of, told, whole
from .errors import ScenarioError
from .local_energy import LocalEnergy, laws_of, number_of
from .scenario import Scenario

__all__ = ["GradientCheck", "Tape", "check_gradient", "record"]

Array = NDArray[np.float64]
Loss = Callable[[Array], tuple[float, ArrayLike]]
KEY_CHANGE = 1e-4  # of a key on each side, relative
CHECK_CHANGES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)  # tried by check_gradient
GOOD = 1e-6  # relative agreement that needs no further change
FINER = 4  # division of time.tolerance_um by which check_gradient compares
COARSE = 0.05  # relative difference from there at which it warns
WRONG = 1e-3  # relative error at which it warns, if the difference is surer than that
SNAP_PART = 0.1  # of the run: within this time a snap doubles, and halves, the dependence on a key


def record(
    scenario: Union[Scenario, str, os.PathLike[str], Mapping[str, Any]],
    *,
    until_min: Optional[float] = None,
    at_min: Union[float, Iterable[float]] = (),
    strengths: Optional[Mapping[str, ArrayLike]] = None,
    energies: Optional[Mapping[str, LocalEnergy]] = None,
    threads: int = 1,
) -> Tape:
    """Run a scenario and record it for gradients.

    Parameters
    ----------
    scenario : Scenario, str, path or mapping
        The scenario or its source (see `Scenario`).
    until_min : float, optional
        End of the run, minutes; by default that of the scenario.
    at_min : float or iterable of float
        Times at which outcomes are wanted, minutes. Steps end on them.
    strengths : mapping of str to array_like of float, shape (cells,), optional
        Factors, 0 or more, on the strengths of cells in contractions and cortices (``"cortex.apical"``), on the rates of growth
        (``"growth.NAME"``), and on the stiffness of cells (``"elasticity"``): the corotational or neo-Hookean one, except dilatation
        within cells of several elements.
    energies : dict of str to LocalEnergy, optional
        Force laws by name, as for `Simulation`.
    threads : int
        Threads per step.

    Returns
    -------
    Tape

    Raises
    ------
    ValueError
        If a law of the scenario has no derivatives (inertia, jumps at triggers). The message names it.
    NumericsError
        If no step converges.

    Notes
    -----
    The run is that of `Simulation`, except that a cell with a trigger starts where its measure crosses the threshold,
    interpolated linearly within the step, instead of at the end of the step.

    Examples
    --------
    >>> import plica
    >>> tape = plica.record("drosophila", until_min=1)
    >>> slope = tape.gradient("furrow_depth_um", of="contraction.apical.stiffness_nN_per_um")
    >>> slope > 0
    True
    """
    own = scenario.copy() if isinstance(scenario, Scenario) else Scenario(scenario)
    times_s = sorted({60 * time for time in _times(at_min)})
    until_s = math.inf if until_min is None else 60 * number_from(until_min, 0, "until_min", "a number above 0", above=True)
    factors = _factors(own, {} if strengths is None else strengths)
    laws = laws_of(energies)
    core = _core.Tape.record(own._ready, whole(threads, "threads", 1, 1024), times_s, until_s, factors, laws)
    return Tape(own, core, factors, dict(energies or {}), threads)


class Tape:
    """Recorded run. Made by `record`.

    Gradients are exact for the recorded steps: their number, ends and orders do not change, nor do the times at which cells divide
    or exchange neighbours, and which do. Positions at such a time are those after the change.
    """

    def __init__(self, scenario: Scenario, core: _core.Tape, strengths: dict[str, list[float]], energies: dict[str, LocalEnergy],
                 threads: int) -> None:
        self._scenario, self._core, self._strengths, self._energies, self._threads = scenario, core, strengths, energies, threads
        self._parameters: dict[str, _core.Parameter] = {}

    @property
    def scenario(self) -> Scenario:
        """Copy of the scenario."""
        return self._scenario.copy()

    @property
    def times_min(self) -> Array:
        """Start of the run and ends of all steps, minutes."""
        return self._core.times_s / 60

    def positions(self, at_min: Optional[float] = None) -> Array:
        """Return node positions at the end of a step, µm; shape (nodes, 3).

        Parameters
        ----------
        at_min : float, optional
            Time, minutes; by default the end of the run.
        """
        return self._core.positions(self._states(at_min)[0])

    def distance_to(self, target: ArrayLike, *, surface: str = "apical") -> Loss:
        """Return the mean squared distance of a surface from a target, µm², as an outcome for `gradient`.

        Parameters
        ----------
        target : array_like of float, shape (nodes, 3)
            Positions of all nodes, µm; those of other nodes are not read. With several times, shape (times, nodes, 3).
        surface : {"apical", "basal", "all"}
            Nodes that are compared.
        """
        nodes = np.arange(len(self.positions())) if surface == "all" else self._core.surface_nodes(text_of(surface, "surface"))
        wanted = numbers(target, "target", "positions of all nodes")
        if wanted.ndim not in (2, 3) or wanted.shape[-2:] != self.positions().shape:
            raise ValueError(f"target: {told(wanted)}; give positions of all nodes, of shape {self.positions().shape}")
        wanted = wanted[..., nodes, :]

        def distance(positions: Array) -> tuple[float, Array]:
            apart = positions[..., nodes, :] - wanted
            gradient = np.zeros_like(positions)
            count = apart.size / 3
            gradient[..., nodes, :] = 2 * apart / count
            return float((apart**2).sum() / count), gradient

        return distance

    def value(self, outcome: Union[str, Loss], *, at_min: Union[None, float, Iterable[float]] = None) -> float:
        """Return the value of an outcome.

        Parameters
        ----------
        outcome : str or callable
            As for `gradient`.
        at_min : float or iterable of float, optional
            As for `gradient`.
        """
        return self._evaluate(outcome, at_min)[0]

    def gradient(
        self,
        outcome: Union[str, Loss, ArrayLike],
        *,
        of: Union[str, Iterable[str]],
        by: Optional[str] = None,
        at_min: Union[None, float, Iterable[float]] = None,
        tolerance: float = 1e-9,
    ) -> Any:
        """Return the gradient of an outcome.

        Parameters
        ----------
        outcome : str, callable or array_like of float
            Output variable: ``"furrow_depth_um"``, ``"lip_distance_um"``, ``"mean_height_um"``, ``"vml_height_um"``,
            ``"vml_apical_area_ratio"``, ``"vce_apical_area_ratio"``, ``"enclosed_volume_ratio"``, ``"lumen_volume_ratio"``, or the
            column of a monitor of areas, volumes, depths, positions, displacements or distances; an extremum has the gradient of the
            node or cell that has it. Or a function of positions, of shape (nodes, 3), that returns its value and its gradient, of
            the same shape; or the gradient alone. With several times, positions and gradient have shape
            (times, nodes, 3).
        of : str or iterable of str
            Key of the scenario with a number (``"cortex.apical.tension_mN_per_m"``), or number of a `LocalEnergy`
            (``"energy.springs.k"``; if it differs between groups, a factor on all), or several. With ``by="cell"``, one contraction or
            cortex (``"cortex.apical"``), a growth (``"growth.NAME"``), or ``"elasticity"`` for stiffnesses.
        by : "cell", optional
            For the derivative by a factor on the strength of each cell, 1 for the scenario's.
        at_min : float or iterable of float, optional
            Time of the outcome, minutes; several: outcome of several times. By default the end of the run.
        tolerance : float
            Relative tolerance of linear solves.

        Returns
        -------
        float or ndarray
            A number for one key; an array for several, in their order, or for cells, in the order of ``Simulation.cell_data``.

        Raises
        ------
        ValueError
            If a key is unknown, cannot be varied, or changes the tissue or which laws act, or if contact forces act after cells have
            divided or exchanged neighbours.

        Notes
        -----
        The cost is about that of the run, for any number of cells, and two evaluations of forces per key and step. For growth, and
        after cells have divided or exchanged neighbours, each cell, or each key, costs about 0.6 of a run.
        """
        if not isinstance(of, str):
            of = texts_of(of, "of")
        if by not in (None, "cell"):
            raise ValueError(f'by: {told(by)}; give "cell", or omit it for keys of the scenario')
        if by == "cell" and not isinstance(of, str):
            raise ValueError(f"of: {told(of)}; give one contraction or cortex with by=\"cell\"")
        accuracy = number_from(tolerance, 0, "tolerance", "a number above 0", above=True)
        by_positions = self._evaluate(outcome, at_min)[1]
        keys = [] if by == "cell" else [of] if isinstance(of, str) else of
        parameters = [self._parameter(key) for key in keys]
        by_key, by_cell = self._core.gradient(by_positions, parameters, text_of(of, "of") if by == "cell" else "", accuracy)
        if by == "cell":
            return by_cell
        return float(by_key[0]) if isinstance(of, str) else by_key

    def jacobian(
        self,
        outcomes: Union[str, Loss, Iterable[Union[str, Loss]]],
        *,
        of: Union[str, Iterable[str]],
        at_min: Union[None, float, Iterable[float]] = None,
        tolerance: float = 1e-9,
    ) -> Array:
        """Return the derivatives of several outcomes at several times by several keys.

        Parameters
        ----------
        outcomes : str, callable, or iterable of them
            Outcomes, each of one time, as for `gradient`.
        of : str or iterable of str
            Keys with a number, up to about twenty.
        at_min : float or iterable of float, optional
            Times, minutes; by default the end of the run.
        tolerance : float
            Relative tolerance of linear solves.

        Returns
        -------
        ndarray of float, shape (outcomes, times, keys)
            Per unit of each key.

        Raises
        ------
        ValueError
            As `gradient`.

        Notes
        -----
        The cost depends on the number of keys only, since the derivatives of all positions are followed through the run. For
        one outcome and many keys, or for cells, `gradient` is cheaper.

        Examples
        --------
        >>> import plica
        >>> tape = plica.record("drosophila", until_min=1, at_min=0.5)
        >>> keys = ["contraction.apical.stiffness_nN_per_um", "elasticity.young_modulus_Pa"]
        >>> tape.jacobian(["furrow_depth_um", "vml_apical_area_ratio"], of=keys, at_min=[0.5, 1]).shape
        (2, 2, 2)
        """
        given: list[Any] = [outcomes] if isinstance(outcomes, str) or callable(outcomes) else list(outcomes)
        times: list[Optional[float]] = [None] if at_min is None else list(_times(at_min))
        keys = texts_of(of, "of")
        slopes = self._rows([(outcome, time) for outcome in given for time in times], keys, tolerance)[1]
        return slopes.reshape(len(given), len(times), len(keys))

    def _along(self, change: Mapping[str, ArrayLike], at_min: Iterable[float], tolerance: float) -> Array:
        """Return the derivatives of positions at these times along a change of factors on strengths; shape (times, nodes, 3)."""
        found = self._core.tangent({law: np.asarray(of_cells).tolist() for law, of_cells in change.items()}, self._states(at_min), tolerance)
        return np.stack(found)

    def _rows(self, rows: list[tuple[Any, Optional[float]]], keys: list[str], tolerance: float) -> tuple[Array, Array]:
        """Return values and derivatives by keys, one row per outcome and time."""
        accuracy = number_from(tolerance, 0, "tolerance", "a number above 0", above=True)
        found = [self._evaluate(outcome, time) for outcome, time in rows]
        slopes = self._core.jacobian([gradient for _, gradient in found], [self._parameter(key) for key in keys], accuracy)
        return np.array([value for value, _ in found]), slopes.reshape(len(rows), len(keys))

    def _states(self, at_min: Union[None, float, Iterable[float]]) -> list[int]:
        if at_min is None:
            return [len(self._core.times_s) - 1]
        return [self._core.state_at(60 * time) for time in _times(at_min)]

    def _evaluate(self, outcome: Any, at_min: Union[None, float, Iterable[float]]) -> tuple[float, dict[int, Array]]:
        """Return the value of an outcome (NaN for a gradient alone) and its gradient by positions of each state."""
        states = self._states(at_min)
        of_one = at_min is None or not isinstance(at_min, Iterable)
        if isinstance(outcome, str):
            if len(states) != 1:
                raise ValueError(f"at_min: {told(at_min)}; give one time for outcome {told(outcome)}")
            of_state, by_positions = self._core.outcome(text_of(outcome, "outcome"), states[0])
            return of_state, {states[0]: by_positions}
        all_positions = [self._core.positions(state) for state in states]
        if len({len(one) for one in all_positions}) > 1:
            raise ValueError(f"at_min: {told(at_min)}; cells divide between these times, so give one time per outcome")
        stack = np.stack(all_positions)
        positions = stack[0] if of_one else stack
        value = math.nan
        if callable(outcome):
            result = outcome(positions)
            if not isinstance(result, tuple) or len(result) != 2:
                raise ValueError(f"outcome: the function returned {told(result)}; return its value and its gradient")
            value, outcome = number(result[0], "outcome", "a finite number as its value"), result[1]
        gradient = numbers(outcome, "outcome", f"a gradient of shape {positions.shape}")
        if gradient.shape != positions.shape:
            raise ValueError(f"outcome: {told(gradient)}; give a gradient of shape {positions.shape}")
        if not np.isfinite(gradient).all():
            raise ValueError("outcome: its gradient has values that are not finite")
        by_state: dict[int, Array] = {}
        for state, part in zip(states, gradient[None] if of_one else gradient):
            by_state[state] = np.ascontiguousarray(by_state.get(state, 0) + part)
        return value, by_state

    def _value(self, key: str) -> float:
        """Return the value of a key, or of a number of an energy."""
        of_energy = number_of(self._energies, key)
        try:
            value = self._energies[of_energy[0]]._value(of_energy[1]) if of_energy else self._scenario[key]
        except KeyError as error:
            raise ValueError(f"of: {error.args[0]}; choose another key, or set this one in the scenario") from None
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"{key}: {told(value)}; choose a key that has a number")
        if value == 0:
            raise ValueError(f"{key}: is 0, where its change has no scale; set a small value above 0 for a gradient there")
        return float(value)

    def _changed(self, key: str, part: float) -> tuple[Scenario, dict[str, LocalEnergy]]:
        """Return scenario and energies with a key changed by this part of its value."""
        value, energies = self._value(key), dict(self._energies)
        if of_energy := number_of(energies, key):
            name, number_name = of_energy
            energies[name] = energies[name]._scaled(number_name, 1 + part)
            return self._scenario, energies
        changed = self._scenario.copy()
        try:
            changed[key] = value * (1 + part)
        except ScenarioError as error:
            raise ValueError(f"{key}: cannot be varied about {value:g}; choose a key with a range of numbers ({error})") from error
        return changed, energies

    def _replayed(self, scenario: Scenario, strengths: dict[str, list[float]], energies: dict[str, LocalEnergy]) -> Tape:
        """Return a changed run through the same steps."""
        return Tape(scenario, self._core.replayed(scenario._ready, strengths, laws_of(energies)), strengths, energies, self._threads)

    def _with_strengths(self, factors: Mapping[str, ArrayLike]) -> Tape:
        """Return the run with other factors through the same steps."""
        return self._replayed(self._scenario, _factors(self._scenario, factors), self._energies)

    def _parameter(self, key: str) -> _core.Parameter:
        if key not in self._parameters:
            changed = [self._changed(key, part) for part in (KEY_CHANGE, -KEY_CHANGE)]
            more, less = [(scenario._ready, laws_of(energies)) for scenario, energies in changed]
            self._parameters[key] = self._core.parameter(key, more, less, 2 * KEY_CHANGE * self._value(key))
        return self._parameters[key]

    def __repr__(self) -> str:
        return f"Tape({self._scenario.name!r}, {len(self._core.times_s) - 1} steps to {self.times_min[-1]:.4g} min)"


@dataclass(frozen=True)
class GradientCheck:
    """Derivative compared with a central difference over the same steps.

    Attributes
    ----------
    of : str
        Key, or direction in the strengths of cells.
    gradient, difference : float
        The derivative, and the central difference.
    change : float
        Relative change of the key, or change of factors, on each side.
    uncertainty : float
        Relative difference to the central difference of another change; NaN if one change sufficed. Where it is large, the outcome is
        strongly curved or jumps, and no derivative can be checked.
    error : float
        Relative difference of derivative and difference.
    finer : float
        The derivative of a run with a quarter of ``time.tolerance_um``; NaN if steps are given, or cells divide or exchange
        neighbours.
    snap_min : float
        When the shape snaps: its dependence on the key rises and falls at least twofold within a tenth of the run. NaN if it does not.
        From shortly before, outcomes are strongly curved, and the slope holds for small changes only.
    """

    of: str
    gradient: float
    difference: float
    change: float
    uncertainty: float
    finer: float = math.nan
    snap_min: float = math.nan

    @property
    def error(self) -> float:
        return abs(self.gradient - self.difference) / max(abs(self.difference), np.finfo(float).tiny)

    def __repr__(self) -> str:
        doubt = "" if math.isnan(self.uncertainty) else f" ± {self.uncertainty:.1e}"
        return (f"GradientCheck({self.of}: {self.gradient:.9g}, difference {self.difference:.9g} by changes of {self.change:.0e}, "
                f"error {self.error:.1e}{doubt}" + ("" if math.isnan(self.finer) else f", by finer steps {self.finer:.4g}")
                + ("" if math.isnan(self.snap_min) else f", snap at {self.snap_min:.3g} min") + ")")


def check_gradient(
    tape: Tape,
    outcome: Union[str, Loss],
    *,
    of: Union[str, Iterable[str]],
    by: Optional[str] = None,
    at_min: Union[None, float, Iterable[float]] = None,
    change: Optional[float] = None,
) -> list[GradientCheck]:
    """Compare a gradient with central differences of runs through the same steps, and with that of a run in finer steps.

    Parameters
    ----------
    tape : Tape
        Recorded run.
    outcome : str or callable
        As for `Tape.gradient`.
    of, by, at_min
        As for `Tape.gradient`.
    change : float, optional
        Relative change of keys, and change of factors on strengths, on each side. By default 1e-3, and smaller ones where the
        outcome is too curved for it: near a snap or in contact. Of these, the change counts whose difference differs least from that
        of the change before.

    Returns
    -------
    list of GradientCheck
        One per key. For cells: a random direction, and the cell with the largest derivative.

    Raises
    ------
    RuntimeError
        If a step of a changed run does not converge.

    Warns
    -----
    UserWarning
        If a derivative differs by more than 0.1 %, and more than its uncertainty, from the difference. If that of a run with a quarter
        of ``time.tolerance_um`` differs by more than 5 %: an outcome may be accurate where its slope is not.

    Notes
    -----
    It takes two to ten runs per comparison and one more, with tight tolerances, and one in finer steps.

    Examples
    --------
    >>> import plica
    >>> tape = plica.record("drosophila", until_min=0.5)
    >>> [check] = plica.check_gradient(tape, "furrow_depth_um", of="contraction.apical.stiffness_nN_per_um")
    >>> check.error < 1e-6, abs(check.finer / check.gradient - 1) < 0.05
    (True, True)
    """
    changes = CHECK_CHANGES if change is None else (number_from(change, 0, "change", "a number above 0", above=True),)
    base = tape._replayed(tape._scenario, tape._strengths, tape._energies)
    slopes = np.atleast_1d(base.gradient(outcome, of=of, by=by, at_min=at_min, tolerance=1e-11))

    def differences(run_with: Callable[[float], Tape], unit: float) -> Callable[[float], tuple[float, float]]:
        def at(part: float) -> tuple[float, float]:
            more, less = run_with(part), run_with(-part)
            difference = (more.value(outcome, at_min=at_min) - less.value(outcome, at_min=at_min)) / (2 * part * unit)
            return difference, _snap_min(more, less)
        return at

    if by is None:
        keys = [of] if isinstance(of, str) else texts_of(of, "of")

        def by_key(key: str, part: float) -> Tape:
            scenario, energies = base._changed(key, part)
            return tape._replayed(scenario, tape._strengths, energies)

        checks = [_checked(key, float(slope), changes, differences(partial(by_key, key), base._value(key)))
                  for key, slope in zip(keys, slopes)]
        return _compared_with_finer(tape, checks, list(np.eye(len(keys))), outcome, of, by, at_min)
    law = text_of(of, "of")
    at = np.array(tape._strengths.get(law, np.ones(len(slopes))))
    largest = int(np.argmax(np.abs(slopes)))
    originals = tape._core.originals  # with embryo.mirror, cells change with their images
    directions = {"a random direction": np.random.default_rng(0).uniform(0, 1, len(slopes))[originals],
                  f"cell {largest}": (originals == originals[largest]).astype(float)}

    def along(direction: Array, part: float) -> Tape:
        return tape._replayed(tape._scenario, {**tape._strengths, law: (at + part * direction).tolist()}, tape._energies)

    checks = [_checked(f"{law}, {name}", float(direction @ slopes), changes, differences(partial(along, direction), 1.0))
              for name, direction in directions.items()]
    return _compared_with_finer(tape, checks, list(directions.values()), outcome, of, by, at_min)


def _snap_min(more: Tape, less: Tape) -> float:
    """Return when the difference of two runs through the same steps is largest, if it rises and falls fast there; else NaN."""
    times = more.times_min
    apart = np.array([np.sqrt(np.mean((more._core.positions(state) - less._core.positions(state)) ** 2)) for state in range(len(times))])
    peak, window = int(apart.argmax()), SNAP_PART * times[-1]
    before = apart[(times >= times[peak] - window) & (times <= times[peak])]
    after = apart[(times >= times[peak]) & (times <= times[peak] + window)]
    is_snap = times[peak] > window and max(before.min(), after.min()) <= apart[peak] / 2
    return float(times[peak]) if is_snap else math.nan


def _compared_with_finer(tape: Tape, checks: list[GradientCheck], directions: list[Array], outcome: Any, of: Any, by: Optional[str],
                         at_min: Union[None, float, Iterable[float]]) -> list[GradientCheck]:
    """Add derivatives along directions of a run in finer steps. Warns if one differs, or one from its difference."""
    wrong = [check for check in checks if check.error > WRONG and check.error > 2 * check.uncertainty]  # not of one change
    if wrong:
        worst = max(wrong, key=lambda check: check.error)
        warnings.warn(f"check_gradient: the derivative by {worst.of} is {worst.gradient:.4g}, but runs differ by {worst.difference:.4g}; do "
                      "not use it, and report it with the scenario", stacklevel=3)
    scenario = tape.scenario
    tolerance_um = float(scenario["time.tolerance_um"])
    if scenario["time.step_s"] != "adaptive" or tape._core.changes > 0:
        return checks
    scenario["time.tolerance_um"] = tolerance_um / FINER
    finer = record(scenario, until_min=tape.times_min[-1], at_min=() if at_min is None else at_min, strengths=tape._strengths,
                   energies=tape._energies, threads=tape._threads)
    slopes = np.atleast_1d(finer.gradient(outcome, of=of, by=by, at_min=at_min))
    found = [replace(check, finer=float(direction @ slopes)) for check, direction in zip(checks, directions)]
    coarse = [check for check in found if abs(check.finer - check.gradient) > COARSE * abs(check.finer)]
    if coarse:
        worst = max(coarse, key=lambda check: abs(check.finer - check.gradient) / max(abs(check.finer), np.finfo(float).tiny))
        warnings.warn(f"check_gradient: time.tolerance_um = {tolerance_um:g} is too coarse for slopes: that by {worst.of} is "
                      f"{worst.gradient:.4g}, and {worst.finer:.4g} at {tolerance_um / FINER:g}; set time.tolerance_um to "
                      f"{tolerance_um / FINER:g} or less, record and check again", stacklevel=3)
    return found


def _checked(of: str, slope: float, changes: Iterable[float],
             difference_at: Callable[[float], tuple[float, float]]) -> GradientCheck:
    """Compare a derivative with differences of smaller and smaller changes, until one agrees or two differences do."""
    best: Optional[GradientCheck] = None
    last = math.nan
    for part in changes:
        difference, snap_min = difference_at(part)
        doubt = abs(difference - last) / max(abs(difference), np.finfo(float).tiny)
        found = GradientCheck(of, slope, difference, part, doubt, snap_min=snap_min)
        if best is None or math.isnan(best.uncertainty) or found.uncertainty < best.uncertainty:
            best = found
        if found.error < GOOD or found.uncertainty < GOOD:
            return found
        last = difference
    assert best is not None
    return best


def _times(at_min: Union[float, Iterable[float]]) -> list[float]:
    given = list(at_min) if isinstance(at_min, Iterable) and not isinstance(at_min, str) else [at_min]
    return [number_from(time, 0, "at_min", "a time in minutes, or several") for time in given]


def _factors(scenario: Scenario, strengths: Mapping[str, ArrayLike]) -> dict[str, list[float]]:
    given = mapping_of(strengths, "strengths", "a mapping of laws to one number per cell")
    cells = scenario._cell_count() if given else 0
    return {law: per_cell(values, cells, f"strengths[{law}]").tolist() for law, values in given.items()}
