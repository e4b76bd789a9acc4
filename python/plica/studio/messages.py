"""Messages to the page: problems, and binary ones: the length of a JSON head, the head, and arrays of four-byte numbers."""
from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ScenarioError


def packed(head: dict[str, Any], arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Pack a head and arrays, of type float32 or uint32. The arrays begin at a multiple of four bytes."""
    index = [[name, array.dtype.kind, array.size] for name, array in arrays.items()]
    text = json.dumps({**head, "arrays": index}, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return b"".join([struct.pack("<I", len(text)), text,
        *(np.ascontiguousarray(array).tobytes() for array in arrays.values())])


def problem_of(error: Exception) -> dict[str, Any]:
    """Describe an error to the page: as a text, and by key where the scenario has one."""
    by_key = [{"key": one.key, "text": one.problem + (f"; {one.remedy}" if one.remedy else "")}
              for one in error.diagnostics] if isinstance(error, ScenarioError) else []
    text = "\n".join(f"{one['key']}: {one['text']}" for one in by_key) if by_key else str(error)
    return {"text": text or type(error).__name__, "by_key": by_key}
