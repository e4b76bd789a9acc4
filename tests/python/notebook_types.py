#!/usr/bin/env python3
"""Type-checks the code of the notebooks with mypy --strict, as a user's own code would be.

usage: notebook_types.py NOTEBOOK...; needs mypy, and the package where MYPYPATH or PYTHONPATH says.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

CELL = re.compile(r"^```\{code-cell\}[^\n]*\n(.*?)^```$", re.M | re.S)


def code_of(notebook):
    """Its cells one after another; blank lines stand for the text between, so that lines keep their numbers."""
    text = notebook.read_text(encoding="utf-8")
    lines = [""] * text.count("\n")
    for cell in CELL.finditer(text):
        first = text.count("\n", 0, cell.start(1))
        for number, line in enumerate(cell[1].splitlines()):
            if not re.match(r":\w|%|!", line):  # an option of the cell, or a command of Jupyter
                lines[first + number] = line
    return "\n".join(lines) + "\n"


def main():
    notebooks = [Path(name) for name in sys.argv[1:]]
    if not notebooks:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        sources = []
        for notebook in notebooks:
            sources.append(Path(folder) / f"notebook_{notebook.stem}.py")
            sources[-1].write_text(code_of(notebook), encoding="utf-8")
        # PyVista's types are not installed for tests; scikit-image says that it has types, and most of its functions
        # have none. A cell may end in a value.
        sys.exit(subprocess.run([sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports",
                                 "--untyped-calls-exclude=skimage", *sources]).returncode)


if __name__ == "__main__":
    main()
