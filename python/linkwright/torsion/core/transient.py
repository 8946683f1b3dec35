r"""Discs with inertias that change with the angle, shafts and torques, in the terms of the core.

.. math:: J(\theta)\,\ddot\theta + \tfrac12 J'(\theta)\,\dot\theta^2 + c\,\dot\theta
    + d\,(\dot\theta - \omega) + \sum M_\mathrm{shaft} = \sum M

with the speed ω of the train as a whole, the mean over its inertia.

Everything is said of the discs at their own speeds; discs behind rigid gears move as one mass, as in
`linkwright.torsion.core.train`.

Hysteresis has no meaning in time: what loses the same share of its energy whatever the frequency is no law
of the instant. A shaft of the loss factor η becomes a viscous one that loses as much at one frequency,
:math:`c = \eta k/\omega`.

References
----------
.. [1] Crandall, The role of damping in vibration theory, J. Sound Vib. 11 (1970) 3-18.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linkwright import _core
from linkwright.kernel.arrays import Floats, Integers
from linkwright.kernel.core.curve import Curve
from linkwright.kernel.core.periodic_table import PeriodicTable, smooth
from linkwright.kernel.errors import InputError, ShapeError
from linkwright.torsion.core.torque import DecayingTorque, GovernorTorque, OverSpeed, Power, TrainTorque
from linkwright.torsion.core.train import HELD, ReferredTrain, lead_speeds

# Share of a twist that is rounding.
_EQUAL = 1e-9

# Share of the largest slope by which given slopes may differ from those of the samples.
_SLOPES_AGREE = 1e-3


@dataclass(frozen=True)
class VariableInertia:
    """An inertia that changes with the angle of its disc."""

    on: int  # disc
    table: PeriodicTable  # [kg m²]
    phase: float = 0.0  # angle of the table where that of the disc is zero [rad]


def variable_inertia(
    on: int,
    inertia: ArrayLike,
    slope: ArrayLike | None = None,
    phase: float = 0.0,
    period: float = 2 * np.pi,
) -> VariableInertia:
    """An inertia from even samples over one revolution, or over the period after which it repeats.

    By the trigonometric polynomial through the samples. `inertia`: (samples,) [kg m²]; `slope`: (samples,)
    [kg m²/rad]; `phase`, `period`: [rad].
    """
    J = np.asarray(inertia, dtype=float)
    if not len(J) or not (np.isfinite(J).all() and (J > 0).all()):
        raise InputError("inertia over the revolution: expected finite numbers above zero")
    table = smooth(J, period)
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
class TimeExtremes:
    """Extremes of curves over time, (curves,) each, and their times [s]."""

    maximum: Floats
    maximum_time: Floats
    minimum: Floats
    minimum_time: Floats

    @staticmethod
    def of(extremes: _core.Extremes, count: int) -> TimeExtremes:
        """The first ones that the core tells."""
        columns = (extremes.greatest, extremes.greatest_at, extremes.least, extremes.least_at)
        return TimeExtremes(*(column[:count] for column in columns))


class NetTorque(NamedTuple):
    """Sum of all torques on each mass, less ½ J′ω² [N m], and its inertia [kg m²], (rows, masses)."""

    torque: Floats
    inertia: Floats


@dataclass(frozen=True)
class Grip:
    """Friction in one sense of slip, at full engagement."""

    held: float  # static capacity [N m]
    sliding: float  # torque far from rest [N m]
    rise: float = 0.0  # what it has more at rest [N m]
    speed: float = 1.0  # slip at which that has fallen to 1/e [rad/s]
    curve: Curve | None = None  # sliding torque over slip, instead [N m, rad/s]


@dataclass(frozen=True)
class TrainFriction:
    """A clutch, brake or freewheel: dry friction between two discs."""

    name: str
    tip: tuple[int, int]  # discs that it joins; `HELD` for the ground
    # Where the first disc is faster, and where it is slower; None where it cannot slide.
    forward: Grip | None
    backward: Grip | None
    engagement: Curve | None = None  # over time [s]; None for 1


@dataclass(frozen=True)
class FrictionMotion:
    """What elements with friction do, (elements, …)."""

    torque: Floats  # (elements, times) [N m]
    state: Integers  # (elements, times) 0 open, 1 stuck, 2 sliding forward, 3 backward
    # `torque_extremes`, `power_extremes`: [N m, W].
    torque_extremes: TimeExtremes
    power_extremes: TimeExtremes
    heat: Floats  # [J]
    engagements: Integers  # how often each has come to stick
    # `slip_time`, `stuck_time`: [s].
    slip_time: Floats
    stuck_time: Floats


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
    # `energy_start`, `energy_end`: kinetic and potential energy together [J].
    energy_start: float
    energy_end: float
    # `angle`, `speed`: (masses, times) of the masses, at the speed of the first disc [rad, rad/s].
    angle: Floats
    speed: Floats
    torque: Floats  # (shafts, times) at the speed of each shaft [N m]
    # `kinetic`, `potential`: (times,) energy [J].
    kinetic: Floats
    potential: Floats
    # `torque_extremes`, `speed_extremes`: of each shaft and of each mass.
    torque_extremes: TimeExtremes
    speed_extremes: TimeExtremes
    work: Floats  # (torques and then controllers,) [J]
    # `shaft_loss`, `mass_loss`, `modal_loss`: lost in each shaft, at each mass, by damping ratios [J].
    shaft_loss: Floats
    mass_loss: Floats
    modal_loss: float
    friction: FrictionMotion


@dataclass(frozen=True)
class Manner:
    """What a shaft or mesh has beyond a spring and a damper between two discs that turn alike."""

    rigid: bool = False  # no stiffness: both ends move as one
    contact: bool = False  # damping acts while flanks touch, and never pulls
    # Torque at the first end over that of the teeth while it drives, and while the second does.
    loss: tuple[float, float] | None = None
    joint: tuple[float, float] | None = None  # angle α and phase of a Hooke's joint at the first end [rad]
    # Disc that carries a mesh, and the parts of the angles of first, second and carrier in the twist.
    carrier: tuple[int, tuple[float, float, float]] | None = None


@dataclass(frozen=True)
class MovingPendulum:
    """Centrifugal pendulums: disc that carries them, disc that their angle is, m, R and l [kg, m]."""

    on: int
    bob: int
    mass: float
    radius: float
    length: float

    @property
    def swing_per_lead(self) -> float:
        """Angle of swing over the angle by which the pendulum leads its disc about the axis."""
        return (self.radius + self.length) / self.length


@dataclass(frozen=True)
class Controller:
    """A speed controller, M₀ + k_p (e + ∫e dt/T_i), e = ω_s(t) − ω, within a limit."""

    name: str
    on: int  # disc
    gain: float  # k_p [N m s/rad]
    inverse_time: float  # 1/T_i [1/s]
    limit: float  # infinite for none [N m]
    set_point: Curve  # ω_s [rad/s] over time [s]
    offset: float = 0.0  # M₀ [N m]


PLAIN = Manner()


@dataclass(frozen=True)
class MovingTrain:
    """Discs, shafts and torques of a train that moves in time."""

    discs: tuple[str, ...]  # names
    speed: Floats  # (discs,) n, speed of each disc over that of the first, without its sense
    mass: Integers  # (discs,) discs of one number move as one
    # `inertia`, `damping`, `swing_damping`: (discs,) constant part of the inertia [kg m²], damping against
    # the ground, and damping that resists only what goes beyond the speed of the train as a whole [N m
    # s/rad].
    inertia: Floats
    damping: Floats
    swing_damping: Floats
    shafts: tuple[str, ...]  # names of what twists
    tip: Integers  # (shafts, 2) discs that each joins; `HELD` for the ground
    # `stiffness`, `shaft_damping`: (shafts,) at the first end that is a disc [N m/rad, N m s/rad].
    stiffness: Floats
    shaft_damping: Floats
    # Torque over twist of each shaft, in addition to its stiffness [N m, rad].
    curves: tuple[Curve | None, ...]
    inertias: tuple[VariableInertia, ...] = ()  # in addition to the constant ones
    torques: tuple[TrainTorque, ...] = ()  # from outside
    # (masses, masses) of damping ratios of modes, at the speed of the first disc; None for none [N m s/rad].
    modal_damping: Floats | None = None
    frictions: tuple[TrainFriction, ...] = ()
    notes: tuple[str, ...] = field(default=())  # what was assumed
    manners: tuple[Manner, ...] = ()  # of each shaft; empty where all are plain
    # (discs,) 0 for a disc that rests while the train runs, whose `speed` is 1, else 1. None: all turn.
    turns: Floats | None = None
    pendulums: tuple[MovingPendulum, ...] = ()
    controllers: tuple[Controller, ...] = ()

    @property
    def masses(self) -> int:
        """How many masses."""
        return int(self.mass.max()) + 1

    @property
    def turning(self) -> Floats:
        """0 for a mass that rests while the train runs, else 1, (masses,)."""
        turning = np.ones(self.masses)
        if self.turns is not None:
            turning[self.mass] = self.turns
        return turning

    @cached_property
    def joins(self) -> Floats:
        """Parts of the angles of the masses in each twist over the speed of its lead, (shafts, masses)."""
        joins = np.zeros((len(self.shafts), self.masses + 1))
        # The last column is that of the ground.
        ends = np.append(self.mass, self.masses)[self.tip]
        for end, sign in zip(ends.T, (1.0, -1.0), strict=True):
            np.add.at(joins, (np.arange(len(joins)), end), sign)
        for s, manner in enumerate(self.manners):
            if manner.carrier is not None:
                discs = [*self.tip[s].tolist(), manner.carrier[0]]
                joins[s] = 0.0
                for disc, part in zip(discs, manner.carrier[1], strict=True):
                    if disc != HELD:
                        joins[s, self.mass[disc]] += part * self.speed[disc] / self.lead[s]
        return joins[:, :-1]

    @cached_property
    def is_free(self) -> bool:
        """Whether it can rotate as a rigid body."""
        size = np.abs(self.joins) @ self.turning
        held = (self.tip == HELD).any(axis=1) & (size > 0)
        for s, manner in enumerate(self.manners):
            if manner.carrier is not None:
                held[s] = abs(self.joins[s] @ self.turning) > _EQUAL * size[s]
        return not held.any()

    @property
    def has_losses(self) -> bool:
        """Whether gear stages lose power by their torque."""
        return any(manner.loss is not None for manner in self.manners)

    @cached_property
    def groups(self) -> Integers:
        """Number of the group of rigidly connected masses of each, (masses,): rigid stages with losses."""
        group = np.arange(self.masses)
        for s, manner in enumerate(self.manners):
            if manner.rigid:
                a, b = group[self.mass[self.tip[s]]]
                group[group == b] = a
        return np.unique(group, return_inverse=True)[1].astype(np.int32)

    @property
    def lead(self) -> Floats:
        """Speed of the end of each shaft where its twist counts, over that of the first disc, (shafts,)."""
        return lead_speeds(self.tip, self.speed)

    @property
    def mean_inertia(self) -> Floats:
        """Inertia of the discs, averaged over the revolution, (discs,) [kg m²]."""
        J = np.array(self.inertia, dtype=float)
        np.add.at(J, [rotor.on for rotor in self.inertias], [rotor.table.mean for rotor in self.inertias])
        return J

    @cached_property
    def system(self) -> _core.TorsionSystem:
        """The train as the core takes it."""
        return core_system(self)

    def net_torques(self, time: float, angle: ArrayLike, speed: ArrayLike) -> NetTorque:
        """Sum of all torques on each mass, and its inertia, (rows, masses).

        Torques, less ½ J′ω² [N m], and inertias [kg m²]. `time`: [s]; `angle`: (rows, masses) [rad]; `speed`:
        (masses,) [rad/s].
        """
        n, more = self.masses, len(self.controllers)
        rows = np.pad(np.asarray(angle, dtype=np.float64), [(0, 0), (0, more)])
        turning = np.pad(np.asarray(speed, dtype=np.float64), (0, more))
        net = self.system.net_torques(time, np.ascontiguousarray(rows), turning)
        return NetTorque(net.torque[:, :n], net.inertia[:, :n])

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
        more = len(self.controllers)
        # The state of each controller is the speed of a mass of its own.
        at, turning = (np.pad(np.asarray(given, dtype=np.float64), (0, more)) for given in (angle, speed))
        sampled = np.ascontiguousarray(times, dtype=np.float64)
        motion = self.system.follow(
            angle=at,
            speed=turning,
            times=sampled,
            start=start,
            duration=float(sampled[-1]),
            accuracy=accuracy,
            method=method,
            steps_max=steps_max,
        )
        # Dashpots of modal damping come after the shafts.
        m, n, f = len(self.shafts), self.masses, len(self.frictions)
        return TrainMotion(
            end=motion.end,
            method=motion.method,
            steps=motion.steps,
            rejected=motion.rejected,
            evaluations=motion.evaluations,
            time=motion.time,
            fastest=motion.fastest,
            energy_start=motion.kinetic_start + motion.potential_start,
            energy_end=motion.kinetic_end + motion.potential_end,
            angle=motion.angle[:n],
            speed=motion.speed[:n],
            torque=motion.torque[:m],
            kinetic=motion.kinetic,
            potential=motion.potential,
            torque_extremes=TimeExtremes.of(motion.torque_extremes, m),
            speed_extremes=TimeExtremes.of(motion.speed_extremes, n),
            work=motion.work,
            shaft_loss=motion.loss_links[:m],
            mass_loss=motion.loss_masses[:n],
            modal_loss=float(motion.loss_links[m:].sum()),
            friction=FrictionMotion(
                torque=motion.friction_torque,
                state=np.nan_to_num(motion.friction_state).astype(np.int32),
                torque_extremes=TimeExtremes.of(motion.friction_extremes, f),
                power_extremes=TimeExtremes.of(motion.power_extremes, f),
                heat=motion.loss_frictions,
                engagements=np.array(motion.engagements, np.int32),
                slip_time=motion.slip_time,
                stuck_time=motion.stuck_time,
            ),
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
    frictions: Iterable[TrainFriction] = (),
    notes: Iterable[str] = (),
    manners: Sequence[Manner] = (),
) -> MovingTrain:
    """A train in motion from the train for vibration.

    `inertia`: (discs,) constant part, at the speed of each disc [kg m²]; `damping`: (discs,) against the
    ground [N m s/rad]; `swing_damping`: (discs,) [N m s/rad]; `shaft_damping`: (shafts,) [N m s/rad].
    """
    n, m = len(referred.discs), len(referred.shafts)
    shapes = tuple(curves) if curves is not None else (None,) * m
    straight = np.array([curve is None for curve in shapes], dtype=float)
    return MovingTrain(
        referred.discs,
        referred.scale,
        referred.mass,
        np.broadcast_to(np.asarray(inertia, dtype=float), n),
        np.broadcast_to(np.asarray(damping, dtype=float), n),
        np.broadcast_to(np.asarray(swing_damping, dtype=float), n),
        referred.shafts,
        referred.tip,
        referred.stiffness / referred.lead**2 * straight,
        np.broadcast_to(np.asarray(shaft_damping, dtype=float), m),
        shapes,
        tuple(inertias),
        tuple(torques),
        modal_damping,
        tuple(frictions),
        tuple(notes),
        tuple(manners) if any(manner != PLAIN for manner in manners) else (),
        None if referred.twist is None else (referred.speed != 0).astype(float),
    )


def viscous(stiffness: Any, loss_factor: Any, omega: Any) -> Any:
    """Viscous damping that loses as much at one frequency as hysteresis does: c = ηk/ω.

    Of the same shape [N m s/rad]. `stiffness`: k, of any shape [N m/rad]; `loss_factor`: η; `omega`: [rad/s];
    arrays, which may be tangents, or numbers.
    """
    return stiffness * loss_factor / omega


def core_system(train: MovingTrain) -> _core.TorsionSystem:
    """A train in motion as the core takes it."""
    parts = _SharedParts()
    return _core.TorsionSystem(
        masses=_masses(train),
        links=[*_shafts(train, parts), *_modal_links(train)],
        rotors=[
            _core.TorsionRotor(
                mass=int(train.mass[rotor.on]),
                ratio=float(train.speed[rotor.on]),
                phase=rotor.phase,
                inertia=parts.table(rotor.table),
            )
            for rotor in train.inertias
        ],
        torques=[_torque(train, torque, parts) for torque in train.torques],
        pendulums=[_pendulum(train, pendulum) for pendulum in train.pendulums],
        controllers=[_controller(train, n, parts) for n in range(len(train.controllers))],
        frictions=[_friction(train, friction, parts) for friction in train.frictions],
    )


class _SharedParts:
    """Tables and curves in the form of the core, each converted once."""

    def __init__(self) -> None:
        self._made: dict[int, Any] = {}

    def table(self, table: PeriodicTable) -> _core.Periodic:
        if id(table) not in self._made:
            knots = {name: _floats(getattr(table, name)) for name in ("value", "slope", "bend")}
            self._made[id(table)] = _core.Periodic(period=table.period, **knots)
        made: _core.Periodic = self._made[id(table)]
        return made

    def curve(self, curve: Curve) -> _core.Curve:
        if id(curve) not in self._made:
            points = {name: _floats(getattr(curve, name)) for name in ("x", "y", "before", "after")}
            self._made[id(curve)] = _core.Curve(**points)
        made: _core.Curve = self._made[id(curve)]
        return made

    def curve_or_none(self, curve: Curve | None) -> _core.Curve | None:
        return None if curve is None else self.curve(curve)


def _masses(train: MovingTrain) -> list[_core.TorsionMass]:
    """Rigidly connected discs as masses, at the speed of the first disc."""
    columns = np.zeros((3, train.masses))
    for column, own in zip(columns, (train.inertia, train.damping, train.swing_damping), strict=True):
        np.add.at(column, train.mass, train.speed**2 * own)
    masses = [
        _core.TorsionMass(inertia=inertia, damping=damping, swing_damping=swing, turns=turns > 0)
        for (inertia, damping, swing), turns in zip(columns.T.tolist(), train.turning.tolist(), strict=True)
    ]
    # What a controller adds up is the speed of a mass that nothing else moves.
    integral = _core.TorsionMass(inertia=1.0, damping=0.0, swing_damping=0.0, turns=False)
    return [*masses, *[integral] * len(train.controllers)]


def _pendulum(train: MovingTrain, pendulum: MovingPendulum) -> _core.TorsionPendulum:
    return _core.TorsionPendulum(
        disc=int(train.mass[pendulum.on]),
        bob=int(train.mass[pendulum.bob]),
        ratio=float(train.speed[pendulum.on]),
        mass=pendulum.mass,
        radius=pendulum.radius,
        length=pendulum.length,
    )


def _controller(train: MovingTrain, n: int, parts: _SharedParts) -> _core.TorsionController:
    one = train.controllers[n]
    return _core.TorsionController(
        mass=int(train.mass[one.on]),
        integral=train.masses + n,
        ratio=float(train.speed[one.on]),
        gain=one.gain,
        inverse_time=one.inverse_time,
        offset=one.offset,
        limit=one.limit,
        set_point=parts.curve(one.set_point),
    )


def _shafts(train: MovingTrain, parts: _SharedParts) -> Iterator[_core.TorsionLink]:
    ends = [[None if end == HELD else int(train.mass[end]) for end in pair] for pair in train.tip.tolist()]
    numbers = np.column_stack([train.lead, train.stiffness, train.shaft_damping]).tolist()
    manners = train.manners or (PLAIN,) * len(train.shafts)
    rows = zip(ends, numbers, train.curves, manners, strict=True)
    for s, ((first, second), (ratio, stiffness, damping), curve, manner) in enumerate(rows):
        joint, carrier = manner.joint, manner.carrier
        yield _core.TorsionLink(
            first=first,
            second=second,
            ratio=ratio,
            stiffness=stiffness,
            damping=damping,
            curve=parts.curve_or_none(curve),
            rigid=manner.rigid,
            contact=manner.contact,
            loss=manner.loss,
            joint=None if joint is None else (float(np.cos(joint[0])), joint[1]),
            carrier=None if carrier is None else (int(train.mass[carrier[0]]), _carried(train, s, carrier)),
        )


def _carried(
    train: MovingTrain, s: int, carrier: tuple[int, tuple[float, float, float]]
) -> tuple[float, ...]:
    """Parts of the angles of the masses in the twist of a mesh on a carrier."""
    discs = (*train.tip[s].tolist(), carrier[0])
    scale = (0.0 if disc == HELD else float(train.speed[disc]) for disc in discs)
    return tuple(part * factor for part, factor in zip(carrier[1], scale, strict=True))


# Share of the largest entry of a damping matrix that is rounding.
_ROUNDING = 1e-13


def _modal_links(train: MovingTrain) -> list[_core.TorsionLink]:
    """Dashpots between masses and to ground that realise the matrix of damping ratios."""
    # A symmetric matrix is Σ c (e_i − e_j)(e_i − e_j)ᵀ of all pairs with c = −C_ij, but for what rows sum up
    # to; single dashpots may be negative, all together are not.
    C = train.modal_damping
    if C is None:
        return []
    least = _ROUNDING * float(np.abs(C).max())
    first, second = np.triu_indices(len(C), 1)
    pairs: list[tuple[int, int | None, float]] = [
        *zip(first.tolist(), second.tolist(), (-C[first, second]).tolist(), strict=True)
    ]
    # A train that is free as a whole has modes that vibrate without momentum: rows sum up to zero.
    if not train.is_free:
        pairs += [(mass, None, rest) for mass, rest in enumerate(C.sum(axis=1).tolist())]
    return [
        _core.TorsionLink(first=a, second=b, ratio=1.0, stiffness=0.0, damping=c, curve=None)
        for a, b, c in pairs
        if abs(c) > least
    ]


def _torque(train: MovingTrain, torque: TrainTorque, parts: _SharedParts) -> _core.TorsionTorque:
    n = float(train.speed[torque.on])
    shape = None
    if torque.shape is not None:
        table = parts.table(torque.shape)
        shape = _core.TorqueShape(table=table, pitch=torque.pitch * n, phase=torque.phase)
    return _core.TorsionTorque(
        mass=int(train.mass[torque.on]),
        ratio=n,
        scale=torque.scale,
        law=_law(torque, parts),
        weight=parts.curve_or_none(torque.weight),
        shape=shape,
    )


def _friction(train: MovingTrain, friction: TrainFriction, parts: _SharedParts) -> _core.TorsionFriction:
    first, second = (None if end == HELD else int(train.mass[end]) for end in friction.tip)
    turning = next(end for end in friction.tip if end != HELD)

    def grip(one: Grip | None) -> _core.TorsionGrip | None:
        if one is None:
            return None
        curve = parts.curve_or_none(one.curve)
        return _core.TorsionGrip(
            held=one.held, sliding=one.sliding, rise=one.rise, speed=one.speed, curve=curve
        )

    return _core.TorsionFriction(
        first=first,
        second=second,
        ratio=float(train.speed[turning]),
        forward=grip(friction.forward),
        backward=grip(friction.backward),
        engagement=parts.curve_or_none(friction.engagement),
    )


def _law(torque: TrainTorque, parts: _SharedParts) -> _core.TorqueLaw:
    match torque.law:
        case None:
            return _core.TorqueLaw.Constant()
        case Power(speed, exponent, is_even):
            kind = _core.TorqueLaw.Even if is_even else _core.TorqueLaw.Odd
            return kind(speed=speed, exponent=exponent)
        case OverSpeed(curve):
            return _core.TorqueLaw.OverSpeed(curve=parts.curve(curve))
        case GovernorTorque(gain, curve):
            return _core.TorqueLaw.Following(gain=gain, curve=parts.curve(curve))
        case DecayingTorque(start, end, rate, speed, phase):
            return _core.TorqueLaw.Decaying(start=start, end=end, rate=rate, speed=speed, phase=phase)


def _floats(values: ArrayLike) -> Floats:
    return np.ascontiguousarray(values, dtype=np.float64)
