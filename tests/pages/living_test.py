"""The scripts of docs/science/living, on studies that are much smaller than those of docs/science/living-embryo.md. Needs the Python package."""
import csv
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

import plica

ROOT = Path(__file__).resolve().parents[2]
LIVING = ROOT / "docs/science/living"


def run(script, *arguments):
    done = subprocess.run([sys.executable, LIVING / script, *arguments], capture_output=True, text=True, cwd=ROOT, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{script}: {done.stdout}{done.stderr}")
    return done.stdout


class Living(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="plica_living_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def study(self, name, out, **design):
        """Run the study of that file with another design."""
        with (LIVING / name).open("rb") as file:
            study = tomllib.load(file)
        study["scenario"] = str(LIVING / study["scenario"])
        study["design"].update(design)
        plica.Study(study).run(out=self.folder / out, jobs=2)
        return self.folder / out

    def test_draws_from_the_posterior_are_frozen(self):
        slices, drawn = self.study("posterior.toml", "posterior", points=80), self.folder / "draws50.csv"
        self.assertIn("of the prior's: ", run("posterior.py", slices, drawn))
        lines = drawn.read_text().splitlines()
        self.assertEqual(len(lines), 1 + 50)
        drawn.write_text("\n".join(lines[: 1 + 20]) + "\n")
        # Slices stand for embryos, which take half a minute each: they differ from themselves by nothing.
        with (LIVING / "slow-start.toml").open("rb") as file:
            keep = tomllib.load(file)["keep"]
        plica.Study({"format": 1, "scenario": str(LIVING / "chosen.toml"), "design": {"kind": "file", "file": str(drawn)},
                     "keep": {"measures": [*keep["measures"], "closed_length_ratio", "self_intersections"]}}).run(
                         out=self.folder / "confirm", jobs=2)
        frozen = self.folder / "draws.csv"
        text = run("freeze.py", slices, self.folder / "confirm", frozen)
        self.assertIn("deeper than its slice by 0.0 ± ", text.replace("-0.0", "0.0"))
        self.assertIn("Close: 20 of 20; pass through themselves: 0;", text)
        with frozen.open(newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(len(rows), 1 + 10)
        with (ROOT / "scenarios/living/draws.csv").open(newline="") as file:
            self.assertEqual(rows[0], next(csv.reader(file)))

    def test_slices_are_lit_and_made_embryos(self):
        for name in ("clock", "floor", "own"):
            self.study(f"fit-{name}.toml", name, points=10)
        self.assertIn("inhibited from 8 min on: ", run("light.py", self.folder / "floor", "--best", "1"))
        text = run("straight.py", self.folder, self.folder / "short", self.folder / "straight.png", "--best", "1")
        self.assertEqual(text.count("end_time"), 3, text)
        self.assertGreater((self.folder / "straight.png").stat().st_size, 10_000)

    def test_a_wound_recoils(self):
        self.assertIn("µm wider (its sides recoil)", run("wound.py"))

    def test_tables_of_the_four_hypotheses_are_those_of_their_results(self):
        run("egg/paper.py", "--check")

    def test_outcomes_of_the_egg_have_gradients(self):
        self.assertIn("round.obj: 2392 cells", run("egg/mesh.py", self.folder))
        sys.path.insert(0, str(LIVING / "egg"))
        import fit
        for hypothesis in fit.PLAN["hypothesis"]:
            scenario, bounds = fit.scenario_of(hypothesis)
            self.assertTrue(all(low < scenario[key] < high for key, (low, high) in bounds.items()), hypothesis)
        scenario["embryo.file"] = str(self.folder / "round.obj")
        egg = fit.Egg(scenario)
        self.assertAlmostEqual(egg.section, np.pi * (90**2 - 55**2) / 3, delta=0.003 * egg.section)
        rng = np.random.default_rng(1)
        places = egg.rest + 0.3 * rng.standard_normal(egg.rest.shape)
        change = rng.standard_normal(egg.rest.shape)
        for outcome in (egg.height, egg.flank):
            ends = [outcome(places + side * 1e-5 * change)[0] for side in (1, -1)]
            slope = (outcome(places)[1] * change).sum()
            self.assertAlmostEqual((ends[0] - ends[1]) / 2e-5, slope, delta=1e-6 * abs(slope))


if __name__ == "__main__":
    unittest.main()
