r"""Torques on a train from outside: what it drives, what drives it, and what makes it pulsate.

A load resists with :math:`M = M_0 (\omega/\omega_0)^p`, ω the speed of its disc: p = 2 for propellers and
fans, 1 for viscous drag, 0 for pumps of constant stroke, −1 for a generator at constant power. Its vibration
is damped by the slope,

.. math:: c = \frac{dM}{d\omega} = p\,\frac{M}{\omega}

Pulsating torques are :math:`\sum M_\nu \cos(\nu\varphi + 2\pi f t + \beta_\nu)`, φ the angle of the disc,
ν the order, f a fixed frequency, as electrical machines have it: lines at the supply frequency and its
double, and interharmonics of an inverter, :math:`k f_1 \pm n f_2`, with the :math:`f_1 = p\Omega/2\pi` of
p pole pairs and the fixed :math:`f_2`.

Engines of one kind or several, turbines and motors drive, each with its part of the power. Mean torques
balance: with the resistance R and what is given as torques G, both referred to the first disc,
the other drivers give the rest by their shares,

.. math:: n_d M_d = \frac{s_d}{\sum s}\,(R - G)

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963: propellers and pumps.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.limits import HARMONICS, ORDER
from linkwright.kernel.units.kinds import (
    COUNT,
    FREQUENCY,
    RATIO,
    TIME,
    TORQUE,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
)
from linkwright.kernel.units.marks import Angle, Bound, Quantity, QuantityList, Speeds, not_negative, positive
from linkwright.torsion.model.engine.engine import ReciprocatingEngine
from linkwright.torsion.model.train_base import PositiveSpeed, PositiveTorque

# Beyond any law of a torque over the speed; powers of it stay numbers.
_STEEPEST = 10.0
Exponent = Annotated[
    float,
    Quantity(
        COUNT,
        Bound(
            f" between −{_STEEPEST:.0f} and {_STEEPEST:.0f},",
            {"minimum": -_STEEPEST, "maximum": _STEEPEST},
            lambda value: abs(value) <= _STEEPEST,
        ),
    ),
]


Order = Annotated[
    float,
    Quantity(
        COUNT,
        Bound(
            f" from {1 / ORDER.most:g} to {ORDER.most},",
            {"minimum": 1 / ORDER.most, "maximum": ORDER.most},
            lambda value: 1 / ORDER.most <= value <= ORDER.most,
        ),
    ),
]


class LoadHarmonic(Description):
    """A pulsation of a load."""

    order: Order = Field(
        description="Order: cycles per revolution of the disc; for a propeller, the number of blades."
    )
    share: Annotated[float, not_negative(RATIO)] = Field(
        description="Ratio of the amplitude to the mean torque."
    )
    phase: Angle = Field(0.0, description="Phase β of the load torque cos(νφ + β), with the disc angle φ.")


class TrainLoad(CheckedDescription):
    """What a disc drives: a propeller, a pump, a generator, a brake."""

    on: str = Field(description="Disc that drives the load.")
    torque: PositiveTorque = Field(description="Mean load torque at the given speed.")
    speed: PositiveSpeed = Field(description="Speed of the disc at which the torque is given.")
    exponent: Exponent = Field(
        2.0, description="Exponent of the torque over the speed: 2 for a propeller, 0 for constant torque."
    )
    damping_factor: Annotated[float, not_negative(RATIO)] = Field(
        1.0,
        description="Ratio of the damping of vibration to the slope of the torque over the speed; "
        "often 1 to 1.5 for propellers.",
    )
    harmonics: tuple[LoadHarmonic, ...] = Field(
        (), description="Harmonics of the load torque over one revolution."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from _listed_twice([harmonic.order for harmonic in self.harmonics])

    def resistance(self, speed: float) -> float:
        """Mean torque at a speed of its disc above zero [N m]."""
        resistance: float = self.torque * (speed / self.speed) ** self.exponent
        return resistance

    def damping(self, speed: float) -> float:
        """Damping of its vibration at a speed [N m s/rad]; none where the torque falls with the speed."""
        return max(self.damping_factor * self.exponent * self.resistance(speed) / speed, 0.0)


class Harmonic(CheckedDescription):
    """One order or frequency of a pulsating torque."""

    order: Order | None = Field(
        None, description="Order: cycles per revolution of the disc. Default: none, with a frequency alone."
    )
    frequency: Annotated[float, Quantity(FREQUENCY)] | None = Field(
        None,
        description="Fixed frequency that adds to that of the order, such as 100 Hz for twice the supply; "
        "negative for a difference, as k f₁ − n f₂ of an inverter or twice the slip frequency.",
    )
    torque: Annotated[float, not_negative(TORQUE)] = Field(description="Amplitude of the torque.")
    phase: Angle = Field(
        0.0, description="Phase β of cos(νφ + 2πf t + β), with the disc angle φ and the frequency f."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.order is None and not self.frequency:
            yield fault("order", expected="an order, a frequency, or both")

    @property
    def line(self) -> tuple[float, float]:
        """Order, 0 for none, and fixed angular frequency [rad/s]."""
        return self.order or 0.0, 2 * math.pi * (self.frequency or 0.0)


class Excitation(CheckedDescription):
    """A torque on a disc that pulsates with its angle."""

    on: str = Field(description="Disc on which the torque acts.")
    harmonics: tuple[Harmonic, ...] = Field(description="Orders of the excitation.")
    speed: PositiveSpeed | None = Field(
        None, description="Speed at which the amplitudes are given, if they depend on the speed."
    )
    exponent: Exponent = Field(
        0.0, description="Exponent of the amplitudes over the speed: 2 for inertia torques."
    )
    speeds: Speeds | None = Field(
        None,
        description="Speeds of the disc, increasing, of a table of factors on the amplitudes, such as over "
        "the slip of a synchronous motor that starts; instead of speed and exponent.",
    )
    factors: Annotated[tuple[float, ...], QuantityList(RATIO)] | None = Field(
        None, description="Factors at these speeds; linear between them, held beyond."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if not self.harmonics:
            yield fault("harmonics", found="an empty list", expected="a list of at least one order")
        if self.exponent and self.speed is None:
            yield fault("speed", expected="the speed at which the amplitudes hold, as they change with it")
        yield from _listed_twice([harmonic.line for harmonic in self.harmonics])
        if (self.speeds is None) != (self.factors is None):
            name = "speeds" if self.speeds is None else "factors"
            yield fault(name, expected="speeds and factors together")
        elif self.speeds is not None:
            yield from curve_faults(self, "speeds", ("factors",))
            if self.speed is not None:
                yield fault("speed", found=self.speed, expected="none beside speeds", remedy="leave it out")

    def factor(self, speed: float) -> float:
        """Amplitudes at a speed over those given."""
        if self.speeds is not None and self.factors is not None:
            return float(np.interp(speed, self.speeds, self.factors))
        if self.speed is None:
            return 1.0
        factor: float = (speed / self.speed) ** self.exponent
        return factor


def _listed_twice(orders: Sequence[float] | Sequence[tuple[float, float]]) -> Iterator[InitErrorDetails]:
    if len(orders) > HARMONICS.most:
        yield fault("harmonics", found=f"{len(orders)} of them", expected=HARMONICS.words)
        return
    for n, order in enumerate(orders):
        if order in orders[:n]:
            remedy = "add the two up, each with its phase"
            found = order[0] if isinstance(order, tuple) else order
            yield fault(
                "harmonics", n, "order", found=found, expected="an order not yet in the list", remedy=remedy
            )


class SpeedControl(CheckedDescription):
    """A PI controller that holds the speed of a driver: a frequency converter, a turbine governor."""

    speed: PositiveSpeed | None = Field(
        None, description="Set-point of the speed of the disc. Default: its speed at the start of the motion."
    )
    times: Annotated[tuple[float, ...], QuantityList(TIME)] | None = Field(
        None, description="Times of a set-point that changes, increasing; instead of `speed`."
    )
    speeds: Speeds | None = Field(None, description="Set-point at these times; linear between them.")
    proportional: Annotated[float, positive(TORSIONAL_DAMPING)] = Field(
        description="Proportional gain k_p: torque per speed deviation."
    )
    integral: Annotated[float, not_negative(TORSIONAL_STIFFNESS)] = Field(
        0.0,
        description="Integral gain k_i: torque per integral of the speed deviation over time; k_p over the "
        "integral-action time.",
    )
    torque_max: PositiveTorque | None = Field(
        None,
        description="Limit of the torque, either way; the integral stops at the limit (anti-windup). "
        "Default: none.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.times is None) != (self.speeds is None):
            yield fault("times" if self.times is None else "speeds", expected="times and speeds together")
        elif self.times is not None:
            yield from curve_faults(self, "times", ("speeds",))
            if self.speed is not None:
                yield fault("speed", found=self.speed, expected="none beside times", remedy="leave it out")


class TrainDriver(CheckedDescription):
    """A turbine or motor that drives: with its share of the power, or with a torque over the speed."""

    on: str = Field(description="Disc driven by the turbine or motor.")
    share: Annotated[float, positive(RATIO)] = Field(
        1.0, description="Share of the load power, relative to the other drivers."
    )
    torque: PositiveTorque | None = Field(
        None, description="Mean torque at the given speed, independent of the loads; instead of the share."
    )
    speed: PositiveSpeed | None = Field(None, description="Speed of the disc at which the torque is given.")
    exponent: Exponent = Field(
        0.0, description="Exponent of the torque over the speed; −1 for constant power."
    )
    control: SpeedControl | None = Field(
        None,
        description="Speed controller: it adds to the mean torque what the deviation of the speed asks for.",
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.control is not None and self.speed is not None:
            expected = "no torque over the speed beside a speed controller"
            yield fault("speed", found=self.speed, expected=expected, remedy="leave it out")
        if self.torque is None and (self.speed is not None or self.exponent):
            key = "speed" if self.speed is not None else "exponent"
            yield fault(key, found=getattr(self, key), expected="none without a torque", remedy="give torque")
        if self.torque is not None and self.speed is None and self.exponent:
            yield fault("speed", expected="the speed at which the torque holds, as it changes with it")

    def torque_at(self, speed: float) -> float:
        """Torque given, at a speed of its disc above zero [N m]."""
        assert self.torque is not None
        if self.speed is None:
            return self.torque
        torque: float = self.torque * (speed / self.speed) ** self.exponent
        return torque


class TrainEngine(Description):
    """One of several engines that drive a train."""

    phase: Angle = Field(
        0.0,
        description="Angle by which its crank leads that of [train.engine], at its own speed. With "
        "clutched engines the phase is arbitrary: look for the worst.",
    )
    factors: dict[str, Annotated[float, not_negative(RATIO)]] = Field(
        default_factory=dict,
        description="Combustion factor of faulty cylinders, by number; 0 for a misfire.",
    )
    engine: ReciprocatingEngine | None = Field(
        None, description="Description of the engine, if it differs from [train.engine]."
    )


class InstalledEngine(NamedTuple):
    """An engine in its place in a train."""

    name: str  # empty where there is but one
    engine: ReciprocatingEngine  # with its own factors
    phase: float  # angle by which its crank leads [rad]

    @property
    def throws(self) -> tuple[str, ...]:
        """Names of the discs that its throws are."""
        return throw_names(len(self.engine.throws), self.name)

    @property
    def cranks(self) -> tuple[str, ...]:
        """Names of the shafts between its throws."""
        return crank_names(len(self.engine.throws), self.name)

    @property
    def prefix(self) -> str:
        """Before the names of its parts."""
        return _prefix(self.name)


def throw_names(throws: int, engine: str = "") -> tuple[str, ...]:
    """Names of the discs that the throws of an engine are."""
    return tuple(f"{_prefix(engine)}throw_{n + 1}" for n in range(throws))


def crank_names(throws: int, engine: str = "") -> tuple[str, ...]:
    """Names of the shafts between the throws of an engine."""
    return tuple(f"{_prefix(engine)}crank_{n + 1}" for n in range(throws - 1))


def _prefix(engine: str) -> str:
    return f"{engine}_" if engine else ""
