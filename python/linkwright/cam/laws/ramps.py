r"""Ramps: from rest to a velocity of one over a length of one.

Halves of the symmetric laws, and two of minimum :math:`\int \dddot x^2`: for the travel of 3/5, which makes
the jerk end in zero,

.. math:: G = 2u^3 - 2u^4 + \tfrac35 u^5, \qquad \int \dddot x^2 = 19.2

and for a travel that is free, which comes out as 1/2, as the minimum then demands a fourth derivative that
ends in zero:

.. math:: G = u^3 - \tfrac12 u^4, \qquad \int \dddot x^2 = 12

Source: the first is the start of paper 2, *Synthesis of the cam drive mechanism of a roller-forming
installation with a combined mode of motion*, equations (1)–(3); the second follows from `optimal`.
"""

from __future__ import annotations

from collections.abc import Callable

from linkwright.cam.laws import sine_series
from linkwright.cam.laws.half_law import half_law
from linkwright.cam.laws.harmonic import harmonic
from linkwright.cam.laws.modified_sine import modified_sine
from linkwright.cam.laws.modified_trapezoid import modified_trapezoid
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.parabolic import parabolic
from linkwright.cam.laws.piece import Piece
from linkwright.cam.laws.polynomial import polynomial_3_4_5, polynomial_4_5_6_7
from linkwright.kernel.errors import LawError, Problem


def optimal_jerk() -> MotionLaw:
    """Minimum ∫ jerk² over a travel of 3/5; the jerk ends in zero."""
    return MotionLaw((0.0, 1.0), (Piece((0.0, 0.0, 0.0, 2.0, -2.0, 0.6)),))


def optimal_jerk_free() -> MotionLaw:
    """Minimum ∫ jerk² over any travel, which comes out as 1/2."""
    return MotionLaw((0.0, 1.0), (Piece((0.0, 0.0, 0.0, 1.0, -0.5)),))


# Laws whose first half is a ramp.
SYMMETRIC: dict[str, Callable[[], MotionLaw]] = {
    "parabolic": parabolic,
    "harmonic": harmonic,
    "cycloidal": sine_series.cycloidal,
    "modified_trapezoid": modified_trapezoid,
    "modified_sine": modified_sine,
    "gutman_1_3": sine_series.gutman_1_3,
    "freudenstein_1_3": sine_series.freudenstein_1_3,
    "freudenstein_1_3_5": sine_series.freudenstein_1_3_5,
    "polynomial_3_4_5": polynomial_3_4_5,
    "polynomial_4_5_6_7": polynomial_4_5_6_7,
}

RAMPS = ("optimal_jerk", "optimal_jerk_free", *SYMMETRIC)


def ramp(name: str) -> MotionLaw:
    """A ramp by its name.

    Parameters
    ----------
    name : str
        One of `RAMPS`.

    Returns
    -------
    MotionLaw
        G, from 0 to 1; G′ goes from 0 to 1.

    Raises
    ------
    LawError
        There is no such ramp.
    """
    own = {"optimal_jerk": optimal_jerk, "optimal_jerk_free": optimal_jerk_free}
    if name in own:
        return own[name]()
    if name not in SYMMETRIC:
        raise LawError(Problem("ramp", f'"{name}"', "one of " + ", ".join(RAMPS)))
    return half_law(SYMMETRIC[name]())
