"""Every servo motor of a catalogue with every gearbox: which pairs an axis may have, and why others not.

All pairs are judged at once, by the checks of `duty`. What makes that quick: the torque at the motor is
J dω/dt and a part that depends on the gearbox alone, so that its mean square is a polynomial in J; and since
peak torque does not rise with the speed, a sample counts only if none that is faster has more torque, for any
inertia among the motors compared.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np

from linkwright.axes.driver_cycle import DriverCycle, Peak
from linkwright.axes.duty import INERTIA_RATIO, OF_STARTS, MotorDuty, motor_duty, start_checks
from linkwright.axes.model.axis_catalogue import CatalogueGearbox, CatalogueServo
from linkwright.axes.model.servo_motor import TorqueCurve
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About
from linkwright.kernel.result import Record
from linkwright.kernel.units.kinds import INERTIA, RATIO
from linkwright.kernel.units.marks import not_negative, positive

Goal = Literal["cost", "power", "inertia", "rms"]

# What is judged of every pair, in the order of `duty`.
CHECKS = (
    "speed",
    "torque_rms",
    "torque_peak",
    "inertia_ratio",
    "gearbox_torque_peak",
    "gearbox_torque_rms",
    "gearbox_speed",
)

# Those of a start or stop of the master.
_OF_STARTS = [CHECKS.index(name) for name in OF_STARTS]

_NO_STARTS: Mapping[str, DriverCycle] = {}

# A limit that is met to rounding is kept.
_ROUNDED = 1e-12

# Motors whose inertias differ by less are compared together: samples that count for one count for the others.
_SPREAD = 1.5


@dataclass(frozen=True)
class ServoChoice(Record):
    """Pairs of motor and gearbox for an axis."""

    goal: Annotated[Goal, About("Criterion: ``cost``, rated ``power``, ``inertia``, or ``rms`` utilisation.")]
    motors: Annotated[tuple[CatalogueServo, ...], About("Of the catalogue.")]
    gearboxes: Annotated[tuple[CatalogueGearbox, ...], About("Of the catalogue.")]
    utilisation: Annotated[
        Floats,
        About(
            "Of every check of `CHECKS`; NaN where it is not known, 0 where nothing is limited.",
            "(checks, motors, gearboxes)",
        ),
    ]
    order: Annotated[
        np.ndarray,
        About(
            "Places of motor and gearbox of the pairs that pass, by the goal, then by their utilisation.",
            "(passing, 2)",
        ),
    ]
    cycle: Annotated[DriverCycle, About("At the driver.")]
    starts: Annotated[Mapping[str, DriverCycle], About("The same while the master starts or stops.")]
    coupling: Annotated[float, About("Inertia at the motor shaft [kg m²].")]
    inertia_ratio: Annotated[float, About("At most permitted.")]

    @property
    def passes(self) -> Annotated[np.ndarray, About("True for a pair that passes.", "(motors, gearboxes)")]:
        """Whether each pair passes all checks."""
        return np.asarray(np.all(self.utilisation <= 1 + _ROUNDED, axis=0))

    def duty(self, motor: int, gearbox: int) -> MotorDuty:
        """The duty of a pair over the cycle, with all its checks."""

        def over(cycle: DriverCycle) -> MotorDuty:
            return motor_duty(
                cycle,
                self.motors[motor].motor,
                self.gearboxes[gearbox].gearbox,
                coupling=self.coupling,
                inertia_ratio=self.inertia_ratio,
            )

        duty = over(self.cycle)
        started = (check for when, cycle in self.starts.items() for check in start_checks(over(cycle), when))
        return replace(duty, checks=(*duty.checks, *started))

    def reasons(self, motor: int, gearbox: int) -> tuple[str, ...]:
        """Why a pair is refused, each reason in words; none if it passes."""
        return tuple(check.words for check in self.duty(motor, gearbox).failed)

    @property
    def refused(self) -> dict[str, int]:
        """Pairs that each check refuses, or cannot judge."""
        failed = ~(self.utilisation <= 1 + _ROUNDED)
        return {name: int(np.sum(fails)) for name, fails in zip(CHECKS, failed, strict=True) if np.any(fails)}

    @property
    def nearest(self) -> tuple[int, int]:
        """The pair of the smallest maximum utilisation: the chosen ones aside, what comes nearest."""
        worst = np.max(np.where(np.isnan(self.utilisation), np.inf, self.utilisation), axis=0)
        place = np.unravel_index(np.argmin(worst), worst.shape)
        return int(place[0]), int(place[1])

    def best_gearboxes(self) -> Iterator[tuple[int, int]]:
        """For each motor, in their order, its best gearbox that passes, or the one that comes nearest."""
        first: dict[int, int] = {}
        for motor, gearbox in self.order.tolist():
            first.setdefault(motor, gearbox)
        worst = np.max(np.where(np.isnan(self.utilisation), np.inf, self.utilisation), axis=0)
        for motor in range(len(self.motors)):
            yield motor, first.get(motor, int(np.argmin(worst[motor])))

    def to_dict(self, *, curves: bool = False, most: int = 20) -> dict[str, Any]:
        """The first pairs, what refuses others, and if none passes the one that comes nearest.

        `curves`: with speed and torque of these; `most`: pairs.
        """
        pairs = self.order[:most].tolist() or [self.nearest]
        return {
            "goal": self.goal,
            "pairs": len(self.motors) * len(self.gearboxes),
            "passing": len(self.order),
            "refused": self.refused,
            "chosen" if len(self.order) else "nearest": [
                self._pair(motor, gearbox, curves) for motor, gearbox in pairs
            ],
        }

    def _pair(self, motor: int, gearbox: int, curves: bool) -> dict[str, Any]:
        servo, gears, duty = self.motors[motor], self.gearboxes[gearbox], self.duty(motor, gearbox)
        return {
            "motor": servo.type,
            "gearbox": gears.type,
            "ratio": gears.gearbox.ratio,
            "power_rated": servo.power_rated,
            "cost": _cost(servo, gears),
            **duty.to_dict(curves=curves),
        }


def _cost(servo: CatalogueServo, gears: CatalogueGearbox) -> float | None:
    return None if servo.cost is None or gears.cost is None else servo.cost + gears.cost


@public
def choose_servo(
    cycle: DriverCycle,
    motors: Sequence[CatalogueServo],
    gearboxes: Sequence[CatalogueGearbox],
    *,
    goal: Goal = "power",
    starts: Mapping[str, DriverCycle] = _NO_STARTS,
    coupling: float = 0.0,
    inertia_ratio: float = INERTIA_RATIO,
) -> ServoChoice:
    """Judge every servo motor with every gearbox for an axis, and sort what passes.

    Parameters
    ----------
    cycle : DriverCycle
        Speed and torque at the driver over a cycle.
    motors, gearboxes : sequence
        Of catalogues, such as those of `read_servo_motors` and `read_gearboxes`.
    goal : str
        The lowest comes first: ``"cost"`` of motor and gearbox, rated ``"power"``, ``"inertia"`` of the
        rotor, or ``"rms"``, the utilisation of the continuous torque.
    starts : mapping
        The same while the master starts or stops, as in ``ServoAxis.starts``.
    coupling : float
        Inertia of a coupling at the motor shaft [kg m²].
    inertia_ratio : float
        Inertia that the rotor drives over its own, at most permitted [–].

    Returns
    -------
    ServoChoice
        The pairs that pass, by the goal, and the utilisation of every check of every pair.

    Raises
    ------
    InputError
        No motors or gearboxes; a driver along a line without the travel per revolution; or the goal needs a
        column that a catalogue does not have.
    """
    in_range(coupling=(coupling, not_negative(INERTIA)), inertia_ratio=(inertia_ratio, positive(RATIO)))
    servos, gears = tuple(motors), tuple(gearboxes)
    if not servos or not gears:
        raise InputError(f"{'gearboxes' if servos else 'motors'}: found none to choose from")
    if not cycle.turns:
        raise InputError(
            "gearbox: found a driver along a line without per_turn, expected its travel per revolution of "
            "the gearbox output: screw lead, pulley circumference"
        )
    used = _utilisations(cycle.divided(), servos, gears, coupling, inertia_ratio)
    for start in starts.values():
        of_start = _utilisations(start.divided(), servos, gears, coupling, inertia_ratio)
        used[_OF_STARTS] = np.maximum(used[_OF_STARTS], of_start[_OF_STARTS])
    value = _values(goal, servos, gears, used)
    worst = np.max(np.nan_to_num(used, nan=np.inf), axis=0)
    passing = np.argwhere(worst <= 1 + _ROUNDED)
    ranks = np.lexsort((worst[tuple(passing.T)], value[tuple(passing.T)]))
    return ServoChoice(goal, servos, gears, used, passing[ranks], cycle, starts, coupling, inertia_ratio)


def _values(
    goal: Goal, servos: Sequence[CatalogueServo], gears: Sequence[CatalogueGearbox], used: Floats
) -> Floats:
    """The criterion of every pair."""
    if goal == "rms":
        return np.asarray(used[CHECKS.index("torque_rms")])
    if goal == "inertia":
        own = np.array([servo.motor.rotor for servo in servos])
    else:
        own = _column(servos, "cost" if goal == "cost" else "power_rated", "motors")
    other = _column(gears, "cost", "gearboxes") if goal == "cost" else np.zeros(len(gears))
    return own[:, None] + other[None, :]


def _column(parts: Sequence[Any], name: str, noun: str) -> Floats:
    """A column that the goal needs of all types."""
    lacking = next((part.type for part in parts if getattr(part, name) is None), None)
    if lacking is not None:
        raise InputError(f"{noun}: {lacking} has no {name}; add a column {name}, or choose another goal")
    return np.array([getattr(part, name) for part in parts])


def _utilisations(
    cycle: DriverCycle,
    servos: Sequence[CatalogueServo],
    gears: Sequence[CatalogueGearbox],
    coupling: float,
    inertia_ratio: float,
) -> Floats:
    """Utilisation of every check of every pair: (checks, motors, gearboxes)."""
    rotor = np.array([servo.motor.rotor for servo in servos])
    top = np.array([servo.motor.top_speed or np.nan for servo in servos])
    means = cycle.weights() / cycle.period
    speed_mean = float(means @ np.abs(cycle.speed))
    speed_peak = Peak(cycle.time, np.abs(cycle.speed), "max").value
    torque_peak = float(np.max(np.abs(cycle.torque)))
    torque_rms = float(np.sqrt(means @ cycle.torque**2))
    ratios = np.array([each.gearbox.ratio for each in gears])
    continuous = np.array([_beyond(servo.motor.continuous, speed_mean * ratios) for servo in servos])
    peaks = _Peaks(cycle, servos, rotor)
    used = np.zeros((len(CHECKS), len(servos), len(gears)))
    with np.errstate(divide="ignore", invalid="ignore"):
        for nth, each in enumerate(gears):
            gearbox = each.gearbox
            _, acceleration, load = geared = cycle.geared(gearbox)
            extra = coupling + gearbox.inertia
            inertia = rotor + extra
            squares = (means @ (acceleration * other) for other in (acceleration, load))
            square, mixed = squares
            rms = np.sqrt(np.maximum(inertia**2 * square + 2 * inertia * mixed + means @ load**2, 0.0))
            referred = np.nan if cycle.inertia is None else cycle.inertia / gearbox.ratio**2
            used[:4, :, nth] = (
                speed_peak * gearbox.ratio / top,
                np.where(rms > 0, rms / continuous[:, nth], 0.0),
                peaks.utilisation(geared, extra),
                (referred + extra) / rotor / inertia_ratio,
            )
            used[4:, :, nth] = [
                [value / limit if limit is not None else 0.0]
                for value, limit in (
                    (torque_peak, gearbox.torque_max),
                    (torque_rms, gearbox.torque_rated),
                    (speed_peak * gearbox.ratio, gearbox.speed_max),
                )
            ]
    return used


def _beyond(curve: TorqueCurve | None, speeds: Floats) -> Floats:
    """The torque of a curve at some speeds, NaN beyond its end."""
    if curve is None:
        return np.full(len(speeds), np.nan)
    torque = np.interp(speeds, curve.speed, curve.torque)
    return np.where(speeds > curve.speed[-1] * (1 + _ROUNDED), np.nan, torque)


class _Peaks:
    """The loops of all motors against their peak curves."""

    def __init__(self, cycle: DriverCycle, servos: Sequence[CatalogueServo], rotor: Floats) -> None:
        # Samples from the fastest to the slowest, whatever the ratio.
        self.order = np.argsort(-np.abs(cycle.speed), kind="stable")
        curves = [servo.motor.peak for servo in servos]
        points = max((len(curve.speed) for curve in curves if curve is not None), default=2)
        self.known = np.array([curve is not None for curve in curves])
        # Short curves go on level, over no width, at their ends.
        padded = [_padded(curve, points) for curve in curves]
        self.speed = np.array([speed for speed, _ in padded])
        self.torque = np.array([torque for _, torque in padded])
        self.rotor = rotor
        by_size = np.argsort(rotor, kind="stable")
        self.groups: list[Any] = []
        first = 0
        for place in range(1, len(rotor) + 1):
            least = rotor[by_size[first]]
            if place == len(rotor) or rotor[by_size[place]] > _SPREAD * least:
                self.groups.append(by_size[first:place])
                first = place

    def utilisation(self, geared: tuple[Floats, Floats, Floats], extra: float) -> Floats:
        """Largest share of the peak torque that each motor gives; NaN where its curve ends before."""
        speed, acceleration, load = (column[self.order] for column in geared)
        speed, found = np.abs(speed), np.empty(len(self.rotor))
        for group in self.groups:
            inertia = self.rotor[group] + extra
            keep = _outer(inertia[0] * acceleration + load, inertia[-1] * acceleration + load)
            torque = np.abs(inertia[:, None] * acceleration[keep] + load[keep])
            limit = self._limits(group, speed[keep])
            share = np.max(np.where(torque > 0, torque / limit, 0.0), axis=1, initial=0.0)
            beyond = speed[0] > self.speed[group, -1] * (1 + _ROUNDED)
            found[group] = np.where(beyond | ~self.known[group], np.nan, share)
        return found

    def _limits(self, group: Floats, speed: Floats) -> Floats:
        """Peak torque of the motors of a group at some speeds: (motors, speeds)."""
        ends, torques = self.speed[group], self.torque[group]
        widths = np.diff(ends, axis=1)
        slopes = np.divide(np.diff(torques, axis=1), widths, out=np.zeros_like(widths), where=widths > 0)
        limit = np.repeat(torques[:, :1], len(speed), axis=1)
        for nth in range(widths.shape[1]):
            if np.any(slopes[:, nth]):
                over = np.clip(speed - ends[:, nth, None], 0.0, widths[:, nth, None])
                limit += slopes[:, nth, None] * over
        return limit


def _padded(curve: TorqueCurve | None, points: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Speeds and torques of a curve, its last point repeated up to a number of points."""
    if curve is None:
        return (0.0,) * points, (np.nan,) * points
    more = points - len(curve.speed)
    return (*curve.speed, *curve.speed[-1:] * more), (*curve.torque, *curve.torque[-1:] * more)


def _outer(one: Floats, other: Floats) -> np.ndarray:
    """Places of samples, the fastest first, that no faster one outdoes for any inertia between two.

    `one`, `other`: torques with the smallest and the largest inertia; with those between they lie between.
    """
    sizes = np.abs(one), np.abs(other)
    most = np.maximum(*sizes)
    least = np.where(one * other < 0, 0.0, np.minimum(*sizes))
    outdone = np.maximum.accumulate(least)
    return np.flatnonzero(most > np.concatenate([[-1.0], outdone[:-1]]))
