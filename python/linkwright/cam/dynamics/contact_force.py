r"""What follower and cam press on each other, which flank carries, and the torque of the cam shaft.

Along the way of the follower the normal force N balances the force F of inertia, damper, spring and load,
and the friction of contact and bearing (`linkwright.cam.dynamics.bearing`). A follower that is held in a
groove, or by a second cam, is carried by the flank that lifts where F > 0, and by the other where F < 0.
The torque follows from power:

.. math:: M = s'(F + L) + \mu|N||v_\mathrm{slide}|/\omega

with the friction L of the bearing along the way.

Source: R. L. Norton, *Design of Machinery*, McGraw-Hill, chapter 15; H. A. Rothbart, *Cam Design
Handbook*, chapter 7.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np

from linkwright.cam.dynamics.backlash import SideChange, side_changes
from linkwright.cam.dynamics.bearing import ArmPivot, Bearing, BearingReaction, NoFriction, Push, pushes
from linkwright.cam.dynamics.follower_load import CamCourse, FollowerLoad, force_along
from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.zeros import zero
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import LENGTH, RATIO
from linkwright.kernel.units.marks import not_negative

Closure = Literal["force", "form"]

# Share of the largest s′ below which the follower rests, and friction has no direction.
_REST = 1e-9

# What is left of a normal force of one, over what is left without friction, below which the follower jams:
# beyond a thousand times the force no part is rigid any more.
_JAM = 1e-3


_NORMAL = (
    "Negative on the other flank of a form-closed follower, and what is lacking where a force-closed one "
    "leaves the cam; NaN where it jams."
)


@dataclass(frozen=True)
class ContactForce(Result):
    """Forces between cam and follower over the cam angle."""

    cam_angle: Annotated[Floats, Label("cam angle", "θ", "rad")]
    force_along: Annotated[
        Floats,
        Label(
            "force required along the follower's path",
            "F",
            "N",
            "Friction left out; N m of an oscillating follower.",
        ),
    ]
    normal: Annotated[Floats, Label("normal force", "N", "N", _NORMAL)]
    side: Annotated[
        Floats,
        Label("flank that carries", "", "", "1 on the lifting flank, −1 on the other."),
    ]
    across: Annotated[
        Floats,
        Label("force of the cam across the path", "", "N", "In the direction in which the surface moves."),
    ]
    near: Annotated[
        Floats,
        Label(
            "reaction at the near end of the guide",
            "",
            "N",
            "In the direction in which the surface moves; of a pivot, its force.",
        ),
    ]
    far: Annotated[
        Floats,
        Label(
            "reaction at the far end of the guide",
            "",
            "N",
            "In the direction in which the surface moves; of a pivot, its force.",
        ),
    ]
    torque: Annotated[Floats, Label("driving torque of the cam shaft for this follower", "", "N m")]
    power: Annotated[Floats, Label("power of the cam shaft", "", "W")]
    power_friction: Annotated[Floats, Label("power of friction", "", "W", "Never positive.")]
    jammed: Annotated[Bools, About("Where no force of the cam moves the follower, shape (n,).")]
    lost: Annotated[Bools, About("Where a force-closed follower leaves the cam, shape (n,).")]
    normal_max: Annotated[float, Label("maximum normal force", "N_max", "N", "Largest size.")]
    normal_max_angle: Annotated[float, Label("cam angle of the maximum normal force", "θ(N_max)", "rad")]
    normal_min: Annotated[float, Label("minimum normal force", "N_min", "N")]
    torque_max: Annotated[
        float, Label("maximum driving torque of the cam shaft", "", "N m", "Over the angles given.")
    ]
    torque_min: Annotated[
        float, Label("minimum driving torque of the cam shaft", "", "N m", "Over the angles given.")
    ]
    torque_mean: Annotated[
        float,
        Label(
            "mean driving torque of the cam shaft",
            "",
            "N m",
            "Over the angles given: conservative forces exactly, what is left by Simpson's rule.",
        ),
    ]
    torque_mean_error: Annotated[
        float,
        Label(
            "error of the mean driving torque",
            "",
            "N m",
            "Measured: by how much the mean differs from that of every second angle; NaN of two angles.",
        ),
    ]
    side_changes: Annotated[
        tuple[SideChange, ...], About("Where the force goes from one flank to the other, form-closed.")
    ]
    findings: Annotated[tuple[str, ...], About("Jams, loss of contact, changes of the flank, in sentences.")]


@public
def contact_force(
    course: CamCourse,
    follower: FollowerLoad,
    bearing: Bearing | None = None,
    *,
    friction: float = 0.0,
    closure: Closure = "force",
    clearance: float = 0.0,
) -> ContactForce:
    """Forces between a cam and its follower.

    Parameters
    ----------
    course : CamCourse
        Geometry and motion, n angles.
    follower : FollowerLoad
        Inertia, spring, damper, load.
    bearing : StemGuide, ArmPivot or NoFriction, optional
        How it is held; without it, as a translating follower without friction.
    friction : float
        μ of the contact; of a roller on a journal, μ of the journal times its radius over the roller's [–].
    closure : {"force", "form"}
        Whether a spring or a second flank holds the follower on the cam.
    clearance : float
        Between the two flanks of a form-closed follower, along the way [m or rad].

    Returns
    -------
    ContactForce
        Over the cam angle.

    Raises
    ------
    InputError
        A number makes no sense; friction of the contact without sliding.
    FindingError
        The follower is drawn into its guide.
    """
    in_range(friction=(friction, not_negative(RATIO)), clearance=(clearance, not_negative(LENGTH)))
    if friction and not course.sliding.any():
        raise InputError(
            "sliding: found zero everywhere, expected the sliding of the contact, since it has friction"
        )
    bearing = bearing or NoFriction()
    force = force_along(course, follower)
    side = np.where((force < 0) & (closure == "form"), -1.0, 1.0)
    held, push = _held(course, bearing, friction, side)
    easy = _held(course, _without_friction(bearing), 0.0, side)[0].gain
    jammed = held.gain / easy < _JAM
    size = np.where(jammed, np.nan, force / np.where(jammed, 1.0, held.gain))
    lost = ~jammed & (size < 0)
    rub = friction * np.abs(size) * np.abs(course.sliding)
    torque = course.lift_d1 * (force + held.loss * np.abs(size)) + rub
    loss = held.loss * np.abs(size) * course.velocity + rub * course.speed
    changes = side_changes(course, force, follower.mass, clearance) if closure == "form" else ()
    at = int(np.nanargmax(np.abs(size))) if not jammed.all() else 0
    normal = size * side
    mean, error = _mean(course, follower, torque)
    return ContactForce(
        cam_angle=course.cam_angle,
        force_along=force,
        normal=normal,
        side=side,
        across=push.across * size,
        near=held.near * size,
        far=held.far * size,
        torque=torque,
        power=torque * course.speed,
        power_friction=-loss,
        jammed=jammed,
        lost=lost,
        normal_max=float(abs(normal[at])),
        normal_max_angle=float(course.cam_angle[at]),
        normal_min=_over(np.min, normal),
        torque_max=_over(np.max, torque),
        torque_min=_over(np.min, torque),
        torque_mean=mean,
        torque_mean_error=error,
        side_changes=changes,
        findings=(
            *_jams(course, bearing, friction, side, jammed),
            *_losses(course, force, lost),
            *(str(change) for change in changes),
        ),
    )


def _held(course: CamCourse, bearing: Bearing, friction: float, side: Floats) -> tuple[BearingReaction, Push]:
    """Effect of a unit normal force on the carrying flank, and the reaction of the bearing."""
    still = np.abs(course.lift_d1) <= _REST * np.abs(course.lift_d1).max(initial=0.0)
    moving = np.where(still, 0.0, np.sign(course.lift_d1))
    push = pushes(course, friction, side, moving)
    return bearing.held(course, push), push


def _without_friction(bearing: Bearing) -> Bearing:
    return bearing if isinstance(bearing, NoFriction) else replace(bearing, coefficient=0.0)


def _over(what: object, values: Floats) -> float:
    assert callable(what)
    there = values[np.isfinite(values)]
    return float(what(there)) if len(there) else math.nan


def _mean(course: CamCourse, follower: FollowerLoad, torque: Floats) -> tuple[float, float]:
    """Mean torque over the angle, and its change with every second angle; NaN if values are missing."""
    # The work of inertia at constant speed, spring and constant load is that of their energies at the ends.
    angle = course.cam_angle
    span = float(angle[-1] - angle[0])
    if not span > 0:
        return float(torque[0]), 0.0
    energy, conservative = _energy(course, follower)
    rest = torque - course.lift_d1 * conservative
    gained = float(energy[-1] - energy[0])
    by_all, by_half = (_simpson(angle[at], rest[at]) for at in (slice(None), _every_second(len(angle))))
    return (gained + by_all) / span, abs(by_all - by_half) / span


def _energy(course: CamCourse, follower: FollowerLoad) -> tuple[Floats, Floats]:
    """Energy of a follower [J], and the force along its path that does this work [N]."""
    s, d1 = course.lift, course.lift_d1
    load = float(np.asarray(follower.load).flat[0]) if np.ndim(follower.load) == 0 else 0.0
    energy = 0.5 * follower.spring_rate * s**2 + (follower.preload + load) * s
    force = follower.spring_rate * s + follower.preload + load
    if np.ptp(course.speed) == 0 and not course.acceleration.any():
        inertia = follower.mass * course.speed**2
        energy, force = energy + 0.5 * inertia * d1**2, force + inertia * course.lift_d2
    return energy, force


def _every_second(n: int) -> Indices:
    return np.unique(np.append(np.arange(0, n, 2), n - 1))


def _simpson(angle: Floats, values: Floats) -> float:
    from scipy.integrate import simpson

    # Angles may come twice, at both sides of a joint of the law: a step in between has no width.
    joints = np.flatnonzero(np.diff(angle) == 0) + 1
    parts = zip(np.split(angle, joints), np.split(values, joints), strict=True)
    return float(sum(simpson(y, x=x) for x, y in parts if len(x) > 1))


def _stretches(flags: Bools) -> Iterator[tuple[int, int]]:
    edges = np.diff(np.concatenate([[False], flags, [False]]).astype(int))
    yield from zip(np.flatnonzero(edges > 0), np.flatnonzero(edges < 0) - 1, strict=True)


def _from_to(course: CamCourse, low: int, high: int) -> str:
    first, last = np.degrees(course.cam_angle[[low, high]])
    angle = "cam angle θ ="
    return f"at {angle} {first:.4g}°" if low == high else f"from {angle} {first:.4g}° to {last:.4g}°"


def _jams(course: CamCourse, bearing: Bearing, friction: float, side: Floats, jammed: Bools) -> Iterator[str]:
    """Where friction jams the follower, and by how much the pressure angle must decrease."""
    for low, high in _stretches(jammed):
        gamma = course.pressure_angle[low : high + 1]
        k = low + int(np.argmax(np.abs(gamma)))
        limit = _limit(course, bearing, friction, side, k)
        yield (
            f"the follower jams {_from_to(course, low, high)}: the pressure angle is "
            f"{np.degrees(course.pressure_angle[k]):.4g}° at θ = {np.degrees(course.cam_angle[k]):.4g}°, and "
            f"friction allows {np.degrees(limit):.4g}° there; give a larger base circle, a longer guide, "
            "less overhang or less friction"
        )


def _limit(course: CamCourse, bearing: Bearing, friction: float, side: Floats, row: int) -> float:
    """Pressure angle, of the same sign, beyond which the follower jams at one row."""
    sign = math.copysign(1.0, course.pressure_angle[row])
    if isinstance(bearing, ArmPivot) and np.ndim(bearing.arm):
        bearing = replace(bearing, arm=np.asarray(bearing.arm)[row])
    return sign * zero(
        lambda size: _gain(course, bearing, friction, side, row, sign * size) * side[row],
        0.0,
        0.5 * math.pi * (1 - 1e-12),
    )


def _gain(
    course: CamCourse, bearing: Bearing, friction: float, side: Floats, row: int, gamma: float
) -> float:
    """Component along the path of a unit normal force, at one row with another pressure angle."""
    one = slice(row, row + 1)
    values = {name: getattr(course, name)[one] for name in CamCourse.__dataclass_fields__}
    there = CamCourse(**(values | {"pressure_angle": np.array([gamma])}))
    return float(_held(there, bearing, friction, side[one])[0].gain[0])


def _losses(course: CamCourse, force: Floats, lost: Bools) -> Iterator[str]:
    for low, high in _stretches(lost):
        k = low + int(np.argmin(force[low : high + 1]))
        yield (
            f"the follower leaves the cam {_from_to(course, low, high)}: increase the force along its "
            f"path by {-force[k]:.4g} at θ = {np.degrees(course.cam_angle[k]):.4g}°"
        )
