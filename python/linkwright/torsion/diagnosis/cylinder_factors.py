"""Factors of the cylinders of an engine with their uncertainty, and whom they accuse."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.numerics.confidence import coverage_factor
from linkwright.kernel.result import Result

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Diagnosis(Result):
    """How strongly each cylinder fires.

    Attributes
    ----------
    cylinders : tuple of str
        Their names.
    factor : ndarray, shape (cylinders,)
        Firing part over that of a healthy cylinder; 1 where it cannot be determined.
    deviation : ndarray, shape (cylinders,)
        Standard deviation of each; infinite where it cannot be determined.
    covariance : ndarray, shape (cylinders, cylinders)
        Of the factors, as far as they can be determined.
    condition : float
        Largest over smallest singular value; infinite where cylinders cannot be distinguished.
    misfit : float
        What is left over for each degree of freedom, over the noise if that is known, else [rad/s]; NaN
        without any degree of freedom.
    freedom : int
        Equations less factors told.
    is_noise_known : bool
        Whether the noise was given, or estimated.
    warnings : tuple of str
        What limits the diagnosis.
    delay, delay_deviation : ndarray, shape (cylinders,), or None
        Crank angle by which the combustion of each is late, where its strength alone does not explain the
        measurement, and its standard deviation [rad].
    compression, compression_deviation : ndarray, shape (cylinders,), or None
        Likewise, torque of compression and expansion over that of a tight cylinder.
    """

    cylinders: tuple[str, ...]
    factor: Floats
    deviation: Floats
    covariance: Floats
    condition: float
    misfit: float
    freedom: int
    is_noise_known: bool
    warnings: tuple[str, ...]
    delay: Floats | None = None
    delay_deviation: Floats | None = None
    compression: Floats | None = None
    compression_deviation: Floats | None = None

    def half_width(self, level: float = 0.95) -> Floats:
        """Half width of the interval about each factor.

        Parameters
        ----------
        level : float
            Probability that it holds the truth, for each cylinder by itself.

        Returns
        -------
        ndarray, shape (cylinders,)
        """
        return self.coverage(level) * self.deviation

    def coverage(self, level: float) -> float:
        """Half width of an interval over the standard deviation.

        Parameters
        ----------
        level : float
            Probability that it holds the truth.
        """
        return coverage_factor(level, None if self.is_noise_known else self.freedom)

    def weak(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire less than a healthy one, the weakest first.

        Parameters
        ----------
        level : float
            Probability that none is named in a healthy engine; shared out to the cylinders (Bonferroni).

        Returns
        -------
        tuple of str
            Those whose intervals, one-sided, lie below 1.
        """
        return self._below(self.factor - 1, self.deviation, level)

    def late(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that fire late, the latest first; none where the measurement says nothing of it.

        Parameters
        ----------
        level : float
            As of `weak`.

        Returns
        -------
        tuple of str
            Those whose intervals, one-sided, lie above 0.
        """
        if self.delay is None or self.delay_deviation is None:
            return ()
        return self._below(-self.delay, self.delay_deviation, level)

    def leaking(self, level: float = 0.95) -> tuple[str, ...]:
        """Cylinders that compress less than a tight one, the worst first; none where nothing is said of it.

        Parameters
        ----------
        level : float
            As of `weak`.

        Returns
        -------
        tuple of str
            Those whose intervals, one-sided, lie below 1.
        """
        if self.compression is None or self.compression_deviation is None:
            return ()
        return self._below(self.compression - 1, self.compression_deviation, level)

    def _below(self, value: Floats, deviation: Floats, level: float) -> tuple[str, ...]:
        """Cylinders whose one-sided intervals lie below 0, at a level for all of them together."""
        each = 1 - 2 * (1 - level) / len(self.cylinders)
        below = value + self.coverage(each) * deviation < 0
        return tuple(self.cylinders[n] for n in np.argsort(value) if below[n])

    @property
    def is_refuted(self) -> bool:
        """Whether more is left over than the known noise explains."""
        # A misfit has the mean 1 and the deviation 1/√(2f); three of them are rare.
        return bool(self.is_noise_known and self.misfit > 1 + 3 / np.sqrt(2 * max(self.freedom, 1)))

    @property
    def relative(self) -> Floats:
        """Factors over their mean, shape (cylinders,): where the load of the engine is not known."""
        found: Floats = self.factor / self.factor.mean()
        return found
