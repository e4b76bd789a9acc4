"""The scenario being edited: always valid, with undo, and its text as differences from a built-in scenario."""
from __future__ import annotations

import copy
import os
import tomllib
from collections.abc import Mapping
from typing import Any, Optional

from .. import _core
from ..errors import ScenarioError
from ..scenario import Scenario, _items, _toml_key, _toml_value

MOST_UNDO, MOST_SAVED = 200, 20
Table = dict[str, Any]
# Tissues to paint, by name: begun in the studio only, since they have no forces yet.
STARTS: dict[str, Table] = {
    "sheet": {"format": 1, "title": "Sheet of 400 cells to paint", "time": {"end_s": 1200},
              "embryo": {"shape": "sheet", "length_um": 100, "width_um": 160, "cell_count": 400, "cell_height_um": 15}},
}
# Values without which a new table is refused, since it would have no effect; by first part of its name.
BEGUN: dict[str, Table] = {
    "ablation": {"at_s": 0}, "cortex": {"tension_mN_per_m": 1}, "division": {"at_s": 60},
    "elasticity": {"young_modulus_Pa": 1000}, "extrusion": {"apical_area_below_um2": 5},
    "foundation": {"stiffness_nN_per_um3": 0.002}, "growth": {"rate_per_h": 0.6},
    "matrix": {"young_modulus_Pa": 30000, "thickness_um": 0.1}, "monitor": {"axis": "z"},
    "region": {"x_um": [-10, 10]}, "signal": {"initial": 1}, "stop": {"above": 0},
}
Changes = Mapping[str, Any]  # by dotted key; None removes a key or a table


def schema() -> list[Table]:
    """Return all tables of scenarios with their keys, as the reference page lists them."""
    return [{"path": path, "meaning": meaning, "group": group, "rows": [dict(row) for row in rows]}
            for path, meaning, group, rows in _core.schema()]


def row_of(key: str, tables: list[Table]) -> Table:
    """Return the row of a dotted key in the schema; empty for an unknown key."""
    for table in tables:
        stem, _, _ = table["path"].partition(".*")
        if stem and not key.startswith(f"{stem}."):
            continue
        rest = key[len(stem) + 1:] if stem else key
        if table["path"].endswith(".*"):
            rest = rest.partition(".")[2]
        for row in table["rows"]:
            if rest == row["key"]:
                return dict(row)
    return {}


def begun(kind: str, region: str, table: Table, tables: list[Table]) -> Table:
    """Return a new table of a kind, "cortex" say, for a scenario: its required keys, with values that are accepted."""
    rows: list[Table] = next((one["rows"] for one in tables if one["path"] == f"{kind}.*"), [])
    made: Table = {row["key"]: 0 if row["type"] == "number" else (row["words"] or [""])[0]
                   for row in rows if row["required"] and "." not in row["key"]}
    if any(row["key"] == "region" for row in rows):
        made["region"] = region
    if kind == "stop":
        monitors = list(table.get("monitor", {}))
        if not monitors:
            raise ValueError("stop: no monitor, which a criterion observes; add one first")
        made["monitor"] = monitors[0]
    return made | BEGUN.get(kind, {})


def typed(value: Any, kind: str) -> Any:
    """Convert the text of a form's field to a value of a type; a text that is none is left for the check to refuse."""
    if not isinstance(value, str) or kind in ("text", "word"):
        return value
    text = value.strip()
    if text == "":
        return None
    is_list = kind.startswith("list") or kind in ("[low, high]", "3 integers")
    for candidate in ([f"[{text}]", text] if is_list and not text.startswith("[") else [text]):
        try:
            return tomllib.loads(f"value = {candidate}")["value"]
        except tomllib.TOMLDecodeError:
            continue
    return [part.strip() for part in text.split(",")] if kind in ("list of words", "list of texts") else text


def changed(table: Table, changes: Changes) -> Table:
    """Return a copy of nested tables with some dotted keys set or removed."""
    result = copy.deepcopy(table)
    for key, value in changes.items():
        *path, last = key.split(".")
        inner = result
        for part in path:
            inner = inner.setdefault(part, {})
            if not isinstance(inner, dict):
                raise ValueError(f"{key}: {part} is a value, not a table; give another key")
        if value is None:
            inner.pop(last, None)
        else:
            inner[last] = value
    return result


def differences(of: Table, base: Table) -> dict[str, Any]:
    """Return the dotted keys of `of` that `base` lacks or has with another value, with their values in `of`."""
    known = dict(_items(base))
    return {key: value for key, value in _items(of) if known.get(key) != value}


def toml(table: Table) -> str:
    """Write nested tables: sections down to named tables, what is deeper in one line."""
    lines = _lines({key: value for key, value in table.items() if not isinstance(value, dict)})
    for name, inner in table.items():
        if not isinstance(inner, dict):
            continue
        own = {key: value for key, value in inner.items() if not isinstance(value, dict)}
        if own:
            lines += ["", f"[{_toml_key(name)}]", *_lines(own)]
        for key, value in inner.items():
            if isinstance(value, dict):
                lines += ["", f"[{_toml_key(name)}.{_toml_key(key)}]", *_lines(value)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _lines(table: Table) -> list[str]:
    return [f"{_toml_key(key)} = {_toml_value(value, key)}" for key, value in table.items()]


class Draft:
    """Scenario with undo. Changes that `plica check` would refuse raise ScenarioError and leave it as it is."""

    def __init__(self, table: Table, base: str = "") -> None:
        self.base = base if base in _core.scenarios else ""
        self.history, self.place, self.drag = [table], 0, ""

    @classmethod
    def of(cls, source: str | os.PathLike[str] | Scenario) -> Draft:
        """Read a built-in scenario, one of STARTS, a file or a Scenario.

        What it expects of its results is left out: it is to be changed."""
        if isinstance(source, str) and source in STARTS:
            source = Scenario(STARTS[source])
        scenario = source if isinstance(source, Scenario) else Scenario(source)
        scenario._require_file("plica.studio")
        name, _, text = scenario._source
        base = name if name in _core.scenarios else str(tomllib.loads(text).get("base", ""))
        table = scenario.to_dict()
        table.pop("expect", None)
        return cls(table, base)

    @property
    def table(self) -> Table:
        return self.history[self.place]

    @property
    def base_table(self) -> Optional[Table]:
        return Scenario(self.base).to_dict() if self.base else None

    def with_changes(self, changes: Changes) -> Table:
        """Return the complete scenario with the changes, checked."""
        return Scenario(changed(self.table, changes)).to_dict()

    def set(self, changes: Changes, drag: str = "") -> None:
        """Make changes. Those of one `drag` of a slider are undone together."""
        table = self.with_changes(changes)
        if drag and drag == self.drag:
            self.undo()
        self.go_to(table)
        self.drag = drag if self.table is table else ""

    def go_to(self, table: Table) -> None:
        """Make another valid scenario the present one; the earlier ones can be restored."""
        if table == self.table:
            return
        self.history = [*self.history[: self.place + 1], table][-MOST_UNDO:]
        self.place = len(self.history) - 1

    def undo(self) -> None:
        self.drag = ""
        self.place = max(self.place - 1, 0)

    def redo(self) -> None:
        self.place = min(self.place + 1, len(self.history) - 1)

    def text(self) -> str:
        return text_of(self.table, self.base)

    def state(self) -> Table:
        first = max(self.place - MOST_SAVED, 0)
        return {"base": self.base, "history": self.history[first : self.place + MOST_SAVED],
            "place": self.place - first}

    @classmethod
    def restored(cls, state: Table) -> Draft:
        draft = cls({}, state["base"])
        draft.history, draft.place = state["history"], state["place"]
        return draft


def _with_least(start: Table, table: Table) -> Table:
    """Return `start` with each named table of `table` that it lacks, of no more keys than such a table needs."""
    made = copy.deepcopy(start)
    for kind, rows in ((one["path"][:-2], one["rows"]) for one in schema() if one["path"].endswith(".*")):
        needed = {row["key"] for row in rows if row["required"]} | {"region", *BEGUN.get(kind, {})}
        for name, values in table.get(kind, {}).items():
            if isinstance(values, dict) and name not in made.get(kind, {}):
                least = {key: value for key, value in values.items() if key in needed}
                made.setdefault(kind, {})[name] = least or values
    return made


def defaults_of(table: Table) -> list[str]:
    """Return the dotted keys of named tables that have their default values."""
    least = _with_least({"format": 1, "embryo": table["embryo"]}, table)
    given = dict(_items(least))
    try:
        known = Scenario(least).to_dict()
    except ScenarioError:  # a law that needs more than is known here
        return []
    differ = differences(table, known)
    return [key for key, _ in _items(table) if key.count(".") > 1 and key not in given and key not in differ]


def text_of(table: Table, base: str) -> str:
    """Write a complete scenario as its differences from a built-in one or from defaults, or whole where these fail."""
    for start in [{"format": 1, "base": base}] * bool(base) + [{"format": 1, "embryo": table["embryo"]}]:
        for least in (True, False):
            try:
                known = Scenario(start).to_dict()
                begin = changed(start, _added(known, _with_least(known, table))) if least else start
                short = changed(begin, differences(table, Scenario(begin).to_dict()))
                read = Scenario(short).to_dict()
            except ScenarioError:  # a file of cells that is gone, say
                continue
            read.pop("expect", None)
            if read == table:
                return toml(short)
    return toml(table)


def _added(before: Table, after: Table) -> Table:
    """Return the named tables that one of two nested tables has more, by dotted name."""
    return {f"{kind}.{name}": values for kind, inner in after.items() if isinstance(inner, dict)
            for name, values in inner.items() if isinstance(values, dict) and name not in before.get(kind, {})}
