"""Extremes with their derivatives: which rivals tie, and by which entries their derivatives differ.

An extreme has the derivative of its curve at its place (envelope theorem). Where it is reached twice, it has
the derivatives that both places have in common; by entries that they follow differently there are only
one-sided ones, which are NaN.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal, variables_of

# Extremes this near, as a share of their size or of the curve's range, tie: what is known to rounding, and
# what is solved for or looked for.
TIE, TIE_OF_SOLVED = 1e-9, 1e-7

# Derivatives of rivals that differ by less than this share of their scale are the same, likewise.
ALIKE, ALIKE_OF_SOLVED = 1e-8, 1e-5

# A kink that moves by less than this [rad] for its entry doubled stays where it is.
_STAYS = 1e-12

# How far a rival may seem to stay below the extreme before it is read more closely, as a share of the range:
# far more than the angles of a first look leave.
_DOUBT = 1e-2

# Readings of each round in which a peak is closed in on: the interval shrinks to an eighth, and what the
# height lacks to a 64th, from round to round.
READINGS = 17

# Places and entries that a sentence lists.
_LISTED = 4


def apart(slopes: Floats, scale: Any = None, alike: float = ALIKE) -> Bools:
    """Where the derivatives of rivals, (rivals, n), differ from those of the first, (rivals, n).

    `scale`: size of derivatives, or by entry (n,); without it that of the largest.
    """
    if scale is None:
        scale = np.nanmax(np.abs(slopes), initial=0.0)
    return np.asarray(~(np.abs(slopes - slopes[0]) <= alike * scale))


def differ(slopes: Floats, scale: Any = None, alike: float = ALIKE) -> Bools:
    """By which entries the derivatives of rivals differ, (n,)."""
    return np.asarray(apart(slopes, scale, alike).any(axis=0))


def common(slopes: Floats, scale: Any = None, alike: float = ALIKE) -> Floats:
    """The derivatives that rivals have in common, (n,); NaN where theirs differ."""
    return np.where(differ(slopes, scale, alike), np.nan, slopes[0])


def off(angles: Floats, angle: float, cycle: float = 2 * np.pi) -> Floats:
    """How far angles are from another one round the cycle [rad]."""
    half = 0.5 * cycle
    return np.asarray(np.abs((angles - angle + half) % cycle - half))


def as_high(
    read: Callable[[Floats], Floats],
    looked: tuple[Floats, Floats],
    top: tuple[float, float],
    cycle: float,
    *,
    near: float,
    rounds: int,
) -> list[float]:
    """Angles of the highest peak and of all that are as high, increasing [rad].

    `read`: values at angles of any shape; `looked`: angles of a first look over the cycle, increasing, and
    the values there; `top`: angle and height of the highest peak; peaks nearer than `near` are one.
    """
    (angles, values), (at, height) = looked, top
    span = float(np.ptp(values))
    high = np.flatnonzero(values >= height - _DOUBT * span)
    before, behind = high - 1, (high + 1) % len(values)
    is_peak = (values[high] >= values[before]) & (values[high] > values[behind])
    is_peak &= off(angles[high], at, cycle) > near
    if not is_peak.any():
        return [at]
    peaks = high[is_peak]
    low = angles[before[is_peak]] - cycle * (peaks == 0)
    end = angles[behind[is_peak]] + cycle * (peaks == len(values) - 1)
    rows = np.arange(len(peaks))
    for _ in range(rounds):
        places = np.linspace(low, end, READINGS, axis=-1)
        heights = read(places)
        best = heights.argmax(axis=-1)
        low, end = (places[rows, np.clip(best + way, 0, READINGS - 1)] for way in (-1, 1))
    found = [at]
    for angle in places[rows, best][heights[rows, best] >= height - TIE_OF_SOLVED * span] % cycle:
        if off(np.array(found), angle, cycle).min() > near:
            found.append(float(angle))
    return sorted(found)


@dataclass(frozen=True)
class Kinks:
    """Crank angles at which loads or motion have a kink or jump, and the entries that move them."""

    variables: Sequence[str]
    angles: Floats  # (k,) [rad]
    cycle: float  # [rad]
    moves: Bools  # (k, n)

    @classmethod
    def of(cls, compiled: Any, along: Any) -> Kinks:
        """Those of a compiled machine along directions of its numbers."""
        angles = compiled.kinks()
        moves = np.abs(compiled.kinks_along(along.values, angles) * along.sizes) > _STAYS
        return cls(along.variables, angles, compiled.cycle, moves)

    def moved_at(self, angle: float, near: float) -> Bools:
        """Which variables move a kink at a crank angle that is known to an angle `near` [rad], (n,)."""
        return np.asarray(self.moves[off(self.angles, angle, self.cycle) <= near].any(axis=0))

    def moved_near(self, angles: Floats, near: float) -> list[float]:
        """Kinks that lie on some angles and that a variable moves."""
        on = [kink for kink in self.angles.tolist() if (off(angles, kink, self.cycle) <= near).any()]
        return [kink for kink in on if self.moved_at(kink, near).any()]

    def extreme(self, value: float, d: Floats, angle: float, moving: Bools) -> tuple[Tangent, str]:
        """An extreme beside a kink that variables move, by which it has no derivatives, and why."""
        why = self.words(angle, moving) if moving.any() else ""
        return Tangent(value, np.where(moving, np.nan, d)), why

    def words(self, angle: float, moving: Bools) -> str:
        """Which entries have no derivative there."""
        kink = float(self.angles[off(self.angles, angle, self.cycle).argmin()])
        return (
            f"the extreme occurs at {degrees(kink)}, at a kink of loads or motion; there is no derivative "
            f"with respect to the entries that move this kink: {', '.join(chosen(self.variables, moving))}"
        )


def degrees(angle: float) -> str:
    """An angle [rad] as it is named."""
    return f"{np.degrees(angle):.4g}°"


def chosen(entries: Sequence[str], by: Bools) -> list[str]:
    """Some of the entries."""
    return [entry for entry, yes in zip(entries, by, strict=True) if yes]


def occurs_at(angles: Iterable[float], differing: Sequence[str] = (), *, of: str = "") -> str:
    """At which angles [rad] an extreme occurs, and by which entries derivatives differ there.

    `of`: what has the angles, ``"crank angles "``.
    """
    places = list(dict.fromkeys(map(degrees, angles)))
    words = f"the extreme occurs at {of}{_listed(places, ' and ', 'angles')}"
    return f"{words}; {they_differ(differing)}" if differing else words


def they_differ(entries: Sequence[str]) -> str:
    """By which entries derivatives differ."""
    return f"the derivatives with respect to {_listed(entries, ', ', 'entries')} differ"


def _listed(words: Sequence[str], between: str, what: str) -> str:
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
    return Tangent(primal(first), common(np.stack(rivals)))


def least(*numbers: Any) -> Any:
    """The minimum, likewise."""
    return -greatest(*(-x for x in numbers))


def size(x: Any) -> Any:
    """The size of a number; at zero it has no derivative by what moves it."""
    n = variables_of((x,))
    return abs(x) if n is None else np.abs(lifted(x, n))
