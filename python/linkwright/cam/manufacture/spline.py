"""A closed B-spline in the plane: degree, knots, control points.

Source: de Boor, *A Practical Guide to Splines* (1978), chapter X.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Whole = NDArray[np.intp]

# Samples of a piece from which a place finds the nearest, and rounds of Gauss–Newton from there.
_SAMPLES, _ROUNDS = 9, 4


@dataclass(frozen=True)
class Spline:
    """A closed B-spline with equal weights.

    Attributes
    ----------
    degree : int
        3 or 5.
    knots : ndarray, shape (n + degree + 1,)
        [rad].
    controls : ndarray, shape (n, 2)
        Control points; the last is the first again [m].
    """

    degree: int
    knots: Floats
    controls: Floats

    @cached_property
    def cuts(self) -> Floats:
        """The different knots, (k + 1,) [rad]."""
        return np.unique(self.knots)

    @cached_property
    def vertices(self) -> Floats:
        """Where the pieces begin, (k, 2) [m]."""
        return self.values(self.cuts[:-1])[0]

    def values(self, x: Floats) -> tuple[Floats, Floats]:
        """Places and first derivatives by de Boor's recursion.

        Parameters
        ----------
        x : ndarray, shape (…)
            Values of the parameter [rad].

        Returns
        -------
        tuple of ndarray, shape (…, 2)
            [m], [m/rad].
        """
        k, t = self.degree, self.knots
        span = np.clip(np.searchsorted(t, x, "right") - 1, k, len(self.controls) - 1)
        d = [self.controls[span - k + j] for j in range(k + 1)]
        for r in range(1, k + 1):
            if r == k:
                slope = k * (d[k] - d[k - 1]) / (t[span + 1] - t[span])[..., None]
            for j in range(k, r - 1, -1):
                low, high = t[span + j - k], t[span + 1 + j - r]
                share = ((x - low) / (high - low))[..., None]
                d[j] = (1 - share) * d[j - 1] + share * d[j]
        return d[k], slope

    def at(self, which: Whole, u: Floats) -> Floats:
        """Places on pieces (k,) at shares (k, m) of them, (k, m, 2) [m]."""
        return self.evaluated.at(which, u)

    def distances(self, which: Whole, places: Floats) -> Floats:
        """Distance of places (k, m, 2) from pieces (k,), (k, m) [m]."""
        return self.evaluated.distances(which, places)

    @property
    def evaluated(self) -> EvaluatedSpline:
        """The spline as a path in pieces."""
        return EvaluatedSpline(self.cuts, self.values)


@dataclass(frozen=True)
class EvaluatedSpline:
    """A closed path in pieces, by whatever evaluates it.

    Attributes
    ----------
    cuts : ndarray, shape (n + 1,)
        Ends of the pieces, in the parameter of the path.
    values : callable
        From parameters of any shape to places [m] and first derivatives, (…, 2) each.
    """

    cuts: Floats
    values: Callable[[Floats], tuple[Floats, Floats]]

    @cached_property
    def vertices(self) -> Floats:
        """Where the pieces begin, (n, 2) [m]."""
        return self.values(self.cuts[:-1])[0]

    def at(self, which: Whole, u: Floats) -> Floats:
        """Places on pieces (k,) at shares (k, m) of them, (k, m, 2) [m]."""
        low = self.cuts[which][:, None]
        return self.values(low + u * (self.cuts[which + 1][:, None] - low))[0]

    def distances(self, which: Whole, places: Floats) -> Floats:
        """Distance of places from pieces, by Gauss–Newton from the nearest of samples.

        Parameters
        ----------
        which : ndarray, shape (k,)
            Numbers of pieces.
        places : ndarray, shape (k, m, 2)
            For each its places [m].

        Returns
        -------
        ndarray, shape (k, m)
            Never too small [m].
        """
        low, high = self.cuts[which][:, None], self.cuts[which + 1][:, None]
        samples = low + (high - low) * np.linspace(0, 1, _SAMPLES)
        gaps = np.linalg.norm(places[:, :, None] - self.values(samples)[0][:, None], axis=-1)
        x = np.take_along_axis(samples, gaps.argmin(axis=-1), axis=1)
        least = gaps.min(axis=-1)
        for _ in range(_ROUNDS):
            place, slope = self.values(x)
            off = places - place
            least = np.minimum(least, np.linalg.norm(off, axis=-1))
            square = np.maximum((slope**2).sum(axis=-1), np.finfo(float).tiny)
            x = np.clip(x + (off * slope).sum(axis=-1) / square, low, high)
        return np.asarray(least)
