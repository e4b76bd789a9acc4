"""Per-cell values of a simulation, signals, and arrays of the user's own among them."""
from __future__ import annotations

from typing import Any, Callable, Self, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import mapping_of, per_cell, text_of, told


class _CellArrays(dict[str, NDArray[np.float64]]):
    """Per-cell values at one moment, by name, which are given back to the simulation when assigned."""

    _title: str

    def __init__(self, values: dict[str, NDArray[np.float64]], cells: int, give: Callable[[str, Sequence[float]], None]) -> None:
        super().__init__(values)
        self._cells, self._give = cells, give

    def __setitem__(self, name: str, values: ArrayLike) -> None:
        what = f"{self._title}[{told(name)}]"
        array = per_cell(values, self._cells, what)
        self._give(text_of(name, what), array.tolist())
        array.flags.writeable = False
        super().__setitem__(name, array)

    def update(self, *others: Any, **more: Any) -> None:
        for other in (*others, more):
            for name, values in mapping_of(other, self._title, "a mapping of names to arrays").items():
                self[name] = values

    def __ior__(self, others: Any) -> Self:  # type: ignore[override,misc]
        self.update(others)
        return self

    def setdefault(self, name: str, values: Any = None) -> NDArray[np.float64]:
        if name not in self:
            self[name] = values
        return self[name]

    def _keep(self, *_: object) -> Any:
        raise TypeError(f"{self._title}: arrays cannot be removed; assign other values")

    __delitem__ = pop = popitem = clear = _keep

    def __reduce__(self) -> tuple[type, tuple[dict[str, Any]]]:
        return dict, (dict(self),)


class CellData(_CellArrays):
    """Per-cell values at one moment, by name; values that are assigned are kept by the simulation (`Simulation.cell_data`)."""

    _title = "cell_data"

    def __init__(self, core: _core.Simulation) -> None:
        super().__init__(core.cell_data, len(core.pressures), core.set_cell_array)


class Signals(_CellArrays):
    """Concentrations of signals at one moment, by name; assigned ones replace those of the simulation (`Simulation.signals`)."""

    _title = "signals"

    def __init__(self, core: _core.Simulation) -> None:
        super().__init__(core.signals, len(core.pressures), core.set_signal)
