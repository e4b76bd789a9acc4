"""Runs inside JAX: node positions as a differentiable function of keys or of strengths of cells. Requires JAX."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Optional, Union

import numpy as np

from .differentiable import Run, Source
from .errors import needed

__all__ = ["positions"]


def positions(
    scenario: Source,
    *,
    of: Union[str, Iterable[str]],
    by: Optional[str] = None,
    at_min: Union[None, float, Iterable[float]] = None,
    threads: int = 1,
) -> Callable[[Any], Any]:
    """Return node positions of a run as a function for `jax.grad` and `jax.jit`.

    Parameters
    ----------
    scenario : Scenario, str, path or mapping
        As for `plica.record`.
    of : str or iterable of str
        Key or keys with a number; with ``by="cell"``, one contraction or cortex.
    by : "cell", optional
        For factors on the strengths of cells.
    at_min : float or iterable of float, optional
        Time or times, minutes; by default the end of the run.
    threads : int
        Threads per step.

    Returns
    -------
    callable
        Takes an array of shape (keys,) or (cells,), and returns positions, µm, of shape (nodes, 3) or (times, nodes, 3). One run per
        call, and about one more for a gradient.

    Raises
    ------
    MissingExtra
        If JAX is not installed.
    ValueError
        As `plica.record` and `Tape.gradient`.

    Examples
    --------
    >>> import plica.jax                                                                          # doctest: +SKIP
    >>> run = plica.jax.positions("drosophila", of="contraction.apical", by="cell", at_min=1)     # doctest: +SKIP
    >>> jax.grad(lambda factors: run(factors)[:, 2].max())(jax.numpy.ones(756)).shape             # doctest: +SKIP
    (756,)
    """
    jax = needed("jax", "jax")
    run = Run(scenario, of, by, at_min, threads)

    def host(function: Callable[..., Any], shape: tuple[int, ...], *arrays: Any) -> Any:
        kind = jax.numpy.result_type(float)  # double precision only if JAX is set to it
        called = jax.ShapeDtypeStruct(shape, kind)
        return jax.pure_callback(lambda *given: function(*(np.asarray(one, dtype=np.float64) for one in given)).astype(kind), called, *arrays)

    @jax.custom_vjp  # type: ignore[misc]
    def of_values(values: Any) -> Any:
        return host(run.positions, run.shape, values)

    def backward(values: Any, by_positions: Any) -> tuple[Any]:
        return (host(run.pull_back, (run.size,), values, by_positions),)

    of_values.defvjp(lambda values: (of_values(values), values), backward)
    return of_values  # type: ignore[no-any-return]
