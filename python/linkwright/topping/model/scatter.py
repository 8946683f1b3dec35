r"""Lengths that scatter from one piece to the next: a constant, or a distribution cut off at its ends.

`mean` and `deviation` are those of the whole distribution. What lies below `min` or above `max` is cut
off, so that of the distribution function F there remains

.. math:: F_t(x) = \frac{F(x) - F(a)}{F(b) - F(a)}, \qquad a \le x \le b,

whose mean and deviation are others where much is cut off. Of a lognormal length they are those of the length
itself: its logarithm is normal with

.. math:: \sigma^2 = \ln\left(1 + \frac{s^2}{m^2}\right), \qquad \mu = \ln m - \frac{\sigma^2}{2}.

References
----------
.. [1] Johnson, Kotz, Balakrishnan, *Continuous Univariate Distributions*, vol. 1, 2nd ed. 1994, chapters 13
   and 14.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BeforeValidator, Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, fault, formerly
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.marks import Length, Quantity, not_negative
from linkwright.kernel.units.reading import is_number
from linkwright.linkages.model.element import PositiveLength

if TYPE_CHECKING:
    from statistics import NormalDist

Deviation = Annotated[float, not_negative(LENGTH)]

_PLAIN = Quantity(LENGTH)

_BOTH = "an even scatter is given by min and max, or by mean and deviation"

# Share of a distribution that must be left between its ends: below it the rounding of F counts.
_LEFT = 1e-9

# Shares of exactly 0 and 1 have no place in a distribution without ends.
_LAST = 2.0**-53


class Scatter(CheckedDescription):
    """What all have in common: quantities of one length."""

    @property
    def ends(self) -> tuple[float, float]:
        """Minimum and maximum value [m]; infinite without such."""
        raise NotImplementedError

    @property
    def is_constant(self) -> bool:
        """Whether all values are the same."""
        return self.ends[0] == self.ends[1]

    def values(self, shares: ArrayLike) -> Floats:
        """Inverse of the distribution function [m], (n,), at ``shares`` (n,) from 0 to 1."""
        raise NotImplementedError


class ConstantScatter(Scatter):
    """The same for all; a bare length means this."""

    kind: Literal["constant"]
    value: Length = Field(description="Constant length.")

    @property
    def ends(self) -> tuple[float, float]:
        """Twice the value [m]."""
        return self.value, self.value

    def values(self, shares: ArrayLike) -> Floats:
        return np.full(np.shape(shares), self.value)


class UniformScatter(Scatter):
    """Evenly between two ends."""

    kind: Literal["uniform"]
    mean: Length | None = Field(None, description="Mean, instead of the ends.")
    deviation: Deviation | None = Field(
        None, description="Standard deviation, with the mean: half the width over √3."
    )
    min: Length | None = Field(None, validation_alias=formerly("least", "min"), description="Minimum value.")
    max: Length | None = Field(
        None, validation_alias=formerly("greatest", "max"), description="Maximum value."
    )

    @property
    def ends(self) -> tuple[float, float]:
        """Minimum and maximum value [m]."""
        if self.min is not None and self.max is not None:
            return self.min, self.max
        middle, half = self.mean or 0.0, math.sqrt(3.0) * (self.deviation or 0.0)
        return middle - half, middle + half

    def values(self, shares: ArrayLike) -> Floats:
        least, greatest = self.ends
        return np.asarray(least + (greatest - least) * np.asarray(shares, dtype=float))

    def _faults(self) -> Iterator[InitErrorDetails]:
        by_ends = {"min": self.min, "max": self.max}
        by_mean = {"mean": self.mean, "deviation": self.deviation}
        wanted, others = (by_mean, by_ends) if self.mean is not None else (by_ends, by_mean)
        for key, value in wanted.items():
            if value is None:
                yield fault(key, expected=Quantity(LENGTH).expected, remedy=_BOTH)
        for key, value in others.items():
            if value is not None:
                yield fault(key, found=value, expected="nothing", remedy=_BOTH)
        if self.min is not None and self.max is not None:
            yield from _order_faults(self.min, self.max)


class BellScatter(Scatter):
    """A bell curve, cut off at its ends."""

    mean: Length = Field(description="Mean of the whole distribution.")
    deviation: Deviation = Field(description="Standard deviation; 0 for a constant.")
    min: Length | None = Field(
        None, validation_alias=formerly("least", "min"), description="Lower truncation."
    )
    max: Length | None = Field(
        None, validation_alias=formerly("greatest", "max"), description="Upper truncation."
    )

    @property
    def ends(self) -> tuple[float, float]:
        """Minimum and maximum value [m]; infinite without such."""
        if not self.deviation:
            return self.mean, self.mean
        return self._lowest if self.min is None else self.min, _or(self.max, math.inf)

    @property
    def _lowest(self) -> float:
        return -math.inf

    def values(self, shares: ArrayLike) -> Floats:
        even = np.asarray(shares, dtype=float)
        if not self.deviation:
            return np.full(even.shape, self.mean)
        low, high = self._scores
        # Upper tails by their mirror images, where F has more digits.
        sign = -1.0 if low > 0 else 1.0
        start, end = sorted((_normal().cdf(sign * low), _normal().cdf(sign * high)))
        part = even if sign > 0 else 1.0 - even
        within = np.clip(start + (end - start) * part, max(start, _LAST), min(end, 1 - _LAST))
        scores = np.fromiter(map(_normal().inv_cdf, within.ravel()), float, within.size).reshape(within.shape)
        return np.clip(self._unscored(sign * scores), *self.ends)

    @property
    def _scores(self) -> tuple[float, float]:
        least, greatest = self.ends
        return self._score(least), self._score(greatest)

    def _score(self, value: float) -> float:
        return (value - self.mean) / self.deviation

    def _unscored(self, score: Floats) -> Floats:
        return np.asarray(self.mean + self.deviation * score)

    def _faults(self) -> Iterator[InitErrorDetails]:
        least, greatest = self.min, self.max
        if least is not None and greatest is not None and least > greatest:
            yield from _order_faults(least, greatest)
        elif not self.deviation:
            yield from self._constant_faults()
        elif self._left() < _LEFT:
            key = "min" if least is not None and self._score(least) > 0 else "max"
            found = f"{least if key == 'min' else greatest:.6g} m, which leaves nothing of the distribution"
            expected = f"an end within 6 deviations of {self.deviation:.6g} m from {self.mean:.6g} m"
            yield fault(key, found=found, expected=expected)

    def _constant_faults(self) -> Iterator[InitErrorDetails]:
        for key, end, sign in (("min", self.min, 1), ("max", self.max, -1)):
            if end is not None and sign * (end - self.mean) > 0:
                side = "most" if sign > 0 else "least"
                expected = f"at {side} the mean, {self.mean:.6g} m, as nothing scatters"
                yield fault(key, found=end, expected=expected)

    def _left(self) -> float:
        low, high = self._scores
        sign = -1.0 if low > 0 else 1.0
        return abs(_normal().cdf(sign * high) - _normal().cdf(sign * low))


class NormalScatter(BellScatter):
    """A normal distribution, cut off at its ends."""

    kind: Literal["normal"]


class LognormalScatter(BellScatter):
    """The logarithm has a normal distribution: nothing below 0, and a long tail above."""

    kind: Literal["lognormal"]
    mean: PositiveLength = Field(description="Mean of the length, not of its logarithm.")

    @property
    def _lowest(self) -> float:
        return 0.0

    @property
    def _bell(self) -> tuple[float, float]:
        variance = math.log1p((self.deviation / self.mean) ** 2)
        return math.log(self.mean) - 0.5 * variance, math.sqrt(variance)

    def _score(self, value: float) -> float:
        middle, deviation = self._bell
        if value <= 0:
            return -math.inf
        return (math.log(value) - middle) / deviation if value < math.inf else math.inf

    def _unscored(self, score: Floats) -> Floats:
        middle, deviation = self._bell
        return np.asarray(np.exp(middle + deviation * score))


@cache
def _normal() -> NormalDist:
    """The standard normal distribution, loaded when the first bell is met: most machines have none."""
    from statistics import NormalDist

    return NormalDist()


def _order_faults(least: float, greatest: float) -> Iterator[InitErrorDetails]:
    if least > greatest:
        yield fault("max", found=greatest, expected=f"{least:.6g} m or more, as min is")


def _or(value: float | None, other: float) -> float:
    return other if value is None else value


def _as_table(value: object) -> object:
    if isinstance(value, str) or is_number(value):
        return {"kind": "constant", "value": _PLAIN.read(value)}
    return value


AnyScatter = Annotated[
    Annotated[
        ConstantScatter | NormalScatter | LognormalScatter | UniformScatter, Field(discriminator="kind")
    ],
    BeforeValidator(
        _as_table,
        json_schema_input_type=Annotated[float, _PLAIN]
        | Annotated[
            ConstantScatter | NormalScatter | LognormalScatter | UniformScatter, Field(discriminator="kind")
        ],
    ),
]
