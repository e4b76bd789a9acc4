#!/usr/bin/python3
"""Checks the layout of the sources: includes, VTK's place, headers, file lengths, theory pages, links, version and authors.

Usage: layout_test.py ROOT [PLICA]; with the program, docs/reference/scenario.md and the end of docs/reference/measures.md are compared with
what `plica reference` prints, and docs/reference/cli.md with the help of the commands.
Prints what it counted; on a breach, a line each, and exit status 1.
"""
import re
import subprocess
import sys
import tomllib
from pathlib import Path

# A folder of src/ includes itself and the folders before it.
FOLDERS = ("core", "tissue", "mechanics", "solver", "measure", "scenario", "simulation", "record", "show", "study",
           "experiments", "app")
# Inside solver/, too, a folder includes itself and those before it.
ROOMS_OF_SOLVER = ("algebra", "multigrid", "linear", "step", "projection", "sensitivity")
MOST_LINES = 500
# Headers of src/mechanics that define no law, beside those of kernels/.
NOT_A_LAW = {"law", "law_activity", "law_change", "law_memory", "step", "cells_apart", "derivatives", "internal_change", "constraint", "obstacle", "model", "program", "turning_elements", "cell_pattern", "reaction", "signal_parts", "shape_activation", "followed_signal", "wall_factors", "fibres", "local_energy",
             "hexahedron_stiffness", "element_values", "contact_pair", "edge_pairs", "nonconforming_edges", "model_memory"}
MEASURES_MARK = "<!-- Below: what plica reference --measures prints. -->\n"
UNIT_AT_END = re.compile(r"_(um|um2|um3|s|um_per_s|per_um|nN|nN_um|deg|Pa|ratio|error)$")
MARKDOWN_LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')

root = Path(sys.argv[1]).resolve()
program = sys.argv[2] if len(sys.argv) > 2 else None
breaches, counts = [], {}


def breach(path, text, line=None):
    place = path.relative_to(root) if path.is_absolute() else path
    breaches.append(f"{place}:{line}: {text}" if line else f"{place}: {text}")


def count(what, number=1):
    counts[what] = counts.get(what, 0) + number


def lines_of(path):
    return path.read_text(encoding="utf-8").splitlines()


def files(folder, *suffixes):
    return sorted(p for p in (root / folder).rglob("*") if p.is_file() and p.suffix in suffixes)


def rank_in_solver(room):
    return ROOMS_OF_SOLVER.index(room) if room in ROOMS_OF_SOLVER else len(ROOMS_OF_SOLVER)  # files beside the rooms


def check_includes():
    """Includes run one way; VTK only in files named *_vtk.cpp."""
    for path in files("src", ".hpp", ".cpp"):
        folder = path.relative_to(root / "src").parts[0]
        if folder not in FOLDERS:
            breach(path, f"is in no known folder of src/; there are {', '.join(FOLDERS)}")
            continue
        for number, text in enumerate(lines_of(path), 1):
            found = INCLUDE.match(text)
            if not found:
                continue
            count("includes")
            quoted, name = found.group(1) == '"', found.group(2)
            other = name.split("/")[0]
            if quoted and not (root / "src" / name).is_file():
                breach(path, f"includes {name}, which is not in src/; paths are from src/", number)
            elif quoted and FOLDERS.index(other) > FOLDERS.index(folder):
                breach(path, f"{folder} may not include {other}: {other} comes after it", number)
            elif quoted and folder == other == "solver":
                room, other_room = path.relative_to(root / "src").parts[1], name.split("/")[1]
                if rank_in_solver(other_room) > rank_in_solver(room):
                    breach(path, f"solver/{room} may not include {name}: {other_room} comes after it", number)
            if (other.startswith("vtk") or name.endswith("_vtk.hpp")) and not path.stem.endswith("_vtk"):
                breach(path, f"includes {name}: VTK is for files named *_vtk.cpp", number)


def check_headers():
    for folder in ("src", "tests", "bench"):
        for path in files(folder, ".hpp"):
            count("headers")
            text = lines_of(path)
            if not text or not text[0].startswith("// "):
                breach(path, "does not begin with a comment on its purpose", 1)
            if "#pragma once" not in text:
                breach(path, "has no #pragma once")


def check_lengths():
    for folder in ("src", "tests", "bench", "tools"):
        for path in files(folder, ".hpp", ".cpp", ".py", ".sh"):
            count("source files")
            length = len(lines_of(path))
            if length > MOST_LINES:
                breach(path, f"has {length} lines, over {MOST_LINES}: which two files is it?")


def check_laws():
    """One law: one header, one source, one theory page, one test."""
    for path in files("src/mechanics", ".hpp"):
        if path.stem in NOT_A_LAW or path.parent.name == "kernels":
            continue
        count("laws")
        place = path.relative_to(root / "src").with_suffix("")
        for companion in (f"src/{place}.cpp", f"docs/theory/{path.stem}.md", f"tests/{place}_test.cpp"):
            if not (root / companion).is_file():
                breach(path, f"has no {companion}")


def check_links():
    for path in sorted(root.glob("*.md")) + files("docs", ".md"):
        count("pages")
        in_code = False
        for number, text in enumerate(lines_of(path), 1):
            in_code ^= text.lstrip().startswith("```")
            if in_code:
                continue
            for target in MARKDOWN_LINK.findall(text):
                if re.match(r"[a-z]+:", target) or target.startswith("#"):
                    continue
                count("links")
                if not (path.parent / target.split("#")[0]).exists():
                    breach(path, f"links to {target}, which is not there", number)
    if not (root / "README.md").is_file():
        breach(root / "README.md", "is missing")


def check_release():
    """Files that name the version and the authors agree."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    author = ", ".join(one["name"] for one in project["authors"])
    for name, pattern, expected in (
            ("CMakeLists.txt", r"^project\(plica VERSION ([\d.]+)", project["version"]),
            ("CITATION.cff", r"^version: (.+)$", project["version"]),
            ("CITATION.cff", r"^authors:\n  - name: (.+)$", author),
            ("CITATION.cff", r"^abstract: (.+)\.$", project["description"]),
            ("CHANGELOG.md", r"^## (\S+)", project["version"]),
            ("packaging/conda/recipe.yaml", r'^  version: "(.+)"$', project["version"]),
            ("cmake/package.cmake", r'CPACK_PACKAGE_CONTACT "(.+) <', author),
            ("docs/conf.py", r'^author = "(.+)"$', author)):
        count("names of version and authors")
        found = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
        if not found or found[1] != expected:
            breach(root / name, f"names {found[1] if found else 'nothing'}, where pyproject.toml has: {expected}")


def printed(*arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout


def check_measures():
    """Every column of the program is on the page, with the meaning that its table says."""
    page = root / "docs/reference/measures.md"
    expected = printed("reference", "--measures")
    count("columns of results", len(re.findall(r"^\| `", expected, re.MULTILINE)))
    _, mark, found = page.read_text(encoding="utf-8").partition(MEASURES_MARK)
    if not mark or found != expected:
        breach(page, "does not end with what the program prints; run: sed -i '/^<!-- Below/q' docs/reference/measures.md && "
                     "plica reference --measures >> docs/reference/measures.md")


def check_units():
    """Every column ends with its unit, ratio or error, or is among the pure numbers that docs/reference/measures.md lists."""
    page = root / "docs/reference/measures.md"
    pure = set(re.findall(r"`(\w+)`", page.read_text(encoding="utf-8").partition("## Monitors")[0].
                          partition("pure numbers:\n")[2]))
    columns, quantities = printed("reference", "--measures").split("### Quantities of monitors")
    names = set(re.findall(r"^\| `(\w+)`", columns, re.MULTILINE))
    # A monitor's column ends with its quantity and that one's unit.
    monitored = re.findall(r"^\| `(\w+)` \| \w+ \| (?:`(\w+)`)? *\|", quantities, re.MULTILINE)
    names |= {f"{quantity}_{unit}" if unit else quantity for quantity, unit in monitored}
    count("columns with units", len(names))
    count("quantities of monitors", len(monitored))
    for name in sorted(names):
        if bool(UNIT_AT_END.search(name)) == (name in pure):
            breach(page, f"{name}: needs either a unit at its end or a place among the pure numbers")


def check_reference():
    page = root / "docs/reference/scenario.md"
    expected = printed("reference")
    count("lines of the scenario reference", len(expected.splitlines()))
    if not page.is_file() or page.read_text(encoding="utf-8") != expected:
        breach(page, "is not what the program prints; run: plica reference > docs/reference/scenario.md")


def check_command_line():
    def words(text):  # CLI11 breaks lines elsewhere and writes " [2]" for "=2" since 2.4
        return re.sub(r" \[(\w+)\](?=\s)", r"=\1", text).split()

    page, maker = root / "docs/reference/cli.md", root / "docs/make_cli.py"
    expected = subprocess.run([sys.executable, maker, program], capture_output=True, text=True, check=True).stdout
    count("commands", expected.count("\n## "))
    if not page.is_file() or words(page.read_text(encoding="utf-8")) != words(expected):
        breach(page, "is not what the program prints; run: docs/make_cli.py build/release/plica > docs/reference/cli.md")


check_includes()
check_headers()
check_lengths()
check_laws()
check_links()
check_release()
if program:
    check_reference()
    check_measures()
    check_units()
    check_command_line()

# A check that looked at nothing is a broken check.
for what in ("includes", "headers", "source files", "laws", "pages", "links"):
    if not counts.get(what):
        breach(root, f"no {what} found: is this the root of plica?")
print("Checked " + ", ".join(f"{number} {what}" for what, number in counts.items()) + ".")
for text in breaches:
    print(text)
print(f"{len(breaches)} breaches")
sys.exit(1 if breaches else 0)
