r"""Which ratios are feasible for a motor: accelerating factor and load factor.

With :math:`\dot\omega` and :math:`M_L` at the driver, losses of the gears included, and
:math:`\tau = 1/i`, the mean square torque of the motor is

.. math:: M_{rms}^2 = J_M^2\,\dot\omega_{rms}^2/\tau^2 + 2 J_M\,\overline{\dot\omega M_L} + \tau^2 M_{L,rms}^2

Its minimum, :math:`J_M\,\beta`, is at :math:`\tau^2 = J_M\,\dot\omega_{rms}/M_{L,rms}`, with the load factor
:math:`\beta = 2(\dot\omega_{rms} M_{L,rms} + \overline{\dot\omega M_L})`. A motor of the continuous torque
:math:`M_N` is therefore possible only if its accelerating factor :math:`\alpha = M_N^2/J_M` is at least
:math:`\beta`; the ratio then lies between the roots of a biquadratic equation.

Source: Giberti, Cinquemani, Legnani, *Effects of transmission mechanical characteristics on the choice of a
motor-reducer*, Mechatronics 20 (2010).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.axes.driver_cycle import DriverCycle
from linkwright.axes.model.axis_catalogue import CatalogueServo
from linkwright.axes.model.axis_gearbox import AxisGearbox
from linkwright.axes.model.servo_motor import ServoMotor
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result


@dataclass(frozen=True)
class LoadFactor(Result):
    """What an axis asks of any motor, whatever its ratio."""

    load_factor: Annotated[float, Label("load factor", "β", "W/s")]
    acceleration_rms: Annotated[float, Label("root mean square acceleration at the driver", "", "rad/s²")]
    torque_rms: Annotated[
        float, Label("root mean square torque at the driver", "M_L,rms", "N m", "With losses of the gears.")
    ]
    product_mean: Annotated[float, Label("mean of acceleration times torque", "", "W/s")]
    speed_mean: Annotated[float, Label("mean absolute speed of the driver", "", "rad/s")]
    speed_peak: Annotated[float, Label("peak absolute speed of the driver", "ω_max", "rad/s")]

    def torque_at_motor(self, inertia: float, ratio: float) -> float:
        """Root mean square torque of a motor with a ratio of its gearbox [N m]."""
        own, load = inertia * ratio * self.acceleration_rms, self.torque_rms / ratio
        return math.sqrt(max(own * own + 2 * inertia * self.product_mean + load * load, 0.0))


@dataclass(frozen=True)
class RatioRange(Result):
    """The ratios with which a motor bears the torque of an axis in continuous operation."""

    type: Annotated[str, About("Of the motor.")]
    inertia: Annotated[float, Label("inertia at the motor shaft", "J_M", "kg m²")]
    torque_continuous: Annotated[
        float | None,
        Label(
            "continuous torque", "M_N", "N m", "At the mean speed with the best ratio; None without a curve."
        ),
    ]
    accelerating_factor: Annotated[float | None, Label("accelerating factor", "α", "W/s")]
    ratio_best: Annotated[
        float | None,
        Label("best ratio", "i", "", "Of minimum root mean square torque within the speeds of the motor."),
    ]
    torque_rms_best: Annotated[float | None, Label("root mean square torque with the best ratio", "", "N m")]
    ratio_min: Annotated[float | None, Label("minimum ratio", "", "", "None if no ratio is feasible.")]
    ratio_max: Annotated[float | None, Label("maximum ratio", "", "", "Also by the maximum speed.")]

    @property
    def feasible(self) -> bool:
        """Whether any ratio is feasible."""
        return self.ratio_min is not None


def load_factor(cycle: DriverCycle, gearbox: AxisGearbox | None = None) -> LoadFactor:
    """What a cycle at a driver asks of any motor; `gearbox`: whose efficiency counts, whatever its ratio."""
    gears = (gearbox or AxisGearbox()).with_entries({"ratio": 1.0})
    cycle = cycle.divided()
    _, acceleration, load = cycle.geared(gears)
    means = cycle.weights() / cycle.period
    rms, torque = (math.sqrt(max(float(means @ x**2), 0.0)) for x in (acceleration, load))
    product = float(means @ (acceleration * load))
    speed = np.abs(cycle.speed)
    return LoadFactor(
        2 * (rms * torque + product), rms, torque, product, float(means @ speed), float(np.max(speed))
    )


def ratio_range(load: LoadFactor, motor: ServoMotor, *, type: str = "", extra: float = 0.0) -> RatioRange:
    """The ratios that are feasible for a motor; `extra`: inertia beside the rotor at its shaft [kg m²]."""
    inertia = motor.rotor + extra
    best: float | None
    top = _top_ratio(load, motor)
    accelerating = inertia * load.acceleration_rms
    # Without inertia to accelerate the highest ratio is best.
    best = min(math.sqrt(load.torque_rms / accelerating) if accelerating > 0 else math.inf, top)
    if not 0 < best < math.inf:
        best = None
    curve = motor.continuous
    torque = None if curve is None or best is None else curve.at(load.speed_mean * best)
    least = load.torque_at_motor(inertia, best) if best is not None else None
    factor = torque * torque / inertia if torque is not None and inertia > 0 else None
    low, high = _roots(load, inertia, torque)
    high = None if high is None else min(high, top)
    feasible = low is not None and high is not None and low <= high
    return RatioRange(
        type or motor.type or "",
        inertia,
        torque,
        factor,
        best,
        least,
        low if feasible else None,
        high if feasible else None,
    )


def ratio_ranges(
    load: LoadFactor, motors: Sequence[CatalogueServo], *, extra: float = 0.0
) -> tuple[RatioRange, ...]:
    """The feasible ratios of all motors of a catalogue."""
    return tuple(ratio_range(load, servo.motor, type=servo.type, extra=extra) for servo in motors)


def _top_ratio(load: LoadFactor, motor: ServoMotor) -> float:
    """Ratio with which the motor reaches its maximum speed, or its mean speed the end of the S1 curve."""
    speeds = (
        (motor.top_speed, load.speed_peak),
        (
            motor.continuous.speed[-1] if motor.continuous else None,
            load.speed_mean,
        ),
    )
    return min((top / speed for top, speed in speeds if top is not None and speed > 0), default=math.inf)


def _roots(load: LoadFactor, inertia: float, torque: float | None) -> tuple[float | None, float | None]:
    """Between which ratios the root mean square torque is at most the continuous torque.

    With x = i²: J² ω̇_rms² x² − (M_N² − 2 J mean(ω̇ M_L)) x + M_L,rms² ≤ 0.
    """
    if torque is None:
        return None, None
    square, rest = (inertia * load.acceleration_rms) ** 2, load.torque_rms**2
    middle = torque * torque - 2 * inertia * load.product_mean
    under = middle * middle - 4 * square * rest
    if middle <= 0 or under < 0:
        return None, None
    # The stable form: no difference of nearly equal numbers.
    greater = 0.5 * (middle + math.sqrt(under))
    return math.sqrt(rest / greater), math.sqrt(greater / square) if square > 0 else math.inf
