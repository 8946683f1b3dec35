"""The mechanism: drivers on the crankshaft, and the elements that they move, one built on another.

Angles count counter-clockwise from the x axis. Elements refer to each other by name, in any order; `topology`
says which points and links each of them makes.
"""

from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self

from pydantic import Field, ModelWrapValidatorHandler, ValidationError, model_validator

from linkwright.kernel.description.base import Description, Name, faults_of, raise_faults
from linkwright.kernel.description.deferred_model import deferred_model
from linkwright.kernel.units.marks import Angle
from linkwright.linkages.model.assembly import Step
from linkwright.linkages.model.cylinder import Cylinder
from linkwright.linkages.model.element import (
    Bar,
    Cable,
    Crank,
    Crossing,
    FixedPoint,
    Gear,
    Joint,
    LinearDriver,
    Rack,
    RigidPoint,
    Rocker,
    Slider,
    SlottedLever,
    Yoke,
)
from linkwright.linkages.model.topology import ORIGIN, TABLES, Topology

if TYPE_CHECKING:
    from linkwright.cam.model.cam import Cam
else:
    Cam = deferred_model("cam.model.cam", "Cam")


_ORIGIN = FixedPoint(x=0.0, y=0.0)


class Link(NamedTuple):
    """A link of a mechanism: the rigid body between two of its points."""

    role: Literal["crank", "rod", "coupler", "rocker", "lever", "bar", "gear", "yoke", "barrel", "piston rod"]
    element: str  # name of the element that makes it
    # Names of the points that it runs between; the same for a gear or a yoke, which has one point.
    start: str
    end: str
    length: float  # distance between them [m]; zero where it is not given


class Mechanism(Description):
    """Fixed points, cranks, and what the cranks move."""

    points: dict[Name, FixedPoint] = Field(default_factory=dict, description="Fixed points by name.")
    cranks: dict[Name, Crank] = Field(default_factory=dict, description="Cranks by name.")
    sliders: dict[Name, Slider] = Field(default_factory=dict, description="Sliders by name.")
    rockers: dict[Name, Rocker] = Field(default_factory=dict, description="Rockers by name.")
    rigid_points: dict[Name, RigidPoint] = Field(
        default_factory=dict, description="Points fixed to links, by name."
    )
    linear_drivers: dict[Name, LinearDriver] = Field(
        default_factory=dict, description="Points moved along a guide by the drive, by name."
    )
    cams: dict[Name, Cam] = Field(default_factory=dict, description="Cams and their followers by name.")
    slotted_levers: dict[Name, SlottedLever] = Field(
        default_factory=dict, description="Slotted levers by name."
    )
    crossings: dict[Name, Crossing] = Field(default_factory=dict, description="Pins in two guides, by name.")
    yokes: dict[Name, Yoke] = Field(default_factory=dict, description="Yokes by name.")
    gears: dict[Name, Gear] = Field(default_factory=dict, description="Gears and pulleys by name.")
    racks: dict[Name, Rack] = Field(default_factory=dict, description="Racks by name.")
    cables: dict[Name, Cable] = Field(default_factory=dict, description="Cables on arcs, by name.")
    joints: dict[Name, Joint] = Field(default_factory=dict, description="Joints of bars and guides, by name.")
    bars: dict[Name, Bar] = Field(default_factory=dict, description="Bars between points, by name.")
    cylinders: dict[Name, Cylinder] = Field(
        default_factory=dict, description="Hydraulic cylinders between points, by name."
    )
    assembled_at: Angle = Field(
        0.0, description="Crank angle to which the approximate positions of the joints refer."
    )

    @model_validator(mode="wrap")
    @classmethod
    def _names_fit(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            mechanism = handler(data)
        except ValidationError as error:
            raise_faults(cls.__name__, [*faults_of(error), *Topology.of(data).faults(values_fit=False)])
            raise
        raise_faults(cls.__name__, Topology.of(mechanism).faults())
        if mechanism.cams:
            from linkwright.cam.model.follower import cam_place_faults

            raise_faults(cls.__name__, cam_place_faults(mechanism))
        return mechanism

    def fixed_points(self) -> dict[str, FixedPoint]:
        """The points at rest by name, with the origin."""
        bears = any(ORIGIN in getattr(self, table) for table in TABLES)
        return ({} if bears else {ORIGIN: _ORIGIN}) | self.points

    def moving_points(self) -> tuple[str, ...]:
        """Names of the points that move."""
        return tuple(Topology.of(self).moving_points)

    def slides(self) -> tuple[str, ...]:
        """Names of the coordinates along guides."""
        return tuple(Topology.of(self).slides)

    def links(self) -> dict[str, Link]:
        """Links by name: a crank has its element's; ``"cart1.rod"`` is the rod of the slider ``cart1``."""
        links: dict[str, Link] = {}
        for name, crank in self.cranks.items():
            links[name] = Link("crank", name, crank.pivot or ORIGIN, name, crank.radius)
        for name, cam in self.cams.items():
            if cam.is_oscillating:
                links[name] = Link("crank", name, cam.arm_pivot or ORIGIN, name, cam.arm_length or 0.0)
        for name, slider in self.sliders.items():
            links[f"{name}.rod"] = Link("rod", name, slider.crank, name, slider.rod)
        for name, rocker in self.rockers.items():
            links[f"{name}.coupler"] = Link("coupler", name, rocker.crank, name, rocker.coupler)
            links[f"{name}.rocker"] = Link("rocker", name, rocker.pivot, name, rocker.rocker)
        for name, lever in self.slotted_levers.items():
            links[name] = Link("lever", name, lever.pivot, lever.pin, lever.length or 0.0)
        for name in self.yokes:
            links[name] = Link("yoke", name, name, name, 0.0)
        for name, gear in self.gears.items():
            links[name] = Link("gear", name, gear.pivot, gear.pivot, 0.0)
        for name, bar in self.bars.items():
            links[name] = Link("bar", name, bar.start, bar.end, bar.length)
        for name, cylinder in self.cylinders.items():
            ends = cylinder.start, cylinder.end
            links[name] = Link("barrel", name, *ends, cylinder.barrel_length or 0.0)
            links[f"{name}.rod"] = Link("piston rod", name, *ends[::-1], cylinder.rod_length or 0.0)
        return links

    def drivers(self) -> dict[str, Crank | LinearDriver | Cylinder]:
        """What is moved over the crank angle: cranks, linear drivers, and cylinders that are drivers."""
        cylinders = {name: cylinder for name, cylinder in self.cylinders.items() if cylinder.drives}
        return {**self.cranks, **self.linear_drivers, **cylinders}

    def laws(self) -> dict[str, Crank | LinearDriver | Cylinder]:
        """Drivers that follow a formula, by name."""
        return {name: driver for name, driver in self.drivers().items() if driver.law is not None}

    def steps(self) -> list[Step]:
        """The steps in which the mechanism is built."""
        return Topology.of(self).build().steps

    def build_order(self) -> list[str]:
        """Names of the moving elements, each after those that it is built on."""
        return [name for step in self.steps() for name in step.names]
