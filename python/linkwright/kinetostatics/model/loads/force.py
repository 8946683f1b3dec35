"""Loads on a point or a link: forces and torques of constant size, weight, friction, formulas.

A formula is a text: ``force = "-200*v - 50*sign(v)"``.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.description.cycle import ONE_TURN, CycleAngle, cycle_faults, cycle_turns
from linkwright.kernel.description.formula import VARIABLES, names, parse
from linkwright.kernel.description.formula_faults import constant_faults, text_faults, used_names
from linkwright.kernel.units.kinds import ACCELERATION, DAMPING, FORCE, TORQUE, TORSIONAL_DAMPING
from linkwright.kernel.units.marks import Angle, AnyQuantity, Force, Torque, not_negative


class Load(CheckedDescription):
    """What all loads have in common."""


def one_of(load: Load, for_points: str, for_links: str) -> Iterator[InitErrorDetails]:
    """The fault of a load that has neither or both of two entries."""
    given = [name for name in (for_points, for_links) if getattr(load, name) is not None]
    if len(given) == 2:
        remedy = f"{for_points} acts on a point or a slider, {for_links} on a link"
        yield fault(for_links, found=getattr(load, for_links), expected="only one of the two", remedy=remedy)
    if not given:
        yield fault(expected=f"{for_points} (on a point or a slider) or {for_links} (on a link)")


def number_or_curve(load: Load, number: str, argument: str, value: str) -> Iterator[InitErrorDetails]:
    """The fault of a load that is not described by either one number or a curve of two lists."""
    curve = [name for name in (argument, value) if getattr(load, name) is not None]
    if getattr(load, number) is not None and curve:
        yield fault(
            curve[0], found=getattr(load, curve[0]), expected=f"either {number}, or {argument} and {value}"
        )
    elif len(curve) == 1 or (getattr(load, number) is None and not curve):
        yield fault(expected=f"{number}, or a curve by {argument} and {value}")


class ConstantForce(Load):
    """A force of constant size, fixed in direction or turning with a link."""

    kind: Literal["force"]
    on: str = Field(description="Moving point or slider on which it acts.")
    force: Force = Field(description="Magnitude of the force.")
    direction: Angle = Field(
        0.0, description="Direction of the force, measured from the x axis or from the link `along`."
    )
    along: str | None = Field(
        None, description="Link with which the force rotates. Default: its direction is fixed."
    )


class ConstantTorque(Load):
    """A torque of constant size."""

    kind: Literal["torque"]
    on: str = Field(description="Link on which it acts.")
    torque: Torque = Field(description="Torque, positive counter-clockwise.")


class Gravity(Load):
    """The weight of all bodies."""

    kind: Literal["gravity"]
    acceleration: Annotated[float, not_negative(ACCELERATION)] = Field(
        9.81, description="Acceleration of gravity."
    )
    direction: Angle = Field(-math.pi / 2, description="Direction of gravity, from the x axis.")


class DryFriction(Load):
    """Resistance of constant size that always opposes the motion."""

    kind: Literal["dry"]
    on: str = Field(description="Moving point, slider or link on which it acts.")
    force: Annotated[float, not_negative(FORCE)] | None = Field(
        None, description="Friction force on a point or a slider."
    )
    torque: Annotated[float, not_negative(TORQUE)] | None = Field(
        None, description="Friction torque on a link."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return one_of(self, "force", "torque")


class ViscousFriction(Load):
    """Resistance in proportion to the speed, against the motion."""

    kind: Literal["viscous"]
    on: str = Field(description="Moving point, slider or link on which it acts.")
    damping: Annotated[float, not_negative(DAMPING)] | None = Field(
        None, description="Damping coefficient on a point or a slider: force per velocity."
    )
    damping_torsional: Annotated[float, not_negative(TORSIONAL_DAMPING)] | None = Field(
        None, description="Torsional damping coefficient on a link: torque per angular velocity."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return one_of(self, "damping", "damping_torsional")


class FormulaLoad(Load):
    """A force or a torque by a formula in angle, speed, time, position and velocity of what it acts on."""

    kind: Literal["formula"]
    on: str = Field(description="Moving point, slider or link on which it acts.")
    force: str | None = Field(None, description="Formula of a force in N, on a point or a slider.")
    torque: str | None = Field(
        None, description="Formula of a torque in N m, on a link, positive counter-clockwise."
    )
    direction: Angle | None = Field(
        None, description="Direction of the force, from the x axis, or from the link `along`."
    )
    along: str | None = Field(None, description="Link with which the force rotates.")
    constants: dict[str, Annotated[float, AnyQuantity()]] = Field(
        default_factory=dict, description="Constants of the formula by name, in any unit."
    )
    cycle: CycleAngle = Field(
        ONE_TURN,
        description="Period of phi in the formula: phi restarts from 0 after this angle, such as 720 deg.",
    )

    @property
    def turns(self) -> int:
        """Revolutions after which the crank angle of the formula starts again from 0."""
        return cycle_turns(self.cycle)

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
        yield from cycle_faults(self.cycle)
        for key in ("force", "torque"):
            text = getattr(self, key)
            if text is not None:
                yield from text_faults(key, text, self.constants)
        for key in ("direction", "along"):
            if self.torque is not None and getattr(self, key) is not None:
                expected = "nothing: a torque is counter-clockwise"
                yield fault(key, found=getattr(self, key), expected=expected)


def variable_faults(key: str, text: object, known: frozenset[str], on: str) -> Iterator[tuple[str, str, str]]:
    """Variables that the carrier `on` of a load does not have: key, what is expected, and the remedy."""
    used = used_names(text) if isinstance(text, str) else None
    for name, at in (used or {}).items():
        if name in VARIABLES and name not in known:
            remedy = f"{on} has {', '.join(sorted(known))}"
            yield key, f'another variable at character {at}, where "{name}" stands', remedy
