"""Motion laws of the textbooks, from 0 to 1 over 0 to 1, written down here and not taken from the library."""

from __future__ import annotations

import numpy as np

from linkwright.cam import MotionLaw, joined
from linkwright.cam.laws.motion_law import Harmonic, Piece

CYCLOIDAL = MotionLaw.of(0.0, (1.0, Piece((0.0, 1.0), (Harmonic(2 * np.pi, 0.0, -0.5 / np.pi),))))
HARMONIC = MotionLaw.of(0.0, (1.0, Piece((0.5,), (Harmonic(np.pi, -0.5, 0.0),))))
PARABOLIC = MotionLaw.of(0.0, (0.5, Piece((0.0, 0.0, 0.5))), (0.5, Piece((0.5, 1.0, -0.5))))
UNIFORM = MotionLaw.of(0.0, (1.0, Piece((0.0, 1.0))))
POLYNOMIAL_345 = MotionLaw.of(0.0, (1.0, Piece((0.0, 0.0, 0.0, 10.0, -15.0, 6.0))))
POLYNOMIAL_4567 = MotionLaw.of(0.0, (1.0, Piece((0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0))))
POLYNOMIAL_56789 = MotionLaw.of(
    0.0, (1.0, Piece((0.0, 0.0, 0.0, 0.0, 0.0, 126.0, -420.0, 540.0, -315.0, 70.0)))
)

# Not symmetric: it starts softly and stops hard.
SKEW = MotionLaw.of(0.0, (1.0, Piece((0.0, 0.0, 0.0, 0.0, 5.0, -4.0))))

# Constant acceleration over 0.4, constant retardation over 0.6.
UNEQUAL = MotionLaw.of(0.0, (0.4, Piece((0.0, 0.0, 0.4))), (0.6, Piece((0.4, 1.2, -0.6))))


def dwell(angle: float, lift: float) -> MotionLaw:
    return MotionLaw.of(0.0, (angle, Piece((lift,))))


def turn(law: MotionLaw, lift: float, rise: float = 2.0, high: float = 0.8, back: float = 1.7) -> MotionLaw:
    """Rise, dwell, return and dwell over one revolution."""
    up, down = law.scaled(lift), law.reversed().scaled(lift)
    rest = 2 * np.pi - rise - high - back
    return joined(
        [
            up.placed(0.0, rise),
            dwell(high, lift).placed(rise, high),
            down.placed(rise + high, back),
            dwell(rest, 0.0).placed(rise + high + back, rest),
        ]
    )
