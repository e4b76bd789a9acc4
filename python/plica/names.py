"""Names for readers: columns and keys in words with their units; short tables."""
from __future__ import annotations

UNITS = {"um": "µm", "um2": "µm²", "um3": "µm³", "m": "m", "m3": "m³", "s": "s", "min": "min", "nN": "nN", "mN": "mN", "Pa": "Pa",
         "kPa": "kPa", "deg": "°", "kg": "kg", "MB": "MB", "percent": "%"}


def name_and_unit(name: str) -> tuple[str, str]:
    """Split a column or key into name and unit: stiffness_nN_per_um becomes stiffness and nN/µm."""
    words = name.split("_")
    for first in range(1, len(words)):
        end = words[first:]
        if end[0] != "per" and end[-1] != "per" and all(word in UNITS or word == "per" for word in end):
            unit = " ".join(UNITS.get(word, "/") for word in end).replace(" / ", "/")
            return "_".join(words[:first]), unit
    return name, ""


def label(name: str, with_unit: bool = True) -> str:
    """Return a name in words, with its unit; keys stay as in a scenario."""
    text, unit = name_and_unit(name)
    if "." not in text:
        text = text.replace("_", " ")
    return f"{text} ({unit})" if unit and with_unit else text


def in_columns(rows: list[tuple[str, ...]], heads: tuple[str, ...]) -> list[str]:
    """Return rows as aligned lines below their heads; nothing without rows."""
    table = [heads, *rows] if rows else []
    widths = [max(map(len, column)) for column in zip(*table)]
    return ["  ".join([row[0].ljust(widths[0]), *(text.rjust(width) for text, width in zip(row[1:], widths[1:]))]) for row in table]
