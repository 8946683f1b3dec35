"""The mechanism: cranks on the crankshaft, and the elements that they move, one built on another.

Angles count counter-clockwise from the x axis. Elements refer to each other by name, in any order; `outline`
says which points and links each of them makes.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import Field, ModelWrapValidatorHandler, ValidationError, model_validator

from linkwright.machine.base import Description, Name, faults_of, raise_faults
from linkwright.machine.outline import ORIGIN, Outline
from linkwright.units import LENGTH, Angle, Length, positive

PositiveLength = Annotated[float, positive(LENGTH)]


class FixedPoint(Description):
    """A point of the frame."""

    x: Length = Field(0.0, description="To the right of the origin.")
    y: Length = Field(0.0, description="Above the origin.")


class Crank(Description):
    """A crank on the crankshaft; all cranks turn together."""

    radius: PositiveLength = Field(description="From the pivot to the pin.")
    phase: Angle = Field(0.0, description="Angle of this crank when the crank angle is zero.")
    pivot: str | None = Field(None, description="Fixed point that it turns about. Without it, the origin.")


class Slider(Description):
    """A slider on a straight guide, moved through a rod."""

    crank: str = Field(description="Moving point that drives it: the pin of a crank, or another.")
    rod: PositiveLength = Field(description="From the driving point to the slider.")
    offset: Length = Field(0.0, description="Of the guide to the left of its direction.")
    angle: Angle = Field(0.0, description="Direction of the guide.")
    through: str | None = Field(
        None,
        description="Fixed point that the guide would pass through without offset. "
        "Without it, the pivot of the crank, or the origin.",
    )
    assembly: Literal["positive", "negative"] = Field(
        "positive", description="Side of the slider, along the guide, from the driving point."
    )


class Rocker(Description):
    """A coupler and a rocker that meet in a joint."""

    crank: str = Field(description="Moving point that drives the coupler.")
    pivot: str = Field(description="Point that the rocker turns about; it may move.")
    coupler: PositiveLength = Field(description="From the driving point to the joint.")
    rocker: PositiveLength = Field(description="From the pivot to the joint.")
    assembly: Literal["left", "right"] = Field(
        "left", description="Side of the joint, seen from the driving point to the pivot."
    )


class RigidPoint(Description):
    """A point fixed to a link."""

    link: str = Field(description="Link that carries it.")
    along: Length = Field(description="From the start of the link along it.")
    across: Length = Field(0.0, description="To the left of the link.")


class Link(NamedTuple):
    """A link of a mechanism: the rigid body between two of its points.

    Attributes
    ----------
    role : str
        ``"crank"``, ``"rod"``, ``"coupler"`` or ``"rocker"``.
    element : str
        Name of the element that makes it.
    start, end : str
        Names of the points that it runs between.
    length : float
        Distance between them [m].
    """

    role: Literal["crank", "rod", "coupler", "rocker"]
    element: str
    start: str
    end: str
    length: float


class Mechanism(Description):
    """Fixed points, cranks, and what the cranks move."""

    points: dict[Name, FixedPoint] = Field(default_factory=dict, description="Fixed points by name.")
    cranks: dict[Name, Crank] = Field(default_factory=dict, description="Cranks by name.")
    sliders: dict[Name, Slider] = Field(default_factory=dict, description="Sliders by name.")
    rockers: dict[Name, Rocker] = Field(default_factory=dict, description="Rockers by name.")
    rigid_points: dict[Name, RigidPoint] = Field(
        default_factory=dict, description="Points fixed to links, by name."
    )

    @model_validator(mode="wrap")
    @classmethod
    def _names_fit(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Report wrong values and wrong names together."""
        try:
            mechanism = handler(data)
        except ValidationError as error:
            raise_faults(cls.__name__, [*faults_of(error), *Outline.of(data).faults()])
            raise
        raise_faults(cls.__name__, Outline.of(mechanism).faults())
        return mechanism

    def fixed_points(self) -> dict[str, FixedPoint]:
        """The points at rest by name, with the origin."""
        own = dict(self.points)
        return {name: own.get(name) or FixedPoint(x=0.0, y=0.0) for name in Outline.of(self).fixed_points}

    def moving_points(self) -> tuple[str, ...]:
        """Names of the points that move: pins, sliders, joints and rigid points."""
        return tuple(Outline.of(self).moving_points)

    def slides(self) -> tuple[str, ...]:
        """Names of the points that move on a guide."""
        return tuple(self.sliders)

    def links(self) -> dict[str, Link]:
        """The links by name.

        Returns
        -------
        dict of str to Link
            A crank has the name of its element; ``"cart1.rod"`` is the rod of the slider ``cart1``.
        """
        found: dict[str, Link] = {}
        for name, crank in self.cranks.items():
            found[name] = Link("crank", name, crank.pivot or ORIGIN, name, crank.radius)
        for name, slider in self.sliders.items():
            found[f"{name}.rod"] = Link("rod", name, slider.crank, name, slider.rod)
        for name, rocker in self.rockers.items():
            found[f"{name}.coupler"] = Link("coupler", name, rocker.crank, name, rocker.coupler)
            found[f"{name}.rocker"] = Link("rocker", name, rocker.pivot, name, rocker.rocker)
        return found

    def build_order(self) -> list[str]:
        """Names of the moving elements, each after those that it is built on."""
        return Outline.of(self).order()
