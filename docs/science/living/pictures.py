"""Draws the pictures of docs/science/living-embryo.md from what its experiments have left.

Usage: pictures.py RESULTS MEASURED GRADIENT IMAGES, where RESULTS and MEASURED are of `plica reproduce living` and of `plica
reproduce scenarios/living/measured.toml`, GRADIENT of `plica run docs/science/living/gradient.toml`: cuts.png, atlas.png, gradient.png
and closing.gif in IMAGES.
"""
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from PIL import Image  # noqa: E402

from drawing import few_colours, render  # noqa: E402

results, measured, gradient, images = map(Path, sys.argv[1:])
CUTS = {
    "reference": "undisturbed",
    "cut-out": "apical cuts in front and behind",
    "walls-cut": "walls of the middle cut",
    "cut-out-and-walls-cut": "both",
    "block": "middle in the light",
    "floor-kept": "floor kept stiff",
}
GRADIENT_AT = "--at-x-um=-60"  # the gradient's embryo is cut across there, too


def run_of(folder, experiment):
    return folder / "runs" / experiment / "draw-1"


images.mkdir(parents=True, exist_ok=True)
with tempfile.TemporaryDirectory() as name:
    folder = Path(name)

    figure, panels = plt.subplots(3, 2, figsize=(11, 7.2))
    for panel, (experiment, title) in zip(panels.flat, CUTS.items()):
        panel.imshow(plt.imread(render(run_of(results, experiment), folder / "cut.png", "--view", "sagittal-section", "--range", "0:60")))
        panel.set_title(title, fontsize=12)
        panel.axis("off")
    figure.tight_layout(pad=0.3)
    figure.savefig(folder / "cuts.png", dpi=90)
    few_colours(Image.open(folder / "cuts.png")).save(images / "cuts.png", optimize=True)

    for picture, run, at, times in (("atlas.png", run_of(measured, "atlas"), "--at-x-um=30", "9min,14min,17min,20min"),
                                    ("gradient.png", gradient, GRADIENT_AT, "9min,14min,20min,24min")):
        render(run, folder / picture, "--view", "ventral,sagittal-section,cross-section", at, "--time", times, "--size", "1500x824")
        few_colours(Image.open(folder / picture)).save(images / picture, optimize=True)

    # The movie: from below, and beside it cut across, without legends.
    render(gradient, folder / "below.png", "--movie", "--view", "ventral,sagittal-section", "--size", "700x560")
    render(gradient, folder / "across.png", "--movie", GRADIENT_AT, "--size", "560x560")
    frames = []
    for below, across in zip(sorted(folder.glob("below_*.png"))[3:], sorted(folder.glob("across_*.png"))[3:]):
        frame = Image.new("RGB", (780, 260), "white")
        frame.paste(Image.open(below).crop((25, 20, 572, 270)), (0, 5))
        frame.paste(Image.open(across).crop((0, 50, 475, 540)).resize((232, 240), Image.Resampling.LANCZOS), (548, 10))
        frames.append(frame.resize((696, 232), Image.Resampling.LANCZOS))
    palette = few_colours(frames[-1])  # one for all frames, so that what stands still costs nothing
    frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    times = [300] * (len(frames) - 1) + [2000]
    frames[0].save(images / "closing.gif", save_all=True, append_images=frames[1:], duration=times, loop=0)
print("\n".join(f"drawn: {images / picture}" for picture in ("cuts.png", "atlas.png", "gradient.png", "closing.gif")))
