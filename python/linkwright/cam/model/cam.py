r"""A cam on the crankshaft and the follower that it moves.

| follower | moves | makes |
| --- | --- | --- |
| translating | along a line, to the left of the cam's centre by the offset | a point on a slide |
| oscillating | about its own pivot | a link with a point at its end |

Its sections say how it moves over one revolution. Where the lift is smallest, the contact lies on the base
circle, r_0 from the cam's centre; a roller's centre then lies on the prime circle, r_0 + r_r. Two followers
that touch one cam on opposite sides have their distance, the breadth, instead: b = 2 (r_0 + r_r) + lift.

In the mechanism a cam stands for a driver that follows the programme (`cam_follower`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.cam.model.follower_motion import FollowerMotion, FollowerTrain, follower_motion
from linkwright.cam.model.motion_section import MotionSection, section_faults
from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.units.kinds import ANGLE, PRESSURE, RATIO
from linkwright.kernel.units.marks import ACUTE, Angle, Bound, Length, Quantity, not_negative, positive
from linkwright.linkages.model.element import PositiveLength

if TYPE_CHECKING:
    from linkwright.cam.laws.motion_law import MotionLaw
    from linkwright.cam.laws.programme import Programme

_LIMIT = Bound(
    " between 0 and 90 deg,",
    {"exclusiveMinimum": 0, "exclusiveMaximum": np.pi / 2},
    lambda value: 0 < value < np.pi / 2,
)
_TO_HALF = Bound(
    " of 0 or more and below 0.5,",
    {"minimum": 0, "exclusiveMaximum": 0.5},
    lambda value: 0 <= value < 0.5,
)

# Largest pressure angle by rule of thumb: a translating follower jams in its guide beyond 30°, an arm bears
# more. Norton, Cam Design and Manufacturing Handbook, 2nd ed., section 7.3.
_USUAL_LIMIT = {"translating": np.pi / 6, "oscillating": 7 * np.pi / 36}


class SecondFollower(Description):
    """The second follower of a conjugate pair of cams, fixed to the first."""

    shown_with_part: ClassVar[bool] = True

    roller_radius: PositiveLength | None = Field(
        None, description="Radius of the second roller. Default: that of the first."
    )
    distance: PositiveLength | None = Field(
        None, description="Translating follower: distance between the two rollers along the line of motion."
    )
    arm_length: PositiveLength | None = Field(
        None, description="Oscillating follower: length of the second arm. Default: that of the first."
    )
    angle: Annotated[float, Quantity(ANGLE)] | None = Field(
        None, description="Oscillating follower: angle between the two arms, across the cam."
    )


class Cam(CheckedDescription):
    """A cam on the crankshaft, and its follower."""

    advance: ClassVar[float] = 0.0  # of the lift per cycle: a cam closes

    follower: Literal["translating", "oscillating"] = Field(
        "translating", description="Translating or oscillating follower."
    )
    contact: Literal["roller", "point", "flat"] = Field(
        "roller", description="Contact of the follower: roller, knife edge or flat face."
    )
    closure: Literal["spring", "groove", "conjugate", "constant_diameter", "constant_breadth"] = Field(
        "spring",
        description="Joint closure: by force (spring), by a groove, by a conjugate cam with a second "
        "follower, or by one cam between two followers (constant diameter: points or rollers; constant "
        "breadth: flat faces).",
    )
    sections: tuple[MotionSection, ...] = Field(
        description="Motion programme of the follower over one revolution."
    )
    phase: Angle = Field(0.0, description="Crank angle at which the first section begins.")
    rotation: Literal["same", "opposite"] = Field(
        "same",
        description="Sense of rotation of the cam relative to the crankshaft; the speed is the same.",
    )
    pivot: str | None = Field(None, description="Fixed pivot of the cam. Default: the origin.")
    base_radius: PositiveLength | None = Field(
        None, description="Base radius, at minimum lift. Default: from the breadth."
    )
    breadth: PositiveLength | None = Field(
        None,
        description="Distance between two followers on opposite sides of one cam: edges, roller centres "
        "or faces.",
    )
    roller_radius: PositiveLength | None = Field(None, description="Radius of the roller.")
    direction: Angle = Field(
        0.0, description="Direction of the follower's motion, outwards, measured from the x axis."
    )
    offset: Length = Field(
        0.0,
        description="Offset of the follower's line of motion, positive to the left of the cam centre; of "
        "an oscillating face, from its pivot towards the cam.",
    )
    face_tilt: Annotated[float, Quantity(ANGLE, ACUTE)] = Field(
        0.0, description="Inclination of a translating face: angle of its normal to the direction of motion."
    )
    arm_pivot: str | None = Field(None, description="Fixed pivot of an oscillating follower.")
    arm_length: PositiveLength | None = Field(
        None, description="Distance from that pivot to the roller centre or edge."
    )
    side: Literal["left", "right"] = Field(
        "left", description="Side of the arm, looking from the cam centre to the pivot of the arm."
    )
    second: SecondFollower | None = Field(None, description="Second follower of a conjugate pair.")
    train: FollowerTrain | None = Field(
        None, description="Elastic follower train, between a translating follower and its load."
    )
    cutter_radius: PositiveLength | None = Field(None, description="Radius of the cutter or grinding wheel.")
    pressure_angle_limit: Annotated[float, Quantity(ANGLE, _LIMIT)] | None = Field(
        None,
        description="Maximum permitted pressure angle. Default: 30 deg for a translating and 35 deg for an "
        "oscillating follower.",
    )
    curvature_limit: PositiveLength | None = Field(
        None, description="Minimum permitted convex radius of curvature of the profile."
    )
    friction: Annotated[float, not_negative(RATIO)] = Field(
        0.0,
        description="Coefficient of friction of an edge or a face on the cam; used for forces, not for "
        "steady motion.",
    )
    width: PositiveLength | None = Field(None, description="Face width of the cam, for the contact pressure.")
    elastic_modulus: Annotated[float, positive(PRESSURE)] = Field(
        210e9, description="Young's modulus of cam and roller."
    )
    poisson_ratio: Annotated[float, Quantity(RATIO, _TO_HALF)] = Field(
        0.3, description="Poisson's ratio of cam and roller."
    )

    @property
    def is_roller(self) -> bool:
        """Whether it is touched by a roller, or by a knife edge, which is one of radius zero."""
        return self.contact != "flat"

    @property
    def is_oscillating(self) -> bool:
        """Whether its follower turns about a pivot."""
        return self.follower == "oscillating"

    @property
    def has_opposite(self) -> bool:
        """Whether one cam stands between two followers."""
        return self.closure in ("constant_diameter", "constant_breadth")

    @property
    def radius_of_roller(self) -> float:
        """Radius of the roller, zero for a knife edge or a flat face [m]."""
        return self.roller_radius if self.contact == "roller" and self.roller_radius is not None else 0.0

    @property
    def sliding_friction(self) -> float:
        """Coefficient of friction at the contact: none for a roller."""
        return 0.0 if self.contact == "roller" else self.friction

    @property
    def limit(self) -> float:
        """Largest pressure angle allowed [rad]."""
        given = self.pressure_angle_limit
        return _USUAL_LIMIT[self.follower] if given is None else given

    @property
    def motion(self) -> FollowerMotion:
        """How the follower moves over the cam angle from the start of the first section."""
        return follower_motion(self.sections, "swing" if self.is_oscillating else "lift", self.train)

    @property
    def programme(self) -> Programme:
        """Its programme, as the sections say."""
        return self.motion.programme

    @property
    def lift(self) -> MotionLaw:
        """The lift from the base circle: its minimum value is zero."""
        return self.motion.lift

    @property
    def stroke(self) -> float:
        """Maximum lift [m or rad]."""
        return self.motion.stroke

    @property
    def base(self) -> Any:
        """Radius of the base circle, given or from the breadth [m]."""
        if self.base_radius is not None:
            return self.base_radius
        assert self.breadth is not None
        start = 0.5 * (self.breadth - self.stroke)
        return start * np.cos(self.face_tilt) - self.radius_of_roller

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from section_faults(self.sections, "swing" if self.is_oscillating else "lift")
        yield from self._closure_faults()
        if self.contact == "roller" and self.roller_radius is None:
            remedy = 'or say contact = "point" or "flat"'
            yield fault("roller_radius", expected="the radius of the roller", remedy=remedy)
        if self.contact == "roller" and "friction" in self.model_fields_set and self.friction:
            yield fault("friction", found=self.friction, expected="nothing for a roller, which rolls")
        if self.contact != "roller" and self.roller_radius is not None:
            expected = f'nothing for contact = "{self.contact}"'
            yield fault("roller_radius", found=self.roller_radius, expected=expected)
        if self.is_oscillating:
            yield from self._arm_faults()
        else:
            yield from self._line_faults()

    def _closure_faults(self) -> Iterator[InitErrorDetails]:
        wanted = {"constant_diameter": True, "constant_breadth": False, "groove": True, "conjugate": True}
        if self.closure in wanted and wanted[self.closure] != self.is_roller:
            kinds = "rollers or points" if wanted[self.closure] else 'contact = "flat"'
            yield fault("contact", found=self.contact, expected=f"{kinds} for the closure {self.closure}")
        if self.has_opposite and (self.is_oscillating or np.any(self.offset != 0)):
            key = "follower" if self.is_oscillating else "offset"
            expected = "followers in one line through the cam's centre, on both sides of it"
            yield fault(key, found=getattr(self, key), expected=expected)
        given = [self.base_radius is not None, self.breadth is not None]
        if given[1] and not self.has_opposite:
            remedy = "the breadth is that of one cam between two followers"
            yield fault("breadth", found=self.breadth, expected="nothing", remedy=remedy)
        elif sum(given) != 1:
            found = "both" if all(given) else "neither"
            yield fault("base_radius", found=found, expected="either base_radius or breadth")
        yield from self._breadth_faults()
        if (self.closure == "conjugate") != (self.second is not None):
            yield fault(
                "second", found=self.second and "a table", expected='a table if the closure is "conjugate"'
            )
        if self.second is not None:
            yield from self._second_faults(self.second)

    def _second_faults(self, second: SecondFollower) -> Iterator[InitErrorDetails]:
        swings = self.is_oscillating
        wanted, what = ("angle", "the two arms") if swings else ("distance", "the two rollers")
        if getattr(second, wanted) is None:
            yield fault("second", wanted, expected=f"the distance between {what}")
        for key in ("distance",) if swings else ("angle", "arm_length"):
            if getattr(second, key) is not None:
                expected = f"nothing for {'an oscillating' if swings else 'a translating'} follower"
                yield fault("second", key, found=getattr(second, key), expected=expected)
        if self.contact == "point" and second.roller_radius is not None:
            yield fault("second", "roller_radius", found=second.roller_radius, expected="nothing for an edge")

    def _breadth_faults(self) -> Iterator[InitErrorDetails]:
        if self.breadth is None or not self.has_opposite or np.ndim(self.breadth):
            return
        if any(True for _ in section_faults(self.sections, "lift")) or self.is_oscillating:
            return
        least = self.stroke + 2 * self.radius_of_roller
        if self.breadth <= least:
            remedy = "half of the remainder is the base radius"
            yield fault("breadth", found=self.breadth, expected=f"more than {least:.6g} m", remedy=remedy)

    def _arm_faults(self) -> Iterator[InitErrorDetails]:
        if self.arm_pivot is None:
            yield fault("arm_pivot", expected="the fixed pivot of the follower")
        if self.arm_length is None and self.is_roller:
            yield fault("arm_length", expected="a length: from the follower's pivot to roller or edge")
        for key in ("direction", "face_tilt", "train"):
            if key in self.model_fields_set:
                found = "a table" if key == "train" else getattr(self, key)
                yield fault(key, found=found, expected="nothing for an oscillating follower")
        if self.is_roller and "offset" in self.model_fields_set:
            yield fault("offset", found=self.offset, expected="nothing for an arm with a roller or edge")

    def _line_faults(self) -> Iterator[InitErrorDetails]:
        for key in ("arm_pivot", "arm_length", "side"):
            if key in self.model_fields_set and getattr(self, key) is not None:
                yield fault(key, found=getattr(self, key), expected="nothing for a translating follower")
        if self.face_tilt and self.is_roller:
            yield fault("face_tilt", found=self.face_tilt, expected="nothing without a flat face")
        if not self.is_roller and np.any(self.offset != 0):
            remedy = "the contact of a flat face does not depend on the position of its stem"
            yield fault("offset", found=self.offset, expected="nothing for a flat face", remedy=remedy)
