"""Commands that the program ``plica`` hands over to the Python package: ``labels``, and ``calibrate`` by gradients. ``python -m plica``
runs them without the program."""
from __future__ import annotations

import argparse
import json
import re
import sys
import warnings
from pathlib import Path
from typing import Optional, Sequence

from . import calibrate_command
from .errors import FileError, NumericsError, PlicaError, ScenarioError
from .volumes import tissue_of_labels

DONE, USAGE, GAVE_UP, FILES = 0, 2, 3, 4  # exit statuses, as those of the program


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="plica", description="Commands of plica's Python package.")
    commands = parser.add_subparsers(dest="command", required=True)
    labels = commands.add_parser(
        "labels", help="cells as prisms, from a volume of labels",
        description="Make cells of a volume of labels, for embryo.shape = \"prisms\".",
        epilog="example: plica labels cyst.tif --spacing-um 1 0.3 0.3 --apical inside --out cells.vtp --picture cells.png")
    labels.add_argument("file", help="TIFF, OME-TIFF, NumPy or Zarr: planes, rows, columns")
    labels.add_argument("--out", required=True, help="file to write, .vtp or .ply")
    labels.add_argument("--spacing-um", nargs=3, type=float, metavar=("PLANES", "ROWS", "COLUMNS"),
                        help="distances in um; default: those of the file")
    labels.add_argument("--apical", help="outside, inside, or a direction: +z, -z, +y, -y, +x, -x")
    labels.add_argument("--background", type=int, default=0, help="label outside all cells (default: 0)")
    labels.add_argument("--gap-px", type=float, default=1, help="half the width of gaps that are closed, in voxels (default: 1)")
    labels.add_argument("--keep-cut", action="store_true", help="keep cells cut by the border of the image")
    labels.add_argument("--keep", choices=("all", "largest"), default="all", help="pieces of tissue that become cells")
    labels.add_argument("--picture", help="picture to write: slices of the labels with the cells in outline")
    labels.add_argument("--overwrite", action="store_true", help="write over existing files")
    calibrate_command.add_parser(commands)
    return parser


def main(words: Optional[Sequence[str]] = None) -> int:
    """Run a command and return its exit status."""
    given = _parser().parse_args(_with_directions(sys.argv[1:] if words is None else words))
    try:
        return calibrate_command.calibrate(given) if given.command == "calibrate" else _labels(given)
    except NumericsError as error:
        return _refused(error, GAVE_UP)
    except ScenarioError as error:
        return _refused(error, USAGE)
    except PlicaError as error:
        return _refused(error, FILES)
    except ValueError as error:
        return _refused(error, USAGE)


def _with_directions(words: Sequence[str]) -> list[str]:
    """Return words in which ``--apical -z`` is ``--apical=-z``, because argparse takes -z for an option."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] == "--apical" and not word.startswith("--"):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined


def _refused(error: Exception, status: int) -> int:
    print(f"plica: {error}", file=sys.stderr)
    return status


def _labels(given: argparse.Namespace) -> int:
    for path in (given.out, given.picture):
        if path is not None and Path(path).exists() and not given.overwrite:
            raise FileError(f"{path}: exists; set --overwrite, or another name")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # printed as remarks
        try:
            tissue = tissue_of_labels(given.file, given.spacing_um, apical=given.apical, background=given.background,
                                      gap_px=given.gap_px, keep_cut=given.keep_cut, keep=given.keep)
        except ValueError as error:
            raise ValueError(f"{given.file}: {_in_options(str(error))}") from error
    tissue.write(given.out)
    if given.picture:
        tissue.figure(given.file).savefig(given.picture, dpi=150)
    for remark in tissue.remarks:
        print(f"note: {_in_options(remark)}")
    print(f"{given.out}: {len(tissue.cells)} cells, {tissue.sizes}\n{tissue.quality!r}\n")
    print(f"In a scenario:\n[embryo]\nshape = \"prisms\"\nfile = {json.dumps(given.out, ensure_ascii=False)}")
    return DONE


def _in_options(text: str) -> str:
    """Return a message of `tissue_of_labels` with options in place of arguments."""
    text = re.sub(r"spacing_um = \((.*?)\)", lambda found: "--spacing-um " + found[1].replace(",", ""), text)
    text = text.replace("spacing_um: None", "spacing_um: not in the file").replace("keep_cut = True", "--keep-cut").replace('keep = "largest"', "--keep largest")
    return re.sub(r"\b(gap_px|spacing_um)\b", lambda found: "--" + found[0].replace("_", "-"), text)


if __name__ == "__main__":
    sys.exit(main())
