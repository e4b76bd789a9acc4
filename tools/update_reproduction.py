#!/usr/bin/python3
"""Put the results of `plica reproduce` into docs/science/reproduction.md.

Usage: update_reproduction.py DIR, the --out directory of a full (not --quick) run. Text outside of the page's markers is
written by hand and stays. Written are

- the page's tables between <!-- claims --> or <!-- errors --> and <!-- end -->, and its count of verdicts,
- docs/science/reproduction.csv (claims), reproduction-readings.csv and reproduction-errors.csv, in full,
- the figures that the page shows, in docs/images/reproduction/.
"""
import csv
import re
import shutil
import sys
from pathlib import Path

SCIENCE = Path(__file__).resolve().parent.parent / "docs/science"
PAGE, IMAGES = SCIENCE / "reproduction.md", SCIENCE.parent / "images/reproduction"
TABLES = {"section": "reproduction.csv", "varied": "reproduction-readings.csv", "headline": "reproduction-errors.csv"}
SHORT = {"*reproduced*": "yes", "*reproduced under this reading*": "under this reading", "*not reproduced*": "no"}


def tables_of(text):
    """Rows of cells of each table in Markdown, its header first, by the first cell of the header."""
    found = {}
    for table in re.findall(r"(?:^\|.*\n)+", text, re.M):
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
        found[rows[0][0]] = [rows[0], *rows[2:]]
    return found


def table(header, rows):
    return "\n".join("| " + " | ".join(row) + " |" for row in [header, ["---"] * len(header), *rows]) + "\n"


def fill(page, name, text):
    """The page with this text between the marker of that name and its end."""
    filled, count = re.subn(rf"(<!-- {name} -->\n).*?(?=<!-- end -->)", lambda found: f"{found[1]}\n{text}\n", page, flags=re.S)
    if count != 1:
        sys.exit(f"{PAGE}: no text between <!-- {name} --> and <!-- end -->")
    return filled


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    results = Path(sys.argv[1])
    tables = tables_of((results / "reproduction.md").read_text(encoding="utf-8"))
    for first, name in TABLES.items():
        with (SCIENCE / name).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([cell.strip("*") for cell in row] for row in tables[first])

    claims = [(claim, SHORT[verdict]) for _, claim, _, _, _, verdict, _ in tables["section"][1:]]
    page = fill(PAGE.read_text(encoding="utf-8"), "claims", table(["claim", "reproduced"], claims))
    page = fill(page, "errors", table(tables["headline"][0], tables["headline"][1:]))
    counts = [sum(verdict == short for _, verdict in claims) for short in SHORT.values()]
    page = re.sub(r"Of \d+ claims, \d+ are reproduced, \d+ under this reading, and \d+ are not",
                  "Of {} claims, {} are reproduced, {} under this reading, and {} are not".format(len(claims), *counts), page)
    PAGE.write_text(page, encoding="utf-8")

    shutil.rmtree(IMAGES, ignore_errors=True)
    IMAGES.mkdir(parents=True)
    names = re.findall(r"\]\(\.\./images/reproduction/([^)]+)\)", page)
    for name in names:
        shutil.copy(results / "figures" / name, IMAGES / name)
    print(f"{PAGE}: {len(claims)} claims, {len(names)} figures")


if __name__ == "__main__":
    main()
