"""The train between a cam and the mass that it moves, as one mass on one stiffness; the lift made for it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units import FORCE, MASS, RATIO, SPEED, STIFFNESS, Quantity, not_negative, positive

if TYPE_CHECKING:
    from linkwright.cam.laws.motion_law import MotionLaw

Ratio = Annotated[float, not_negative(RATIO)]


class FollowerTrain(CheckedDescription):
    """What vibrates between cam and load: one mass on one stiffness."""

    mass: Annotated[float, positive(MASS)] = Field(description="Of all that moves, reduced to the follower.")
    stiffness: Annotated[float, positive(STIFFNESS)] = Field(description="Between the cam and the mass.")
    damping_ratio: Ratio = Field(0.0, description="Of the damper between the cam and the mass.")
    damping_ratio_frame: Ratio = Field(0.0, description="Of the damper between the mass and the frame.")
    spring_rate: Annotated[float, not_negative(STIFFNESS)] = Field(
        0.0, description="Of the spring that closes."
    )
    preload: Annotated[float, Quantity(FORCE)] = Field(0.0, description="Of that spring at no lift.")
    polydyne_speed: Annotated[float, positive(SPEED)] | None = Field(
        None,
        description="Speed at which the mass is to move exactly as the sections say: the cam gets the lift "
        "for it. Without it the cam has the lift of the sections.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        both = self.damping_ratio + self.damping_ratio_frame
        if both >= 1:
            yield fault("damping_ratio", found=both, expected="less than 1, both together")
        if self.polydyne_speed is not None and self.damping_ratio:
            remedy = "behind a damper in the train the lift of a dwell would never fade"
            yield fault(
                "polydyne_speed", found=self.polydyne_speed, expected="a train without damper", remedy=remedy
            )

    def lift_for(self, wanted: MotionLaw) -> MotionLaw:
        """The lift that makes the mass move by a law at the polydyne speed.

        Parameters
        ----------
        wanted : MotionLaw
            x over the cam angle [m over rad].

        Returns
        -------
        MotionLaw
            s, see `linkwright.cam.laws.polydyne`; the law itself without a polydyne speed.
        """
        from linkwright.cam.laws.polydyne import polydyne_lift

        if self.polydyne_speed is None:
            return wanted
        stiff = self.stiffness + self.spring_rate
        slow = self.polydyne_speed / math.sqrt(stiff / self.mass)
        return polydyne_lift(wanted, slow, self.damping_ratio_frame, self.stiffness / stiff)
