"""Two cams that turn in opposite directions, one on each side of the cart, against one cam alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.kernel.files.library import library_path
from linkwright.kinetostatics.forces import forces
from linkwright.machine.read import read
from linkwright.papers.paper2.alternatives import design_speed

# Angles of the turn, every quarter of a degree, off the joints of the law.
_ANGLES = 1440


@dataclass(frozen=True)
class Pair:
    """Forces across the cart's travel at the design speed.

    Attributes
    ----------
    side_force : float
        Largest in size that one cam alone puts on the guide [N].
    left_over : float
        Largest that is left of it with half the work for each of two counter-rotating cams [N].
    contact_force : float
        Largest along the normal of the contact, by one cam alone [N].
    """

    side_force: float
    left_over: float
    contact_force: float


def pair(machine: str, cam: str) -> Pair:
    """Compare one cam with two.

    Parameters
    ----------
    machine : str
        Name in the library.
    cam : str
        Name of its cam.

    Returns
    -------
    Pair
        Of the machine as it is, and with its mirror image.

    Notes
    -----
    Both cams move the cart in the same way, so each may be computed by itself, and their mean is what two
    cams with half the force each do.
    """
    sides = []
    angles = (np.arange(_ANGLES) + 0.5) * (2 * np.pi / _ANGLES)
    for rotation in ("same", "opposite"):
        found = read(library_path(machine), {f"mechanism.cams.{cam}.rotation": rotation})
        acting = forces(found, speed=design_speed(found), angles=angles)
        sides.append(acting.pairs[f"{cam}.guide"].normal)
    return Pair(
        side_force=float(np.abs(sides[0]).max()),
        left_over=float(np.abs(0.5 * (sides[0] + sides[1])).max()),
        contact_force=float(np.abs(acting.drives[cam]).max()),
    )
