r"""Laws with the minimum peak of acceleration, and of jerk.

What has the minimum peak is at its peak throughout, and only changes its sign: once for the acceleration,
twice for the jerk. With the velocities v₀, v₁ at the ends, Δ = v₁ − v₀ and the lift s over a section of
length one, q = s − (v₀ + v₁)/2,

.. math:: A = 2q \pm \sqrt{4q^2 + \Delta^2}, \qquad J = 16q \pm \sqrt{256q^2 + 16\Delta^2}

with the sign of q; the acceleration changes its sign at :math:`\tfrac12 + \Delta/2A`, the jerk at
:math:`\tfrac14 + \Delta/J` and half a section later. From rest to rest A = 4 s and J = 32 s. The acceleration
at the ends is ±A in the first law and zero in the second.

Source: Pontryagin et al., *The Mathematical Theory of Optimal Processes* (1962), chapter 1: minimum-time
motion under a bound, with time and bound exchanged; the closed forms follow from the conditions at the ends.
"""

from __future__ import annotations

from math import copysign, sqrt

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.parabolic import constant_velocity
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.errors import LawError, Problem

# Accelerations at the ends that are no more than this share of the law's own are none.
_NONE = 1e-9


def minimum_acceleration(task: Boundary) -> MotionLaw:
    """The law of minimum peak acceleration.

    Parameters
    ----------
    task : Boundary
        The boundary values; accelerations at the ends come out as they are.

    Returns
    -------
    MotionLaw
        From 0 to 1.

    Raises
    ------
    LawError
        Accelerations at the ends are asked for.
    """
    q, change = _excess(task)
    A = 2 * q + copysign(sqrt(4 * q * q + change * change), q)
    for wanted, sign in ((task.acceleration_start, 1), (task.acceleration_end, -1)):
        if wanted is not None and abs(wanted - sign * A) > _NONE * abs(A):
            expected = "no acceleration at the ends: the law begins and ends with its peak"
            raise LawError(Problem("", "an acceleration at an end", expected, 'take law = "minimum_jerk"'))
    if A == 0:
        return constant_velocity().scaled(task.lift)
    turn = 0.5 + 0.5 * change / A
    course = MotionLaw.of(0.0, (turn, Piece((A,))), (1 - turn, Piece((-A,))))
    return course.integral(task.velocity_start).integral()


def minimum_jerk(task: Boundary) -> MotionLaw:
    """The law of minimum peak jerk without acceleration at the ends.

    Parameters
    ----------
    task : Boundary
        The boundary values.

    Returns
    -------
    MotionLaw
        From 0 to 1.

    Raises
    ------
    LawError
        Accelerations at the ends are asked for.
    """
    q, change = _excess(task)
    J = 16 * q + copysign(sqrt(256 * q * q + 16 * change * change), q)
    if task.acceleration_start or task.acceleration_end:
        expected = "no acceleration at the ends, for which the law has a closed form"
        raise LawError(Problem("", "an acceleration at an end", expected, 'take law = "polynomial"'))
    if J == 0:
        return constant_velocity().scaled(task.lift)
    turn = 0.25 + change / J
    course = MotionLaw.of(0.0, (turn, Piece((J,))), (0.5, Piece((-J,))), (0.5 - turn, Piece((J,))))
    return course.integral().integral(task.velocity_start).integral()


def _excess(task: Boundary) -> tuple[float, float]:
    """Lift beyond that of the mean of the end velocities, and change of the velocity."""
    mean = 0.5 * (task.velocity_start + task.velocity_end)
    return task.lift - mean, task.velocity_end - task.velocity_start
