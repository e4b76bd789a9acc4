"""Binary messages to the page: the length of a JSON head, the head, and arrays of four-byte numbers that it lists."""
from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray


def packed(head: dict[str, Any], arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Pack a head and arrays, of type float32 or uint32. The arrays begin at a multiple of four bytes."""
    index = [[name, array.dtype.kind, array.size] for name, array in arrays.items()]
    text = json.dumps({**head, "arrays": index}, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return b"".join([struct.pack("<I", len(text)), text,
        *(np.ascontiguousarray(array).tobytes() for array in arrays.values())])
