"""A tissue at rest, as the page shows it."""
from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Optional

from ..errors import PlicaError
from ..scenario import Scenario
from ..simulation import Simulation
from .draft import Table
from .messages import packed
from .shapes import Floats, ends_of_colours, shape_message, strengths_now, values_now


class Rest:
    """A tissue at rest, built in a thread of its own whenever another one is wanted; `number`: that of its frames."""

    def __init__(self, told: Callable[[], None], number: int) -> None:
        self.number, self.version, self.cells = number, 0, 0
        self.advice: list[str] = []
        self.problem = ""
        self._built: Optional[tuple[int, bytes, Floats, dict[str, Floats]]] = None  # version, shape, positions, values
        self._told, self._wanted = told, threading.Condition()
        self._next: Optional[Callable[[], Scenario]] = None
        self._closing = False
        self._thread = threading.Thread(target=self._work, name="plica studio rest", daemon=True)
        self._thread.start()

    def close(self) -> None:
        with self._wanted:
            self._closing = True
            self._wanted.notify()
        self._thread.join()

    def build(self, make: Callable[[], Scenario]) -> None:
        with self._wanted:
            self._next = make
            self._wanted.notify()

    def _work(self) -> None:
        while True:
            with self._wanted:
                while self._next is None and not self._closing:
                    self._wanted.wait()
                if self._closing or self._next is None:
                    return
                make, self._next = self._next, None
            version = self.version + 1
            built, advice, problem = self._built, list[str](), ""
            try:
                sim = Simulation(make(), threads=1)
                shape = shape_message(sim, f"{self.number}/{version}")
                strengths = {name: array.astype("f4") for name, array in strengths_now(sim, at_rest=True).items()}
                built = (version, shape, sim.positions.astype("f4"), values_now(sim) | strengths)
                advice = list(sim._core.advice)
            except (PlicaError, ValueError, OSError, MemoryError) as error:
                problem = str(error) or "out of memory; use fewer cells"
            with self._wanted:
                if self._next is not None:  # another one is wanted by now
                    continue
                self._built, self.advice, self.problem, self.version = built, advice, problem, version
                self.cells = 0 if problem else len(sim.pressures)
                self._wanted.notify_all()
            self._told()

    def frame_message(self, want: Table) -> list[bytes]:
        """Return shape and frame unless the page knows them."""
        if self._built is None or self._built[0] == want.get("known"):
            return []
        version, shape, positions, values = self._built
        name = want["field"]
        head = {"kind": "frame", "slot": want["slot"], "run": self.number, "index": version, "count": 1, "time_s": 0.0,
                "shape": f"{self.number}/{version}", "field": name, "columns": [], "first_row": 0, "rows": []}
        arrays = {"positions": positions}
        if name in values:
            arrays["values"] = values[name]
            head["range"] = ends_of_colours(name, float(values[name].min()), float(values[name].max()))
        return [shape, packed(head, arrays)]
