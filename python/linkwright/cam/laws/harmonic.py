r"""Simple and double harmonic: accelerations of one and of two cosines.

Source: Rothbart (ed.), *Cam Design Handbook* (2004), chapter 2; VDI 2143 Blatt 1 (1980), "einfache
Sinoide".
"""

from __future__ import annotations

from math import pi

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Harmonic, Piece


def harmonic() -> MotionLaw:
    """f = (1 − cos πz)/2, the motion of a Scotch yoke; its acceleration jumps at both ends."""
    return MotionLaw((0.0, 1.0), (Piece((0.5,), (Harmonic(pi, -0.5, 0.0),)),))


def double_harmonic() -> MotionLaw:
    """f = (1 − cos πz)/2 − (1 − cos 2πz)/8: soft at its start, with a jump of the acceleration at its end."""
    waves = (Harmonic(pi, -0.5, 0.0), Harmonic(2 * pi, 0.125, 0.0))
    return MotionLaw((0.0, 1.0), (Piece((0.375,), waves),))
