"""Per-cell values of a simulation, and arrays of the user's own among them."""
from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import mapping_of, per_cell, text_of, told


class CellData(dict[str, NDArray[np.float64]]):
    """Per-cell values at one moment, by name; values that are assigned are kept by the simulation (`Simulation.cell_data`)."""

    def __init__(self, core: _core.Simulation) -> None:
        super().__init__(core.cell_data)
        self._core = core

    def __setitem__(self, name: str, values: ArrayLike) -> None:
        what = f"cell_data[{told(name)}]"
        array = per_cell(values, len(self._core.pressures), what)
        self._core.set_cell_array(text_of(name, what), array.tolist())
        array.flags.writeable = False
        super().__setitem__(name, array)

    def update(self, *others: Any, **more: Any) -> None:
        for other in (*others, more):
            for name, values in mapping_of(other, "cell_data", "a mapping of names to arrays").items():
                self[name] = values

    def __ior__(self, others: Any) -> Self:  # type: ignore[override,misc]
        self.update(others)
        return self

    def setdefault(self, name: str, values: Any = None) -> NDArray[np.float64]:
        if name not in self:
            self[name] = values
        return self[name]

    def _keep(self, *_: object) -> Any:
        raise TypeError("cell_data: arrays cannot be removed; assign other values")

    __delitem__ = pop = popitem = clear = _keep

    def __reduce__(self) -> tuple[type, tuple[dict[str, Any]]]:
        return dict, (dict(self),)
