r"""Any symmetric law of rest to rest, used for any boundary values.

The first half of a law f brings a follower from rest to its maximum velocity. Stretched over a section it
changes the velocity there,

.. math:: x(z) = v_0 z + (v_1 - v_0)\,G(z) + \bigl(s - v_0 - (v_1 - v_0)\,G(1)\bigr) f(z), \qquad
          G'(z) = \frac{f'(z/2)}{f'(1/2)}

and f itself covers what is left of the lift s. Accelerations at the ends that the sum does not have are added
by a quintic that changes nothing else there. A section of a family keeps the family's smoothness: its
harmonics, and no jump that f has not.

Source: VDI 2143 Blatt 1 (1980) takes halves of symmetric laws for the tasks R-G and G-R; the sum for
two velocities is the same formula once for each.
"""

from __future__ import annotations

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.motion_law import MotionLaw, combined
from linkwright.cam.laws.parabolic import constant_velocity
from linkwright.cam.laws.polynomial import polynomial

_REST = {0: 0.0, 1: 0.0, 2: 0.0}


def half_law(law: MotionLaw) -> MotionLaw:
    """The first half of a symmetric law, stretched to a section and to an end velocity of one.

    Parameters
    ----------
    law : MotionLaw
        Symmetric, from 0 to 1.

    Returns
    -------
    MotionLaw
        G, from 0 to 1; G′ goes from 0 to 1.
    """
    middle = float(law.at(0.5, 1))
    return law.stretch(0.0, 0.5).placed(0.0, 1.0).scaled(2 / middle)


def with_boundary(law: MotionLaw, task: Boundary) -> MotionLaw:
    """A symmetric law made to meet boundary values.

    Parameters
    ----------
    law : MotionLaw
        Symmetric, from 0 to 1.
    task : Boundary
        The boundary values. Accelerations that are None are those that come out.

    Returns
    -------
    MotionLaw
        x(z), from 0 to 1, beginning with 0.
    """
    moved = law.scaled(task.lift)
    if task.velocity_start or task.velocity_end:
        moved = _moved(law, task)
    start, end = moved.at(0.0, 2), moved.at(1.0, 2, "before")
    missing = [
        0.0 if wanted is None else wanted - float(there)
        for wanted, there in ((task.acceleration_start, start), (task.acceleration_end, end))
    ]
    if not any(missing):
        return moved
    bend = polynomial(_REST | {2: missing[0]}, _REST | {2: missing[1]})
    return combined((1.0, moved), (1.0, bend))


def _moved(law: MotionLaw, task: Boundary) -> MotionLaw:
    """The sum that meets lift and velocities."""
    v_0, change = task.velocity_start, task.velocity_end - task.velocity_start
    G = half_law(law)
    left = task.lift - v_0 - change * float(G.at(1.0))
    return combined((v_0, constant_velocity()), (change, G), (left, law))
