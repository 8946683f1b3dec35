"""Modified sine: the acceleration is a slow cosine between two quick quarter sines.

Source: Neklutin, *Mechanisms and Cams for Automatic Machines* (1969); VDI 2143 Blatt 1 (1980), "modifizierte
Sinuslinie"; Norton, *Cam Design and Manufacturing Handbook* (2002).
"""

from __future__ import annotations

from math import pi

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Harmonic, Piece
from linkwright.cam.laws.rest_to_rest import rest_to_rest


def modified_sine(share: float = 1 / 8) -> MotionLaw:
    """Modified sine.

    Parameters
    ----------
    share : float
        Of each of the two quarter sines in the whole, from 0, the harmonic law, to below 1/2; 1/4 is the
        cycloidal law.

    Returns
    -------
    MotionLaw
        From 0 to 1.
    """
    return rest_to_rest(
        (share, Piece((), (Harmonic(pi / 2, 0.0, 1.0),))),
        (1 - 2 * share, Piece((), (Harmonic(pi, 1.0, 0.0),))),
        (share, Piece((), (Harmonic(pi / 2, -1.0, 0.0),))),
    )
