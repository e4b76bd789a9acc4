"""Draw a random scenario from the key table: a small embryo, plausible values for most keys, extreme ones for some.

Keys, types and ranges come from the table; plausible values from a key's default or the unit in its name, so new keys
need no change here. This module only adds what keeps runs short.
"""
import math

SEVERAL = {"region": (0, 3), "contraction": (0, 3), "hold": (0, 1), "pressure": (0, 2), "division": (-2, 1), "signal": (-1, 2), "stop": (-1, 1),
           "monitor": (0, 3), "expect": (-2, 1)}  # numbers of named tables: least (below 0: mostly none) and most
MOST_ELEMENTS = 250
MOST_STEPS = 60


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + "".join(c if c.isprintable() and c not in '"\\' else f"\\u{ord(c):04X}" for c in value) + '"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return repr(value)


class Draft:
    """Scenario as addresses and values: {"embryo.shape": "block", "contraction.a.region": "all", ...}."""

    def __init__(self):
        self.values = {}

    def text(self):
        tables = {}
        for address, (table, key, value) in self.values.items():
            tables.setdefault(table, []).append(f"{key} = {toml(value)}")
        parts = ["\n".join(tables.pop("", []))]
        return "\n".join(parts + [f"[{table}]\n" + "\n".join(lines) for table, lines in tables.items()]) + "\n"

    def put(self, table, key, value):
        self.values[f"{table}.{key}" if table else key] = (table, key, value)

    def get(self, address, default=None):
        return self.values[address][2] if address in self.values else default

    def drop(self, address):
        """Remove a key, or all keys of a table; return whether there was any."""
        gone = [a for a in self.values if a == address or a.startswith(address + ".")]
        for a in gone:
            del self.values[a]
        return bool(gone)


class Drawer:
    """Random draws. `files`: file names by key ("embryo.file": [...])."""

    def __init__(self, random, tables, expected, files):
        self.random, self.tables, self.expected, self.files = random, tables, expected, files

    def draw(self):
        r = self.random
        self.draft = Draft()
        self.names = {}
        for table in self.tables:
            least, most = SEVERAL.get(table.stem, (0, 2)) if table.named else (1, 1)
            count = max(0, r.randint(least, most))
            names = r.sample(self.expected, count) if table.stem == "expect" else [f"{table.stem[:1]}{i}" for i in range(count)]
            self.names[table.stem] = names if table.named else []
        for table in self.tables:
            for path in [f"{table.stem}.{name}" for name in self.names[table.stem]] if table.named else [table.path]:
                # Draw few keys of plain tables, more of named ones, which have no effect without keys.
                share = r.choice((0, 0.2, 0.5)) if not table.named else r.choice((0.3, 0.6))
                for key in table.keys:
                    if key.required or r.random() < share:
                        self.put(path, key)
        self.make_small()
        for extreme in EXTREMES:
            if r.random() < 0.07:
                extreme(self.draft, r)
        return self.draft

    def put(self, path, key):
        if key.instead_of and f"{path}.{key.instead_of}" in self.draft.values and self.random.random() < 0.95:
            return
        value = self.value(path, key)
        if value is not None:
            self.draft.put(path, key.name, value)

    def value(self, path, key):
        r, kind = self.random, key.kind
        if key.word_for_none and r.random() < 0.3:
            return key.word_for_none
        if kind == "text":
            return self.word_of(path, key)
        if kind == "word":
            return r.choice(key.words)
        if kind == "true or false":
            return r.random() < 0.5
        if kind == "number":
            return self.number(key)
        if kind == "integer":
            return self.integer(key)
        if kind == "3 integers":
            return [self.integer(key) for _ in range(3)]
        if kind == "[low, high]":
            low, high = sorted(r.gauss(0, 100) for _ in range(2))
            return [low, high] if r.random() < 0.5 else [-math.fabs(low), 1e6]
        if kind == "list of words":
            return r.sample(key.words, r.randint(1, len(key.words)))
        if kind == "list of integers":
            return [r.randrange(40) for _ in range(r.randint(1, 8))]
        if kind == "list of numbers":
            numbers = [self.number(key) for _ in range(3)]
            return sorted(map(abs, numbers)) if "time" in key.name or ".at_" in key.name else numbers
        if kind == "list of texts":
            return [self.word_of(path, key) for _ in range(r.randint(1, 2))]
        if kind == "table of numbers":
            return {"k": self.number(key)}
        raise ValueError(f"{path}.{key.name}: unknown type \"{kind}\"; add it to Drawer.value")

    def word_of(self, path, key):
        """Draw a text: a file, a name in this scenario, or arbitrary characters."""
        r, stem = self.random, path.split(".")[0]
        if f"{stem}.{key.name}" in self.files:
            return r.choice(self.files[f"{stem}.{key.name}"])
        name = key.name.split(".")[-1]
        if name in ("region", "initial_region", "from", "neighbours_of", "union", "intersect", "except"):
            return r.choice(["all", *self.names["region"]])
        if self.names.get(name):
            return r.choice(self.names[name])
        if name == "reaction" and r.random() < 0.9:
            return r.choice(["k * s0 * (1 - s0)", "k * (apical_area_ratio - 1)", "0.1 - s0^2", "1 / s0", "height_ratio * k - s1"])
        return "".join(r.choice("ab \"\\\n\tµ✓'#=[]{}") for _ in range(r.randint(1, 12)))

    def integer(self, key):
        r = self.random
        most = {"cells": 5, "elements_per_cell": r.choice((1, 1, 1, 3))}.get(key.name, 6 if key.low >= 1 else 40)
        if key.name not in ("cells", "elements_per_cell") and r.random() < 0.05:
            most = 10**9
        low = max(key.low, 0)
        return int(r.uniform(low, min(key.high, max(most, low)) + 0.999)) if low < key.high else int(low)

    def number(self, key):
        r = self.random
        extreme = r.random() < 0.04
        if extreme and math.isfinite(key.low + key.high):
            span = key.high - key.low
            return r.choice((key.low, key.high, key.low + 1e-4 * span, key.high - 1e-4 * span))
        if math.isfinite(key.low + key.high):
            return r.uniform(key.low, key.high) if key.low <= 0 else key.low * (key.high / key.low) ** r.random()
        try:
            typical = abs(float(key.default))
        except ValueError:
            typical = 0
        if extreme and r.random() < 0.3:
            return r.choice((0, 1e-300, 1e-12, 1e12, 1e300, 5e-324, 1.7e308, -1e300))
        if not typical:
            for unit, size in (("_nN_per_um", 2), ("_nN", 10), ("_Pa", 100), ("_s", 10), ("_um", 30), ("_um2", 500), ("_um3", 2e4),
                               ("_ratio", 0.5), ("_per_s", 10), ("min", 0.2)):
                typical = size if key.name.endswith(unit) else typical
            typical = typical or 1
        value = typical * 10 ** (r.uniform(-6, 6) if extreme else r.gauss(0, 0.3))
        if r.random() < 0.05 and key.low <= 0:
            value = 0 if key.low == 0 and r.random() < 0.5 else value
        return -value if key.low < 0 and r.random() < 0.3 else value

    def make_small(self):
        """Limit the work: few cells and elements, a short time."""
        r, draft = self.random, self.draft
        if draft.get("base") or draft.get("embryo.shape") != "file":
            cells = draft.get("embryo.cells") or [r.randint(1, 5) for _ in range(3)]
            per_cell = draft.get("embryo.elements_per_cell", [1, 1, 1])
            a, b, c = cells
            count = a * b * c if draft.get("embryo.shape") == "block" else 2 * (a * b + b * c + c * a)
            if count * math.prod(per_cell) > MOST_ELEMENTS:
                draft.drop("embryo.elements_per_cell")
            draft.put("embryo", "cells", cells)
            if "embryo.mirror" in draft.values and r.random() < 0.7:
                draft.drop("embryo.mirror")  # usually, since random scenarios are rarely symmetric
            elif "embryo.mirror" in draft.values:
                draft.put("embryo", "cells", [2 * max(1, n // 2) for n in cells])
        # At most MOST_STEPS of the longest step; adaptive steps may be shorter.
        step = draft.get("time.step_s", "adaptive")
        longest = step if isinstance(step, float) else min(draft.get("time.max_step_s", 30.0), 30.0)
        end = draft.get("time.end_s", 60 * draft.get("time.end_min", 0)) or 10 ** r.uniform(-1, 2)
        draft.drop("time.end_min")
        draft.put("time", "end_s", min(end, MOST_STEPS * max(longest, 1e-3)))
        if isinstance(step, float):
            draft.put("time", "step_s", max(step, draft.get("time.end_s") / MOST_STEPS))
        for key, least in (("time.tolerance_um", 1e-3), ("time.max_step_s", draft.get("time.end_s") / MOST_STEPS)):
            if draft.get(key) is not None:
                draft.put("time", key.split(".")[1], max(draft.get(key), least))
        # An adaptive step is at most a twelfth of a pulse period.
        for key, unit_s in (("pulse.period_s", 1), ("pulse.period_min", 60)):
            for address in [a for a in draft.values if a.endswith("." + key) and draft.get(a) != "none"]:
                table, _, value = draft.values[address]
                draft.put(table, key, max(value, 12 * draft.get("time.end_s") / (4 * MOST_STEPS) / unit_s))
        for address in [a for a in draft.values if a.startswith("division.") and a.endswith(".region")]:
            table = address.removesuffix(".region")
            draft.put(table, "max_generation", min(draft.get(f"{table}.max_generation", 1), 2))


# Extreme inputs of the reliability page, applied to a drawn scenario.


def contract_ten_times_too_strongly(draft, _):
    for address in list(draft.values):
        if address.endswith(".stiffness_nN_per_um"):
            draft.put(*address.rsplit(".", 1), 10 * draft.get(address))


def be_incompressible(draft, _):
    draft.put("elasticity", "poisson_ratio", 0.4999)


def flatten_fifty_to_one(draft, _):
    cells, width = draft.get("embryo.cells", [3, 3, 3]), 280.0
    height = width / max(cells) / 50
    if draft.get("embryo.shape") == "block":
        draft.put("embryo", "length_um", width)
        draft.put("embryo", "width_um", width)
        height *= cells[2]
    draft.put("embryo", "cell_height_um", height)


def step_an_hour(draft, r):
    draft.put("time", "step_s" if r.random() < 0.5 else "max_step_s", 3600.0)
    draft.put("time", "end_s", 36000.0)


def fill_the_shell(draft, r):
    """Press the embryo against the vitelline membrane, and let it grow."""
    if draft.get("embryo.shape") == "block":
        return
    draft.put("vitelline", "enabled", True)
    draft.put("pressure.out", "region", "all")
    draft.put("pressure.out", "face", "basal")
    draft.put("pressure.out", "pressure_Pa", 10 ** r.uniform(2, 6))
    if r.random() < 0.5:
        for key, value in (("region", "all"), ("at_s", 1.0), ("growth_s", 5.0), ("daughter_volume_ratio", 2.0)):
            draft.put("division.full", key, value)


EXTREMES = (contract_ten_times_too_strongly, be_incompressible, flatten_fifty_to_one, step_an_hour, fill_the_shell)
