"""Modified trapezoid: constant acceleration with ramps of quarter sines.

Source: Neklutin, *Mechanisms and Cams for Automatic Machines* (1969); VDI 2143 Blatt 1 (1980), "modifiziertes
Beschleunigungstrapez"; Norton, *Cam Design and Manufacturing Handbook* (2002).
"""

from __future__ import annotations

from math import pi

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Harmonic, Piece
from linkwright.cam.laws.rest_to_rest import rest_to_rest


def modified_trapezoid(share: float = 1 / 8) -> MotionLaw:
    """Modified trapezoid.

    Parameters
    ----------
    share : float
        Of each of the four ramps in the whole, from 0, the parabola, to 1/4, the cycloidal law.

    Returns
    -------
    MotionLaw
        From 0 to 1.
    """
    flat = 0.5 - 2 * share
    up, down = Harmonic(pi / 2, 0.0, 1.0), Harmonic(pi / 2, 1.0, 0.0)
    return rest_to_rest(
        (share, Piece((), (up,))),
        (flat, Piece((1.0,))),
        (2 * share, Piece((), (Harmonic(pi, 1.0, 0.0),))),
        (flat, Piece((-1.0,))),
        (share, Piece((), (down._replace(cosine=-1.0),))),
    )
