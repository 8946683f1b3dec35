"""A law from rest to rest by the course of its acceleration.

The course is integrated twice and brought to a lift of one over a length of one; only its shape counts.
"""

from __future__ import annotations

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece


def rest_to_rest(*stretches: tuple[float, Piece]) -> MotionLaw:
    """The law f(z), z and f from 0 to 1.

    Parameters
    ----------
    *stretches : tuple of float and Piece
        Length and course of the acceleration, one after the other; together they bring the velocity back to
        zero.

    Returns
    -------
    MotionLaw
        From 0 to 1.
    """
    law = MotionLaw.of(0.0, *stretches).integral().integral().placed(0.0, 1.0)
    return law.scaled(1 / float(law.at(1.0)))
