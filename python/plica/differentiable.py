"""Runs as functions of arrays, for frameworks of automatic differentiation: `plica.jax`, `plica.torch`."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .arguments import text_of, texts_of, told
from .scenario import Scenario
from .simulation import Simulation
from .tapes import Tape, _times, record

Array = NDArray[np.float64]
Source = Union[Scenario, str, os.PathLike[str], Mapping[str, Any]]
ACCURACY = 1e-9  # of gradients


class Run:
    """Node positions of a run as a function of keys or strengths of cells, with its transposed derivative.

    Parameters
    ----------
    scenario : Scenario, str, path or mapping
        As for `record`.
    of : str or iterable of str
        Key or keys with a number; with ``by="cell"``, one contraction or cortex.
    by : "cell", optional
        For factors on the strengths of cells.
    at_min : float or iterable of float, optional
        Time or times of the positions, minutes; by default the end of the run.
    threads : int
        Threads per step.

    Attributes
    ----------
    size : int
        Length of the argument.
    shape : tuple of int
        Shape of the positions: (nodes, 3), or (times, nodes, 3) with several times.
    """

    def __init__(self, scenario: Source, of: Union[str, Iterable[str]], by: Optional[str] = None,
                 at_min: Union[None, float, Iterable[float]] = None, threads: int = 1) -> None:
        if by not in (None, "cell"):
            raise ValueError(f'by: {told(by)}; give "cell", or omit it for keys of the scenario')
        self.scenario = scenario.copy() if isinstance(scenario, Scenario) else Scenario(scenario)
        simulation = Simulation(self.scenario, threads=threads)
        self.law = simulation._label(text_of(of, "of")) if by == "cell" else None
        self.keys = [] if by == "cell" else texts_of(of, "of")
        self.at_min = at_min if at_min is None or not isinstance(at_min, Iterable) else list(_times(at_min))
        self.threads = threads
        self.size = len(simulation.pressures) if by == "cell" else len(self.keys)
        nodes = simulation.positions.shape
        self.shape: tuple[int, ...] = (len(self.at_min), *nodes) if isinstance(self.at_min, list) else nodes
        self._last: tuple[bytes, Tape]

    def record(self, values: Array) -> Tape:
        """Record the run, or return the last one if it had the same values."""
        if values.shape != (self.size,):
            raise ValueError(f"argument of shape {values.shape}; give one of shape ({self.size},)")
        name = np.ascontiguousarray(values, dtype=np.float64).tobytes()
        if not hasattr(self, "_last") or self._last[0] != name:
            scenario, times = self.scenario.copy(), [] if self.at_min is None else _times(self.at_min)
            scenario.update(dict(zip(self.keys, values.tolist())))
            self._last = name, record(scenario, at_min=times, until_min=max(times, default=None), threads=self.threads,
                                      strengths={} if self.law is None else {self.law: values})
            if self._last[1].positions().shape != self.shape[-2:]:
                raise ValueError("positions: cells divide in this run, so the number of nodes changes; end the run before")
        return self._last[1]

    def positions(self, values: Array) -> Array:
        """Return node positions, µm."""
        tape = self.record(values)
        if isinstance(self.at_min, list):
            return np.stack([tape.positions(time) for time in self.at_min])
        return tape.positions(self.at_min)

    def pull_back(self, values: Array, by_positions: Array) -> Array:
        """Return the gradient by the argument of a function of positions, from its gradient by these."""
        tape, by = self.record(values), np.asarray(by_positions, dtype=np.float64)
        if self.law is not None:
            return np.asarray(tape.gradient(by, of=self.law, by="cell", at_min=self.at_min, tolerance=ACCURACY))
        return np.asarray(tape.gradient(by, of=self.keys, at_min=self.at_min, tolerance=ACCURACY))
