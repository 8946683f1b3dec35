"""Laws of one power a piece: constant velocity, and the parabola of constant acceleration.

Source: VDI 2143 Blatt 1 (1980); Rothbart (ed.), *Cam Design Handbook* (2004), chapter 2.
"""

from __future__ import annotations

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece


def constant_velocity() -> MotionLaw:
    """The straight line f = z: the minimum velocity, which jumps at both ends."""
    return MotionLaw((0.0, 1.0), (Piece((0.0, 1.0)),))


def parabolic() -> MotionLaw:
    """f = 2 z² up to the middle, its mirror image from there: the minimum acceleration, which jumps."""
    return MotionLaw((0.0, 0.5, 1.0), (Piece((0.0, 0.0, 0.5)), Piece((0.5, 1.0, -0.5))))
