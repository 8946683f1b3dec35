r"""Torques on a train from outside: what it drives, and what makes it pulsate.

A load resists with :math:`M = M_0 (\omega/\omega_0)^p`, ω the speed of its disc: p = 2 for propellers and
fans, 1 for viscous drag, 0 for pumps of constant stroke, −1 for a generator at constant power. Its vibration
is damped by the slope,

.. math:: c = \frac{dM}{d\omega} = p\,\frac{M}{\omega}

Pulsating torques are :math:`\sum M_\nu \cos(\nu\varphi + \beta_\nu)`, φ the angle of the disc, ν the order.

References
----------
.. [1] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 2, 1963: propellers and pumps.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.limits import HARMONICS, ORDER
from linkwright.kernel.units import COUNT, RATIO, TORQUE, Angle, Bound, Quantity, not_negative
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

    order: Order = Field(description="Cycles per revolution of its disc; of a propeller, its blades.")
    share: Annotated[float, not_negative(RATIO)] = Field(description="Amplitude over the mean torque.")
    phase: Angle = Field(0.0, description="β of the resistance cos(νφ + β), φ the angle of the disc.")


class TrainLoad(CheckedDescription):
    """What a disc drives: a propeller, a pump, a generator, a brake."""

    on: str = Field(description="The disc that drives it.")
    torque: PositiveTorque = Field(description="Mean resistance at the speed given.")
    speed: PositiveSpeed = Field(description="Of the disc, at which the torque is given.")
    exponent: Exponent = Field(
        2.0, description="Of the torque over the speed: 2 for a propeller, 0 for constant torque."
    )
    damping_factor: Annotated[float, not_negative(RATIO)] = Field(
        1.0, description="Damping of its vibration over the slope of its torque; propellers often 1 to 1.5."
    )
    harmonics: tuple[LoadHarmonic, ...] = Field((), description="Pulsation over its revolution.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from _listed_twice([harmonic.order for harmonic in self.harmonics])

    def resistance(self, speed: float) -> float:
        """Mean torque at a speed of its disc above zero [N m]."""
        found: float = self.torque * (speed / self.speed) ** self.exponent
        return found

    def damping(self, speed: float) -> float:
        """Damping of its vibration at a speed [N m s/rad]; none where the torque falls with the speed."""
        return max(self.damping_factor * self.exponent * self.resistance(speed) / speed, 0.0)


class Harmonic(Description):
    """One order of a pulsating torque."""

    order: Order = Field(description="Cycles per revolution of its disc.")
    torque: Annotated[float, not_negative(TORQUE)] = Field(description="Amplitude.")
    phase: Angle = Field(0.0, description="β of cos(νφ + β), φ the angle of the disc.")


class Excitation(CheckedDescription):
    """A torque on a disc that pulsates with its angle."""

    on: str = Field(description="The disc that it acts on.")
    harmonics: tuple[Harmonic, ...] = Field(description="Its orders.")
    speed: PositiveSpeed | None = Field(None, description="At which the amplitudes hold, if they change.")
    exponent: Exponent = Field(0.0, description="Of the amplitudes over the speed: 2 for inertia torques.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if not self.harmonics:
            yield fault("harmonics", found="an empty list", expected="a list of at least one order")
        if self.exponent and self.speed is None:
            yield fault("speed", expected="the speed at which the amplitudes hold, as they change with it")
        yield from _listed_twice([harmonic.order for harmonic in self.harmonics])

    def factor(self, speed: float) -> float:
        """Amplitudes at a speed over those given."""
        if self.speed is None:
            return 1.0
        found: float = (speed / self.speed) ** self.exponent
        return found


def _listed_twice(orders: Sequence[float]) -> Iterator[InitErrorDetails]:
    """Orders that a list of harmonics has already."""
    if len(orders) > HARMONICS.most:
        yield fault("harmonics", found=f"{len(orders)} of them", expected=HARMONICS.words)
        return
    for n, order in enumerate(orders):
        if order in orders[:n]:
            remedy = "add the two up, each with its phase"
            yield fault(
                "harmonics", n, "order", found=order, expected="an order not yet in the list", remedy=remedy
            )
