"""Bodies and loads of a machine in the core's terms."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
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
    """Makes the loads of a machine.

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

    def all(self, *, brake: bool) -> list[_core.Load]:
        """Forces and torques; a brake resists on the crankshaft."""
        parts: list[_core.Load] = []
        for load in self.machine.all_loads.values():
            if isinstance(load, loads.FormulaLoad):
                parts += self._formula_load(load)
            elif isinstance(load, loads.TorqueSwing):
                parts += [term for piece in swing_formulas(load) for term in self._formula_load(piece)]
            else:
                parts.append(self._load(load))
        drive = self.machine.drive
        if brake and drive and drive.brake:
            ratio = drive.gearbox.ratio if drive.brake.on == "motor" else 1.0
            parts.append(_core.Load.DryCrank(torque=self.slot(drive.brake.torque * ratio)))
        return parts

    def _table(self, x: Sequence[Any], y: Sequence[Any]) -> _core.Table:
        return table_of(self.machine, self.program, x, y)

    def _load(self, load: Any) -> _core.Load:
        match load:
            case loads.DryFriction():
                return self._dry(load)
            case loads.ViscousFriction():
                return self._viscous(load)
            case loads.ConstantForce():
                return self._force(load)
            case loads.ConstantTorque():
                return _core.Load.Torque(link=self.links[load.on], torque=self.slot(load.torque))
            case loads.Gravity():
                x, y = self._vector(load.acceleration, load.direction)
                return _core.Load.Gravity(x=x, y=y)
            case loads.Spring() | loads.Damper() | loads.GasSpring():
                return self._between(load, *(self.points[end] for end in load.between))
            case loads.TorsionalSpring() | loads.TorsionalDamper():
                return self._between_links(load)
            case loads.ForcePosition():
                forward = self._table(load.position, load.forward)
                back = self._table(load.position, load.return_ or (0.0,) * len(load.position))
                return _core.Load.ForcePosition(slide=self.slides[load.on], forward=forward, back=back)
            case loads.TorqueAngle():
                return _core.Load.TorqueAngle(
                    table=self._table(*load.points(load.torque)), turns=whole_turns(load)
                )
            case loads.ForceAngle():
                return _core.Load.ForceAngle(
                    slide=self.slides[load.on],
                    table=self._table(*load.points(load.force)),
                    turns=whole_turns(load),
                )
            case loads.TorqueSpeed():
                return _core.Load.TorqueSpeed(table=self._table(load.speed, load.torque))
        raise TypeError(f"no translation for {type(load).__name__}")

    def _dry(self, load: loads.DryFriction) -> _core.Load:
        """A constant resistance on a link, a slide or a point."""
        if load.torque is not None:
            return _core.Load.DryLink(link=self.links[load.on], torque=self.slot(load.torque))
        if load.on in self.slides:
            return _core.Load.DrySlide(slide=self.slides[load.on], force=self.slot(load.force))
        return _core.Load.DryPoint(point=self.points[load.on], force=self.slot(load.force))

    def _viscous(self, load: loads.ViscousFriction) -> _core.Load:
        """A resistance in proportion to speed on a link, a slide or a point."""
        if load.damping_torsional is not None:
            return _core.Load.ViscousLink(link=self.links[load.on], damping=self.slot(load.damping_torsional))
        if load.on in self.slides:
            return _core.Load.ViscousSlide(slide=self.slides[load.on], damping=self.slot(load.damping))
        return _core.Load.ViscousPoint(point=self.points[load.on], damping=self.slot(load.damping))

    def _force(self, load: loads.ConstantForce) -> _core.Load:
        x, y = self._vector(load.force, load.direction)
        if load.along is not None:
            return _core.Load.Follow(
                point=self.points[load.on], link=self.links[load.along], along=x, across=y
            )
        return _core.Load.Force(point=self.points[load.on], x=x, y=y)

    def _between(self, load: Any, start: int, end: int) -> _core.Load:
        """A load along the line between two points."""
        match load:
            case loads.Spring(length=tuple() as length, force=tuple() as force):
                return _core.Load.SpringTable(start=start, end=end, table=self._table(length, force))
            case loads.Spring():
                return _core.Load.Spring(
                    start=start,
                    end=end,
                    stiffness=self.slot(load.stiffness),
                    free_length=self.slot(load.free_length),
                    preload=self.slot(load.preload),
                )
            case loads.Damper(velocity=tuple() as velocity, force=tuple() as force):
                return _core.Load.DamperTable(start=start, end=end, table=self._table(velocity, force))
            case loads.Damper():
                return _core.Load.Damper(start=start, end=end, damping=self.slot(load.damping))
        return _core.Load.GasSpring(
            start=start,
            end=end,
            force=self.slot(load.force_extended),
            length=self.slot(load.length_extended),
            column=self.slot(gas_column(load)),
            exponent=self.slot(load.exponent),
        )

    def _between_links(self, load: loads.TorsionalSpring | loads.TorsionalDamper) -> _core.Load:
        """A torque between the link that a load acts on and another one, or the frame."""
        link, other = self.links[load.on], None if load.against is None else self.links[load.against]
        if isinstance(load, loads.TorsionalDamper):
            return _core.Load.TorsionDamper(link=link, other=other, damping=self.slot(load.damping_torsional))
        cos, sin = self._vector(1.0, load.free_angle)
        return _core.Load.TorsionSpring(
            link=link, other=other, stiffness=self.slot(load.stiffness), cos=cos, sin=sin
        )

    def _formula_load(self, load: loads.FormulaLoad) -> Iterator[_core.Load]:
        """A load for each summand, so that each enters the motion in its own way."""
        on: Callable[..., _core.Load] = _core.Load.FormulaOnSlide
        carrier: dict[str, int]
        turns = whole_turns(load)
        if load.torque is not None:
            on, carrier = _core.Load.FormulaOnLink, {"link": self.links[load.on]}
        elif load.along is not None or load.direction is not None:
            cos, sin = self._vector(1.0, 0.0 if load.direction is None else load.direction)
            on, carrier = _core.Load.FormulaOnPoint, {"point": self.points[load.on], "cos": cos, "sin": sin}
            if load.along is not None:
                on, carrier = _core.Load.FormulaAlong, carrier | {"link": self.links[load.along]}
        else:
            carrier = {"slide": self.slides[load.on], "point": self.points[load.on]}
        constants = {name: self.slot(value) for name, value in load.constants.items()}
        for term in formula.terms(formula.parse(load.text)):
            yield on(formula=self.program.formula(term, constants), **carrier, turns=turns)

    def _vector(self, size: Any, direction: Any) -> tuple[int, int]:
        return self.slot(size * np.cos(direction)), self.slot(size * np.sin(direction))


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
