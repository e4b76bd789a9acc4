"""A run in the hand: a scenario that is taken forward, a step after another."""
from __future__ import annotations

import html
import logging
import math
import os
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import FileError
from .results import Run, _grid, _pandas, open_run
from .scenario import Scenario, Tissue

if TYPE_CHECKING:
    import pandas

__all__ = ["Simulation", "Step", "load"]

log = logging.getLogger("plica")


class Step:
    """A step that has been taken, as it was measured.

    Attributes
    ----------
    time_s : float
        Its end, s.
    measures : dict of str to float or None
        What a row of ``series.csv`` has, units in the names (:doc:`docs/measures </measures>`); None: there is no value.
    """

    __slots__ = ("time_s", "measures")

    def __init__(self, time_s: float, measures: dict[str, Optional[float]]) -> None:
        self.time_s, self.measures = time_s, measures

    def __getitem__(self, name: str) -> Optional[float]:
        return self.measures[name]

    @property
    def newton_iterations(self) -> int:
        """How many Newton iterations it took, those of refused attempts too."""
        return int(self.measures["newton_iterations"] or 0)

    @property
    def volume_error(self) -> Optional[float]:
        """The largest relative error of a cell's volume."""
        return self.measures["max_volume_error"]

    def __repr__(self) -> str:
        return f"Step(to {self.time_s / 60:.4g} min, {self.newton_iterations} Newton iterations)"


class Simulation:
    """A scenario at a moment, and the way on from there.

    Parameters
    ----------
    scenario : Scenario, or what makes one
        Copied: what is changed in it later does not matter here.
    threads : int, optional
        How many threads solve a step; by default one for every 10 000 elements. Results do not depend on it.

    Raises
    ------
    ScenarioError
        For what only the tissue shows to be wrong.

    Notes
    -----
    Arrays are copies of the moment when they are asked for, and cannot be written to. While a step is solved, other Python
    threads go on. One simulation belongs to one thread at a time; two simulations do not disturb each other.

    Examples
    --------
    >>> import plica
    >>> sim = plica.Simulation(plica.Scenario("drosophila"), threads=1)
    >>> while sim.time_s < 20:
    ...     step = sim.step()
    >>> round(step["furrow_depth_um"], 1)
    5.1
    """

    def __init__(self, scenario: Union[Scenario, str, os.PathLike[str], Mapping[str, Any]], *, threads: Optional[int] = None) -> None:
        own = scenario.copy() if isinstance(scenario, Scenario) else Scenario(scenario)
        core = _core.Simulation(own._ready, _threads(threads))
        own._check_masks(len(core.pressures))
        self._begin(own, core)

    def _begin(self, scenario: Scenario, core: _core.Simulation) -> None:
        self._scenario, self._core = scenario, core
        self._has_crossed = False
        for line in core.advice if core.steps == 0 else []:
            if line.startswith("warning: "):
                log.warning("%s", line.removeprefix("warning: "))

    @property
    def scenario(self) -> Scenario:
        """A copy of what it was made from."""
        return self._scenario.copy()

    # Going on

    def step(self, *, until_min: Optional[float] = None) -> Optional[Step]:
        """Takes the next step.

        Parameters
        ----------
        until_min : float, optional
            The step ends there at the latest, minutes.

        Returns
        -------
        Step or None
            None when the simulation has finished, or that time has come.

        Raises
        ------
        NumericsError
            No step could be solved, however short. The state is the last good one.
        KeyboardInterrupt
            Ctrl-C came within the step, which is given up; the next call takes it again.
        """
        return self._step(_seconds(until_min))

    def _step(self, until_s: float) -> Optional[Step]:
        if not self._core.step(until_s):
            return None
        measures = self._core.measures
        if not self._has_crossed and (measures["self_intersections"] or 0) > 0:
            self._has_crossed = True
            warnings.warn(self._core.crossing_warning, stacklevel=3)
        return Step(self._core.time_s, measures)

    @overload
    def run(
        self,
        *,
        until_min: Optional[float] = None,
        out: Union[str, os.PathLike[str]],
        overwrite: bool = False,
        resume: bool = False,
        progress: bool = False,
        callback: Optional[Callable[[Simulation, Step], object]] = None,
    ) -> Run: ...
    @overload
    def run(
        self,
        *,
        until_min: Optional[float] = None,
        out: None = None,
        progress: bool = False,
        callback: Optional[Callable[[Simulation, Step], object]] = None,
    ) -> None: ...
    def run(
        self,
        *,
        until_min: Optional[float] = None,
        out: Optional[Union[str, os.PathLike[str]]] = None,
        overwrite: bool = False,
        resume: bool = False,
        progress: bool = False,
        callback: Optional[Callable[[Simulation, Step], object]] = None,
    ) -> Optional[Run]:
        """Goes on to the end, or to a time.

        Parameters
        ----------
        until_min : float, optional
            A step ends there, minutes; by default the simulation goes on until it has finished.
        out : str or path, optional
            A directory for the same files as ``plica run`` leaves. They tell of what comes from now on.
        overwrite : bool
            Results that lie there are replaced; without it, that is an error.
        resume : bool
            Goes on from the directory's checkpoint, to the same bits; begins where there is none. Of a simulation at rest.
        progress : bool
            Shows a bar, in a terminal or a notebook.
        callback : callable, optional
            Called as ``callback(simulation, step)`` after every step; may call `set_activity`. A true value ends the run.

        Returns
        -------
        Run or None
            What lies in `out` now; None without it.

        Raises
        ------
        NumericsError, FileError
            As for `step`, and of files that cannot be written.
        KeyboardInterrupt
            All that is done by then is saved first; the same call with ``resume=True`` goes on.
        """
        end_s = _seconds(until_min)
        if out is None and (resume or overwrite):
            raise ValueError("overwrite and resume are about the directory of the results; give it as out")
        if out is not None and not self._begin_record(os.fspath(out), overwrite, resume):
            return open_run(out)
        bar = _Progress(min(end_s, self._core.end_s)) if progress else None
        try:
            while (step := self._step(end_s)) is not None:
                if bar is not None:
                    bar.show(step)
                if callback is not None and callback(self, step):
                    break
        finally:
            if bar is not None:
                bar.close()
            if self._core.is_recording:
                self._core.end_record()
        return None if out is None else open_run(out)

    def _begin_record(self, out: str, overwrite: bool, resume: bool) -> bool:
        """False where the run that lies there has finished."""
        if overwrite and resume:
            raise ValueError("give overwrite or resume, not both")
        if self._core.is_recording:
            raise ValueError("this simulation is being recorded already; end that run first")
        for note in self._core.begin_record(out, "resume" if resume else "overwrite" if overwrite else "fresh"):
            log.warning("%s", note)
        return self._core.is_recording

    @property
    def finished(self) -> bool:
        """Whether nothing is left to do: at rest, at the end of time, stopped by a criterion, or given up."""
        return self._core.status != "under_way"

    @property
    def status(self) -> str:
        """"under_way", "equilibrium", "end_time" or "failed"."""
        return self._core.status

    def set_activity(self, law: str, activity: Optional[ArrayLike]) -> None:
        """From now on, cells act by a law as they are told, not by its program: light, feedback, another model.

        Parameters
        ----------
        law : str
            A contraction or a cortex: its name in the scenario, alone where only one has it ("apical"), or with its table
            ("cortex.apical").
        activity : array_like of float, shape (cells,), or float, or None
            A factor on what the scenario says of each cell, 0 or more; NaN: that cell follows its program. None: all do
            again.

        Raises
        ------
        ValueError
            No cells act by a law of that name; another shape; a number that is negative or infinite.

        Notes
        -----
        It holds until it is set again, in copies and saved simulations too. A large change at once costs some refused
        steps.

        Examples
        --------
        >>> import numpy as np, plica
        >>> sim = plica.Simulation("drosophila")
        >>> x = sim.cell_data["x_um"]
        >>> sim.set_activity("apical", np.where(x > 0, 0.0, np.nan))  # one half is switched off
        """
        label = self._label(law)
        if activity is None:
            return self._core.set_activity(label, [])
        count = len(self._core.activity(label))
        values = np.asarray(activity, dtype=np.float64)
        if values.ndim == 0:
            values = np.full(count, float(values))
        if values.shape != (count,):
            raise ValueError(f"{label}: activities of shape {values.shape}; give one a cell ({count})")
        if (values < 0).any():
            cell = int(np.argmax(values < 0))
            raise ValueError(f"{label}: the activity of cell {cell} is {values[cell]}; give a number of 0 or more")
        self._core.set_activity(label, np.where(np.isnan(values), -1.0, values).tolist())

    def activity(self, law: str) -> NDArray[np.float64]:
        """How active each cell is by a law now: by its program, its own state, or as it was told.

        Parameters
        ----------
        law : str
            As for `set_activity`.

        Returns
        -------
        ndarray of float, shape (cells,)
            NaN for cells that do not act by it.
        """
        return self._core.activity(self._label(law))

    def _label(self, name: str) -> str:
        labels = self._core.laws(active=True)
        fitting = [label for label in labels if label == name or label.partition(".")[2] == name]
        if name in labels:
            return name
        if len(fitting) > 1:
            raise ValueError(f'"{name}" may be {" or ".join(fitting)}; say which')
        return fitting[0] if fitting else name

    # Another time

    def copy(self) -> Simulation:
        """A fork in time: the same moment twice. Both go on to the same bits, until something is done to one of them.

        Examples
        --------
        >>> import plica
        >>> sim = plica.Simulation("drosophila")
        >>> sim.run(until_min=1)
        >>> fork = sim.copy()
        >>> fork.set_activity("apical", 0)
        """
        other = object.__new__(Simulation)
        other._begin(self._scenario.copy(), self._core.copy())
        return other

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Saves all that the next step depends on, for `load`.

        Parameters
        ----------
        path : str or path
            A file, replaced where it exists.
        """
        target = Path(path)
        beside = target.with_name(target.name + ".part")
        try:
            beside.write_bytes(self._core.save())
            os.replace(beside, target)
        except OSError as error:
            beside.unlink(missing_ok=True)
            raise FileError(f"{target}: cannot be written: {error.strerror}") from error

    def __getstate__(self) -> dict[str, Any]:
        return {"scenario": self._scenario, "saved": self._core.save(), "threads": self._core.threads}

    def __setstate__(self, state: dict[str, Any]) -> None:
        scenario = state["scenario"]
        self._begin(scenario, _core.Simulation(scenario._ready, state["threads"], state["saved"]))

    # How it is now

    @property
    def time_s(self) -> float:
        """Time, s."""
        return self._core.time_s

    @property
    def time_min(self) -> float:
        """Time, minutes."""
        return self._core.time_s / 60

    @property
    def steps(self) -> int:
        """How many steps it has taken."""
        return self._core.steps

    @property
    def threads(self) -> int:
        """How many threads solve a step."""
        return self._core.threads

    @property
    def measures(self) -> dict[str, Optional[float]]:
        """What a row of ``series.csv`` has, of now; units in the names."""
        return self._core.measures

    @property
    def positions(self) -> NDArray[np.float64]:
        """Where the nodes are, µm; shape (nodes, 3)."""
        return self._core.positions

    @property
    def rest_positions(self) -> NDArray[np.float64]:
        """Where the nodes are at rest, µm; shape (nodes, 3)."""
        return self._core.rest_positions

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities of the nodes at the end of the last step, µm/s; shape (nodes, 3)."""
        return self._core.velocities

    @property
    def hexahedra(self) -> NDArray[np.int32]:
        """Nodes of the elements, in VTK's order, the last four on the apical side; shape (elements, 8)."""
        return self._core.hexahedra

    @property
    def hexahedron_cell(self) -> NDArray[np.int32]:
        """Which cell each element is of: its place in `cell_data`; shape (elements,)."""
        return self._core.hexahedron_cell

    @property
    def pressures(self) -> NDArray[np.float64]:
        """Pressure of each cell, Pa; shape (cells,)."""
        return self._core.pressures

    @property
    def cell_data(self) -> dict[str, NDArray[np.float64]]:
        """What ``cells.csv`` has of each cell, as arrays of shape (cells,), units in the names."""
        return self._core.cell_data

    @property
    def cells(self) -> pandas.DataFrame:
        """The same as a table, a row a cell."""
        table: pandas.DataFrame = _pandas("cells").DataFrame({k: v.copy() for k, v in self._core.cell_data.items()})
        return table

    @property
    def regions(self) -> dict[str, NDArray[np.bool_]]:
        """The scenario's regions: which cells are in each; shape (cells,)."""
        return self._core.regions

    @property
    def neighbours(self) -> NDArray[np.int32]:
        """Pairs of cells that share a wall: places in `cell_data`, the lower one first; shape (pairs, 2)."""
        return self._core.neighbours

    @property
    def laws(self) -> list[str]:
        """Names of the laws of mechanics at work, for `forces` and `energies`."""
        return self._core.laws(active=False)

    def forces(self, law: str) -> NDArray[np.float64]:
        """What one law exerts on the nodes of the body as if it stood still.

        Parameters
        ----------
        law : str
            One of `laws`.

        Returns
        -------
        ndarray of float, shape (nodes, 3)
            nN. What resists motion (drag, viscosity, dampers) has none.

        Raises
        ------
        ValueError
            There is no such law.
        """
        return self._core.forces(law)

    @property
    def energies(self) -> dict[str, dict[str, float]]:
        """Where energy has gone so far, by law: "active" (put in by cells), "stored", "dissipated"; nN µm."""
        return self._core.energies

    def to_pyvista(self) -> Any:
        """The mesh as it is now, with `cell_data` on its elements: a ``pyvista.UnstructuredGrid``."""
        cell = self.hexahedron_cell
        data = {name: values[cell] for name, values in self.cell_data.items()}
        return _grid(self.positions, self.hexahedra, {}, data)

    def __repr__(self) -> str:
        return f"Simulation({self._scenario.name!r}, at {self.time_min:.4g} min after {self.steps} steps, {self.status})"

    def _repr_html_(self) -> str:
        told = {name: value for name, value in self.measures.items() if value is not None}
        rows = "".join(
            f"<tr><td style='text-align:left'>{html.escape(name)}</td><td>{value:.5g}</td></tr>" for name, value in told.items()
        )
        return f"{html.escape(repr(self))}<details><summary>measures</summary><table>{rows}</table></details>"


def load(
    path: Union[str, os.PathLike[str]], *, threads: Optional[int] = None, tissue: Optional[Tissue] = None
) -> Simulation:
    """A simulation that was saved, or the checkpoint of a run. It goes on to the same bits.

    Parameters
    ----------
    path : str or path
        What ``Simulation.save`` wrote, or the ``checkpoint.h5`` of a run.
    threads : int, optional
        As for `Simulation`.
    tissue : Tissue, optional
        The one that its scenario was given, where it was given one.

    Raises
    ------
    FileError
        The file cannot be read, is none, or is of another embryo.
    """
    source = Path(path)
    try:
        saved = source.read_bytes()
    except OSError as error:
        raise FileError(f"{source}: cannot be read: {error.strerror}") from error
    try:
        scenario = Scenario(_core.scenario_of_saved(saved), tissue=tissue)
        simulation = object.__new__(Simulation)
        simulation._begin(scenario, _core.Simulation(scenario._ready, _threads(threads), saved))
    except FileError as error:
        raise FileError(f"{source}: {error}") from error
    except UnicodeDecodeError as error:
        raise FileError(f"{source}: is damaged: the scenario in it is no text") from error
    return simulation


def _threads(threads: Optional[int]) -> int:
    if threads is None:
        return 0
    if isinstance(threads, bool) or not isinstance(threads, (int, np.integer)) or not 1 <= threads <= 1024:
        raise ValueError(f"threads: {threads!r}; give a whole number from 1 to 1024")
    return int(threads)


def _seconds(until_min: Optional[float]) -> float:
    """Of a time in minutes; without one, never."""
    if until_min is None:
        return math.inf
    if isinstance(until_min, bool) or not isinstance(until_min, (int, float, np.number)) or math.isnan(float(until_min)):
        raise ValueError(f"until_min: {until_min!r}; give a number")
    return 60 * float(until_min)


class _Progress:
    """A bar: tqdm's where it is installed, which looks right in notebooks, else a line on the terminal."""

    def __init__(self, end_s: float) -> None:
        self.end_min = end_s / 60
        self.last = 0.0
        self.bar: Any = None
        try:
            from tqdm.auto import tqdm

            self.bar = tqdm(total=round(self.end_min, 3), unit="min", bar_format="{l_bar}{bar}| {n:.2f}/{total:.2f} min {postfix}")
        except ImportError:
            pass

    def show(self, step: Step) -> None:
        minutes, depth = step.time_s / 60, step.measures.get("furrow_depth_um")
        told = "" if depth is None else f"furrow {depth:.1f} µm deep"
        if self.bar is not None:
            self.bar.set_postfix_str(told, refresh=False)
            self.bar.update(minutes - self.bar.n)
        elif time.monotonic() - self.last > 0.1:
            self.last = time.monotonic()
            sys.stderr.write(f"\r{minutes:6.2f} of {self.end_min:.2f} min  {told}  ")
            sys.stderr.flush()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
        else:
            sys.stderr.write("\n")
