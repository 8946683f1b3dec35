r"""What an axis asks of its motor over the cycle, and whether the motor stands it.

At the motor, with the ratio :math:`i`, the inertia :math:`J` of all that turns at the motor's speed, and the
torque :math:`M_L` at the driver,

.. math:: \omega_m = i\,\omega, \qquad
   M_m = J\,\dot\omega_m + \frac{M_L}{i}\,\eta^{-\operatorname{sign}(M_L\omega)}

where losses go the way that the power goes through the gears; at rest they do not count. A driver that moves
along a line is referred to the pinion or screw that moves it first.

Means over time are exact for a law of pieces: each piece is integrated for itself, with cubics through
neighbouring samples, and is divided where the power changes its sign and the losses jump.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any, Self

import numpy as np

from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor, TorqueCurve
from linkwright.kernel.arrays import Floats
from linkwright.kernel.check import Check
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.machine.program.drive_line import reverse_factor

# Inertia of the load over that of the rotor up to which servo drives are usually well controlled: a rule of
# thumb of makers of servo motors.
INERTIA_RATIO = 10.0

# Checks of a start or stop of the master, which has no root mean square.
OF_STARTS = ("speed", "torque_peak", "gearbox_torque_peak", "gearbox_speed")

# Share of the peak speed or torque below which a sample counts as rest, or as no load: rounding.
_REST = 1e-9

# A speed chosen at a limit meets it to rounding.
_ROUNDED = 1e-12


@dataclass(frozen=True)
class DriverCycle:
    """Speed and torque at a driver that turns, over one cycle; a time that occurs twice ends a piece.

    There, the first sample belongs to the piece before and the second to that behind, so that torques may
    jump.
    """

    time: Floats  # from 0, not decreasing [s]
    speed: Floats  # [rad/s]
    acceleration: Floats  # [rad/s²]
    torque: Floats  # that the drive gives to the driver; positive in the sense of the speed [N m]
    inertia: float | None = (
        None  # mean inertia of the mechanism at the driver; None if it is not known [kg m²]
    )
    turns: bool = True  # else along a line, in m/s, N and kg: no screw or pinion is known

    @classmethod
    def of_line(
        cls,
        time: Floats,
        velocity: Floats,
        acceleration: Floats,
        force: Floats,
        per_turn: float,
        mass: float | None = None,
    ) -> Self:
        """Of a driver that moves along a line by `per_turn` [m] per revolution of its screw or pinion.

        `mass`: mean mass of the mechanism at the driver [kg].
        """
        lead = per_turn / (2 * math.pi)
        inertia = None if mass is None else mass * lead * lead
        return cls(time, velocity / lead, acceleration / lead, force * lead, inertia)

    @property
    def period(self) -> float:
        """Time of a cycle [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def power_sign(self) -> Floats:
        """1 where the drive drives the mechanism, −1 where the mechanism drives it, 0 at rest."""
        return np.sign(_without_specks(self.speed)) * np.sign(_without_specks(self.torque))

    def divided(self) -> Self:
        """The same cycle with pieces that end where the power changes its sign.

        Between two samples the place is found on straight lines.
        """
        sign = self.power_sign
        before, behind = sign[:-1], sign[1:]
        columns = np.array([self.time, self.speed, self.acceleration, self.torque])
        at = np.flatnonzero((before * behind < 0) & (np.diff(self.time) > 0))
        turning = np.where(self.speed[at] * self.speed[at + 1] < 0, 1, 3)
        first, last = columns[turning, at], columns[turning, at + 1]
        share = first / (first - last)
        crossing = columns[:, at] + share * (columns[:, at + 1] - columns[:, at])
        crossing[turning, np.arange(len(at))] = 0.0
        # A sample in which the power is zero between two of opposite sign ends a piece itself.
        inner = np.arange(1, len(sign) - 1)
        own = inner[(sign[inner] == 0) & (sign[inner - 1] * sign[inner + 1] < 0)]
        own = own[(np.diff(self.time)[own - 1] > 0) & (np.diff(self.time)[own] > 0)]
        places = np.concatenate([np.repeat(at + 1, 2), own])
        columns = np.insert(
            columns, places, np.hstack([np.repeat(crossing, 2, axis=1), columns[:, own]]), axis=1
        )
        time, speed, acceleration, torque = columns
        return replace(self, time=time, speed=speed, acceleration=acceleration, torque=torque)

    def geared(self, gearbox: AxisGearbox) -> tuple[Floats, Floats, Floats]:
        """Speed and acceleration at the motor, and the torque there that the driver asks for.

        [rad/s, rad/s², N m]; of a cycle that is `divided`.
        """
        ratio, back = gearbox.ratio, float(reverse_factor(gearbox))
        sign = self._side_of_power()
        factor = np.where(sign > 0, 1 / gearbox.efficiency, np.where(sign < 0, 1 / back, 1.0))
        if gearbox.locks:
            factor = np.where(sign > 0, factor, 0.0)
        return self.speed * ratio, self.acceleration * ratio, self.torque / ratio * factor

    def _side_of_power(self) -> Floats:
        """The sign of the power about each sample: at an instant of rest, that of its neighbour."""
        sign, ends = self.power_sign, np.diff(self.time) == 0
        left = np.concatenate([[0.0], np.where(ends, 0.0, sign[:-1])])
        right = np.concatenate([np.where(ends, 0.0, sign[1:]), [0.0]])
        return np.where(sign == 0, np.where(right != 0, right, left), sign)

    def weights(self) -> Floats:
        """Weights of the samples in an integral over the time of a cycle [s]."""
        return integration_weights(self.time)


def _without_specks(values: Floats) -> Floats:
    """The values with zero for what is rounding beside the largest."""
    return np.where(np.abs(values) <= _REST * np.max(np.abs(values), initial=0.0), 0.0, values)


def integration_weights(time: Floats) -> Floats:
    """Weights of samples in an integral over time, each piece between equal times for itself.

    Over each interval the cubic through its four nearest samples of the piece is integrated.
    """
    weights = np.zeros(len(time))
    ends = np.flatnonzero(np.diff(time) == 0) + 1
    for first, last in zip([0, *ends], [*ends, len(time)], strict=True):
        n = last - first
        if n < 2:
            continue
        order = min(4, n)
        left = np.arange(n - 1)
        start = np.clip(left - 1, 0, n - order)
        stencil = first + start[:, None] + np.arange(order)
        width = np.diff(time[first:last])
        nodes = (time[stencil] - time[first + left][:, None]) / width[:, None]
        powers = np.arange(order)
        moments = np.broadcast_to(1 / (powers + 1), (n - 1, order))
        matrix = nodes[:, None, :] ** powers[None, :, None]
        share = np.linalg.solve(matrix, moments[:, :, None])[:, :, 0]
        np.add.at(weights, stencil, share * width[:, None])
    return weights


@dataclass(frozen=True)
class MotorDuty(Result):
    """Speed and torque of a servo motor over the cycle, what they mean for it, and the checks."""

    time: Annotated[Floats, Label("time", "t", "s")]
    speed: Annotated[Floats, Label("speed of the motor", "ω_m", "rad/s")]
    torque: Annotated[Floats, Label("torque of the motor", "M_m", "N m")]
    power: Annotated[Floats, Label("power at the motor shaft", "P_m", "W", "Negative while it brakes.")]
    torque_rms: Annotated[
        float, Label("root mean square torque of the motor", "M_m,rms", "N m", "With dwells.", table="axis")
    ]
    torque_peak: Annotated[float, Label("peak absolute torque of the motor", "M_m,max", "N m", table="axis")]
    speed_mean: Annotated[float, Label("mean absolute speed of the motor", "ω_m,mean", "rad/s", table="axis")]
    speed_peak: Annotated[float, Label("peak absolute speed of the motor", "ω_m,max", "rad/s", table="axis")]
    power_peak: Annotated[float, Label("peak power of the motor", "P_m,max", "W", table="axis")]
    power_braking_peak: Annotated[
        float, Label("peak braking power of the motor", "P_b,max", "W", table="axis")
    ]
    power_braking_mean: Annotated[
        float,
        Label(
            "mean braking power of the motor",
            "P_b,mean",
            "W",
            "That a brake resistor converts to heat where nothing else takes it.",
            table="axis",
        ),
    ]
    energy_regenerated: Annotated[
        float,
        Label(
            "regenerated energy per cycle",
            "E_reg",
            "J",
            "At the motor shaft; losses in the motor leave less of it.",
            table="axis",
        ),
    ]
    inertia_ratio: Annotated[
        float | None,
        Label(
            "inertia ratio",
            "J_L/J_M",
            "",
            "Mean inertia that the rotor drives, at its shaft, over its own.",
            table="axis",
        ),
    ]
    checks: Annotated[tuple[Check, ...], About("Against motor, gearbox and resistor.")]

    @property
    def failed(self) -> tuple[Check, ...]:
        """Checks that fail or cannot be made."""
        return tuple(check for check in self.checks if not check.passed)

    @property
    def passes(self) -> bool:
        """Whether all checks are made and passed."""
        return not self.failed

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars and checks by name, with ``curves`` also the arrays as lists."""
        tree, checks = super().to_dict(curves=curves), [check.to_dict() for check in self.checks]
        return tree | {"failed": [check.name for check in self.failed], "checks": checks}


def motor_duty(
    cycle: DriverCycle,
    motor: ServoMotor,
    gearbox: AxisGearbox | None = None,
    *,
    coupling: float = 0.0,
    inertia_ratio: float = INERTIA_RATIO,
    resistor: tuple[float | None, float | None] = (None, None),
) -> MotorDuty:
    """Refer a cycle to the motor and check the motor, its gearbox and its brake resistor.

    `coupling`: inertia at the motor shaft [kg m²]; `inertia_ratio`: at most permitted [–]; `resistor`: rated
    and maximum power of a brake resistor, None where it is not limited [W].
    """
    gearbox = gearbox or AxisGearbox()
    cycle = cycle.divided()
    speed, acceleration, load = cycle.geared(gearbox)
    own = motor.rotor
    at_motor = own + coupling + gearbox.inertia
    torque = at_motor * acceleration + load
    weights, period = cycle.weights(), cycle.period

    def mean(values: Floats) -> float:
        return float(weights @ values) / period

    power = torque * speed
    braking = np.maximum(-power, 0.0)
    others = None if cycle.inertia is None else cycle.inertia / gearbox.ratio**2 + at_motor - own
    duty = MotorDuty(
        time=cycle.time,
        speed=speed,
        torque=torque,
        power=power,
        torque_rms=math.sqrt(max(mean(torque**2), 0.0)),
        torque_peak=float(np.max(np.abs(torque))),
        speed_mean=mean(np.abs(speed)),
        speed_peak=float(np.max(np.abs(speed))),
        power_peak=float(np.max(np.maximum(power, 0.0))),
        power_braking_peak=float(np.max(braking)),
        power_braking_mean=max(mean(braking), 0.0),
        energy_regenerated=max(mean(braking), 0.0) * period,
        inertia_ratio=others / own if others is not None and own > 0 else None,
        checks=(),
    )
    checks = (
        *_motor_checks(duty, motor),
        _inertia_check(duty, cycle.inertia, inertia_ratio),
        *_gearbox_checks(
            duty, gearbox, float(np.max(np.abs(cycle.torque))), math.sqrt(mean(cycle.torque**2))
        ),
        *_resistor_checks(duty, resistor),
    )
    return MotorDuty(**{**vars(duty), "checks": checks})


def start_checks(duty: MotorDuty, when: str) -> Iterator[Check]:
    """Checks of a start or stop, each saying so, such as "while the master starts"."""
    for check in duty.checks:
        if check.name in OF_STARTS:
            yield replace(check, note=f"{check.note}, {when}" if check.note else when)


def _at_most(name: str, value: float, limit: float, unit: str, note: str = "") -> Check:
    passed = value <= limit * (1 + _ROUNDED)
    return Check(name, value, limit, unit, passed, at_most=True, note=note)


def _unknown(name: str, value: float | None, unit: str, why: str) -> Check:
    return Check(name, value, None, unit, None, at_most=True, note=f"not determined: {why}")


def _motor_checks(duty: MotorDuty, motor: ServoMotor) -> Iterator[Check]:
    """Top speed, effective torque at the mean speed, and the whole loop against the peak curve."""
    top = motor.top_speed
    if top is None:
        yield _unknown("speed", duty.speed_peak, "rad/s", "no maximum speed, speed_max")
    else:
        yield _at_most("speed", duty.speed_peak, top, "rad/s")
    yield _continuous_check(duty, motor.continuous)
    yield _peak_check(duty, motor.peak)


def _continuous_check(duty: MotorDuty, curve: TorqueCurve | None) -> Check:
    """Effective torque against the continuous torque at the mean speed."""
    mean = duty.speed_mean
    if curve is None:
        return _unknown("torque_rms", duty.torque_rms, "N m", "no continuous torque")
    if mean > curve.speed[-1] * (1 + _ROUNDED):
        end = curve.speed[-1]
        why = f"the curve of continuous torque ends at {end:.4g} rad/s, the mean speed is {mean:.4g} rad/s"
        return _unknown("torque_rms", duty.torque_rms, "N m", why)
    note = f"continuous torque at the mean speed, {mean:.4g} rad/s"
    return _at_most("torque_rms", duty.torque_rms, curve.at(mean), "N m", note)


def _peak_check(duty: MotorDuty, curve: TorqueCurve | None) -> Check:
    """The sample that comes nearest to the peak torque at its speed, in all four quadrants."""
    speed, torque = np.abs(duty.speed), np.abs(duty.torque)
    if curve is None:
        return _unknown("torque_peak", duty.torque_peak, "N m", "no peak torque")
    end, fastest = curve.speed[-1], float(np.max(speed))
    if fastest > end * (1 + _ROUNDED):
        why = f"the curve of peak torque ends at {end:.4g} rad/s, the motor reaches {fastest:.4g} rad/s"
        return _unknown("torque_peak", duty.torque_peak, "N m", why)
    limits = np.interp(speed, curve.speed, curve.torque)
    with np.errstate(divide="ignore", invalid="ignore"):
        worst = int(np.argmax(np.where(torque > 0, torque / limits, 0.0)))
    quadrant = "braking" if duty.power[worst] < 0 else "driving"
    note = f"peak torque at {speed[worst]:.4g} rad/s, {quadrant}, at {duty.time[worst]:.4g} s"
    return _at_most("torque_peak", float(torque[worst]), float(limits[worst]), "N m", note)


def _inertia_check(duty: MotorDuty, inertia: float | None, limit: float) -> Check:
    """Inertia that the rotor drives over its own."""
    if duty.inertia_ratio is None:
        why = "the inertia at the driver is not known" if inertia is None else "no inertia of the rotor"
        return _unknown("inertia_ratio", None, "", why)
    return _at_most("inertia_ratio", duty.inertia_ratio, limit, "")


def _gearbox_checks(duty: MotorDuty, gearbox: AxisGearbox, peak: float, rms: float) -> Iterator[Check]:
    """What the gearbox permits, as far as it says so."""
    if gearbox.torque_max is not None:
        yield _at_most("gearbox_torque_peak", peak, gearbox.torque_max, "N m")
    if gearbox.torque_rated is not None:
        yield _at_most("gearbox_torque_rms", rms, gearbox.torque_rated, "N m")
    if gearbox.speed_max is not None:
        yield _at_most("gearbox_speed", duty.speed_peak, gearbox.speed_max, "rad/s")


def _resistor_checks(duty: MotorDuty, resistor: tuple[float | None, float | None]) -> Iterator[Check]:
    """What the brake resistor of an axis by itself converts to heat."""
    rated, most = resistor
    if rated is not None:
        yield _at_most("resistor_power_mean", duty.power_braking_mean, rated, "W")
    if most is not None:
        yield _at_most("resistor_power_peak", duty.power_braking_peak, most, "W")
