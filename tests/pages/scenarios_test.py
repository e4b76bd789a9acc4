#!/usr/bin/python3
"""Checks that every built-in scenario has a section in docs/scenarios, with its picture, commands and numbers.

Usage: scenarios_test.py ROOT. What a section states is compared with [expect] of the scenario, which other tests run;
page_test.py compares it with a run.
"""
import re
import sys
import tomllib
from pathlib import Path

from page import scenario_sections, stated_numbers

LARGEST_PICTURE = 150_000  # bytes
PICTURE = re.compile(r'!\[(?P<words>[^\]]*)\]\(\.\./images/scenarios/(?P<file>[\w-]+\.png)\)')
root = Path(sys.argv[1])
folder = root / "docs/scenarios"
index = (folder / "README.md").read_text(encoding="utf-8")
wrong, compared = [], 0
names = [path.stem for path in sorted((root / "scenarios").glob("*.toml"))]
pages = {path: path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.md")) if path.name != "README.md"}
sections = [(page, name, section) for page, text in pages.items() for name, section in scenario_sections(text).items()]


def picture_of(name, section, page_text):
    """File name of the scenario's picture: NAME.png in its section, or one of the page whose alternative text names it."""
    own = [found["file"] for found in PICTURE.finditer(section) if found["file"] == f"{name}.png"]
    shared = [found["file"] for found in PICTURE.finditer(page_text) if f"{name}," in found["words"] + ","]
    return (own + shared + [None])[0]


for page, name, _ in sections:
    if name not in names:
        wrong.append(f"{page}: has a section about {name}, which is not built in")
for name in names:
    found = [(page, section) for page, section_name, section in sections if section_name == name]
    if len(found) != 1:
        wrong.append(f"{name}: {len(found)} sections in {folder} are about it, not one")
        continue
    page, section = found[0]
    picture = picture_of(name, section, pages[page])
    path = root / "docs/images/scenarios" / (picture or f"{name}.png")
    if picture is None or not path.is_file():
        wrong.append(f"{page}: does not show {path}")
    elif path.stat().st_size > LARGEST_PICTURE:
        wrong.append(f"{path}: has {path.stat().st_size} bytes, over {LARGEST_PICTURE}")
    for command in (f"plica run {name} --out results/{name}\n", f"plica render results/{name} --out {name}.png"):
        if command not in section:
            wrong.append(f"{page}: the section about {name} lacks the command: {command.strip()}")
    for heading in ("Results", "Key parameters", "Limitations"):
        if not re.search(rf"^##+ {heading}$", pages[page], re.M):
            wrong.append(f"{page}: has no heading {heading}")
    stated, compared_here = stated_numbers(section), 0
    for key, expected in tomllib.loads((root / f"scenarios/{name}.toml").read_text(encoding="utf-8"))["expect"].items():
        within = expected.get("within", expected.get("within_percent", 0) / 100 * abs(expected["value"]))
        if key in stated:
            compared_here += 1
            if any(abs(value - expected["value"]) > within for value in stated[key]):
                wrong.append(f"{page}: says {key} = {stated[key]} of {name}; it expects {expected['value']} within {within}")
    if not compared_here:
        wrong.append(f"{page}: states no number of {name} that the scenario expects")
    compared += compared_here
    link = re.compile(rf"\]\({re.escape(page.name)}(#{re.escape(name)})?\)")
    rows = [line for line in index.splitlines() if line.startswith("|") and f"[`{name}`]" in line and link.search(line)]
    shown = [cell.strip() for cell in rows[0].split("|")] if rows else []
    minutes = stated.get("time_s", stated.get("equilibrium_time_s", (0, 0)))[0] / 60
    if not rows or f"images/scenarios/{picture}" not in rows[0] or \
            [shown[5], shown[6]] != [f"{minutes:g}", f"{stated.get('cells', (0,))[0]:g}"] or \
            ("furrow_depth_um" in stated and float(shown[4]) != stated["furrow_depth_um"][0]):
        wrong.append(f"{folder / 'README.md'}: has no row for {name} with its picture and the numbers of its section")

print(f"Looked at {len(names)} scenarios, compared {compared} numbers with what they expect.")
if not names or not compared:
    wrong.append("nothing was compared: is this the root of plica?")
print("\n".join(wrong))
sys.exit(1 if wrong else 0)
