"""The driver that follows the law of an axis, in place of the one that the file has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from pydantic import Field

from linkwright.axes.model.axis import Axis, Master
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.programme import CLOSES, TURN, periodic
from linkwright.cam.model.motion_section import Family, MotionSection, programme
from linkwright.drive.model.drive import Drive, design_speed
from linkwright.kernel.description.place import arrays, join
from linkwright.kernel.errors import ShapeError
from linkwright.kernel.numerics.tangent import total
from linkwright.linkages.model.cylinder import Cylinder
from linkwright.linkages.model.element import Crank, LinearDriver

if TYPE_CHECKING:
    from linkwright.linkages.model.mechanism import Mechanism


class AxisProgramme(NamedTuple):
    """How a driver moves over the master angle."""

    law: MotionLaw  # from 0 to 2π, from 0 to what it advances [rad or m]
    lift: MotionLaw  # without the even part of that: periodic
    phase: Any  # master angle at which it begins [rad]
    advance: Any  # per cycle [rad or m]


class AxisCrank(Crank):
    """A crank that follows the law of an axis."""

    programme: Any = Field(description="Its motion over the master angle.")
    turn: float = Field(1.0, description="Sense of the angle as the law grows.")

    def follows(self) -> AxisProgramme:
        """Its motion over the master angle."""
        motion: AxisProgramme = self.programme
        return motion


class AxisDriver(LinearDriver):
    """A linear driver that follows the law of an axis."""

    programme: Any = Field(description="Its motion over the master angle.")

    def follows(self) -> AxisProgramme:
        """Its motion over the master angle."""
        motion: AxisProgramme = self.programme
        return motion


class AxisCylinder(Cylinder):
    """A cylinder whose extension follows the law of an axis."""

    programme: Any = Field(description="Its motion over the master angle.")

    def follows(self) -> AxisProgramme:
        """Its motion over the master angle."""
        motion: AxisProgramme = self.programme
        return motion


def cycle_time_of(master: Master | None, drive: Drive | None) -> float | None:
    """Duration of a cycle [s]; None where neither master nor drive says it."""
    speed = design_speed(master, drive)
    return None if speed is None else TURN / speed


def whole_sections(axis: Axis, cycle_time: float | None) -> tuple[MotionSection, ...]:
    """The sections of a cycle over angles of the master, with the dwell that is left of it."""
    given = tuple(section.over(cycle_time) for section in axis.sections)
    left = TURN - total(section.angle for section in given)
    return (*given, MotionSection.model_construct(angle=left)) if left > CLOSES * TURN else given


def family_of(mechanism: object, driver: str) -> Family | None:
    """Whether a driver swings or is lifted; None where it does neither."""
    from linkwright.kernel.description.place import keys, look

    if driver in keys(look(mechanism, "cranks")):
        return "swing"
    lifted = any(driver in keys(look(mechanism, table)) for table in ("linear_drivers", "cylinders"))
    return "lift" if lifted else None


def programme_of(axis: Axis, family: Family, cycle_time: float | None) -> AxisProgramme:
    """The motion that the sections of an axis describe."""
    for place, _ in arrays(axis.sections):
        raise ShapeError(
            f"{join(('sections', *place))}: the sections of an axis cannot vary from machine to machine in a "
            "batch; compute machines with others one by one"
        )
    advance = axis.advance if family == "swing" else axis.travel
    law = programme(whole_sections(axis, cycle_time), family, advance).law
    return AxisProgramme(law, periodic(law, advance), axis.phase, advance)


def with_axes(
    own: Mechanism, axes: Mapping[str, Axis], master: Master | None, drive: Drive | None
) -> Mechanism:
    """A mechanism whose drivers follow the sections of their axes."""
    cycle_time = cycle_time_of(master, drive)
    followers: dict[str, Any] = {
        "cranks": AxisCrank,
        "linear_drivers": AxisDriver,
        "cylinders": AxisCylinder,
    }
    made = {table: dict(getattr(own, table)) for table in followers}
    for name, axis in axes.items():
        driver = axis.driver or name
        family = family_of(own, driver)
        if not axis.sections or family is None:
            continue
        motion = programme_of(axis, family, cycle_time)
        table = next(table for table in made if driver in made[table])
        entries = {key: getattr(made[table][driver], key) for key in type(made[table][driver]).model_fields}
        made[table][driver] = followers[table].model_construct(**entries, programme=motion)
    return own.with_entries(made)
