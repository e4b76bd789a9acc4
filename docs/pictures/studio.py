"""Draws docs/images/studio/, studio.gif and, for cards.py, scenarios/sheet.png: plica studio, driven in a browser by studio.mjs.

Usage: studio.py. Needs Chromium, node with viewer/node_modules, Pillow, and in STUDIO_PYTHON the Python that has plica[studio]:
STUDIO_PYTHON=build/venv/bin/python PYTHONPATH=build/release/python build/venv/bin/python docs/pictures/studio.py"""
import json
import subprocess
import tempfile
from pathlib import Path

from PIL import Image
from style import IMAGES

HERE = Path(__file__).parent
FILM_SIZE = (880, 550)


def film(folder):
    """Join the pictures of the film."""
    names, lasting = zip(*json.loads((folder / "film.json").read_text()))
    pictures = [Image.open(folder / f"{name}.png").convert("RGB").resize(FILM_SIZE, Image.Resampling.LANCZOS) for name in names]
    sample = pictures[8::8]  # the palette is that of all stages
    stages = Image.new("RGB", (FILM_SIZE[0], len(sample) * FILM_SIZE[1]))
    for i, picture in enumerate(sample):
        stages.paste(picture, (0, i * FILM_SIZE[1]))
    palette = stages.quantize(128, kmeans=1, dither=Image.Dither.NONE)
    first, *rest = [one.quantize(palette=palette, dither=Image.Dither.NONE) for one in pictures]
    first.save(IMAGES / "studio.gif", save_all=True, append_images=rest, duration=lasting, loop=0, optimize=True)


if __name__ == "__main__":
    (IMAGES / "studio").mkdir(exist_ok=True)
    made = [IMAGES / "studio.gif"]
    with tempfile.TemporaryDirectory() as name:
        subprocess.run(["node", HERE / "studio.mjs", name], check=True)
        film(Path(name))
        for one, place in [("paint", "studio"), ("fold", "studio"), ("cut", "studio"), ("sheet", "scenarios")]:
            made.append(IMAGES / f"{place}/{one}.png")
            Image.open(Path(name) / f"{one}.png").convert("RGB").quantize(255, dither=Image.Dither.NONE).save(made[-1], optimize=True)
    for file in made:
        print(f"{file}: {file.stat().st_size / 1000:.0f} kB")
