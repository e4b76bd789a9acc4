"""Laws divided into parts that act about knots in time, so that strengths of cells can change between knots."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from .arguments import number_from
from .scenario import Scenario

PIECES = 8  # linear pieces between points, for the product of two piecewise linear functions
PASSIVE = {"cortex": ("stiffness_mN_per_m", "crowding_mN_per_m"), "contraction": ("damping_nN_s_per_um",)}  # not times the activity


def times_of(knots_min: Iterable[float]) -> list[float]:
    """Return knots, in minutes. ValueError unless there are two or more, increasing."""
    times = [number_from(time, 0, "knots_min", "times in minutes") for time in knots_min]
    if len(times) < 2 or sorted(set(times)) != times:
        raise ValueError(f"knots_min: {', '.join(f'{time:g}' for time in times) or 'none'}; give two or more increasing times in minutes")
    return times


def divided(scenario: Scenario, law: str, knots_min: list[float]) -> list[str]:
    """Divide a law of a scenario into one per knot; return their names.

    Their activities are that of the law times hat functions of the knots, which add up to 1: unchanged in sum.
    """
    kind, _, name = law.partition(".")
    table = scenario.to_dict()[kind][name]
    passive = [key for key in PASSIVE[kind] if table.get(key, 0) != 0]
    if passive or {"measure", "signal"} & set(table.get("trigger", {})):
        raise ValueError(f"knots_min: {law} has {' and '.join(passive) or 'a trigger'}; give a law whose tension alone has a time course, as "
                         f"a second [{kind}.NAME] without it")
    program = table.get("program", {"time_s": [0.0, 0.0], "activity": [1.0, 1.0]})
    times_s = np.asarray(program.get("time_s", 60 * np.asarray(program.get("time_min", []))), dtype=float)
    knots_s = 60 * np.array(knots_min)
    pieces: list[tuple[float, float]] = []  # time, activity
    ends = np.concatenate([[min(times_s[0], knots_s[0])], times_s, [max(times_s[-1], knots_s[-1])]])
    values = np.concatenate([program["activity"][:1], program["activity"], program["activity"][-1:]])
    for (begin, end), (first, last) in zip(zip(ends, ends[1:]), zip(values, values[1:])):
        inner = knots_s[(knots_s > begin) & (knots_s < end)]
        corners = np.concatenate([[begin], inner, [end]])
        fine = np.unique(np.concatenate([np.linspace(a, b, PIECES + 1) for a, b in zip(corners, corners[1:])]))
        activity = np.interp(fine, [begin, end], [first, last]) if end > begin else np.array([first])
        pieces += [(float(time), float(one)) for time, one in zip(fine, activity) if (time, one) not in pieces[-1:]]
    times, activities = np.array(pieces).T
    names = [f"{name}-at-{time:g}-min".replace(".", "p") for time in knots_min]
    changes: dict[str, Any] = {}
    for k, part in enumerate(names):
        hat = np.interp(times, knots_s, np.eye(len(knots_s))[k])
        changes[f"{kind}.{part}"] = {**table, "program": {"time_s": times.tolist(), "activity": (activities * hat).tolist()}}
    for cut, of_cut in scenario.to_dict().get("ablation", {}).items():
        if law in of_cut.get("only", []):
            changes[f"ablation.{cut}.only"] = [one for one in of_cut["only"] if one != law] + [f"{kind}.{part}" for part in names]
    changes[f"{law}.program"] = {"time_s": [0, 1], "activity": [0, 0]}
    scenario.update(changes)
    return [f"{kind}.{part}" for part in names]
