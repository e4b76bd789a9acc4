"""How pictures of docs/science/living-embryo.md are drawn."""
import subprocess

from PIL import Image


def render(run, picture, *words):
    """Writes what `plica render` draws of the run with these options; returns the picture's path."""
    subprocess.run(["build/release/plica", "render", run, "--out", picture, "--overwrite", "--quiet", *words], check=True,
                   stdout=subprocess.DEVNULL)
    return picture


def few_colours(picture):
    """The picture in 64 colours: a fifth of its bytes."""
    return picture.convert("RGB").quantize(64, dither=Image.Dither.NONE)
