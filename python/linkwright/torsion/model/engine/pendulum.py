r"""Moments of inertia of a rod from how fast it swings on a knife edge, and the tests of a machine file.

A body of mass m whose centre of mass hangs a distance b below the edge swings with small amplitude like a
thread pendulum of the length A,

.. math::

    A = \frac{g\,T^2}{4\pi^2} = \frac{g\,(60/\pi)^2}{n^2}, \qquad T = \frac{120}{n}

with n *single* swings (from one side to the other) a minute. The moments of inertia follow about the edge,
the centre of mass, and an axis at the distance c from the edge, counted towards the centre of mass:

.. math::

    J_e = m b A \quad (13), \qquad J_S = m b (A - b) \quad (14), \qquad J_w = m (A b - 2 b c + c^2) \quad (15)

Swung about both heads, on edges a distance l₁ apart, the centre of mass lies from the edge of the small end
at

.. math:: b = l_1 \frac{A_1 - l_1}{A_1 + A_2 - 2 l_1}

with A₁ from the swings about the big end. Where J_S = m a b both A are l₁ whatever b is: near that the two
swings say little about the centre of mass, and it is better found by weighing.

The paper writes weights in kgf, lengths in cm and 358 000 for g (60/π)², which is 357 826 cm/min² with its
own g = 981 cm/s²: its moments about the edge are too large by 0.05 %.

References
----------
.. [1] Paper 3, equations (13) to (15). Its I is J here, G/g is m, L₁ is l₁.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.errors import InputError
from linkwright.kernel.units.kinds import ACCELERATION, LENGTH, TIME
from linkwright.kernel.units.marks import not_negative, positive
from linkwright.linkages.model.element import PositiveNumber

# The paper's rounding of g (60/π)² [cm/min²], and its g [cm/s²].
PRINTED_LENGTH = 358000.0
PRINTED_GRAVITY = 981.0

# Free fall where nothing else is said, as for the loads of a machine [m/s²].
FREE_FALL = 9.81


def swing_period(swings_per_minute: float) -> float:
    """Time of a full oscillation, back and forth. T = 120/n [s]."""
    return 120.0 / swings_per_minute


def pendulum_length(period: float, gravity: float = FREE_FALL) -> float:
    """Length of the thread pendulum that swings as fast.

    A = g T²/4π² [m]. `period`: T of a full oscillation of small amplitude [s]; `gravity`: free fall at the
    place of the test [m/s²].
    """
    return gravity * (period / (2.0 * math.pi)) ** 2


def inertia_about_centre(mass: float, edge: float, length: float) -> float:
    """J_S = m b (A − b), (14) [kg m²]; negative if no body swings like that."""
    return mass * edge * (length - edge)


def two_point_centre(length_big_end: float, length_small_end: float, distance: float) -> float:
    """Place of the centre of mass from swings about both heads.

    b, from the edge of the small end to the centre of mass [m]. `length_big_end`, `length_small_end`: [m];
    `distance`: l₁ between the edges [m].
    """
    excess = length_big_end + length_small_end - 2.0 * distance
    if excess == 0.0:
        raise InputError(
            f"length_small_end: found {length_small_end:.6g} m, which with the other pendulum of "
            f"{length_big_end:.6g} m is twice the distance of the edges: the centre of mass is "
            "undetermined; find it by weighing"
        )
    return distance * (length_big_end - distance) / excess


def printed_inertia_about_edge(weight: float, edge: float, swings_per_minute: float) -> float:
    """The paper's (13), with 358 000 [kgf cm s²]; G [kgf]; b from the centre of mass to the edge [cm]."""
    return weight / PRINTED_GRAVITY * edge * PRINTED_LENGTH / swings_per_minute**2


def printed_inertia_about_centre(weight: float, edge: float, swings_per_minute: float) -> float:
    """The paper's (14), with 358 000 [kgf cm s²]."""
    return weight / PRINTED_GRAVITY * edge * (PRINTED_LENGTH / swings_per_minute**2 - edge)


def printed_inertia_about_axis(weight: float, edge: float, swings_per_minute: float, axis: float) -> float:
    """The paper's (15), with 358 000 [kgf cm s²]. `axis`: c, from the edge to the axis [cm]."""
    swung = PRINTED_LENGTH * edge / swings_per_minute**2
    return weight / PRINTED_GRAVITY * (swung - 2.0 * edge * axis + axis**2)


class Swings(CheckedDescription):
    """How fast a rod swings in one of its heads."""

    swings_per_minute: PositiveNumber | None = Field(
        None, description="Single swings per minute, from one side to the other."
    )
    period: Annotated[float, positive(TIME)] | None = Field(
        None, description="Period of a full swing, instead of the swings per minute."
    )
    edge: Annotated[float, not_negative(LENGTH)] = Field(
        0.0,
        description="Distance of the knife edge beyond the axis of the end, seen from the centre of mass: "
        "the radius of the bore in which the rod hangs.",
    )
    gravity: Annotated[float, positive(ACCELERATION)] = Field(
        FREE_FALL, description="Acceleration of gravity at the place of the test."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        if (self.swings_per_minute is None) == (self.period is None):
            found = "neither" if self.period is None else "both"
            yield fault(found=found, expected="either swings_per_minute or period")

    @property
    def given(self) -> tuple[str, float]:
        """Key and value of what was measured."""
        if self.period is not None:
            return "period", self.period
        assert self.swings_per_minute is not None
        return "swings_per_minute", self.swings_per_minute

    @property
    def length(self) -> float:
        """A of the thread pendulum that swings as fast [m]."""
        key, value = self.given
        return pendulum_length(value if key == "period" else swing_period(value), self.gravity)


class Swing(Swings):
    """A test in one head; the centre of mass is found by weighing or balancing."""

    about: Literal["small_end", "big_end"] = Field(
        "small_end", description="End in which the rod is suspended."
    )


class TwoPointSwing(Description):
    """A test in both heads one after the other, which finds the centre of mass as well."""

    big_end: Swings = Field(description="Test with the rod suspended in the big end.")
    small_end: Swings = Field(description="Test with the rod suspended in the small end.")
