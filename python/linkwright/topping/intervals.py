r"""Shares and means of a sample in clusters, and the confidence intervals that hold the true ones.

Roots of a row are not independent where their phases follow one another, nor are the looks at one root in
many phases: the row, or the root, is what was drawn at random. With the sum :math:`y_c` and the number
:math:`n_c` of each of C clusters the mean and its variance are

.. math:: \bar y = \frac{\sum y_c}{\sum n_c}, \qquad
    s^2 = \frac{C}{C - 1}\,\frac{\sum (y_c - \bar y\,n_c)^2}{(\sum n_c)^2}

and the interval is :math:`\bar y \pm t\,s` with Student's t for C − 1 degrees of freedom.

Shares p near 0 or 1 would get an interval that is too short, or none at all. They get Wilson's,

.. math:: \frac{p + \frac{t^2}{2n} \pm t\sqrt{\frac{p(1-p)}{n} + \frac{t^2}{4n^2}}}{1 + \frac{t^2}{n}}, \qquad
    n = \frac{p(1 - p)}{s^2},

with the number n of independent pieces that would have the same variance; never more than there are, where
each piece is counted or is not. Of exactly 0 and 1 the variance says nothing: there n is the number of pieces
if they are independent, else what other shares of the same pieces are worth (`ShareCurve.worth`), or without
such the number of clusters.

The share of heads cut through, against the length of the edge, is the distribution function of the lengths
needed; the interval of a quantile is that of the share at its length, read off the same curve [4].

References
----------
.. [1] Cochran, *Sampling Techniques*, 3rd ed. 1977, 2.11 and 9A.
.. [2] Wilson, Probable inference, J. Amer. Statist. Assoc. 22 (1927) 209-212.
.. [3] Korn, Graubard, Confidence intervals for proportions with small expected number of positive counts
   estimated from survey data, Survey Methodology 24 (1998) 193-201.
.. [4] Woodruff, Confidence intervals for medians and other position measures, J. Amer. Statist. Assoc. 47
   (1952) 635-646.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.kernel.numerics.confidence import coverage_factor


class Interval(NamedTuple):
    """Estimates and what holds the true ones; arrays (k,), or numbers.

    Attributes
    ----------
    value, low, high : ndarray, shape (k,)
        Of each quantity.
    """

    value: Floats
    low: Floats
    high: Floats


@dataclass(frozen=True)
class Clusters:
    """How pieces of a sample belong together.

    Attributes
    ----------
    of : ndarray of int, shape (n,)
        Cluster of each piece, from 0.
    count : int
        How many clusters, at least 2.
    are_free : bool
        Whether pieces of a cluster are independent all the same.
    level : float
        Confidence level of the intervals.
    worth : float, optional
        Number of independent pieces that shares of 0 and 1 are worth, where pieces depend on one another.
    """

    of: Indices
    count: int
    are_free: bool
    level: float = 0.95
    worth: float | None = None

    @property
    def sizes(self) -> Floats:
        """Pieces in each cluster."""
        return np.asarray(np.bincount(self.of, minlength=self.count), dtype=float)

    @property
    def factor(self) -> float:
        """Student's t."""
        return coverage_factor(self.level, self.count - 1)

    def sums(self, values: Floats) -> Floats:
        """Sum of values (n,), one for each piece, in each cluster, (clusters,)."""
        return np.asarray(np.bincount(self.of, values, minlength=self.count), dtype=float)

    def mean(self, values: Floats) -> Interval:
        """Mean of a quantity that is not negative, (n,) a value for each piece."""
        return self.ratio(values, np.ones(len(values)))

    def ratio(self, values: Floats, sizes: Floats) -> Interval:
        """Sum of a quantity that is not negative over the sum of another, (n,) each, sizes not negative."""
        mean, variance = self._moments(self.sums(values), self.sums(sizes))
        half = self.factor * np.sqrt(variance)
        return Interval(mean, np.maximum(mean - half, 0.0), mean + half)

    def share(self, values: Floats) -> Interval:
        """Mean of a quantity that is between 0 and 1, (n,) a value for each piece."""
        return self._wilson(self.sums(values), np.inf)

    def shares(self, counts: Floats) -> Interval:
        """Shares of pieces that are something or are not, by how many of each cluster are, (clusters, k)."""
        return self._wilson(counts, float(len(self.of)))

    def _wilson(self, sums: Floats, most: float) -> Interval:
        """Wilson's interval with the effective sample size of the variance, at most `most`."""
        p, worth = self._worth(sums, most)
        spread = p * (1 - p)
        square = self.factor**2 / np.where(spread > 0, worth, self._at_ends)
        middle = (p + 0.5 * square) / (1 + square)
        half = np.sqrt(square * (spread + 0.25 * square)) / (1 + square)
        return Interval(p, np.clip(middle - half, 0.0, p), np.clip(middle + half, p, 1.0))

    def worths(self, counts: Floats) -> Floats:
        """Numbers of independent pieces whose shares would have the same variance, (k,); NaN for shares of 0
        and 1.

        `counts`: (clusters, k), how many pieces of each cluster are.
        """
        p, worth = self._worth(counts, float(len(self.of)))
        return np.where(p * (1 - p) > 0, worth, np.nan)

    @property
    def _at_ends(self) -> float:
        """Effective sample size for shares of 0 and 1."""
        if self.are_free:
            return float(len(self.of))
        return float(self.count) if self.worth is None else self.worth

    def _worth(self, sums: Floats, most: float) -> tuple[Floats, Floats]:
        """Shares, and the effective sample size of each, at most `most`."""
        p, variance = self._moments(sums, self.sizes)
        # A mean of ones may be off by rounding.
        p = np.clip(p, 0.0, 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            return p, np.asarray(np.minimum(p * (1 - p) / variance, most))

    def _moments(self, sums: Floats, sizes: Floats) -> tuple[Floats, Floats]:
        total, many = sizes.sum(), self.count
        mean = sums.sum(axis=0) / total
        apart = sums - np.multiply.outer(sizes, mean)
        return np.asarray(mean), np.asarray(many / (many - 1) * (apart**2).sum(axis=0) / total**2)


# Shares of heads whose length is reported.
QUANTILES = (0.5, 0.9, 0.95, 0.99, 0.999)


@dataclass(frozen=True)
class ShareCurve:
    """Share of heads over the length of the edge.

    Attributes
    ----------
    needed : ndarray, shape (n,)
        Length that each head needs [m]; infinite for one that cannot be cut.
    clusters : Clusters
        How heads belong together.
    """

    needed: Floats
    clusters: Clusters

    def at(self, length: Floats) -> Interval:
        """Shares at increasing lengths (k,) [m], each length by itself."""
        return self.clusters.shares(self._counts(length))

    def _counts(self, length: Floats) -> Floats:
        # The first of the lengths that is enough for each head.
        k = len(length)
        first = np.searchsorted(length, self.needed)
        cells = self.clusters.of * (k + 1) + first
        table = np.bincount(cells, minlength=self.clusters.count * (k + 1)).reshape(-1, k + 1)
        return np.cumsum(table[:, :k], axis=1).astype(float)

    def quantiles(self, shares: Sequence[float]) -> Floats:
        """Minimum lengths (k,) that are enough for shares, from 0 to 1, of all heads [m]."""
        ordered = self._ordered
        # A share that a whole number of heads makes up is not to be missed by its rounding.
        place = np.ceil(np.asarray(shares) * len(ordered) - 1e-9).astype(int) - 1
        return np.asarray(ordered[np.clip(place, 0, len(ordered) - 1)])

    def lengths(self, shares: Sequence[float]) -> Interval:
        """The same for increasing shares with what holds the true ones."""
        lengths = self.quantiles(shares)
        # Beyond the heads that can be cut there is no length; their own share is as uncertain.
        finite = self.needed[np.isfinite(self.needed)]
        share, low, high = self.at(np.minimum(lengths, finite.max(initial=0.0)))
        asked = np.asarray(shares)
        ends = (asked - (share - low), asked + (high - share))
        low, high = (self.quantiles(np.clip(end, 0.0, 1.0).tolist()) for end in ends)
        # A greater share needs no less: what bounds the one bounds the other.
        return Interval(lengths, np.maximum.accumulate(low), np.minimum.accumulate(high[::-1])[::-1])

    def worth(self) -> float | None:
        """Heads that the shares at the 50 and 90 % lengths are worth; None if all need the same length."""
        worths = self.clusters.worths(self._counts(self.quantiles((0.5, 0.9))))
        worths = worths[np.isfinite(worths)]
        return float(worths.min()) if len(worths) else None

    @cached_property
    def _ordered(self) -> Floats:
        return np.sort(self.needed)
