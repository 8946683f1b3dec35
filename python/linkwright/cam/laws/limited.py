r"""Trapezoidal velocity and S-curve by limits of velocity, acceleration and jerk.

A section has its length; what is free is how fast to go between the ramps. Ramps use the acceleration (and
the jerk) that is allowed, and the velocity between them is the minimum with which the section is done in its
length. In the shortest possible length that is the motion of minimum time. A ramp to the velocity v takes

.. math:: t_r(v) = \frac{v}{A}, \qquad
          t_r(v) = \frac{v}{A} + \frac{A}{J} \ (v \ge A^2/J), \qquad t_r(v) = 2\sqrt{v/J} \ (v \le A^2/J)

and the lift s takes :math:`T(v) = s/v + t_r(v)` as long as :math:`v\,t_r(v) \le s`; there T falls with v.

Source: Biagiotti and Melchiorri, *Trajectory Planning for Automatic Machines and Robots* (2008), sections
3.2, 3.4.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, degrees, inf
from typing import Any

from linkwright.cam.laws.boundary import Boundary
from linkwright.cam.laws.handbook import constant_velocity, rest_to_rest
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import moves, primal, sqrt

# Halvings after which an interval of floats is two neighbours.
_HALVINGS = 100

# Share by which rounding may miss the shortest length.
_ROUNDING = 1e-12

# Pieces shorter than this share of the section are left out: their length would be known to a few digits
# only. Limits are kept to about this share.
_SHORTEST = 1e-8


@dataclass(frozen=True)
class Limits:
    """What the follower is allowed."""

    velocity: float  # maximum velocity [m/rad or –]; infinite without a limit
    acceleration: float  # maximum acceleration [m/rad² or 1/rad]
    jerk: float = inf  # maximum jerk [m/rad³ or 1/rad²]; infinite without a limit

    def ramp(self, v: Any) -> Any:
        """Minimum length in which the velocity v is reached from rest [rad]."""
        if self._is_short(v):
            return 2 * sqrt(v / self.jerk)
        return v / self.acceleration + self.acceleration / self.jerk

    def _is_short(self, v: float) -> bool:
        """Whether the full acceleration is not reached on the way to a velocity."""
        return bool(primal(v) * primal(self.jerk) <= primal(self.acceleration) ** 2)

    def ramp_slope(self, v: float) -> Any:
        """By how much that length grows with the velocity."""
        return 1 / sqrt(v * self.jerk) if self._is_short(v) else 1 / self.acceleration

    @property
    def primal(self) -> Limits:
        """The limits without derivatives."""
        return Limits(primal(self.velocity), primal(self.acceleration), primal(self.jerk))

    def fastest(self, lift: Any) -> Any:
        """Maximum velocity of the motion of minimum length over a lift [m/rad or –]."""
        # Without any other limit, acceleration and deceleration meet at this velocity.
        low, high = 0.0, min(self.velocity, sqrt(self.acceleration * lift))
        if high * self.ramp(high) <= lift:
            return high
        bare, high = self.primal, primal(high)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if middle * bare.ramp(middle) <= lift else (low, middle)
        missing = low * self.ramp(low) - lift
        return solution_along(low, missing, bare.ramp(low) + low * bare.ramp_slope(low))

    def shortest(self, lift: Any) -> Any:
        """Minimum length of a section with a lift of this size [rad]."""
        v = self.fastest(lift)
        return lift / v + self.ramp(v)


def limited_section(
    task: Boundary, angle: float, velocity: float | None, acceleration: float, jerk: float | None
) -> MotionLaw:
    """The law of a section of rest to rest that keeps limits.

    ``angle``: of the section [rad]; ``velocity``, ``acceleration``, ``jerk``: maximum derivatives by the cam
    angle [m or rad, per rad, rad², rad³]; None without a limit.
    """
    ends = (task.velocity_start, task.velocity_end, task.acceleration_start, task.acceleration_end)
    if any(map(moves, ends)):
        expected = "rest at both ends, which the law goes from and to"
        raise LawError(
            Problem("", f"the boundary conditions {task.letters}", expected, 'take law = "polynomial"')
        )
    if task.lift == 0:
        return constant_velocity().scaled(0.0)
    limits = Limits(inf if velocity is None else velocity, acceleration, inf if jerk is None else jerk)
    shortest = limits.shortest(abs(task.lift))
    if shortest > angle * (1 + _ROUNDING):
        found = f"limits that require at least {degrees(primal(shortest)):.10g} deg"
        expected = f"limits that complete the lift in {degrees(primal(angle)):.10g} deg"
        remedy = "give the section that angle, or raise the limits"
        raise LawError(Problem("", found, expected, remedy))
    return limited(limits, abs(task.lift), max(angle, shortest)).scaled(copysign(1.0, primal(task.lift)))


def limited(limits: Limits, lift: float, length: float) -> MotionLaw:
    """The law of a section within limits; ``lift`` > 0 [m or rad]; ``length`` ≥ `Limits.shortest` [rad]."""
    least = limits.shortest(lift)
    low, high = lift / length, limits.fastest(lift)
    if length > least * (1 + _SHORTEST):
        bare, low, high = limits.primal, primal(low), primal(high)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            slow = primal(lift) / middle + bare.ramp(middle) > length
            low, high = (middle, high) if slow else (low, middle)
        missing = lift / high + limits.ramp(high) - length
        high = solution_along(high, missing, bare.ramp_slope(high) - primal(lift) / high**2)
    return _profile(limits, high, lift / high).scaled(lift)


def _profile(limits: Limits, v: float, fast: float) -> MotionLaw:
    """Ramps within the limits, between them constant velocity; over ``fast`` the velocity v does the lift."""
    ramp = limits.ramp(v)
    corner = min(limits.acceleration / limits.jerk, 0.5 * ramp)
    up, flat, down = (
        (corner, Piece((0.0, 1.0))),
        (ramp - 2 * corner, Piece((1.0,))),
        (corner, Piece((1.0, -1.0))),
    )
    brake = [(size, piece.scaled(-1.0)) for size, piece in (up, flat, down)]
    stretches = [up, flat, down, (fast - ramp, Piece((0.0,))), *brake]
    kept = [(size, piece) for size, piece in stretches if size > _SHORTEST * (fast + ramp)]
    return rest_to_rest(*kept)
