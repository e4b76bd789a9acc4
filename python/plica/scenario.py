"""Scenarios: parameters of a simulation that can be read and changed."""
from __future__ import annotations

import difflib
import html
import math
import os
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import flags, mapping_of, path_of, per_cell, text_of, told
from .errors import ScenarioError
from .tissue import Tissue

__all__ = ["Scenario", "builtin_scenarios"]

GIVEN = "<Python>"  # in messages, the file name of a scenario made of text or a dict


def builtin_scenarios() -> dict[str, str]:
    """Return the names and titles of the built-in scenarios.

    Returns
    -------
    dict of str to str
        Titles by name.

    Examples
    --------
    >>> import plica
    >>> "drosophila" in plica.builtin_scenarios()
    True
    """
    return {name: str(tomllib.loads(text).get("title", "")) for name, text in _core.scenarios.items()}


class Scenario:
    """Complete, valid description of a simulation; invalid changes are rejected.

    Parameters
    ----------
    source : str, path or mapping
        Name of a built-in scenario, TOML file, TOML text (several lines, or containing "="), or nested dict.
    tissue : Tissue, optional
        Cells to use instead of an embryo built by plica.
    arrays : mapping of str to array_like of float, shape (cells,), optional
        Arrays of the cells, as for `set_array`.

    Raises
    ------
    ScenarioError
        If the scenario is invalid; lists every error with its key and fix.
    FileError
        If the file cannot be read.
    ValueError
        If `source` is neither a built-in scenario nor a file, or an array has the wrong shape.

    Examples
    --------
    >>> import plica
    >>> s = plica.Scenario("drosophila")
    >>> s["contraction.apical.stiffness_nN_per_um"] = 5
    >>> s["contraction.apical.stiffness_nN_per_um"]
    5
    >>> s.diff(plica.Scenario("drosophila"))["contraction.apical.stiffness_nN_per_um"]
    (5, 4.82)
    """

    def __init__(
        self,
        source: Union[str, os.PathLike[str], Mapping[str, Any]],
        *,
        tissue: Optional[Tissue] = None,
        arrays: Optional[Mapping[str, ArrayLike]] = None,
    ) -> None:
        if tissue is not None and not isinstance(tissue, Tissue):
            raise TypeError(f"tissue: {told(tissue)}; give a Tissue")
        self._source: tuple[str, str, str]  # name, file, text
        if isinstance(source, Mapping):
            self._source = ("scenario", GIVEN, _toml_of(source))
        elif isinstance(source, str) and ("\n" in source or "=" in source):
            self._source = ("scenario", GIVEN, text_of(source, "source"))
        else:
            self._source = _core.find(path_of(source, "source"))
        self._changes: dict[str, str] = {}
        self._regions: dict[str, NDArray[np.bool_]] = {}
        self._arrays: dict[str, NDArray[np.float64]] = {}
        self._cells: tuple[object, int] = (None, 0)  # the embryo and its number of cells
        self._tissue = tissue
        if tissue is not None:
            self._changes = {"embryo.shape": f'"{tissue.shape}"', "embryo.file": f'"{GIVEN}"'}
        self._load()
        for name, values in mapping_of({} if arrays is None else arrays, "arrays", "a mapping of names to arrays").items():
            self.set_array(name, values)

    # The only place where a scenario is checked. On failure, self is unchanged.
    def _load(
        self,
        changes: Optional[dict[str, str]] = None,
        regions: Optional[dict[str, NDArray[np.bool_]]] = None,
        arrays: Optional[dict[str, NDArray[np.float64]]] = None,
    ) -> None:
        changes = self._changes if changes is None else changes
        regions = self._regions if regions is None else regions
        arrays = self._arrays if arrays is None else arrays
        core = _core.load(
            *self._source,
            [f"{key}={value}" for key, value in changes.items()],
            {name: np.flatnonzero(mask).tolist() for name, mask in regions.items()},
            {name: values.tolist() for name, values in arrays.items()},
            None if self._tissue is None else self._tissue._mesh,
            None if self._tissue is None else self._tissue._prisms,
        )
        self._core, self._changes, self._regions, self._arrays = core, changes, regions, arrays
        self._resolved: Optional[dict[str, Any]] = None

    @property
    def name(self) -> str:
        """Name of the built-in scenario, or of the file without extension."""
        return self._source[0]

    @property
    def title(self) -> str:
        """Title given in the scenario."""
        return self._core.title

    @property
    def tissue(self) -> Optional[Tissue]:
        """Tissue given from Python; None if plica builds the embryo or reads it from a file."""
        return self._tissue

    def to_toml(self) -> str:
        """Return the complete scenario, including defaults, as TOML text.

        Returns
        -------
        str
            Text as in ``scenario.toml`` of a run; it loads to an equal scenario.
        """
        return self._core.toml()

    def to_dict(self) -> dict[str, Any]:
        """Return the complete scenario, including defaults, as nested dicts."""
        return tomllib.loads(self.to_toml())

    def __getitem__(self, key: str) -> Any:
        if self._resolved is None:
            self._resolved = self.to_dict()
        value: Any = self._resolved
        if not isinstance(key, str):
            raise KeyError(f"{told(key)}: keys are texts, such as \"time.end_s\"")
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                near = difflib.get_close_matches(key, list(dict(_items(self._resolved))), 3)
                hint = f"; nearest matches: {', '.join(near)}" if near else ""
                raise KeyError(f"{key}: has no value in this scenario{hint}")
            value = value[part]
        return value

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __contains__(self, key: object) -> bool:
        return isinstance(key, str) and key in set(self.keys())

    def keys(self) -> Iterator[str]:
        """Iterate over all dotted keys that have a value."""
        return (key for key, _ in _items(self.to_dict()))

    def update(self, changes: Mapping[str, Any]) -> None:
        """Change several keys at once, for changes that are valid only together.

        Parameters
        ----------
        changes : mapping of str to value
            Dotted keys, as in ``plica run --set``, with numbers, strings, lists, dicts or booleans.

        Raises
        ------
        ScenarioError
            If the result is invalid. The scenario is then unchanged.

        Examples
        --------
        >>> import plica
        >>> s = plica.Scenario("drosophila")
        >>> s.update({"elasticity.model": "neo-hookean", "elasticity.relaxation_s": 300})
        """
        merged = dict(self._changes)
        for key, value in mapping_of(changes, "changes", "a mapping of dotted keys to values").items():
            merged.pop(key, None)  # the last change comes last
            merged[key] = _toml_value(value, key)
        self._load(changes=merged)

    def set_region(self, name: str, cells: ArrayLike) -> None:
        """Define a region by a boolean array, replacing any definition in the scenario.

        Parameters
        ----------
        name : str
            Name of a new or existing region.
        cells : array_like of bool, shape (cells,)
            True for cells of the region, in the order of ``Simulation.cell_data``.

        Raises
        ------
        ValueError
            If `cells` is not boolean, has not one value per cell, or selects no cell.
        ScenarioError
            If the embryo cannot be built.

        Examples
        --------
        >>> import plica
        >>> s = plica.Scenario("drosophila")
        >>> x = plica.Simulation(s).cell_data["x_um"]
        >>> s.set_region("front", x < 0)
        """
        mask = flags(cells, self._cell_count(), f"region {text_of(name, 'name')}")
        if not mask.any():
            raise ValueError(f"region {name}: selects no cell; set at least one to True")
        changes = self._changes
        if name not in self.to_dict().get("region", {}):
            # Declares the name for other keys; the array defines the cells.
            changes = {f"region.{name}.ids": f"[{int(np.argmax(mask))}]", **changes}
        self._load(changes=changes, regions={**self._regions, name: mask})

    def set_array(self, name: str, values: ArrayLike) -> None:
        """Give the cells an array, for profiles (``shape = "array"``) and regions (``array = "NAME"``).

        To give one from a file, also in studies and on the command line, write a table with a column per array and set
        ``embryo.cell_arrays``.

        Parameters
        ----------
        name : str
            Name of the array; an array of this name from a file is replaced.
        values : array_like of float, shape (cells,)
            One number per cell, in the order of ``Simulation.cell_data``; NaN or masked where there is none.

        Raises
        ------
        ValueError
            If there is not one number per cell, or one is infinite.
        ScenarioError
            If the embryo cannot be built.

        Examples
        --------
        >>> import numpy as np, plica
        >>> s = plica.Scenario("drosophila")
        >>> x = plica.Simulation(s).cell_data["x_um"]
        >>> s.set_array("myosin", np.exp(-((x / 100) ** 2)))
        >>> s["contraction.apical.profile"] = {"shape": "array", "array": "myosin", "from": 0, "to": 1}
        """
        array = per_cell(values, self._cell_count(), f"array {text_of(name, 'name')}")
        if not name or any(letter < " " for letter in name):
            raise ValueError(f"name: {told(name)}; give a name without control characters")
        if np.isinf(array).any():
            cell = int(np.argmax(np.isinf(array)))
            raise ValueError(f"array {name}: the value of cell {cell} is {array[cell]}; give a finite number, or NaN for none")
        self._load(arrays={**self._arrays, name: array})

    def _cell_count(self) -> int:
        embryo = self.to_dict()["embryo"]
        if self._cells[0] != embryo:
            self._cells = (embryo, self._ready.cell_count)
        return self._cells[1]

    @property
    def _ready(self) -> _core.Scenario:
        """Core scenario for a simulation; without VTK, includes cells read by meshio."""
        embryo = self.to_dict()["embryo"]
        if embryo["shape"] == "file" and not self._core.has_mesh and not _core.reads_meshes:
            self._core.give_mesh(Tissue.from_file(embryo["file"], apical_array=embryo.get("apical_array", ""))._mesh)
        return self._core

    def _require_file(self, what: str) -> None:
        if self._tissue is not None or self._regions or self._arrays:
            raise ValueError(f"{what} requires a scenario that a file can express: no tissue, regions or arrays given from Python "
                             "(a file of arrays: embryo.cell_arrays)")

    def _check_masks(self, cells: int) -> None:
        for name, mask in self._regions.items():
            if len(mask) != cells:
                problem = f"is an array for {len(mask)} cells; the tissue has {cells}"
                raise ScenarioError([("", 0, f"region.{name}", problem, "give one boolean per cell")])

    def copy(self) -> Scenario:
        """Return an independent copy."""
        other = object.__new__(Scenario)
        other.__setstate__(self.__getstate__())
        return other

    def diff(self, other: Scenario) -> dict[str, tuple[Any, Any]]:
        """Return the keys in which two scenarios differ.

        Parameters
        ----------
        other : Scenario

        Returns
        -------
        dict of str to (value, value)
            Value in this scenario and in `other`; None where a scenario has none. Expected results of built-in scenarios
            (``[expect]``) are not compared.
        """
        if not isinstance(other, Scenario):
            raise TypeError(f"other: {told(other)}; give a Scenario")
        mine, others = (dict(_items(scenario.to_dict())) for scenario in (self, other))
        keys = [key for key in {**mine, **others} if not key.startswith("expect.")]
        return {key: (mine.get(key), others.get(key)) for key in keys if mine.get(key) != others.get(key)}

    def advice(self) -> list[str]:
        """Return advice before a run, as lines that begin with "warning: " or "note: "."""
        return self._ready.advice()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        mine, others = self._arrays, other._arrays
        same_arrays = mine.keys() == others.keys() and all(np.array_equal(mine[k], others[k], equal_nan=True) for k in mine)
        return self.to_dict() == other.to_dict() and self._tissue is other._tissue and same_arrays

    __hash__ = None  # type: ignore[assignment]

    def __getstate__(self) -> dict[str, Any]:
        return {"source": self._source, "changes": self._changes, "regions": self._regions, "arrays": self._arrays,
                "tissue": self._tissue}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._source, self._tissue, self._cells = state["source"], state["tissue"], (None, 0)
        self._load(dict(state["changes"]), dict(state["regions"]), dict(state["arrays"]))

    def __repr__(self) -> str:
        of_arrays = {f"region.{name}.ids" for name in self._regions}
        shown = {key: value for key, value in self._changes.items() if key not in of_arrays and value != f'"{GIVEN}"'}
        changed = [f"{key} = {value}" for key, value in shown.items()]
        changed += [f"region.{name} of {mask.sum()} cells" for name, mask in self._regions.items()]
        changed += [f"array {name}" for name in self._arrays]
        return f"Scenario({self.name!r}{', with ' if changed else ''}{', '.join(changed)})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td style='text-align:left'>{html.escape(key)}</td>"
            f"<td style='text-align:left'>{html.escape(str(value))}</td></tr>"
            for key, value in _items(self.to_dict())
        )
        return (
            f"<b>{html.escape(self.name)}</b>: {html.escape(self.title)}"
            f"<details><summary>{html.escape(repr(self))}</summary><table>{rows}</table></details>"
        )


def _items(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _items(value, f"{before}{key}.")
        else:
            yield before + key, value


def _toml_value(value: Any, key: str) -> str:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return repr(number) if math.isfinite(number) else str(number)  # nan and inf are valid TOML, and rejected by the check
    if isinstance(value, (str, Path)):
        return _toml_text(text_of(str(value), key))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_toml_key(k)} = {_toml_value(v, f'{key}.{k}')}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0):
        return "[" + ", ".join(_toml_value(item, key) for item in value) + "]"
    raise TypeError(f"{key}: {told(value)}; give a number, text, boolean, list or dict")


def _toml_text(text: str) -> str:
    escaped = "".join(
        {'"': '\\"', "\\": "\\\\"}.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04X}") for c in text
    )
    return f'"{escaped}"'


def _toml_key(key: Any) -> str:
    text = str(key)
    return text if text and all(c.isascii() and (c.isalnum() or c in "-_") for c in text) else _toml_text(text)


def _toml_of(table: Mapping[str, Any]) -> str:
    return "".join(f"{_toml_key(key)} = {_toml_value(value, str(key))}\n" for key, value in table.items())
