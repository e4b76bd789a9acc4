"""Exceptions. Messages name the file, line and key, the problem and the fix."""
from __future__ import annotations

import importlib
from typing import Any, NamedTuple, Optional, Sequence


class Diagnostic(NamedTuple):
    """One error in a scenario.

    Attributes
    ----------
    file : str
        Scenario file or built-in name; empty for a key set from Python.
    line : int
        Line in that file, from 1; 0 if unknown.
    key : str
        Dotted key, or empty.
    problem, remedy : str
        Problem, and how to fix it.
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
    """Base class of all exceptions of plica."""


class ScenarioError(PlicaError, ValueError):
    """Invalid scenario. All errors are reported at once.

    Attributes
    ----------
    diagnostics : tuple of Diagnostic
        The errors, one by one.
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
    """Solver failure. The simulation stays at its last accepted state, which can be inspected and saved.

    Attributes
    ----------
    reason : str
        Cause, cell, time, and suggested remedy.
    cell : int or None
        Id of the cell where it failed, if known.
    time_s : float
        Time of the last accepted state, s.
    """

    def __init__(self, reason: str, cell: Optional[int] = None, time_s: float = float("nan")) -> None:
        self.reason, self.cell, self.time_s = reason, cell, time_s
        super().__init__(reason)

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.reason, self.cell, self.time_s)


class FileError(PlicaError, OSError):
    """File that cannot be read or written, or has unexpected content."""


class MissingExtra(PlicaError, ImportError):
    """Missing optional package; the message names the command that installs it."""

    def __init__(self, what: str, package: str, extra: str) -> None:
        super().__init__(f"{what} needs {package}, which is not installed; pip install {package}, or all of its kind: "
                         f"pip install 'plica[{extra}]'")
        self.what, self.package, self.extra = what, package, extra

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), (self.what, self.package, self.extra)


# Modules: the package that has them, and the extra of pyproject.toml that includes it.
PACKAGES = {"pandas": ("pandas", "plot"), "matplotlib": ("matplotlib", "plot"), "pyvista": ("pyvista", "plot"),
            "meshio": ("meshio", "plot"), "IPython": ("ipython", "notebook"), "xarray": ("xarray", "study"),
            "SALib": ("SALib", "study"), "sklearn": ("scikit-learn", "study"), "threadpoolctl": ("threadpoolctl", "study"),
            "skimage": ("scikit-image", "image"), "scipy": ("scipy", "image"), "imageio": ("imageio", "movie"),
            "imageio_ffmpeg": ("imageio-ffmpeg", "movie"), "tables": ("tables", "tyssue"), "tifffile": ("tifffile", "image"),
            "zarr": ("zarr", "image"), "starlette": ("starlette", "studio"), "uvicorn": ("uvicorn", "studio"),
            "websockets": ("websockets", "studio"), "jax": ("jax", "jax"), "torch": ("torch", "torch"),
            "sympy": ("sympy", "formula")}


def needed(module: str, what: str) -> Any:
    """Import a module of an optional package. MissingExtra if it is not installed, PlicaError if its import fails."""
    root = module.split(".")[0]
    package, extra = PACKAGES[root]
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if str(error.name).split(".")[0] == root:
            raise MissingExtra(what, package, extra) from None
        raise PlicaError(f"{what} needs {package}, whose import fails: {error}") from error
    except ImportError as error:
        raise PlicaError(f"{what} needs {package}, whose import fails: {error}") from error
