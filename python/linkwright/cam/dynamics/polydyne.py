"""The lift that lets an elastic follower move exactly by a wanted law, at the speed of its design.

`linkwright.cam.model.follower_motion` has the formula: the equation of the one mass, read for the lift.
The preload is in balance at rest and does not appear. The lift is continuous if x″ is, its velocity if x‴ is,
its acceleration if x⁗ is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.cam.dynamics.one_mass import OneMass
from linkwright.cam.dynamics.oscillator import Ends, continuity, steps
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.model.follower_motion import polydyne_correction, polydyne_lift
from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import SPEED
from linkwright.kernel.units.marks import positive

# Share of the lift below which the cam's reaching under its base circle is rounding.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Polydyne(Result):
    """The lift of a polydyne cam."""

    lift: Annotated[MotionLaw, About("s of the cam [m].")]
    wanted: Annotated[MotionLaw, About("x of the follower's mass [m].")]
    speed: Annotated[float, Label("speed for which the cam is made", "ω", "rad/s")]
    continuity: Annotated[int, Label("highest order up to which the derivatives of x have no jump", "", "")]
    lift_max: Annotated[float, Label("maximum lift", "", "m")]
    lift_min: Annotated[
        float,
        Label("minimum lift", "", "m", "A cam dips below its base circle where s is less than at rest."),
    ]
    correction_max: Annotated[
        float, Label("maximum correction of the lift", "", "m", "Peak absolute value of κs − x.")
    ]
    acceleration_max: Annotated[
        float, Label("maximum acceleration by the lift", "", "m/s²", "Peak absolute value of s″ω².")
    ]
    findings: Annotated[tuple[str, ...], About("Impacts, jumps of acceleration, and dips, in sentences.")]


@public
def polydyne(wanted: MotionLaw, model: OneMass, speed: float, ends: Ends = "dwell") -> Polydyne:
    """Lift for a required motion of the follower mass.

    Parameters
    ----------
    wanted : MotionLaw
        x over the cam angle [m over rad].
    model : OneMass
        The follower, without damper in its train.
    speed : float
        ω for which the cam is made [rad/s].
    ends : {"dwell", "turn"}
        Whether the follower dwells before and after the law, or the law repeats.

    Returns
    -------
    Polydyne
        The lift.

    Raises
    ------
    InputError
        The train has a damper: behind it, the lift of a dwell would never fade.
    FindingError
        x, x′ or x″ jumps: the lift would have to jump.
    """
    in_range(speed=(speed, positive(SPEED)))
    if model.damping_ratio:
        raise InputError(
            f"damping_ratio: found {model.damping_ratio:g}, expected 0: with a damper in the train, no "
            "lift with dwells keeps the follower at rest; give it as damping_ratio_frame, or correct "
            "without it and check the residual vibration"
        )
    smooth = continuity(wanted, ends)
    if smooth < 2:
        raise FindingError(_jump(wanted, ends, smooth + 1))
    slow = speed / model.natural_frequency
    correction = polydyne_correction(wanted, slow, model.damping_ratio_frame)
    lift = polydyne_lift(wanted, slow, model.damping_ratio_frame, model.share)
    low, high = lift.extremes()
    return Polydyne(
        lift=lift,
        wanted=wanted,
        speed=speed,
        continuity=smooth,
        lift_max=high.value,
        lift_min=low.value,
        correction_max=abs(correction.peak().value),
        acceleration_max=abs(lift.peak(2).value) * speed**2,
        findings=tuple(_findings(wanted, lift, smooth)),
    )


def _jump(wanted: MotionLaw, ends: Ends, order: int) -> str:
    jumps = steps(wanted, order, ends)
    k = int(np.argmax(np.abs(jumps)))
    return (
        f"derivative {order} of the wanted motion jumps by {jumps[k]:.4g} m/rad^{order} at "
        f"{wanted.breaks[k]:.6g} rad: the lift would have to jump; choose a law whose acceleration is "
        "continuous and begins and ends with zero"
    )


def _findings(wanted: MotionLaw, lift: MotionLaw, smooth: int) -> list[str]:
    sentences = []
    if smooth == 2:
        sentences.append(
            "the third derivative of the wanted motion jumps, so the velocity of the lift jumps (impact); "
            "choose a law with continuous jerk, such as the polynomial 4-5-6-7"
        )
    if smooth == 3:
        sentences.append(
            "the fourth derivative of the wanted motion jumps, so the acceleration of the lift jumps; choose "
            "a law with four continuous derivatives, such as the polynomial 5-6-7-8-9, to avoid it"
        )
    at_rest = min(float(lift.at(lift.start)), float(lift.at(lift.end, 0, "before")))
    dip = at_rest - lift.extremes()[0].value
    if dip > _ROUNDING * float(np.ptp(wanted.at(np.linspace(wanted.start, wanted.end, 65)))):
        sentences.append(f"the lift dips by {1e3 * dip:.4g} mm below its lower end")
    return sentences
