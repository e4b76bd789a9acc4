"""Draws docs/images/notebooks: figures of the notebooks, for readers of the repository.

Usage: notebooks.py [NOTEBOOK...], files of docs/notebooks; without, all, in some minutes. The code cells of a notebook are run in
a folder of their own. A picture below <!-- site: output --> is the figure that the code cell before it has drawn.
PYTHONPATH=build/release/python build/site-venv/bin/python docs/pictures/notebooks.py
"""
import io
import os
import re
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("PYVISTA_OFF_SCREEN", "true")
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from PIL import Image  # noqa: E402

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"
WIDTHS, LARGEST = (1000, 800, 640), 80_000  # pixels, bytes
CELL = re.compile(r"^```\{code-cell\}[^\n]*\n(?P<code>.*?)^```$"
                  r"(?:\s*^<!-- site: output -->\n!\[[^\]]*\]\((?P<picture>[^)]*)\))?", re.M | re.S)


def write(figure, path):
    """Writes a figure as PNG, in as many colours and as wide as LARGEST allows."""
    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=150, bbox_inches="tight", facecolor="white")
    whole = Image.open(memory).convert("RGB")
    path.parent.mkdir(parents=True, exist_ok=True)
    for width, colours in [(width, colours) for width in WIDTHS for colours in (256, 128, 64, 32)]:
        small = whole.resize((width, round(whole.height * width / whole.width)), Image.Resampling.LANCZOS)
        small.quantize(colours, dither=Image.Dither.NONE).save(path, optimize=True)
        if path.stat().st_size < LARGEST:
            break
    print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB", flush=True)


def run(notebook):
    """Runs the code cells of a notebook, and writes its pictures."""
    text, begin = notebook.read_text(encoding="utf-8"), time.monotonic()
    names = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        plt.rcdefaults()
        plt.rcParams["font.size"] = 14  # readable where a picture is shrunk
        for cell in CELL.finditer(text):
            before = names.get("figure")
            exec(compile(cell["code"], str(notebook), "exec"), names)
            if cell["picture"]:
                own = names.get("figure")  # one that pyplot may not know
                write(plt.gcf() if own is before else own, (notebook.parent / cell["picture"]).resolve())
        plt.close("all")
        os.chdir(NOTEBOOKS)
    print(f"{notebook.name}: {time.monotonic() - begin:.0f} s", flush=True)


if __name__ == "__main__":
    for one in [Path(name).resolve() for name in sys.argv[1:]] or sorted(NOTEBOOKS.glob("*.md")):
        run(one)
