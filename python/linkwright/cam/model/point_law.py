"""Laws by formulas and through points, as they are written in a machine file."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.cam.model.motion_law import Law
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.description.formula import NUMBERS, parse
from linkwright.kernel.description.formula_faults import constant_faults, text_faults
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.limits import LAW_POINTS
from linkwright.kernel.numerics.formula_value import value
from linkwright.kernel.numerics.taylor import Taylor
from linkwright.kernel.units.marks import Angles, AnyQuantity, Lengths

if TYPE_CHECKING:
    from linkwright.cam.laws.boundary import Boundary
    from linkwright.cam.laws.motion_law import MotionLaw

# Two angles, or two lifts, that differ by less than this share are the same.
_SAME = 1e-9


class PointLaw(Law):
    """A law through points of the section."""

    file: str | None = Field(
        None,
        description="CSV file beside the machine file, instead of the lists; columns angle and lift (or "
        'swing) with units in the header: "angle [deg], lift [mm]".',
    )
    angle: Angles = Field((), description="Cam angles from the start to the end of the section, increasing.")
    lift: Lengths | None = Field(None, description="Lift at each angle.")
    swing: Angles | None = Field(
        None, description="Angle of an oscillating follower at each cam angle, instead of the lift."
    )

    def own_lift(self, angle: float, *, swing: bool) -> float | None:
        values = self._values(swing)
        return values[-1] - values[0] if values else None

    def _values(self, swing: bool) -> tuple[float, ...] | None:
        return self.swing if swing else self.lift

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
        elif (self.lift is None) == (self.swing is None):
            found = "both lift and swing" if self.lift else None
            yield fault("lift", found=found, expected="a list of lifts, or of swings")
        elif len(self.angle) > LAW_POINTS.most:
            yield fault("angle", found=f"{len(self.angle)} of them", expected=LAW_POINTS.words)
        else:
            yield from curve_faults(self, "angle", ("lift", "swing"))

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        from linkwright.cam.laws.spline import spline

        values = self._values(swing)
        if values is None:
            expected = "swings, as the follower swings" if swing else "lifts, as it moves along a guide"
            raise LawError(Problem("swing" if swing else "lift", "nothing", expected))
        span, goes = self.angle[-1], values[-1] - values[0]
        if abs(self.angle[0]) > _SAME * angle or abs(span - angle) > _SAME * angle:
            found = f"angles from {self.angle[0]:.10g} to {span:.10g} rad"
            expected = f"angles from 0 to {angle:.10g} rad, that of the section"
            raise LawError(Problem("angle", found, expected))
        if abs(goes - task.lift) > _SAME * max(map(abs, values)):
            found = f"points that rise by {goes:.10g}"
            expected = f"points that rise by the lift of the section, {task.lift:.10g}"
            raise LawError(Problem("swing" if swing else "lift", found, expected))
        places = [0.0, *(angle / span for angle in self.angle[1:-1]), 1.0]
        ways = [value - values[0] for value in values[:-1]]
        return spline(places, [*ways, task.lift], task, self._degree)

    @property
    def _degree(self) -> int:
        degree: int = getattr(self, "degree")  # noqa: B009
        return degree


class FormulaLaw(Law):
    """A lift by a formula over the section."""

    kind: Literal["formula"]
    lift: str | None = Field(
        None,
        description="Lift in m as a formula in z (0 to 1 over the section) and theta (cam angle from its "
        "start, rad); only the change from the start counts.",
    )
    swing: str | None = Field(
        None, description="Angle of an oscillating follower in rad, instead of the lift."
    )
    constants: dict[str, Annotated[float, AnyQuantity()]] = Field(
        default_factory=dict, description="Constants of the formula by name, in any unit."
    )

    def own_lift(self, angle: float, *, swing: bool) -> float | None:
        text = self.swing if swing else self.lift
        if text is None:
            return None
        start, end = self._taylor(text, np.array([0.0, 1.0]), angle)[0]
        # Ends without a value are an infinite lift, which its law refuses in its own words.
        return float(end - start) if np.isfinite([start, end]).all() else math.inf

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.lift is None) == (self.swing is None):
            found = "both lift and swing" if self.lift else None
            yield fault("lift", found=found, expected="a formula of the lift, or of the swing")
            return
        key, text = ("lift", self.lift) if self.lift is not None else ("swing", self.swing or "")
        yield from constant_faults(self.constants, text)
        yield from text_faults(key, text, self.constants, ("z", "theta"))

    def _taylor(self, text: str, z: Floats, angle: float) -> Floats:
        """Value and three derivatives by z at each place, (4, n)."""
        at = Taylor.variable(z)
        names = {**NUMBERS, **self.constants, "z": at, "theta": at * angle}
        with np.errstate(all="ignore"):
            series = value(parse(text), names)
        if not isinstance(series, Taylor):
            series = at * 0.0 + series
        derivatives: Floats = series.derivatives
        return derivatives

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        from linkwright.cam.laws.spline import osculating

        text = self.swing if swing else self.lift
        if text is None:
            expected = "a formula of the swing" if swing else "a formula of the lift"
            raise LawError(Problem("swing" if swing else "lift", "nothing", expected))
        key, rise = "swing" if swing else "lift", self.own_lift(angle, swing=swing) or 0.0
        if abs(rise - task.lift) > _SAME * max(abs(rise), abs(task.lift)):
            found, expected = f"a formula that changes by {rise:.6g}", f"a change by {task.lift:.6g}"
            remedy = f"the section has its own {key}: remove it"
            raise LawError(Problem(key, found, expected, remedy))
        own = osculating(lambda z: self._taylor(text, z, angle), text)
        for word, order, z, wanted in (
            ("velocity", 1, 0.0, task.velocity_start),
            ("velocity", 1, 1.0, task.velocity_end),
        ):
            has = float(own.at(z, order, "before" if z else "after"))
            if abs(has - wanted) > _BEGINS * max(abs(task.lift), abs(has)):
                found = (
                    f"a formula that {'ends' if z else 'begins'} with a {word} of {has:.6g} in its section"
                )
                expected = f"a {word} of {wanted:.6g} at its {'end' if z else 'start'}, as its neighbour has"
                raise LawError(Problem(key, found, expected))
        return own


# Share of the lift by which a velocity at the ends may be off: what rounding leaves of a formula.
_BEGINS = 1e-9


class SplineLaw(PointLaw):
    """The spline through points that begins and ends as its neighbours ask."""

    kind: Literal["spline"]
    degree: Literal[3, 5, 7] = Field(
        5,
        description="Degree of the spline: 3 prescribes the velocity at the ends, 5 also the "
        "acceleration, 7 also the jerk.",
    )


class TableLaw(PointLaw):
    """A table of many points, joined by straight lines or by a cubic spline."""

    kind: Literal["table"]
    degree: Literal[1, 3] = Field(3, description="1: linear interpolation; 3: cubic spline.")
