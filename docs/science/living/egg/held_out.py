"""Run the held-out tests of experiments.toml with the fitted set of one hypothesis.

Usage: held_out.py FITTED OUT, where FITTED is the folder that fit.py wrote. OUT gets set.toml, experiments.toml and, in `runs`, what
`plica reproduce` writes; the same command continues after an interruption. Prints the table of outcomes.
"""
import csv
import json
import subprocess
import sys
from pathlib import Path

import fit

fitted, out = Path(sys.argv[1]), Path(sys.argv[2])
found = json.loads((fitted / "evidence.json").read_text())
scenario, _ = fit.scenario_of(found["hypothesis"])
scenario.update(found["values"])
out.mkdir(parents=True, exist_ok=True)
text = (fit.HERE / "experiments.toml").read_text().replace('scenario = "egg.toml"', 'scenario = "set.toml"')
for file, content in (("set.toml", scenario.to_toml()), ("experiments.toml", text.replace('"round.obj"', json.dumps(str(fit.HERE / "round.obj"))))):
    if not (out / file).exists():
        (out / file).write_text(content)
subprocess.run(["plica", "reproduce", out / "experiments.toml", "--out", out / "runs", "--jobs", "1"], check=False)
for row in csv.DictReader((out / "runs/experiments.csv").open()):
    print(f"{row['experiment']:12} {row['outcome']:12} {row['number']:>12} {row['judgement']}")
