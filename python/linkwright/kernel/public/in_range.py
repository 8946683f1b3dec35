"""Numbers that are given to a function: each is a quantity of its kind, finite and within the kind's range.

The ranges are those of the machine file (`linkwright.kernel.units`): no number of 1e300 enters by another
door.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.units.marks import Quantity


def in_range(**arguments: tuple[Any, Quantity]) -> None:
    """Raise `InputError`, which says which and where, unless every number is such a quantity.

    By the name that the message shall have: a number or an array [SI], and the mark of what it is, as
    ``positive(SPEED)``. None, for an argument that was left out, is passed over.
    """
    for name, (value, mark) in arguments.items():
        if value is not None:
            _require(name, value, mark)


def _require(name: str, value: Any, mark: Quantity) -> None:
    if type(value) is float and mark.holds(value):
        return
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: found {show(value)}, expected {_wanted(mark)}") from None
    for place in _suspects(numbers):
        number = float(numbers.flat[place])
        if not mark.holds(number):
            where = f" at index {place}" if numbers.ndim else ""
            remedy = f"; {hint}" if (hint := mark.remedy(number)) else ""
            raise InputError(f"{name}: found {number:g}{where}, expected {_wanted(mark)}{remedy}")


def _suspects(numbers: Floats) -> list[int]:
    """Places of the numbers that are wrong if any is: not finite, the extremes, the minimum above 0."""
    if not numbers.size:
        return []
    places = [int(np.argmin(np.isfinite(numbers))), int(np.argmin(numbers)), int(np.argmax(numbers))]
    above = np.where(numbers > 0, numbers, np.inf)
    return [*places, int(np.argmin(above))]


def _wanted(mark: Quantity) -> str:
    unit = f" in {mark.kind.unit_word}" if mark.kind.unit else ""
    return f"{mark.kind.word}{mark.bound.words.rstrip(',')}{unit}"
