r"""A reciprocating engine: throws, banks, rods, gas, and the order in which its cylinders fire.

It stands for a row of discs ``throw_1``, ``throw_2``, … with shafts ``crank_1``, ``crank_2``, … between them;
what the engine drives, flywheel, dampers, is joined to them.

A throw at the angle α behind throw 1, counted in the sense of rotation, points along a cylinder at the angle
β from the vertical when the crank angle is :math:`\varphi = \beta - \alpha`, once per revolution. In which of
the revolutions of a cycle a cylinder fires follows from the order: each fires at its first dead centre after
the one before it, and when the first fires again, just one cycle must have passed.

| kind | is | module |
| --- | --- | --- |
| `table` | measured indicator diagrams | `indicator` |
| `wiebe` | a cycle by Wiebe's function | `combustion` |

Both follow a load map (`gas`) and give a `CyclePressure` for a `Cylinder`; `cylinder` makes harmonics of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, NamedTuple

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.limits import THROWS
from linkwright.kernel.units.kinds import INERTIA, MASS, RATIO
from linkwright.kernel.units.marks import Angles, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.torsion.model.engine.combustion import Combustion
from linkwright.torsion.model.engine.crank_fatigue import CrankFatigue
from linkwright.torsion.model.engine.indicator import Indicator
from linkwright.torsion.model.engine.rod import ArticulatedRod, Rod
from linkwright.torsion.model.engine.throw import CrankThrow
from linkwright.torsion.model.shaft_limit import ShaftLimit
from linkwright.torsion.model.train_base import Damping, LossFactor, PositiveStiffness

# Angles that differ by less are the same within rounding of what was typed [rad].
_EQUAL = 1e-6


class CylinderPlace(NamedTuple):
    """Where a cylinder is."""

    # `throw`, `bank`: counted from 0.
    throw: int
    bank: int
    along: float  # crank angle at which its throw points along it, 0 to 2π [rad]


def cylinder_places(
    throws: Sequence[float], banks: Sequence[float], numbering: str = "by_bank"
) -> list[CylinderPlace]:
    """All cylinders in the order of their numbers. `throws`: [rad]; `banks`: [rad]."""
    if numbering == "by_throw":
        pairs = [(t, b) for t in range(len(throws)) for b in range(len(banks))]
    else:
        pairs = [(t, b) for b in range(len(banks)) for t in range(len(throws))]
    return [CylinderPlace(t, b, _turn(banks[b] - throws[t])) for t, b in pairs]


def firing_angles(
    places: Sequence[CylinderPlace], order: Sequence[int], cycle: float
) -> tuple[list[float], float]:
    """Crank angle at which each cylinder fires, as near as its throw points along it.

    Gives `angles`: by number, of the first in the order 0 to 2π [rad]; `found`: after which the first fires
    again; the order fits if it is the cycle [rad]. `cycle`: crank angle of a working cycle [rad].
    """
    along = [places[number - 1].along for number in order]
    steps = [_turn(after - here) for here, after in zip(along, [*along[1:], along[0]], strict=True)]
    # Where two in a row have their dead centres together, the second fires with the first or turns later.
    together = steps.count(0.0)
    turns = round((cycle - sum(steps)) / (2 * math.pi))
    if turns == 1 and together == len(steps):
        # All fire at once, every revolution.
        steps[-1] = 2 * math.pi
    elif together and turns > 0 and turns % together == 0:
        steps = [step or 2 * math.pi * (turns // together) for step in steps]
    angles, now = [0.0] * len(places), along[0]
    for number, step in zip(order, steps, strict=True):
        angles[number - 1] = now
        now += step
    return angles, sum(steps)


def _turn(angle: float) -> float:
    """An angle from 0 up to a revolution; what is a revolution within rounding is 0."""
    turned = angle % (2 * math.pi)
    return 0.0 if turned < _EQUAL or 2 * math.pi - turned < _EQUAL else turned


AnyGas = Annotated[Indicator | Combustion, Field(discriminator="kind")]


class ReciprocatingEngine(CheckedDescription):
    """An engine with one or more banks of cylinders on one crankshaft."""

    machine: Literal["engine", "compressor"] = Field(
        "engine",
        description="Kind of machine; a compressor is driven, by default at the first disc of [train.discs], "
        "with the mean torque that balances its own.",
    )
    strokes: Literal[2, 4] = Field(4, description="Strokes of a working cycle.")
    bore: PositiveLength = Field(description="Diameter of the cylinders.")
    crank_radius: PositiveLength | None = Field(
        None,
        description="Crank radius: half the stroke of a plain crank mechanism. Default: that of the throw.",
    )
    throws: Angles = Field(
        description="Angle of each throw from the first, in the sense of rotation; the first is 0."
    )
    banks: Angles = Field(
        (0.0,), description="Angle of the cylinders of each bank from the vertical, in the sense of rotation."
    )
    numbering: Literal["by_bank", "by_throw"] = Field(
        "by_bank", description="Numbering of the cylinders: bank after bank, or throw after throw."
    )
    firing_order: tuple[int, ...] = Field(description="Numbers of the cylinders, from 1, in firing order.")
    rods: Literal["side_by_side", "fork_and_blade", "articulated"] = Field(
        "side_by_side",
        description="Arrangement of the rods of several banks on one pin. With articulated rods, the "
        "first bank has the master rod.",
    )
    rod: Rod = Field(description="Connecting rod; with articulated rods, the master rod.")
    articulated: ArticulatedRod | None = Field(
        None, description="Articulated rod of the other banks, pivoted on the master rod."
    )
    piston_mass: Annotated[float, positive(MASS)] = Field(
        description="Mass of piston, pin and rings of one cylinder."
    )
    throw: CrankThrow | None = Field(None, description="Geometry of a throw.")
    throw_inertia: Annotated[float, positive(INERTIA)] | None = Field(
        None,
        description="Moment of inertia of the rotating parts of one throw, without rods. Default: from "
        "the throw.",
    )
    stiffness: PositiveStiffness | None = Field(
        None,
        description="Torsional stiffness from throw to throw, measured or computed. Default: by a formula.",
    )
    stiffness_formula: Literal["constrained", "free", "carter", "ker_wilson", "zimanenko"] = Field(
        "constrained", description="Formula for the stiffness of the throw."
    )
    damping: Damping = Field(0.0, description="Viscous damping of each throw against the frame.")
    loss_factor: LossFactor = Field(0.0, description="Loss factor of the crankshaft.")
    limit: ShaftLimit | None = Field(
        None,
        description="Permitted stresses of the crankshaft; without a diameter, at the crank pin.",
    )
    fatigue: CrankFatigue | None = Field(
        None, description="Fillets, oil bores and steel, for the fatigue of the crankshaft by IACS UR M53."
    )
    gas: AnyGas = Field(description="Gas pressure in the cylinders.")
    factors: dict[str, Annotated[float, not_negative(RATIO)]] = Field(
        default_factory=dict,
        description="Combustion factor of faulty cylinders, by number; 0 for a misfire.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from self._angle_faults()
        yield from self._part_faults()
        yield from self._limit_fault()
        yield from self._fatigue_fault()
        if self.n_cylinders:
            yield from self._number_faults()
        for wrong in self.gas.cycle_faults(self.strokes):
            yield InitErrorDetails(
                type=wrong["type"], loc=("gas", *wrong.get("loc", ())), input=wrong["input"]
            )

    def _number_faults(self) -> Iterator[InitErrorDetails]:
        wrong = [*self._order_faults()]
        yield from wrong
        if not wrong:
            yield from self._cycle_fault()
        for number in self.factors:
            if number not in map(str, range(1, self.n_cylinders + 1)):
                yield fault("factors", number, found=number, expected=self._numbers())

    def _angle_faults(self) -> Iterator[InitErrorDetails]:
        if not self.throws:
            yield fault("throws", found="an empty list", expected="an angle for each throw")
        elif len(self.throws) > THROWS.most:
            yield fault("throws", found=f"{len(self.throws)} of them", expected=THROWS.words)
        elif self.throws[0] != 0.0:
            yield fault("throws", 0, found=self.throws[0], expected="0, from which the others are counted")
        if not self.banks:
            yield fault("banks", found="an empty list", expected="an angle for each bank of cylinders")
        for name, angles in (("throws", self.throws), ("banks", self.banks)):
            for n, angle in enumerate(angles):
                if abs(angle) > 2 * math.pi + _EQUAL:
                    remedy = f'a number without unit is radians; give degrees as "{angle:.6g} deg"'
                    yield fault(name, n, found=angle, expected="an angle up to a revolution", remedy=remedy)

    def _part_faults(self) -> Iterator[InitErrorDetails]:
        if self.rods == "articulated" and self.articulated is None:
            expected = "the table of the rods that turn on the master rods"
            yield fault("articulated", expected=expected, remedy='or give other rods than "articulated"')
        elif self.rods != "articulated" and self.articulated is not None:
            expected = f'no such table for rods = "{self.rods}"'
            remedy = 'make it rods = "articulated", or leave the table out'
            yield fault("articulated", found="a table", expected=expected, remedy=remedy)
        if self.rods == "articulated" and len(self.banks) < 2:
            yield fault("banks", found=f"{len(self.banks)} bank", expected="at least 2 for articulated rods")
        if self.throw is None:
            for name, what in (
                ("crank_radius", "the radius"),
                ("throw_inertia", "the inertia"),
                ("stiffness", "the stiffness"),
            ):
                if getattr(self, name) is None and (name != "stiffness" or len(self.throws) > 1):
                    yield fault(name, expected=f"{what} of the throws, or [train.engine.throw]")
        elif self.crank_radius is not None and abs(self.crank_radius / self.throw.radius - 1) > 1e-9:
            expected = f"the radius of the throw, {self.throw.radius:.6g} m"
            yield fault(
                "crank_radius", found=self.crank_radius, expected=expected, remedy="give one of the two"
            )

    def _fatigue_fault(self) -> Iterator[InitErrorDetails]:
        if self.fatigue is None:
            return
        if self.throw is None:
            expected = "the geometry of a throw, [train.engine.throw]"
            yield fault("fatigue", found="a table", expected=expected)
        if self.rods == "articulated":
            expected = 'rods = "side_by_side" or "fork_and_blade": IACS UR M53 has no articulated rods'
            yield fault("fatigue", found="a table", expected=expected)

    def _limit_fault(self) -> Iterator[InitErrorDetails]:
        limit = self.crank_limit
        if limit is not None and limit.needs_section and not limit.has_section:
            expected = "the diameter where the stress counts, or [train.engine.throw] with its pin"
            yield fault("limit", "diameter", expected=expected)

    def _order_faults(self) -> Iterator[InitErrorDetails]:
        numbers, seen = range(1, self.n_cylinders + 1), set()
        for n, number in enumerate(self.firing_order):
            if number not in numbers:
                yield fault("firing_order", n, found=number, expected=self._numbers())
            elif number in seen:
                yield fault("firing_order", n, found=number, expected="each cylinder once")
            seen.add(number)
        missing = [str(number) for number in numbers if number not in seen]
        if missing:
            listed = ", ".join(missing)
            yield fault("firing_order", found=f"an order without {listed}", expected="each cylinder once")

    def _cycle_fault(self) -> Iterator[InitErrorDetails]:
        angle, wanted = firing_angles(self.places, self.firing_order, self.cycle)[1], self.cycle
        if abs(angle - wanted) > _EQUAL:
            yield fault(
                "firing_order",
                found=f"an order that repeats after {angle / (2 * math.pi):.6g} revolutions",
                expected=f"one of {wanted / (2 * math.pi):.6g}, a cycle of {self.strokes} strokes",
                remedy="look at the angles of throws and banks, the sense of rotation, and the numbering",
            )

    def _numbers(self) -> str:
        return f"the number of a cylinder, 1 to {self.n_cylinders}"

    @property
    def n_cylinders(self) -> int:
        """How many cylinders it has."""
        return len(self.throws) * len(self.banks)

    @property
    def cycle(self) -> float:
        """Crank angle of a working cycle [rad]."""
        return math.pi * self.strokes

    @property
    def places(self) -> list[CylinderPlace]:
        """Throw and bank of each cylinder, by number."""
        return cylinder_places(self.throws, self.banks, self.numbering)

    @property
    def radius(self) -> float:
        """Of the crank [m]."""
        if self.crank_radius is not None:
            return self.crank_radius
        assert self.throw is not None
        return self.throw.radius

    @property
    def crank_limit(self) -> ShaftLimit | None:
        """What the crankshaft bears, with the section of its pin where it has none of its own."""
        limit, throw = self.limit, self.throw
        if throw is None or (limit is not None and (limit.diameter or limit.section_modulus)):
            return limit
        pin = {"diameter": throw.pin.diameter, "inner_diameter": throw.pin.inner_diameter}
        return (limit or ShaftLimit()).model_copy(update=pin)

    def factor(self, number: int) -> float:
        """Share of the combustion in a cylinder, 1 if it is sound."""
        return self.factors.get(str(number), 1.0)
