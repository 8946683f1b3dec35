r"""The share of heads that are cut right through, against the length of the edge, and its quantiles.

It is the distribution function of the lengths needed.

The interval of a quantile is that of the share at its length, read off the same curve.

References
----------
.. [1] Woodruff, Confidence intervals for medians and other position measures, J. Amer. Statist. Assoc. 47
   (1952) 635-646.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from linkwright.topping.intervals import Clusters, Interval

Floats = NDArray[np.float64]

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
        """Shares at some lengths.

        Parameters
        ----------
        length : ndarray, shape (k,)
            Increasing [m].

        Returns
        -------
        Interval
            Of each length by itself.
        """
        return self.clusters.shares(self._counts(length))

    def _counts(self, length: Floats) -> Floats:
        """Heads of each cluster that each of the lengths cuts right through."""
        # The first of the lengths that is enough for each head.
        k = len(length)
        first = np.searchsorted(length, self.needed)
        cells = self.clusters.of * (k + 1) + first
        table = np.bincount(cells, minlength=self.clusters.count * (k + 1)).reshape(-1, k + 1)
        return np.cumsum(table[:, :k], axis=1).astype(float)

    def quantiles(self, shares: Sequence[float]) -> Floats:
        """Minimum lengths that are enough for shares of all heads.

        Parameters
        ----------
        shares : sequence of float
            From 0 to 1.

        Returns
        -------
        ndarray, shape (k,)
            [m]
        """
        ordered = self._ordered
        # A share that a whole number of heads makes up is not to be missed by its rounding.
        place = np.ceil(np.asarray(shares) * len(ordered) - 1e-9).astype(int) - 1
        return np.asarray(ordered[np.clip(place, 0, len(ordered) - 1)])

    def lengths(self, shares: Sequence[float]) -> Interval:
        """The same with what holds the true ones.

        Parameters
        ----------
        shares : sequence of float
            From 0 to 1, increasing.
        """
        found = self.quantiles(shares)
        # Beyond the heads that can be cut there is no length; their own share is as uncertain.
        finite = self.needed[np.isfinite(self.needed)]
        share, low, high = self.at(np.minimum(found, finite.max(initial=0.0)))
        asked = np.asarray(shares)
        ends = (asked - (share - low), asked + (high - share))
        low, high = (self.quantiles(np.clip(end, 0.0, 1.0).tolist()) for end in ends)
        # A greater share needs no less: what bounds the one bounds the other.
        return Interval(found, np.maximum.accumulate(low), np.minimum.accumulate(high[::-1])[::-1])

    def worth(self) -> float | None:
        """Independent heads that the shares at the lengths for 50 and 90 % are worth, the fewer of both.

        Returns
        -------
        float or None
            None if all heads need the same length.
        """
        found = self.clusters.worths(self._counts(self.quantiles((0.5, 0.9))))
        found = found[np.isfinite(found)]
        return float(found.min()) if len(found) else None

    @cached_property
    def _ordered(self) -> Floats:
        return np.sort(self.needed)
