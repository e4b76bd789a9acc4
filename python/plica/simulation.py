"""Simulations advanced from Python, one time step at a time."""
from __future__ import annotations

import contextlib
import html
import logging
import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import callable_of, number, path_of, per_cell, text_of, whole
from .cell_data import CellData, Signals
from .errors import FileError
from .local_energy import LocalEnergy, LocalLaw, laws_of
from .progress import Progress, moment
from .results import Run, _grid, _pandas, open_run
from .scenario import Scenario
from .tissue import Tissue

if TYPE_CHECKING:
    import pandas

__all__ = ["Simulation", "Step", "load"]

log = logging.getLogger("plica")
told_once: set[str] = set()  # warnings shown by this process


def _warn_once(line: str) -> None:
    if line not in told_once:
        told_once.add(line)
        log.warning("%s", line.removeprefix("warning: "))


class Step:
    """Time step that was taken, with its output variables.

    Attributes
    ----------
    time_s : float
        Time at the end of the step, s.
    measures : dict of str to float or None
        Output variables of ``series.csv``, units in the names (:doc:`output variables </reference/measures>`); None where a
        variable has no value.
    """

    __slots__ = ("time_s", "measures")

    def __init__(self, time_s: float, measures: dict[str, Optional[float]]) -> None:
        self.time_s, self.measures = time_s, measures

    def __getitem__(self, name: str) -> Optional[float]:
        return self.measures[name]

    @property
    def newton_iterations(self) -> int:
        """Number of Newton iterations, including those of rejected attempts."""
        return int(self.measures["newton_iterations"] or 0)

    @property
    def volume_error(self) -> Optional[float]:
        """Largest relative volume error of a cell."""
        return self.measures["max_volume_error"]

    def __repr__(self) -> str:
        return f"Step(to {moment(self.time_s)}, {self.newton_iterations} Newton iterations)"


class Simulation:
    """Simulation of a scenario, advanced step by step.

    Parameters
    ----------
    scenario : Scenario, str, path or mapping
        The scenario or its source (see `Scenario`). It is copied: later changes to it have no effect.
    threads : int, optional
        Threads per step; by default one for every 10 000 elements. Results are bitwise identical for any number.
    energies : dict of str to LocalEnergy, optional
        Further force laws, by name.

    Raises
    ------
    ScenarioError
        If an error shows only when the tissue is built.
    ValueError
        If a group of `energies` has a node that the tissue has not, or the scenario changes the nodes.

    Notes
    -----
    Arrays are read-only copies of the state at access. Other Python threads keep running while a step is solved. Use a
    simulation from one thread at a time; simulations are independent of each other.

    Examples
    --------
    >>> import plica
    >>> sim = plica.Simulation(plica.Scenario("drosophila"), threads=1)
    >>> while sim.time_s < 20:
    ...     step = sim.step()
    >>> round(step["furrow_depth_um"], 1)
    5.1
    """

    def __init__(self, scenario: Union[Scenario, str, os.PathLike[str], Mapping[str, Any]], *, threads: Optional[int] = None,
                 energies: Optional[Mapping[str, LocalEnergy]] = None) -> None:
        own = scenario.copy() if isinstance(scenario, Scenario) else Scenario(scenario)
        local = laws_of(energies)
        core = _core.Simulation(own._ready, _threads(threads), energies=local)
        own._check_masks(len(core.pressures))
        self._begin(own, core, local)

    def _resume(self, scenario: Scenario, threads: int, saved: bytes, local: Sequence[LocalLaw] = ()) -> None:
        """Begin in a saved state, which may be of another scenario."""
        self._begin(scenario, _core.Simulation(scenario._ready, threads, saved, energies=list(local)), local)

    def _begin(self, scenario: Scenario, core: _core.Simulation, local: Sequence[LocalLaw]) -> None:
        self._scenario, self._core, self._local = scenario, core, local
        self._has_crossed = False
        for line in core.advice if core.steps == 0 else []:
            if line.startswith("warning: "):
                _warn_once(line)

    @property
    def scenario(self) -> Scenario:
        """Copy of the scenario it was made from."""
        return self._scenario.copy()

    # Advancing

    def step(self, *, until_min: Optional[float] = None) -> Optional[Step]:
        """Take the next time step.

        Parameters
        ----------
        until_min : float, optional
            Latest end of the step, minutes.

        Returns
        -------
        Step or None
            None if the simulation has finished or has reached `until_min`.

        Raises
        ------
        NumericsError
            If no step converges, however short. The simulation stays at the last accepted state.
        KeyboardInterrupt
            On Ctrl-C. The step is discarded; the next call repeats it.
        """
        return self._step(_seconds(until_min))

    def _step(self, until_s: float) -> Optional[Step]:
        if not self._core.step(until_s):
            return None
        measures = self._core.measures
        if not self._has_crossed and (measures["self_intersections"] or 0) > 0:
            self._has_crossed = True
            warnings.warn(self._core.crossing_warning, stacklevel=3)
        for text in self._core.warnings:
            warnings.warn(text, stacklevel=3)
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
        """Run to the end, or to a given time.

        Parameters
        ----------
        until_min : float, optional
            End of the last step, minutes; by default the run continues until it has finished.
        out : str or path, optional
            Directory for the files that ``plica run`` writes. They record the run from the present state.
        overwrite : bool
            Replace existing results in `out`; otherwise they raise FileError.
        resume : bool
            Continue from the checkpoint in `out`, bitwise identically; start a new run if there is none. The simulation must be
            in its initial state.
        progress : bool
            Show a progress bar in a terminal or notebook.
        callback : callable, optional
            Called as ``callback(simulation, step)`` after every step; may call `set_activity`. Return a true value to stop.

        Returns
        -------
        Run or None
            Results in `out`; None without `out`.

        Raises
        ------
        NumericsError
            If no step converges, as for `step`.
        FileError
            If a file cannot be written, or `out` already has results.
        ValueError
            If arguments conflict, such as `resume` without `out`.
        KeyboardInterrupt
            On Ctrl-C, after saving. The same call with ``resume=True`` continues.

        Warns
        -----
        UserWarning
            If the tissue first intersects itself, or if time steps of a finished run lost or added more than 1 % of its energy.

        Examples
        --------
        >>> import plica
        >>> sim = plica.Simulation("drosophila")
        >>> sim.run(until_min=1, callback=lambda sim, step: step["furrow_depth_um"] > 5)
        >>> sim.finished
        False
        """
        end_s = _seconds(until_min)
        callable_of(callback, "callback")
        if out is None and (resume or overwrite):
            raise ValueError("overwrite and resume require a results directory; set out")
        if out is not None and not self._begin_record(path_of(out, "out"), overwrite, resume):
            return open_run(out)
        bar = Progress(min(end_s, self._core.end_s), self._core.time_left(end_s)) if progress else None
        try:
            while (step := self._step(end_s)) is not None:
                if bar is not None:
                    bar.show(step.time_s, step.measures)
                if callback is not None and callback(self, step):
                    break
        finally:
            if bar is not None:
                bar.close()
            if self._core.is_recording:
                self._core.end_record()
        return None if out is None else open_run(out)

    def _begin_record(self, out: str, overwrite: bool, resume: bool) -> bool:
        """Start recording; return False if the run in `out` has finished."""
        if overwrite and resume:
            raise ValueError("overwrite and resume exclude each other; set one of them")
        if self._core.is_recording:
            raise ValueError("this simulation is already being recorded; end that run first")
        for note in self._core.begin_record(out, "resume" if resume else "overwrite" if overwrite else "fresh"):
            log.warning("%s", note)
        return self._core.is_recording

    @property
    def finished(self) -> bool:
        """Whether the simulation reached equilibrium, its end time or a stop criterion, or failed."""
        return self._core.status != "under_way"

    @property
    def status(self) -> str:
        """Status: "under_way", "equilibrium", "end_time" (also for stop criteria) or "failed"."""
        return self._core.status

    def set_activity(self, law: str, activity: Optional[ArrayLike]) -> None:
        """Override the activity time course of a law with per-cell values.

        Parameters
        ----------
        law : str
            Name of a contraction or cortex: alone if unambiguous ("apical"), or with its table ("cortex.apical").
        activity : array_like of float, shape (cells,), or float, or None
            Factor on the strength of each cell, 0 or more. NaN or masked: the cell follows its time course. None: all cells do.

        Raises
        ------
        ValueError
            If no active law has this name, the shape is wrong, or a value is negative or infinite.

        Notes
        -----
        The values hold until they are set again, also in copies and saved simulations. A large sudden change causes some
        rejected steps. Use it for optogenetic inhibition, feedback, or coupling to another model.

        Examples
        --------
        >>> import numpy as np, plica
        >>> sim = plica.Simulation("drosophila")
        >>> x = sim.cell_data["x_um"]
        >>> sim.set_activity("apical", np.where(x > 0, 0.0, np.nan))  # switch off one half
        """
        label = self._label(law)
        if activity is None:
            return self._core.set_activity(label, [])
        values = per_cell(activity, len(self._core.activity(label)), label)
        if (values < 0).any():
            cell = int(np.argmax(values < 0))
            raise ValueError(f"{label}: the activity of cell {cell} is {values[cell]}; give a number >= 0")
        self._core.set_activity(label, np.where(np.isnan(values), -1.0, values).tolist())

    def activity(self, law: str) -> NDArray[np.float64]:
        """Return the present activity of each cell under a law.

        Parameters
        ----------
        law : str
            Name, as in `set_activity`.

        Returns
        -------
        ndarray of float, shape (cells,)
            Activity by time course, cell state or `set_activity`; NaN for cells outside the region of the law.
        """
        return self._core.activity(self._label(law))

    def set_wall_factors(self, law: str, factors: Optional[ArrayLike]) -> None:
        """Multiply the tension of single walls in a cortex of lateral faces.

        Parameters
        ----------
        law : str
            Name of a lateral cortex: alone if unambiguous ("lateral"), or with its table ("cortex.lateral").
        factors : array_like of float, shape (walls,), or float, or None
            Factor on the tension of each wall, 0 or more, in the order of `walls`. None: no factors.

        Raises
        ------
        ValueError
            If no lateral cortex has this name, the shape is wrong, a value is negative or not finite, or the embryo has mirror
            planes.

        Notes
        -----
        A factor belongs to a pair of cells, or to a cell and the rim, and multiplies `direction` and `noise`. It holds until
        factors are set again, also in copies and saved simulations. Walls of daughters inherit it; cells that meet by an exchange
        begin with 1, also if they were neighbours before. The order of `walls` then changes: read `wall_factors` again.

        Examples
        --------
        >>> import numpy as np, plica
        >>> sim = plica.Simulation({"embryo": {"shape": "sheet", "cell_count": 40},
        ...                         "cortex": {"lateral": {"region": "all", "faces": "lateral", "tension_mN_per_m": 1}}})
        >>> walls = sim.walls
        >>> short = walls["length_um"] < np.median(walls["length_um"])
        >>> sim.set_wall_factors("lateral", np.where(short, 2.0, 1.0))
        >>> print(sim.walls["tension_mN_per_m"].max().round(3))
        2.0
        """
        label = self._label(law)
        if factors is None:
            return self._core.set_wall_factors(label, [])
        values = per_cell(factors, len(self._core.wall_factors(label)), f"{label}: factors", "wall")
        self._core.set_wall_factors(label, values.tolist())

    def wall_factors(self, law: str) -> NDArray[np.float64]:
        """Return the factors of `set_wall_factors`, shape (walls,); 1 where none is set.

        Parameters
        ----------
        law : str
            Name, as there.
        """
        return self._core.wall_factors(self._label(law))

    def _label(self, name: str) -> str:
        text_of(name, "law")
        labels = self._core.laws(active=True)
        fitting = [label for label in labels if label == name or label.partition(".")[2] == name]
        if name in labels:
            return name
        if len(fitting) > 1:
            raise ValueError(f'"{name}" is ambiguous; use {" or ".join(fitting)}')
        return fitting[0] if fitting else name

    # Copies and files

    def copy(self) -> Simulation:
        """Return an independent copy of the present state, to branch the run.

        Both continue bitwise identically until one is changed; their last digits may differ from those of a simulation that
        was not copied.

        Examples
        --------
        >>> import plica
        >>> sim = plica.Simulation("drosophila")
        >>> sim.run(until_min=1)
        >>> fork = sim.copy()
        >>> fork.set_activity("apical", 0)
        """
        other = object.__new__(Simulation)
        other._begin(self._scenario.copy(), self._core.copy(), self._local)
        return other

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Save the complete state to a file, for `load`.

        Parameters
        ----------
        path : str or path
            File to write; an existing one is replaced.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        target = Path(path_of(path, "path"))
        beside = target.parent / (target.name + ".part")
        try:
            beside.write_bytes(self._core.save())
            os.replace(beside, target)
        except OSError as error:
            with contextlib.suppress(OSError):
                beside.unlink(missing_ok=True)
            raise FileError(f"{target}: cannot be written: {error.strerror}") from error

    def __getstate__(self) -> dict[str, Any]:
        return {"scenario": self._scenario, "saved": self._core.save(), "threads": self._core.threads, "local": self._local}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._resume(**state)

    # Present state

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
        """Number of accepted time steps."""
        return self._core.steps

    @property
    def threads(self) -> int:
        """Number of threads per step."""
        return self._core.threads

    @property
    def measures(self) -> dict[str, Optional[float]]:
        """Output variables of ``series.csv`` at the present time; units in the names."""
        return self._core.measures

    @property
    def positions(self) -> NDArray[np.float64]:
        """Node positions, µm; shape (nodes, 3)."""
        return self._core.positions

    @property
    def rest_positions(self) -> NDArray[np.float64]:
        """Node positions in the reference state, µm; shape (nodes, 3)."""
        return self._core.rest_positions

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Node velocities at the end of the last step, µm/s; shape (nodes, 3)."""
        return self._core.velocities

    @property
    def hexahedra(self) -> NDArray[np.int32]:
        """Node indices of the elements in VTK order, the last four apical; shape (elements, 8)."""
        return self._core.hexahedra

    @property
    def hexahedron_cell(self) -> NDArray[np.int32]:
        """Cell of each element, as an index into `cell_data`; shape (elements,)."""
        return self._core.hexahedron_cell

    @property
    def pressures(self) -> NDArray[np.float64]:
        """Pressure of each cell, Pa; shape (cells,)."""
        return self._core.pressures

    @property
    def cell_data(self) -> CellData:
        """Per-cell values of ``cells.csv`` and arrays of the tissue, of shape (cells,), units in the names.

        Assign an array of your own to keep it: `save`, `copy` and the snapshots of later steps include it, and daughters inherit
        it. No law reads it (see `set_activity`). The report colours cells by arrays that exist when the run begins. ValueError
        for a wrong shape, a value that is not finite, or the name of another array.

        Examples
        --------
        >>> import numpy as np, plica
        >>> sim = plica.Simulation("drosophila")
        >>> sim.cell_data["signal"] = np.exp(-sim.cell_data["x_um"] ** 2 / 2e4)
        >>> float(sim.cell_data["signal"].max().round(1))
        1.0
        """
        return CellData(self._core)

    @property
    def signals(self) -> Signals:
        """Concentration of each ``[signal.NAME]`` in each cell, by name; arrays of shape (cells,).

        Assign an array to change it: the next step begins with it, and laws follow it. ValueError for an unknown name, a wrong
        shape, or a value that is not finite.

        Examples
        --------
        >>> import plica
        >>> sim = plica.Simulation({"embryo": {"shape": "sheet"}, "signal": {"u": {"decay_per_min": 0.1}}})
        >>> sim.signals["u"] = sim.cell_data["x_um"] > 0
        >>> float(sim.signals["u"].max())
        1.0
        """
        return Signals(self._core)

    @property
    def cells(self) -> pandas.DataFrame:
        """Per-cell values of `cell_data`, as a table with one row per cell."""
        table: pandas.DataFrame = _pandas("cells").DataFrame({k: v.copy() for k, v in self._core.cell_data.items()})
        return table

    @property
    def regions(self) -> dict[str, NDArray[np.bool_]]:
        """Regions of the scenario, as boolean arrays of shape (cells,)."""
        return self._core.regions

    @property
    def neighbours(self) -> NDArray[np.int32]:
        """Pairs of cells that share a lateral face, as indices into `cell_data`, lower first; shape (pairs, 2)."""
        return self._core.neighbours

    @property
    def walls(self) -> NDArray[np.void]:
        """Table of lateral faces, one row per pair of cells; a structured array of shape (walls,).

        Its fields: `cell` and `other`, as indices into `cell_data`, lower first (`other` is -1 for all faces by which a cell
        touches no other); `length_um`, mean of base and apex; `area_um2`; `tension_mN_per_m` of all lateral
        cortices. Rows are in order of both cells. ``pandas.DataFrame(sim.walls)`` makes a table of it.

        Examples
        --------
        >>> import plica
        >>> walls = plica.Simulation({"embryo": {"shape": "sheet", "cell_count": 40}}).walls
        >>> inner = walls[walls["other"] >= 0]
        >>> inner.dtype.names
        ('cell', 'other', 'length_um', 'area_um2', 'tension_mN_per_m')
        """
        columns = self._core.walls
        table = np.empty(len(columns["cell"]), [(name, column.dtype) for name, column in columns.items()])
        for name, column in columns.items():
            table[name] = column
        table.flags.writeable = False
        return table

    @property
    def laws(self) -> list[str]:
        """Names of the force laws, for `forces` and `energies`."""
        return self._core.laws(active=False)

    def forces(self, law: str) -> NDArray[np.float64]:
        """Return the nodal forces of one law in the present state, at zero velocity.

        Parameters
        ----------
        law : str
            A name in `laws`.

        Returns
        -------
        ndarray of float, shape (nodes, 3)
            Forces, nN; 0 for laws that resist motion (drag, viscosity, dampers), and at hanging nodes, whose forces act on the
            free nodes that carry them.

        Raises
        ------
        ValueError
            If no law has this name.
        """
        return self._core.forces(text_of(law, "law"))

    @property
    def energies(self) -> dict[str, dict[str, float]]:
        """Energies by law since the start: "active" (work done by cells), "stored" and "dissipated"; nN µm."""
        return self._core.energies

    def to_pyvista(self) -> Any:
        """Return the present mesh as a ``pyvista.UnstructuredGrid`` with `cell_data` on its elements.

        Raises
        ------
        MissingExtra
            If PyVista is not installed.
        """
        cell = self.hexahedron_cell
        data = {name: values[cell] for name, values in self.cell_data.items()}
        return _grid(self.positions, self.hexahedra, {}, data)

    def __repr__(self) -> str:
        return f"Simulation({self._scenario.name!r}, at {moment(self.time_s)} after {self.steps} steps, {self.status})"

    def _repr_html_(self) -> str:
        told = {name: value for name, value in self.measures.items() if value is not None}
        rows = "".join(
            f"<tr><td style='text-align:left'>{html.escape(name)}</td><td>{value:.5g}</td></tr>" for name, value in told.items()
        )
        return f"{html.escape(repr(self))}<details><summary>measures</summary><table>{rows}</table></details>"


def load(
    path: Union[str, os.PathLike[str]],
    *,
    threads: Optional[int] = None,
    tissue: Optional[Tissue] = None,
    arrays: Optional[Mapping[str, ArrayLike]] = None,
    energies: Optional[Mapping[str, LocalEnergy]] = None,
) -> Simulation:
    """Load a saved simulation or the checkpoint of a run; it continues bitwise identically.

    Parameters
    ----------
    path : str or path
        File written by ``Simulation.save``, or the ``checkpoint.h5`` of a run.
    threads : int, optional
        Threads per step, as for `Simulation`.
    tissue, arrays, energies : optional
        Tissue, arrays and energies that it was given from Python, if any.

    Returns
    -------
    Simulation

    Raises
    ------
    FileError
        If the file cannot be read, is damaged, or belongs to another tissue.

    Examples
    --------
    >>> import pathlib, tempfile, plica
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "state.h5"
    >>> plica.Simulation("drosophila").save(file)
    >>> plica.load(file).time_s
    0.0
    """
    source = Path(path_of(path, "path"))
    try:
        saved = source.read_bytes()
    except OSError as error:
        raise FileError(f"{source}: cannot be read: {error.strerror}") from error
    try:
        scenario = Scenario(_core.scenario_of_saved(saved), tissue=tissue, arrays=arrays)
        simulation = object.__new__(Simulation)
        simulation._resume(scenario, _threads(threads), saved, laws_of(energies))
    except FileError as error:
        raise FileError(f"{source}: {error}") from error
    except UnicodeDecodeError as error:
        raise FileError(f"{source}: is damaged: its scenario is not valid text") from error
    return simulation


def _threads(threads: Optional[int]) -> int:
    return 0 if threads is None else whole(threads, "threads", 1, 1024)


def _seconds(until_min: Optional[float]) -> float:
    """Convert minutes to seconds; None becomes infinity."""
    if until_min is None or (isinstance(until_min, float) and until_min == math.inf):
        return math.inf
    return 60 * number(until_min, "until_min", "a number")
