"""A force or torque by a formula: ``force = "-200*v - 50*sign(v)"``."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.formula import VARIABLES, names, parse
from linkwright.kernel.description.formula_faults import constant_faults, text_faults, used_names
from linkwright.kernel.units import Angle, AnyQuantity
from linkwright.kinetostatics.model.loads.base import Load, one_of


class FormulaLoad(Load):
    """A force or a torque by a formula in angle, speed, time, position and velocity of what it acts on."""

    kind: Literal["formula"]
    on: str = Field(description="Moving point, slider or link that it acts on.")
    force: str | None = Field(None, description="Formula of a force in N, on a point or a slider.")
    torque: str | None = Field(None, description="Formula of a torque in N m, on a link, counter-clockwise.")
    direction: Angle | None = Field(
        None, description="Direction of the force, from the x axis, or from the link `along`."
    )
    along: str | None = Field(None, description="Link that the force turns with.")
    constants: dict[str, Annotated[float, AnyQuantity()]] = Field(
        default_factory=dict, description="Constants of the formula by name, in any unit."
    )

    @property
    def text(self) -> str:
        """The formula."""
        return self.force if self.force is not None else self.torque or ""

    @property
    def knows_time(self) -> bool:
        """Whether the load changes with time itself."""
        return "t" in names(parse(self.text))

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from one_of(self, "force", "torque")
        yield from constant_faults(self.constants, self.text)
        for key in ("force", "torque"):
            text = getattr(self, key)
            if text is not None:
                yield from text_faults(key, text, self.constants)
        for key in ("direction", "along"):
            if self.torque is not None and getattr(self, key) is not None:
                expected = "nothing: a torque is counter-clockwise"
                yield fault(key, found=getattr(self, key), expected=expected)


def variable_faults(key: str, text: object, known: frozenset[str], on: str) -> Iterator[tuple[str, str, str]]:
    """Variables that what a load acts on does not have.

    `on`: what the load acts on, in words. Returns: key, what is expected, and the remedy.
    """
    used = used_names(text) if isinstance(text, str) else None
    for name, at in (used or {}).items():
        if name in VARIABLES and name not in known:
            remedy = f"{on} has {', '.join(sorted(known))}"
            yield key, f'another variable at character {at}, where "{name}" stands', remedy
