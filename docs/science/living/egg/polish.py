"""Polish a fit of the third round by differences of runs, where slopes of one run do not describe its surroundings.

Usage: polish.py HYPOTHESIS FOLDER, where FOLDER is that of fit.py --early. It begins at the best place there. Four directions are changed: three
that the data determine best by the last slopes, and the way to the prior's centre. Differences are those of runs 0.1 away on both sides (norm of
logarithms). Rounds of eight runs and at most three steps follow, until hypotheses.toml calls it converged or ROUNDS are spent. The same
command continues after an interruption. Writes evidence.json.
"""
import json
import sys
import warnings
from pathlib import Path

import numpy as np

import fit
from plica.descent import bounded_step
from plica.fit_problem import Problem, experiments_of

REACH = 0.1  # of differences
FARTHEST = 2.5  # of steps, in reaches
ROUNDS = 2


def directions_of(slopes, away, spread):
    """Four orthogonal directions in standard deviations of the prior (rows)."""
    best = np.linalg.svd(slopes * spread)[2][:3]
    rest = away - best.T @ (best @ away)
    return np.vstack([best, rest / np.linalg.norm(rest)])


def score(residuals):
    return float("inf") if residuals is None else float(residuals @ residuals)


def stepped(problem, place, residuals, slopes, moves):
    """Try the step that differences propose, a half and a quarter of it. Returns place, residuals and what the step promised."""
    step = bounded_step(slopes, residuals, np.full(4, -FARTHEST), np.full(4, FARTHEST), FARTHEST)
    promised = score(residuals) - score(residuals + slopes @ step)
    for part in (1, 0.5, 0.25) if promised >= fit.TOLERANCE else ():
        there = np.clip(place + part * step @ moves, problem.low, problem.high)
        found = problem.residuals(there, None)
        print(f"promised {promised:.2f}, a step by {part:g} gains {score(residuals) - score(found):.2f}", flush=True)
        if score(residuals) - score(found) > 0.25 * fit.TOLERANCE:
            return there, found, promised
    return place, residuals, promised


def main(name, folder):
    tests, bounds, priors = fit.problem_of(name, True)
    problem = Problem(experiments_of(tests, None), bounds, priors, 1)
    problem.keep_in(folder)
    known = [(np.array(place[1:]), run) for place, run in problem.known.items() if run["found"] is not None]
    place = min((place for place, _ in known), key=lambda place: score(problem.residuals(place, None)))
    slopes = np.array([run["slopes"] for _, run in known if run["slopes"] is not None][-1])
    spread = np.array([scale.spread for scale in problem.scales])
    centre = 0.5 * (problem.low + problem.high)
    for count in range(1, ROUNDS + 1):
        directions = directions_of(slopes, (place - centre) / spread, spread)
        moves = np.array([REACH * move / np.linalg.norm(move) for move in directions * spread])
        residuals = problem.residuals(place, None)
        ends = [[problem.residuals(place + side * move, None) for side in (1, -1)] for move in moves]
        differences = np.array([0.5 * (high - low) for high, low in ends]).T
        print(f"round {count}: misfit and prior {score(residuals):.2f}; 0.1 away {[[round(score(one), 1) for one in pair] for pair in ends]}", flush=True)
        moved, found, promised = stepped(problem, place, residuals, differences, moves)
        has_moved = not np.array_equal(moved, place)
        place = moved
        if not has_moved:
            break
    converged = not has_moved and promised < (fit.TOLERANCE if promised < fit.TOLERANCE else fit.KINK)
    lengths = np.linalg.norm(moves / spread, axis=1)  # of moves, in standard deviations of the prior
    count = len(found) - len(priors)
    by_slopes = slopes * spread
    data = by_slopes - by_slopes @ directions.T @ directions + (differences[:count] / lengths) @ directions
    write(name, folder, problem, place, found, data, promised, converged)


def write(name, folder, problem, place, residuals, data, promised, converged):
    """evidence.json, as fit.py writes it: evidence with differences in place of slopes along the four directions."""
    count = len(data)
    prior, misfit = score(residuals[count:]), score(residuals[:count])
    log_det = float(np.linalg.slogdet(np.eye(len(place)) + data.T @ data)[1])
    used = np.linalg.eigvalsh(data.T @ data)
    rows = [(index, row) for index, one in enumerate(problem.experiments) for row in one.rows]
    found = {"hypothesis": name, "misfit": misfit, "prior": prior, "log_det": log_det, "keys": len(place), "keys_used": float((used / (1 + used)).sum()),
             "log_evidence": -0.5 * (misfit + prior + log_det), "promised": promised, "converged": converged, "runs": len(problem.known),
             "end": "polished", "values": problem.values_at(place),
             "targets": [[index, str(getattr(row.outcome, "__name__", row.outcome)), row.at_min, row.value, row.sd, value]
                         for (index, row), value in zip(rows, problem.run(place, None)["found"])]}
    (folder / "evidence.json").write_text(json.dumps(found, indent=1) + "\n")
    print(json.dumps({key: value for key, value in found.items() if key != "targets"}, indent=1))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main(sys.argv[1], Path(sys.argv[2]))
