"""Torques on a shaft by its angle: constant, a table, a formula."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.curve import curve_faults, unread_file
from linkwright.kernel.description.formula import NUMBERS, parse
from linkwright.kernel.description.formula_faults import constant_faults, text_faults
from linkwright.kernel.numerics.formula_value import value
from linkwright.kernel.units import Angles, AnyQuantity, Torque, Torques

Floats = NDArray[np.float64]

# A table over the whole cycle may close exactly; printed degrees and π are rounded.
_ROUNDED = 1e-9


class ShaftTorque(CheckedDescription):
    """A torque on the shaft, positive against what it stands for: drive or resistance."""

    @abstractmethod
    def at(self, phi: Floats, cycle: float) -> Floats:
        """Torque at shaft angles within the cycle, shape (n,) [N m]."""

    def kinks(self, cycle: float) -> Floats:
        """Angles within the cycle at which it has a corner or a jump [rad]."""
        return np.empty(0)

    def cycle_faults(self, cycle: float) -> Iterator[InitErrorDetails]:
        """What does not fit a cycle of this length [rad]."""
        return iter(())


class ConstantShaftTorque(ShaftTorque):
    """The same torque at every angle."""

    kind: Literal["constant"]
    torque: Torque = Field(description="Torque.")

    def at(self, phi: Floats, cycle: float) -> Floats:
        return np.full(len(phi), self.torque)


class FormulaShaftTorque(ShaftTorque):
    """A torque by a formula of the angle."""

    kind: Literal["formula"]
    torque: str = Field(description="Formula of the torque in N m; its variable is phi, the shaft angle.")
    constants: dict[str, Annotated[float, AnyQuantity()]] = Field(
        default_factory=dict, description="Numbers of the formula by name, in any unit; they count in SI."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from constant_faults(self.constants, self.torque)
        yield from text_faults("torque", self.torque, self.constants, ("phi",))

    def at(self, phi: Floats, cycle: float) -> Floats:
        # Where a formula has no value the fit says so, with the angle.
        with np.errstate(all="ignore"):
            found = value(parse(self.torque), {**NUMBERS, **self.constants, "phi": phi})
        torque: Floats = np.broadcast_to(np.asarray(found, dtype=float), phi.shape)
        return torque


class TableShaftTorque(ShaftTorque):
    """A torque by points of a diagram: linear between them, or in steps."""

    kind: Literal["table"]
    file: str | None = Field(
        None,
        description="File of comma-separated values beside the machine file, in place of the lists, with "
        'units in its head: "angle [deg], torque [N m]".',
    )
    angle: Angles = Field((), description="Shaft angles, increasing, within one cycle.")
    torque: Torques = Field((), description="Torque at each angle.")
    between: Literal["linear", "steps"] = Field(
        "linear",
        description="What holds between two angles: a straight line, or the torque of the first of them.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.file is not None:
            yield unread_file(self.file)
            return
        yield from curve_faults(self, "angle", ("torque",))

    def cycle_faults(self, cycle: float) -> Iterator[InitErrorDetails]:
        span = self.angle[-1] - self.angle[0]
        if span > cycle * (1 + _ROUNDED):
            remedy = "set turning_moment.cycle to 720 deg if a cycle takes two revolutions"
            found = f"{math.degrees(span):.6g} deg"
            yield fault("angle", found=found, expected="angles within one cycle", remedy=remedy)
        elif self._closes(cycle) and self.torque[0] != self.torque[-1] and self.between == "linear":
            expected = f"{self.torque[0]:.6g} N m, as at the first angle, one cycle before"
            yield fault("torque", len(self.torque) - 1, found=self.torque[-1], expected=expected)

    def _closes(self, cycle: float) -> bool:
        return self.angle[-1] - self.angle[0] >= cycle * (1 - _ROUNDED)

    def kinks(self, cycle: float) -> Floats:
        corners: Floats = np.mod(np.asarray(self.angle), cycle)
        return corners

    def at(self, phi: Floats, cycle: float) -> Floats:
        angle, torque = np.asarray(self.angle), np.asarray(self.torque)
        if self._closes(cycle):
            angle, torque = angle[:-1], torque[:-1]
        from_first = np.mod(phi - angle[0], cycle)
        if self.between == "steps":
            held: Floats = torque[np.searchsorted(angle - angle[0], from_first, side="right") - 1]
            return held
        straight: Floats = np.interp(from_first, angle - angle[0], torque, period=cycle)
        return straight


AnyShaftTorque = Annotated[
    ConstantShaftTorque | FormulaShaftTorque | TableShaftTorque, Field(discriminator="kind")
]
