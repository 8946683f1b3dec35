r"""The law y(t) by which a knife goes back and forth across the row, and what it takes to move it.

The mean speed v_h counts the way in both senses, :math:`v_h = 2 S f` for one stroke S back and forth a cycle;
so a sine of stroke S has :math:`2\pi f = \pi v_h/S` and its maximum speed is :math:`\tfrac{\pi}{2} v_h`. The
phase is zero in the middle of the stroke, the knife going to the left; that of a knife moved by a mechanism
is the crank angle. A knife at rest stands in the middle of its stroke, or where a given phase puts it.

Smooth laws are sums of harmonics, all others laws in pieces: those of a mechanism with cams are polynomials
of degree 5 through position, velocity and acceleration at each degree and at every joint of a cam, which
leaves rounding of a smooth stretch. The follower of a cam has the lift of its cam.

It takes its inertia force, and the torque of its drive at the design speed. Inertia and loads are those of
the machine file; `linkwright.kinetostatics.forces` balances all members.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.cam.laws.motion_law import Harmonic, MotionLaw, Piece
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.extreme import as_high, greatest, size
from linkwright.kernel.numerics.tangent import plain
from linkwright.kinetostatics.forces import forces
from linkwright.linkages.closure import require_full_turn
from linkwright.linkages.kinematics import kinematics_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.topping.core import KnifeWay
from linkwright.topping.model.topper import ConstantKnife, MemberKnife, Topper

_TURN = 2 * np.pi

# Crank angles at which the motion of a smooth member is sampled, and polynomials that stand for any other.
_ANGLES, _KNOTS = 1440, 360

# Share of the first harmonic below which harmonics are rounding; a smooth law has no more of them than this.
_ROUNDING = 1e-14
_HARMONICS = 180

# Share of the maximum speed by which the speed has to change at once to be a blow.
_JUMP = 1e-6

# Beside a corner of the motion derivatives are taken from either side of it [rad].
_BESIDE = 1e-9

# Crank angles at which two revolutions of a member are compared, and the share of its way that is rounding.
_PLACES, _AGAIN = np.array([0.1, 1.0, 1.9, 2.9, 3.7, 4.6, 5.5]), 1e-6


@dataclass(frozen=True)
class Knife:
    """A knife and its law; law, rate and drift may have derivatives.

    Attributes
    ----------
    law : MotionLaw
        y over its phase from 0 to 2π, zero in the middle of the stroke [m].
    harmonics : ndarray, shape (k, 2), or None
        The same as cosines and sines from the constant on [m], for a smooth law.
    corners : tuple of float
        Phases at which the law or one of its first two derivatives jumps [rad].
    rate : float
        Phase per time [rad/s].
    drift : float
        Constant speed across the row of a knife that does not turn back [m/s].
    """

    law: MotionLaw
    harmonics: Floats | None
    corners: tuple[float, ...]
    rate: float
    drift: float = 0.0

    @cached_property
    def stroke(self) -> Any:
        """Distance between the ends [m]."""
        low, high = self.law.extremes()
        return high.value - low.value

    @cached_property
    def way_per_turn(self) -> Any:
        """Way back and forth in one revolution of the phase [m]."""
        turns = sorted([*self.law.primal.breaks, *self.law.zeros(1)])
        places = self.law.at(np.array(turns), 0, "before")
        ways = places[1:] - places[:-1]
        return plain((ways * np.sign(ways)).sum())

    @property
    def frequency(self) -> Any:
        """Revolutions of the phase in a second [1/s]."""
        return self.rate / _TURN

    @cached_property
    def mean_speed(self) -> Any:
        """Mean of the speed across the row, in both senses [m/s]."""
        return size(self.drift) + self.way_per_turn * self.frequency

    @cached_property
    def speeds(self) -> tuple[Any, Any]:
        """Minimum and maximum velocity across the row [m/s]."""
        low, high = (extreme.value * self.rate + self.drift for extreme in self.law.extremes(1))
        return low, high

    @property
    def speed_max(self) -> Any:
        """Maximum speed across the row [m/s]."""
        return greatest(*map(size, self.speeds))

    @cached_property
    def acceleration_max(self) -> Any:
        """Maximum acceleration across the row [m/s²]; infinite for a knife that turns back at once."""
        if not self.rate:
            return 0.0
        law = self.law.primal
        jumps = np.append(law.jumps(1), law.at(0.0, 1) - law.at(law.end, 1, "before"))
        if np.abs(jumps).max() > _JUMP * abs(law.peak(1).value):
            return float("inf")
        return greatest(*(size(extreme.value) for extreme in self.law.extremes(2))) * self.rate**2

    def at(self, time: Any, phase: Any = 0.0, order: int = 0) -> Any:
        """Place, velocity or acceleration by `order`, (...) [m, m/s, m/s²]; `time` [s], `phase` [rad]."""
        value = self.law.at(np.mod(phase + self.rate * time, _TURN), order) * self.rate**order
        return value + (self.drift * time, self.drift, 0.0)[order]

    @cached_property
    def way(self) -> KnifeWay:
        """The knife in the core's terms."""
        reach = max(abs(extreme.value) for extreme in self.law.extremes())
        law = self.law if self.harmonics is None else self.harmonics
        return KnifeWay(law, self.corners, self.rate, self.drift, reach, *self.speeds)


def knives(machine: Machine, topper: Topper) -> tuple[Knife, ...]:
    """The knife of a topper; both of its directions if it does not turn back over a head.

    Raises `AssemblyError` if the mechanism does not close all round, `FindingError` if the member does not
    come back with each revolution.
    """
    motion, speed = topper.motion, topper.knife_speed or 0.0
    if isinstance(motion, MemberKnife):
        return (_moved(machine, motion.of),)
    if not speed and (motion.phase is None or not motion.stroke):
        return (Knife(_still(), np.zeros((1, 2)), (), 0.0),)
    if isinstance(motion, ConstantKnife):
        return (_to_and_fro(motion.stroke, speed),) if motion.stroke else _one_way(speed)
    half = 0.5 * motion.stroke
    return (_smooth(np.array([[0.0, 0.0], [0.0, half]]), speed * np.pi / motion.stroke),)


def _still() -> MotionLaw:
    return MotionLaw((0.0, _TURN), (Piece(()),))


def _one_way(speed: float) -> tuple[Knife, ...]:
    return tuple(Knife(_still(), np.zeros((1, 2)), (), 0.0, way * speed) for way in (1, -1))


def _to_and_fro(stroke: float, speed: float) -> Knife:
    quarter, half = np.pi / 2, 0.5 * stroke
    law = MotionLaw.of(
        0.0, (quarter, Piece((0.0, half))), (np.pi, Piece((half, -stroke))), (quarter, Piece((-half, half)))
    )
    return Knife(law, None, (quarter, 3 * quarter), speed * np.pi / stroke)


def _smooth(harmonics: Floats, rate: float) -> Knife:
    waves = tuple(Harmonic(_TURN * k, a, b) for k, (a, b) in enumerate(harmonics.tolist()) if k)
    law = MotionLaw((0.0, _TURN), (Piece((float(harmonics[0, 0]),), waves),))
    return Knife(law, harmonics, (), rate)


def _moved(machine: Machine, member: str) -> Knife:
    compiled = compile_machine(machine)
    require_full_turn(compiled, machine)
    rate = machine.drive.speed if machine.drive and machine.drive.speed else 0.0

    def motion(phi: Floats) -> tuple[Floats, Floats, Floats]:
        slide = kinematics_of(compiled, phi, [("slides", member)]).slides[member]
        return slide.position, slide.d1, slide.d2

    _require_repeats(motion, member)
    corners = _joints(machine)
    if member in machine.mechanism.cams:
        cam = machine.mechanism.cams[member]
        return _centred(cam.lift.shifted(cam.phase), corners, rate)
    harmonics = None if corners else _harmonics(motion(np.linspace(0.0, _TURN, _ANGLES, endpoint=False))[0])
    if harmonics is not None:
        least, greatest = _smooth(harmonics, rate).law.extremes()
        harmonics[0, 0] -= 0.5 * (least.value + greatest.value)
        return _smooth(harmonics, rate)
    return _centred(*_in_pieces(motion, corners), rate)


def _require_repeats(motion: Callable[[Floats], tuple[Floats, Floats, Floats]], member: str) -> None:
    once, again = (motion(_PLACES + turn)[0] for turn in (0.0, _TURN))
    missed = float(np.abs(again - once).max())
    if missed > _AGAIN * max(1e-3, float(np.ptp(once))):
        raise FindingError(
            f'the knife\'s member "{member}" does not repeat its motion in each revolution: it is up to '
            f"{missed:.4g} m elsewhere a revolution later; take a member that comes back with each revolution"
        )


def _centred(law: MotionLaw, corners: tuple[float, ...], rate: float) -> Knife:
    least, greatest = law.extremes()
    return Knife(law.scaled(1.0, -0.5 * (least.value + greatest.value)), None, corners, rate)


def _joints(machine: Machine) -> tuple[float, ...]:
    """Crank angles at which sections of cams meet, increasing from 0 to 2π."""
    return tuple(sorted({float(np.mod(joint, _TURN)) for joint in joints(machine)}))


def joints(machine: Machine) -> list[Any]:
    """Crank angles at which sections of cams meet, with derivatives where the machine has some [rad]."""
    cams = machine.mechanism.cams.values()
    return [at + cam.phase for cam in cams for at in cam.lift.breaks[:-1]]


def _harmonics(samples: Floats) -> Floats | None:
    """Cosines and sines of a motion sampled over one revolution; None if it is not smooth."""
    spectrum = np.fft.rfft(samples) / len(samples)
    pairs = np.stack([2 * spectrum.real, -2 * spectrum.imag], axis=1)
    pairs[0] *= 0.5
    size = np.hypot(*pairs.T)
    counted = np.flatnonzero(size > _ROUNDING * max(size[1:].max(), np.finfo(float).tiny))
    last = int(counted[-1]) if len(counted) else 0
    return np.ascontiguousarray(pairs[: last + 1]) if last <= _HARMONICS else None


def _in_pieces(
    motion: Callable[[Floats], tuple[Floats, Floats, Floats]], corners: tuple[float, ...]
) -> tuple[MotionLaw, tuple[float, ...]]:
    """Polynomials through position and two derivatives at even angles and at corners; all corners."""
    knots: Floats = np.unique(np.concatenate([np.linspace(0.0, _TURN, _KNOTS + 1), corners]))
    knots = knots[np.concatenate([[True], np.diff(knots) > 2 * _BESIDE])]
    knots[-1] = _TURN
    places = at_knots(knots)
    starts, ends, place = motion(places[0]), motion(places[1]), motion(places[2])[0]
    leaps = [np.abs(starts[k] - np.roll(ends[k], 1)) > _JUMP * np.abs(starts[k]).max() for k in (1, 2)]
    corners = tuple(sorted({*corners, *knots[:-1][leaps[0] | leaps[1]].tolist()}))
    behind, before = ([values.tolist() for values in side] for side in (starts, ends))
    return through(knots, behind, before, place.tolist()), corners


def at_knots(knots: Floats) -> tuple[Floats, Floats, Floats]:
    """Angles right behind the start of each piece and right before its end, and its start [rad]."""
    # Where the motion has a corner, each piece has the derivatives of its own side.
    return np.asarray(knots[:-1] + _BESIDE), np.asarray(knots[1:] - _BESIDE), np.asarray(knots[:-1])


def through(knots: Floats, starts: Any, ends: Any, place: Any) -> MotionLaw:
    """Polynomials through places at their starts, with the derivatives of `starts` and `ends`."""
    value = [*place, place[0]]
    pieces = [
        _quintic(high - low, (value[i], starts[1][i], starts[2][i]), (value[i + 1], ends[1][i], ends[2][i]))
        for i, (low, high) in enumerate(pairwise(knots.tolist()))
    ]
    return MotionLaw(tuple(knots.tolist()), tuple(pieces))


def _quintic(length: float, start: Any, end: Any) -> Piece:
    """The polynomial of degree 5 over u from 0 to 1 with value and two derivatives at both ends."""
    s, v, a = start[0], start[1] * length, start[2] * length**2
    # What a polynomial of degree 2 from the start leaves at the end.
    rise = end[0] - (s + v + 0.5 * a)
    slope = end[1] * length - (v + a)
    bend = end[2] * length**2 - a
    cubic = (
        10 * rise - 4 * slope + 0.5 * bend,
        -15 * rise + 7 * slope - bend,
        6 * rise - 3 * slope + 0.5 * bend,
    )
    return Piece((s, v, 0.5 * a, *cubic))


# Crank angles of the revolution; then so often so many about an extreme, which leaves 1e-12 of it.
_DRIVE_ANGLES, _LOOKS, _CLOSE = 720, 3, 40


@dataclass(frozen=True)
class KnifeDrive:
    """Force and torque at the design speed.

    Attributes
    ----------
    mass : float
        Of the bodies on the knife [kg].
    inertia_force_max : float
        Peak absolute value of mass times acceleration of the knife [N].
    torque_max, torque_min, torque_mean : float
        Extremes and mean of the driving torque at the crank [N m].
    power_mean : float
        Mean power at the crank [W].
    torque_max_angle, torque_min_angle : float
        Crank angles of the extremes [rad].
    """

    mass: float
    inertia_force_max: float
    torque_max: float
    torque_min: float
    torque_mean: float
    power_mean: float
    torque_max_angle: float
    torque_min_angle: float


# Crank angles over whose torques the mean is taken.
DRIVE_ANGLES: Floats = np.linspace(0.0, _TURN, _DRIVE_ANGLES, endpoint=False)


def carried(machine: Machine) -> Any:
    """Mass of the bodies on the knife of a machine [kg]."""
    assert machine.topper is not None
    motion = machine.topper.motion
    assert isinstance(motion, MemberKnife)
    on_knife = [body for name, body in machine.bodies.items() if (body.on or name) == motion.of]
    return sum((body.mass for body in on_knife if body.mass is not None), start=0.0)


def knife_drive(machine: Machine, knife: Knife) -> KnifeDrive | None:
    """Inertia force of the knife and torque of its drive; None without mechanism or mass."""
    motion = None if machine.topper is None else machine.topper.motion
    drive = machine.drive
    if not isinstance(motion, MemberKnife) or drive is None or drive.speed is None or not machine.bodies:
        return None
    mass = carried(machine)
    acting = forces(machine, speed=drive.speed, n=_DRIVE_ANGLES)
    # The revolution's end is its start.
    mean = float(np.mean(acting.torque_drive[:-1]))
    highest, lowest = (
        _highest(machine, drive.speed, acting.crank_angle, acting.torque_drive, sign) for sign in (1.0, -1.0)
    )
    return KnifeDrive(
        mass=float(mass),
        inertia_force_max=float(mass * knife.acceleration_max),
        torque_max=highest[0],
        torque_min=-lowest[0],
        torque_mean=mean,
        power_mean=mean * drive.speed,
        torque_max_angle=highest[1],
        torque_min_angle=lowest[1],
    )


# Rounds in which peaks of the torque are closed in on: to 1e-8 of the revolution.
_ROUNDS = 7


def other_peaks(machine: Machine, knife_drive: KnifeDrive, end: str) -> list[float]:
    """Other crank angles [rad] at which the driving torque is as large, ``"max"``, or small, ``"min"``."""
    assert machine.drive is not None
    speed, sign = machine.drive.speed, 1.0 if end == "max" else -1.0
    top = getattr(knife_drive, f"torque_{end}_angle") % _TURN, sign * getattr(knife_drive, f"torque_{end}")

    def read(angles: Floats) -> Floats:
        torque = forces(machine, speed=speed, angles=angles.ravel()).torque_drive
        return sign * torque.reshape(angles.shape)

    looked = DRIVE_ANGLES, read(DRIVE_ANGLES)
    peaks = as_high(read, looked, top, _TURN, near=_TURN / _DRIVE_ANGLES, rounds=_ROUNDS)
    return [angle for angle in peaks if angle != top[0]]


def _highest(
    machine: Machine, speed: float, angle: Floats, torque: Floats, sign: float
) -> tuple[float, float]:
    """The maximum torque, times a sign, and its angle: examined more closely about the highest so far."""
    step = 2 * np.pi / _DRIVE_ANGLES
    for _ in range(_LOOKS):
        at = int(np.nanargmax(sign * torque))
        angle = np.linspace(angle[at] - step, angle[at] + step, _CLOSE + 1)
        torque = forces(machine, speed=speed, angles=angle).torque_drive
        step = 2 * step / _CLOSE
    at = int(np.nanargmax(sign * torque))
    place = float(angle[at])
    if 0 < at < _CLOSE:
        # The top of the parabola through the three highest.
        a, b, c = torque[at - 1 : at + 2]
        bend = a - 2 * b + c
        place += 0.5 * (a - c) / bend * (angle[1] - angle[0]) if bend else 0.0
    return float(sign * torque[at]), place
