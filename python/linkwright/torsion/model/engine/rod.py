r"""Connecting rods: length, mass, and how the mass is spread along them.

| given | centre of mass | moment of inertia |
| --- | --- | --- |
| `centre`, `inertia` | given | given about the centre of mass |
| `inertia_small_end` or `distribution`, `centre` | given | J_S = J_w − m (l − c)² |
| `inertia_small_end` or `distribution` alone | that of two point masses | that of two point masses |
| `centre`, `swing` | given, by weighing | from one pendulum test, (14) |
| `two_point_swing` | from both tests | from both tests |

The published split puts two point masses in the heads, with J_w the moment of inertia about the small end:

.. math::

    m_1 = \frac{J_w}{l^2} \quad (1), \qquad m_2 = m - \frac{J_w}{l^2} \quad (2), \qquad
    k = \frac{m_1}{m} = \frac{J_w}{m l^2} \quad (8)

It keeps mass and J_w of the rod, but not its centre of mass, unless J_S = m c (l − c). Where J_w or k is all
that is known, the rod is taken to *be* these two point masses: c = (1 − k) l, J_S = k (1 − k) m l².

References
----------
.. [1] Paper 3, equations (1), (2), (8). Its I_w is J_w here, L is l.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, NamedTuple

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault
from linkwright.kernel.units.kinds import INERTIA, LENGTH, MASS, RATIO
from linkwright.kernel.units.marks import INSIDE_ONE, Angle, Length, Quantity, not_negative, positive
from linkwright.linkages.model.element import PositiveLength
from linkwright.torsion.model.engine.pendulum import (
    Swing,
    TwoPointSwing,
    inertia_about_centre,
    two_point_centre,
)

PositiveInertia = Annotated[float, positive(INERTIA)]

# What spreads the mass: one of these is given.
_WAYS = ("inertia", "inertia_small_end", "distribution", "swing", "two_point_swing")
# How far the heads reach beyond their axes at most, in lengths of the rod: big ends are about 0.3 large.
_OVERHANG = 0.5
# Share of the distance between the edges by which two pendulums together must differ from twice that to tell
# the centre of mass: there an error of 0.1 % in the swings already moves it by a fifth of its distance.
_TELLING = 0.01


class RodBody(NamedTuple):
    """A rod as a rigid body."""

    mass: float  # m [kg]
    centre: float  # c of the centre of mass, from the axis of the big end towards the small end [m]
    inertia: float  # J_S, about the centre of mass [kg m²]


class Rod(CheckedDescription):
    """A connecting rod on the crank pin: one of two side by side, a fork, a blade, or a master rod."""

    length: PositiveLength = Field(description="Distance between the axes of big and small end.")
    mass: Annotated[float, positive(MASS)] = Field(
        description="Mass of the whole rod with bearings and bolts."
    )
    centre: Length | None = Field(
        None,
        description="Distance of the centre of mass from the axis of the big end, towards the small end.",
    )
    inertia: PositiveInertia | None = Field(None, description="Moment of inertia about the centre of mass.")
    inertia_small_end: PositiveInertia | None = Field(
        None, description="Moment of inertia about the axis of the small end."
    )
    distribution: Annotated[float, Quantity(RATIO, INSIDE_ONE)] | None = Field(
        None,
        description="Moment of inertia about the small end over mass times length squared: the share of "
        "the mass allotted to the big end.",
    )
    swing: Swing | None = Field(None, description="Pendulum test, suspended in one end.")
    two_point_swing: TwoPointSwing | None = Field(None, description="Pendulum tests, suspended in both ends.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        for faults in (self._key_faults, self._swing_faults, self._body_faults):
            problems = list(faults())
            yield from problems
            if problems:
                return

    def _key_faults(self) -> Iterator[InitErrorDetails]:
        given = [key for key in _WAYS if getattr(self, key) is not None]
        if len(given) != 1:
            expected = f"one of {', '.join(_WAYS[:-1])} and {_WAYS[-1]}, which say how the mass is spread"
            yield fault(found=" and ".join(given) or None, expected=expected)
        elif self.centre is None and given[0] in ("inertia", "swing"):
            remedy = "weigh the rod on its heads: its small end carries mass times centre over length"
            yield fault("centre", expected=f"the centre of mass, which {given[0]} needs", remedy=remedy)
        elif self.centre is not None and given[0] == "two_point_swing":
            remedy = "the two tests find it; with a centre of mass known, give one of them as swing"
            yield fault("centre", found=self.centre, expected="no entry", remedy=remedy)

    def _swing_faults(self) -> Iterator[InitErrorDetails]:
        if self.swing is not None and self._below_edge <= 0:
            expected = "a centre of mass below the knife edge of the swing"
            yield fault("centre", found=self.centre, expected=expected)
        test = self.two_point_swing
        if test is None:
            return
        apart = self._edges_apart
        big, small = test.big_end.length, test.small_end.length
        if (big - apart) * (small - apart) <= 0:
            found = f"pendulums of {big:.6g} m in the big end and {small:.6g} m in the small end"
            expected = f"both longer or both shorter than the {apart:.6g} m between the edges"
            remedy = (
                "no centre of mass between the edges is consistent: count again, or weigh the rod and "
                "give one swing"
            )
            yield fault("two_point_swing", found=found, expected=expected, remedy=remedy)
        elif abs(big + small - 2 * apart) < _TELLING * apart:
            found = f"pendulums of {big:.6g} m in the big end and {small:.6g} m in the small end"
            expected = f"pendulums that differ from the {apart:.6g} m between the edges"
            remedy = (
                "this close to it they do not determine the centre of mass: weigh the rod and give one swing"
            )
            yield fault("two_point_swing", found=found, expected=expected, remedy=remedy)

    def _body_faults(self) -> Iterator[InitErrorDetails]:
        low, high = -_OVERHANG * self.length, (1 + _OVERHANG) * self.length
        if self._is_two_masses and self.distribution is None and self.mass_piston <= 0:
            expected = f"less than mass times length squared, {self.mass * self.length**2:.6g} kg m^2"
            yield fault("inertia_small_end", found=self.inertia_small_end, expected=expected)
            return
        m, c, J = self.body
        if not low < c < high:
            expected = f"a centre of mass between {low:.6g} and {high:.6g} m from the axis of the big end"
            yield fault("centre", found=c, expected=expected)
        elif J <= 0:
            yield self._too_small(J)
        elif m * (c - low) * (high - c) < J:
            found = f"{J:.6g} kg m^2 about the centre of mass"
            expected = f"up to {m * (c - low) * (high - c):.6g} kg m^2"
            remedy = "more would require mass far beyond the ends"
            yield fault(self._way, found=found, expected=expected, remedy=remedy)

    def _too_small(self, J: float) -> InitErrorDetails:
        found = f"{J:.6g} kg m^2 about the centre of mass"
        least = self.mass * (self.length - (self.centre or 0.0)) ** 2
        if self._way == "inertia_small_end":
            expected = f"more than mass times distance of the centre of mass squared, {least:.6g} kg m^2"
            return fault("inertia_small_end", found=self.inertia_small_end, expected=expected)
        if self._way == "distribution":
            expected = f"more than {least / (self.mass * self.length**2):.6g} with this centre of mass"
            return fault("distribution", found=self.distribution, expected=expected)
        if self.swing is not None:
            key, value = self.swing.given
            slowest = 2 * math.pi * math.sqrt(self._below_edge / self.swing.gravity)
            limit = f"more than {slowest:.6g} s" if key == "period" else f"fewer than {120 / slowest:.6g}"
            expected = f"{limit}, as of a thread pendulum down to the centre of mass"
            return fault("swing", key, found=value, expected=expected)
        expected = "swings of a body with a positive moment of inertia"
        return fault("two_point_swing", found=found, expected=expected, remedy="count the swings again")

    @property
    def _way(self) -> str:
        return next(key for key in _WAYS if getattr(self, key) is not None)

    @property
    def _is_two_masses(self) -> bool:
        return self.centre is None and self.two_point_swing is None

    @property
    def _below_edge(self) -> float:
        """b of the single test: how far the centre of mass hangs below the edge [m]."""
        assert self.swing is not None
        assert self.centre is not None
        to_axis = self.centre if self.swing.about == "big_end" else self.length - self.centre
        return to_axis + self.swing.edge

    @property
    def _edges_apart(self) -> float:
        """l₁ of the two tests, between their edges [m]."""
        assert self.two_point_swing is not None
        return self.length + self.two_point_swing.big_end.edge + self.two_point_swing.small_end.edge

    @property
    def body(self) -> RodBody:
        """The rod as a rigid body; of two point masses in its heads if no more is known."""
        m, length = self.mass, self.length
        if self.two_point_swing is not None:
            return self._swung_body(self.two_point_swing)
        if self.centre is None:
            k = self.mass_pin / m
            return RodBody(m, (1 - k) * length, k * (1 - k) * m * length**2)
        if self.inertia is not None:
            return RodBody(m, self.centre, self.inertia)
        if self.swing is not None:
            J = inertia_about_centre(m, self._below_edge, self.swing.length)
            return RodBody(m, self.centre, J)
        assert self._moment is not None
        return RodBody(m, self.centre, self._moment - m * (length - self.centre) ** 2)

    def _swung_body(self, test: TwoPointSwing) -> RodBody:
        b = two_point_centre(test.big_end.length, test.small_end.length, self._edges_apart)
        J = inertia_about_centre(self.mass, b, test.small_end.length)
        return RodBody(self.mass, self.length - (b - test.small_end.edge), J)

    @property
    def _moment(self) -> float | None:
        """J_w, given directly or by k; None if it follows otherwise."""
        if self.distribution is not None:
            return self.distribution * self.mass * self.length**2
        return self.inertia_small_end

    @property
    def moment_small_end(self) -> float:
        """J_w, about the axis of the small end [kg m²]."""
        if self._moment is not None:
            return self._moment
        m, c, J = self.body
        return J + m * (self.length - c) ** 2

    @property
    def mass_pin(self) -> float:
        """m_1 of the published split, at the crank pin, (1) [kg]."""
        return self.moment_small_end / self.length**2

    @property
    def mass_piston(self) -> float:
        """m_2 of the published split, at the piston pin, (2) [kg]."""
        return self.mass - self.mass_pin

    @property
    def share(self) -> float:
        """The coefficient k of the mass distribution, m_1/m, (8)."""
        return self.mass_pin / self.mass


class ArticulatedRod(Rod):
    """A rod on a pin of a master rod; its big end is the one on that pin."""

    pin_radius: Annotated[float, not_negative(LENGTH)] = Field(
        description="Distance from the axis of the master rod's big end to the articulated pin."
    )
    pin_angle: Angle = Field(
        description="Angle from the axis of the master rod to the articulated pin, in the sense of "
        "rotation; often the angle between the two cylinders."
    )
