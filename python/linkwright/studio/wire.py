"""Messages between server and page: a number, words as JSON, arrays as raw doubles that need no parsing.

| bytes | hold |
| --- | --- |
| 4 | number of the request, which its answers repeat; little-endian, as is all that follows |
| 4 | length of the JSON, a multiple of eight |
| … | the JSON, filled up with blanks; an array stands in it as ``{"$": [first, rows, columns]}`` |
| … | the arrays as doubles, one after another |
"""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats

_HEAD = struct.Struct("<II")
_WORD = 8


class WireError(ValueError):
    """A message that is none."""


def packed(number: int, body: Any) -> bytes:
    """An answer as a message: tables, lists, words, finite numbers, arrays of one or two dimensions."""
    arrays: list[Floats] = []
    size = 0

    def placed(value: Any) -> Any:
        nonlocal size
        if isinstance(value, np.generic):
            return value.item()
        if not isinstance(value, np.ndarray):
            raise TypeError(f"no message holds {type(value).__name__}")
        array = np.ascontiguousarray(value, dtype="<f8")
        first, size = size, size + array.size
        arrays.append(array)
        return {"$": [first, *array.shape]}

    text = json.dumps(
        body, default=placed, ensure_ascii=False, allow_nan=False, separators=(",", ":")
    ).encode()
    text += b" " * (-len(text) % _WORD)
    return b"".join([_HEAD.pack(number, len(text)), text, *(array.tobytes() for array in arrays)])


def unpacked(message: bytes) -> tuple[int, bytes]:
    """Number and JSON of a message that brings a table and no arrays; a `WireError` if it is none."""
    if len(message) < _HEAD.size:
        raise WireError("shorter than its head")
    number, length = _HEAD.unpack_from(message)
    text = message[_HEAD.size : _HEAD.size + length]
    if len(text) != length:
        raise WireError("shorter than it says")
    try:
        body = json.loads(text)
    except (ValueError, RecursionError):
        raise WireError("no JSON") from None
    if not isinstance(body, dict):
        raise WireError("no request")
    return number, text
