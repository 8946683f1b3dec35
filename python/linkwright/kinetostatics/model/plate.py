"""A link cut from a plate: mass and moment of inertia by its outline, its thickness and its density.

With the area A and the polar second moment of area I_p about the centre of area, m = ρ t A and J = ρ t I_p.

Source: Norton, *Design of Machinery*, section 10.5.
"""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import AREA, AREA_MOMENT, DENSITY, LENGTH
from linkwright.kernel.units.marks import Length, Lengths, positive


class Plate(CheckedDescription):
    """A link cut from a plate, by a drawing of its outline or by the area and its moments."""

    shown_with_part: ClassVar[bool] = True

    file: str | None = Field(
        None,
        description="DXF file with the closed outline of the link and its holes; it gives the area, its "
        "centre and its second moment.",
    )
    layers: tuple[str, ...] | None = Field(
        None, description="Layers of the outline and its holes. Default: the only layer with curves."
    )
    unit: Annotated[float, positive(LENGTH)] | None = Field(
        None, description='Unit of the DXF file, such as "1 mm", if the file does not state it.'
    )
    start: Lengths | None = Field(
        None, description="x and y in the drawing of the joint where the link starts. Default: its origin."
    )
    end: Lengths | None = Field(
        None,
        description="x and y in the drawing of the joint where the link ends. Default: the link lies along "
        "the x axis of the drawing.",
    )
    thickness: Annotated[float, positive(LENGTH)] = Field(description="Thickness of the plate.")
    density: Annotated[float, positive(DENSITY)] = Field(description="Density of the material.")
    area: Annotated[float, positive(AREA)] | None = Field(None, description="Area, without holes.")
    second_moment: Annotated[float, positive(AREA_MOMENT)] | None = Field(
        None, description="Polar second moment of area about its centre."
    )
    along: Length = Field(0.0, description="Position of its centre along the link, from its start.")
    across: Length = Field(0.0, description="Position of its centre across the link, positive to the left.")
    distance: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Distance of the two joints in the drawing, which is compared with the link."
    )

    @property
    def mass(self) -> Any:
        """m = ρ t A [kg]."""
        area: Any = self.area
        return self.density * self.thickness * area

    @property
    def inertia(self) -> Any:
        """About the centre of mass, J = ρ t I_p [kg m²]."""
        second_moment: Any = self.second_moment
        return self.density * self.thickness * second_moment

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            expected = "area and second_moment: a drawing is read with the machine file that names it"
            yield fault("file", found=self.file, expected=expected)
            return
        for name in ("layers", "unit", "start", "end"):
            if getattr(self, name) is not None:
                yield fault(name, found=getattr(self, name), expected="it beside a file of which it tells")
        for name in ("area", "second_moment"):
            if getattr(self, name) is None:
                yield fault(name, expected='a file with the outline, such as "link.dxf", or this entry')
