r"""How far estimates may be from the truth: quantiles of the normal and of Student's distribution.

With f degrees of freedom and :math:`\vartheta = \arctan(t/\sqrt f)` the probability of a value within ±t is a
finite sum,

.. math:: A = \sin\vartheta \left(1 + \tfrac12 \cos^2\vartheta + \tfrac{1\cdot3}{2\cdot4} \cos^4\vartheta +
    \dots\right) \text{ to } \cos^{f-2}\vartheta,\ f \text{ even}

.. math:: A = \tfrac2\pi \left[\vartheta + \sin\vartheta \left(\cos\vartheta + \tfrac23 \cos^3\vartheta +
    \dots\right)\right] \text{ to } \cos^{f-2}\vartheta,\ f \text{ odd}

and the ratio F of two variances is, after Paulson, normal in its cube root to three digits.

References
----------
.. [1] Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, 26.7.3, 26.7.4 and 26.6.15.
"""

from __future__ import annotations

import math
from statistics import NormalDist

from linkwright.kernel.errors import InputError

# From here on Student's quantiles are the normal ones to three digits.
_MANY = 1000


def coverage_factor(level: float, freedom: int | None = None) -> float:
    """Half width of an interval over the standard deviation.

    Parameters
    ----------
    level : float
        Probability that the interval holds the truth, between 0 and 1.
    freedom : int, optional
        Degrees of freedom from which the deviation was estimated; without them it is known.

    Returns
    -------
    float
        1.96 for 95 % and a known deviation.

    Raises
    ------
    InputError
        The level is no probability.
    """
    if not 0 <= level < 1:
        raise InputError(f"level of confidence {level}: expected a number from 0 to below 1, such as 0.95")
    if freedom is None or freedom > _MANY:
        return NormalDist().inv_cdf(0.5 + level / 2)
    low, high = 0.0, math.pi / 2
    # In ϑ the probability grows from 0 to 1 on a quarter circle: sixty halvings reach the last bit.
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if _within(middle, freedom) < level else (low, middle)
    return math.sqrt(freedom) * math.tan((low + high) / 2)


def chance_of_ratio(ratio: float, above: int, below: int | None = None) -> float:
    """Probability that a ratio of two variances is at least as large by chance.

    Parameters
    ----------
    ratio : float
        F, variance above over variance below.
    above : int
        Degrees of freedom of the variance above.
    below : int, optional
        Of that below; without them it is known.

    Returns
    -------
    float
        Between 0 and 1.
    """
    if ratio <= 0:
        return 1.0
    a, b = 2 / (9 * above), 0.0 if below is None else 2 / (9 * below)
    root = math.cbrt(ratio)
    return 1 - NormalDist().cdf(((1 - b) * root - (1 - a)) / math.sqrt(b * root**2 + a))


def _within(theta: float, freedom: int) -> float:
    """A, the probability of a value within ±t."""
    sine, cosine = math.sin(theta), math.cos(theta)
    odd = freedom % 2
    term = cosine if odd else 1.0
    total = 0.0
    for power in range(odd, freedom - 1, 2):
        total += term
        term *= cosine**2 * (power + 1) / (power + 2)
    return 2 / math.pi * (theta + sine * total) if odd else sine * total
