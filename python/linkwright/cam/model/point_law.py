"""Laws by formulas and through points, as they are written in a machine file."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

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
from linkwright.kernel.numerics.tangent import primal
from linkwright.kernel.numerics.taylor import Taylor
from linkwright.kernel.units.kinds import LIFT_D1, LIFT_D2, RATIO, SWING_D2
from linkwright.kernel.units.marks import Angles, AnyQuantity, Lengths, QuantityList

if TYPE_CHECKING:
    from linkwright.cam.laws.boundary import Boundary
    from linkwright.cam.laws.motion_law import MotionLaw

# Points from which on, and share of points at which the slope turns, points are noise: of white noise
# three in four turn it, of smooth curves a few.
_NOISE_POINTS, _NOISE_SHARE = 16, 0.4

# Two angles, or two lifts, that differ by less than this share are the same.
_SAME = 1e-9


# Derivatives that a table may have.
_DERIVATIVES = ("velocity", "acceleration")


class PointLaw(Law):
    """A law through points of the section."""

    file: str | None = Field(
        None,
        description="CSV file beside the machine file, instead of the lists; columns angle and lift (or "
        'swing) with units in the header: "angle [deg], lift [mm]". Or a table of a motion controller: '
        "Structured Text of points (CODESYS XYVA, Beckhoff, Siemens, Rockwell), .tab, or pairs of numbers "
        "after their number.",
    )
    angle: Angles = Field((), description="Cam angles from the start to the end of the section, increasing.")
    lift: Lengths | None = Field(None, description="Lift at each angle.")
    swing: Angles | None = Field(
        None, description="Angle of an oscillating follower at each cam angle, instead of the lift."
    )
    columns: str | None = Field(
        None,
        description='Columns of a file without a header, in their order: "angle [deg], lift [mm]".',
    )

    def own_lift(self, angle: float, *, swing: bool) -> float | None:
        values = self._values(swing)
        return values[-1] - values[0] if values else None

    def _values(self, swing: bool) -> tuple[float, ...] | None:
        return self.swing if swing else self.lift

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
        elif self.columns is not None:
            yield fault("columns", found=self.columns, expected="nothing without file")
        elif (self.lift is None) == (self.swing is None):
            found = "both lift and swing" if self.lift else None
            yield fault("lift", found=found, expected="a list of lifts, or of swings")
        elif len(self.angle) > LAW_POINTS.most:
            yield fault("angle", found=f"{len(self.angle)} of them", expected=LAW_POINTS.words)
        else:
            faults = list(curve_faults(self, "angle", ("lift", "swing", *self._further)))
            yield from faults or self._noise_faults()

    # Lists beside the values, of which there are as many.
    _further: ClassVar[tuple[str, ...]] = ()

    def _noise_faults(self) -> Iterator[InitErrorDetails]:
        """Points that a smooth curve cannot go through but by turning at every other one."""
        name = "lift" if self.lift is not None else "swing"
        values = np.array([primal(value) for value in self._values(name == "swing") or ()])
        if self._degree < 3 or len(values) < _NOISE_POINTS:
            return
        slopes = np.diff(values) / np.diff([primal(angle) for angle in self.angle])
        bends = np.diff(slopes)
        # What rounding leaves of a straight line is no noise.
        bends[np.abs(bends) <= _SAME * np.abs(slopes).max(initial=0.0)] = 0.0
        turns = bends[:-1] * bends[1:] < 0
        if turns.mean() > _NOISE_SHARE:
            noisy = f"here the slope turns at {int(turns.sum())} of {len(turns)} points, which is noise"
            expected = f"points of a smooth curve; {noisy}"
            remedy = "smooth the record, take fewer points or more digits, or a table of degree 1"
            place = int(np.flatnonzero(turns)[0]) + 2
            yield fault(name, place, found=float(values[place]), expected=expected, remedy=remedy)

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
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
        return self._through(places, [*ways, task.lift], task, angle, swing=swing)

    def _through(
        self, places: list[float], ways: list[Any], task: Boundary, angle: float, *, swing: bool
    ) -> MotionLaw:
        """The law through points at shares of the section. ``angle``: of the section [rad]."""
        from linkwright.cam.laws.spline import spline

        return spline(places, ways, task, self._degree)

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
        _require_ends(own, task, key, "a formula")
        return own


# Share of the peak velocity by which one at the ends may be off: what rounding leaves of a formula.
_BEGINS = 1e-9


def _require_ends(own: MotionLaw, task: Boundary, key: str, what: str) -> None:
    """Refuse, by a `LawError`, a law that begins or ends with another velocity than its neighbour."""
    peak = abs(own.primal.peak(1).value)
    for z, wanted in ((0.0, task.velocity_start), (1.0, task.velocity_end)):
        has = float(primal(own.value(z, 1, "before" if z else "after")))
        if abs(has - wanted) > _BEGINS * peak:
            found = f"{what} that {'ends' if z else 'begins'} with a velocity of {has:.6g} in its section"
            expected = f"a velocity of {wanted:.6g} at its {'end' if z else 'start'}, as its neighbour has"
            raise LawError(Problem(key, found, expected))


class SplineLaw(PointLaw):
    """The spline through points that begins and ends as its neighbours ask."""

    kind: Literal["spline"]
    degree: Literal[3, 5, 7] = Field(
        5,
        description="Degree of the spline: 3 prescribes the velocity at the ends, 5 also the "
        "acceleration, 7 also the jerk.",
    )


class TableLaw(PointLaw):
    """A table of many points, joined by straight lines, by a cubic spline, or by their derivatives."""

    kind: Literal["table"]
    degree: Literal[1, 3] = Field(
        3,
        description="1: linear interpolation; 3: cubic spline. With derivatives the degree follows from "
        "their number: 3 or 5.",
    )
    velocity: Annotated[tuple[float, ...], QuantityList(LIFT_D1)] | None = Field(
        None, description="First derivative of the lift by the cam angle at each angle."
    )
    acceleration: Annotated[tuple[float, ...], QuantityList(LIFT_D2)] | None = Field(
        None, description="Second derivative of the lift at each angle, beside the first."
    )
    swing_velocity: Annotated[tuple[float, ...], QuantityList(RATIO)] | None = Field(
        None, description="For an oscillating follower: first derivative of its angle at each angle."
    )
    swing_acceleration: Annotated[tuple[float, ...], QuantityList(SWING_D2)] | None = Field(
        None, description="For an oscillating follower: second derivative of its angle."
    )

    _further: ClassVar[tuple[str, ...]] = (*_DERIVATIVES, *(f"swing_{name}" for name in _DERIVATIVES))

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        own, other = ("swing_", "") if self.swing is not None else ("", "swing_")
        given = [getattr(self, own + name) is not None for name in _DERIVATIVES]
        for name, below, is_given, is_below in zip(
            _DERIVATIVES[1:], _DERIVATIVES, given[1:], given, strict=False
        ):
            if is_given and not is_below:
                yield fault(own + below, expected=f"values beside those of {own + name}")
        if any(given) and "degree" in self.model_fields_set:
            yield fault("degree", found=self.degree, expected="nothing beside derivatives, which decide it")
        for name in _DERIVATIVES:
            if getattr(self, other + name) is not None:
                yield fault(other + name, found="a list", expected=f"{own + name}, as the points have")

    def _noise_faults(self) -> Iterator[InitErrorDetails]:
        has_derivatives = any(getattr(self, name) is not None for name in self._further)
        yield from () if has_derivatives else super()._noise_faults()

    def _through(
        self, places: list[float], ways: list[Any], task: Boundary, angle: float, *, swing: bool
    ) -> MotionLaw:
        from linkwright.cam.laws.spline import hermite

        names = [f"swing_{name}" if swing else name for name in _DERIVATIVES]
        lists = [values for name in names if (values := getattr(self, name)) is not None]
        if not lists:
            return super()._through(places, ways, task, angle, swing=swing)
        rows = [[value * angle**order for value in values] for order, values in enumerate(lists, start=1)]
        own = hermite([primal(place) for place in places], [ways, *rows])
        _require_ends(own, task, names[0], "a table")
        return own
