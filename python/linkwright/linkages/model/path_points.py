"""Points of a path in their order, with crank angles or without. All numbers are SI."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, fault
from linkwright.kernel.units.marks import Angles, Lengths


class PathPoints(Description):
    """Points that a point of the mechanism shall pass in their order while the crank turns."""

    x: Lengths = Field(description="x coordinates, one value per point.")
    y: Lengths = Field(description="y coordinates, one value per point.")
    crank_angle: Angles | None = Field(
        None,
        description="Crank angle at each point. Default: free timing.",
    )

    def _faults_of_points(self, least: int) -> Iterator[InitErrorDetails]:
        """Fewer points than `least`, and lists that have not one value for each."""
        n = len(self.x)
        if n < least:
            yield fault("x", found=values(n), expected=f"at least {values(least)}, one a point")
        yield from same_length(("y",), len(self.y), n, "point")
        if self.crank_angle is not None:
            yield from same_length(("crank_angle",), len(self.crank_angle), n, "point")


def same_length(place: tuple[str, ...], length: int, wanted: int, what: str) -> Iterator[InitErrorDetails]:
    """The fault of a list that has not one value for each of something."""
    if length != wanted:
        yield fault(*place, found=values(length), expected=f"{values(wanted)}, one a {what}")


def values(n: int) -> str:
    """A number of values in words."""
    return "1 value" if n == 1 else f"{n} values"
