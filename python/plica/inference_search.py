"""Search for the log factors of cells that explain shapes (inference.py): L-BFGS, or Gauss-Newton steps where factors are many.

The misfit's Hessian is nearly diagonal in the coefficients of fields (inference_problem.py), and a smooth function of the eigenvalue:
L-BFGS starts from this diagonal, and so takes few runs. It learns one direction per run, though. Beyond some hundred factors, each
step solves (weight SᵀS + precision) step = -gradient, S being the derivatives of residuals, by conjugate gradients with this diagonal as
preconditioner. Products with S and Sᵀ are a tangent and an adjoint of one recorded run in long steps, which costs a fraction of a run:
errors of some percent in S change the step, not where the search ends. Such steps keep nothing from earlier ones, so an
interrupted search continues bitwise.

Gradients g of sums of residuals with random weights have the mean of g gᵀ equal to the Gauss-Newton Hessian. A few of them give its
diagonal, averaged over bands of eigenvectors, and its differences from cell to cell, averaged over neighbours. From this follows the
weight of the prior, by its evidence (MacKay 1992).
"""
from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from .errors import NumericsError
from .fit_problem import largest_by_chance
from .inference_problem import Problem

Array = NDArray[np.float64]
FIRST_SPREAD = 0.3  # prior standard deviation of log factors
SPREADS = (0.03, 1.5)  # bounds of it
LARGEST_CHANGE = 0.7  # of a log factor in one iteration
CONVERGED = 0.003  # mean squared distance from the minimum, in units of posterior variances; an estimate, low by up to a factor of 5
CONVERGED_EARLY = 0.5  # the same while later shapes are not compared yet
SLOW, SLOW_AFTER = 0.03, 5  # relative decrease of an iteration, after some, at which weights are adapted
SLOW_EARLY = 0.1  # the same at which the next shape is compared, too
MOST_ADAPTED = 20  # times that weights are adapted at one point
TINY = float(np.finfo(float).tiny)
SEARCH_PROBES = 6  # gradients for the curvature, by default
MOST_WHOLE = 200  # coefficients, up to which the whole Hessian is computed by default
LEFT, MOST_PRODUCTS = 0.1, 30  # part of the residual at which conjugate gradients end, and products until then
NOISE_ERROR = 0.1  # relative, of the noise that is given, up to which no model is said to be wrong


class Search:
    """Iterations of weight * misfit / 2 + sum(precision * v**2) / 2, weights of which may change in between: by L-BFGS, or by
    Gauss-Newton steps where factors are many."""

    def __init__(self, problem: Problem, spread: Optional[float], probes: Optional[int]) -> None:
        self.problem, self.given_spread, self.given_probes = problem, spread, probes
        self.v: Array = np.zeros(sum(len(field.acting) for field in problem.fields))
        self.spreads: Array = np.full(len(problem.fields), FIRST_SPREAD if spread is None else spread)
        self.weight = 1.0  # of the misfit; below 1 where it exceeds the noise
        self.times = 0
        self.is_large = len(self.v) > MOST_WHOLE
        self.converged = self._is_slow = self._is_limited = False

    def begin(self, times: int) -> None:
        """Compare the first targets, from the present point."""
        self.times = times
        self.steps: list[Array] = []
        self.changes: list[Array] = []  # of the gradient of half the misfit
        self.tape = self.problem.run(self.v, times)
        self.misfits = self.problem.misfits(self.tape, times)
        self.slope = self.problem.gradient(self.tape, self.v, times)
        self.linearise()

    def linearise(self, coarsely: bool = True) -> None:
        """Renew the derivatives of residuals, where factors are many by a run in longer steps."""
        self.linear = self.tape
        if self.is_large and coarsely:
            try:
                self.linear = self.problem.run_coarsely(self.v, self.times)
            except NumericsError:
                pass
        self.probe()
        self._direction: Optional[Array] = None

    def probe(self) -> None:
        """Estimate the Gauss-Newton Hessian of half the misfit at the present point."""
        rng = np.random.default_rng(0)
        probes = [self.problem.probe(self.linear, self.v, self.times, rng) for _ in range(self.given_probes or SEARCH_PROBES)]
        fields, by_law = self.problem.fields, [np.array(ones).T for ones in zip(*probes)]
        self.curvature = np.concatenate([  # diagonal in coefficients
            field.band_means(((field.vectors.T @ g) ** 2).mean(axis=1)) for field, g in zip(fields, by_law)])
        # How well each cell is seen, and the diagonal if all were seen equally.
        self.seen = [np.sqrt(np.maximum(field.near_means((g**2).mean(axis=1)), TINY)) for field, g in zip(fields, by_law)]
        self.equal_curvature = [field.band_means(((field.vectors.T @ (g / seen[:, None])) ** 2).mean(axis=1))
                                for field, g, seen in zip(fields, by_law, self.seen)]

    @property
    def precision(self) -> Array:
        return self.problem.precision(self.spreads)

    def value(self, v: Array, misfits: Array) -> float:
        return 0.5 * self.weight * float(misfits.sum()) + 0.5 * float(self.precision @ v**2)

    @property
    def gradient(self) -> Array:
        return self.weight * self.slope + self.precision * self.v

    @property
    def direction(self) -> Array:
        if self._direction is None:
            self._direction = -(self.newton if self.is_large else self.inverse_hessian)(self.gradient)
        return self._direction

    @property
    def distance(self) -> float:
        """Estimated mean squared distance from the minimum, in units of posterior variances."""
        return -float(self.gradient @ self.direction) / len(self.v)

    def step(self) -> bool:
        """Take one iteration. Returns whether it decreased the objective."""
        gradient, value, direction = self.gradient, self.value(self.v, self.misfits), self.direction
        largest = max(np.abs(log).max() for log in self.problem.logs(direction))
        length = min(1.0, LARGEST_CHANGE / largest)
        self._is_limited = length < 1
        downhill = float(gradient @ direction)
        for _ in range(6):
            v = self.v + length * direction
            new_value = math.inf
            try:
                tape = self.problem.run(v, self.times)
                misfits = self.problem.misfits(tape, self.times)
                new_value = self.value(v, misfits)
            except NumericsError:
                pass
            if new_value <= value + 1e-4 * length * downhill:
                self.tape = tape
                self._accept(v, misfits, self.problem.gradient(tape, v, self.times))
                return True
            # Minimum of a parabola through the values and the slope.
            shorter = -0.5 * downhill * length**2 / (new_value - value - downhill * length)
            length = min(max(shorter, 0.1 * length), 0.5 * length)
        return False

    def _accept(self, v: Array, misfits: Array, slope: Array) -> None:
        step, change = v - self.v, slope - self.slope
        self.v, self.misfits, self.slope, self._direction = v, misfits, slope, None
        if self.is_large:
            self.linearise()
            return
        self.linear = self.tape
        if step @ (self.weight * change + self.precision * step) > 0:
            self.steps.append(step)
            self.changes.append(change)

    def newton(self, q: Array) -> Array:
        """Apply the inverse of the Gauss-Newton Hessian by conjugate gradients, preconditioned by its diagonal."""
        precision = self.precision
        diagonal = self.weight * self.curvature + precision
        found, left = np.zeros_like(q), q.copy()
        first = rest = float(left @ (left / diagonal))
        along = left / diagonal
        for _ in range(MOST_PRODUCTS):
            if rest <= LEFT**2 * first:
                break
            product = self.weight * self.problem.product(self.linear, self.v, along, self.times) + precision * along
            length = rest / float(along @ product)
            found += length * along
            left -= length * product
            before, rest = rest, float(left @ (left / diagonal))
            along = left / diagonal + rest / before * along
        return found

    def inverse_hessian(self, q: Array) -> Array:
        """Apply the L-BFGS approximation of the inverse Hessian."""
        q, precision, weights = q.copy(), self.precision, []
        pairs = [(s, self.weight * y + precision * s) for s, y in zip(self.steps, self.changes)]
        pairs = [(s, y) for s, y in pairs if s @ y > 0]
        for s, y in reversed(pairs):
            weights.append((s @ q) / (s @ y))
            q -= weights[-1] * y
        q /= self.weight * self.curvature + precision
        for (s, y), weight in zip(pairs, reversed(weights)):
            q += (weight - (y @ q) / (s @ y)) * s
        return q

    def known(self) -> list[Array]:
        """Return by law how far each coefficient is known from the targets: 0 not at all, 1 from them only."""
        curvature = self.weight * self.curvature
        return self.problem.by_law(curvature / (curvature + self.precision))

    @property
    def free(self) -> float:
        """Residuals minus coefficients that they determine: expected sum of squares where the model explains the shapes."""
        return max(float(self.problem.counts(self.times).sum()) - sum(float(of_law.sum()) for of_law in self.known()), 1.0)

    @property
    def is_missed(self) -> bool:
        """Whether residuals exceed the noise by more than its error and chance."""
        return float(self.misfits.sum()) > (1 + NOISE_ERROR) ** 2 * largest_by_chance(self.free)

    def adapt(self) -> bool:
        """Set the prior's spread by its evidence, and the misfit's weight if it exceeds the noise. Returns whether they changed."""
        known, free = self.known(), self.free
        before = np.append(self.spreads, self.weight**-0.5)
        if self.given_spread is None:
            for k, (field, v, of_law) in enumerate(zip(self.problem.fields, self.problem.by_law(self.v), known)):
                varied = ~field.is_common
                if of_law[varied].sum() > 0:
                    spread = math.sqrt(float(field.unit_precision[varied] @ v[varied]**2) / float(of_law[varied].sum()))
                    self.spreads[k] = min(max(spread, SPREADS[0]), SPREADS[1])
        self.weight = min(1.0, free / max(float(self.misfits.sum()), TINY))
        self._direction = None
        return bool(np.abs(np.log(np.append(self.spreads, self.weight**-0.5) / before)).max() > 0.1)

    def fit(self, most_runs: int, after_step: Callable[[], None]) -> None:
        """Iterate to the minimum: first for the first time alone, then with the next one, and so on."""
        last = len(self.problem.times_min)
        for times in range(max(self.times, 1), last + 1):
            self.begin(times)
            adapted = 0  # times since the last step
            while self.problem.runs < most_runs:
                distance, value = self.distance, self.value(self.v, self.misfits)
                if times < last and (distance < CONVERGED_EARLY or self._is_slow):
                    self._is_slow = False
                    break
                if times == last and (distance < CONVERGED or self._is_slow):
                    self._is_slow = False
                    self.converged = (not self.adapt() or adapted == MOST_ADAPTED) and distance < CONVERGED
                    if self.converged:
                        break
                    adapted += 1
                    continue
                if not self.step():
                    if self.linear is self.tape:
                        break
                    self.linearise(coarsely=False)
                    continue
                adapted = 0
                slow, after = (SLOW, SLOW_AFTER) if times == last else (SLOW_EARLY, 1)
                self._is_slow = (not self._is_limited and (self.is_large or len(self.steps) > after)
                                 and self.value(self.v, self.misfits) > (1 - slow) * value)
                after_step()

    def curvatures(self) -> list[tuple[slice, Array]]:
        """Return the Gauss-Newton Hessian of half the misfit by log factors at the present point: whole, or in blocks of laws."""
        if self.given_probes is None and len(self.v) <= MOST_WHOLE:
            return [(slice(None), self.problem.curvature(self.tape, self.v, self.times))]
        self.probe()
        blocks, first = [], 0
        for field, curvature, seen in zip(self.problem.fields, self.equal_curvature, self.seen):
            law = slice(first, first := first + len(field.acting))
            blocks.append((law, (field.vectors * curvature) @ field.vectors.T * np.outer(seen, seen)))
        return blocks

    def state(self) -> dict[str, Any]:
        """Return what a later session continues from."""
        return {"v": self.v, "logs": np.concatenate(self.problem.logs(self.v)), "spreads": self.spreads, "weight": self.weight,
                "times": self.times, "is_slow": self._is_slow, "runs": self.problem.runs}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.v, logs = np.array(state["v"]), np.array(state["logs"])
        # Eigenvectors of equal eigenvalues may be others on another machine; then the factors count.
        if not np.allclose(np.concatenate(self.problem.logs(self.v)), logs, rtol=0, atol=1e-9):
            self.v = np.concatenate([field.vectors.T @ part for field, part in zip(self.problem.fields, self.problem.by_law(logs))])
        self.spreads, self.weight = np.array(state["spreads"]), float(state["weight"])
        self.times, self.problem.runs, self._is_slow = int(state["times"]), int(state["runs"]), bool(state["is_slow"])
