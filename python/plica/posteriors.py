"""Posterior distributions of keys, given measured targets.

Targets have normal errors, so the likelihood is known, and importance sampling requires neither distance nor tolerance, unlike
approximate Bayesian computation. pyABC gives the same posterior (docs/developers/dependencies.md).
"""
from __future__ import annotations

import math
import tempfile
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np

from .answers import _results, _set_log
from .arguments import pairs_of, text_of, told, whole
from .emulator import Array, Emulator, Range, _range
from .errors import needed
from .fits import fit
from .names import in_columns, label as _label
from .scenario import Scenario
from .study import Study
from .tapes import record

if TYPE_CHECKING:
    import pandas

__all__ = ["Posterior", "posterior"]

FEW = 100  # effective samples; with fewer, means are wrong by a tenth of a standard deviation or more
MOST_ROUNDS = 30
CENTRES = 400  # components of the mixture for proposals


class Posterior(NamedTuple):
    """Weighted samples of keys, given targets; created by `posterior`.

    Attributes
    ----------
    samples : pandas.DataFrame
        One row per sample: the keys and ``weight``; weights sum to 1 and must be used in every statistic.
    targets : pandas.DataFrame
        One row per output variable: ``value`` and ``sd`` of the target, ``mean`` and ``posterior_sd`` of the samples. If
        a mean deviates from its value by several ``sd``, no values of the keys meet all targets.
    ranges : dict of str to (low, high, is_log)
        Prior: each key uniform between these values, independent of the others.
    effective_size : float
        Effective sample size, 1 / sum(weight²) (Kong 1992; docs/references.bib).
    """

    samples: pandas.DataFrame
    targets: pandas.DataFrame
    ranges: dict[str, Range]
    effective_size: float

    def __repr__(self) -> str:
        """Summary: mean, standard deviation and central 90 % of each key, and the targets."""
        heads = ("key", "mean", "sd", "5 %", "95 %")
        sd = np.sqrt(np.diag(self.covariance))
        rows = [(key, *(f"{one:.4g}" for one in (self.mean[key], sd[k], *self._quantiles(key, (0.05, 0.95)))))
                for k, key in enumerate(self.keys)]
        goals = [(str(name), *(f"{row[one]:.4g}" for one in ("value", "sd", "mean", "posterior_sd")))
                 for name, row in self.targets.iterrows()]
        return "\n".join([f"Posterior of {len(self.samples)} samples, worth {self.effective_size:.0f}", *in_columns(rows, heads),
                          *in_columns(goals, ("target", "value", "sd", "mean", "posterior sd"))])

    def _quantiles(self, key: str, parts: tuple[float, ...]) -> Array:
        values, weights = (np.asarray(self.samples[name], dtype=float) for name in (key, "weight"))
        order = np.argsort(values)
        return np.asarray(np.interp(parts, np.cumsum(weights[order]) - 0.5 * weights[order], values[order]))

    @property
    def keys(self) -> list[str]:
        """Keys of the posterior."""
        return list(self.ranges)

    @property
    def mean(self) -> pandas.Series[float]:
        """Posterior mean of each key, in its unit."""
        mean: pandas.Series[float] = self.samples[self.keys].mul(self.samples.weight, axis=0).sum()
        return mean

    @property
    def covariance(self) -> pandas.DataFrame:
        """Posterior covariance of each pair of keys, in the product of their units."""
        away = self.samples[self.keys] - self.mean
        return away.mul(self.samples.weight, axis=0).T @ away

    def plot(self) -> Any:
        """Plot the marginal distribution of each key and the joint distributions of pairs. Axes span the prior.

        Returns
        -------
        matplotlib.figure.Figure
        """
        plt = needed("matplotlib.pyplot", "plot")
        count, weights = len(self.keys), self.samples.weight
        figure, axes = plt.subplots(count, count, squeeze=False, sharex="col", layout="constrained",
                                    figsize=(1.2 + 2.3 * count, 1.0 + 2.1 * count))
        bins = int(np.clip(self.effective_size**0.35, 8, 30))
        edges = {key: one.from_unit(np.linspace(0.0, 1.0, bins + 1, dtype=np.float64)) for key, one in self.ranges.items()}
        for row, y in enumerate(self.keys):
            for column, x in enumerate(self.keys):
                ax = axes[row, column]
                if column > row:
                    ax.axis("off")
                    continue
                if x == y:
                    ax.hist(self.samples[x], edges[x], weights=weights, color="#0072B2")
                    ax.set(yticks=[], xlim=self.ranges[x][:2])
                else:
                    ax.hist2d(self.samples[x], self.samples[y], [edges[x], edges[y]], weights=weights, cmap="Blues")
                    if self.ranges[y].is_log:
                        _set_log(ax.yaxis)
                    ax.set_ylabel(_label(y) if column == 0 else "")
                    ax.tick_params(labelleft=column == 0)
                if self.ranges[x].is_log:
                    _set_log(ax.xaxis)
                if row == count - 1:
                    ax.set_xlabel(_label(x))
        axes[0, 0].set_ylabel("probability")
        return figure


def posterior(
    source: Union[Study, Scenario, str],
    keys: Optional[Mapping[str, tuple[float, float]]] = None,
    targets: Optional[Mapping[str, tuple[float, float]]] = None,
    *,
    on: str = "emulator",
    runs: Optional[int] = None,
    samples: int = 10000,
    seed: int = 1,
    jobs: Optional[int] = None,
    progress: bool = False,
) -> Posterior:
    """Sample the posterior distribution of keys, given several targets.

    The prior is uniform between the bounds of each key (in its logarithm if the study has ``scale = "log"``). The likelihood is
    normal: the `sd` of a target must include measurement error and model discrepancy. The emulator variance is added, so a poor
    emulator widens the posterior. Samples come from population Monte Carlo (Cappé et al. 2004; docs/references.bib):
    rounds of importance sampling around the previous weighted samples, with a likelihood tempered from flat to full.
    With gradients, they are runs drawn around the best fit instead, by its covariance (Laplace's approximation).

    Parameters
    ----------
    source : Study, Scenario, str, path or mapping
        Study whose runs vary the keys and have the targets, or scenario for which `runs` are made now (Sobol sequence over
        the bounds).
    keys : mapping of str to (float, float)
        Bounds of each key. Keys of a study that are omitted take their whole range.
    targets : mapping of str to (float, float)
        Output variables, each with value and standard deviation, in its unit.
    on : str
        "emulator": evaluate Gaussian processes fitted to the runs. "runs": weight the runs by their likelihood (0 if a target
        is missing), which requires many runs of kind "sobol" or "latin-hypercube". "gradients": fit a scenario (`fit`), draw runs
        around the fit and weight them by their likelihood; targets need a gradient (`Tape.gradient`), and one best fit.
    runs : int, optional
        Number of runs of a scenario; by default 20 per key, and 200 with gradients, beside those of the fit.
    samples : int
        Number of samples drawn on the emulator.
    seed : int
        Random seed.
    jobs, progress
        As for `Study.run`.

    Returns
    -------
    Posterior

    Raises
    ------
    ValueError
        If there are no targets, a standard deviation is not positive, bounds are reversed or exceed those of the study, no sample
        agrees, or a target has no gradient.
    ScenarioError
        If a key or output variable is unknown. With gradients, a ValueError.

    Warns
    -----
    UserWarning
        If there are fewer than 100 effective samples, or the mean misses a target by more than 3 standard deviations.

    Examples
    --------
    >>> import plica
    >>> found = plica.posterior("furrow-slice",
    ...                         keys={"cortex.apical.tension_mN_per_m": (1, 2), "cortex.shortening.tension_mN_per_m": (0.2, 0.7)},
    ...                         targets={"furrow_depth_um": (55, 3), "lips_closed_time_s": (900, 60)})  # doctest: +SKIP
    >>> found.mean, found.plot()                                                                        # doctest: +SKIP
    """
    targets = pairs_of({} if targets is None else targets, "targets", "(value, sd)")
    if not targets or not all(np.isfinite(value) and 0 < sd < np.inf for value, sd in targets.values()):
        raise ValueError("posterior: give targets as {output: (value, sd)}, each sd > 0")
    keys = pairs_of({} if keys is None else keys, "keys", "(low, high)")
    whole(samples, "samples", 2), whole(seed, "seed", 0, 2**32 - 1)
    if text_of(on, "on") not in ("emulator", "runs", "gradients"):
        raise ValueError(f'posterior: on={on!r}; give "emulator", "runs" or "gradients"')
    if on == "gradients" and isinstance(source, Study):
        raise ValueError('posterior: on="gradients" makes its own runs; give a scenario instead of a study')
    if not isinstance(source, Study) and not keys:
        raise ValueError("posterior: give keys as {key: (low, high)}")
    for key, (low, high) in keys.items():
        if not -math.inf < low < high < math.inf:
            raise ValueError(f"keys[{told(key)}]: {low:g} to {high:g}; give finite bounds, the lower one first")
    count = (200 if on == "gradients" else 20 * len(keys)) if runs is None else whole(runs, "runs")
    if on == "gradients":
        found = _by_gradients(_scenario_of(source), keys, targets, count, seed, jobs, progress)
    else:
        study = source if isinstance(source, Study) else _made(
            _scenario_of(source), {key: {"low": low, "high": high} for key, (low, high) in keys.items()},
            {"kind": "sobol", "points": count, "seed": seed}, list(targets), jobs, progress)
        ranges = _prior(study, keys)
        found = _of_runs(study, ranges, targets) if on == "runs" else _on_emulator(study, ranges, targets, samples, seed)
    if found.effective_size < FEW:
        more = {"runs": "take more runs, or the emulator", "gradients": "take more runs"}.get(on, "take more samples")
        warnings.warn(f"posterior: only {found.effective_size:.0f} effective samples; {more}", stacklevel=2)
    for measure, row in found.targets.iterrows():
        if abs(row["mean"] - row.value) > 3 * row.sd:
            warnings.warn(f"posterior: {measure} is {row['mean']:.4g}; the target is {row.value:g} ± {row.sd:g}; "
                          "no values of the keys meet all targets", stacklevel=2)
    return found


def _scenario_of(source: Any) -> Scenario:
    return source if isinstance(source, Scenario) else Scenario(source)


def _made(scenario: Scenario, vary: Mapping[str, Any], design: Mapping[str, Any], measures: list[str], jobs: Optional[int],
          progress: bool) -> Study:
    scenario._require_file("posterior")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scenario.toml"
        file.write_text(scenario.to_toml(), encoding="utf-8")
        study = Study({
            "scenario": str(file), "vary": vary, "design": design, "keep": {"measures": measures},
        })
        study.run(jobs=jobs, progress=progress)
    return study


def _prior(study: Study, keys: Mapping[str, tuple[float, float]]) -> dict[str, Range]:
    unknown = [key for key in keys if key not in study.keys]
    if unknown:
        raise ValueError(f"posterior: {unknown[0]} does not vary in the study; keys: {', '.join(study.keys)}")
    table, ranges = study.table, {}
    for key in study.keys:
        tried = _range(study, table, key)
        low, high = keys.get(key, tried[:2])
        if not tried.low <= low < high <= tried.high:
            raise ValueError(f"posterior: {key} from {low:g} to {high:g}; the study covers {tried.low:g} to {tried.high:g}")
        ranges[key] = Range(float(low), float(high), tried.is_log)
    return ranges


def _of_runs(study: Study, ranges: dict[str, Range], targets: Mapping[str, tuple[float, float]]) -> Posterior:
    if study.kind not in ("sobol", "latin-hypercube"):
        raise ValueError(f'posterior: the points of a study of kind "{study.kind}" do not follow the prior; '
                         'give one of kind "sobol" or "latin-hypercube", or on="emulator"')
    if any(name.endswith(".mean") for name in study._given if name.startswith("vary.")):
        raise ValueError("posterior: a key of the study has a normal distribution, but the prior is uniform; give low and high")
    table = study.table
    inside = np.logical_and.reduce([table[key].between(one.low, one.high) for key, one in ranges.items()])
    table = table[inside & (table.status != "not_run")]
    results = np.column_stack([_results(table, measure) for measure in targets])
    return _weighted(table[list(ranges)], _log_likelihood(results, np.zeros_like(results), targets), results, ranges, targets)


def _on_emulator(study: Study, ranges: dict[str, Range], targets: Mapping[str, tuple[float, float]], samples: int,
                 seed: int) -> Posterior:
    emulator: Emulator = study.emulator(list(targets), seed=seed)
    pandas = needed("pandas", "posterior")

    def values_at(places: Array) -> dict[str, Array]:
        return {key: one.from_unit(places[:, k]) for k, (key, one) in enumerate(ranges.items())}

    def predict(places: Array) -> tuple[Array, Array]:
        values = values_at(places)
        return emulator._predict(np.column_stack([one.to_unit(values[key]) for key, one in emulator.ranges.items()]))

    def log_likelihood(places: Array) -> Array:
        return _log_likelihood(*predict(places), targets)

    places, log_weights = population_monte_carlo(log_likelihood, len(ranges), samples, np.random.default_rng(seed))
    return _weighted(pandas.DataFrame(values_at(places)), log_weights, predict(places)[0], ranges, targets)


def _by_gradients(scenario: Scenario, keys: Mapping[str, tuple[float, float]], targets: Mapping[str, tuple[float, float]],
                  runs: int, seed: int, jobs: Optional[int], progress: bool) -> Posterior:
    ranges = {key: Range(float(low), float(high), False) for key, (low, high) in keys.items()}
    start = scenario.copy()
    at_rest = record(start, until_min=1e-6)._core
    for name in targets:
        try:
            at_rest.outcome(name, 0)
        except ValueError as error:
            raise ValueError(f'posterior: {error}, or give on="emulator"') from None
    for key, one in ranges.items():
        try:
            value = start[key]
        except KeyError as error:
            raise ValueError(f"keys: {error.args[0]}; choose another key, or set this one in the scenario") from None
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"keys: {key} is {told(value)}; choose keys that have a number")
        if not one.low <= value <= one.high:
            start[key] = (one.low + one.high) / 2
    best = fit(start, targets, of=keys, progress=progress)
    # In the unit cube of the prior, whose variance is 1/12 along what targets leave open.
    slopes = best.jacobian * [(one.high - one.low) / (best.values[key] if one.low > 0 else 1.0) for key, one in ranges.items()]
    covariance = np.asarray(np.linalg.inv(slopes.T @ slopes + 12 * np.eye(len(keys))), dtype=np.float64)
    middle = np.array([one.to_unit(np.array([best.values[key]]))[0] for key, one in ranges.items()])
    places, log_proposal = _about(middle, covariance, runs, np.random.default_rng(seed))
    values = {key: {"values": one.from_unit(places[:, k]).tolist()} for k, (key, one) in enumerate(ranges.items())}
    table = _made(scenario, values, {"kind": "list"}, list(targets), jobs, progress).table
    results = np.column_stack([_results(table, measure) for measure in targets])
    logs = _log_likelihood(results, np.zeros_like(results), targets)
    return _weighted(table[list(ranges)], logs - log_proposal, results, ranges, targets)


def _about(middle: Array, covariance: Array, count: int, random: np.random.Generator) -> tuple[Array, Array]:
    """Draw places in the unit cube, and return their log-density.

    9 of 10 from Student's distribution (4 degrees of freedom) of twice this covariance, 1 of 10 even. Places outside the cube are
    redrawn, which raises the density inside by one factor, found by drawing.
    """
    dimensions, freedom = len(middle), 4
    factor = np.linalg.cholesky(2 * covariance)

    def drawn(number_of: int) -> Array:
        width = np.sqrt(freedom / random.chisquare(freedom, number_of))
        places = middle + width[:, None] * random.standard_normal((number_of, dimensions)) @ factor.T
        return np.asarray(places[((places >= 0) & (places <= 1)).all(axis=1)])

    trials = 10_000
    near = drawn(trials)
    inside = len(near) / trials
    wanted = count - count // 10
    while len(near) < wanted:
        near = np.concatenate([near, drawn(trials)])
    places = np.concatenate([near[:wanted], random.random((count - wanted, dimensions))])
    squares = (np.linalg.solve(factor, (places - middle).T) ** 2).sum(axis=0)
    constant = math.lgamma((freedom + dimensions) / 2) - math.lgamma(freedom / 2) - dimensions / 2 * math.log(freedom * math.pi)
    logs = constant - np.log(np.diag(factor)).sum() - (freedom + dimensions) / 2 * np.log1p(squares / freedom)
    return places, np.logaddexp(math.log(0.9) + logs - math.log(inside), math.log(0.1))


def _log_likelihood(means: Array, deviations: Array, targets: Mapping[str, tuple[float, float]]) -> Array:
    """Log-likelihood of each row of results, up to a constant; -infinity if a result is missing."""
    value, sd = np.array(list(targets.values()), dtype=float).T
    variance = sd**2 + deviations**2
    logs = -0.5 * ((means - value) ** 2 / variance + np.log(variance)).sum(axis=1)
    return np.where(np.isfinite(logs), logs, -np.inf)


def _weighted(values: pandas.DataFrame, log_weights: Array, results: Array, ranges: dict[str, Range],
              targets: Mapping[str, tuple[float, float]]) -> Posterior:
    if not np.isfinite(log_weights).any():
        raise ValueError("posterior: no sample agrees with the targets; check that runs have these output variables")
    weights = np.exp(log_weights - log_weights.max())
    weights /= weights.sum()
    kept = weights > 0
    pandas = needed("pandas", "posterior")
    mean = weights[kept] @ results[kept]
    spread = np.sqrt(weights[kept] @ (results[kept] - mean) ** 2)
    rows = {"value": [value for value, _ in targets.values()], "sd": [sd for _, sd in targets.values()], "mean": mean,
            "posterior_sd": spread}
    table = pandas.DataFrame(rows, index=pandas.Index(list(targets), name="measure"), dtype=float)
    samples = values[kept].assign(weight=weights[kept]).reset_index(drop=True)
    return Posterior(samples, table, ranges, float(1 / (weights**2).sum()))


def population_monte_carlo(log_likelihood: Callable[[Array], Array], dimensions: int, count: int,
                           random: np.random.Generator) -> tuple[Array, Array]:
    """Draw weighted samples of a likelihood over the unit cube.

    Returns
    -------
    places : ndarray of float, shape (count, dimensions)
    log_weights : ndarray of float, shape (count,)
        Not normalised.
    """
    places: Array = random.random((count, dimensions))
    log_proposal: Array = np.zeros(count)
    for _ in range(MOST_ROUNDS):
        logs = log_likelihood(places)
        power = _power(logs, log_proposal, 0.3 * count)
        if power == 1:
            break
        weights = _normal(power * logs - log_proposal)
        places, log_proposal = _proposed(places, weights, random)
    return places, logs - log_proposal


def _power(logs: Array, log_proposal: Array, least: float) -> float:
    """Return the largest exponent <= 1 of the likelihood with an effective sample size of at least `least`."""
    def worth(power: float) -> float:
        return float(1 / (_normal(power * logs - log_proposal) ** 2).sum())

    if worth(1) >= least:
        return 1
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if worth(middle) >= least else (low, middle)
    return max(low, 1e-6)


def _normal(log_weights: Array) -> Array:
    weights = np.exp(log_weights - log_weights.max())
    return np.asarray(weights / weights.sum())


def _proposed(places: Array, weights: Array, random: np.random.Generator) -> tuple[Array, Array]:
    """Propose new places and their density: 9 of 10 normal around weighted old ones, 1 of 10 uniform.

    Places outside the cube are redrawn, which raises all densities inside by one factor; it is included.
    """
    count, dimensions = places.shape
    away = places - weights @ places
    factor = np.linalg.cholesky((weights[:, None] * away).T @ away + 1e-12 * np.eye(dimensions))
    centres = places[random.choice(count, CENTRES, p=weights)]
    factor = factor * _width(_squares(np.linalg.solve(factor, centres.T).T), dimensions)
    near: list[Array] = []
    drawn = kept = 0
    wanted = count - count // 10
    while kept < wanted:
        trial = centres[random.integers(CENTRES, size=count)] + random.standard_normal((count, dimensions)) @ factor.T
        inside = trial[((trial >= 0) & (trial <= 1)).all(axis=1)]
        near.append(inside)
        drawn, kept = drawn + count, kept + len(inside)
    new = np.concatenate([np.concatenate(near)[:wanted], random.random((count - wanted, dimensions))])
    squares = _squares(np.linalg.solve(factor, new.T).T, np.linalg.solve(factor, centres.T).T)
    constant = (2 * np.pi) ** (dimensions / 2) * np.prod(np.diag(factor))
    density = np.exp(-0.5 * squares).mean(axis=1) / constant * drawn / kept
    return new, np.log(0.9 * density + 0.1)


def _width(squares: Array, dimensions: int) -> float:
    """Return the kernel width, in standard deviations of all samples, that best predicts each centre from the others.
    Narrow for two clusters or a curved ridge."""
    away = squares > 1e-9  # exclude samples drawn twice

    def told(width: float) -> float:
        density = np.where(away, np.exp(-0.5 * squares / width**2), 0).sum(axis=1) / width**dimensions
        return float(np.log(density + 1e-300).sum())

    return max((0.7 * 0.75**step for step in range(16)), key=told)


def _squares(places: Array, others: Optional[Array] = None) -> Array:
    """Return squared distances between two sets of places, or within one."""
    others = places if others is None else others
    squares = (places**2).sum(axis=1)[:, None] + (others**2).sum(axis=1) - 2 * places @ others.T
    return np.asarray(np.maximum(squares, 0))
