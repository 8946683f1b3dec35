"""How far estimates may be from the truth: Student's distribution, and the chances of a ratio of variances.

SciPy has the distributions; it is imported when one is asked for.
"""

from __future__ import annotations

from statistics import NormalDist

from linkwright.kernel.errors import InputError


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
    if freedom is None:
        return NormalDist().inv_cdf(0.5 + level / 2)
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + level / 2))


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
    from scipy.special import chdtrc, fdtrc

    if ratio <= 0:
        return 1.0
    return float(chdtrc(above, ratio * above) if below is None else fdtrc(above, below, ratio))
