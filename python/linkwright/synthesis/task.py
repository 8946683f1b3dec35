"""Tasks of a synthesis as they stand in a file: what a linkage shall do. All numbers are SI.

Entries with several values are lists or one text with one unit, ``x = "0, 20, 35 mm"``, so that a task of
many points is short.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, Self

from pydantic import Field, ModelWrapValidatorHandler
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, Whole, fault, raise_faults
from linkwright.kernel.description.problems import WholeDescription
from linkwright.kernel.limits import PATH_POINTS, TRIALS
from linkwright.kernel.units.kinds import ANGLE, LENGTH, RATIO
from linkwright.kernel.units.marks import (
    Angle,
    Angles,
    Length,
    Lengths,
    QuantityList,
    Ratio,
    not_negative,
    positive,
)
from linkwright.linkages.model.path_points import PathPoints, same_length, values

PositiveLength = Annotated[float, positive(LENGTH)]
Ratios = Annotated[tuple[float, ...], QuantityList(RATIO)]


class Task(WholeDescription):
    """What all tasks share: a task is checked as a whole, and all its problems are reported."""

    name: str = Field("", description="Purpose of the linkage; name of the machine.")

    @classmethod
    def _checked(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        task = handler(data)
        raise_faults(cls.__name__, task._faults())
        return task

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from ()


class Poses(Description):
    """Poses of a body in their order: its origin and its angle."""

    x: Lengths = Field(description="To the right, one value a pose.")
    y: Lengths = Field(description="Up, one value a pose.")
    angle: Angles = Field(description="Of the body's own x axis, one value a pose.")


class MovingPoint(Description):
    """A point of the body, in the body's own axes."""

    x: Length = Field(description="Along the body's x axis from its origin.")
    y: Length = Field(0.0, description="Along the body's y axis.")
    turn: Angle | None = Field(
        None,
        description="Angle that the link at this point turns through between two poses; signed.",
    )


class FixedPivot(Description):
    """A fixed pivot."""

    x: Length = Field(description="To the right.")
    y: Length = Field(description="Up.")


class PoseTask(Task):
    """Two or three poses of a body that the coupler of a linkage shall pass through."""

    linkage: Literal["four-bar", "slider-crank"] = Field(
        "four-bar", description="What carries the body: crank and rocker, or crank and slider."
    )
    poses: Poses = Field(description="The poses.")
    crank_point: MovingPoint | None = Field(None, description="Point of the body at the crank pin.")
    rocker_point: MovingPoint | None = Field(
        None, description="Point of the body at the rocker; for a four-bar."
    )
    crank_pivot: FixedPivot | None = Field(
        None,
        description="In place of crank_point: fixed pivot of the crank. Three poses then give the crank pin.",
    )
    rocker_pivot: FixedPivot | None = Field(
        None, description="In place of rocker_point: fixed pivot of the rocker, likewise."
    )
    slider_point: MovingPoint | None = Field(
        None,
        description="Point of the body at the slider; for a slider-crank. With three poses the nearest point "
        "that stays on a straight line is taken.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        n = len(self.poses.x)
        if n not in (2, 3):
            yield fault("poses", "x", found=values(n), expected="2 or 3 values, one a pose")
        for key in ("y", "angle"):
            yield from same_length(("poses", key), len(getattr(self.poses, key)), n, "pose")
        yield from self._holder_faults("crank", n)
        if self.linkage == "four-bar":
            yield from self._holder_faults("rocker", n)
            others: tuple[str, ...] = ("slider_point",)
        else:
            others = ("rocker_point", "rocker_pivot")
            if self.slider_point is None:
                yield fault("slider_point", expected="a table; a slider-crank needs it")
        for other in others:
            if getattr(self, other) is not None:
                yield fault(other, found="a table", expected=f"nothing; a {self.linkage} has no such point")
        turning = ("crank_point", "rocker_point")
        for key in (*turning, "slider_point"):
            yield from self._turn_faults(key, needed=n == 2 and key in turning)

    def _holder_faults(self, name: str, poses: int) -> Iterator[InitErrorDetails]:
        point, pivot = f"{name}_point", f"{name}_pivot"
        given = [key for key in (point, pivot) if getattr(self, key) is not None]
        if not given:
            yield fault(point, expected=f"a table, or {pivot}; a {self.linkage} needs one of them")
        elif len(given) == 2:
            remedy = "each follows from the other"
            yield fault(pivot, found="a table", expected=f"nothing beside {point}", remedy=remedy)
        elif given == [pivot] and poses == 2:
            remedy = f"give {point} and the rotation of its link, or a third pose"
            yield fault(pivot, found="a table", expected="three poses: two leave the pin free", remedy=remedy)

    def _turn_faults(self, key: str, *, needed: bool) -> Iterator[InitErrorDetails]:
        point: MovingPoint | None = getattr(self, key)
        if point is None:
            return
        if needed and point.turn is None:
            yield fault(key, "turn", expected='an angle such as "60 deg"; two poses leave it free')
        if needed and point.turn is not None and not 0 < abs(point.turn) < 6.28:
            yield fault(
                key, "turn", found=point.turn, expected="an angle other than 0, less than a revolution"
            )
        if not needed and point.turn is not None:
            yield fault(key, "turn", found=point.turn, expected="nothing; it follows from the poses")


class FunctionTask(Task):
    """A function y(x) that the angle of a rocker shall follow as the crank turns."""

    function: str | None = Field(
        None,
        description='The function, such as "log10(x)", of x, numbers, + − * / ^ and the usual functions.',
    )
    x: Ratios | None = Field(None, description="Arguments at which the function shall be met.")
    y: Ratios | None = Field(None, description="Its values there; instead of `function`.")
    range: Ratios | None = Field(None, description="First and last argument; without it, those of `x`.")
    points: Whole = Field(3, ge=3, le=1000, description="Number of accuracy points, if `x` is not given.")
    spacing: Literal["chebyshev", "even"] = Field("chebyshev", description="Spacing of the points.")
    crank_range: Angle = Field(description="Angle that the crank turns through over the range; signed.")
    rocker_range: Angle = Field(description="Angle that the rocker turns through over the range; signed.")
    crank_start: Angle | None = Field(
        None, description="Crank angle from the frame at the start of the range; without it, it is found."
    )
    rocker_start: Angle | None = Field(
        None, description="Rocker angle from the frame at the start of the range; without it, it is found."
    )
    frame: PositiveLength = Field(1.0, description="Distance of the fixed pivots.")
    transmission_angle_min: Annotated[float, not_negative(ANGLE)] = Field(
        0.0, description="Minimum transmission angle over the range."
    )
    length_ratio_max: Annotated[float, positive(RATIO)] = Field(
        20.0, description="Maximum ratio of longest to shortest link."
    )

    @property
    def unknowns(self) -> int:
        """How many numbers are free: three lengths and the start angles that are not given."""
        return 3 + (self.crank_start is None) + (self.rocker_start is None)

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.function is None) == (self.y is None):
            expected = "the function, or a list y of its values; one of the two"
            yield fault("function", found=self.function, expected=expected)
        if self.y is not None:
            yield from self._table_faults(self.y)
        elif self.x is None and self.range is None:
            yield fault("range", expected='first and last argument, such as "1, 2"')
        if self.range is not None and (len(self.range) != 2 or self.range[0] == self.range[1]):
            yield fault("range", found=str(list(self.range)), expected="two different values")
        for key in ("crank_range", "rocker_range"):
            if not 0 < abs(getattr(self, key)) < 6.28:
                yield fault(
                    key, found=getattr(self, key), expected="an angle other than zero, less than a revolution"
                )
        yield from self._count_faults()

    def _table_faults(self, y: tuple[float, ...]) -> Iterator[InitErrorDetails]:
        if self.x is None:
            yield fault("x", expected="a list of arguments, one for each value of y")
        else:
            yield from same_length(("y",), len(y), len(self.x), "x")

    def _count_faults(self) -> Iterator[InitErrorDetails]:
        n = self.points if self.x is None else len(self.x)
        if n < self.unknowns:
            key = "points" if self.x is None else "x"
            expected = f"at least {self.unknowns} points for {self.unknowns} unknowns"
            remedy = "give crank_start and rocker_start" if n == 3 else "give crank_start or rocker_start"
            yield fault(key, found=values(n), expected=expected, remedy=remedy)


class Box(Description):
    """A rectangle in which something must lie."""

    x: Lengths = Field(description="Left and right end.")
    y: Lengths = Field(description="Lower and upper end.")


class PathTask(PathPoints, Task):
    """Points that a coupler point shall pass in their order while the crank turns round.

    Crank angles count from any zero: the crank is fixed on its shaft as fits best.
    """

    pivots: Box | None = Field(
        None,
        description="Region of the fixed pivots. Default: within four sizes of the path around it.",
    )
    crank_pivot: FixedPivot | None = Field(
        None, description="Fixed pivot of the crank, in place of a region; together with rocker_pivot."
    )
    rocker_pivot: FixedPivot | None = Field(None, description="Fixed pivot of the rocker.")
    linkage: Literal["crank-rocker", "double-crank", "any"] = Field(
        "crank-rocker", description="Type of linkage; its crank always rotates fully."
    )
    transmission_angle_min: Annotated[float, not_negative(ANGLE)] = Field(
        0.0, description="Minimum transmission angle in the revolution."
    )
    length_ratio_max: Annotated[float, positive(RATIO)] = Field(
        20.0, description="Maximum ratio of longest to shortest link."
    )
    length_max: PositiveLength | None = Field(
        None, description="Longest link; without it, four sizes of the path."
    )
    seed: Whole = Field(
        1, ge=0, description="Seed of the random generator; the same seed gives the same linkage."
    )
    population: Whole = Field(240, ge=20, le=100_000, description="Number of starts that are refined.")
    generations: Whole = Field(
        600, ge=1, le=1_000_000, description="Maximum number of steps of the refinement, in its last stage."
    )
    accuracy: Ratio = Field(
        1e-9,
        description="Error over size of the path below which linkages count as exact; of such the one with "
        "the maximum transmission angle is given.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        n = len(self.x)
        yield from self._faults_of_points(3)
        if n * self.population > PATH_POINTS.most:
            found = f"{self.population} linkages at {n} points"
            yield fault("population", found=found, expected=PATH_POINTS.words)
        if self.population * self.generations > TRIALS.most:
            found = f"{self.generations} generations of {self.population} linkages"
            yield fault("generations", found=found, expected=TRIALS.words)
        if len(self.y) == n and n and max(self.x) == min(self.x) and max(self.y) == min(self.y):
            yield fault("x", found="points at one place", expected="points at different places")
        yield from self._pivot_faults()
        for key in ("x", "y") if self.pivots else ():
            ends: tuple[float, ...] = getattr(self.pivots, key)
            if len(ends) != 2 or ends[0] >= ends[1]:
                yield fault(
                    "pivots", key, found=str(list(ends)), expected="two values, the smaller one first"
                )

    def _pivot_faults(self) -> Iterator[InitErrorDetails]:
        crank, rocker = self.crank_pivot, self.rocker_pivot
        if crank is None and rocker is None:
            return
        if crank is None or rocker is None:
            lacking = "crank_pivot" if crank is None else "rocker_pivot"
            yield fault(lacking, expected="the other pivot too, or pivots, a region of both")
        elif (crank.x, crank.y) == (rocker.x, rocker.y):
            yield fault("rocker_pivot", found="the place of crank_pivot", expected="another place")
        if self.pivots is not None:
            yield fault("pivots", found="a table", expected="nothing beside crank_pivot and rocker_pivot")
