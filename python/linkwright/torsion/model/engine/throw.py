"""The geometry of one crank throw: main journal, crank pin, two webs, drillings, counterweights.

Lengths *along* are counted from the axis of the shaft towards the axis of the pin, lengths *across* to the
left of it, seen so that the shaft turns counter-clockwise. A throw goes from the middle of one main journal
to the middle of the next, so it has one whole journal, one pin and two webs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.units.kinds import INERTIA, LENGTH, MASS
from linkwright.kernel.units.marks import Angle, Length, Lengths, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.torsion.model.engine.polygon import Points, first_crossing, holds, signed_area
from linkwright.torsion.model.shaft_section import Density, Modulus

# Steel: the same as of the shafts of a train.
STEEL_DENSITY = 7850.0
STEEL_SHEAR = 79.3e9
STEEL_ELASTIC = 206e9


class Journal(CheckedDescription):
    """A main journal of a crankshaft, solid or bored."""

    length: PositiveLength = Field(description="Length between the webs.")
    diameter: PositiveLength = Field(description="Outer diameter.")
    inner_diameter: Annotated[float, not_negative(LENGTH)] = Field(0.0, description="Diameter of the bore.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.inner_diameter >= self.diameter:
            expected = f"a bore smaller than the diameter, {self.diameter:.6g} m"
            yield fault("inner_diameter", found=self.inner_diameter, expected=expected)


class CrankPin(Journal):
    """A crank pin, solid or bored; its bore may lie beside its axis."""

    bore_offset: Length = Field(
        0.0, description="Offset of the axis of the bore from that of the pin, positive away from the shaft."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        wall = (self.diameter - self.inner_diameter) / 2
        if 0 < wall <= abs(self.bore_offset):
            expected = f"less than {wall:.6g} m, so that the bore stays inside the pin"
            yield fault("bore_offset", found=self.bore_offset, expected=expected)


class CrankWeb(CheckedDescription):
    """One of the two equal webs of a throw: a plate of a rectangular, round or any other outline."""

    thickness: PositiveLength = Field(description="Thickness along the shaft.")
    width: PositiveLength | None = Field(
        None,
        description="Width across the crank, halfway between shaft and pin; used for the stiffness. "
        "Default for a disc: its diameter.",
    )
    outline: Literal["rectangle", "disc", "polygon"] = Field(
        "rectangle", description="Outline of the web, seen along the shaft."
    )
    length: PositiveLength | None = Field(
        None,
        description="Length of a rectangle along the crank. Default: from the far side of the journal to "
        "the far side of the pin.",
    )
    diameter: PositiveLength | None = Field(None, description="Diameter of a disc.")
    centre: Length | None = Field(
        None,
        description="Position of the centre of a disc, or of a rectangle with a length, along the crank. "
        "Default: halfway between shaft and pin.",
    )
    along: Lengths | None = Field(None, description="Corners of a polygon in order, along the crank.")
    across: Lengths | None = Field(None, description="Corners of a polygon in order, across the crank.")

    # Which keys each outline asks for, and which it may have besides.
    _KEYS = {  # noqa: RUF012
        "rectangle": (("width",), ("length", "centre")),
        "disc": (("diameter",), ("width", "centre")),
        "polygon": (("width", "along", "across"), ()),
    }

    def _faults(self) -> Iterator[InitErrorDetails]:
        needed, allowed = self._KEYS[self.outline]
        for key in ("width", "length", "diameter", "centre", "along", "across"):
            value = getattr(self, key)
            if value is None and key in needed:
                yield fault(key, expected=f'an entry, which the outline "{self.outline}" needs')
            elif value is not None and key not in (*needed, *allowed):
                yield fault(key, found=value, expected=f'no entry for the outline "{self.outline}"')
        if self.centre is not None and self.outline == "rectangle" and self.length is None:
            yield fault("length", expected="the length of the rectangle that the centre is of")
        if self.along is not None and self.across is not None:
            yield from self._polygon_faults()

    def _polygon_faults(self) -> Iterator[InitErrorDetails]:
        assert self.along is not None
        assert self.across is not None
        if len(self.along) != len(self.across):
            expected = f"as many lengths as in along, {len(self.along)}"
            yield fault("across", found=f"{len(self.across)} lengths", expected=expected)
            return
        corners = self.corners
        if len(corners) < 3:
            yield fault("along", found=f"{len(corners)} corners", expected="at least three corners")
            return
        crossing = first_crossing(corners)
        if crossing is not None:
            found = f"sides {crossing[0] + 1} and {crossing[1] + 1} that meet"
            yield fault("along", found=found, expected="an outline that does not touch or cross itself")
        elif signed_area(corners) == 0:
            yield fault("along", found="corners in a line", expected="corners that enclose an area")

    @property
    def corners(self) -> Points:
        """Corners of a polygon (along, across) [m]; a last one that repeats the first is left out."""
        listed = tuple(zip(self.along or (), self.across or (), strict=False))
        return listed[:-1] if len(listed) > 1 and listed[0] == listed[-1] else listed

    @property
    def breadth(self) -> float:
        """Width that the stiffness counts with [m]."""
        breadth = self.diameter if self.width is None else self.width
        assert breadth is not None
        return breadth


class Drilling(Description):
    """A hole drilled into a throw: an oil way, a hole that makes a web lighter."""

    diameter: PositiveLength = Field(description="Diameter of the hole.")
    length: PositiveLength = Field(description="Length of the hole in metal.")
    radius: Length = Field(
        0.0,
        description="Distance of its middle from the axis of the shaft, along the crank; negative away "
        "from the pin.",
    )
    inclination: Angle = Field(0.0, description="Inclination of the hole to the axis of the shaft.")


class Counterweight(CheckedDescription):
    """A counterweight of a throw, by its mass or as the sector of a ring."""

    direction: Angle = Field(
        math.pi,
        description="Angle from the crank to the middle of the counterweight, in the sense of rotation.",
    )
    mass: Annotated[float, positive(MASS)] | None = Field(None, description="Mass of the counterweight.")
    radius: PositiveLength | None = Field(
        None, description="Distance of the centre of mass from the axis of the shaft."
    )
    inertia: Annotated[float, not_negative(INERTIA)] | None = Field(
        None, description="Moment of inertia about the centre of mass, axis along the shaft. Default: 0."
    )
    outer_radius: PositiveLength | None = Field(
        None, description="Outer radius of a sector, instead of the mass."
    )
    inner_radius: Annotated[float, not_negative(LENGTH)] | None = Field(
        None, description="Inner radius of the sector. Default: 0."
    )
    angle: Angle | None = Field(None, description="Angle of the sector.")
    thickness: PositiveLength | None = Field(None, description="Thickness of the sector along the shaft.")
    density: Density | None = Field(None, description="Density of the sector. Default: that of the throw.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        sector = ("outer_radius", "inner_radius", "angle", "thickness", "density")
        lump = ("mass", "radius", "inertia")
        given = [key for key in (*lump, *sector) if getattr(self, key) is not None]
        wanted, other = (
            (sector, lump) if self.mass is None and self.outer_radius is not None else (lump, sector)
        )
        needed = ("outer_radius", "angle", "thickness") if wanted is sector else ("mass", "radius")
        for key in needed:
            if key not in given:
                remedy = "give mass and radius, or outer_radius, angle and thickness of a sector"
                yield fault(key, expected=f"an entry beside {needed[0]}", remedy=remedy)
        for key in other:
            if key in given:
                expected = f"no {key}: either mass and radius, or a sector"
                yield fault(key, found=getattr(self, key), expected=expected)
        yield from self._sector_faults()

    def _sector_faults(self) -> Iterator[InitErrorDetails]:
        if self.outer_radius is not None and (self.inner_radius or 0.0) >= self.outer_radius:
            expected = f"less than the outer radius, {self.outer_radius:.6g} m"
            yield fault("inner_radius", found=self.inner_radius, expected=expected)
        if self.angle is not None and not 0 < self.angle <= 2 * math.pi:
            found = f"{math.degrees(self.angle):.6g}°"
            yield fault("angle", found=found, expected="an angle above 0 and up to 360°")


class CrankThrow(CheckedDescription):
    """One throw of a crankshaft, from the middle of a main journal to the middle of the next."""

    radius: PositiveLength = Field(description="Throw radius, from the axis of the shaft to that of the pin.")
    journal: Journal = Field(description="Main journal: half of it on each side of the throw.")
    pin: CrankPin = Field(description="Crank pin.")
    web: CrankWeb = Field(description="Web; a throw has two equal webs.")
    drillings: tuple[Drilling, ...] = Field((), description="Drillings and holes.")
    counterweights: tuple[Counterweight, ...] = Field((), description="Counterweights.")
    density: Density = Field(STEEL_DENSITY, description="Density of the material. Default: steel.")
    shear_modulus: Modulus = Field(STEEL_SHEAR, description="Shear modulus of the material. Default: steel.")
    elastic_modulus: Modulus = Field(
        STEEL_ELASTIC, description="Young's modulus of the material. Default: steel."
    )
    restraint_length: PositiveLength | None = Field(
        None,
        description="Ratio of torque to bearing reaction, for the formula of constrained bearings. "
        "Default: from the geometry.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        R = self.radius
        for point, what in (((0.0, 0.0), "shaft"), ((R, 0.0), "pin")):
            if not self._web_holds(point):
                key = {"rectangle": "length", "disc": "diameter", "polygon": "along"}[self.web.outline]
                expected = f"a web that the axis of the {what} goes through, {point[0]:.6g} m along the crank"
                yield fault("web", key, found=getattr(self.web, key), expected=expected)

    def _web_holds(self, point: tuple[float, float]) -> bool:
        if self.web.outline == "polygon":
            return holds(self.web.corners, point)
        if self.web.outline == "disc":
            assert self.web.diameter is not None
            return math.dist(point, (self.web_centre, 0.0)) < self.web.diameter / 2
        return abs(point[0] - self.web_centre) < self.web_length / 2

    @property
    def web_length(self) -> float:
        """Of a rectangular web, along the crank [m]."""
        given = self.web.length
        return self.radius + (self.journal.diameter + self.pin.diameter) / 2 if given is None else given

    @property
    def web_centre(self) -> float:
        """Of a disc or a rectangle, along the crank [m]."""
        if self.web.centre is not None:
            return self.web.centre
        if self.web.outline == "rectangle" and self.web.length is None:
            return (self.radius + (self.pin.diameter - self.journal.diameter) / 2) / 2
        return self.radius / 2

    @property
    def length(self) -> float:
        """From the middle of one main journal to the middle of the next [m]."""
        return self.journal.length + self.pin.length + 2 * self.web.thickness
