"""Runs inside PyTorch: node positions as a differentiable function of keys or of strengths of cells. Requires PyTorch."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Optional, Union

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
    """Return node positions of a run as a function with a gradient for `torch.autograd`.

    Parameters
    ----------
    scenario, of, by, at_min, threads
        As for `plica.jax.positions`.

    Returns
    -------
    callable
        Takes a tensor of shape (keys,) or (cells,), and returns positions, µm, of shape (nodes, 3) or (times, nodes, 3), in double
        precision.

    Raises
    ------
    MissingExtra
        If PyTorch is not installed.
    ValueError
        As `plica.record` and `Tape.gradient`.

    Examples
    --------
    >>> import plica.torch                                                                        # doctest: +SKIP
    >>> run = plica.torch.positions("drosophila", of="contraction.apical", by="cell", at_min=1)   # doctest: +SKIP
    >>> factors = torch.ones(756, requires_grad=True)                                             # doctest: +SKIP
    >>> run(factors)[:, 2].max().backward()                                                       # doctest: +SKIP
    """
    torch = needed("torch", "torch")
    run = Run(scenario, of, by, at_min, threads)

    class Positions(torch.autograd.Function):  # type: ignore[misc,name-defined]
        @staticmethod
        def forward(context: Any, values: Any) -> Any:
            context.save_for_backward(values)
            return torch.tensor(run.positions(values.detach().double().cpu().numpy()))

        @staticmethod
        def backward(context: Any, by_positions: Any) -> Any:
            (values,) = context.saved_tensors
            gradient = run.pull_back(values.detach().double().cpu().numpy(), by_positions.double().cpu().numpy())
            return torch.from_numpy(gradient).to(values)

    return Positions.apply  # type: ignore[no-any-return]
