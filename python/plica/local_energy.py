"""Force laws from an energy of a few nodes, given by a formula or by a function; forces follow by differentiation."""
from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import mapping_of
from .errors import needed

__all__ = ["LocalEnergy"]

Array = NDArray[np.float64]
Derivative = Callable[..., Array]  # of coordinates (groups, 3 nodes) and numbers


class LocalEnergy:
    """Energy of groups of nodes, which acts in a simulation as a force law.

    Parameters
    ----------
    energy : str or callable
        Energy of one group, nN µm. A formula in coordinates of its nodes, ``x0``, ``y0``, ``z0``, ``x1``, … (µm), in
        ``length(0, 1)``, ``area(0, 1, 2)`` and ``volume(0, 1, 2, 3)`` of its nodes, in functions such as ``sqrt`` and ``exp``, and in
        `numbers`; requires SymPy. Or a function of positions, shape (nodes, 3), and of `numbers` by keyword, written with
        ``jax.numpy``; requires JAX. It must be twice differentiable wherever the nodes go.
    groups : array_like of int, shape (groups, nodes)
        Nodes of each group: row numbers of `Simulation.positions`, as in `Simulation.hexahedra`.
    **numbers : float or array_like of float, shape (groups,)
        Values of the other names, for all groups or for each.

    Raises
    ------
    ValueError
        If the formula cannot be read, or a name has no value.
    MissingExtra
        If SymPy, or JAX, is not installed.

    Notes
    -----
    Derivatives are exact, so runs take few Newton iterations. The law stores its energy; results are in `Simulation.energies` and
    `Simulation.forces` under ``energy.NAME``. With the law given to `record` as well, `Tape.gradient` gives derivatives by
    ``energy.NAME.NUMBER``. The scenario may not change the nodes (division, exchange, extrusion), nor have mirror planes. Checkpoints
    do not hold the law: give it again to `load`.

    Examples
    --------
    Springs that shorten the cells of a sheet to three quarters of their height:

    >>> import plica
    >>> sheet = {"embryo": {"shape": "block", "length_um": 40, "width_um": 40, "cell_height_um": 20, "cells": [4, 4, 1]}}
    >>> along_height = plica.Simulation(sheet).hexahedra[:, [0, 4]]
    >>> springs = plica.LocalEnergy("k / 2 * (length(0, 1) - L) ** 2", along_height, k=2, L=15)
    >>> sim = plica.Simulation(sheet, energies={"springs": springs})
    >>> sim.run(until_min=1)
    >>> bool(sim.cell_data["height_um"].mean() < 20)
    True
    """

    def __init__(self, energy: Union[str, Callable[..., Any]], groups: ArrayLike, **numbers: ArrayLike) -> None:
        nodes = np.asarray(groups)
        if nodes.ndim != 2 or nodes.size == 0 or nodes.dtype.kind not in "iu":
            raise ValueError(f"groups: shape {nodes.shape} of {nodes.dtype}; give node numbers, shape (groups, nodes)")
        self.groups = np.ascontiguousarray(nodes, np.int32)
        self.energy, self.numbers = energy, {}
        for name, value in numbers.items():
            array = np.asarray(value, np.float64)
            if array.shape not in ((), (len(nodes),)) or not np.isfinite(array).all():
                raise ValueError(f"{name}: shape {array.shape}; give one number, or one for each of the {len(nodes)} groups, all finite")
            self.numbers[name] = np.broadcast_to(array, (len(nodes),))
        names, size = sorted(self.numbers), self.groups.shape[1]
        self._derivatives = _of_formula(energy, size, names) if isinstance(energy, str) else _of_function(energy, size, names)

    def __getstate__(self) -> dict[str, Any]:
        return {"energy": self.energy, "groups": self.groups, "numbers": self.numbers}

    def __setstate__(self, state: dict[str, Any]) -> None:
        LocalEnergy.__init__(self, state["energy"], state["groups"], **state["numbers"])

    def _value(self, number: str) -> float:
        """Return a number; if it differs between groups, 1: a factor on all."""
        values = self.numbers[number]
        return float(values[0]) if (values == values[0]).all() else 1.0

    def _scaled(self, number: str, factor: float) -> LocalEnergy:
        """Return a copy with a number multiplied by a factor."""
        scaled = object.__new__(type(self))
        scaled.__dict__ = {**self.__dict__, "numbers": {**self.numbers, number: self.numbers[number] * factor}}
        return scaled

    def __call__(self, positions: Array, order: int) -> Array:
        """Return energies, gradients or Hessians of the groups, by order; positions: shape (groups, 3 nodes), µm."""
        with np.errstate(all="ignore"):
            values = self._derivatives[order](positions, *(self.numbers[name] for name in sorted(self.numbers)))
        result = np.ascontiguousarray(values, np.float64)
        wrong = ~np.isfinite(result.reshape(len(result), -1)).all(axis=1)
        if wrong.any():
            group = int(np.argmax(wrong))
            what = ("energy", "gradient", "Hessian")[order]
            raise ValueError(f"LocalEnergy: the {what} of group {group} (nodes {self.groups[group].tolist()}) is not finite; "
                             "give an energy that is twice differentiable there")
        return result


LocalLaw = tuple[str, NDArray[np.int32], LocalEnergy]  # name, groups, energy


def laws_of(energies: Optional[Mapping[str, LocalEnergy]]) -> list[LocalLaw]:
    given = mapping_of({} if energies is None else energies, "energies", "a mapping of names to LocalEnergy")
    for name, energy in given.items():
        if not isinstance(energy, LocalEnergy):
            raise ValueError(f"energies: {name}: {type(energy).__name__}; give a LocalEnergy")
    return [(name, energy.groups, energy) for name, energy in given.items()]


def number_of(energies: Mapping[str, LocalEnergy], key: str) -> Optional[tuple[str, str]]:
    """Return the names of an energy and of one of its numbers, of ``energy.NAME.NUMBER``; none for another key."""
    start, _, rest = key.partition(".")
    name, _, number = rest.rpartition(".")
    if start != "energy":
        return None
    if name not in energies or number not in energies[name].numbers:
        known = [f"energy.{one}.{of_it}" for one, energy in energies.items() for of_it in energy.numbers]
        raise ValueError(f"{key}: not a number of an energy; give {'one of ' + ', '.join(known) if known else 'its law as energies to record'}")
    return name, number


def _of_formula(formula: str, nodes: int, names: list[str]) -> tuple[Derivative, ...]:
    """Return energy, gradient and Hessian of a formula, by SymPy."""
    sympy = needed("sympy", "LocalEnergy of a formula")
    coordinates = [sympy.Symbol(f"{axis}{node}", real=True) for node in range(nodes) for axis in "xyz"]
    places = [sympy.Matrix(coordinates[3 * node : 3 * node + 3]) for node in range(nodes)]
    symbols = [sympy.Symbol(name, real=True) for name in names]

    def side(a: int, b: int) -> Any:
        return places[b] - places[a]

    def norm(vector: Any) -> Any:
        return sympy.sqrt(vector.dot(vector))

    known: dict[str, Any] = {str(symbol): symbol for symbol in [*coordinates, *symbols]}
    known |= {name: getattr(sympy, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "atan2", "tanh", "pi")}
    known |= {"length": lambda a, b: norm(side(a, b)), "area": lambda a, b, c: norm(side(a, b).cross(side(a, c))) / 2,
              "volume": lambda a, b, c, d: side(a, b).dot(side(a, c).cross(side(a, d))) / 6}
    unknown = sorted(set(re.findall(r"[A-Za-z_]\w*", formula)) - set(known))
    if unknown:
        raise ValueError(f"energy: {unknown[0]!r} has no value; give {unknown[0]}=…, or one of {', '.join(sorted(known))}")
    if not re.fullmatch(r"[\w\s.+\-*/(),]*", formula):
        raise ValueError(f"energy: {formula!r}; give a formula of numbers, names, + - * / ** and parentheses")
    try:
        value = sympy.sympify(eval(formula, {"__builtins__": {}}, known))  # only the names above
    except Exception as error:
        raise ValueError(f"energy: {formula!r} cannot be read: {error}") from None
    gradient = [sympy.diff(value, x) for x in coordinates]
    hessian = [[sympy.diff(of_one, x) for x in coordinates] for of_one in gradient]

    def compiled(expressions: Any, shape: tuple[int, ...]) -> Derivative:
        function = sympy.lambdify([*coordinates, *symbols], expressions, modules="numpy", cse=True)

        def values(positions: Array, *given: Array) -> Array:
            found = function(*positions.T, *given)
            columns = [np.broadcast_to(one, len(positions)) for one in found]
            return np.stack(columns, axis=1).reshape(len(positions), *shape)

        return values

    flat = [one for row in hessian for one in row]
    size = len(coordinates)
    return compiled([value], ()), compiled(gradient, (size,)), compiled(flat, (size, size))


def _of_function(function: Callable[..., Any], nodes: int, names: list[str]) -> tuple[Derivative, ...]:
    """Return energy, gradient and Hessian of a function, by JAX in double precision."""
    if not callable(function):
        raise ValueError(f"energy: {type(function).__name__}; give a formula, or a function of positions")
    jax = needed("jax", "LocalEnergy of a function")
    double = jax.enable_x64 if hasattr(jax, "enable_x64") else jax.experimental.enable_x64

    def one(place: Any, *given: Any) -> Any:
        return function(place.reshape(nodes, 3), **dict(zip(names, given)))

    def of(derivative: Any) -> Derivative:
        mapped = jax.jit(jax.vmap(derivative))

        @functools.wraps(function)
        def values(positions: Array, *given: Array) -> Array:
            with double(True):
                return np.asarray(mapped(np.asarray(positions), *(np.asarray(number) for number in given)))

        return values

    return of(one), of(jax.grad(one)), of(jax.hessian(one))
