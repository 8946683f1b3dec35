"""A measured surface card in a machine file, by a file of comma-separated values or by lists."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Whole, fault
from linkwright.kernel.description.curve import unread_file
from linkwright.kernel.units.kinds import FORCE, FREQUENCY, LENGTH, TIME
from linkwright.kernel.units.marks import QuantityList, not_negative, positive


class MeasuredCard(CheckedDescription):
    """A surface card that was measured on the well: one stroke at equal steps of time."""

    file: str | None = Field(
        None,
        description='CSV file with the samples, beside the machine file, with a header such as "position '
        '[in], load [lbf]"; a column "time [s]" gives the period.',
    )
    position: Annotated[tuple[float, ...], QuantityList(LENGTH)] = Field(
        description="Positions of the polished rod, upward."
    )
    load: Annotated[tuple[float, ...], QuantityList(FORCE)] = Field(description="Loads of the polished rod.")
    time: Annotated[tuple[float, ...], QuantityList(TIME)] | None = Field(
        None, description="Times of the samples, at equal steps."
    )
    period: Annotated[float, positive(TIME)] | None = Field(
        None, description="Period of the stroke. Default: by the times, or by the speed of the machine."
    )
    damping: Annotated[float, not_negative(FREQUENCY)] | None = Field(
        None, description="Damping c of the rods [1/s]. Default: fitted to the card."
    )
    harmonics: Annotated[Whole, Field(ge=1)] | None = Field(
        None, description="Harmonics of the card that count. Default: those above its noise."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
        for name in ("load", "time"):
            values = getattr(self, name)
            if values is not None and len(values) != len(self.position):
                expected = f"{len(self.position)} values, one for each position"
                yield fault(name, found=f"{len(values)} values", expected=expected)
