r"""How a follower is held: in a straight guide, or on the pivot of an arm.

With a normal force |N| on the side κ = ±1 of the cam, and friction μ|N| along its surface, which runs with
the sign σ, the contact pushes along the way with α|N| and across it with τ|N|:

.. math:: \alpha = \kappa\cos\gamma - \mu\sigma\sin\gamma, \qquad
    \tau = \kappa\sin\gamma + \mu\sigma\cos\gamma

**Guide** of length B, whose near end is A away from the contact, stem of diameter d, contact beside the
stem's axis by x. With the friction μ_g of the guide and the sign σ_v of the velocity, and A′ = A − μ_g σ_v
d/2, the ends bear

.. math:: \frac{R_2}{|N|} = \frac{x\alpha + A'\tau}{B}, \qquad \frac{R_1}{|N|} = -\tau - \frac{R_2}{|N|}

and along the way |N|(α − μ_g σ_v(|R₁| + |R₂|)/|N|) = F. Without friction of the contact, x and d, and
rising, this is F = N(cos γ − μ_g(2A/B + 1) sin γ), the formula of the handbooks, and the follower jams
from tan γ = B/(μ_g(2A + B)) on.

**Pivot** at the end of an arm l, with friction μ_p in a journal of radius r, whose force is taken to be
that of the contact: |N|(l α − μ_p r σ_v √(1 + μ²)) = M.

Source: H. A. Rothbart, *Cam Design Handbook*, McGraw-Hill 2004, chapter 7, on the translating follower in
its guide; R. L. Norton, *Cam Design and Manufacturing Handbook*, chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright.cam.dynamics.follower_load import CamCourse, alike
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.kernel.public import public, public_type
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import LENGTH, RATIO
from linkwright.kernel.units.marks import not_negative, positive


class Push(NamedTuple):
    """What a normal force of one does to the follower."""

    # along, across: (n,): α and τ.
    along: Floats
    across: Floats
    friction: float  # μ of the contact
    moving: Floats  # (n,): σ_v, sign of the velocity; zero in a dwell


class BearingReaction(NamedTuple):
    """How a bearing answers to a normal force of one."""

    gain: Floats  # (n,): force or torque along the way that is left of it [– or m]
    # near, far: (n,): reactions at both ends of a guide, to where the cam's surface runs; of a pivot its
    # force, and zero [–].
    near: Floats
    far: Floats
    loss: Floats  # (n,): force or torque of friction in the bearing, against the motion [– or m]


def pushes(course: CamCourse, friction: float, side: Floats, moving: Floats) -> Push:
    """What a normal force of one does along and across the way.

    ``friction``: μ of the contact [–]; ``side`` (n,): κ, 1 for the flank that lifts, −1 for the other;
    ``moving`` (n,): σ_v.
    """
    cos, sin = np.cos(course.pressure_angle), np.sin(course.pressure_angle)
    rub = friction * np.sign(course.sliding)
    return Push(side * cos - rub * sin, side * sin + rub * cos, friction, moving)


@public_type
@dataclass(frozen=True)
class StemGuide:
    """A straight guide of the stem.

    Attributes
    ----------
    length : float
        B, between its ends [m].
    overhang : float
        A at no lift: from the contact, or the roller's centre, to the near end [m].
    coefficient : float
        μ_g [–].
    diameter : float
        d, of the stem [m].
    """

    length: float
    overhang: float
    coefficient: float = 0.0
    diameter: float = 0.0

    def __post_init__(self) -> None:
        """Refuse numbers that no guide has."""
        in_range(
            length=(self.length, positive(LENGTH)),
            overhang=(self.overhang, not_negative(LENGTH)),
            coefficient=(self.coefficient, not_negative(RATIO)),
            diameter=(self.diameter, not_negative(LENGTH)),
        )

    @public
    def held(self, course: CamCourse, push: Push) -> BearingReaction:
        """Reactions and friction at each angle of a course, (n,), for a normal force of one.

        Refuses a lift that draws the end of the follower into its guide.
        """
        overhang = self.overhang - course.lift
        if (overhang < 0).any():
            k = int(np.argmin(overhang))
            raise FindingError(
                f"the lift of {course.lift[k]:.6g} m at cam angle θ = "
                f"{np.degrees(course.cam_angle[k]):.4g}° moves the end of the follower into its guide, "
                f"{self.overhang:.6g} m away; increase the overhang by {-overhang[k]:.6g} m"
            )
        lever = overhang - 0.5 * self.coefficient * push.moving * self.diameter
        far = (course.offset * push.along + lever * push.across) / self.length
        near = -push.across - far
        loss = self.coefficient * push.moving * (np.abs(near) + np.abs(far))
        return BearingReaction(push.along - loss, near, far, loss)


@public_type
@dataclass(frozen=True)
class ArmPivot:
    """The pivot of an oscillating follower.

    Attributes
    ----------
    arm : array_like, shape (n,) or ()
        l, from the pivot to the follower's end, or to the contact of a flat face [m].
    coefficient : float
        μ_p [–].
    radius : float
        r, of the journal [m].
    """

    arm: ArrayLike
    coefficient: float = 0.0
    radius: float = 0.0

    def __post_init__(self) -> None:
        """Refuse numbers that no pivot has."""
        in_range(
            arm=(self.arm, positive(LENGTH)),
            coefficient=(self.coefficient, not_negative(RATIO)),
            radius=(self.radius, not_negative(LENGTH)),
        )

    @public
    def held(self, course: CamCourse, push: Push) -> BearingReaction:
        """Reaction and friction at each angle of a course, (n,), for a normal force of one."""
        force = np.full_like(course.cam_angle, np.hypot(1.0, push.friction))
        loss = self.coefficient * self.radius * push.moving * force
        arm = alike(cam_angle=course.cam_angle, arm=self.arm)["arm"]
        return BearingReaction(arm * push.along - loss, force, np.zeros_like(force), loss)


@dataclass(frozen=True)
class NoFriction:
    """A bearing of a translating follower that takes whatever comes across the way, without friction."""

    @public
    def held(self, course: CamCourse, push: Push) -> BearingReaction:
        """Nothing is lost; the whole reaction counts as that of the near end, for each angle."""
        none = np.zeros_like(course.cam_angle)
        return BearingReaction(push.along, -push.across, none, none)


Bearing = StemGuide | ArmPivot | NoFriction
