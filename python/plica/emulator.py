"""A formula in the place of runs: a Gaussian process over the keys of a study, and how far it is off."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

from .answers import _is_number, _label, _results
from .errors import needed

if TYPE_CHECKING:
    import pandas

    from .study import Study

__all__ = ["Emulator"]

Array = NDArray[np.float64]


class Range(NamedTuple):
    """The values of a key that a study has tried."""

    low: float
    high: float
    is_log: bool

    def to_unit(self, values: Any) -> Array:
        """From 0 at the low end to 1 at the high end, in the logarithm where it is of that."""
        if self.is_log:
            return np.asarray(np.log(np.asarray(values, dtype=float) / self.low) / np.log(self.high / self.low))
        return np.asarray((np.asarray(values, dtype=float) - self.low) / (self.high - self.low))

    def from_unit(self, places: Array) -> Array:
        """Back to values."""
        if self.is_log:
            return self.low * (self.high / self.low) ** places
        return self.low + (self.high - self.low) * places


class Emulator:
    """Measures of a study as smooth functions of its keys: a guess for points that were not run, with its deviation.

    Made by `Study.emulator`.

    Attributes
    ----------
    ranges : dict of str to (low, high, is_log)
        The keys, and the values between which runs were made. Nothing is said beyond.
    errors : pandas.DataFrame
        A row a measure: ``runs`` that it was made from; ``missing`` ones without the measure; ``rmse``, the root of the mean
        square error of what was predicted for runs that were held out, in the measure's unit; ``explained``, the share of
        the variance that these predictions explain (1 is perfect, 0 no better than the mean).
    held_out : dict of str to pandas.DataFrame
        By measure, a row a run: what came out (``run``), what was predicted without it (``mean``, ``sd``).
    """

    def __init__(self, ranges: dict[str, Range], models: dict[str, Any], errors: pandas.DataFrame,
                 held_out: dict[str, pandas.DataFrame]) -> None:
        self.ranges, self.errors, self.held_out = ranges, errors, held_out
        self._models = models

    @property
    def keys(self) -> list[str]:
        """What it is a function of."""
        return list(self.ranges)

    @property
    def measures(self) -> list[str]:
        """What it predicts."""
        return list(self._models)

    def predict(self, points: pandas.DataFrame) -> tuple[pandas.DataFrame, pandas.DataFrame]:
        """What runs would come to.

        Parameters
        ----------
        points : pandas.DataFrame, shape (points, at least the keys)
            Values of the keys, in columns of their names.

        Returns
        -------
        mean, sd : pandas.DataFrame, shape (points, measures)
            In the measures' units. The deviation is that of a new run: of the guess, and of replicates where there are any.

        Raises
        ------
        ValueError
            A key is missing, or a value lies beyond what was run.
        """
        for key, (low, high, _) in self.ranges.items():
            if key not in points:
                raise ValueError(f"predict: there is no column {key}; give {', '.join(self.keys)}")
            slack = 1e-9 * (high - low)
            if not points[key].between(low - slack, high + slack).all():
                raise ValueError(f"predict: {key} goes from {points[key].min():g} to {points[key].max():g}; "
                                 f"runs were made from {low:g} to {high:g}, and beyond them an emulator knows nothing")
        places = np.column_stack([one.to_unit(points[key]) for key, one in self.ranges.items()])
        means, deviations = self._predict(places)
        pandas = needed("pandas", "predict")
        return (pandas.DataFrame(means, points.index, self.measures), pandas.DataFrame(deviations, points.index, self.measures))

    def plot(self) -> Any:
        """Draws what was predicted for each run while it was held out, over what came out: a panel a measure.

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
            ax.set_title(f"off by {error.rmse:.3g} (rms), explains {100 * error.explained:.0f} %", fontsize="medium")
            ax.set(xlabel=_label(measure) + ", run", ylabel=_label(measure) + ", predicted")
            ax.legend(frameon=False, loc="upper left")
        return figure

    def _predict(self, places: Array) -> tuple[Array, Array]:
        """Means and deviations, shape (points, measures), at places from 0 to 1 in each key."""
        found = [_in_parts(model, places) for model in self._models.values()]
        return np.column_stack([mean for mean, _ in found]), np.column_stack([sd for _, sd in found])

    def __repr__(self) -> str:
        off = ", ".join(f"{measure} ± {rmse:.3g}" for measure, rmse in self.errors.rmse.items())
        return f"Emulator({off} over {', '.join(self.keys)})"


def emulator(study: Study, measures: Union[str, Sequence[str]], *, folds: int = 5, seed: int = 1) -> Emulator:
    """Fits a Gaussian process to each measure, over the keys of the study. Needs scikit-learn.

    Its covariance is a Matérn function (ν = 5/2) with a length for each key, and noise; both are fitted by the marginal
    likelihood (Rasmussen and Williams 2006, chapters 2, 4 and 5; docs/references.bib). Keys that the study varies with
    ``scale = "log"`` go in by their logarithm. The error is that of k-fold cross-validation: a part of the points is held out
    and predicted by a process fitted to the rest, one part after another. Ten points a key are few; a few hundred in all are quick, 2000 are slow.

    Parameters
    ----------
    measures : str or sequence of str
        Columns of `table`.
    folds : int
        Parts of the cross-validation.
    seed : int
        Of the parts, and of the fit's starting points.

    Returns
    -------
    Emulator

    Raises
    ------
    ValueError
        A key takes words, lists or one value only; there is no such measure; or too few runs have it (twice the number of
        keys and 2 more are needed, and as many as there are folds).

    Warns
    -----
    UserWarning
        Runs without the measure were left out: the emulator bridges what may be a border.

    Examples
    --------
    >>> import plica
    >>> study = plica.Study("results/stiffness")                                 # doctest: +SKIP
    >>> emulator = study.emulator("furrow_depth_um")                             # doctest: +SKIP
    >>> mean, sd = emulator.predict(study.points)                                # doctest: +SKIP
    """
    processes = needed("sklearn.gaussian_process", "emulator")
    pandas = needed("pandas", "emulator")
    table, names = study.table, [measures] if isinstance(measures, str) else list(measures)
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
                             f"at least {least} are needed")
        if not has.all():
            warnings.warn(f"emulator: {int((~has).sum())} of {len(table)} runs have no {measure} and are left out; it is guessed "
                          "there, too", stacklevel=2)
        mean, sd = np.empty_like(values), np.empty_like(values)
        for part in range(folds):
            out = parts == part
            mean[out], sd[out] = _in_parts(_fitted(processes, places[~out], values[~out], seed), places[out])
        models[measure] = _fitted(processes, places, values, seed)
        held_out[measure] = pandas.DataFrame({"run": values, "mean": mean, "sd": sd}, index=table.index[has])
        square = float(((values - mean) ** 2).mean())
        spread = float(values.var())
        errors.append({"runs": len(values), "missing": int((~has).sum()), "rmse": square**0.5,
                       "explained": 1 - square / spread if spread > 0 else float("nan")})
    return Emulator(ranges, models, pandas.DataFrame(errors, index=pandas.Index(names, name="measure")), held_out)


def _range(study: Study, table: pandas.DataFrame, key: str) -> Range:
    if not _is_number(table[key]):
        words = ", ".join(dict.fromkeys(map(str, table[key])))
        raise ValueError(f"emulator: {key} takes words ({words}), between which there is nothing; make a study for each of them")
    low, high = (float(study._given.get(f"vary.{key}.{end}", found)) for end, found in
                 (("low", table[key].min()), ("high", table[key].max())))
    if low == high:
        raise ValueError(f"emulator: {key} has one value only; move it from [vary] to [set]")
    return Range(low, high, study._given.get(f"vary.{key}.scale") == "log")


def _parts(points: NDArray[Any], folds: int, seed: int) -> NDArray[np.int64]:
    """Which part each run is in; replicates of a point are together."""
    distinct, of_run = np.unique(points, return_inverse=True)
    parts = np.random.default_rng(seed).permutation(np.arange(len(distinct)) % folds)
    return np.asarray(parts[of_run])


def _fitted(processes: Any, places: Array, values: Array, seed: int) -> Any:
    kernels = processes.kernels
    covariance = kernels.ConstantKernel(1.0, (1e-3, 1e6)) * kernels.Matern(np.ones(places.shape[1]), (5e-2, 1e3), nu=2.5)
    noise = kernels.WhiteKernel(1e-4, (1e-10, 1e1))
    model = processes.GaussianProcessRegressor(covariance + noise, normalize_y=True, n_restarts_optimizer=1, random_state=seed)
    with warnings.catch_warnings():  # of lengths at their bounds: of a key that does nothing, or of results without noise
        warnings.simplefilter("ignore", needed("sklearn.exceptions", "emulator").ConvergenceWarning)
        # One thread is as quick for a few hundred runs, and much quicker where others are busy.
        with needed("threadpoolctl", "emulator").threadpool_limits(1 if len(values) < 500 else None):
            return model.fit(places, values)


def _in_parts(model: Any, places: Array) -> tuple[Array, Array]:
    """So many points at a time that their covariances with all runs do not fill the memory."""
    with warnings.catch_warnings():  # of a variance that rounding makes a little less than 0, and that is taken as 0
        warnings.filterwarnings("ignore", "Predicted variances smaller than 0")
        parts = [model.predict(places[at : at + 2000], return_std=True) for at in range(0, len(places), 2000)]
    return np.concatenate([mean for mean, _ in parts]), np.concatenate([sd for _, sd in parts])
