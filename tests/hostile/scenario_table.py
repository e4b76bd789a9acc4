"""Reader of the key table printed by `plica reference`: every table and key with type, default and allowed values.

Keys added to src/scenario/tables/ appear here automatically.
"""
import re
import subprocess
from dataclasses import dataclass, replace


@dataclass
class Key:
    name: str
    kind: str  # "number", "3 integers", "list of words", ...
    default: str  # in TOML, or ""
    low: float  # bounds of a number, or of each number of a list
    high: float
    words: tuple  # allowed words, also for each item of a list
    word_for_none: str  # word for a number without a value
    shapes: tuple  # embryo shapes that use it; empty: all
    instead_of: str
    required: bool


@dataclass
class Table:
    path: str  # "embryo", "region.NAME", "" at the top
    keys: list

    @property
    def named(self):
        return self.path.endswith(".NAME")

    @property
    def stem(self):
        return self.path.removesuffix(".NAME")


def _key(cells):
    name, kind, default, allowed, _ = cells
    parts = allowed.split("; ")
    low, high, words, none, shapes, instead = float("-inf"), float("inf"), (), "", (), ""
    for part in parts:
        if part.startswith(("with shape ")):
            shapes = tuple(part.removeprefix("with shape ").split(", "))
        elif part.startswith("not with "):
            instead = part.removeprefix("not with ").strip("`")
        elif kind in ("word", "list of words") and part != "any":
            words = tuple(part.replace("\\|", "|").split(" | "))
        elif part != "any":
            if match := re.search(r' or "(\w+)"$', part):
                none, part = match[1], part[: match.start()]
            number = r"(-?[\d.e+-]+)"
            if match := re.fullmatch(rf"{number} to {number}", part):
                low, high = float(match[1]), float(match[2])
            elif re.fullmatch(number, part):
                low = high = float(part)
            for sign, bound in re.findall(rf"([<>])=? {number}", part):
                low, high = (float(bound), high) if sign == ">" else (low, float(bound))
    known = default not in ("none", "required") and not default.startswith("see ")
    return Key(name.strip("`"), kind, default.strip("`") if known else "", low, high, words, none, shapes, instead,
               default == "required")


def _slug(heading):
    """The anchor of a heading."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def _inner_keys(names, keys):
    """Keys of the inner tables `names`, from the section that lists them. It lists tables with the same keys once."""
    listed = {key.name.split(".")[0] for key in keys}
    first = keys[0].name.split(".")[0]
    for name in names:
        source = name if name in listed else first
        for key in keys:
            if key.name.startswith(f"{source}."):
                yield replace(key, name=key.name.replace(source, name, 1), instead_of=key.instead_of.replace(source, name, 1))


def read_table(program):
    """Tables in order, with the keys of their inner tables, and names that [expect] accepts."""
    text = subprocess.run([program, "reference"], check=True, capture_output=True, text=True).stdout
    tables, sections, inner = [], {}, []
    for line in text.splitlines():
        if line.startswith("## "):
            heading = line.removeprefix("## ")
            keys = sections[_slug(heading)] = []
            if heading == "Top level" or heading.startswith("`["):
                tables.append(Table("" if heading == "Top level" else heading.strip("`[]"), keys))
        elif line.startswith("Inner tables: "):
            inner.append((tables[-1], line))
        elif line.startswith("| `"):
            cells = [cell.strip().replace(r"\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            keys.append(_key(cells))
    for table, line in inner:
        for names, slug in re.findall(r"((?:`\w+`(?:, )?)+) \(\[[^\]]*\]\(#([\w-]+)\)\)", line):
            table.keys.extend(_inner_keys(re.findall(r"`(\w+)`", names), sections[slug]))
    expected = re.search(r"^`\[expect\]` accepts: (.*)$", text, re.MULTILINE)[1]
    return tables, re.findall(r"`(\w+)`", expected)
