"""Progress of a simulation on the terminal or in a notebook."""
from __future__ import annotations

import sys
import time
from typing import Any, Optional

from . import _core


def moment(time_s: float) -> str:
    """Return a time in the unit that shows it."""
    return f"{time_s:.3g} s" if time_s < 60 else f"{time_s / 60:.4g} min"


class Progress:
    """Progress bar: by tqdm if installed, else one line on the terminal."""

    def __init__(self, end_s: float, time_left: _core.TimeLeft) -> None:
        self.end_min = end_s / 60
        self.time_left = time_left
        self.start, self.last = time.monotonic(), 0.0
        self.bar: Any = None
        try:
            from tqdm.auto import tqdm

            self.bar = tqdm(total=round(self.end_min, 3), unit="min", bar_format="{l_bar}{bar}| {n:.2f}/{total:.2f} min {postfix}")
        except ImportError:
            pass

    def show(self, time_s: float, measures: dict[str, Optional[float]]) -> None:
        self.time_left.add(time.monotonic() - self.start, time_s, measures["max_node_speed_um_per_s"] or 0)
        minutes, depth = time_s / 60, measures.get("furrow_depth_um")
        told = f"displacement {measures['max_displacement_um']:.1f} µm" if depth is None else f"depth {depth:.1f} µm"
        if left := self.time_left.text:
            told += f", {left}"
        if self.bar is not None:
            self.bar.set_postfix_str(told, refresh=False)
            self.bar.update(minutes - self.bar.n)
        elif time.monotonic() - self.last > 0.1:
            self.last = time.monotonic()
            sys.stderr.write(f"\r{minutes:6.2f} of {self.end_min:.2f} min  {told}\x1b[K")
            sys.stderr.flush()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
        else:
            sys.stderr.write("\n")


class Counter:
    """Count of runs of unknown number: by tqdm if installed, else one line on the terminal. Does nothing if not shown."""

    def __init__(self, what: str, unit: str, is_shown: bool) -> None:
        self.what, self.unit, self.is_shown, self.count = what, unit, is_shown, 0
        self.bar: Any = None
        try:
            from tqdm.auto import tqdm

            self.bar = tqdm(desc=what, unit=unit) if is_shown else None
        except ImportError:
            pass

    def add(self, told: str) -> None:
        """Count one, and show where it is."""
        self.count += 1
        if self.bar is not None:
            self.bar.set_postfix_str(told, refresh=False)
            self.bar.update()
        elif self.is_shown:
            sys.stderr.write(f"\r{self.what}: {self.count} {self.unit}s  {told}\x1b[K")
            sys.stderr.flush()

    def __enter__(self) -> Counter:
        return self

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()
        elif self.is_shown:
            sys.stderr.write("\n")
