r"""Derivatives of servo axes and their DC bus by entries of the machine.

Torques follow the equilibrium at fixed angles of the master (`linkwright.kinetostatics.gradient`). The
samples of a cycle lie between the ends of sections and the kinks of loads, and move with them: at a sample
whose angle :math:`\varphi` follows an entry p,

.. math::
   \frac{\mathrm d f}{\mathrm dp} = \frac{\partial f}{\partial p} + f' \frac{\mathrm d\varphi}{\mathrm dp}

From there on the formulas are those of the results themselves, in tangents.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.axes.axis import (
    ServoAxis,
    axis_numbers,
    driver_cycle,
    rates_in_time,
    servo_axes,
    slide_of,
    the_axis,
)
from linkwright.axes.bus import bus_numbers, bus_power, dc_bus
from linkwright.axes.cycle import AxesCycle, axes_cycle, continued
from linkwright.axes.driver_cycle import Peak
from linkwright.axes.duty import Numbers
from linkwright.axes.inertia import inertia_angles, inertias_in
from linkwright.drive.study import has_motor
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.extreme import (
    ALIKE_OF_SOLVED,
    TIE_OF_SOLVED,
    chosen,
    degrees,
    differ,
    occurs_at,
    off,
    they_differ,
)
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.kinetostatics.gradient import drives_along, unit_scene_along, unknowns_along
from linkwright.linkages.whole_cycle import cycle_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import Channel
from linkwright.machine.tangents import Derivatives, Directions, directions

# Samples of a smooth piece by which its slope at each is found, and how near an end is to its cause [rad].
_STENCIL, _NEAR = 7, 1e-7

# How far inside its piece an end is looked at [rad].
_OFF = 1e-8

# A peak below this share of the torques or powers of all axes is rounding.
_NOTHING = 1e-12

# Quantities that are neither torques nor powers.
_OWN_SIZE = ("inertia_mean", "inertia_ratio", "velocity_max", "acceleration_max", "speed_mean", "speed_peak")

_ZERO = "it is zero within rounding error"
_PLACE = "only the extreme value is differentiated, not its location"


@dataclass(frozen=True)
class _Along:
    """The cycle of a machine with derivatives by some entries, at samples that move."""

    program: Directions
    machine: Machine  # the description with tangents
    cycle: AxesCycle
    time: Any
    drivers: Mapping[str, tuple[Any, Any, Any]]  # velocity, acceleration, torque of the driver of each axis
    inertias: Mapping[str, Any]
    lost: Mapping[str, float]

    def of(self, name: str) -> tuple[Any, ...]:
        """Axis, time, velocity, acceleration, torque and mean inertia of its driver."""
        axis = self.machine.axes[name]
        return axis, self.time, *self.drivers[name], self.inertias.get(axis.driver or name)


def axis_tangents(machine: Machine, name: str | None, variables: Sequence[str]) -> Derivatives:
    """Scalars of an axis and its motor by some entries. Raises what `servo_axis` raises."""
    name = the_axis(machine, name)
    known, along = servo_axes(machine, names=(name,))[name], _along(machine, variables)
    found = _Found.of(along, max(abs(known.torque_max), known.motor.torque_peak))
    found.take(known, axis_numbers(*along.of(name)))
    found.missing["torque_max_angle"] = _PLACE
    return found.derivatives(units={key: _unit(known, key) for key in found.tangents})


def bus_tangents(machine: Machine, variables: Sequence[str]) -> Derivatives:
    """Scalars of the DC bus by some entries. Raises what `dc_bus` raises."""
    known, along = dc_bus(machine), _along(machine, variables)
    asked = {name: driver_cycle(*along.of(name)) for name in machine.axes}
    found = _Found.of(along, float(np.abs(known.power).max()))
    found.take(known, bus_numbers(*bus_power(along.machine, asked)))
    return found.derivatives()


def _along(machine: Machine, variables: Sequence[str]) -> _Along:
    """The cycle with derivatives; the same as before for the same entries."""
    kept, asked = compile_machine(machine).kept, tuple(variables)
    last = kept.get("axes_along")
    if last is None or last[0] != asked:
        last = kept["axes_along"] = asked, _cycle_along(machine, asked)
    along: _Along = last[1]
    return along


def _cycle_along(machine: Machine, variables: Sequence[str]) -> _Along:
    cycle = axes_cycle(machine)
    # At the end of a cycle of the crankshaft its time is the period.
    of_speed = cycle_of(machine)
    inside = _off_ends(cycle.angle)
    drives = drives_along(machine, variables, np.append(inside, of_speed))
    program, along = drives.program, drives.scene.machine
    n, motion = len(program.variables), drives.scene.motion
    times, speed, acceleration = (lifted(x, n) for x in (motion.time, motion.speed, motion.acceleration))
    period, time = times[-1], times[:-1]
    time = time + np.round((cycle.time - time.value) / period.value) * period
    # Both sides of an end are at one time.
    time = Tangent(cycle.time, time.d)
    followed: dict[str, Any] = {"speed": speed[:-1], "acceleration": acceleration[:-1]}
    motion = replace(motion, crank_angle=inside, **followed)
    moved = _Samples.of(machine, along, cycle, program)
    compiled, drivers = compile_machine(machine), {}
    for name, axis in machine.axes.items():
        driver = axis.driver or name
        is_cam = driver in machine.mechanism.cams
        torque = lifted((drives.shaft_torques if is_cam else drives.forces)[driver], n)[:-1]
        slide = slide_of(machine, driver)
        if slide is None:
            rates = motion.speed, motion.acceleration
        else:
            (rows,) = compiled.motion([Channel.Slide(slide)], inside, program.values)
            rates = rates_in_time(rows.d1, rows.d2, motion)
        velocity, bend = (lifted(rate, n) for rate in rates)
        torque = continued(cycle.angle, velocity.value, torque)
        slope = bend.value / cycle.forces.motion.speed
        drivers[name] = moved.along(velocity, slope), moved.along(bend), moved.along(torque)
    scene = unit_scene_along(
        machine, program.variables, inertia_angles(round(cycle.angle[-1] / (2 * math.pi)))
    )
    inertias = inertias_in(scene, unknowns_along)
    return _Along(
        *(program, along, cycle, moved.along(time, 1 / cycle.forces.motion.speed)),
        *(drivers, inertias, drives.lost),
    )


def _off_ends(angle: Floats) -> Floats:
    """Angles of a cycle with the ends of pieces inside them: on a kink the core has one side."""
    ends = np.flatnonzero(np.diff(angle) == 0)
    inside = angle.copy()
    inside[[0, *(ends + 1)]] += _OFF
    inside[[*ends, -1]] -= _OFF
    return inside


@dataclass(frozen=True)
class _Samples:
    """The samples of a cycle, which move with the ends of their pieces."""

    pieces: list[slice]
    angle: Floats  # (n,) [rad]
    moves: Floats  # (n, k): derivatives of their angles

    @classmethod
    def of(cls, machine: Machine, along: Machine, cycle: AxesCycle, program: Directions) -> _Samples:
        """Those of a machine; `along`: with tangents."""
        bounds = [0, *(np.flatnonzero(np.diff(cycle.angle) == 0) + 1), len(cycle.angle)]
        pieces = [slice(first, last) for first, last in pairwise(bounds)]
        ends = np.append([cycle.angle[piece.start] for piece in pieces], cycle.angle[-1])
        moving = np.zeros((len(ends), len(program.variables)))
        for place, slope in _breaks(along, len(program.variables)):
            moving[off(ends, place) < _NEAR] = slope
        for place, slope in _kinks(machine, program, round(ends[-1] / (2 * math.pi))):
            moving[off(ends, place, ends[-1]) < _NEAR] = slope
        moves = np.empty((len(cycle.angle), len(program.variables)))
        for k, piece in enumerate(pieces):
            share = (cycle.angle[piece] - ends[k]) / (ends[k + 1] - ends[k])
            moves[piece] = moving[k] + share[:, None] * (moving[k + 1] - moving[k])
        return cls(pieces, cycle.angle, moves)

    def along(self, values: Tangent, slope: Floats | None = None) -> Tangent:
        """Values at samples that move; `slope`: derivative by the angle, if it is known."""
        if not self.moves.any():
            return values
        slope = self._slope(values.value) if slope is None else slope
        return Tangent(values.value, values.d + slope[:, None] * self.moves)

    def _slope(self, values: Floats) -> Floats:
        """Derivative by the angle within each piece, by polynomials through neighbouring samples."""
        slopes = np.empty_like(values)
        for piece in self.pieces:
            n = piece.stop - piece.start
            first = np.clip(np.arange(n) - _STENCIL // 2, 0, n - _STENCIL)
            weights = _difference_weights()[np.arange(n) - first]
            width = (self.angle[piece.stop - 1] - self.angle[piece.start]) / (n - 1)
            slopes[piece] = (weights * values[piece][first[:, None] + np.arange(_STENCIL)]).sum(
                axis=1
            ) / width
        return slopes


@cache
def _difference_weights() -> Floats:
    """Weights of even samples in the slope at each of them, (place, samples), for a unit step."""
    at = np.arange(_STENCIL)
    powers = np.arange(_STENCIL)
    inverse = np.linalg.inv(at[:, None] ** powers)
    slopes = powers * at[:, None] ** np.maximum(powers - 1, 0)
    return np.asarray(slopes @ inverse)


def _breaks(along: Machine, n: int) -> Iterator[tuple[float, Floats]]:
    """Ends of the pieces of all laws, and how they move."""
    for driver in along.linkage.drivers().values():
        followed = driver.follows()
        if followed is not None:
            for place in getattr(followed, "law", followed.lift).breaks:
                end = lifted(place + followed.phase, n)
                yield float(end.value), end.d


def _kinks(machine: Machine, program: Directions, turns: int) -> Iterator[tuple[float, Floats]]:
    """Kinks of loads and motion of all drivers, and how they move."""
    whole = machine.with_entries({"drive": None}) if has_motor(machine) else machine
    way = program if whole is machine else directions(whole, program.variables)
    compiled = compile_machine(whole)
    compiled = compiled.over_turns(turns)
    angles = compiled.kinks()
    places = [program.variables.index(name) for name in way.variables]
    for angle, slopes in zip(angles.tolist(), compiled.kinks_along(way.values, angles), strict=True):
        moves = np.zeros(len(program.variables))
        moves[places] = slopes
        yield angle, moves


def _unit(known: ServoAxis, key: str) -> str:
    """Unit of a quantity of an axis, or of its motor."""
    of, _, name = key.rpartition(".")
    return (getattr(known, of) if of else known).unit_of(name)


@dataclass(frozen=True)
class _Found:
    """Tangents by name, what ties, what has no derivative."""

    along: _Along
    size: float  # of torques or powers, beside which little is rounding
    tangents: dict[str, Tangent]
    ties: dict[str, str]
    missing: dict[str, str]

    @classmethod
    def of(cls, along: _Along, size: float) -> _Found:
        """None yet."""
        return cls(along, size, {}, {}, {})

    def take(self, known: Any, numbers: Numbers) -> None:
        """Quantities that a result has, with its values."""
        for key, number in numbers.means.items():
            if number is not None:
                self._keep(key, _value(known, key), lifted(number, self._n).d, "")
        for key, peak in numbers.peaks.items():
            self._keep(key, _value(known, key), *self._highest(peak))

    def _keep(self, key: str, value: float, d: Floats, why: str) -> None:
        """A quantity with its derivatives, unless it is zero."""
        if abs(value) <= _NOTHING * self.size and key.rpartition(".")[2] not in _OWN_SIZE:
            self.missing[key] = _ZERO
            return
        self.tangents[key] = Tangent(value, d)
        if why:
            self.ties[key] = why

    @property
    def _n(self) -> int:
        return len(self.along.program.variables)

    def _highest(self, peak: Peak) -> tuple[Floats, str]:
        """Derivatives of a peak, NaN by entries that its rivals follow otherwise, and why."""
        places = peak.places(TIE_OF_SOLVED)
        slopes = np.array([lifted(place.value, self._n).d for place in places])
        # One that is as large with the other sign follows the size likewise.
        senses = np.array([math.copysign(1.0, primal(place.value)) for place in places])
        if peak.kind != "size":
            senses = np.ones_like(senses)
        size = max(abs(primal(places[0].value)), _NOTHING)
        differs = differ(senses[:, None] * slopes, size / self.along.program.sizes, ALIKE_OF_SOLVED)
        d = np.where(differs, np.nan, slopes[0])
        if not differs.any():
            return d, ""
        times = [place.time for place in places]
        angles = np.interp(times, self.along.cycle.time, self.along.cycle.angle)
        by = chosen(self.along.program.variables, differs)
        apart = len({*map(degrees, angles)}) > 1
        return d, occurs_at(angles, by) if apart else they_differ(by)

    def derivatives(self, **more: Any) -> Derivatives:
        """All of them."""
        program = self.along.program
        return Derivatives(
            *(program.variables, self.tangents, self.ties, self.missing, program.refused, self.along.lost),
            **more,
        )


def _value(known: Any, key: str) -> Any:
    """A quantity of a result, or of one within it."""
    for name in key.split("."):
        known = getattr(known, name)
    return known
