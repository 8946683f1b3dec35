"""Variables of an FMU: what the importing tool sets, and what it reads.

Words, symbols and units are those of the results that declare the quantities. A value reference is
65536 · group + number, the same in FMI 2.0 and 3.0.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from enum import IntEnum
from typing import Any, NamedTuple

from linkwright.drive.reduction import Reduction
from linkwright.drive.steady_state import SteadyState
from linkwright.drive.transient import Transient
from linkwright.driveline.chain import Chain
from linkwright.driveline.in_time import ElasticTransient
from linkwright.fmi.parameters import Adjustable, bounds_of
from linkwright.fmi.program import Program
from linkwright.kernel.description.place import split
from linkwright.kernel.numerics.tangent import primal
from linkwright.kernel.quantities import Label
from linkwright.kernel.quantities import shown as declared
from linkwright.kernel.units import kinds
from linkwright.kernel.units.marks import Quantity, not_negative
from linkwright.linkages.kinematics import everything
from linkwright.machine.program.compiled import CompiledMachine

# Value references of one group.
_GROUP = 65536


class Group(IntEnum):
    """What a variable is to the library: `linkwright-fmu`, module `variables`."""

    TIME = 0
    INPUT = 1
    PARAMETER = 2
    STATE = 3
    DERIVATIVE = 4
    INDICATOR = 5
    OUTPUT = 6
    POINT = 7
    LINK = 8
    SLIDE = 9
    MASS = 10
    SHAFT = 11


class Variable(NamedTuple):
    """A variable of an FMU."""

    name: str
    group: Group
    number: int
    causality: str  # "independent", "input", "parameter", "output" or "local"
    unit: str = ""  # SI unit as it is printed; empty for a number without one
    about: str = ""  # one sentence
    start: float | bool | None = None  # None where it is computed
    derivative_of: str = ""  # name of the state whose derivative it is
    # Names of the inputs and states that it depends on; None for all.
    depends: tuple[str, ...] | None = None
    is_bool: bool = False
    bounds: tuple[float, float] | None = None  # between which it may be set
    factor: float = 1.0  # of what the library has, such as the speed of a mass referred to the crank

    @property
    def reference(self) -> int:
        """Value reference."""
        return _GROUP * self.group + self.number

    def to_dict(self) -> dict[str, Any]:
        """What a tool needs to know of it, ready for JSON."""
        return {"causality": self.causality, "unit": self.unit, "start": self.start, "about": self.about}

    @property
    def is_state(self) -> bool:
        """Whether it is a continuous state."""
        return self.group == Group.STATE


ANGLE, SPEED = "crank_angle", "crank_speed"

_EXTERNAL = "External torque on the crank; counter-clockwise is positive."
_BRAKE = "Braking torque referred to the crank, 0 or more; it opposes the motion and holds at rest."
_LOAD_SPEED = "Speed of a load behind a viscous coupling with the crank; counter-clockwise is positive."
_COUPLING = "Torque of the coupling with the load per difference of speeds; 0 for none."
_SUPPLY = "Supply of the motor; without it the motor gives no torque."
_REST = "The machine stands, and nothing moves it."


def _set(name: str, number: int, causality: str, mark: Quantity, about: str) -> Variable:
    """A number from outside, of a kind and within its bound."""
    return Variable(name, Group.INPUT, number, causality, mark.kind.unit, about, 0.0, bounds=bounds_of(mark))


INPUTS = (
    Variable("motor_on", Group.INPUT, 0, "input", about=_SUPPLY, start=True, is_bool=True),
    _set("external_torque", 1, "input", Quantity(kinds.TORQUE), _EXTERNAL),
    _set("brake_torque", 2, "input", not_negative(kinds.TORQUE), _BRAKE),
    _set("load_speed", 3, "input", Quantity(kinds.SPEED), _LOAD_SPEED),
    _set("load_coupling", 4, "parameter", not_negative(kinds.TORSIONAL_DAMPING), _COUPLING),
)

TIME = Variable("time", Group.TIME, 0, "independent", "s", "Time.")

_KINETIC = Label("kinetic energy", "E", "J", "½ J(φ) ω².")
_COUPLED = Label("torque of the coupling", "T_c", "N m", "c (ω_L − ω): of the load on the crank.")
_MOTOR_SPEED = Label("speed of the motor", "ω_M", "rad/s", "At its shaft.")

# Name, its number for the library, and the quantity.
_OUTPUTS = (
    ("torque_motor", 0, declared(SteadyState, "torque_motor")),
    ("torque_drive", 1, declared(SteadyState, "torque_drive")),
    ("torque_load", 2, declared(SteadyState, "torque_load")),
    ("inertia_reduced", 3, declared(Reduction, "inertia_reduced")),
    ("power_motor", 4, declared(SteadyState, "power_motor")),
    ("energy_kinetic", 5, _KINETIC),
    ("speed_motor", 6, _MOTOR_SPEED),
    ("torque_coupling", 7, _COUPLED),
)
# The angle alone gives J(φ), two speeds the torque of the coupling.
_DEPENDS = {"inertia_reduced": (ANGLE,), "torque_coupling": (SPEED, "load_speed")}
# Parts of an elastic driveline turn at speeds of their own.
_DEPENDS_RIGID = {"energy_kinetic": (ANGLE, SPEED), "speed_motor": (SPEED,)}

# Of a point, a link and a slide: names, units; the first ones of position, then of velocity, of acceleration.
_PARTS: dict[str, tuple[Group, int, tuple[tuple[str, str], ...]]] = {
    "points": (
        Group.POINT,
        6,
        (("x", "m"), ("y", "m"), ("vx", "m/s"), ("vy", "m/s"), ("ax", "m/s²"), ("ay", "m/s²")),
    ),
    "links": (Group.LINK, 4, (("angle", "rad"), ("speed", "rad/s"), ("acceleration", "rad/s²"))),
    "slides": (Group.SLIDE, 4, (("position", "m"), ("velocity", "m/s"), ("acceleration", "m/s²"))),
}
_WORDS = {
    "points": ("Position", "Velocity", "Acceleration"),
    "links": ("Angle", "Angular velocity", "Angular acceleration"),
    "slides": ("Position", "Velocity", "Acceleration"),
}
_ONE = {"points": "point", "links": "link", "slides": "slide"}


def variables_of(
    program: Program, start: tuple[float, float], entries: Iterable[Adjustable]
) -> list[Variable]:
    """All variables of a drive, in the order of the description.

    `start`: crank angle [rad] and speed [rad/s] where nothing else is set.
    """
    return [
        *INPUTS,
        *(_parameter(k, entry) for k, entry in enumerate(entries)),
        *_motion(start),
        *([] if program.chain is None else [*_of_driveline(program.chain), *_of_stations(program.chain)]),
        *_of_drive(rigid=program.chain is None),
        *_of_mechanism(program.compiled),
    ]


def indicators(count: int) -> list[Variable]:
    """Event indicators, which FMI 3.0 lists as variables."""
    return [Variable(f"event_indicator_{k + 1}", Group.INDICATOR, k, "local") for k in range(count)]


def _parameter(nth: int, entry: Adjustable) -> Variable:
    """A parameter by its address."""
    unit = entry.kind.unit.replace("^2", "²").replace("^3", "³")
    return Variable(
        quoted(".".join(split(entry.address))),
        Group.PARAMETER,
        nth,
        "parameter",
        unit,
        entry.about,
        entry.value,
        bounds=entry.bounds,
    )


def _motion(start: tuple[float, float]) -> Iterator[Variable]:
    """States and their derivatives."""
    angle, speed, acceleration = (
        declared(Transient, name) for name in ("crank_angle", "speed", "acceleration")
    )
    bounds = [bounds_of(Quantity(kind)) for kind in (kinds.ANGLE, kinds.SPEED)]
    yield _of_label(ANGLE, Group.STATE, 0, angle, start=start[0], depends=(ANGLE,), bounds=bounds[0])
    yield _of_label(SPEED, Group.STATE, 1, speed, start=start[1], depends=(SPEED,), bounds=bounds[1])
    local = f"Derivative of the {angle.word}."
    yield Variable(
        f"der({ANGLE})", Group.DERIVATIVE, 0, "local", "rad/s", local, derivative_of=ANGLE, depends=(SPEED,)
    )
    yield _of_label("crank_acceleration", Group.DERIVATIVE, 1, acceleration, derivative_of=SPEED)


def _of_driveline(chain: Chain) -> Iterator[Variable]:
    """Twists and speeds of the masses against the crank: the other states, with their derivatives."""
    others = len(chain.links["inertia"])
    names = [_mass_name(chain, mass) for mass in range(others)]
    kinds = (
        ("twist", "rad", "Twist of {} against the crank."),
        ("slip", "rad/s", "Speed of {} less that of the crank."),
    )
    for order, (word, unit, about) in enumerate(kinds):
        for mass, name in enumerate(names):
            number = 2 + order * others + mass
            own = quoted(f"driveline.{name}.{word}")
            sentence = about.format(name)
            yield Variable(own, Group.STATE, number, "output", unit, sentence, 0.0, depends=(own,))
            after = quoted(f"driveline.{name}.slip")
            yield Variable(
                f"der({own})",
                Group.DERIVATIVE,
                number,
                "local",
                f"{unit}/s" if order == 0 else "rad/s²",
                f"Derivative: {sentence[0].lower()}{sentence[1:]}",
                derivative_of=own,
                depends=(after,) if order == 0 else None,
            )


def _of_stations(chain: Chain) -> Iterator[Variable]:
    """Motion of the masses but the crank, at the own speed of what is named, and load of the shafts."""
    for mass in range(len(chain.links["inertia"])):
        name = _mass_name(chain, mass)
        ratio = float(primal(chain.ratio[chain.stations.index(name)]))
        for part, quantity in enumerate(("angle", "speed", "acceleration")):
            yield _of_part(f"driveline.{name}", quantity, Group.MASS, 4 * mass + part, name, ratio)
    for nth, (name, lead) in enumerate(zip(chain.shafts, primal(chain.lead), strict=True)):
        yield _of_part(f"shafts.{name}", "twist", Group.SHAFT, 2 * nth, name, float(lead))
        yield _of_part(f"shafts.{name}", "torque", Group.SHAFT, 2 * nth + 1, name, 1.0 / float(lead))


def _of_part(head: str, quantity: str, group: Group, number: int, name: str, factor: float) -> Variable:
    """An output of a station or a shaft."""
    label = declared(ElasticTransient, quantity)
    label = label._replace(word=re.sub("each (station|shaft)", lambda _: name, label.word))
    return _of_label(quoted(f"{head}.{quantity}"), group, number, label, factor=factor)


def _mass_name(chain: Chain, mass: int) -> str:
    """What turns with a mass, the first of them."""
    return str(chain.stations[chain.mass.tolist().index(mass)])


def _of_label(name: str, group: Group, number: int, label: Label, **more: Any) -> Variable:
    """An output that a result declares."""
    head = label.word[:1].upper() + label.word[1:] + (f", {label.symbol}" if label.symbol else "")
    about = " ".join(part for part in (f"{head}.", label.about) if part)
    return Variable(name, group, number, "output", label.unit, about, **more)


def _of_drive(*, rigid: bool) -> Iterator[Variable]:
    """Torques, power, energy of the drive."""
    depends = _DEPENDS | (_DEPENDS_RIGID if rigid else {})
    for name, number, label in _OUTPUTS:
        yield _of_label(name, Group.OUTPUT, number, label, depends=depends.get(name))
    yield Variable("at_rest", Group.OUTPUT, 16, "output", about=_REST, is_bool=True)


def _of_mechanism(compiled: CompiledMachine) -> Iterator[Variable]:
    """Points that move, links and slides, all that have a name."""
    orders: tuple[tuple[str, ...] | None, ...] = ((ANGLE,), (ANGLE, SPEED), None)
    fixed = {point.point for point in compiled.ground}
    for part, name in everything(compiled):
        if part == "points" and compiled.points[name] in fixed:
            continue
        group, width, columns = _PARTS[part]
        first = width * getattr(compiled, part)[name]
        per = len(columns) // 3
        for nth, (column, unit) in enumerate(columns):
            about = f"{_WORDS[part][nth // per]} of the {_ONE[part]} {name}."
            yield Variable(
                quoted(f"{part}.{name}.{column}"),
                group,
                first + nth,
                "output",
                unit,
                about,
                depends=orders[nth // per],
            )


# What a quoted part of a structured name may hold, beside letters and digits.
_QUOTABLE = re.compile(r"[A-Za-z0-9_!#$%&()*+,\-./:;<>=?@\[\]^{}|~ ]+")


def quoted(name: str) -> str:
    """A name with points as a structured name of FMI: parts that are no identifiers in single quotes.

    FMI 2.0.4, section 2.2.9; FMI 3.0.1, section 2.4.7.5.1.
    """
    return ".".join(part if _is_identifier(part) else f"'{part}'" for part in name.split("."))


def is_structured(name: str) -> bool:
    """Whether a name made by `quoted` is a structured one; else names of the FMU are a flat list."""
    return name.startswith("der(") or all(
        _is_identifier(part) or _QUOTABLE.fullmatch(part[1:-1]) for part in name.split(".")
    )


def _is_identifier(part: str) -> bool:
    """Whether a part of a name needs no quotes."""
    return part.isidentifier() and part.isascii()
