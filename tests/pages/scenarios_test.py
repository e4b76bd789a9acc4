#!/usr/bin/python3
"""Every built-in scenario has a page with its picture in docs/scenarios, and says there what its tests know.

Usage: scenarios_test.py ROOT. What a page states is compared with [expect] of the scenario, which other tests run;
page_test.py compares it with a run.
"""
import sys
import tomllib
from pathlib import Path

from page import stated_numbers

LARGEST_PICTURE = 150_000  # bytes
root = Path(sys.argv[1])
pages = root / "docs/scenarios"
index = (pages / "README.md").read_text(encoding="utf-8")
wrong, compared = [], 0
names = [path.stem for path in sorted((root / "scenarios").glob("*.toml"))]

for name in names:
    page, picture = pages / f"{name}.md", root / f"docs/images/scenarios/{name}.png"
    if not page.is_file():
        wrong.append(f"{name}: there is no {page}")
        continue
    text = page.read_text(encoding="utf-8")
    if f"](../images/scenarios/{name}.png)" not in text or not picture.is_file():
        wrong.append(f"{page}: does not show {picture}")
    elif picture.stat().st_size > LARGEST_PICTURE:
        wrong.append(f"{picture}: has {picture.stat().st_size} bytes, over {LARGEST_PICTURE}")
    for command in (f"plica run {name} --out results/{name}\n", f"plica render results/{name} --out {name}.png"):
        if command not in text:
            wrong.append(f"{page}: lacks the command: {command.strip()}")
    stated = stated_numbers(text)
    for key, expected in tomllib.loads((root / f"scenarios/{name}.toml").read_text(encoding="utf-8"))["expect"].items():
        within = expected.get("within", expected.get("within_percent", 0) / 100 * abs(expected["value"]))
        if key in stated:
            compared += 1
            if any(abs(value - expected["value"]) > within for value in stated[key]):
                wrong.append(f"{page}: says {key} = {stated[key]}; its scenario expects {expected['value']} within {within}")
    row = next((line for line in index.splitlines() if f"]({name}.md)" in line and f"images/scenarios/{name}.png" in line), "")
    shown = [cell.strip() for cell in row.split("|")]
    minutes = stated.get("time_s", stated.get("equilibrium_time_s", (0, 0)))[0] / 60
    if not row or [shown[5], shown[6]] != [f"{minutes:g}", f"{stated['cells'][0]:g}"] or (
            "furrow_depth_um" in stated and float(shown[4]) != stated["furrow_depth_um"][0]):
        wrong.append(f"{pages / 'README.md'}: has no row for {name} with its picture and the numbers of its page")

print(f"Looked at {len(names)} scenarios, compared {compared} numbers with what they expect.")
if not names or not compared:
    wrong.append("nothing was compared: is this the root of plica?")
print("\n".join(wrong))
sys.exit(1 if wrong else 0)
