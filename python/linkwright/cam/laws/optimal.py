r"""Laws with minimum mean square or minimum peak of a derivative.

The minimum integral of the square is that of a polynomial.

.. math:: \int_0^1 \bigl(x^{(n)}\bigr)^2 dz \to \min

for given values and derivatives below the n-th at both ends. Euler's equation is :math:`x^{(2n)} = 0`: the
solution is a polynomial of degree 2n − 1. A derivative of order k that is not given at an end is free there
and brings the natural condition :math:`x^{(2n-1-k)} = 0` at that end. The functional is convex, so what
satisfies these conditions is the minimum.

For rest to rest, n = 1 gives constant velocity, n = 2 the cubic, n = 3 the polynomial 3-4-5, n = 4 the
4-5-6-7.

Source: Gelfand and Fomin, *Calculus of Variations* (1963), sections 6 and 11 (higher derivatives, natural
boundary conditions).

What has the minimum peak of acceleration, or of jerk, is at its peak throughout, and only changes its sign:
once for the acceleration, twice for the jerk. With the velocities v₀, v₁ at the ends, Δ = v₁ − v₀ and the
lift s over a section of length one, q = s − (v₀ + v₁)/2,

.. math:: A = 2q \pm \sqrt{4q^2 + \Delta^2}, \qquad J = 16q \pm \sqrt{256q^2 + 16\Delta^2}

with the sign of q; the acceleration changes its sign at :math:`\tfrac12 + \Delta/2A`, the jerk at
:math:`\tfrac14 + \Delta/J` and half a section later. From rest to rest A = 4 s and J = 32 s. The acceleration
at the ends is ±A in the first law and zero in the second.

Source: Pontryagin et al., *The Mathematical Theory of Optimal Processes* (1962), chapter 1: minimum-time
motion under a bound, with time and bound exchanged; the closed forms follow from the conditions at the ends.
"""

from __future__ import annotations

from collections.abc import Collection
from math import copysign

from linkwright.cam.laws.boundary import Boundary, or_none
from linkwright.cam.laws.handbook import constant_velocity
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.cam.laws.polynomial import Conditions, polynomial
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.numerics.tangent import moves, primal, sqrt


def optimal(order: int, start: Conditions, end: Conditions) -> MotionLaw:
    """The law of minimum ∫ (dⁿx/dzⁿ)² dz from 0 to 1.

    `start`, `end`: order of the derivative → its value there; the orders below n that are missing are free.
    Raises `LawError` if a derivative of order n or more is given, or so few are that the minimum is not one
    law.
    """
    highest = max((*start, *end), default=0)
    if highest >= order:
        expected = f"derivatives below the minimised one, up to order {order - 1}"
        raise LawError(Problem("order", f"a derivative of order {highest} at an end", expected))
    try:
        return polynomial(_with_natural(order, start), _with_natural(order, end))
    except LawError:
        found = f"{len(start) + len(end)} values at the two ends, which leave the law open"
        expected = f"{order} or more values at the ends, one of them the lift at an end"
        raise LawError(Problem("order", found, expected)) from None


def optimal_section(
    task: Boundary, order: int = 3, free_start: Collection[int] = (), free_end: Collection[int] = ()
) -> MotionLaw:
    """The optimal law of a section."""
    start = (0.0, task.velocity_start, or_none(task.acceleration_start))
    end = (task.lift, task.velocity_end, or_none(task.acceleration_end))
    sides = []
    for key, values, free in (("free_start", start, free_start), ("free_end", end, free_end)):
        wanted = [i for i, value in enumerate(values) if moves(value) and i and (i in free or i >= order)]
        if wanted:
            expected = (
                f"a law that can have the derivative of order {wanted[0]} that is asked for at this end"
            )
            raise LawError(Problem(key, f"order {order}, free: {sorted(free)}", expected))
        kept = [i for i in range(order) if i not in free]
        sides.append({i: (values[i] if i < len(values) else 0.0) for i in kept})
    return optimal(order, sides[0], sides[1])


def _with_natural(order: int, given: Conditions) -> dict[int, float]:
    """The conditions at one end: given ones, and natural ones for what is free."""
    natural = {2 * order - 1 - k: 0.0 for k in range(order) if k not in given}
    return {**given, **natural}


# Accelerations at the ends that are no more than this share of the law's own are none.
_NONE = 1e-9


def minimum_acceleration(task: Boundary) -> MotionLaw:
    """The law of minimum peak acceleration."""
    q, change = _excess(task)
    A = 2 * q + copysign(1.0, primal(q)) * sqrt(4 * q * q + change * change)
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
    """The law of minimum peak jerk without acceleration at the ends."""
    q, change = _excess(task)
    J = 16 * q + copysign(1.0, primal(q)) * sqrt(256 * q * q + 16 * change * change)
    if moves(or_none(task.acceleration_start)) or moves(or_none(task.acceleration_end)):
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
