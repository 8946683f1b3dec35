r"""How the follower of a cam moves: its programme over one revolution, from the base circle, and its peaks.

The same sections give the same motion, which is worked out once. A lift may move an elastic follower exactly
by a wanted law at one speed: for one mass on a train of stiffness k without damper of its own, with a closing
spring k_r and a damper to the frame,

.. math:: s = \frac1\kappa\left(x + 2\zeta_f\frac{\omega}{\Omega}\,x' + \frac{\omega^2}{\Omega^2}\,x''\right),
    \qquad \kappa = \frac{k}{k + k_r}, \qquad \Omega^2 = \frac{k + k_r}{m}

Source: W. M. Dudley, *New methods in valve cam design*, SAE Quarterly Transactions 2, 1948, 19–33;
D. A. Stoddart, *Polydyne cam design*, Machine Design 25, 1953.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.cam.laws.motion_law import MotionLaw, combined
from linkwright.cam.model.motion_section import Family, MotionSection, programme
from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.place import arrays, join
from linkwright.kernel.errors import ShapeError
from linkwright.kernel.numerics.tangent import sqrt
from linkwright.kernel.units.kinds import FORCE, MASS, RATIO, SPEED, STIFFNESS
from linkwright.kernel.units.marks import Quantity, not_negative, positive

if TYPE_CHECKING:
    from linkwright.cam.laws.motion_law import MotionLaw
    from linkwright.cam.laws.programme import Joint, Programme


def polydyne_correction(wanted: MotionLaw, slow: float, damping_ratio: float) -> MotionLaw:
    """What the lift is more than the wanted motion, both at the mass: κs − x.

    ``wanted``: x over the cam angle [m over rad]; ``slow``: ω/Ω, speed of the cam over the natural frequency
    [–]; ``damping_ratio``: ζ_f of the damper to the frame [–] → over the cam angle [m over rad].
    """
    return combined((2 * damping_ratio * slow, wanted.derivative(1)), (slow**2, wanted.derivative(2)))


def polydyne_lift(wanted: MotionLaw, slow: float, damping_ratio: float, share: float) -> MotionLaw:
    """Lift [m over rad] for the wanted motion [m over rad]; ``slow``, ``damping_ratio``, ``share`` [–]."""
    correction = polydyne_correction(wanted, slow, damping_ratio)
    return combined((1.0, wanted), (1.0, correction)).scaled(1 / share)


Ratio = Annotated[float, not_negative(RATIO)]


class FollowerTrain(CheckedDescription):
    """What vibrates between cam and load: one mass on one stiffness."""

    mass: Annotated[float, positive(MASS)] = Field(description="Moving mass, reduced to the follower.")
    stiffness: Annotated[float, positive(STIFFNESS)] = Field(description="Stiffness between cam and mass.")
    damping_ratio: Ratio = Field(0.0, description="Damping ratio of the damper between cam and mass.")
    damping_ratio_frame: Ratio = Field(0.0, description="Damping ratio of the damper between mass and frame.")
    spring_rate: Annotated[float, not_negative(STIFFNESS)] = Field(
        0.0, description="Rate of the closing spring."
    )
    preload: Annotated[float, Quantity(FORCE)] = Field(
        0.0, description="Preload of the closing spring at zero lift."
    )
    polydyne_speed: Annotated[float, positive(SPEED)] | None = Field(
        None,
        description="Speed at which the mass follows the sections exactly (polydyne cam): the lift of the "
        "cam is corrected for it. Default: the cam has the lift of the sections.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        both = self.damping_ratio + self.damping_ratio_frame
        if both >= 1:
            yield fault("damping_ratio", found=both, expected="less than 1, both together")
        if self.polydyne_speed is not None and self.damping_ratio:
            remedy = "with a damper in the train, the correction would not decay in a dwell"
            yield fault(
                "polydyne_speed", found=self.polydyne_speed, expected="a train without damper", remedy=remedy
            )

    def lift_for(self, wanted: MotionLaw) -> MotionLaw:
        """Lift that makes the mass move by the law ``wanted`` [m over rad] at the polydyne speed."""

        if self.polydyne_speed is None:
            return wanted
        stiff = self.stiffness + self.spring_rate
        slow = self.polydyne_speed / sqrt(stiff / self.mass)
        return polydyne_lift(wanted, slow, self.damping_ratio_frame, self.stiffness / stiff)


class FollowerMotion:
    """The motion that some sections describe.

    Parameters
    ----------
    sections : tuple of MotionSection
        Without faults.
    family : {"lift", "swing"}
        What the follower does.
    train : FollowerTrain or None
        What vibrates behind the cam, which may ask for a lift of its own.

    Attributes
    ----------
    programme : Programme
        As the sections say: it begins with zero.
    lift : MotionLaw
        Counted from the base circle: its minimum value is zero [m or rad].
    stroke : float
        Maximum lift [m or rad].

    Raises
    ------
    ShapeError
        An entry of a section or of the train is an array over many machines.
    """

    def __init__(
        self, sections: tuple[MotionSection, ...], family: Family, train: FollowerTrain | None
    ) -> None:
        for what, part in (("sections", sections), ("train", train)):
            for place, _ in arrays(part):
                raise ShapeError(
                    f"{join((what, *place))}: the {what} of a cam cannot vary from machine to machine in a "
                    "batch; compute machines with others one by one"
                )
        self.programme: Programme = programme(sections, family)
        law = self.programme.law if train is None else train.lift_for(self.programme.law)
        least, greatest = law.extremes()
        self.lift: MotionLaw = law.scaled(1.0, -least.value)
        self.stroke = greatest.value - least.value

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """How smooth the lift is at segment boundaries, and where a law inside a section has a break."""
        from linkwright.cam.laws.programme import joints

        return joints(self.lift.primal, self.lift.primal.breaks[:-1])

    @cached_property
    def stretches(self) -> tuple[MotionLaw, ...]:
        """The lift over each section."""
        starts = [joint.angle for joint in self.programme.joints]
        return tuple(self.lift.stretch(low, high) for low, high in pairwise([*starts, self.lift.end]))

    @cached_property
    def peaks(self) -> tuple[float | None, ...]:
        """Largest absolute first, second and third derivative by the cam angle; None where infinite."""
        smooth = min(joint.order for joint in self.joints)
        orders = range(1, 4)
        return tuple(abs(self.lift.peak(n).value) if n <= smooth + 1 else None for n in orders)

    @property
    def steady_velocity(self) -> float | None:
        """Largest velocity that is kept over a piece, by the cam angle; None if there is none."""
        return max(map(abs, self.steady_velocities), default=0.0) or None

    @cached_property
    def steady_velocities(self) -> tuple[float, ...]:
        """Velocities that are kept over a piece, by the cam angle."""
        return tuple(
            (piece.derivative(high - low).value(0.5))
            for piece, (low, high) in zip(self.lift.pieces, pairwise(self.lift.breaks), strict=True)
            if not piece.harmonics and not any(piece.polynomial[2:])
        )


def follower_motion(
    sections: tuple[MotionSection, ...], family: Family, train: FollowerTrain | None = None
) -> FollowerMotion:
    """The motion of some sections; the same as before for the same tuple."""
    key = (id(sections), family, id(train))
    if key not in _known:
        if len(_known) >= _KNOWN_MAX:
            _known.pop(next(iter(_known)), None)
        # The parts are kept with their motion, so that nothing else can take their identity.
        _known[key] = ((sections, train), FollowerMotion(sections, family, train))
    return _known[key][1]


_known: dict[tuple[int, Family, int], tuple[object, FollowerMotion]] = {}
_KNOWN_MAX = 64
