"""How far estimates may be from the truth: Student's distribution.

SciPy has the distributions; it is imported when one is asked for.
"""

from __future__ import annotations

from statistics import NormalDist

from linkwright.kernel.errors import InputError


def coverage_factor(level: float, freedom: int | None = None) -> float:
    """Half width over the standard deviation of an interval that holds the truth with a probability `level`.

    `freedom`: degrees of freedom from which the deviation was estimated; without them it is known, and 95 %
    give 1.96. Raises `InputError` for a level outside 0 ≤ level < 1.
    """
    if not 0 <= level < 1:
        raise InputError(f"level of confidence {level}: expected a number from 0 to below 1, such as 0.95")
    if freedom is None:
        return NormalDist().inv_cdf(0.5 + level / 2)
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + level / 2))
