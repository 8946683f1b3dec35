"""The roots of a field that a topper goes over: random ones by their distributions, or measured ones.

[topper.field]
kind = "random"
root_diameter = { kind = "normal", mean = "110 mm", deviation = "18 mm", least = "50 mm" }
cut_height = { kind = "normal", mean = "30 mm", deviation = "8 mm" }
offset = { kind = "normal", mean = "0 mm", deviation = "10 mm" }
spacing = "0.3 m"
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Whole, fault
from linkwright.kernel.description.curve import unread_file
from linkwright.kernel.limits import ROOTS
from linkwright.kernel.units.kinds import DENSITY, LENGTH
from linkwright.kernel.units.marks import Length, Lengths, Quantity, positive
from linkwright.topping.model.scatter import AnyScatter, ConstantScatter, Scatter, UniformScatter


class RootField(CheckedDescription):
    """What all fields have."""

    seed: Annotated[Whole, Field(ge=0)] = Field(1, description="Seed of the random generator.")
    root_density: Annotated[float, positive(DENSITY)] | None = Field(
        None, description="Density of the roots, for the lost mass."
    )
    cut_height_shift: Length = Field(
        0.0, description="Shift added to each cut height, as if the knife were set lower."
    )


class RandomField(RootField):
    """Roots that scatter."""

    kind: Literal["random"] = Field(description="Random roots by distributions.")
    roots: Annotated[Whole, Field(ge=2, le=ROOTS.most)] = Field(20_000, description="Number of roots.")
    rows: Annotated[Whole, Field(ge=2, le=ROOTS.most)] = Field(
        100, description="Number of rows; each begins at a random phase of the knife."
    )
    root_diameter: AnyScatter | None = Field(
        None, description="Diameter D, a length or a table. Default: that of [topper]."
    )
    cut_height: AnyScatter | None = Field(
        None,
        description="Cut height h_p, a length or a table; 0 or less where the knife passes above the "
        "head. Default: that of [topper].",
    )
    offset: AnyScatter | None = Field(
        None,
        description="Offset of the root's axis to the left of the row. Default: uniform within ± that of "
        "[topper].",
    )
    spacing: AnyScatter | None = Field(
        None,
        description="Distance between neighbouring roots along the row; gives the phases of the knife. "
        "Default: phases are independent and uniform.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.rows > self.roots:
            yield fault("rows", found=self.rows, expected=f"at most one for each of {self.roots} roots")
        for key in ("root_diameter", "spacing"):
            scatter: Scatter | None = getattr(self, key)
            if scatter is not None and scatter.ends[0] <= 0 and not _begins_at_zero(scatter):
                yield _below_zero(key, scatter)


def _begins_at_zero(scatter: Scatter) -> bool:
    """Whether it has but positive values, though zero is its end."""
    return scatter.ends[0] == 0 < scatter.ends[1]


def _below_zero(key: str, scatter: Scatter) -> InitErrorDetails:
    expected = "a length greater than 0"
    if isinstance(scatter, ConstantScatter):
        return fault(key, found=scatter.value, expected=expected)
    lowest = scatter.ends[0]
    found = "no minimum value" if math.isinf(lowest) else f"values down to {lowest:.6g} m"
    return fault(key, found=found, expected=expected + " for each", remedy='add least, such as "20 mm"')


class MeasuredField(RootField):
    """Roots that were measured; each is examined in many phases of the knife."""

    kind: Literal["measured"] = Field(description="Measured roots.")
    file: str | None = Field(
        None,
        description="CSV file beside the machine file, instead of the lists, with units in the header: "
        '"root_diameter [mm], cut_height [mm], offset [mm]".',
    )
    phases: Annotated[Whole, Field(ge=4, le=100_000)] = Field(
        64,
        description="Number of knife phases at which each root is evaluated, evenly spaced over one "
        "revolution.",
    )
    root_diameter: Lengths = Field((), description="Diameter D of each root.")
    cut_height: Lengths = Field(
        (), description="Cut height h_p of each root; 0 or less where the knife passes above the head."
    )
    offset: Lengths = Field((), description="Offset of each root's axis to the left of the row.")
    spacing: Lengths | None = Field(
        None,
        description="Distance of each root from the preceding one along the row; the first value is not "
        "used. Given, it relates the phases of all roots.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
            return
        for key in ("root_diameter", "cut_height", "offset"):
            if len(getattr(self, key)) < 2:
                expected = "a column with the lengths of 2 roots or more"
                yield fault(key, found=f"{len(getattr(self, key))} of them", expected=expected)
        if len(self.root_diameter) * self.phases > ROOTS.most:
            found = f"{self.phases} phases of each of {len(self.root_diameter)} roots"
            yield fault("phases", found=found, expected=ROOTS.words)
        yield from self._length_faults()
        yield from self._value_faults()

    def _length_faults(self) -> Iterator[InitErrorDetails]:
        n = len(self.root_diameter)
        for key in ("cut_height", "offset", "spacing"):
            listed = getattr(self, key)
            if n > 1 and listed is not None and len(listed) not in (n, 0, 1):
                yield fault(key, found=f"{len(listed)} values", expected=f"{n} values, one for each root")

    def _value_faults(self) -> Iterator[InitErrorDetails]:
        for i, diameter in enumerate(self.root_diameter):
            if diameter <= 0:
                yield fault("root_diameter", i, found=diameter, expected=_POSITIVE)
            elif diameter > _LARGEST:
                remedy = "without a unit it counts in metres: give the unit in the header, root_diameter [mm]"
                expected = f"up to {_LARGEST:g} m"
                yield fault("root_diameter", i, found=diameter, expected=expected, remedy=remedy)
        for i, (height, diameter) in enumerate(zip(self.cut_height, self.root_diameter, strict=False)):
            if height >= diameter > 0:
                expected = f"less than root_diameter, {diameter:.6g} m"
                remedy = "such a deep cut passes below the root"
                yield fault("cut_height", i, found=height, expected=expected, remedy=remedy)
        for i, distance in enumerate((self.spacing or ())[1:], start=1):
            if distance <= 0:
                yield fault("spacing", i, found=distance, expected=_POSITIVE)


# No root is as large as this [m]: its unit is missing.
_LARGEST = 1.0

_POSITIVE = Quantity(LENGTH).expected.replace("a length", "a length greater than 0,")

AnyField = Annotated[RandomField | MeasuredField, Field(discriminator="kind")]


def even_offset(greatest: float) -> UniformScatter:
    """Axes of roots evenly to both sides of the row. ``greatest``: Δ [m]."""
    return UniformScatter(kind="uniform", min=-greatest, max=greatest)


def field_faults(
    field: RandomField | MeasuredField, *, has_cycle: bool, phase: float | None
) -> Iterator[InitErrorDetails]:
    """What is wrong between a field and the knife. ``phase``: phase in which it meets all heads [rad]."""
    if field.spacing is None:
        return
    if phase is not None:
        remedy = "remove it, or motion.phase"
        expected = "nothing, as motion.phase gives all heads one phase"
        yield fault("field", "spacing", found="distances", expected=expected, remedy=remedy)
    if not has_cycle:
        expected = "a stroke of the knife: without it, it has no phase that would follow from the spacing"
        yield fault("motion", "stroke", expected=expected, remedy="or leave out field.spacing")
