"""A tissue of the user's: files that the readers of plica know, with what these remarked, before one is used."""
from __future__ import annotations

import shutil
import warnings
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from ..centres import polygons_of_centres
from ..errors import FileError, PlicaError, needed
from ..label_files import read_labels
from ..labels import polygons_of_labels
from ..outlines import polygons_of_outlines
from ..scenario import Scenario
from ..volumes import tissue_of_labels
from .draft import Draft, Table
from .messages import problem_of
from .rest import Rest

READING_S = 20.0  # that "use" waits for a reading
SIDES = ["", "outside", "inside", "+z", "-z", "+y", "-y", "+x", "-x"]


class OtherKind(ValueError):
    """The file is of another kind than it was read as."""


class Option(NamedTuple):
    """Question that a reader asks: a number, a choice of `words`, or, with the words no and yes, a tick."""

    name: str
    label: str
    value: str
    words: list[str] = []


HEIGHT = Option("cell_height_um", "height of the cells, µm", "")
KEEP = Option("keep", "pieces of tissue to keep", "all", ["all", "largest"])
CUT = Option("keep_cut", "cells cut by the border", "no", ["no", "yes"])
GAP = Option("gap_px", "half the width of lines between cells, pixels", "2")
OPTIONS = {
    "mesh of hexahedra": [],
    "polygons": [HEIGHT, Option("scale", "µm for one unit of the file", "1"), KEEP],
    "prisms": [Option("scale", "µm for one unit of the file", "1")],
    "points around a closed embryo": [HEIGHT],
    "points on an open sheet": [HEIGHT, KEEP],
    "outlines": [Option("um_per_unit", "µm for one unit of the file", "1"), HEIGHT, KEEP],
    "label image": [Option("um_per_pixel", "size of a pixel, µm", "1"), HEIGHT, GAP, CUT, KEEP],
    "label volume": [Option(f"spacing_{axis}", f"distance of {axis}, µm", "") for axis in ("planes", "rows", "columns")]
        + [Option("apical", "apical side", "", SIDES), GAP._replace(value="1"), CUT, KEEP],
}
MESHES = ["prisms", "mesh of hexahedra", "polygons"]
IMAGES = ["label image", "label volume"]
ENDINGS = {".vtu": MESHES, ".vtk": MESHES, ".vtp": MESHES, ".obj": ["polygons"], ".off": ["polygons"],
           ".ply": ["prisms", "polygons"], ".hf5": ["polygons"], ".h5": ["polygons"], ".hdf5": ["polygons"],
           ".csv": ["points around a closed embryo", "points on an open sheet"], ".geojson": ["outlines"],
           ".tif": IMAGES, ".tiff": IMAGES, ".npy": IMAGES, ".npz": IMAGES, ".png": ["label image"]}
SHAPES = {"mesh of hexahedra": "file", "polygons": "surface", "prisms": "prisms",
          "points around a closed embryo": "points"}


@cache
def usual_advice() -> list[str]:
    """Return the advice on any tissue without forces, which does not concern the file."""
    cube = {"shape": "block", "length_um": 20, "width_um": 20, "cell_height_um": 20, "cells": [2, 2, 2]}
    return Scenario({"format": 1, "embryo": cube}).advice()


def number(options: Table, name: str) -> Optional[float]:
    """Return the number in a field, or None for an empty one."""
    text = str(options.get(name, "")).strip()
    try:
        return float(text) if text else None
    except ValueError:
        raise ValueError(f"{name}: {text[:40]!r} is not a number; give one, such as 0.3") from None


def image_of(path: Path) -> tuple[NDArray[Any], Optional[tuple[float, float, float]]]:
    """Return the labels of a file, flat ones without planes."""
    if path.suffix.lower() == ".png":
        return np.asarray(needed("skimage.io", "reading PNG").imread(path)), None
    array, spacing = read_labels(path)
    return (array[0] if array.ndim == 3 and len(array) == 1 else array), spacing


def is_flat(array: NDArray[Any]) -> bool:
    return array.ndim == 2 or array.ndim == 3 and array.shape[-1] in (3, 4)


def of_image(path: Path, kind: str, options: Table, made: Path) -> str:
    """Write the cells of a label image or volume; return the shape of the file."""
    array, spacing = image_of(path)
    if is_flat(array) != (kind == "label image"):
        raise OtherKind(f"{path.name}: an array of shape {array.shape}; choose the other kind of file")
    common = {"keep_cut": options["keep_cut"] == "yes", "keep": options["keep"]}
    gap_px = number(options, "gap_px") or 0.0
    if kind == "label image":
        polygons = polygons_of_labels(array, number(options, "um_per_pixel") or 0.0, gap_px=gap_px, **common)
        polygons.write(made)
        return "surface"
    given = [number(options, f"spacing_{axis}") for axis in ("planes", "rows", "columns")]
    for axis, own, value in zip(("planes", "rows", "columns"), given, spacing or (None, None, None)):
        options[f"spacing_{axis}"] = f"{own or value or 1:g}"
    distances = tuple(number(options, f"spacing_{axis}") or 1.0 for axis in ("planes", "rows", "columns"))
    tissue = tissue_of_labels(array, distances, apical=options["apical"] or None,  # type: ignore[arg-type]
                              gap_px=gap_px, **common)
    tissue.write(made)
    return "prisms"


def of_centres(path: Path, options: Table, made: Path) -> str:
    """Write the cells around the centres of an open sheet."""
    table = np.genfromtxt(path, delimiter=",", names=True, encoding="utf-8-sig", deletechars="")
    names = list(table.dtype.names or ())
    if "x_um" not in names or "y_um" not in names:
        raise FileError(f"{path}: columns {', '.join(names[:6]) or 'none'}; name them x_um, y_um and, if curved, z_um")
    places = np.column_stack([table[name] for name in ("x_um", "y_um", "z_um") if name in names])
    arrays = {name: table[name] for name in names if name not in ("x_um", "y_um", "z_um")}
    polygons_of_centres(places, cell_data=arrays, keep=options["keep"]).write(made)
    return "surface"


def read_as(kind: str, path: Path, options: Table, made: Path) -> Table:
    """Return the scenario of a tissue file; what the program cannot read itself is written to `made`."""
    embryo: Table = {"shape": SHAPES.get(kind, ""), "file": str(path)}
    if kind not in SHAPES:
        if kind == "outlines":
            polygons_of_outlines(path, number(options, "um_per_unit") or 0.0, keep=options["keep"]).write(made)
            embryo["shape"] = "surface"
        elif kind == "points on an open sheet":
            embryo["shape"] = of_centres(path, options, made)
        else:
            embryo["shape"] = of_image(path, kind, options, made)
        embryo |= {"file": str(made), "centre": True}
    elif kind == "polygons":
        embryo["keep"] = options["keep"]
    if (scale := number(options, "scale")) not in (None, 1.0):
        embryo["scale"] = 3 * [scale]
    if (height := number(options, "cell_height_um")) is not None:
        embryo["cell_height_um"] = height
    return {"format": 1, "title": path.name, "embryo": embryo}


class Candidate(Rest):
    """The tissue that is looked at before it is used. Cells of images are written into a folder of the session."""

    def __init__(self, told: Callable[[], None], folder: Path) -> None:
        self.folder = folder
        self.path: Optional[Path] = None
        self.source, self.kind, self.remarks, self.asked = "", "", list[str](), 0
        self.options: Table = {}
        self._scenario: Optional[Scenario] = None
        super().__init__(told, -1)

    def look_at(self, path: Path, source: str, options: Table) -> None:
        """Begin to read a file, which the page calls `source`; `options`: answers by name, and the kind of file."""
        given = {str(name): str(value) for name, value in options.items()}
        with self._wanted:
            if path != self.path:
                self.kind, self.options = "", {}
            self.path, self.source, self.problem, self.remarks = path, source, "", []
            self._built, self._scenario = None, None
            self.cells, self.asked = 0, self.asked + 1
            self.build(partial(self._read, path, given, self.asked))

    @property
    def made(self) -> Path:
        return self.folder / "cells.ply"

    def _read(self, path: Path, given: Table, asked: int) -> Scenario:
        kinds = ENDINGS[path.suffix.lower()]
        problems = []
        for kind in [given["kind"]] if given.get("kind") in kinds else kinds:
            options = {one.name: given.get(one.name, one.value) for one in OPTIONS[kind]}
            try:
                with warnings.catch_warnings(record=True) as told:
                    warnings.simplefilter("always")
                    self.folder.mkdir(exist_ok=True)
                    scenario = Scenario(read_as(kind, path, options, self.made))
                    advice = scenario.advice()  # reads the file
            except (PlicaError, ValueError, OSError, TypeError) as error:
                text = problem_of(error)["text"].replace(str(self.made), path.name).replace(str(path), path.name)
                problems.append((isinstance(error, OtherKind), kind, options, text))
                continue
            if "cell_height_um" in options:
                options["cell_height_um"] = f"{scenario['embryo.cell_height_um']:g}"
            remarks = [str(one.message) for one in told if issubclass(one.category, UserWarning)]
            remarks += [line for line in advice if line not in usual_advice()]
            self._note(asked, kind, options, remarks, scenario)
            return scenario
        likely = [one for one in problems if not one[0]] or problems
        self._note(asked, *likely[0][1:3], [], None)
        raise ValueError("\n".join(dict.fromkeys(text for _, _, _, text in likely)))

    def _note(self, asked: int, kind: str, options: Table, remarks: list[str], scenario: Optional[Scenario]) -> None:
        """Note what was read, unless another reading has been asked for by now."""
        with self._wanted:
            if asked == self.asked:
                self.kind, self.options, self.remarks, self._scenario = kind, options, remarks, scenario

    def state(self) -> Optional[Table]:
        """Return what the page shows beside the picture."""
        with self._wanted:  # else a reading that ends meanwhile is shown in part
            if self.path is None:
                return None
            fields = [{**one._asdict(), "value": self.options.get(one.name, one.value)}
                      for one in OPTIONS.get(self.kind, [])]
            return {"file": self.source, "kind": self.kind, "kinds": ENDINGS[self.path.suffix.lower()],
                    "options": fields, "remarks": self.remarks, "problem": self.problem, "cells": self.cells,
                    "asked": self.asked}

    def draft(self) -> Draft:
        """Return the tissue as a scenario. Cells made of an image get a file of their own, beside the image.

        An answer given just before may still be at work: its tissue is the one that is meant, so it is waited for."""
        with self._wanted:
            is_over = self._wanted.wait_for(lambda: self.path is None or self.cells or self.problem, READING_S)
        if not is_over:
            raise ValueError(f"{self.source}: is still being read; use it once it is shown")
        if self._scenario is None or self.path is None or self.cells == 0:
            raise ValueError("no tissue is shown; choose a file that can be read")
        table = self._scenario.to_dict()
        if Path(table["embryo"]["file"]) == self.made:
            names = [f"{self.path.stem}-cells.ply", *(f"{self.path.stem}-cells-{n}.ply" for n in range(2, 1000))]
            target = next(file for name in names if not (file := self.path.with_name(name)).exists())
            shutil.copyfile(self.made, target)
            table["embryo"]["file"] = str(target)
        return Draft.of(Scenario(table))
