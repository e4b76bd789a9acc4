"""The input table as `plica reference` prints it: every table and key with its type, default and what is allowed.

A key that is added to src/scenario/schema.cpp appears here by itself.
"""
import re
import subprocess
from dataclasses import dataclass


@dataclass
class Key:
    name: str
    kind: str  # "number", "3 integers", "list of words", ...
    default: str  # in TOML, or ""
    low: float  # bounds of a number, or of each of a list
    high: float
    words: tuple  # of which a word, or each of a list, is one
    word_for_none: str  # how a number says that it has none
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


def read_table(program):
    """The tables in their order, and the names that [expect] knows."""
    text = subprocess.run([program, "reference"], check=True, capture_output=True, text=True).stdout
    tables = []
    for line in text.splitlines():
        if line.startswith("## "):
            tables.append(Table("" if line == "## Top level" else line.strip("# `[]"), []))
        elif line.startswith("| `"):
            cells = [cell.strip().replace(r"\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            tables[-1].keys.append(_key(cells))
    expected = re.findall(r"`(\w+)`", text[text.rindex("`[expect]` knows:") + len("`[expect]` knows:"):])
    return tables, expected
