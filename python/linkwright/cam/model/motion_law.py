"""The motion law of a section, as it is written in a machine file: a name, or a table with a `kind`.

| kind | is |
| --- | --- |
| `cycloidal`, `polynomial_3_4_5`, … | a law of the catalogue that has no parameters |
| `modified_trapezoid`, `modified_sine` | with a share of their ramps |
| `polynomial` | by its boundary conditions, of any degree |
| `optimal` | minimum integral of the square of a derivative |
| `combined`, `trapezoidal_velocity`, `s_curve` | ramp, constant velocity, ramp, by shares |
| `limited` | the same by limits of velocity, acceleration and jerk |

`point_law` has those that go through points.

The laws themselves are in `linkwright.cam.laws`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.errors import LawError, Problem
from linkwright.kernel.units.kinds import LIFT_D1, LIFT_D2, LIFT_D3, RATIO, SWING_D2, SWING_D3
from linkwright.kernel.units.marks import Bound, Quantity, not_negative, positive

if TYPE_CHECKING:
    from linkwright.cam.laws.boundary import Boundary
    from linkwright.cam.laws.motion_law import MotionLaw

_TO_QUARTER = Bound(
    " above 0 and up to 0.25,", {"exclusiveMinimum": 0, "maximum": 0.25}, lambda x: 0 < x <= 0.25
)
_UP_TO_HALF = Bound(" of 0 to 0.5,", {"minimum": 0, "maximum": 0.5}, lambda x: 0 <= x <= 0.5)
_TO_HALF = Bound(
    " between 0 and 0.5,", {"exclusiveMinimum": 0, "exclusiveMaximum": 0.5}, lambda x: 0 < x < 0.5
)
Share = Annotated[float, not_negative(RATIO)]

# Polynomials of higher degree than these give are lost in rounding.
Order = Literal[1, 2, 3, 4]
Continuity = Literal[0, 1, 2, 3, 4, 5, 6, 7]


class Law(CheckedDescription):
    """What all laws have in common."""

    def own_lift(self, angle: float, *, swing: bool) -> float | None:
        """The lift that the law says itself [m or rad]. ``angle``: of the section [rad]."""
        return None

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        """The law of a section. ``angle``: of the section [rad]."""
        from linkwright.cam.laws.catalogue import LAWS

        name: str = getattr(self, "kind")  # noqa: B009
        return LAWS[name].section(task, **self._parameters())

    def _parameters(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in type(self).model_fields if name != "kind"}


class PlainLaw(Law):
    """A law of the catalogue that has no parameters."""

    kind: Literal[
        "constant_velocity",
        "parabolic",
        "harmonic",
        "double_harmonic",
        "cycloidal",
        "gutman_1_3",
        "freudenstein_1_3",
        "freudenstein_1_3_5",
        "polynomial_3_4_5",
        "polynomial_4_5_6_7",
        "minimum_acceleration",
        "minimum_jerk",
    ]


class ModifiedTrapezoidLaw(Law):
    """Constant acceleration with ramps of quarter sines."""

    kind: Literal["modified_trapezoid"]
    share: Annotated[float, Quantity(RATIO, _TO_QUARTER)] = Field(
        0.125, description="Share of each of the four ramps in the section."
    )


class ModifiedSineLaw(Law):
    """Slow cosine between two quick quarter sines."""

    kind: Literal["modified_sine"]
    share: Annotated[float, Quantity(RATIO, _TO_HALF)] = Field(
        0.125, description="Share of each of the two quarter sines in the section."
    )


class PolynomialLaw(Law):
    """The polynomial that meets the boundary values."""

    kind: Literal["polynomial"]
    continuity_start: Continuity = Field(
        2,
        description="Order of the highest derivative prescribed at the start; derivatives above the "
        "second are zero.",
    )
    continuity_end: Continuity = Field(2, description="Likewise at the end.")
    powers: tuple[int, ...] | None = Field(
        None, description="Powers of the polynomial, as many as prescribed derivatives. Default: 0, 1, 2, …"
    )

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        from linkwright.cam.laws.boundary import by_conditions

        return by_conditions(task, self.continuity_start, self.continuity_end, self.powers)

    def _faults(self) -> Iterator[InitErrorDetails]:
        powers = self.powers or ()
        wrong = next((i for i, p in enumerate(powers) if p < 0 or p in powers[:i]), None)
        if wrong is not None:
            expected = "another whole number of 0 or more, each once"
            yield fault("powers", wrong, found=powers[wrong], expected=expected)


class OptimalLaw(Law):
    """The law of minimum integral of the square of a derivative."""

    kind: Literal["optimal"]
    order: Literal[1, 2, 3, 4, 5] = Field(
        3, description="Order of the minimised derivative: 2 acceleration, 3 jerk."
    )
    free_start: tuple[Order, ...] = Field(
        (), description="Orders of the derivatives that are free at the start; the others are prescribed."
    )
    free_end: tuple[Order, ...] = Field((), description="Likewise at the end.")


class CombinedLaw(Law):
    """Start, constant velocity, braking, from rest to rest."""

    kind: Literal["combined"]
    start: Share = Field(1 / 6, description="Share of the acceleration phase in the section.")
    stop: Share = Field(1 / 6, description="Share of the deceleration phase in the section.")
    ramp: Literal[
        "optimal_jerk",
        "optimal_jerk_free",
        "parabolic",
        "harmonic",
        "cycloidal",
        "modified_trapezoid",
        "modified_sine",
        "gutman_1_3",
        "freudenstein_1_3",
        "freudenstein_1_3_5",
        "polynomial_3_4_5",
        "polynomial_4_5_6_7",
    ] = Field(
        "optimal_jerk",
        description="Velocity over a ramp: minimum ∫ jerk² over 3/5 of the travel at full velocity, "
        "minimum ∫ jerk² with free travel, or the first half of a law.",
    )


class TrapezoidalVelocityLaw(Law):
    """Constant acceleration, constant velocity, constant deceleration."""

    kind: Literal["trapezoidal_velocity"]
    start: Share = Field(1 / 3, description="Share of the acceleration phase in the section.")
    stop: Share = Field(1 / 3, description="Share of the deceleration phase in the section.")


class SCurveLaw(Law):
    """Trapezoidal velocity with rounded corners."""

    kind: Literal["s_curve"]
    start: Share = Field(1 / 3, description="Share of the acceleration phase in the section.")
    stop: Share = Field(1 / 3, description="Share of the deceleration phase in the section.")
    rounding: Annotated[float, Quantity(RATIO, _UP_TO_HALF)] = Field(
        0.25, description="Share of each of the two rounded corners in its ramp."
    )


class LimitedLaw(Law):
    """Trapezoidal velocity, or with a limit of the jerk an S-curve, within limits per angle of the cam."""

    kind: Literal["limited"]
    velocity_max: Annotated[float, positive(LIFT_D1)] | None = Field(
        None, description="Maximum lift per angle of the cam or master. Default: no limit."
    )
    acceleration_max: Annotated[float, positive(LIFT_D2)] | None = Field(
        None, description="Maximum second derivative."
    )
    jerk_max: Annotated[float, positive(LIFT_D3)] | None = Field(
        None, description="Maximum third derivative. Default: the acceleration jumps."
    )
    swing_velocity_max: Annotated[float, positive(RATIO)] | None = Field(
        None, description="For a swing: maximum angle per angle of the cam or master."
    )
    swing_acceleration_max: Annotated[float, positive(SWING_D2)] | None = Field(
        None, description="Maximum second derivative of its angle."
    )
    swing_jerk_max: Annotated[float, positive(SWING_D3)] | None = Field(
        None, description="Maximum third derivative of its angle."
    )

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        from linkwright.cam.laws.limited import limited_section

        names = [f"swing_{name}" if swing else name for name in _LIMITS]
        velocity, acceleration, jerk = (getattr(self, name) for name in names)
        if acceleration is None:
            expected = "the maximum second derivative by the cam angle"
            raise LawError(Problem(names[1], "nothing", expected))
        return limited_section(task, angle, velocity, acceleration, jerk)


_LIMITS = ("velocity_max", "acceleration_max", "jerk_max")
