"""What can go wrong. Messages say what is wrong, where, and what would be right."""
from __future__ import annotations

import importlib
from typing import Any, NamedTuple, Optional, Sequence


class Diagnostic(NamedTuple):
    """One thing that is wrong in a scenario.

    Attributes
    ----------
    file : str
        The scenario's file or built-in name; empty for a key that was set from Python.
    line : int
        Line in that file, from 1; 0 where there is none.
    key : str
        The dotted key, or empty.
    problem, remedy : str
        What is wrong, and what would be right.
    """

    file: str
    line: int
    key: str
    problem: str
    remedy: str

    def __str__(self) -> str:
        place = self.file + (f":{self.line}" if self.line else "")
        parts = [part for part in (place, self.key, self.problem) if part]
        return ": ".join(parts) + (f"; {self.remedy}" if self.remedy else "")


class PlicaError(Exception):
    """Whatever plica finds wrong: the base of its other exceptions."""


class ScenarioError(PlicaError, ValueError):
    """A scenario breaks rules. All that is wrong is told at once.

    Attributes
    ----------
    diagnostics : tuple of Diagnostic
        What is wrong, one by one.
    """

    def __init__(self, diagnostics: Sequence[tuple[str, int, str, str, str]] = ()) -> None:
        self.diagnostics = tuple(
            Diagnostic("" if file == "--set" else file, line, key, problem, remedy)
            for file, line, key, problem, remedy in diagnostics
        )
        super().__init__("\n".join(map(str, self.diagnostics)))

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.diagnostics,)


class NumericsError(PlicaError, ArithmeticError):
    """A simulation gave up. The simulation is at its last good state, which can be looked at and saved.

    Attributes
    ----------
    reason : str
        What gave up, where, when, and what may help.
    cell : int or None
        The id of the cell that it happened in, where it was one.
    time_s : float
        The time of the last good state, s.
    """

    def __init__(self, reason: str, cell: Optional[int] = None, time_s: float = float("nan")) -> None:
        self.reason, self.cell, self.time_s = reason, cell, time_s
        super().__init__(reason)

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.reason, self.cell, self.time_s)


class FileError(PlicaError, OSError):
    """A file cannot be read or written, or is not what it should be."""


class MissingExtra(PlicaError, ImportError):
    """Something needs a package that plica itself does not."""

    def __init__(self, what: str, package: str, extra: str) -> None:
        super().__init__(f"{what} needs {package}, which is not installed; to have it, where plica was checked out: pip install '.[{extra}]'")
        self.what, self.package, self.extra = what, package, extra

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.what, self.package, self.extra)


EXTRAS = {"pandas": "plot", "matplotlib": "plot", "pyvista": "plot", "meshio": "plot", "IPython": "notebook",
          "xarray": "study", "SALib": "study", "sklearn": "study", "threadpoolctl": "study",
          "skimage": "image", "scipy": "image"}


def needed(package: str, what: str) -> Any:
    """A package that only this needs, imported now."""
    try:
        return importlib.import_module(package)
    except ImportError:
        name = package.split(".")[0]
        raise MissingExtra(what, name, EXTRAS[name]) from None
