"""Sobol indices: variance-based sensitivity of a result to each key of a study."""
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .answers import _results
from .arguments import number, text_of, whole
from .errors import needed
from .names import label as _label
from .study_table import StudyTable

if TYPE_CHECKING:
    import pandas


__all__ = ["SobolIndices"]


class SobolIndices(NamedTuple):
    """Sobol indices of one output variable; created by `Study.sobol_indices`.

    Attributes
    ----------
    measure : str
        Output variable.
    table : pandas.DataFrame
        One row per key. ``first``: fraction of variance removed by fixing this key; ``total``: fraction that remains if all
        other keys are fixed. Both lie between 0 and 1, with ``first`` <= ``total``, apart from the estimation error, which is
        large with few base points. ``*_low`` and ``*_high`` bound the confidence intervals.
    base_points : int
        Number of base points (groups of runs) used.
    confidence : float
        Level of the confidence intervals.
    dropped : int
        Number of base points omitted because a run had no result (``drop_missing=True``).
    """

    measure: str
    table: pandas.DataFrame
    base_points: int
    confidence: float
    dropped: int = 0

    def __str__(self) -> str:
        wide = max(len(key) for key in ["key", *self.table.index])
        lines = [f"{'key':{wide}}  {'first':18}total"]
        for key, row in self.table.iterrows():
            first, total = (f"{row[name]:.2f} ({row[name + '_low']:.2f} to {row[name + '_high']:.2f})" for name in ("first", "total"))
            lines.append(f"{key!s:{wide}}  {first:18}{total}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return str(self)

    def plot(self, ax: Any = None) -> Any:
        """Plot both indices of each key as bars with confidence intervals.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw into; by default a new figure is made.

        Returns
        -------
        matplotlib.figure.Figure
        """
        plt = needed("matplotlib.pyplot", "plot")
        if ax is None:
            _, ax = plt.subplots(figsize=(7, 1.4 + 0.75 * len(self.table)), layout="constrained")
        places = np.arange(len(self.table))
        for name, shift, colour, text in (("first", -0.19, "#0072B2", "alone"),
                                          ("total", 0.19, "#E69F00", "with what it does together with others")):
            share = self.table[name]
            ends = [share - self.table[f"{name}_low"], self.table[f"{name}_high"] - share]
            ax.barh(places + shift, share, 0.36, xerr=ends, color=colour, capsize=3, label=text)
        ax.set_yticks(places, [_label(key, with_unit=False) for key in self.table.index])
        ax.invert_yaxis()
        ax.axvline(0, color="k", linewidth=0.8)
        ax.set_xlabel(f"share of the variance of {_label(self.measure, with_unit=False)}")
        ax.legend(loc="lower center", bbox_to_anchor=(0.4, 1.0), ncols=2, frameon=False)
        ax.grid(axis="x", alpha=0.3)
        return ax.figure


def sobol_indices(
    study: StudyTable, measure: str, *, confidence: float = 0.95, resamples: int = 1000, seed: int = 1, drop_missing: bool = False
) -> SobolIndices:
    """Estimate first-order and total Sobol indices of an output variable. Requires SALib.

    Estimators of Saltelli et al. (2010) as implemented in SALib (Herman and Usher 2017; docs/references.bib): with outputs
    f(A), f(B) and f(AB_k) (A with column k of B) and variance V, first_k = mean(f(B) (f(AB_k) - f(A))) / V and
    total_k = mean((f(A) - f(AB_k))²) / 2V. Confidence intervals are normal, with the standard deviation of bootstrap
    resamples.

    Parameters
    ----------
    measure : str
        Column of `Study.table`.
    confidence : float
        Level of the confidence intervals.
    resamples : int
        Number of bootstrap resamples.
    seed : int
        Random seed of the bootstrap, 0 or more.
    drop_missing : bool
        Omit base points with a run without result; the indices then describe only the rest of the ranges.

    Returns
    -------
    SobolIndices

    Raises
    ------
    ValueError
        If the study is of another kind, the output variable does not exist or is constant, or runs have no value.

    Warns
    -----
    UserWarning
        If base points were omitted.

    Examples
    --------
    >>> import plica
    >>> study = plica.Study({
    ...     "scenario": "division-demo", "set": {"time.end_min": 0.2}, "design": {"kind": "sobol-indices", "points": 4},
    ...     "vary": {"elasticity.young_modulus_Pa": {"low": 500, "high": 1000}}, "keep": {"measures": ["steps", "cells"]},
    ... })
    >>> table = study.run(jobs=1)
    >>> indices = study.sobol_indices("cells")
    Traceback (most recent call last):
    ValueError: sobol_indices: cells is the same in all runs, so no key has an effect on it
    """
    text_of(measure, "measure")
    resamples, seed = whole(resamples, "resamples", 2), whole(seed, "seed", 0, 2**31)
    if not 0 < number(confidence, "confidence") < 1:
        raise ValueError(f"confidence: {confidence!r}; give a number between 0 and 1")
    if study.kind != "sobol-indices":
        raise ValueError(f'sobol_indices: the study is of kind "{study.kind}"; use kind "sobol-indices"')
    table, keys = study.table, study.keys
    results = _results(table, measure).groupby(table.point).mean()  # mean of replicates
    group = len(keys) + 2
    groups: NDArray[np.float64] = np.asarray(results, dtype=np.float64).reshape(-1, group)
    complete: NDArray[np.bool_] = np.asarray(np.isfinite(groups).all(axis=1))
    if not complete.all() and not drop_missing:
        raise ValueError(_what_is_missing(table, measure, int(complete.sum()), len(groups)))
    dropped = int((~complete).sum())
    if dropped > 0:
        warnings.warn(f"sobol_indices: {dropped} of {len(groups)} base points are omitted, because runs have no {measure}; the "
                      "indices say nothing about where these are", stacklevel=2)
    groups = groups[complete]
    if len(groups) < 2:
        raise ValueError(f"sobol_indices: {len(groups)} of {len(complete)} base points are complete; at least 2 are required")
    if np.ptp(groups) == 0:
        raise ValueError(f"sobol_indices: {measure} is the same in all runs, so no key has an effect on it")
    analysis = needed("SALib.analyze.sobol", "sobol_indices")
    problem = {"num_vars": len(keys), "names": np.array(keys), "bounds": [[0, 1]] * len(keys)}
    # SALib ignores a seed of 0.
    found = analysis.analyze(problem, groups.ravel(), calc_second_order=False, num_resamples=resamples, conf_level=confidence,
                             seed=seed + 1)
    columns: dict[str, NDArray[np.float64]] = {}
    for name, short in (("first", "S1"), ("total", "ST")):
        columns |= {name: found[short], f"{name}_low": found[short] - found[f"{short}_conf"],
                    f"{name}_high": found[short] + found[f"{short}_conf"]}
    pandas = needed("pandas", "sobol_indices")
    return SobolIndices(measure, pandas.DataFrame(columns, index=pandas.Index(keys, name="key")), len(groups), confidence, dropped)


def _what_is_missing(table: pandas.DataFrame, measure: str, complete: int, of: int) -> str:
    lost = table[_results(table, measure).isna()]
    why = ", ".join(f"{count} {status}" for status, count in lost.status.value_counts().items())
    return (f"sobol_indices: {len(lost)} of {len(table)} runs have no {measure} ({why}), and a base point requires all its runs; "
            f"{complete} of {of} base points are complete. Run the remaining runs; narrow the ranges to where every run has a "
            "result; take a measure that every run has; or give drop_missing=True, and say so where you show the indices")
