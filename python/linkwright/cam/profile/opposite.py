r"""Two followers fixed to one another that touch one cam on opposite sides at every angle.

With d(φ) the distance of the follower from the cam's centre, the two touch if the cam has the same diameter

.. math:: d(\varphi) + d(\varphi + \pi) = b

at every angle (points and rollers: diameter of the pitch curve; flat faces: breadth, d the support
function). So the lift over the second half of the revolution must be that of the first, mirrored: s(φ + π) =
h − s(φ).

References
----------
.. [1] Paper 2, equations (17) to (22): ρ(φ) + ρ(φ + π) = b.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.cam.core import Extreme
from linkwright.cam.laws.motion_law import MotionLaw, combined
from linkwright.cam.model.cam import Cam
from linkwright.cam.profile.contact import Contact

# Share of the breadth within which it counts as constant: each of the two lifts is good to some units of
# rounding.
_CONSTANT = 1e-12


@dataclass(frozen=True)
class Opposite:
    """The diameter of a cam between two followers.

    Attributes
    ----------
    breadth : float
        Distance of the followers [m].
    diameter : MotionLaw
        Distance of two followers that touch the cam, over half a revolution [m].
    least, greatest : Extreme
        Its extremes.
    """

    breadth: float
    diameter: MotionLaw
    least: Extreme
    greatest: Extreme

    @property
    def is_constant(self) -> bool:
        """Whether both touch at every angle, but for rounding."""
        apart = max(abs(self.least.value - self.breadth), abs(self.greatest.value - self.breadth))
        return apart <= _CONSTANT * self.breadth


def opposite(cam: Cam, contact: Contact) -> Opposite:
    """The diameter over the revolution, with its extremes located exactly.

    Parameters
    ----------
    cam : Cam
        A cam between two followers.
    contact : Contact
        The first of them.

    Returns
    -------
    Opposite
        Breadth and diameter.
    """
    factor = 1.0 if cam.is_roller else float(np.cos(cam.face_tilt))
    place = contact.law.scaled(factor, contact.start * factor)
    both = combined((1.0, place), (1.0, place.shifted(np.pi)))
    least, greatest = both.extremes()
    breadth = cam.breadth if cam.breadth is not None else 2 * contact.start + cam.stroke
    return Opposite(
        float(breadth) * factor,
        both,
        Extreme(least.at % np.pi, least.value),
        Extreme(greatest.at % np.pi, greatest.value),
    )
