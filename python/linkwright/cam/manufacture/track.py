"""A closed curve with its standstills left out, so that each of its places has one angle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.manufacture.curve import TURN, ClosedCurve, Stretch, stretches

Floats = NDArray[np.float64]

# Samples of the whole curve from which a place finds the nearest: at least that many a stretch, and in all.
_PER_STRETCH, _IN_ALL = 33, 2048

# Rounds of Gauss–Newton from there; each leaves the distance times the curvature of the error.
_ROUNDS = 5

# Places compared with all samples at a time, so that the table fits into memory.
_BLOCK = 2048


@dataclass(frozen=True)
class Track:
    """The stretches of a closed curve in a row; τ counts cam angles along them [rad].

    Without standstills τ is the cam angle.

    Attributes
    ----------
    parts : tuple of Stretch
        The stretches.
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
        """Values of the stretch in which each τ lies."""
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
        """The nearest places of the curve.

        Parameters
        ----------
        places : ndarray, shape (n, 2)
            Places [m].

        Returns
        -------
        tuple of ndarray, shape (n,)
            τ [rad], and distances [m].
        """
        tau, samples = self.sampled
        blocks = np.array_split(places, max(1, len(places) // _BLOCK))
        closest = [((block[:, None] - samples) ** 2).sum(axis=-1).argmin(axis=1) for block in blocks]
        start = tau[np.concatenate(closest)]
        around = 2 * self.period / _PER_STRETCH
        return self.project(places, start, start - around, start + around)

    def project(self, places: Floats, start: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """The nearest places between two others, by Gauss–Newton from a guess.

        Parameters
        ----------
        places : ndarray, shape (…, 2)
            Places [m].
        start : ndarray, shape (…)
            First guesses of τ [rad].
        low, high : ndarray
            Between which τ to look [rad].

        Returns
        -------
        tuple of ndarray, shape (…)
            τ [rad], and distances [m]; a distance is that of a place of the curve, so never too small.
        """
        tau = best = np.clip(start, low, high)
        least = np.full(tau.shape, np.inf)
        for k in range(_ROUNDS):
            off = places - self.points(tau, high)
            distance = np.linalg.norm(off, axis=-1)
            best, least = np.where(distance < least, tau, best), np.minimum(distance, least)
            if k < _ROUNDS - 1:
                t = self.tangents(tau, high)
                square = np.maximum((t**2).sum(axis=-1), np.finfo(float).tiny)
                tau = np.clip(tau + (off * t).sum(axis=-1) / square, low, high)
        return best, least
