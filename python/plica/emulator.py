"""Emulators: Gaussian processes over the keys of a study, with their cross-validation errors."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from .answers import _is_number, _results
from .arguments import texts_of, told, whole
from .errors import needed
from .names import label as _label
from .study_table import StudyTable

if TYPE_CHECKING:
    import pandas


__all__ = ["Emulator"]

Array = NDArray[np.float64]


class Range(NamedTuple):
    """Range of a key in a study."""

    low: float
    high: float
    is_log: bool

    def to_unit(self, values: Any) -> Array:
        """Scale values to 0 (low end) … 1 (high end), logarithmically if `is_log`."""
        if self.is_log:
            return np.asarray(np.log(np.asarray(values, dtype=float) / self.low) / np.log(self.high / self.low))
        return np.asarray((np.asarray(values, dtype=float) - self.low) / (self.high - self.low))

    def from_unit(self, places: Array) -> Array:
        """Scale numbers from 0 to 1 back to values."""
        if self.is_log:
            return self.low * (self.high / self.low) ** places
        return self.low + (self.high - self.low) * places


class Emulator:
    """Output variables of a study as smooth functions of its keys, with standard deviations.

    Create it with `Study.emulator`.

    Attributes
    ----------
    ranges : dict of str to (low, high, is_log)
        Keys with the ranges covered by runs; there is no extrapolation.
    errors : pandas.DataFrame
        One row per output variable: ``runs`` used; ``missing`` runs without it; ``rmse``, the cross-validation root mean
        square error, in its unit; ``explained``, the fraction of variance explained (1: perfect, 0: no better than the mean).
    held_out : dict of str to pandas.DataFrame
        By output variable, one row per run: its result (``run``) and the prediction without it (``mean``, ``sd``).
    """

    def __init__(self, ranges: dict[str, Range], models: dict[str, Any], errors: pandas.DataFrame,
                 held_out: dict[str, pandas.DataFrame]) -> None:
        self.ranges, self.errors, self.held_out = ranges, errors, held_out
        self._models = models

    @property
    def keys(self) -> list[str]:
        """Keys it is a function of."""
        return list(self.ranges)

    @property
    def measures(self) -> list[str]:
        """Output variables it predicts."""
        return list(self._models)

    def predict(self, points: pandas.DataFrame) -> tuple[pandas.DataFrame, pandas.DataFrame]:
        """Predict the results of runs.

        Parameters
        ----------
        points : pandas.DataFrame, shape (points, at least the keys)
            Values of the keys, in columns with their names.

        Returns
        -------
        mean, sd : pandas.DataFrame, shape (points, measures)
            Prediction and standard deviation of a new run, including the variance of replicates, in the units of the output
            variables.

        Raises
        ------
        ValueError
            If a key is missing, or a value is outside the range of the runs.
        """
        if not hasattr(points, "columns"):
            raise TypeError(f"points: {told(points)}; give a pandas.DataFrame")
        for key, (low, high, _) in self.ranges.items():
            if key not in points:
                raise ValueError(f"predict: column {key} is missing; give {', '.join(self.keys)}")
            slack = 1e-9 * (high - low)
            if not points[key].between(low - slack, high + slack).all():
                raise ValueError(f"predict: {key} goes from {points[key].min():g} to {points[key].max():g}; "
                                 f"runs cover {low:g} to {high:g}, and the emulator does not extrapolate")
        places = np.column_stack([one.to_unit(points[key]) for key, one in self.ranges.items()])
        means, deviations = self._predict(places)
        pandas = needed("pandas", "predict")
        return (pandas.DataFrame(means, points.index, self.measures), pandas.DataFrame(deviations, points.index, self.measures))

    def plot(self) -> Any:
        """Plot cross-validation predictions over results, one panel per output variable.

        Returns
        -------
        matplotlib.figure.Figure
        """
        plt = needed("matplotlib.pyplot", "plot")
        figure, axes = plt.subplots(1, len(self.measures), squeeze=False, layout="constrained",
                                    figsize=(0.5 + 3.7 * len(self.measures), 3.8))
        for measure, ax in zip(self.measures, axes[0]):
            of_one, error = self.held_out[measure], self.errors.loc[measure]
            ax.errorbar(of_one.run, of_one["mean"], 2 * of_one.sd, fmt=".", color="C0", ecolor="0.75", label="held out, ± 2 sd")
            ax.axline((of_one.run.mean(), of_one.run.mean()), slope=1, color="k", linewidth=0.8)
            ax.set_title(f"RMSE {error.rmse:.3g}, explains {100 * error.explained:.0f} %", fontsize="medium")
            ax.set(xlabel=_label(measure) + ", run", ylabel=_label(measure) + ", predicted")
            ax.legend(frameon=False, loc="upper left")
        return figure

    def _predict(self, places: Array) -> tuple[Array, Array]:
        """Return means and standard deviations, shape (points, outputs), at places from 0 to 1 in each key."""
        found = [_in_parts(model, places) for model in self._models.values()]
        return np.column_stack([mean for mean, _ in found]), np.column_stack([sd for _, sd in found])

    def __repr__(self) -> str:
        off = ", ".join(f"{measure} ± {rmse:.3g}" for measure, rmse in self.errors.rmse.items())
        return f"Emulator({off} over {', '.join(self.keys)})"


def emulator(study: StudyTable, measures: Union[str, Sequence[str]], *, folds: int = 5, seed: int = 1) -> Emulator:
    """Fit a Gaussian process to each output variable, over the keys of the study. Requires scikit-learn.

    The covariance is a Matérn function (ν = 5/2) with one length per key, plus noise, fitted by maximum marginal likelihood
    (Rasmussen and Williams 2006, chapters 2, 4 and 5; docs/references.bib). Keys with ``scale = "log"`` enter by their
    logarithm. Errors come from k-fold cross-validation. Use at least ten points per key; a few hundred in total are fast,
    2000 are slow.

    Parameters
    ----------
    measures : str or sequence of str
        Columns of `Study.table`.
    folds : int
        Number of cross-validation folds.
    seed : int
        Random seed of the folds and of the starting points of the fit.

    Returns
    -------
    Emulator

    Raises
    ------
    ValueError
        If a key takes words, lists or a single value, the output variable does not exist, or too few runs have it (required:
        2 × keys + 2, and at least `folds`).

    Warns
    -----
    UserWarning
        If runs without the output variable were omitted: the emulator interpolates across a possible boundary.

    Examples
    --------
    >>> import plica
    >>> study = plica.Study("results/stiffness")                                 # doctest: +SKIP
    >>> emulator = study.emulator("furrow_depth_um")                             # doctest: +SKIP
    >>> mean, sd = emulator.predict(study.points)                                # doctest: +SKIP
    """
    processes = needed("sklearn.gaussian_process", "emulator")
    pandas = needed("pandas", "emulator")
    folds, seed = whole(folds, "folds", 2), whole(seed, "seed", 0, 2**32 - 1)
    table, names = study.table, texts_of(measures, "measures")
    ranges = {key: _range(study, table, key) for key in study.keys}
    models: dict[str, Any] = {}
    held_out: dict[str, Any] = {}
    errors: list[dict[str, float]] = []
    for measure in names:
        results = _results(table, measure)
        has = results.notna()
        points = table.point[has].to_numpy()
        values: Array = np.asarray(results[has], dtype=np.float64)
        places = np.column_stack([one.to_unit(table.loc[has, key]) for key, one in ranges.items()])
        parts = _parts(points, folds, seed)
        least = max(2 * len(ranges) + 2, folds)
        if len(set(points)) < least:
            raise ValueError(f"emulator: {len(set(points))} of {len(set(table.point))} points have {measure}; "
                             f"at least {least} are required")
        if not has.all():
            warnings.warn(f"emulator: {int((~has).sum())} of {len(table)} runs have no {measure} and are omitted; it is interpolated "
                          "there, too", stacklevel=2)
        model = models[measure] = _fitted(processes, places, values, _covariance(processes, len(ranges)), 1, seed)
        mean, sd = np.empty_like(values), np.empty_like(values)
        for part in range(folds):  # lengths and noise are refitted, starting from their values for all runs
            out = parts == part
            mean[out], sd[out] = _in_parts(_fitted(processes, places[~out], values[~out], model.kernel_, 0, seed), places[out])
        held_out[measure] = pandas.DataFrame({"run": values, "mean": mean, "sd": sd}, index=table.index[has])
        square = float(((values - mean) ** 2).mean())
        spread = float(values.var())
        errors.append({"runs": len(values), "missing": int((~has).sum()), "rmse": square**0.5,
                       "explained": 1 - square / spread if spread > 0 else float("nan")})
    return Emulator(ranges, models, pandas.DataFrame(errors, index=pandas.Index(names, name="measure")), held_out)


def _range(study: StudyTable, table: pandas.DataFrame, key: str) -> Range:
    if not _is_number(table[key]):
        words = ", ".join(dict.fromkeys(map(str, table[key])))
        raise ValueError(f"emulator: {key} takes words ({words}), which cannot be interpolated; use one study per word")
    low, high = (float(study._given.get(f"vary.{key}.{end}", found)) for end, found in
                 (("low", table[key].min()), ("high", table[key].max())))
    if low == high:
        raise ValueError(f"emulator: {key} has a single value; move it from [vary] to [set]")
    return Range(low, high, study._given.get(f"vary.{key}.scale") == "log")


def _parts(points: NDArray[Any], folds: int, seed: int) -> NDArray[np.int64]:
    """Fold of each run; replicates of a point share a fold."""
    distinct, of_run = np.unique(points, return_inverse=True)
    parts = np.random.default_rng(seed).permutation(np.arange(len(distinct)) % folds)
    return np.asarray(parts[of_run])


def _covariance(processes: Any, keys: int) -> Any:
    kernels = processes.kernels
    signal = kernels.ConstantKernel(1.0, (1e-3, 1e6)) * kernels.Matern(np.ones(keys), (5e-2, 1e3), nu=2.5)
    return signal + kernels.WhiteKernel(1e-4, (1e-10, 1e1))


def _fitted(processes: Any, places: Array, values: Array, covariance: Any, restarts: int, seed: int) -> Any:
    model = processes.GaussianProcessRegressor(covariance, normalize_y=True, n_restarts_optimizer=restarts, random_state=seed)
    with warnings.catch_warnings():  # lengths at their bounds: a key without effect, or results without noise
        warnings.simplefilter("ignore", needed("sklearn.exceptions", "emulator").ConvergenceWarning)
        with _one_thread(len(values)):
            return model.fit(places, values)


def _in_parts(model: Any, places: Array) -> tuple[Array, Array]:
    """Evaluate in batches, so that covariances with all runs fit into memory."""
    with warnings.catch_warnings():  # variances rounded to slightly below 0 are set to 0
        warnings.filterwarnings("ignore", "Predicted variances smaller than 0")
        with _one_thread(len(model.X_train_)):
            parts = [model.predict(places[at : at + 2000], return_std=True) for at in range(0, len(places), 2000)]
    return np.concatenate([mean for mean, _ in parts]), np.concatenate([sd for _, sd in parts])


def _one_thread(runs: int) -> Any:
    """Limit to one thread: equally fast for a few hundred runs, and faster on a busy machine."""
    return needed("threadpoolctl", "emulator").threadpool_limits(1 if runs < 500 else None)
