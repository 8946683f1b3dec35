"""What is to be manufactured: a closed curve over the cam angle, smooth from break to break.

A curve may turn its direction suddenly at a break (a corner), and it may stand still over a whole stretch: a
corner too. What it may not do is turn back on itself inside a stretch: there a profile is undercut, and has
no outline.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import ExchangeError

Floats = NDArray[np.float64]
Side = Literal["after", "before"]

TURN = 2 * math.pi

# Samples of a stretch in which its size and its turning back are looked for, and rounds of looking closer.
_SAMPLES, _ROUNDS = 257, 4

# A gap at a break, or a whole stretch, below this share of the size is rounding.
SAME = 1e-9

# Share of the way to the middle of a stretch from which the direction at a place of no speed is taken: the
# error of the direction is of this order.
_NUDGE = 1e-7


class ClosedCurve(Protocol):
    """A closed curve over the cam angle.

    Attributes
    ----------
    breaks : tuple of float
        Cam angles from 0 to 2π, both included, between which the curve is smooth [rad].
    """

    @property
    def breaks(self) -> tuple[float, ...]:
        """Cam angles from 0 to 2π between which the curve is smooth [rad]."""

    def points(self, phi: Floats, side: Side = "after") -> Floats:
        """Places over cam angles of shape (n,), (n, 2) [m]; ``side`` says which stretch counts at a break."""

    def tangents(self, phi: Floats, side: Side = "after") -> Floats:
        """First derivative by the cam angle, (n, 2) [m/rad]."""

    def seconds(self, phi: Floats, side: Side = "after") -> Floats:
        """Second derivative by the cam angle, (n, 2) [m/rad²]."""


@dataclass(frozen=True)
class Stretch:
    """A smooth part of a closed curve.

    Attributes
    ----------
    curve : ClosedCurve
        The curve.
    low, high : float
        Its ends [rad].
    """

    curve: ClosedCurve
    low: float
    high: float

    def points(self, phi: Floats) -> Floats:
        """Places at cam angles of any shape, (…, 2) [m]."""
        return self._at("points", phi)

    def tangents(self, phi: Floats) -> Floats:
        """First derivative by the cam angle, (…, 2) [m/rad]."""
        return self._at("tangents", phi)

    def seconds(self, phi: Floats) -> Floats:
        """Second derivative by the cam angle, (…, 2) [m/rad²]."""
        return self._at("seconds", phi)

    def directions(self, phi: Floats) -> Floats:
        """Unit tangents, (…, 2); where the curve stands still, those from inside."""
        t = self.tangents(phi)
        speed = np.linalg.norm(t, axis=-1)
        still = speed <= SAME * float(np.linalg.norm(self.tangents(self._middle), axis=-1))
        if still.any():
            inside = np.where(still, phi + _NUDGE * (self._middle - phi), phi)
            t = self.tangents(inside)
            speed = np.linalg.norm(t, axis=-1)
        return np.asarray(t / speed[..., None])

    @property
    def _middle(self) -> Floats:
        """The cam angle half way."""
        return np.array(0.5 * (self.low + self.high))

    def _at(self, what: str, phi: Floats) -> Floats:
        """Values seen from inside the stretch, also at its ends."""
        phi = np.asarray(phi, dtype=float)
        flat = np.clip(phi.ravel(), self.low, self.high)
        values = np.asarray(getattr(self.curve, what)(flat, side="after"))
        last = flat >= self.high
        if last.any():
            values = values.copy()
            values[last] = getattr(self.curve, what)(flat[last], side="before")
        return values.reshape(*phi.shape, 2)


def size(curve: ClosedCurve) -> float:
    """The larger side of the rectangle round a curve, as far as samples show it [m]."""
    samples = np.concatenate([_samples(low, high) for low, high in _pairs(curve)])
    places = curve.points(samples)
    return float(np.ptp(places, axis=0).max())


def stretches(curve: ClosedCurve) -> tuple[Stretch, ...]:
    """The smooth parts of a curve that have a length, in order.

    Parameters
    ----------
    curve : ClosedCurve
        The curve.

    Returns
    -------
    tuple of Stretch
        They follow one another without gaps; where one stretch meets the next there may be a corner.

    Raises
    ------
    ExchangeError
        The curve has gaps, is not finite, or turns back on itself inside a stretch.
    """
    whole = size(curve)
    if not whole > 0:
        raise ExchangeError(f"the curve has no size ({whole:g} m): it is a point, or has no finite places")
    parts = [Stretch(curve, low, high) for low, high in _pairs(curve)]
    _refuse_gaps(parts, whole)
    kept = tuple(part for part in parts if _extent(part) > SAME * whole)
    for part in kept:
        _refuse_cusps(part)
    return kept


def _pairs(curve: ClosedCurve) -> list[tuple[float, float]]:
    """Ends of the stretches of a curve."""
    return list(zip(curve.breaks[:-1], curve.breaks[1:], strict=True))


def _samples(low: float, high: float) -> Floats:
    """Equal steps from end to end."""
    return np.linspace(low, high, _SAMPLES)


def _extent(part: Stretch) -> float:
    """The larger side of the rectangle round a stretch [m]."""
    return float(np.ptp(part.points(_samples(part.low, part.high)), axis=0).max())


def _refuse_gaps(parts: list[Stretch], whole: float) -> None:
    """Each stretch begins where the one before it ends, the first where the last ends."""
    for before, after in zip(parts[-1:] + parts[:-1], parts, strict=True):
        gap = after.points(np.array([after.low]))[0] - before.points(np.array([before.high]))[0]
        length = math.hypot(*gap)
        if not length <= SAME * whole:
            raise ExchangeError(
                f"the curve has a gap of {1e3 * length:.6g} mm at cam angle {math.degrees(after.low):.6g}°: "
                "only a closed outline can be manufactured; choose a motion law that closes there"
            )


def _refuse_cusps(part: Stretch) -> None:
    """The direction of a stretch turns smoothly, however closely one looks."""
    phi = _samples(part.low, part.high)
    for _ in range(_ROUNDS):
        t = part.tangents(phi)
        back = np.flatnonzero(np.einsum("ij,ij->i", t[:-1], t[1:]) < 0)
        if not back.size:
            return
        i = int(back[0])
        phi = _samples(phi[i], phi[i + 1])
    raise ExchangeError(
        f"the curve turns back on itself at cam angle {math.degrees(phi[0]):.6g}°: it is undercut "
        "there and has no outline; a larger base circle, a smaller roller or cutter, or a softer motion law "
        "gives one"
    )
