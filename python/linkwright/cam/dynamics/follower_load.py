r"""What acts on a follower along its way, other than the cam and friction.

.. math:: F = m\ddot s + c\dot s + ks + F_0 + F_\mathrm{load}, \qquad
    \ddot s = s''\omega^2 + s'\varepsilon

Of an oscillating follower s is the angle ψ of its arm, m its moment of inertia about the pivot, and F a
torque.

Source: R. L. Norton, *Design of Machinery*, McGraw-Hill, chapter 15.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.kernel.public import public, public_type
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.result import PlainRecord
from linkwright.kernel.units.kinds import (
    ANGLE,
    ANGULAR_ACCELERATION,
    DAMPING,
    FORCE,
    LENGTH,
    MASS,
    SPEED,
    STIFFNESS,
)
from linkwright.kernel.units.marks import Quantity, not_negative, positive


def alike(**values: ArrayLike) -> dict[str, Floats]:
    """Arrays of one length (n,) by name; a single number stands for all places."""
    arrays = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    shapes = {name: array.shape for name, array in arrays.items() if array.shape != ()}
    if any(len(shape) > 1 or not shape[0] for shape in shapes.values()) or len(set(shapes.values())) > 1:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ShapeError(f"found arrays of shapes {listed}; expected lists of one length, not empty")
    shape = next(iter(shapes.values()), (1,))
    return {name: np.broadcast_to(array, shape).copy() for name, array in arrays.items()}


@public_type
@dataclass(frozen=True)
class FollowerLoad(PlainRecord):
    """Inertia, closing spring, damper and load of a follower, in the unit of its lift.

    Attributes
    ----------
    mass : float
        m, of all that moves with the follower [kg]; of an oscillating one its inertia [kg m²].
    spring_rate : float
        k [N/m or N m/rad].
    preload : float
        F₀, of the spring at no lift [N or N m].
    damping : float
        c [N s/m or N m s/rad].
    load : array_like, shape (n,) or ()
        From outside, positive against the lift, at each cam angle [N or N m].
    """

    mass: float
    spring_rate: float = 0.0
    preload: float = 0.0
    damping: float = 0.0
    load: ArrayLike = 0.0

    def __post_init__(self) -> None:
        """Refuse numbers that no follower has."""
        in_range(
            mass=(self.mass, not_negative(MASS)),
            spring_rate=(self.spring_rate, not_negative(STIFFNESS)),
            damping=(self.damping, not_negative(DAMPING)),
            preload=(self.preload, Quantity(FORCE)),
            load=(self.load, Quantity(FORCE)),
        )


# What the entries of a course are; lift and offset count in m, or in rad of an oscillating follower.
_COURSE = {
    "cam_angle": Quantity(ANGLE),
    **dict.fromkeys(("lift", "lift_d1", "lift_d2", "sliding", "offset"), Quantity(LENGTH)),
    "pressure_angle": Quantity(ANGLE),
    "speed": positive(SPEED),
    "acceleration": Quantity(ANGULAR_ACCELERATION),
}


@dataclass(frozen=True)
class CamCourse(PlainRecord):
    """The geometry of a cam drive over the cam angle, as far as forces need it.

    Attributes
    ----------
    cam_angle : ndarray, shape (n,)
        θ, increasing [rad].
    lift, lift_d1, lift_d2 : ndarray, shape (n,)
        s, s′, s″ [m, or rad of an oscillating follower].
    pressure_angle : ndarray, shape (n,)
        γ, between the normal of the cam at the contact and the way of the follower's end; positive where the
        normal leans to where the cam's surface runs, as in a rise in line [rad].
    sliding : ndarray, shape (n,)
        Velocity of the cam's surface relative to the follower's body at the contact, over ω, positive to
        where the surface runs as seen along the way [m/rad]. Needed for friction only.
    offset : ndarray, shape (n,)
        Of the contact from the axis of the follower's stem, to where the surface runs; of a flat face s′ [m].
    speed : ndarray, shape (n,)
        ω, positive [rad/s].
    acceleration : ndarray, shape (n,)
        ε [rad/s²].
    """

    cam_angle: Floats
    lift: Floats
    lift_d1: Floats
    lift_d2: Floats
    pressure_angle: Floats
    sliding: Floats
    offset: Floats
    speed: Floats
    acceleration: Floats

    def __post_init__(self) -> None:
        """Bring all to one length; refuse what is no course."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        in_range(**{name: (value, _COURSE[name]) for name, value in given.items()})
        for name, array in alike(**given).items():
            object.__setattr__(self, name, array)
        if (np.diff(self.cam_angle) < 0).any():
            k = int(np.flatnonzero(np.diff(self.cam_angle) < 0)[0])
            raise InputError(
                f"cam_angle: found {self.cam_angle[k + 1]:g} rad after {self.cam_angle[k]:g} rad, expected "
                "angles that increase"
            )
        if (np.abs(self.pressure_angle) >= 0.5 * np.pi).any():
            k = int(np.argmax(np.abs(self.pressure_angle)))
            raise InputError(
                f"pressure_angle: found {np.degrees(self.pressure_angle[k]):.6g}° at index {k}, expected "
                "less than 90°"
            )

    @property
    def velocity(self) -> Floats:
        """ṡ = s′ω, (n,) [m/s or rad/s]."""
        velocity: Floats = self.lift_d1 * self.speed
        return velocity

    @property
    def lift_ddot(self) -> Floats:
        """s̈ = s″ω² + s′ε, (n,) [m/s² or rad/s²]."""
        ddot: Floats = self.lift_d2 * self.speed**2 + self.lift_d1 * self.acceleration
        return ddot


@public
def cam_course(
    cam_angle: ArrayLike,
    lift: tuple[ArrayLike, ArrayLike, ArrayLike],
    speed: ArrayLike,
    *,
    pressure_angle: ArrayLike = 0.0,
    sliding: ArrayLike = 0.0,
    offset: ArrayLike = 0.0,
    acceleration: ArrayLike = 0.0,
) -> CamCourse:
    """The geometry of a cam drive over the cam angle; what is not given is zero.

    Parameters
    ----------
    cam_angle : array_like, shape (n,)
        θ, increasing [rad].
    lift : tuple of array_like, shape (n,)
        s, s′, s″ [m, or rad of an oscillating follower].
    speed, acceleration : array_like, shape (n,) or ()
        ω, positive, and ε [rad/s, rad/s²].
    pressure_angle : array_like, shape (n,) or ()
        γ [rad].
    sliding : array_like, shape (n,) or ()
        Of the surfaces, over ω [m/rad].
    offset : array_like, shape (n,) or ()
        Of the contact from the stem's axis [m].

    Returns
    -------
    CamCourse
        With arrays of one length.

    Raises
    ------
    InputError
        A number makes no sense.
    ShapeError
        Lengths differ.
    """
    given = alike(
        cam_angle=cam_angle,
        lift=lift[0],
        lift_d1=lift[1],
        lift_d2=lift[2],
        pressure_angle=pressure_angle,
        sliding=sliding,
        offset=offset,
        speed=speed,
        acceleration=acceleration,
    )
    return CamCourse(**given)


def force_along(course: CamCourse, follower: FollowerLoad) -> Floats:
    """F, (n,), along the way without friction [N or N m]; `ShapeError` if the load has another length."""
    load = alike(cam_angle=course.cam_angle, load=follower.load)["load"]
    along: Floats = (
        follower.mass * course.lift_ddot
        + follower.damping * course.velocity
        + follower.spring_rate * course.lift
        + follower.preload
        + load
    )
    return along
