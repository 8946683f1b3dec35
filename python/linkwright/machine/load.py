"""Loads: forces and torques of the work, of friction, of weight, of springs.

| kind | on | is |
| --- | --- | --- |
| `dry` | point or link | `force` or `torque` of constant size against the motion |
| `viscous` | point or link | `damping` or `damping_torsional` times the speed, against it |
| `force` | moving point | a force of fixed direction |
| `torque` | link | a torque, counter-clockwise |
| `gravity` | all bodies | their weight |
| `spring` | two points | `stiffness` times the stretch |
| `force_position` | slider | a force against the motion, by position, forward and return |
| `torque_angle` | crankshaft | a resisting torque by crank angle |
| `torque_speed` | crankshaft | a resisting torque by its speed |

The name of a crank means its pin for `force` and `damping`, its link for `torque` and `damping_torsional`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator
from pydantic_core import InitErrorDetails

from linkwright.machine.base import Description, fault, raise_faults, suggestion
from linkwright.machine.curve import curve_faults
from linkwright.machine.outline import Outline, Wanted
from linkwright.machine.plain import keys, look
from linkwright.units import (
    ACCELERATION,
    DAMPING,
    FORCE,
    LENGTH,
    STIFFNESS,
    TORQUE,
    TORSIONAL_DAMPING,
    Angle,
    Angles,
    Force,
    Forces,
    Lengths,
    Speeds,
    Torque,
    Torques,
    not_negative,
)

# A curve over one turn may close exactly; printed degrees and π are rounded.
_ONE_TURN = 2 * math.pi * (1 + 1e-9)


class Load(Description):
    """What all loads have in common."""

    @model_validator(mode="after")
    def _entries_fit(self) -> Self:
        """Report entries that do not go together."""
        raise_faults(type(self).__name__, self._faults())
        return self

    def _faults(self) -> Iterator[InitErrorDetails]:
        """What contradicts itself."""
        return iter(())


class DryFriction(Load):
    """Resistance of constant size that always opposes the motion."""

    kind: Literal["dry"]
    on: str = Field(description="Moving point, slider or link that it acts on.")
    force: Annotated[float, not_negative(FORCE)] | None = Field(None, description="On a point or a slider.")
    torque: Annotated[float, not_negative(TORQUE)] | None = Field(None, description="On a link.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return _one_of(self, "force", "torque")


class ViscousFriction(Load):
    """Resistance in proportion to the speed, against the motion."""

    kind: Literal["viscous"]
    on: str = Field(description="Moving point, slider or link that it acts on.")
    damping: Annotated[float, not_negative(DAMPING)] | None = Field(
        None, description="Force per velocity, on a point or a slider."
    )
    damping_torsional: Annotated[float, not_negative(TORSIONAL_DAMPING)] | None = Field(
        None, description="Torque per angular speed, on a link."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return _one_of(self, "damping", "damping_torsional")


class ConstantForce(Load):
    """A force of constant size and fixed direction."""

    kind: Literal["force"]
    on: str = Field(description="Moving point or slider that it acts on.")
    force: Force = Field(description="Its size.")
    direction: Angle = Field(0.0, description="Its direction, from the x axis.")


class ConstantTorque(Load):
    """A torque of constant size."""

    kind: Literal["torque"]
    on: str = Field(description="Link that it acts on.")
    torque: Torque = Field(description="Counter-clockwise.")


class Gravity(Load):
    """The weight of all bodies."""

    kind: Literal["gravity"]
    acceleration: Annotated[float, not_negative(ACCELERATION)] = Field(
        9.81, description="Acceleration of free fall."
    )
    direction: Angle = Field(-math.pi / 2, description="Where things fall, from the x axis.")


class Spring(Load):
    """A linear spring between two points."""

    kind: Literal["spring"]
    between: tuple[str, str] = Field(description="The two points that it joins.")
    stiffness: Annotated[float, not_negative(STIFFNESS)] = Field(description="Force per stretch.")
    free_length: Annotated[float, not_negative(LENGTH)] = Field(description="Length without any force.")


class ForcePosition(Load):
    """A force on a slider against its motion, which depends on the position and on the way.

    The position counts along the guide from the foot of the point that the guide passes through. Between the
    given points the force is linear, outside them the end values hold.
    """

    kind: Literal["force_position"]
    on: str = Field(description="Slider that it acts on.")
    position: Lengths = Field(description="Positions along the guide, increasing.")
    forward: Forces = Field(description="Force at each position while the slider moves forward.")
    return_: Forces | None = Field(
        None, alias="return", description="Force at each position on the way back. Without it, none."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "position", ("forward", "return_"))


class TorqueAngle(Load):
    """A resisting torque on the crankshaft over one turn, linear between the given angles."""

    kind: Literal["torque_angle"]
    angle: Angles = Field(description="Crank angles, increasing, within one turn.")
    torque: Torques = Field(description="Torque at each angle.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from curve_faults(self, "angle", ("torque",))
        span = self.angle[-1] - self.angle[0] if self.angle else 0.0
        if span > _ONE_TURN:
            yield fault("angle", found=f"{math.degrees(span):.6g} deg", expected="angles within one turn")
        elif span >= 2 * math.pi * (1 - 1e-9) and self.torque and self.torque[0] != self.torque[-1]:
            expected = f"{self.torque[0]:.6g} N m, as at the first angle, one turn before"
            yield fault("torque", len(self.torque) - 1, found=self.torque[-1], expected=expected)


class TorqueSpeed(Load):
    """A resisting torque on the crankshaft by its speed, linear between the given speeds, end values held."""

    kind: Literal["torque_speed"]
    speed: Speeds = Field(description="Speeds of the crankshaft, increasing.")
    torque: Torques = Field(description="Torque at each speed.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        return curve_faults(self, "speed", ("torque",))


AnyLoad = Annotated[
    DryFriction
    | ViscousFriction
    | ConstantForce
    | ConstantTorque
    | Gravity
    | Spring
    | ForcePosition
    | TorqueAngle
    | TorqueSpeed,
    Field(discriminator="kind"),
]


def _one_of(load: Load, for_points: str, for_links: str) -> Iterator[InitErrorDetails]:
    """The fault of a load that has neither or both of two entries."""
    given = [name for name in (for_points, for_links) if getattr(load, name) is not None]
    if len(given) == 2:
        remedy = f"{for_points} acts on a point or a slider, {for_links} on a link"
        yield fault(for_links, found=getattr(load, for_links), expected="only one of the two", remedy=remedy)
    if not given:
        yield fault(expected=f"{for_points} (on a point or a slider) or {for_links} (on a link)")


# Entry of a load → what its carrier must be. A crank is both: its pin and its link.
_ENTRY_WANTS: dict[tuple[str, str], Wanted] = {
    ("dry", "force"): "moving point",
    ("dry", "torque"): "link",
    ("viscous", "damping"): "moving point",
    ("viscous", "damping_torsional"): "link",
    ("force", "force"): "moving point",
    ("torque", "torque"): "link",
}
_BELONGS = {
    ("dry", "moving point"): "force",
    ("dry", "link"): "torque",
    ("viscous", "moving point"): "damping",
    ("viscous", "link"): "damping_torsional",
}


def load_faults(outline: Outline, loads: object) -> Iterator[InitErrorDetails]:
    """What is wrong between the loads and the mechanism.

    Parameters
    ----------
    outline : Outline
        Names of the mechanism.
    loads : object
        The table of loads, checked or raw.

    Yields
    ------
    InitErrorDetails
        Loads on nothing; entries that do not belong to what the load acts on. As in the errors of pydantic,
        the kind of the load stands in the place, before its key.
    """
    for name in keys(loads):
        load = look(loads, name)
        kind, on = look(load, "kind"), look(load, "on")
        if kind == "spring":
            yield from _spring_faults(outline, name, look(load, "between"))
        elif not isinstance(on, str) or not isinstance(kind, str):
            continue
        elif kind == "force_position":
            yield from _slide_faults(outline, name, on)
        else:
            yield from _carrier_faults(outline, name, load, kind, on)


def _spring_faults(outline: Outline, name: str, between: object) -> Iterator[InitErrorDetails]:
    """Springs between points that do not exist, or are the same, or both at rest."""
    ends = [end for end in between if isinstance(end, str)] if isinstance(between, list | tuple) else []
    known = outline.candidates("point")
    for place, end in enumerate(ends):
        if end not in known:
            expected, remedy = "the name of a point", suggestion(end, known)
            yield fault(
                "loads", name, "spring", "between", place, found=end, expected=expected, remedy=remedy
            )
    moving = any(end not in outline.fixed_points for end in ends)
    if len(ends) == 2 and (ends[0] == ends[1] or not moving):
        found = " and ".join(ends)
        yield fault(
            "loads",
            name,
            "spring",
            "between",
            found=found,
            expected="two points, at least one of them moving",
        )


def _slide_faults(outline: Outline, name: str, on: str) -> Iterator[InitErrorDetails]:
    """A force by position on something that has no guide."""
    sliders = outline.names("sliders")
    if on not in sliders:
        remedy = suggestion(on, sliders)
        place = ("loads", name, "force_position", "on")
        yield fault(*place, found=on, expected="the name of a slider", remedy=remedy)


def _carrier_faults(
    outline: Outline, name: str, load: object, kind: str, on: str
) -> Iterator[InitErrorDetails]:
    """A load on nothing, or with an entry that does not belong to its carrier."""
    wants = [(key, want) for (of, key), want in _ENTRY_WANTS.items() if of == kind]
    known = list(dict.fromkeys(each for _, want in wants for each in outline.candidates(want)))
    if wants and on not in known:
        expected = "the name of a " + " or a ".join(dict.fromkeys(want for _, want in wants))
        remedy = outline.instead(on) or suggestion(on, known)
        yield fault("loads", name, kind, "on", found=on, expected=expected, remedy=remedy)
        return
    for key, want in wants:
        value = look(load, key)
        if value is not None and on not in outline.candidates(want):
            other: Wanted = "link" if want == "moving point" else "moving point"
            expected = _BELONGS.get((kind, other), f"the name of a {want}")
            remedy = f'"{on}" is a {other}: {expected} belongs here'
            yield fault("loads", name, kind, key, found=value, expected=expected, remedy=remedy)
