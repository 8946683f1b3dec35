r"""Ramps of the velocity, and laws that start, keep a velocity and stop.

Ramps go from rest to a velocity of one over a length of one: halves of the symmetric laws, and two of minimum
:math:`\int \dddot x^2`: for the travel of 3/5, which makes the jerk end in zero,

.. math:: G = 2u^3 - 2u^4 + \tfrac35 u^5, \qquad \int \dddot x^2 = 19.2

and for a travel that is free, which comes out as 1/2, as the minimum then demands a fourth derivative that
ends in zero:

.. math:: G = u^3 - \tfrac12 u^4, \qquad \int \dddot x^2 = 12

Source: the first is the start of paper 2, *Synthesis of the cam drive mechanism of a roller-forming
installation with a combined mode of motion*, equations (1)–(3); the second follows from `optimal`.

The velocity goes up a ramp, stays, and comes down a ramp. With the share p of the start, g of the braking,
and ramps of the travel S (the velocity one reached over a length of one), the constant velocity for a lift of
one over a length of one is

.. math:: v = \frac{1}{p S_p + (1 - p - g) + g S_g}

With straight ramps this is the trapezoidal velocity, with rounded ones the S-curve.

Source: paper 2, *Synthesis of the cam drive mechanism of a roller-forming installation with a combined mode
of motion*, equations (4)–(10): p = g = 1/6, S = 3/5, v = 15/13; Biagiotti and Melchiorri, *Trajectory
Planning for Automatic Machines and Robots* (2008), chapter 3, for trapezoidal velocity and S-curve.
"""

from __future__ import annotations

from collections.abc import Callable

from linkwright.cam.laws.boundary import half_law
from linkwright.cam.laws.handbook import (
    constant_velocity,
    cycloidal,
    freudenstein_1_3,
    freudenstein_1_3_5,
    gutman_1_3,
    harmonic,
    modified_sine,
    modified_trapezoid,
    parabolic,
)
from linkwright.cam.laws.motion_law import MotionLaw, joined
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
    "cycloidal": cycloidal,
    "modified_trapezoid": modified_trapezoid,
    "modified_sine": modified_sine,
    "gutman_1_3": gutman_1_3,
    "freudenstein_1_3": freudenstein_1_3,
    "freudenstein_1_3_5": freudenstein_1_3_5,
    "polynomial_3_4_5": polynomial_3_4_5,
    "polynomial_4_5_6_7": polynomial_4_5_6_7,
}

RAMPS = ("optimal_jerk", "optimal_jerk_free", *SYMMETRIC)


def ramp_of(name: str) -> MotionLaw:
    """A ramp by its name."""
    own = {"optimal_jerk": optimal_jerk, "optimal_jerk_free": optimal_jerk_free}
    if name in own:
        return own[name]()
    if name not in SYMMETRIC:
        raise LawError(Problem("ramp", f'"{name}"', "one of " + ", ".join(RAMPS)))
    return half_law(SYMMETRIC[name]())


# What rounding may leave of three shares that add to one.
_ROUNDING = 1e-12


def start_and_stop(start: float = 1 / 6, stop: float = 1 / 6, ramp: str = "optimal_jerk") -> MotionLaw:
    """Start over a share, constant velocity, braking over a share."""
    return _with_ramp(start, stop, ramp_of(ramp))


def trapezoidal_velocity(start: float = 1 / 3, stop: float = 1 / 3) -> MotionLaw:
    """Constant acceleration, constant velocity, constant deceleration."""
    return start_and_stop(start, stop, "parabolic")


def s_curve(start: float = 1 / 3, stop: float = 1 / 3, rounding: float = 1 / 4) -> MotionLaw:
    """Trapezoidal velocity with its corners rounded by parabolas: the jerk is constant there."""
    corner = (rounding, Piece((0.0, 1.0)))
    flat = (1 - 2 * rounding, Piece((1.0,)))
    rise = MotionLaw.of(0.0, corner, flat, (rounding, Piece((1.0, -1.0)))).integral()
    return _with_ramp(start, stop, rise.scaled(1 / (1 - rounding)).placed(0.0, 1.0).integral())


def _with_ramp(start: float, stop: float, ramp: MotionLaw) -> MotionLaw:
    """Start, constant velocity and braking with one ramp G, G′ from 0 to 1."""
    cruise = 1 - start - stop
    if cruise < -_ROUNDING or min(start, stop) < 0:
        found = f"shares of {start:.6g} and {stop:.6g}"
        raise LawError(Problem("start", found, "shares of 0 or more, together at most 1"))
    travel = ramp.value(1.0)
    v = 1 / (start * travel + cruise + stop * travel)
    before, after = v * start * travel, 1 - v * stop * travel
    parts = [
        (0.0, start, ramp.scaled(v * start)),
        (start, 1 - stop - start, constant_velocity().scaled(v * cruise, before)),
        (1 - stop, stop, ramp.reversed().scaled(-v * stop, after + v * stop * travel)),
    ]
    law = joined([part.placed(low, length) for low, length, part in parts if length > _ROUNDING])
    return MotionLaw((0.0, *law.breaks[1:-1], 1.0), law.pieces)
