"""Extremes with their derivatives: which rivals tie, and by which entries their derivatives differ.

An extreme has the derivative of its curve at its place (envelope theorem). Where it is reached twice, it has
the derivatives that both places have in common; by entries that they follow differently there are only
one-sided ones, which are NaN.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.numerics.tangent_array import TangentArray, lifted, primal, variables_of

# Extremes this near, as a share of their size or of the curve's range, tie: what is known to rounding, and
# what is solved for or looked for.
TIE, TIE_OF_SOLVED = 1e-9, 1e-7

# Derivatives of rivals that differ by less than this share of their scale are the same, likewise.
ALIKE, ALIKE_OF_SOLVED = 1e-8, 1e-6

# Places and entries that a sentence lists.
_LISTED = 4


def apart(slopes: Floats, scale: Any = None, alike: float = ALIKE) -> Bools:
    """Where the derivatives of rivals, (rivals, n), differ from those of the first, (rivals, n).

    `scale`: size of derivatives, or by entry (n,); without it that of the largest.
    """
    if scale is None:
        scale = np.nanmax(np.abs(slopes), initial=0.0)
    return np.asarray(~(np.abs(slopes - slopes[0]) <= alike * scale))


def common(slopes: Floats, scale: Any = None, alike: float = ALIKE) -> Floats:
    """The derivatives that rivals have in common, (n,); NaN where theirs differ."""
    return np.where(apart(slopes, scale, alike).any(axis=0), np.nan, slopes[0])


def degrees(angle: float) -> str:
    """An angle [rad] as it is named."""
    return f"{np.degrees(angle):.4g}°"


def occurs_at(places: Iterable[str], differ: Sequence[str] = ()) -> str:
    """Where an extreme occurs, and by which entries derivatives differ there."""
    words = f"the extreme occurs at {listed([*places], ' and ', 'angles')}"
    return f"{words}; {they_differ(differ)}" if differ else words


def they_differ(entries: Sequence[str]) -> str:
    """By which entries derivatives differ."""
    return f"the derivatives with respect to {listed(entries, ', ', 'entries')} differ"


def listed(words: Sequence[str], between: str, what: str) -> str:
    """The first of some words, and how many more there are; of one more it is the word."""
    rest = [f"{len(words) - _LISTED} {what} more"] if len(words) > _LISTED + 1 else words[_LISTED:]
    return between.join([*words[:_LISTED], *rest])


def greatest(*numbers: Any) -> Any:
    """The maximum of numbers; where several are as large, with the derivatives that they have in common."""
    first, n = max(numbers, key=primal), variables_of(numbers)
    if n is None:
        return first
    near = primal(first) - TIE * abs(primal(first))
    rivals = [lifted(x, n).d for x in (first, *numbers) if primal(x) >= near]
    return TangentArray(primal(first), common(np.stack(rivals)))


def least(*numbers: Any) -> Any:
    """The minimum, likewise."""
    return -greatest(*(-x for x in numbers))


def size(x: Any) -> Any:
    """The size of a number; at zero it has no derivative by what moves it."""
    n = variables_of((x,))
    return abs(x if n is None else lifted(x, n))
