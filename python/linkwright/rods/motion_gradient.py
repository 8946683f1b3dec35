r"""A rod string in motion, with derivatives by the entries of the machine.

With a motor the load z of the polished rod over the crank angle and the motion of the drive decide each
other: the gearbox's torque under z, the steady motion under that torque, the load under that motion, z again.
Its derivatives are those that one round leaves as they are (`kernel.numerics.implicit`).

The crank angle φ at a share τ of the period T, from the bottom of the stroke φ_b on, follows by

.. math:: \mathrm d\varphi = \omega\left(\mathrm dt(\varphi_b) + \frac{\mathrm d\varphi_b}{\omega_b}
    + \tau\,\mathrm dT - \mathrm dt(\varphi)\right)

with t(φ) the time of the steady motion at a crank angle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from linkwright.drive.gradient import derivatives_along, gradient_along, solved_along
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.implicit import iterated_along, solution_along
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal
from linkwright.machine.address import entry_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import Translation
from linkwright.machine.tangents import Derivatives, Directions, directions, followed
from linkwright.pumping.gear_torque import equal_peaks
from linkwright.pumping.gradient import RodAlong
from linkwright.pumping.unit import end_angles
from linkwright.rods.core import Cards, numbers_of, solve_along
from linkwright.rods.model.rod_string import RodString
from linkwright.rods.polished_rod import (
    HarmonicRod,
    UnitRod,
    crank_speed,
    gear_load,
    over_angle,
    table_angles,
)
from linkwright.rods.prediction import Solution, polished_rod_load

_STRING, _UNIT, _LOAD = "rod_string.", "pumping_unit.", "pumping_unit.load."


class MovedRod(NamedTuple):
    """A string in motion by `known` entries; curves at the samples of the cards."""

    known: tuple[str, ...]
    string: RodString
    unit: RodAlong | None
    stroke: Any
    period: Any
    angles: Any  # of the crank; None without a unit
    position: Any  # of the polished rod
    cards: Cards
    mean_load: Any
    drive: Derivatives | None  # of steady motion; None without a motor


def moved_rod(
    machine: Machine, solved: Solution, variables: Sequence[str], refused: dict[str, str]
) -> MovedRod:
    """The motion of a solved string by some entries; those without derivatives are `refused`."""
    rod = solved.rod
    has_motor = isinstance(rod, UnitRod) and rod.has_motor
    own = [
        name for name in variables if has_motor or name.startswith((_STRING, _UNIT)) or name == "drive.speed"
    ]
    programs = []
    if isinstance(rod, UnitRod):
        programs.append(directions(rod.rod.machine, [name for name in own if name.startswith(_UNIT)]))
    if isinstance(rod, UnitRod) and has_motor:
        moving = [name for name in own if not name.startswith((_STRING, _LOAD))]
        programs.append(directions(rod.driven(rod.torque), moving))
    for program in programs:
        refused.update(program.refused)
    known, along = followed(machine, [name for name in own if name not in refused], _described, refused)
    if isinstance(rod, HarmonicRod):
        return _harmonic(solved, known, *along)
    follower = _Follower(solved, machine, known, *along, *(_values(program, known) for program in programs))
    return follower.at_speed() if not has_motor else follower.with_motor()


def _described(machine: Machine) -> tuple[Any, Any, Any]:
    """String, unit and pumping speed of a machine."""
    string = machine.rod_string
    assert string is not None
    return string, machine.pumping_unit, crank_speed(machine, string)


def _values(program: Directions, known: Sequence[str]) -> Floats:
    """Derivatives of the program's numbers by known entries."""
    columns = dict(zip(program.variables, program.values.T, strict=True))
    none = np.zeros(len(program.values))
    return np.array([columns.get(name, none) for name in known]).reshape(len(known), len(none)).T


def _harmonic(solved: Solution, known: tuple[str, ...], string: Any, unit: None, speed: Any) -> MovedRod:
    """A polished rod that moves harmonically."""
    period = 2 * np.pi / speed
    moved = solved.rod.motion(2 * len(solved.moved.position))
    position = string.stroke * (moved.position / moved.stroke)
    cards, mean_load = _cards(solved, string, period, position, len(known))
    return MovedRod(known, string, None, string.stroke, period, None, position, cards, mean_load, None)


def _cards(solved: Solution, string: Any, period: Any, position: Any, k: int) -> tuple[Cards, Any]:
    """The cards with derivatives, and the mean load of the plunger."""
    own = solved.solved
    numbers = np.array([lifted(number, k).d for number in numbers_of(string, period)]).reshape(-1, k)
    samples = lifted(position, k).d[::2]
    found = solve_along(
        solved.string, solved.moved.period, solved.moved.position, own.wave, (numbers.T, samples.T)
    )
    stations, work = len(solved.string.sections) + 1, found.work.T
    cards = Cards(
        Tangent(own.cards.position, np.moveaxis(found.position, 0, -1)),
        Tangent(own.cards.load, np.moveaxis(found.load, 0, -1)),
        Tangent(own.cards.work, work[:stations]),
        Tangent(own.cards.loss, work[stations:]),
    )
    return cards, Tangent(own.mean_load, found.ends[:, 0])


@dataclass(frozen=True)
class _Follower:
    """A polished rod on a pumping unit, with derivatives by `known` entries."""

    solved: Solution
    machine: Machine
    known: tuple[str, ...]
    string: Any
    unit: Any
    speed: Any
    beam: Floats  # derivatives of the numbers of the unit alone, (parameters, known)
    driven: Floats = field(default_factory=lambda: np.zeros((0, 0)))  # of those of the drive

    @cached_property
    def rod(self) -> UnitRod:
        rod = self.solved.rod
        assert isinstance(rod, UnitRod)
        return rod

    @cached_property
    def along(self) -> RodAlong:
        """The polished rod with derivatives at fixed crank angles."""
        return RodAlong.of_unit(self.rod.rod, self.unit, self.beam)

    @cached_property
    def angles(self) -> Floats:
        """Crank angles at the samples of the cards."""
        angles = self.rod.motion(2 * len(self.solved.moved.position)).crank_angle
        assert angles is not None
        return angles

    @cached_property
    def bottom(self) -> Floats:
        """Derivatives of the crank angle at the bottom of the stroke, (known,)."""
        return np.asarray(lifted(end_angles(self.unit)[0], len(self.known)).d)

    @cached_property
    def motion(self) -> Any:
        """Rise of the polished rod and its derivatives at fixed crank angles of the samples."""
        return self.along.motion(self.angles)

    def at_speed(self) -> MovedRod:
        """At constant pumping speed."""
        n = len(self.angles)
        return self._moved(np.broadcast_to(self.bottom, (n, len(self.known))), 2 * np.pi / self.speed, None)

    def _moved(self, late: Floats, period: Any, drive: Derivatives | None) -> MovedRod:
        """By derivatives `late` of the crank angles at the samples."""
        angles = Tangent(self.angles, late)
        travel, factor = self.motion[0], primal(self.motion[1])
        position = travel + factor * (angles - self.angles)
        cards, mean_load = _cards(self.solved, self.string, period, position, len(self.known))
        stroke = self.unit.stroke
        return MovedRod(
            self.known, self.string, self.along, stroke, period, angles, position, cards, mean_load, drive
        )

    # -- with a motor ---------------------------------------------------------------------------------------

    def with_motor(self) -> MovedRod:
        """At the steady motion of the drive."""

        def answered(along: Floats) -> Floats:
            moved = self._under(along)
            # The drive knows the load at every other sample of the cards.
            position, load = moved.position[::2], moved.cards.load[0][::2]
            own = polished_rod_load(self.string, primal(position), load)
            return np.asarray(over_angle(moved.angles[::2], own).d)

        load = iterated_along(answered, len(self.rod.load), len(self.known))
        found = self._under(load)
        drive = derivatives_along(self._steady[2], self._directions(load))
        return found._replace(drive=drive)

    @cached_property
    def _torque(self) -> Floats:
        """Derivatives of the drive's numbers by torques of the gearbox, (parameters, angles)."""
        torque = self.rod.torque
        seeds = [Tangent(*pair) for pair in zip(torque, np.eye(len(torque)), strict=True)]
        numbers = Translation(self.rod.driven(seeds), motor=True, brake=False)
        rows = np.array([lifted(x, len(torque)).d for x in numbers.program.parameters])
        return np.concatenate([rows, np.zeros((len(self.driven) - len(rows), len(torque)))])

    def _directions(self, load: Floats) -> Directions:
        """Derivatives of the drive's numbers by those (angles, known) of the loads over the crank angle."""
        factor = self.along.motion(table_angles())[1]
        turn, given = gear_load(self.unit, factor, Tangent(self.rod.load, load))
        net: Any = turn.net(given) if given is not None else self._balanced(turn)
        values = self.driven + self._torque @ lifted(net, len(self.known)).d
        sizes = np.array([abs(float(entry_of(self.machine, name))) or 1.0 for name in self.known])
        return Directions(self.known, values, sizes, {})

    def _balanced(self, turn: Any) -> Any:
        """Torques with the counterbalance that keeps the peaks of both strokes equal."""
        plain, _ = gear_load(self.rod.unit, primal(turn.factor), self.rod.load)
        is_up = plain.factor >= 0
        size = equal_peaks(plain, is_up)
        net, slope = plain.net(size), plain.net_slope(size)
        up, down = (int(np.where(side, net, -np.inf).argmax()) for side in (is_up, ~is_up))
        held = turn.net(size)
        return turn.net(solution_along(size, held[up] - held[down], slope[up] - slope[down]))

    @cached_property
    def _steady(self) -> Any:
        """Steady motion, its solution, and the machine that it is of."""
        program = Directions(self.known, self.driven, np.ones(len(self.known)), {})
        return solved_along(self.rod.driven(self.rod.torque), program)

    def _under(self, load: Floats) -> MovedRod:
        """The motion by derivatives of the loads over the crank angle."""
        _, solution, machine = self._steady
        gradient = gradient_along(machine, solution, self._directions(load))
        angles, bottom = self.angles, self.rod.ends[0]
        order, back = np.unique(np.append(angles, bottom), return_inverse=True)
        speed = solution.curves(order).speed[back]
        time = gradient.curves(order).time[back]
        n = len(angles)
        share = np.arange(n) / n - (angles < bottom)
        late = time[-1] + self.bottom / speed[-1] + np.outer(share, gradient.period) - time[:-1]
        return self._moved(speed[:-1, None] * late, Tangent(self.rod.period, gradient.period), None)
