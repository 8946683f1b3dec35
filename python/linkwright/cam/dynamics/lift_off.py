r"""At which speed a spring-closed follower leaves its cam, and which preload holds it.

Without friction the follower presses along its way with

.. math:: F(\theta, \omega) = m s''\omega^2 + c s'\omega + ks + F_0 + F_\mathrm{load}

It first leaves the cam at the speed at which the minimum F over the revolution becomes zero; without damper,
at

.. math:: \omega = \min_{s'' < 0} \sqrt{\frac{ks + F_0 + F_\mathrm{load}}{-m s''}}

That minimum is found with the exact extremes of F, a law in pieces like the lift: from the speed at which
F is zero at one angle, go to the angle at which F is smallest at that speed, and so on. Every step lowers the
speed, as in the method of Dinkelbach for ratios, and the last one changes nothing but rounding.

Source: R. L. Norton, *Design of Machinery*, McGraw-Hill, chapter 15, on follower jump; W. Dinkelbach, *On
nonlinear fractional programming*, Management Science 13, 1967, 492–498.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from linkwright.cam.dynamics.follower_load import FollowerLoad
from linkwright.cam.dynamics.oscillator import steps, without_steps
from linkwright.cam.laws.motion_law import Extreme, MotionLaw, combined
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import FORCE, MASS, SPEED
from linkwright.kernel.units.marks import not_negative, positive

# Steps to the minimum speed: each about doubles the number of digits.
_ROUNDS = 60

# Angles a piece from which the search may begin.
_STARTS = 17

# Change of the speed that is rounding.
_ROUNDING = 4e-16


@dataclass(frozen=True)
class LiftOff(Result):
    """Where and when a follower leaves its cam."""

    speed: Annotated[
        float,
        Label(
            "minimum speed at which the follower leaves the cam", "ω", "rad/s", "Infinite if it never does."
        ),
    ]
    cam_angle: Annotated[float, Label("cam angle where it leaves first", "θ", "rad")]
    lift_d2: Annotated[float, Label("second derivative of the lift there", "s″", "m/rad²")]
    force_spring: Annotated[float, Label("force of spring and load there", "", "N", "ks + F₀ + F_load.")]


@public
def lift_off(lift: MotionLaw, follower: FollowerLoad, load: MotionLaw | None = None) -> LiftOff:
    """The minimum speed at which the follower leaves the cam.

    Parameters
    ----------
    lift : MotionLaw
        s over one revolution [m over rad].
    follower : FollowerLoad
        Inertia, spring, damper; its load a single number.
    load : MotionLaw, optional
        What acts from outside besides, over the same revolution, positive against the lift [N over rad].

    Returns
    -------
    LiftOff
        Speed and angle.

    Raises
    ------
    FindingError
        Nothing presses the follower on the cam at rest, or its velocity jumps and it leaves at any speed.
    InputError
        The lift jumps or is not one revolution long; the load is an array, or there is no mass.
    """
    without_steps(lift, "turn")
    in_range(mass=(follower.mass, positive(MASS)))
    held = _spring(lift, follower, load)
    low = held.extremes()[0]
    if low.value <= 0:
        raise FindingError(
            f"at rest the follower does not stay on the cam at cam angle θ = {np.degrees(low.at):.4g}°: "
            f"spring and load give a contact force of {low.value:.4g} N; increase the "
            f"preload by {-low.value:.4g} N or more"
        )
    _no_drop(lift, "there the follower leaves the cam at any speed")
    return _least(lift, follower, held)


def _no_drop(lift: MotionLaw, consequence: str) -> None:
    drops = steps(lift, 1, "turn")
    if (drops < 0).any():
        k = int(np.argmin(drops))
        raise FindingError(
            f"the velocity of the lift drops by {-drops[k]:.4g} m/rad at cam angle θ = "
            f"{np.degrees(lift.breaks[k]):.4g}°: {consequence}; choose a law with continuous velocity"
        )


def _spring(lift: MotionLaw, follower: FollowerLoad, load: MotionLaw | None) -> MotionLaw:
    outside = np.asarray(follower.load, dtype=float)
    if outside.ndim:
        raise InputError(
            "follower.load: found an array, expected a number; give a load over the angle as a law"
        )
    held = lift.scaled(follower.spring_rate, follower.preload + float(outside))
    return combined((1.0, held), (1.0, load)) if load else held


def _needed(lift: MotionLaw, follower: FollowerLoad, speed: float) -> MotionLaw:
    """m s″ω² + c s′ω."""
    return combined(
        (follower.mass * speed**2, lift.derivative(2)), (follower.damping * speed, lift.derivative(1))
    )


def _least(lift: MotionLaw, follower: FollowerLoad, held: MotionLaw) -> LiftOff:
    """The search for the minimum speed."""
    at, speed = _start(lift, follower, held)
    for _ in range(_ROUNDS):
        if math.isinf(speed):
            break
        low = combined((1.0, _needed(lift, follower, speed)), (1.0, held)).extremes()[0]
        speed_at = _speed_at(lift, follower, held, low)
        if speed_at >= speed * (1 - _ROUNDING):
            break
        at, speed = low, speed_at
    return LiftOff(
        speed=speed,
        cam_angle=at.at,
        lift_d2=float(lift.at(at.at, 2, at.side)),
        force_spring=float(held.at(at.at, 0, at.side)),
    )


def _start(lift: MotionLaw, follower: FollowerLoad, held: MotionLaw) -> tuple[Extreme, float]:
    places = [lift.extremes(2)[0], lift.extremes(1)[0]]
    for low, high in zip(lift.breaks, lift.breaks[1:], strict=False):
        places += [Extreme(float(x), 0.0, "after") for x in np.linspace(low, high, _STARTS)[:-1]]
    speeds = [_speed_at(lift, follower, held, place) for place in places]
    best = int(np.argmin(speeds))
    return places[best], speeds[best]


def _speed_at(lift: MotionLaw, follower: FollowerLoad, held: MotionLaw, place: Extreme) -> float:
    """The minimum positive root of m s″ω² + c s′ω + held = 0 at one angle; infinite if there is none."""
    a = follower.mass * float(lift.at(place.at, 2, place.side))
    b = follower.damping * float(lift.at(place.at, 1, place.side))
    c = float(held.at(place.at, 0, place.side))
    return float(speed_of_loss(c, b, a))


def speed_of_loss(still: ArrayLike, linear: ArrayLike, square: ArrayLike) -> Floats:
    """The minimum positive ω at which a force N₀ + N₁ω + N₂ω² that presses at rest becomes zero.

    ``still``, ``linear``, ``square`` (n,) or (): N₀, positive; N₁ and N₂ [N, N s/rad, N s²/rad²] → ω;
    infinite where there is none [rad/s], (n,) or ().
    """
    c, b, a = (np.asarray(x, dtype=float) for x in (still, linear, square))
    inside = b * b - 4 * a * c
    # The root that is smaller and positive, without cancellation.
    below = np.sqrt(np.maximum(inside, 0.0)) - b
    there = (inside >= 0) & (below > 0)
    return np.where(there, 2 * c / np.where(there, below, 1.0), np.inf)


@dataclass(frozen=True)
class LeastPreload(Result):
    """The preload that holds a follower on its cam."""

    preload: Annotated[float, Label("minimum preload", "F₀", "N", "Negative if none is needed.")]
    cam_angle: Annotated[float, Label("cam angle that determines it", "", "rad")]


@public
def least_preload(
    lift: MotionLaw,
    follower: FollowerLoad,
    speed: float,
    load: MotionLaw | None = None,
    *,
    contact: float = 0.0,
) -> LeastPreload:
    """The minimum preload with which the follower stays on the cam at a speed.

    Parameters
    ----------
    lift : MotionLaw
        s over one revolution [m over rad].
    follower : FollowerLoad
        Inertia, spring rate, damper; its load a single number, its preload does not count.
    speed : float
        ω [rad/s].
    load : MotionLaw, optional
        What acts from outside besides, over the same revolution, positive against the lift [N over rad].
    contact : float
        Force along the way with which it shall press at least [N].

    Returns
    -------
    LeastPreload
        Preload and angle.

    Raises
    ------
    FindingError
        The velocity of the lift drops at once, and no preload holds it.
    InputError
        The lift jumps or is not one revolution long; the load is an array, or the speed makes no sense.
    """
    in_range(speed=(speed, positive(SPEED)), contact=(contact, not_negative(FORCE)))
    without_steps(lift, "turn")
    _no_drop(lift, "no preload holds the follower there")
    held = _spring(lift, follower, load).scaled(1.0, -follower.preload)
    low = combined((1.0, _needed(lift, follower, speed)), (1.0, held)).extremes()[0]
    return LeastPreload(preload=contact - low.value, cam_angle=low.at)
