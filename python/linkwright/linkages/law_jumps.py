"""Jumps of velocity and acceleration in the laws of drivers that formulas give, and what they move.

A law is continuous where it can be followed at all (`machine/program/smooth_laws.py`). Where its velocity
jumps, the acceleration is infinite: no torque moves a mass through such a corner. Where its acceleration
jumps, forces do too, and everything elastic is struck (VDI 2143: shock and jerk).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import AssemblyError, FindingError, InputError
from linkwright.kernel.reader.numbers import degrees
from linkwright.linkages.model.element import Crank
from linkwright.machine.address import replace
from linkwright.machine.machine import Machine
from linkwright.machine.own_motors import axis_drivers
from linkwright.machine.program.compiled import CompiledMachine, compile_machine
from linkwright.machine.program.core import Channel

# Intervals of a revolution that are examined, and how far a rise may differ from its slopes, as a share of
# the largest rate: a smooth law differs by its third derivative times h³/12, some 1e-6 of it.
_LOOK, _DIFFERS = 720, 1e-3

# Halvings from half a degree to 1e-11 rad.
_HALVINGS = 30

# By how far a driver is moved to see what it moves [rad, m], and places over the revolution at which.
_MOVED, _PLACES = 1e-3, 7

# What is left of a place that does not move, as a share of the move.
_STILL = 1e-6

_WORDS = {1: "velocity", 2: "acceleration"}


@dataclass(frozen=True)
class LawJump:
    """A jump of a law's derivative of some order, 1 or 2, from one value to another [rad or m, per radᵏ]."""

    name: str
    text: str
    order: int
    angle: float  # crank angle [rad]
    before: float
    after: float
    is_angle: bool  # whether the law is an angle, not a distance

    @property
    def words(self) -> str:
        """Where and by how much."""
        unit = ("rad" if self.is_angle else "m") + ("/rad" if self.order == 1 else "/rad²")
        return (
            f"the {_WORDS[self.order]} of the law of {self.name} jumps from {self.before:.4g} to "
            f"{self.after:.4g} {unit} at a crank angle of {degrees(self.angle)}"
        )


def drivers_with_laws(machine: Machine) -> dict[str, tuple[str, bool]]:
    """Drivers with a formula: name → the formula, and whether it is an angle."""
    laws = machine.linkage.laws()
    return {name: (driver.law or "", isinstance(driver, Crank)) for name, driver in laws.items()}


def shaft_of_laws(machine: Machine) -> Iterator[str]:
    """What torques at the crank are where drivers follow laws; nothing without masses and loads."""
    # Of a cylinder the force is given by itself.
    own = {*axis_drivers(machine), *machine.linkage.cylinders}
    names = ", ".join(name for name in drivers_with_laws(machine) if name not in own)
    if names and (machine.bodies or machine.all_loads):
        yield (
            f"The law of {names} acts as a cam on the crankshaft: torques at the crank are those on the "
            "input shaft of the law; a servo motor that generates the motion needs the torque of the "
            "drive behind it"
        )


def law_jumps(machine: Machine) -> list[LawJump]:
    """Jumps of the laws over a revolution, those of the velocity first; empty without laws."""
    kept = compile_machine(machine).kept
    if "law_jumps" not in kept:
        kept["law_jumps"] = _law_jumps(machine)
    known: list[LawJump] = kept["law_jumps"]
    return known


def _law_jumps(machine: Machine) -> list[LawJump]:
    laws = drivers_with_laws(machine)
    of_axes = [*_jumps_of_axes(machine)] if machine.axes else []
    if not laws:
        return sorted(of_axes, key=lambda jump: jump.order)
    compiled = compile_machine(machine).first()
    of_formulas = [
        LawJump(name, text, order, angle, before, after, is_angle)
        for order in (1, 2)
        for name, (text, is_angle) in laws.items()
        for angle, before, after in _jumps(compiled, compiled.slides[f"{name}.law"], order)
    ]
    return sorted([*of_formulas, *of_axes], key=lambda jump: jump.order)


def _jumps_of_axes(machine: Machine) -> Iterator[LawJump]:
    """Jumps where sections of axes, or pieces of their laws, meet."""
    own, cams = axis_drivers(machine), machine.mechanism.cams
    for name, driver in machine.linkage.drivers().items():
        programme = driver.follows() if name in own and name not in cams else None
        if programme is None:
            continue
        lift = programme.lift.primal
        places = np.array(lift.breaks[:-1])
        ends = np.append(lift.breaks[-1], places[1:])
        for order in (1, 2):
            before, after = lift.at(ends, order, "before"), lift.at(places, order, "after")
            least = 0.1 * _DIFFERS * max(abs(lift.peak(order).value), 1e-12)
            for k in np.flatnonzero(np.abs(after - before) > least):
                angle = float(programme.phase + places[k]) % (2 * np.pi)
                # The even advance is part of the velocity.
                rate = float(programme.advance) / (2 * np.pi) if order == 1 else 0.0
                # What is rounding beside the jump is zero.
                low, high = (round(float(side[k]) + rate, 12) + 0.0 for side in (before, after))
                yield LawJump(name, "", order, angle, low, high, isinstance(driver, Crank))


def require_finite_accelerations(machine: Machine) -> None:
    """Raise if a law with a corner moves masses: FindingError with its angle and jump."""
    for corner in law_jumps(machine) if machine.bodies else []:
        if corner.order == 1 and (moved := _bodies_moved(machine, corner)):
            raise FindingError(
                f"{corner.words}: {', '.join(moved)} would need an infinite acceleration there; write a law "
                "whose velocity is continuous, or describe the motion as a cam"
            )


def law_warnings(machine: Machine) -> Iterator[str]:
    """Jumps of velocity that move no masses, and jumps of acceleration, in sentences."""
    for jump in law_jumps(machine):
        words = jump.words[0].upper() + jump.words[1:]
        if jump.order == 1:
            if _bodies_moved(machine, jump):
                continue  # refused
            yield f"{words}: masses there would need an infinite acceleration"
        else:
            yield f"{words}: inertia forces jump there and excite vibration"


def _jumps(compiled: CompiledMachine, slide: int, order: int) -> list[tuple[float, float, float]]:
    """Crank angles at which a derivative of a law jumps, with both values."""

    def law(angles: Floats) -> Floats:
        (rows,) = compiled.motion([Channel.Slide(slide)], angles)
        values: Floats = np.asarray(rows)
        return values

    # From just after zero to just after a revolution, so that a corner at its end is met once.
    phi = np.linspace(0.0, 2 * np.pi, _LOOK + 1) + 0.37 * 2 * np.pi / _LOOK
    values = law(phi)
    size = max(float(np.abs(values[order]).max()), 1e-12)
    if order == 1:
        rise = np.diff(values[1]) - 0.5 * (values[2][1:] + values[2][:-1]) * np.diff(phi)
        doubtful = np.abs(rise) > _DIFFERS * size
    else:
        # Of the third derivative the core has no channel: what changes fast is looked into.
        doubtful = np.abs(np.diff(values[2])) > 0.05 * size
    places = []
    for k in np.flatnonzero(doubtful):
        low, high = float(phi[k]), float(phi[k + 1])
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            a, b, c = law(np.array([low, middle, high]))[order]
            low, high = (low, middle) if abs(b - a) > abs(c - b) else (middle, high)
        before, after = law(np.array([low, high]))[order]
        if abs(after - before) > 0.1 * _DIFFERS * size:
            places.append((low % (2 * np.pi), float(before), float(after)))
    return places


def _bodies_moved(machine: Machine, corner: LawJump) -> list[str]:
    if not machine.bodies:
        return []
    starts = {"cranks": "phase", "linear_drivers": "start", "cylinders": "start_length"}
    tables = (table for table in starts if corner.name in getattr(machine.mechanism, table))
    part = next(tables, None)
    if part is None:
        return list(machine.bodies)
    value = getattr(getattr(machine.mechanism, part)[corner.name], starts[part])
    address = f"mechanism.{part}.{corner.name}.{starts[part]}"
    try:
        there, moved = _places(machine), _places(replace(machine, {address: float(value) + _MOVED}))
    except (AssemblyError, InputError):
        # silent: what a driver moves is not known, so that all bodies count
        return list(machine.bodies)
    names = {
        name
        for name, place in there.items()
        if np.nanmax(np.abs(moved[name] - place), initial=0.0) > _STILL * _MOVED
    }
    return [name for name, body in machine.bodies.items() if (body.on or name) in names]


def _places(machine: Machine) -> dict[str, Floats]:
    compiled = compile_machine(machine).first()
    phi = 0.317 + np.linspace(0.0, 2 * np.pi, _PLACES, endpoint=False)
    points = {name: compiled.point_motion(index, phi).place for name, index in compiled.points.items()}
    links = {name: compiled.link_motion(index, phi).direction for name, index in compiled.links.items()}
    return points | links
