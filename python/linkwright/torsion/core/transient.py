r"""Discs with inertias that change with the angle, shafts and torques, in the terms of the core.

.. math:: J(\theta)\,\ddot\theta + \tfrac12 J'(\theta)\,\dot\theta^2 + c\,\dot\theta
    + d\,(\dot\theta - \omega) + \sum M_\mathrm{shaft} = \sum M

with the speed ω of the train as a whole, the mean over its inertia.

Everything is said of the discs at their own speeds; discs behind rigid gears move as one mass, as in
`linkwright.torsion.core.train`.

Hysteresis has no meaning in time: what loses the same share of its energy whatever the frequency is no law
of the instant. A shaft of the loss factor η becomes a viscous one that loses as much at one frequency,
:math:`c = \eta k/\omega`.

The lists in which a train crosses the border are explained in
`crates/linkwright-core/src/torsion/transient/system.rs`.

References
----------
.. [1] Crandall, The role of damping in vibration theory, J. Sound Vib. 11 (1970) 3-18.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.kernel.core.curve import Curve
from linkwright.kernel.core.periodic_table import PeriodicTable, smooth
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.torsion.core.torque import DecayingTorque, GovernorTorque, OverSpeed, Power, TrainTorque
from linkwright.torsion.core.train import HELD, ReferredTrain

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

# Share of the largest slope by which given slopes may differ from those of the samples.
_SLOPES_AGREE = 1e-3


@dataclass(frozen=True)
class VariableInertia:
    """An inertia that changes with the angle of its disc."""

    on: int  # disc
    table: PeriodicTable  # [kg m²]
    phase: float = 0.0  # angle of the table where that of the disc is zero [rad]


def variable_inertia(
    on: int, inertia: ArrayLike, slope: ArrayLike | None = None, phase: float = 0.0
) -> VariableInertia:
    """An inertia from even samples over one revolution.

    By the trigonometric polynomial through the samples. `inertia`: (samples,) [kg m²]; `slope`: (samples,)
    [kg m²/rad]; `phase`: [rad].
    """
    J = np.asarray(inertia, dtype=float)
    if not len(J) or not (np.isfinite(J).all() and (J > 0).all()):
        raise InputError("inertia over the revolution: expected finite numbers above zero")
    table = smooth(J)
    if slope is not None:
        given = np.asarray(slope, dtype=float)
        if given.shape != J.shape:
            raise ShapeError(f"slope has shape {given.shape}, expected {J.shape}, that of the inertia")
        off = float(np.abs(table.slope[:: len(table.slope) // len(J)] - given).max())
        if not off <= _SLOPES_AGREE * float(np.abs(given).max() or J.mean()):
            raise InputError(
                f"slope of an inertia: differs by {off:.3g} kg m²/rad from that of its {len(J)} samples; "
                "sample the revolution more finely"
            )
    return VariableInertia(on, table, phase)


@dataclass(frozen=True)
class TrainMotion:
    """A motion as the core gives it, in terms of masses."""

    # "time" when it is over; "too many steps", "inaccurate" where no step keeps the accuracy, "not finite".
    end: str
    method: str  # that was used
    # `steps`, `rejected`, `evaluations`: work done.
    steps: int
    rejected: int
    evaluations: int
    time: float  # reached [s]
    fastest: float  # bound of the fastest swing at the start [rad/s]
    energies: tuple[float, float, float, float]  # kinetic and potential at the start, and at the end [J]
    # `angle`, `speed`: (masses, times) of the masses, at the speed of the first disc [rad, rad/s].
    angle: Floats
    speed: Floats
    torque: Floats  # (shafts, times) at the speed of each shaft [N m]
    # `kinetic`, `potential`: (times,) energy [J].
    kinetic: Floats
    potential: Floats
    # (shafts + masses, 4) largest value, its time, minimum value, its time, of torques and speeds.
    extremes: Floats
    work: Floats  # (torques + shafts + masses,) of torques, and lost in shafts and at masses [J]
    modal_loss: float  # lost by damping ratios of modes [J]


@dataclass(frozen=True)
class MovingTrain:
    """Discs, shafts and torques of a train that moves in time."""

    discs: tuple[str, ...]  # names
    speed: Floats  # (discs,) n, speed of each disc over that of the first, without its sense
    mass: Ints  # (discs,) discs of one number move as one
    # `inertia`, `damping`, `swing_damping`: (discs,) constant part of the inertia [kg m²], damping against
    # the ground, and damping that resists only what goes beyond the speed of the train as a whole [N m
    # s/rad].
    inertia: Floats
    damping: Floats
    swing_damping: Floats
    shafts: tuple[str, ...]  # names of what twists
    tip: Ints  # (shafts, 2) discs that each joins; `HELD` for the ground
    # `stiffness`, `shaft_damping`: (shafts,) at the first end that is a disc [N m/rad, N m s/rad].
    stiffness: Floats
    shaft_damping: Floats
    # Torque over twist of each shaft, in addition to its stiffness [N m, rad].
    curves: tuple[Curve | None, ...]
    inertias: tuple[VariableInertia, ...] = ()  # in addition to the constant ones
    torques: tuple[TrainTorque, ...] = ()  # from outside
    # (masses, masses) of damping ratios of modes, at the speed of the first disc; None for none [N m s/rad].
    modal_damping: Floats | None = None
    notes: tuple[str, ...] = field(default=())  # what was assumed

    @property
    def masses(self) -> int:
        """How many masses."""
        return int(self.mass.max()) + 1

    @property
    def lead(self) -> Floats:
        """Speed of the end of each shaft where its twist counts, over that of the first disc, (shafts,)."""
        first, second = self.tip.T
        speed: Floats = self.speed[np.where(first == HELD, second, first)]
        return speed

    @property
    def mean_inertia(self) -> Floats:
        """Inertia of the discs, averaged over the revolution, (discs,) [kg m²]."""
        J = np.array(self.inertia, dtype=float)
        np.add.at(J, [rotor.on for rotor in self.inertias], [rotor.table.mean for rotor in self.inertias])
        return J

    @cached_property
    def system(self) -> _core.TorsionSystem:
        """The train as the core takes it."""
        return encoded(self)

    def net_torques(self, time: float, angle: ArrayLike, speed: ArrayLike) -> tuple[Floats, Floats]:
        """Sum of all torques on each mass, and its inertia, (rows, masses).

        Torques, less ½ J′ω² [N m], and inertias [kg m²]. `time`: [s]; `angle`: (rows, masses) [rad]; `speed`:
        (masses,) [rad/s].
        """
        rows = np.ascontiguousarray(angle, dtype=np.float64)
        return self.system.net_torques(time, rows, np.ascontiguousarray(speed, dtype=np.float64))

    def follow(
        self,
        angle: ArrayLike,
        speed: ArrayLike,
        times: ArrayLike,
        *,
        accuracy: float,
        start: float = 0.0,
        method: str = "auto",
        steps_max: int,
    ) -> TrainMotion:
        """The motion from given angles and speeds.

        Samples beyond the time reached are NaN. `angle`, `speed`: (masses,) [rad, rad/s]; `times`: (times,)
        to sample at, from zero to the end [s]; `start`: [s].
        """
        at, turning, sampled = (
            np.ascontiguousarray(each, dtype=np.float64) for each in (angle, speed, times)
        )
        end = float(sampled[-1])
        motion = self.system.follow(at, turning, sampled, start, end, accuracy, method, steps_max)
        samples = motion.samples
        n, m, k = self.masses, len(self.shafts), len(self.torques)
        # Dashpots of modal damping come after the shafts.
        after = m + len(_dashpots(self))
        return TrainMotion(
            end=motion.end,
            method=motion.method,
            steps=motion.steps,
            rejected=motion.rejected,
            evaluations=motion.evaluations,
            time=motion.time,
            fastest=motion.fastest,
            energies=motion.energies,
            angle=samples[:n],
            speed=samples[n : 2 * n],
            torque=samples[2 * n : 2 * n + m],
            kinetic=samples[-2],
            potential=samples[-1],
            extremes=np.delete(motion.extremes, slice(m, after), axis=0),
            work=np.delete(motion.work, slice(k + m, k + after)),
            modal_loss=float(motion.work[k + m : k + after].sum()),
        )


def moving(
    referred: ReferredTrain,
    inertia: ArrayLike,
    *,
    damping: ArrayLike = 0.0,
    swing_damping: ArrayLike = 0.0,
    shaft_damping: ArrayLike = 0.0,
    curves: Sequence[Curve | None] | None = None,
    inertias: Iterable[VariableInertia] = (),
    torques: Iterable[TrainTorque] = (),
    modal_damping: Floats | None = None,
    notes: Iterable[str] = (),
) -> MovingTrain:
    """A train in motion from the train for vibration.

    `inertia`: (discs,) constant part, at the speed of each disc [kg m²]; `damping`: (discs,) against the
    ground [N m s/rad]; `swing_damping`: (discs,) [N m s/rad]; `shaft_damping`: (shafts,) [N m s/rad].
    """
    n, m = len(referred.discs), len(referred.shafts)
    shapes = tuple(curves) if curves is not None else (None,) * m
    first, second = referred.tip.T
    lead = referred.speed[np.where(first == HELD, second, first)]
    straight = np.array([curve is None for curve in shapes], dtype=float)
    return MovingTrain(
        referred.discs,
        referred.speed,
        referred.mass,
        np.broadcast_to(np.asarray(inertia, dtype=float), n),
        np.broadcast_to(np.asarray(damping, dtype=float), n),
        np.broadcast_to(np.asarray(swing_damping, dtype=float), n),
        referred.shafts,
        referred.tip,
        referred.stiffness / lead**2 * straight,
        np.broadcast_to(np.asarray(shaft_damping, dtype=float), m),
        shapes,
        tuple(inertias),
        tuple(torques),
        modal_damping,
        tuple(notes),
    )


def viscous(stiffness: ArrayLike, loss_factor: ArrayLike, omega: ArrayLike) -> Floats:
    """Viscous damping that loses as much at one frequency as hysteresis does: c = ηk/ω.

    Of the same shape [N m s/rad]. `stiffness`: k, of any shape [N m/rad]; `loss_factor`: η; `omega`: [rad/s].
    """
    k, eta = np.asarray(stiffness, dtype=float), np.asarray(loss_factor, dtype=float)
    damping: Floats = k * eta / np.asarray(omega, dtype=float)
    return damping


def encoded(train: MovingTrain) -> _core.TorsionSystem:
    """A train in motion as the core takes it."""
    n = train.speed
    tables: list[PeriodicTable] = []
    curves: list[Curve] = []
    at_mass = np.zeros((3, train.masses))
    for row, own in zip(at_mass, (train.inertia, train.damping, train.swing_damping), strict=True):
        np.add.at(row, train.mass, n**2 * own)
    # The last is that of the ground, HELD = −1.
    masses = np.append(train.mass, HELD)
    links = [
        [*masses[ends], _place(curve, curves)]
        for ends, curve in zip(train.tip.tolist(), train.curves, strict=True)
    ]
    dashpots = _dashpots(train)
    links += [[first, second, -1] for first, second, _ in dashpots]
    link_numbers = np.column_stack([train.lead, train.stiffness, train.shaft_damping]).tolist()
    link_numbers += [[1.0, 0.0, damping] for _, _, damping in dashpots]
    rotors = [[train.mass[rotor.on], _place(rotor.table, tables)] for rotor in train.inertias]
    torques = [_torque(train, torque, tables, curves) for torque in train.torques]
    return _core.TorsionSystem(
        at_mass[0],
        at_mass[1],
        at_mass[2],
        _ints(links),
        _floats(link_numbers),
        _ints(rotors),
        _floats([[n[rotor.on], rotor.phase] for rotor in train.inertias]),
        _ints([row for row, _ in torques]),
        _floats([row for _, row in torques]),
        _starts([len(table.value) for table in tables]),
        _floats([table.period for table in tables]),
        _end_to_end([getattr(table, name) for name in ("value", "slope", "bend") for table in tables]),
        _starts([len(curve.x) for curve in curves]),
        _end_to_end([getattr(curve, name) for name in ("x", "y", "before", "after") for curve in curves]),
    )


# Share of the largest entry of a damping matrix that is rounding.
_ROUNDING = 1e-13


def _dashpots(train: MovingTrain) -> list[tuple[int, int, float]]:
    """Damping between masses, and of each against the ground, that makes the matrix of damping ratios.

    A symmetric matrix is Σ c (e_i − e_j)(e_i − e_j)ᵀ of all pairs with c = −C_ij, but for what rows sum up
    to; single dashpots may be negative, all together are not.
    """
    C = train.modal_damping
    if C is None:
        return []
    least = _ROUNDING * float(np.abs(C).max())
    first, second = np.triu_indices(len(C), 1)
    pairs = [*zip(first.tolist(), second.tolist(), (-C[first, second]).tolist(), strict=True)]
    # A train that is free as a whole has modes that vibrate without momentum: rows sum up to zero.
    if (train.tip == HELD).any():
        pairs += [(mass, HELD, rest) for mass, rest in enumerate(C.sum(axis=1).tolist())]
    return [(a, b, c) for a, b, c in pairs if abs(c) > least]


def _place(thing: Any, shelf: list[Any]) -> int:
    """Where a table or curve stands among those met so far; −1 for none."""
    if thing is None:
        return -1
    for place, each in enumerate(shelf):
        if each is thing:
            return place
    shelf.append(thing)
    return len(shelf) - 1


def _torque(
    train: MovingTrain, torque: TrainTorque, tables: list[PeriodicTable], curves: list[Curve]
) -> tuple[list[int], list[float]]:
    """Row of integers and row of numbers of a torque."""
    kind, numbers = 0, [0.0] * 5
    curve: Curve | None = None
    match torque.law:
        case Power(speed, exponent, is_even):
            kind, numbers = (1 if is_even else 2), [speed, exponent, 0.0, 0.0, 0.0]
        case OverSpeed(over_speed):
            kind, curve = 3, over_speed
        case GovernorTorque(gain, over_time):
            curve = over_time
            kind, numbers = 4, [gain, 0.0, 0.0, 0.0, 0.0]
        case DecayingTorque(start, end, rate, speed, phase):
            kind, numbers = 5, [start, end, rate, speed, phase]
    n = float(train.speed[torque.on])
    row = [int(train.mass[torque.on]), kind, _place(torque.weight, curves), _place(torque.shape, tables)]
    return [*row, _place(curve, curves)], [n, torque.scale, torque.pitch * n, torque.phase, *numbers]


def _starts(lengths: Sequence[int]) -> Ints:
    """Start of each list among lists that lie end to end, and the end of the last."""
    return np.cumsum([0, *lengths], dtype=np.int32)


def _end_to_end(lists: Sequence[Floats]) -> Floats:
    return np.concatenate(lists) if lists else np.empty(0)


def _ints(rows: ArrayLike) -> Ints:
    return np.ascontiguousarray(rows, dtype=np.int32).ravel()


def _floats(rows: ArrayLike) -> Floats:
    return np.ascontiguousarray(rows, dtype=np.float64).ravel()
