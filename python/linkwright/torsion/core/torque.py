r"""Torques on the discs of a train from outside, for its motion in time.

.. math:: M = s\,w(t)\,g(\omega, t)\,f(p\theta + \beta)

with θ and ω of the disc: a scale, a weight over time that events switch, a law of speed or time, a shape
over the angle.

The torque of a generator in a short circuit follows from the flux that stays in its windings. In per unit of
its apparent power over its speed, without load before, and for the worst instant of switching,

.. math:: M_3 = \frac{1}{x''}\sin\omega t, \qquad
    M_2 = \frac{1}{x''}\left(\sin\omega t - \tfrac12\sin 2\omega t\right)

for three phases and for two, with the subtransient reactance :math:`x''`, both decaying. The maximum of M_2
is :math:`\tfrac34\sqrt3/x''`, at a third of a period.

References
----------
.. [1] Concordia, Synchronous Machines: Theory and Performance, 1951, chapter 7: torque in short circuits from
   constant flux linkages.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from linkwright.drive.model.drive import Drive, Gearbox
from linkwright.drive.model.motor import Motor
from linkwright.kernel.core.curve import Curve, smooth, straight
from linkwright.kernel.core.periodic_table import PeriodicTable
from linkwright.linkages.model.element import Crank
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import CompiledMachine, compile_machine


@dataclass(frozen=True)
class Power:
    """A power of the speed."""

    speed: float  # ω₀, at which the law is 1 [rad/s]
    exponent: float  # p
    # (ω/ω₀)ᵖ the same in both senses, or with the sign of the speed, as resistance has it.
    is_even: bool = False


@dataclass(frozen=True)
class OverSpeed:
    """A curve over the speed of the disc, such as a motor's characteristic."""

    curve: Curve  # torque [N m] over speed [rad/s]


@dataclass(frozen=True)
class GovernorTorque:
    """A torque in proportion to the missing speed: a governor, or a test bench that leads the speed."""

    gain: float  # [N m s/rad]
    curve: Curve  # speed wanted [rad/s] over time [s]


@dataclass(frozen=True)
class DecayingTorque:
    """A sine that decays."""

    # `start`, `end`: between these times [s].
    start: float
    end: float
    rate: float  # of the decay, one over its time constant [1/s]
    # `speed`, `phase`: angular frequency [rad/s] and phase [rad] of the sine.
    speed: float
    phase: float = 0.0


Law = Power | OverSpeed | GovernorTorque | DecayingTorque


@dataclass(frozen=True)
class TrainTorque:
    """A torque on a disc, positive if it drives."""

    name: str  # by which events and results speak of it
    on: int  # disc
    scale: float = 1.0  # torque where the law and the shape are 1 [N m]
    law: Law | None = None  # how it depends on speed or time; None for not at all
    shape: PeriodicTable | None = None  # how it depends on the angle; None for not at all
    # `pitch`, `phase`: angle of the table over that of the disc, and angle of the table where that of the
    # disc is zero [rad].
    pitch: float = 1.0
    phase: float = 0.0
    weight: Curve | None = None  # factor over time; None for 1


def short_circuit(
    name: str,
    on: int,
    *,
    torque: float,
    reactance: float,
    speed: float,
    decay: float,
    phases: int = 3,
    start: float = 0.0,
    end: float = np.inf,
) -> tuple[TrainTorque, ...]:
    """Torque of a generator whose terminals are short-circuited.

    One for three phases; two, of the simple and of the double frequency, for two. `torque`: apparent power
    over its speed [N m]; `speed`: [rad/s]; `decay`: time constant of the torque [s]; `start`, `end`: when it
    begins and is cleared [s]. All of the torque decays with one time constant, that of its part of mains
    frequency; the part of double frequency lasts longer in reality, but passes most trains unfelt.
    """
    size = -torque / reactance
    first = DecayingTorque(start, end, 1.0 / decay, speed)
    simple = TrainTorque(name, on, size, first)
    if phases == 3:
        return (simple,)
    return simple, TrainTorque(name, on, -0.5 * size, replace(first, speed=2 * speed))


# Points up to twice the synchronous speed: a hundred of them in the narrowest breakdown slip, so that cubics
# between them err by less than 1e-6.
_POINTS = 4001


def motor_curve(motor: Motor) -> Curve:
    """Torque [N m] over speed [rad/s]; of induction motors held below rest and beyond twice synchronous."""
    line = motor.polyline()
    if line is not None:
        return straight(*line[:2], beyond="straight" if line[2] else "held")
    assert motor.speed_without_load is not None
    speeds = np.linspace(0.0, 2 * motor.speed_without_load, _POINTS)
    torque = motor_program(motor).motor_torques(speeds).motor
    return smooth(speeds, torque, np.gradient(torque, speeds, edge_order=2), beyond="held")


def motor_program(motor: Motor, ratio: float = 1.0) -> CompiledMachine:
    """A machine with nothing but a motor and gears in the core's terms, for the core's own torque."""
    return compile_machine(motor_machine(motor, ratio))


def motor_machine(motor: Motor, ratio: float = 1.0) -> Machine:
    """A machine with nothing but a motor and gears."""
    return Machine(
        format=1,
        name="motor",
        drive=Drive(motor=motor, gearbox=Gearbox(ratio=ratio)),
        mechanism=Mechanism(cranks={"A": Crank(radius=1.0)}),
    )
