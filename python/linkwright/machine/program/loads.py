"""Bodies and loads of a machine in the core's terms."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from linkwright import _core
from linkwright.kernel.description import formula
from linkwright.kernel.description.cycle import ONE_TURN, cycle_turns
from linkwright.kernel.description.place import arrays, join
from linkwright.kernel.errors import ShapeError
from linkwright.kernel.numerics.tangent import primal
from linkwright.kinetostatics.model import loads
from linkwright.kinetostatics.model.body import Body
from linkwright.machine.machine import Machine
from linkwright.machine.program.mechanism import MechanismProgram


def bodies_of(machine: Machine, program: MechanismProgram) -> list[_core.Body]:
    """Masses on links and on points."""
    lengths = {name: link.length for name, link in program.links_of.items()}
    return [
        _body(program, body.on or name, body, lengths.get(body.on or name))
        for name, body in machine.bodies.items()
    ]


def _body(program: MechanismProgram, carrier: str, body: Body, length: Any) -> _core.Body:
    if carrier not in program.links:
        return _core.Body.Point(point=program.points[carrier], mass=program.slot(body.mass))
    along, across, mass, inertia = link_body(body, length)
    return _core.Body.Link(
        link=program.links[carrier],
        origin=program.starts[carrier],
        along=program.slot(along),
        across=program.slot(across),
        mass=program.slot(mass),
        inertia=program.slot(inertia),
    )


def table_of(machine: Machine, program: MechanismProgram, x: Sequence[Any], y: Sequence[Any]) -> _core.Table:
    """A table of the description. Raises ShapeError: they vary from machine to machine."""
    if any(np.ndim(value) for value in (*x, *y)):
        points = ", ".join(join(place) for place, _ in arrays(machine) if place[-1].isdecimal())
        raise ShapeError(
            f"{points}: the points of a table cannot vary from machine to machine in a batch; "
            "compute machines with others one by one"
        )
    return program.table(x, y)


class Loads:
    """Makes the loads of a machine: where each acts, and what it is.

    Parameters
    ----------
    machine : Machine
        Its description.
    program : MechanismProgram
        The mechanism; takes the numbers.
    """

    def __init__(self, machine: Machine, program: MechanismProgram) -> None:
        self.machine, self.program = machine, program
        self.points, self.links, self.slides = program.points, program.links, program.slides
        self.slot = program.slot

    def all(self, *, brake: bool) -> list[tuple[_core.At, _core.What]]:
        """Forces and torques; a brake resists on the crankshaft."""
        parts = [part for load in self.machine.all_loads.values() for part in self._parts(load)]
        drive = self.machine.drive
        if brake and drive and drive.brake:
            ratio = drive.gearbox.ratio if drive.brake.on == "motor" else 1.0
            parts.append((_core.At.Crank(), _core.What.Dry(size=self.slot(drive.brake.torque * ratio))))
        return parts

    def _parts(self, load: Any) -> Iterator[tuple[_core.At, _core.What]]:
        """A load by a formula is one for each summand, so that each enters the motion in its own way."""
        if isinstance(load, loads.TorqueSwing):
            for piece in swing_formulas(load):
                yield from self._parts(piece)
        elif isinstance(load, loads.FormulaLoad):
            at, turns = self._at(load), whole_turns(load)
            constants = {name: self.slot(value) for name, value in load.constants.items()}
            for term in formula.terms(formula.parse(load.text)):
                yield at, _core.What.Formula(formula=self.program.formula(term, constants), turns=turns)
        else:
            yield self._at(load), self._what(load)

    def _at(self, load: Any) -> _core.At:
        """Where a load acts."""
        match load:
            case loads.Gravity():
                return _core.At.Bodies(**self._direction(load.direction))
            case loads.TorqueAngle() | loads.TorqueSpeed():
                return _core.At.Crank()
            case loads.BetweenPoints():
                start, end = (self.points[end] for end in load.between)
                return _core.At.Between(start=start, end=end)
            case loads.TorsionalSpring() | loads.TorsionalDamper():
                other = None if load.against is None else self.links[load.against]
                free = self._direction(getattr(load, "free_angle", 0.0))
                return _core.At.BetweenLinks(link=self.links[load.on], other=other, **free)
            case (
                loads.ConstantTorque()
                | loads.DryFriction(force=None)
                | loads.ViscousFriction(damping=None)
                | loads.FormulaLoad(force=None)
            ):
                return _core.At.Link(link=self.links[load.on])
        along, direction = getattr(load, "along", None), getattr(load, "direction", None)
        # A cylinder, on which friction acts, slides without a point of its own; only formulas read the point.
        point = self.points.get(load.on, 0) if load.on in self.slides else self.points[load.on]
        if along is not None:
            towards = self._direction(0.0 if direction is None else direction)
            return _core.At.Along(point=point, link=self.links[along], **towards)
        if direction is not None:
            return _core.At.Toward(point=point, **self._direction(direction))
        if load.on in self.slides:
            return _core.At.Slide(slide=self.slides[load.on], point=point)
        return _core.At.Point(point=point)

    def _what(self, load: Any) -> _core.What:
        """What a load is."""
        match load:
            case loads.ConstantForce(force=size) | loads.ConstantTorque(torque=size):
                return _core.What.Constant(size=self.slot(size))
            case loads.Gravity():
                return _core.What.Constant(size=self.slot(load.acceleration))
            case loads.DryFriction():
                return _core.What.Dry(size=self.slot(load.torque if load.force is None else load.force))
            case loads.Damper(velocity=tuple() as velocity, force=tuple() as force):
                return _core.What.OverSpeed(table=self._table(velocity, force))
            case loads.ViscousFriction(damping=None) | loads.TorsionalDamper():
                return _core.What.Viscous(damping=self.slot(load.damping_torsional))
            case loads.ViscousFriction() | loads.Damper():
                return _core.What.Viscous(damping=self.slot(load.damping))
            case loads.Spring(length=tuple() as length, force=tuple() as force):
                return _core.What.Curve(table=self._table(length, force))
            case loads.Spring() | loads.TorsionalSpring():
                free_length, preload = getattr(load, "free_length", 0.0), getattr(load, "preload", 0.0)
                return _core.What.Spring(
                    stiffness=self.slot(load.stiffness),
                    free_length=self.slot(free_length),
                    preload=self.slot(preload),
                )
            case loads.GasSpring():
                return _core.What.Gas(
                    force=self.slot(load.force_extended),
                    length=self.slot(load.length_extended),
                    column=self.slot(gas_column(load)),
                    exponent=self.slot(load.exponent),
                )
            case loads.ForcePosition():
                forward = self._table(load.position, load.forward)
                back = self._table(load.position, load.return_ or (0.0,) * len(load.position))
                return _core.What.Resistance(forward=forward, back=back)
            case loads.TorqueAngle():
                angle, torque = load.points(load.torque)
                table = self._table(angle, [-against for against in torque])
                return _core.What.OverAngle(table=table, turns=whole_turns(load))
            case loads.ForceAngle():
                table = self._table(*load.points(load.force))
                return _core.What.OverAngle(table=table, turns=whole_turns(load))
            case loads.TorqueSpeed():
                return _core.What.OverSpeed(table=self._table(load.speed, load.torque))
        raise TypeError(f"no translation for {type(load).__name__}")

    def _table(self, x: Sequence[Any], y: Sequence[Any]) -> _core.Table:
        return table_of(self.machine, self.program, x, y)

    def _direction(self, direction: Any) -> dict[str, int]:
        return {"cos": self.slot(np.cos(direction)), "sin": self.slot(np.sin(direction))}


def swing_formulas(load: loads.TorqueSwing) -> Iterator[loads.FormulaLoad]:
    """A torque over the angle of a link as loads by formulas."""
    for text, constants in load.as_formulas():
        yield loads.FormulaLoad.model_construct(
            kind="formula",
            on=load.on,
            force=None,
            torque=text,
            direction=None,
            along=None,
            constants=constants,
            cycle=ONE_TURN,
        )


def link_body(body: Body, length: Any) -> tuple[Any, Any, Any, Any]:
    """Place of the centre of mass along and across the link [m], mass [kg], inertia about it [kg m²].

    Without a place the centre is in the middle; without an inertia the body is a uniform slender rod,
    m l²/12.
    """
    mass = 0.0 if body.mass is None else body.mass
    if body.mass_per_length is not None:
        mass = body.mass_per_length * length
    along = 0.5 * length if body.along is None else body.along
    inertia = mass * length**2 / 12 if body.inertia is None else body.inertia
    return along, body.across, mass, inertia


def gas_column(spring: loads.GasSpring) -> Any:
    """Length of the gas of a gas spring at its extended length [m]: volume over the area of the rod.

    The law F = F₁ (h/(h − way))ⁿ goes through the push at the compressed length, F₁·progression.
    """
    way = spring.length_extended - spring.length_compressed
    root = spring.progression ** (1.0 / spring.exponent)
    return way * root / (root - 1.0)


def whole_turns(load: loads.OverCrankAngle | loads.FormulaLoad) -> int:
    """Revolutions after which a load repeats. Raises ShapeError: they vary from machine to machine."""
    if np.ndim(load.cycle):
        raise ShapeError(
            "cycle: the revolutions after which a load repeats cannot vary from machine to machine in a "
            "batch; compute machines with others one by one"
        )
    return cycle_turns(float(primal(load.cycle)))
