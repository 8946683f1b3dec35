r"""What an axis asks of its motor over the cycle, and whether the motor stands it.

At the motor, with the ratio :math:`i`, the inertia :math:`J` of all that turns at the motor's speed, and the
torque :math:`M_L` at the driver,

.. math:: \omega_m = i\,\omega, \qquad
   M_m = J\,\dot\omega_m + \frac{M_L}{i}\,\eta^{-\operatorname{sign}(M_L\omega)}

where losses go the way that the power goes through the gears; at rest they do not count. A driver that moves
along a line is referred to the pinion or screw that moves it first.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.axes.driver_cycle import DriverCycle, Peak, integration_weights, sign_changes
from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor, TorqueCurve
from linkwright.kernel.arrays import Floats
from linkwright.kernel.check import Check
from linkwright.kernel.numerics.tangent import primal, sqrt
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result

# Inertia of the load over that of the rotor up to which servo drives are usually well controlled: a rule of
# thumb of makers of servo motors.
INERTIA_RATIO = 10.0

# Checks of a start or stop of the master, which has no root mean square.
OF_STARTS = ("speed", "torque_peak", "gearbox_torque_peak", "gearbox_speed")

# A speed chosen at a limit meets it to rounding.
_ROUNDED = 1e-12


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


class Numbers(NamedTuple):
    """Quantities by the attribute of a result, in any number."""

    means: dict[str, Any]
    peaks: dict[str, Peak]


class MotorCourse(NamedTuple):
    """What a cycle asks of a motor, in any number."""

    time: Any
    speed: Any
    torque: Any
    power: Any
    means: dict[str, Any]  # means over time by the attribute of `MotorDuty`
    peaks: dict[str, Peak]
    inertia_ratio: Any


def motor_torque(cycle: DriverCycle, at_motor: Any, gearbox: AxisGearbox) -> tuple[Any, Any]:
    """Speed and torque of a motor over a cycle that is `divided`; `at_motor` as in `motor_course`."""
    speed, acceleration, load = cycle.geared(gearbox)
    return speed, at_motor * acceleration + load


def motor_course(cycle: DriverCycle, at_motor: Any, rotor: Any, gearbox: AxisGearbox) -> MotorCourse:
    """Speed and torque of a motor over a cycle that is `divided`.

    `at_motor`: inertia of all that turns at the motor's speed; `rotor`: that of the motor alone [kg m²].
    """
    speed, torque = motor_torque(cycle, at_motor, gearbox)
    power = torque * speed
    weights, regenerated = cycle.weights(), energy_back(cycle.time, power)
    others = None if cycle.inertia is None else cycle.inertia / gearbox.ratio**2 + at_motor - rotor
    means = {
        "torque_rms": root_mean_square(weights, torque, cycle.period),
        "speed_mean": np.sum(weights * _size(speed)) / cycle.period,
        "power_braking_mean": regenerated / cycle.period,
        "energy_regenerated": regenerated,
    }
    peaks = {
        "torque_peak": Peak(cycle.time, _size(torque), "max"),
        "speed_peak": Peak(cycle.time, _size(speed), "max"),
        "power_peak": Peak(cycle.time, power, "max"),
        "power_braking_peak": Peak(cycle.time, -power, "max"),
    }
    ratio = others / rotor if others is not None and rotor > 0 else None
    return MotorCourse(cycle.time, speed, torque, power, means, peaks, ratio)


def root_mean_square(weights: Any, values: Any, period: Any) -> Any:
    """Root of the mean square over a cycle; weights of rounding may make it negative."""
    return sqrt(max(np.sum(weights * values**2) / period, 0.0))


def energy_back(time: Any, power: Any) -> Any:
    """Energy [J] while a power is negative; pieces are divided where it changes its sign."""
    time, power = sign_changes(time, power).among([time, power])
    return np.sum(integration_weights(time) * positive_part(-power))


def positive_part(values: Any) -> Any:
    """The values, and zero where they are negative."""
    return np.where(primal(values) > 0, values, 0.0 * values)


def _size(values: Any) -> Any:
    """The values without their signs; what rests has no derivative to lose."""
    return np.sign(primal(values)) * values


def inertia_at_motor(motor: ServoMotor, gearbox: AxisGearbox, coupling: Any) -> Any:
    """Inertia of all that turns at the motor's speed [kg m²]."""
    return motor.rotor + coupling + gearbox.inertia


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
    course = motor_course(cycle, inertia_at_motor(motor, gearbox, coupling), motor.rotor, gearbox)
    duty = MotorDuty(
        time=course.time,
        speed=course.speed,
        torque=course.torque,
        power=course.power,
        inertia_ratio=course.inertia_ratio,
        checks=(),
        **{name: float(mean) for name, mean in course.means.items()},
        **{name: peak.value for name, peak in course.peaks.items()},
    )
    torque = np.abs(cycle.torque)
    output = float(torque.max()), root_mean_square(cycle.weights(), torque, cycle.period)
    checks = (
        *_motor_checks(duty, motor),
        _inertia_check(duty, cycle.inertia, inertia_ratio),
        *_gearbox_checks(duty, gearbox, *output),
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
