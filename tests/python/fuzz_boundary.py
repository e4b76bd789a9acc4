#!/usr/bin/env python3
"""Calls the public interface at random, with arguments that fit and with ones that do not: the interpreter must live, and
every refusal must be one of the exceptions that a user is told of.

usage: fuzz_boundary.py [--calls N] [--seed S]. The last calls before an end are told. Best under the address sanitizer
(preset asan with PLICA_WITH_PYTHON).
"""
import argparse
import collections
import contextlib
import copy
import faulthandler
import logging
import os
import pickle
import random
import sys
import tempfile
import traceback
import warnings
from decimal import Decimal
from pathlib import Path

import matplotlib
import numpy as np
import pandas
import plica

# What a user is told of. Everything else, RuntimeError and SystemError before all, is a fault.
REFUSALS = (plica.PlicaError, ValueError, TypeError, KeyError, IndexError)
STRIP = """
[embryo]
shape = "block"
length_um = 60
width_um = 40
cell_height_um = 10
cells = [6, 4, 1]
[region.left]
x_um = [-30, 0]
[contraction.apical]
region = "left"
tension_mN_per_m = 0.5
[cortex.walls]
region = "left"
faces = "lateral"
tension_mN_per_m = 0.2
[dynamics]
surface_drag_Pa_s_per_um = 20
[time]
end_min = 3
"""


class Fuzzer:
    def __init__(self, seed, folder):
        self.random = random.Random(seed)
        self.folder = folder
        self.scenario = plica.Scenario(STRIP)
        self.keys = list(self.scenario.keys())
        self.simulations = [plica.Simulation(self.scenario, threads=1)]
        self.laws = self.simulations[0].laws
        self.count = len(self.simulations[0].pressures)
        self.simulations[0].run(until_min=0.2, out=folder / "run")
        self.runs = [plica.open(folder / "run")]
        self.saved = folder / "saved.h5"
        self.simulations[0].save(self.saved)
        self.study = plica.Study(self.study_source())
        self.study.run(jobs=1)
        self.names = 0

    def pick(self, *choices):
        return self.random.choice(choices)

    def odd(self):
        """A value that fits hardly anywhere."""
        return self.pick(
            None, True, -1, 0, 2**31, 2**63, 2**200, -(2**63), 0.5, float("nan"), float("inf"), -1e308, 5e-324, "", "\0", "x" * 10_000,
            "contraction.", "[", "a=b", "\ud800", "é\n= 1", b"bytes", [], [[]], {}, {"a": {"b": []}}, (), object(), int, len, self, 1j,
            np.nan, np.float32(2), np.array(3), np.zeros((0, 3)), np.zeros((2, 3, 4)), np.full(self.count, np.nan), np.full(self.count, -1.0),
            np.zeros(self.count - 1), np.zeros(self.count, dtype=complex), np.array(["a"] * self.count), np.zeros(self.count, dtype=object),
            np.zeros(2 * self.count)[::2], np.asfortranarray(np.zeros((8, 3))), np.ma.masked_all(self.count), range(5), iter([]), Path("."),
            pandas.DataFrame({"a": [1.0]}), pandas.Series([1, None]), pandas.NA, pandas.array([1, None], dtype="Int64"), pandas.NaT,
            np.bool_(True), np.int64(-5), np.uint64(2**63), np.datetime64("2026"), np.str_("left"), Decimal("1.5"), {1, 2}, memoryview(b"ab"),
            np.recarray((2,), dtype=[("a", float)]), float("-inf"), slice(None), Ellipsis, NotImplemented, range(self.count),
            Path("no/such/folder"), self.folder / "run/series.csv", self.scenario, self.simulations[0], self.runs[0],
        )

    def or_odd(self, fitting):
        """What fits, mostly."""
        return self.odd() if self.random.random() < 0.35 else fitting()

    # What fits

    def law(self):
        return self.pick("apical", "contraction.apical", *self.laws)

    def activity(self):
        return self.pick(None, 0, 1.5, np.random.default_rng(self.random.randrange(2**32)).random(self.count) * 2,
                         [1.0] * self.count, np.full(self.count, np.nan))

    def key(self):
        return self.pick(*self.keys)

    def new_path(self):
        self.names += 1
        return self.folder / f"new{self.names}"

    def tissue(self):
        x, y, z = np.meshgrid([0, 10, 20, 30], [0, 10], [0, 10], indexing="ij")
        number = np.arange(16).reshape(4, 2, 2)
        corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        cells = np.array([[number[i + a, b, c] for a, b, c in corners] for i in range(3)])
        points = np.column_stack([x.ravel(), y.ravel(), z.ravel()]).astype(float)
        if self.random.random() < 0.3:
            cells.flat[self.random.randrange(cells.size)] = self.random.randrange(16)
        if self.random.random() < 0.3:
            points.flat[self.random.randrange(points.size)] = self.pick(0.0, 1e300, -5.0)
        return plica.Tissue(self.or_odd(lambda: points), self.or_odd(lambda: cells), apical_faces=self.or_odd(lambda: [5, 5, 5]),
                            regions=self.pick(None, {"left": [True, False, False]}, {"left": [1, 0, 0]}, {"all": np.ones(3, bool)}))

    def toml(self):
        """A scenario's text, cut or stirred."""
        text = STRIP if self.random.random() < 0.5 else self.scenario.to_toml()
        for _ in range(self.random.randrange(3)):
            at = self.random.randrange(len(text))
            text = self.pick(text[:at] + "\n", text[:at] + self.pick("=", "[", '"', "9", "-", "\0", "é") + text[at + 1:])
        return text

    # Calls, one at a time

    def call(self):
        simulation, run = self.pick(*self.simulations), self.pick(*self.runs)
        few = lambda sim, step: self.pick(False, False, False, True)  # noqa: E731
        calls = [
            lambda: plica.Scenario(self.or_odd(self.toml)),
            lambda: plica.Scenario(self.or_odd(lambda: {"base": "division-demo", "time": {"end_min": self.odd()}})),
            lambda: self.change(),
            lambda: self.scenario[self.or_odd(self.key)],
            lambda: self.or_odd(self.key) in self.scenario,
            lambda: self.scenario.copy().set_region(self.or_odd(lambda: "left"), self.or_odd(lambda: np.arange(self.count) < 3)),
            lambda: self.scenario.diff(self.or_odd(lambda: self.scenario.copy())),
            lambda: (self.scenario == self.odd(), repr(self.scenario), self.scenario._repr_html_(), self.scenario.advice()),
            lambda: pickle.loads(pickle.dumps(self.scenario)),
            lambda: plica.Simulation(plica.Scenario(STRIP, tissue=self.tissue()), threads=1),
            lambda: plica.Scenario(self.or_odd(lambda: STRIP), tissue=self.or_odd(self.tissue)),
            lambda: self.keep(plica.Simulation(self.or_odd(lambda: self.scenario), threads=self.or_odd(lambda: self.pick(None, 1, 2)))),
            lambda: self.keep(simulation.copy()),
            lambda: self.keep(copy.deepcopy(simulation)),
            lambda: self.keep(pickle.loads(pickle.dumps(simulation))),
            lambda: simulation.step(),
            lambda: simulation.step(until_min=self.or_odd(lambda: simulation.time_min + 0.05)),
            lambda: simulation.run(until_min=self.or_odd(lambda: simulation.time_min + 0.05), callback=self.or_odd(lambda: few)),
            lambda: self.record(simulation, few),
            lambda: simulation.set_activity(self.or_odd(self.law), self.or_odd(self.activity)),
            lambda: simulation.activity(self.or_odd(self.law)),
            lambda: simulation.set_wall_factors(self.or_odd(lambda: "walls"), self.or_odd(lambda: simulation.walls["length_um"])),
            lambda: simulation.wall_factors(self.or_odd(lambda: "walls")),
            lambda: simulation.forces(self.or_odd(self.law)),
            lambda: simulation.save(self.or_odd(self.new_path)),
            lambda: self.keep(plica.load(self.or_odd(lambda: self.saved), threads=self.or_odd(lambda: 1))),
            lambda: self.keep(plica.load(self.damaged())),
            lambda: (repr(simulation), simulation._repr_html_(), simulation.measures, simulation.energies, simulation.neighbours),
            lambda: (simulation.positions, simulation.cell_data, simulation.regions, simulation.hexahedron_cell, simulation.scenario),
            lambda: self.overwrite(simulation),
            lambda: simulation.positions.__setitem__(0, 1),
            lambda: plica.open(self.or_odd(lambda: self.folder / "run")),
            lambda: (run.series, run.midline, run.summary, run.status, run.scenario, repr(run), run._repr_html_()),
            lambda: run.frames[self.or_odd(lambda: -1)],
            lambda: run.frames.at(self.or_odd(lambda: 0.1)),
            lambda: plica.compare(self.or_odd(lambda: run), self.or_odd(lambda: run), time_min=self.or_odd(lambda: None)).nodes,
            lambda: plica.calibrate(self.or_odd(lambda: self.scenario), self.or_odd(lambda: {self.key(): self.pick((1, 2), (2, 1), (0, 0), 3, "ab")}),
                                    self.or_odd(lambda: {self.pick("steps", "furrow_depth_um", ""): self.pick((5, 1), (1, 0), None)}),
                                    most_trials=self.pick(1, 2, 0, -1)),
            lambda: plica.builtin_scenarios(),
            *self.calls_with_arrays(simulation), *self.calls_of_studies(), *self.calls_of_results(run, simulation),
        ]
        self.random.choice(calls)()

    def overwrite(self, simulation):
        with contextlib.suppress(AttributeError):  # what Python says of attributes that cannot be set
            setattr(simulation, self.pick("positions", "time_s", "status"), self.odd())

    def calls_with_arrays(self, simulation):
        return [
            lambda: simulation.cell_data.__setitem__(self.or_odd(lambda: "signal"), self.or_odd(lambda: np.arange(self.count))),
            lambda: simulation.cell_data.update(self.or_odd(lambda: {"signal": self.odd()})),
            lambda: simulation.cell_data.__ior__(self.or_odd(lambda: {"signal": 2.0})),
            lambda: simulation.cell_data.pop(self.odd()),
            lambda: self.scenario.copy().set_array(self.or_odd(lambda: "myosin"), self.or_odd(lambda: np.arange(self.count))),
            lambda: plica.Scenario(STRIP, arrays=self.or_odd(lambda: {"myosin": self.odd()})),
            lambda: plica.load(self.saved, tissue=self.odd(), arrays=self.odd()),
            lambda: plica.Polygons(self.or_odd(lambda: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]), self.or_odd(lambda: [[0, 1, 2]]),
                                   self.or_odd(lambda: {"a": [1]})),
            lambda: plica.polygons_of_labels(self.or_odd(lambda: np.arange(16).reshape(4, 4)), self.or_odd(lambda: 1.0),
                                             gap_px=self.or_odd(lambda: 2)),
            lambda: plica.polygons_of_outlines(self.or_odd(lambda: [[[0, 0], [1, 0], [0, 1]]]), self.odd(), tolerance_um=self.odd()),
            lambda: plica.polygons_of_centres(self.or_odd(lambda: np.arange(18).reshape(9, 2) ** 2 % 7), reach_um=self.odd(), cell_data=self.odd()),
            lambda: plica.polygons_of_monolayer(self.odd()),
            lambda: plica.Tissue.from_file(self.odd(), apical_array=self.odd()),
        ]

    def study_source(self):
        return {"scenario": "division-demo", "set": {"time.end_min": 0.05}, "vary": {"elasticity.young_modulus_Pa": {"values": [500, 1000]}},
                "design": {"kind": self.pick("grid", "one-at-a-time")}, "keep": {"measures": ["max_displacement_um"]}}

    def calls_of_studies(self):
        study = self.study
        return [
            lambda: plica.Study(self.or_odd(lambda: {**self.study_source(), self.pick("vary", "set", "design", "keep", "x"): self.odd()})),
            lambda: study.run(jobs=self.or_odd(lambda: 1), out=self.or_odd(lambda: None), executor=self.pick(None, None, self.odd()),
                              overwrite=self.odd(), resume=self.odd()),
            lambda: (study.table, study.points, study.measures, len(study), repr(study)),
            lambda: study.curves(self.or_odd(lambda: "max_displacement_um")),
            lambda: study.phase_diagram(self.odd(), self.odd(), measure=self.odd(), at=self.odd(), thumbnails=self.odd(), view=self.odd()),
            lambda: study.sobol_indices(self.odd(), confidence=self.odd(), resamples=self.odd(), seed=self.odd()),
            lambda: study.emulator(self.odd(), folds=self.odd(), seed=self.odd()),
            lambda: plica.verdict(self.or_odd(lambda: {"status": self.odd(), "self_intersections": self.odd(), "lips_closed_time_s": None,
                                                       "furrow_depth_below_lips_um": self.odd(), "furrow_depth_um": self.odd()})),
            lambda: plica.posterior(self.or_odd(lambda: study), keys=self.odd(), targets=self.or_odd(lambda: {"max_displacement_um": self.odd()}),
                                    on=self.odd(), runs=self.odd(), samples=self.odd(), seed=self.odd(), jobs=self.odd()),
            lambda: plica.reproduce(self.odd(), self.odd(), jobs=self.odd()),
        ]

    def calls_of_results(self, run, simulation):
        return [
            lambda: plica.render(self.or_odd(lambda: self.pick(run, simulation, run.frames[-1])), self.odd(), color=self.or_odd(lambda: "region"), view=self.odd(), time_min=self.odd(),
                                 at_x_um=self.odd(), strip=self.odd(), limits=self.odd(), size=self.odd()),
            lambda: plica.movie(self.odd(), self.or_odd(lambda: "fold.gif"), frames_per_s=self.odd(), color=self.odd(), size=self.odd()),
            lambda: run.plot(self.or_odd(lambda: "furrow_depth_um"), ax=self.odd()),
            lambda: run.show(self.odd()),
            lambda: run.frames[-1].polygons(self.odd()),
            lambda: run.frames[-1].polygons().write(self.or_odd(self.new_path)),
            lambda: str(plica.compare(run, self.or_odd(lambda: run), time_min=self.odd())),
        ]

    def keep(self, simulation):
        self.simulations.append(simulation)
        if len(self.simulations) > 6:
            del self.simulations[self.random.randrange(1, len(self.simulations))]

    def change(self):
        """A key gets another value; now and then the result becomes the scenario of later calls."""
        other = self.scenario.copy()
        changes = {self.or_odd(self.key): self.or_odd(lambda: self.pick(0, 1, 0.3, 2, -1, "all", "left", True, [6, 4, 1], [1, 2])) for _ in range(self.pick(1, 2))}
        other.update(changes)
        self.keep(plica.Simulation(other, threads=1))

    def record(self, simulation, few):
        run = simulation.run(until_min=simulation.time_min + 0.02, out=self.or_odd(self.new_path), overwrite=self.pick(False, True),
                             resume=self.pick(False, True, self.odd()), callback=few)
        if run is not None:
            self.runs = self.runs[:3] + [run]

    def damaged(self):
        content = bytearray(self.saved.read_bytes())
        for _ in range(self.random.randrange(1, 4)):
            content[self.random.randrange(len(content))] = self.random.randrange(256)
        path = self.folder / "damaged.h5"
        path.write_bytes(content[: self.pick(len(content), self.random.randrange(len(content)))])
        return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calls", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    faulthandler.enable()
    matplotlib.use("Agg")
    warnings.simplefilter("ignore")
    logging.getLogger("plica").disabled = True
    ends = collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        fuzzer = Fuzzer(chosen.seed, Path(folder))
        for number in range(chosen.calls):
            try:
                fuzzer.call()
                ends["done"] += 1
            except REFUSALS as refusal:
                ends[type(refusal).__name__] += 1
            except MemoryError:
                ends["MemoryError"] += 1
            except Exception:
                traceback.print_exc()
                sys.exit(f"call {number} of seed {chosen.seed} ended in no exception that a user is told of")
    told = ", ".join(f"{count} {name}" for name, count in ends.most_common())
    print(f"{chosen.calls} calls: {told}")


if __name__ == "__main__":
    main()
