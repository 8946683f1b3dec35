"""The closed curve of a cam, and points on it by arc length.

It is smooth over the cam angle from break to break. It may turn its direction suddenly at a break (a corner),
and it may be at rest over a whole stretch: a corner too. What it may not do is turn back on itself inside a
stretch: there a profile is undercut, and has no outline.

With its standstills left out, each of its places has one angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, Protocol

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ExchangeError

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
    """A smooth part of a closed curve."""

    curve: ClosedCurve
    # low, high: its ends [rad].
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
        """Unit tangents, (…, 2); where the curve is at rest, those from inside."""
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
    """The smooth parts of a curve that have a length, in order."""
    extent = size(curve)
    if not extent > 0:
        raise ExchangeError(f"the curve has no size ({extent:g} m): it is a point, or has no finite places")
    parts = [Stretch(curve, low, high) for low, high in _pairs(curve)]
    _refuse_gaps(parts, extent)
    kept = tuple(part for part in parts if _extent(part) > SAME * extent)
    for part in kept:
        _refuse_cusps(part)
    return kept


def _pairs(curve: ClosedCurve) -> list[tuple[float, float]]:
    return list(zip(curve.breaks[:-1], curve.breaks[1:], strict=True))


def _samples(low: float, high: float) -> Floats:
    return np.linspace(low, high, _SAMPLES)


def _extent(part: Stretch) -> float:
    """The larger side of the rectangle round a stretch [m]."""
    return float(np.ptp(part.points(_samples(part.low, part.high)), axis=0).max())


def _refuse_gaps(parts: list[Stretch], extent: float) -> None:
    for before, after in zip(parts[-1:] + parts[:-1], parts, strict=True):
        gap = after.points(np.array([after.low]))[0] - before.points(np.array([before.high]))[0]
        length = math.hypot(*gap)
        if not length <= SAME * extent:
            raise ExchangeError(
                f"the curve has a gap of {1e3 * length:.6g} mm at cam angle θ = "
                f"{math.degrees(after.low):.6g}°: "
                "only a closed outline can be manufactured; choose a motion law that closes there"
            )


def _refuse_cusps(part: Stretch) -> None:
    phi = _samples(part.low, part.high)
    for _ in range(_ROUNDS):
        t = part.tangents(phi)
        back = np.flatnonzero(np.einsum("ij,ij->i", t[:-1], t[1:]) < 0)
        if not back.size:
            return
        i = int(back[0])
        phi = _samples(phi[i], phi[i + 1])
    raise ExchangeError(
        f"the curve turns back on itself at cam angle θ = {math.degrees(phi[0]):.6g}°: it is undercut "
        "there and has no outline; a larger base circle, a smaller roller or cutter, or a softer motion law "
        "gives one"
    )


# Samples of the whole curve from which a place finds the nearest: at least that many a stretch, and in all.
_PER_STRETCH, _IN_ALL = 33, 2048

# Rounds of Gauss–Newton from there; each leaves the distance times the curvature of the error.
_NEAREST_ROUNDS = 5

# Places compared with all samples at a time, so that the table fits into memory.
_BLOCK = 2048


@dataclass(frozen=True)
class Track:
    """The stretches of a closed curve in a row; τ counts cam angles along them [rad].

    Without standstills τ is the cam angle.
    """

    parts: tuple[Stretch, ...]

    @classmethod
    def of(cls, curve: ClosedCurve) -> Track:
        """The track of a curve; refuses what has no outline."""
        return cls(stretches(curve))

    @cached_property
    def ends(self) -> Floats:
        """τ at the start of each stretch, and at the end of the last, (n + 1,) [rad]."""
        return np.concatenate([[0.0], np.cumsum([part.high - part.low for part in self.parts])])

    @property
    def period(self) -> float:
        """τ of the whole curve [rad]."""
        return float(self.ends[-1])

    def points(self, tau: Floats, end: Floats | float = np.inf) -> Floats:
        """Places, (…, 2) [m]; from ``end`` on, those before it."""
        return self._at("points", tau, end)

    def tangents(self, tau: Floats, end: Floats | float = np.inf) -> Floats:
        """First derivatives, (…, 2) [m/rad]; from ``end`` on, those before it."""
        return self._at("tangents", tau, end)

    def at_cam_angles(self, phi: Floats) -> Floats:
        """τ of cam angles (n,); within a standstill that of its end."""
        low, high = np.array([[part.low, part.high] for part in self.parts]).T
        turns = np.floor(phi / TURN)
        inside = phi - TURN * turns
        index = np.clip(np.searchsorted(low, inside, "right") - 1, 0, len(low) - 1)
        tau = self.ends[index] + np.clip(inside, low[index], high[index]) - low[index]
        return np.asarray(tau + turns * self.period)

    def angles(self, tau: Floats) -> Floats:
        """Cam angles of τ (n,), each revolution on [rad]."""
        turns = np.floor(tau / self.period)
        inside = tau - self.period * turns
        low = np.array([part.low for part in self.parts])
        index = np.clip(np.searchsorted(self.ends, inside, "right") - 1, 0, len(low) - 1)
        return np.asarray(low[index] + inside - self.ends[index] + TURN * turns)

    def _at(self, what: str, tau: Floats, end: Floats | float) -> Floats:
        before = tau >= end
        wrapped = tau % self.period
        wrapped = np.where(before & (wrapped == 0), self.period, wrapped)
        inner = self.ends[1:-1]
        index = np.where(before, np.searchsorted(inner, wrapped), np.searchsorted(inner, wrapped, "right"))
        values = np.empty((*tau.shape, 2))
        for i in np.unique(index):
            here = index == i
            part = self.parts[i]
            values[here] = getattr(part, what)(part.low + (wrapped[here] - self.ends[i]))
        return values

    def seconds(self, tau: Floats, end: Floats | float = np.inf) -> Floats:
        """Second derivatives, (…, 2) [m/rad²]; from ``end`` on, those before it."""
        return self._at("seconds", tau, end)

    @cached_property
    def sense(self) -> int:
        """1 if the curve runs counter-clockwise, else −1."""
        _, place = self.sampled
        x, y = place.T
        return 1 if (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0 else -1

    @cached_property
    def sampled(self) -> tuple[Floats, Floats]:
        """τ (n,) and places (n, 2) along the whole curve, with both ends of each stretch."""
        shares = np.diff(self.ends) / self.period
        counts = np.maximum(_PER_STRETCH, (_IN_ALL * shares).astype(int))
        phi = [np.linspace(part.low, part.high, n) for part, n in zip(self.parts, counts, strict=True)]
        tau = [x - part.low + low for x, part, low in zip(phi, self.parts, self.ends, strict=False)]
        places = [part.points(x) for x, part in zip(phi, self.parts, strict=True)]
        return np.concatenate(tau), np.concatenate(places)

    def nearest(self, places: Floats) -> tuple[Floats, Floats]:
        """τ [rad] of the nearest places of the curve to ``places`` (n, 2) [m], and distances [m], (n,)."""
        tau, samples = self.sampled
        blocks = np.array_split(places, max(1, len(places) // _BLOCK))
        closest = [((block[:, None] - samples) ** 2).sum(axis=-1).argmin(axis=1) for block in blocks]
        start = tau[np.concatenate(closest)]
        around = 2 * self.period / _PER_STRETCH
        return self.project(places, start, start - around, start + around)

    def project(self, places: Floats, start: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """The nearest places between two others, by Gauss–Newton from a guess.

        ``places`` (…, 2): places [m]; ``start`` (…): first guesses of τ [rad]; ``low``, ``high``: between
        which τ to look [rad] → τ [rad], and distances [m]; a distance is that of a place of the curve, so
        never too small, (…).
        """
        tau = best = np.clip(start, low, high)
        least = np.full(tau.shape, np.inf)
        for k in range(_NEAREST_ROUNDS):
            off = places - self.points(tau, high)
            distance = np.linalg.norm(off, axis=-1)
            best, least = np.where(distance < least, tau, best), np.minimum(distance, least)
            if k < _NEAREST_ROUNDS - 1:
                t = self.tangents(tau, high)
                square = np.maximum((t**2).sum(axis=-1), np.finfo(float).tiny)
                tau = np.clip(tau + (off * t).sum(axis=-1) / square, low, high)
        return best, least
