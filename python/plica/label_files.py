"""Files of label volumes: TIFF, OME-TIFF, NumPy, Zarr."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .arguments import path_of
from .errors import FileError, PlicaError, needed

Spacing = Optional[tuple[float, float, float]]
UNITS_UM = {"µm": 1.0, "um": 1.0, "micron": 1.0, "microns": 1.0, "micrometer": 1.0, "micrometre": 1.0, "nm": 1e-3, "nanometer": 1e-3,
            "nanometre": 1e-3, "mm": 1e3, "millimeter": 1e3, "millimetre": 1e3}


def read_labels(path: Union[str, os.PathLike[str]]) -> tuple[NDArray[Any], Spacing]:
    """Return the array in a file, and its spacing in µm (planes, rows, columns), if the file has it.

    Endings: ``.tif``, ``.tiff`` (also of ImageJ and OME), ``.npy``, ``.npz``, ``.zarr`` (also of OME, its finest level, and arrays or groups
    inside).

    Raises
    ------
    FileError
        If the file cannot be read, or has another ending.
    """
    file = Path(path_of(path, "volume"))
    readers = {".tif": _tiff, ".tiff": _tiff, ".npy": _numpy, ".npz": _numpy, ".zarr": _zarr}
    ending = ".zarr" if any(part.lower().endswith(".zarr") for part in file.parts) else file.suffix.lower()
    if ending not in readers:
        raise FileError(f"{file}: is no volume of labels; give {', '.join(readers)}")
    if not file.exists():
        raise FileError(f"{file}: cannot be read: there is no such file")
    try:
        return readers[ending](file)
    except PlicaError:
        raise
    except Exception as error:
        raise FileError(f"{file}: cannot be read: {type(error).__name__}: {error}") from error


def _numpy(file: Path) -> tuple[NDArray[Any], Spacing]:
    loaded = np.load(file, allow_pickle=False)
    if file.suffix.lower() == ".npy":
        return loaded, None
    if len(loaded.files) != 1:
        raise FileError(f"{file}: has {len(loaded.files)} arrays ({', '.join(loaded.files[:5])}); save the labels only")
    return loaded[loaded.files[0]], None


def _tiff(file: Path) -> tuple[NDArray[Any], Spacing]:
    with needed("tifffile", "reading TIFF").TiffFile(file) as tiff:
        array = tiff.series[0].asarray()
        if tiff.is_ome and tiff.ome_metadata:
            return array, _spacing_of_ome(tiff.ome_metadata)
        page = tiff.pages[0].tags
        imagej = tiff.imagej_metadata or {}
        unit = UNITS_UM.get(str(imagej.get("unit", "")).replace("\\u00B5", "µ").replace("μ", "µ"))
        if unit is None or "spacing" not in imagej or "XResolution" not in page:
            return array, None
        across, down = (page[name].value for name in ("XResolution", "YResolution"))
        return array, (float(imagej["spacing"]) * unit, unit * down[1] / down[0], unit * across[1] / across[0])


def _spacing_of_ome(metadata: str) -> Spacing:
    from xml.etree import ElementTree

    pixels = next((one for one in ElementTree.fromstring(metadata).iter() if one.tag.endswith("}Pixels")), None)
    if pixels is None:
        return None
    sizes = [pixels.get(f"PhysicalSize{axis}") for axis in "ZYX"]
    units = [UNITS_UM.get(pixels.get(f"PhysicalSize{axis}Unit", "µm").replace("μ", "µ")) for axis in "ZYX"]
    if None in sizes or None in units:
        return None
    planes, rows, columns = (float(size or 0) * (unit or 0) for size, unit in zip(sizes, units))
    return planes, rows, columns


def _zarr(file: Path) -> tuple[NDArray[Any], Spacing]:
    zarr = needed("zarr", "reading Zarr")
    node = zarr.open(str(file), mode="r")
    if hasattr(node, "shape"):
        return np.asarray(node[...]), None
    attributes = dict(node.attrs)
    scales = attributes.get("ome", attributes).get("multiscales")
    if not scales:
        arrays = [name for name, _ in node.arrays()]
        if len(arrays) != 1:
            raise FileError(f"{file}: is a group of {len(arrays)} arrays without multiscales ({', '.join(arrays[:5])}); give the path of one array")
        return np.asarray(node[arrays[0]][...]), None
    finest = scales[0]["datasets"][0]
    array = np.asarray(node[finest["path"]][...])
    axes = [axis["name"] if isinstance(axis, dict) else axis for axis in scales[0].get("axes", [])]
    units = {axis["name"]: UNITS_UM.get(axis.get("unit", "")) for axis in scales[0].get("axes", []) if isinstance(axis, dict)}
    scale = next((one["scale"] for one in finest.get("coordinateTransformations", []) if one.get("type") == "scale"), None)
    if scale is None or not {*"zyx"} <= {*axes} or any(units.get(axis) is None for axis in "zyx"):
        return array, None
    planes, rows, columns = (float(scale[axes.index(axis)]) * float(units[axis] or 0) for axis in "zyx")
    return array, (planes, rows, columns)
