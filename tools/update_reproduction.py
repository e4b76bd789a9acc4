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
VERDICTS = ("reproduced", "reproduced under this reading", "not reproduced")
SUBJECTS = {"2.1": "meshes and sizes", "2.3": "contraction", "2.5": "volume", "2.6": "cell division", "2.7": "stop", "3.1": "furrow of the pill",
            "3.2": "furrow of the sphere", "3.3": "vitelline membrane", "4": "discussion", "5": "conclusion", "note": "notes"}


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


def counts_of(claims):
    """Rows of a table: how many of the claims, (section, verdict), have each verdict, by section, and in all."""
    of_subject = {subject: [0] * len(VERDICTS) for subject in SUBJECTS}
    for section, verdict in claims:
        of_subject[re.match(r"note|\d(\.\d)?", section)[0]][VERDICTS.index(verdict)] += 1
    rows = [(f"{number}, {subject}" if number != "note" else subject, counts)
            for (number, subject), counts in zip(SUBJECTS.items(), of_subject.values())]
    rows.append(("all", [sum(column) for column in zip(*of_subject.values())]))
    return [[name, *map(str, counts)] for name, counts in rows]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    results = Path(sys.argv[1])
    tables = tables_of((results / "reproduction.md").read_text(encoding="utf-8"))
    for first, name in TABLES.items():
        with (SCIENCE / name).open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows([cell.strip("*") for cell in row] for row in tables[first])

    claims = [(row[0], row[5].strip("*")) for row in tables["section"][1:]]
    counts = counts_of(claims)
    page = fill(PAGE.read_text(encoding="utf-8"), "claims", table(["section", "reproduced", "under this reading", "not reproduced"], counts))
    page = fill(page, "errors", table(tables["headline"][0], tables["headline"][1:]))
    page = re.sub(r"Of \d+ claims, \d+ are reproduced, \d+ under this reading, and \d+ are not",
                  "Of {} claims, {} are reproduced, {} under this reading, and {} are not".format(len(claims), *counts[-1][1:]), page)
    PAGE.write_text(page, encoding="utf-8")

    shutil.rmtree(IMAGES, ignore_errors=True)
    IMAGES.mkdir(parents=True)
    names = re.findall(r"\]\(\.\./images/reproduction/([^)]+)\)", page)
    for name in names:
        shutil.copy(results / "figures" / name, IMAGES / name)
    print(f"{PAGE}: {len(claims)} claims, {len(names)} figures")


if __name__ == "__main__":
    main()
