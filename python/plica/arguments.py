"""Checks of arguments. Errors name the argument, what was given and what fits: ValueError for numbers and arrays, TypeError
for paths, texts, mappings and functions that are none."""
from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray


LONGEST_NAME = 255  # bytes, on most file systems


def told(value: Any) -> str:
    """Describe a value in a message: short values as they are, others by type and shape."""
    if value is None or isinstance(value, (bool, int, float, str, bytes, np.generic)):
        text = repr(value)
        return text if len(text) <= 60 else f"{text[:57]}..."
    if isinstance(value, np.ndarray):
        return f"an array of {value.dtype} and shape {value.shape}"
    return f"a value of type {type(value).__name__}"


def path_of(value: Any, what: str) -> str:
    """Return a path as text."""
    if not isinstance(value, (str, os.PathLike)) or not isinstance(os.fspath(value), str):
        raise TypeError(f"{what}: {told(value)}; give a str or path")
    text = str(os.fspath(value))
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{what}: {told(ascii(text))}; give a path of valid characters") from None
    if not text or "\0" in text:
        raise ValueError(f"{what}: {told(text)}; give the name of a file or directory")
    if max(len(name.encode()) for name in text.split("/")) > LONGEST_NAME:
        raise ValueError(f"{what}: {told(text)}; give a name of at most {LONGEST_NAME} bytes")
    return text


def text_of(value: Any, what: str) -> str:
    """Return a text that is valid Unicode."""
    if not isinstance(value, str):
        raise TypeError(f"{what}: {told(value)}; give a str")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{what}: {told(ascii(value))}; give a text of valid characters") from None
    return value


def texts_of(values: Any, what: str) -> list[str]:
    """Return one text, or several, as a list."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        return [text_of(values, what)]
    return [text_of(one, what) for one in values]


def mapping_of(value: Any, what: str, fits: str) -> dict[str, Any]:
    """Return a mapping with texts as keys as a dict."""
    if not isinstance(value, Mapping):
        raise TypeError(f"{what}: {told(value)}; give {fits}")
    return {text_of(key, what): one for key, one in value.items()}


def callable_of(value: Any, what: str) -> None:
    """Check an optional function."""
    if value is not None and not callable(value):
        raise TypeError(f"{what}: {told(value)}; give a function")


def whole(value: Any, what: str, low: int = 1, high: Optional[int] = None) -> int:
    """Return a whole number within bounds."""
    fits = f"a whole number from {low} to {high}" if high is not None else f"a whole number, {low} or more"
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise ValueError(f"{what}: {told(value)}; give {fits}")
    if value < low or (high is not None and value > high):
        raise ValueError(f"{what}: {told(value)}; give {fits}")
    return int(value)


def number(value: Any, what: str, fits: str = "a finite number", finite: bool = True) -> float:
    """Return a number, by default a finite one."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise ValueError(f"{what}: {told(value)}; give {fits}")
    try:
        found = float(value)
    except OverflowError:
        found = math.inf
    if finite and not math.isfinite(found):
        raise ValueError(f"{what}: {told(value)}; give {fits}")
    return found


def number_from(value: Any, low: float, what: str, fits: str, above: bool = False) -> float:
    """Return a finite number of at least `low`, or, if `above`, greater than it."""
    found = number(value, what, fits)
    if found < low or (above and found == low):
        raise ValueError(f"{what}: {told(value)}; give {fits}")
    return found


def pair_of(value: Any, what: str, fits: str, finite: bool = True) -> tuple[float, float]:
    """Return two numbers, by default finite ones."""
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{what}: {told(value)}; give {fits}") from None
    return number(first, what, fits, finite), number(second, what, fits, finite)


def pairs_of(value: Any, what: str, fits: str) -> dict[str, tuple[float, float]]:
    """Return a mapping of names to pairs of numbers."""
    mapping = mapping_of(value, what, f"a mapping of names to {fits}")
    return {name: pair_of(pair, f"{what}[{told(name)}]", fits, finite=False) for name, pair in mapping.items()}


def numbers(values: Any, what: str, fits: str, masked_is_none: bool = False) -> NDArray[np.float64]:
    """Return real numbers as an array. Masked values are refused, or become NaN."""
    if values is None:
        raise ValueError(f"{what}: None; give {fits}")
    try:
        array = np.asanyarray(values)
    except (TypeError, ValueError):
        raise ValueError(f"{what}: {told(values)}; give {fits}") from None
    if array.dtype == object:  # pandas has columns with missing values of this type
        try:
            array = array.astype(np.float64)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(f"{what}: {told(array)}; give {fits}") from None
    if array.dtype.kind not in "biuf":
        raise ValueError(f"{what}: {told(array)}; give {fits}")
    if masked_is_none:
        return np.where(np.broadcast_to(getattr(array, "mask", False), array.shape), np.nan, np.asarray(array, dtype=np.float64))
    _refuse_masked(array, what)
    return np.array(array, dtype=np.float64)


def three(values: Any, what: str, fits: str) -> NDArray[np.float64]:
    """Return three finite numbers."""
    array = numbers(values, what, fits)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{what}: {values!r:.60}; give {fits}")
    return array


def voxel_spacing(spacing_um: Any) -> NDArray[np.float64]:
    """Return the distances of planes, rows and columns of a volume."""
    fits = "three numbers above 0: distances of planes, rows and columns, in µm"
    spacing = three(spacing_um, "spacing_um", fits)
    if not (spacing > 0).all():
        raise ValueError(f"spacing_um: {spacing_um!r:.60}; give {fits}")
    return spacing


def integers(values: Any, what: str) -> NDArray[np.int32]:
    """Return whole numbers of 32 bits as an array."""
    try:
        array = np.asanyarray(values)
    except (TypeError, ValueError):
        raise ValueError(f"{what}: {told(values)}; give whole numbers") from None
    if not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{what}: {told(array)}; give whole numbers")
    _refuse_masked(array, what)
    if array.size and (array.min() < -(2**31) or array.max() >= 2**31):
        raise ValueError(f"{what}: numbers exceed the range of 32-bit integers")
    return np.array(array, dtype=np.int32, order="C")


def _refuse_masked(array: NDArray[Any], what: str) -> None:
    masked = np.count_nonzero(getattr(array, "mask", False))
    if masked:
        raise ValueError(f"{what}: {masked} values are masked; give a value for each, by values.filled(0) for instance")


def per_cell(values: Any, count: int, what: str, item: str = "cell") -> NDArray[np.float64]:
    """Return one number per cell or other item, NaN where it is masked; a single number serves all."""
    fits = f"one number per {item} ({count})"
    array = numbers(values, what, fits, masked_is_none=True)
    if array.ndim == 0:
        array = np.full(count, float(array))
    if array.shape != (count,):
        raise ValueError(f"{what}: {told(array)}; give {fits}")
    return array


def flags(values: Any, count: int, what: str) -> NDArray[np.bool_]:
    """Return one boolean per cell."""
    fits = f"one boolean per cell ({count})"
    try:
        array = np.asanyarray(values)
    except (TypeError, ValueError):
        raise ValueError(f"{what}: {told(values)}; give {fits}") from None
    if array.dtype != np.bool_ or array.shape != (count,):
        raise ValueError(f"{what}: {told(array)}; give {fits}")
    _refuse_masked(array, what)
    return np.array(array, dtype=np.bool_)
