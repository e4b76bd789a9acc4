"""Acts on chosen cells during a run, as changes of its scenario from a time on."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from .draft import Changes, Table

ACT_EVERY_S = 0.1  # acts are written down at multiples of this, which read well


def time_of_act(shown_s: float) -> float:
    """Return the time at which an act on the state shown at a time is written down, s."""
    return round(math.ceil(shown_s / ACT_EVERY_S - 1e-9) * ACT_EVERY_S, 6)


def free_name(stem: str, table: Table) -> str:
    """Return the first of stem-1, stem-2, … that names no table of a scenario."""
    taken = {name for inner in table.values() if isinstance(inner, dict) for name in inner}
    return next(name for n in range(1, len(taken) + 2) if (name := f"{stem}-{n}") not in taken)


def active_tables(table: Table) -> list[str]:
    """Return the tables whose forces are active: light inactivates these, and leaves passive stiffness."""
    cortices = [f"cortex.{name}" for name, one in table.get("cortex", {}).items() if one.get("tension_mN_per_m", 0) > 0]
    return cortices + [f"contraction.{name}" for name in table.get("contraction", {})]


def act(kind: str, table: Table, cells: Sequence[int], at_s: float, strength: float) -> tuple[Changes, str]:
    """Return the changes of a scenario that make an act, and its title.

    cut: the cells lose cortex and contraction. darken: their active forces are multiplied by `strength`. pull:
    `strength` Pa draw on their apical faces."""
    count = f"{len(cells)} cell{'s' if len(cells) != 1 else ''}"
    if kind == "cut":
        name = free_name("cut", table)
        return {f"region.{name}.ids": list(cells), f"ablation.{name}": {"region": name, "at_s": at_s}}, f"cut {count}"
    if kind == "darken":
        only = active_tables(table)
        if not only:
            raise ValueError("darken: no cortex or contraction with active tension; add one before the run")
        name = free_name("dark", table)
        light = {"region": name, "at_s": at_s, "only": only, "remaining": strength}
        return {f"region.{name}.ids": list(cells), f"ablation.{name}": light}, f"darken {count} to {strength:g}"
    if kind == "pull":
        name = free_name("pull", table)
        load = {"region": name, "face": "apical", "pressure_Pa": -strength,
            "program": {"time_s": [at_s, at_s], "activity": [0, 1]}}
        return {f"region.{name}.ids": list(cells), f"pressure.{name}": load}, f"pull {count}, {strength:g} Pa"
    raise ValueError(f"act: {kind} is unknown; use cut, darken or pull")


def running_acts(table: Table, at_s: float) -> list[str]:
    """Return the acts of a scenario that can be ended at a time: light and pulls that have begun and last."""
    lasting = [f"ablation.{name}" for name, one in table.get("ablation", {}).items()
               if one.get("at_s", 0) < at_s and one.get("until_s", "none") == "none" and one.get("only")]
    pulls = [f"pressure.{name}" for name, one in table.get("pressure", {}).items()
             if one.get("program", {}).get("activity") == [0, 1] and one["program"]["time_s"][0] < at_s]
    return lasting + pulls


def end_of_act(name: str, table: Table, at_s: float) -> tuple[Changes, str]:
    """Return the changes that end light or a pull at a time, and their title."""
    if name not in running_acts(table, at_s):
        lasting = ", ".join(running_acts(table, at_s)) or "none"
        raise ValueError(f"{name}: not an act that lasts at {at_s:g} s; choose one of: {lasting}")
    kind, _, own = name.partition(".")
    if kind == "ablation":
        return {f"{name}.until_s": at_s}, f"light again: {own}"
    program: dict[str, Any] = table["pressure"][own]["program"]
    times = [*program["time_s"], at_s, at_s]
    return {f"{name}.program": {"time_s": times, "activity": [0, 1, 1, 0]}}, f"let go: {own}"
