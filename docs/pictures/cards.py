"""Draws the pictures of the built-in scenarios on the first page of plica studio, from those of docs/images/scenarios.

Usage: cards.py. Each card shows parts of a picture, cut out without their captions, side by side."""
from pathlib import Path

from PIL import Image, ImageChops

ROOT = Path(__file__).resolve().parents[2]
SIZE = (440, 220)  # twice that on the page
LAST = [(690, 50, 1000, 262), (690, 262, 1000, 520)]  # last time, from outside and in cross-section
TIMES = [(406, 46, 594, 234), (798, 46, 986, 234)]     # third and last of five cross-sections
PARTS = {
    "bud": [(510, 50, 745, 210), (755, 50, 1000, 210)],
    "convergent-extension": [(20, 130, 180, 420), (420, 320, 1000, 460)],
    "division-demo": [(375, 50, 640, 280), (670, 50, 1000, 255)],
    "drosophila": LAST,
    "drosophila-atlas": [(300, 70, 560, 185), (370, 214, 500, 338)],
    "drosophila-atlas-living": [(18, 46, 665, 278)],
    "drosophila-deep": LAST,
    "drosophila-division": LAST,
    "drosophila-division-twice": LAST,
    "drosophila-egg": [(290, 71, 535, 186), (365, 208, 475, 318)],
    "drosophila-living": TIMES,
    "drosophila-paper": [(665, 42, 1000, 384)],
    "drosophila-shape-memory": [(335, 42, 660, 384)],
    "furrow-slice": TIMES,
    "germ-band": [(0, 62, 250, 274), (748, 62, 1000, 274)],
    "sheet": [(680, 140, 1190, 890), (60, 120, 545, 900)],
    "growing-disc": [(670, 55, 1000, 385), (670, 400, 1000, 500)],
    "wave": [(465, 70, 690, 225)],
    "wing-disc": [(590, 45, 900, 520), (505, 540, 985, 655)],
    "xenopus": LAST,
}
FROM = {"drosophila-paper": "drosophila-variants", "drosophila-shape-memory": "drosophila-variants"}


def trimmed(image):
    """The part of an image that is not white."""
    return image.crop(ImageChops.difference(image, Image.new("RGB", image.size, "white")).point(lambda v: 255 * (v > 12)).getbbox())


def card(name):
    with Image.open(ROOT / f"docs/images/scenarios/{FROM.get(name, name)}.png") as picture:
        parts = [trimmed(picture.convert("RGB").crop(box)) for box in PARTS[name]]
    made = Image.new("RGB", SIZE, "white")
    width = SIZE[0] // len(parts)
    for i, part in enumerate(parts):
        scale = min((width - 16) / part.width, (SIZE[1] - 16) / part.height)
        part = part.resize((round(scale * part.width), round(scale * part.height)), Image.Resampling.LANCZOS)
        made.paste(part, (i * width + (width - part.width) // 2, (SIZE[1] - part.height) // 2))
    return made.quantize(64)


if __name__ == "__main__":
    for name in PARTS:
        card(name).save(ROOT / f"python/plica/studio/cards/{name}.png", optimize=True)
