"""The motion law of a section, as it is written in a machine file: a name, or a table with a `kind`.

| kind | is |
| --- | --- |
| `cycloidal`, `polynomial_3_4_5`, … | a law of the catalogue that has no parameters |
| `modified_trapezoid`, `modified_sine` | with a share of their ramps |
| `polynomial` | by its boundary conditions, of any degree |

The laws themselves are in `linkwright.motion_laws`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import InitErrorDetails

from linkwright.machine.base import Checked, fault
from linkwright.units import RATIO, Bound, Quantity

if TYPE_CHECKING:
    from linkwright.motion_laws.boundary import Boundary
    from linkwright.motion_laws.motion_law import MotionLaw

_TO_QUARTER = Bound(
    " above 0 and up to 0.25,", {"exclusiveMinimum": 0, "maximum": 0.25}, lambda x: 0 < x <= 0.25
)
_TO_HALF = Bound(
    " between 0 and 0.5,", {"exclusiveMinimum": 0, "exclusiveMaximum": 0.5}, lambda x: 0 < x < 0.5
)
# Polynomials of higher degree than these give are lost in rounding.
Continuity = Literal[0, 1, 2, 3, 4, 5, 6, 7]


class Law(Checked):
    """What all laws have in common."""

    @property
    def carries_lift(self) -> bool:
        """Whether the law itself says how far the section goes."""
        return False

    def own_lift(self, angle: float, *, swing: bool) -> float | None:
        """The lift that the law says itself [m or rad].

        Parameters
        ----------
        angle : float
            Of the section [rad].
        swing : bool
            Whether the follower swings.
        """
        return None

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        """The law of a section.

        Parameters
        ----------
        task : Boundary
            What the section has to do.
        angle : float
            Of the section [rad].
        swing : bool
            Whether the follower swings.

        Returns
        -------
        MotionLaw
            x(z) from 0 to 1, beginning with 0.

        Raises
        ------
        LawError
            The law cannot meet these boundary values.
        """
        from linkwright.motion_laws.catalogue import LAWS

        return LAWS[getattr(self, "kind")].over(task, **self._parameters())  # noqa: B009

    def _parameters(self) -> dict[str, Any]:
        """The parameters of the law by name."""
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
    ]


class ModifiedTrapezoidLaw(Law):
    """Constant acceleration with ramps of quarter sines."""

    kind: Literal["modified_trapezoid"]
    share: Annotated[float, Quantity(RATIO, _TO_QUARTER)] = Field(
        0.125, description="Of each of the four ramps in the section."
    )


class ModifiedSineLaw(Law):
    """Slow cosine between two quick quarter sines."""

    kind: Literal["modified_sine"]
    share: Annotated[float, Quantity(RATIO, _TO_HALF)] = Field(
        0.125, description="Of each of the two quarter sines in the section."
    )


class PolynomialLaw(Law):
    """The polynomial that meets the boundary values."""

    kind: Literal["polynomial"]
    continuity_start: Continuity = Field(
        2, description="Order of the highest derivative set at the start; those above the second are zero."
    )
    continuity_end: Continuity = Field(2, description="The same at the end.")
    powers: tuple[int, ...] | None = Field(
        None, description="Powers to be used, as many as derivatives are set. Without them, 0, 1, 2, …"
    )

    def over(self, task: Boundary, angle: float, *, swing: bool) -> MotionLaw:
        from linkwright.motion_laws.shapes import by_conditions

        return by_conditions(task, self.continuity_start, self.continuity_end, self.powers)

    def _faults(self) -> Iterator[InitErrorDetails]:
        powers = self.powers or ()
        wrong = next((i for i, p in enumerate(powers) if p < 0 or p in powers[:i]), None)
        if wrong is not None:
            expected = "another whole number of 0 or more, each once"
            yield fault("powers", wrong, found=powers[wrong], expected=expected)


def _as_table(value: object) -> object:
    """The table that a bare name stands for."""
    return {"kind": value} if isinstance(value, str) else value


AnyLaw = Annotated[
    Annotated[PlainLaw | ModifiedTrapezoidLaw | ModifiedSineLaw | PolynomialLaw, Field(discriminator="kind")],
    BeforeValidator(_as_table, json_schema_input_type=str | dict[str, Any]),
]
