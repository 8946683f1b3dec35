r"""Parts of a train with dry friction: clutches, brakes and bits, freewheels.

While a clutch slips it carries its sliding torque over the slip s, and while it sticks whatever its discs
need, up to its static capacity. The torque is given, or that of z friction surfaces of the mean radius r
under the force F,

.. math:: T = z\,\mu\,F\,r_m

Between static and sliding friction the torque may fall with the slip, as measured with bits and linings,

.. math:: T(s) = T_\mathrm{d} + (T_\mathrm{s} - T_\mathrm{d})\,\mathrm{e}^{-s/s_\mathrm{S}}

References
----------
.. [1] VDI 2241-1, Clutches and brakes with frictional connection, 1982: capacity, mean radius, static and
   sliding torque.
.. [2] Armstrong-Hélouvry, Dupont, Canudas de Wit, A survey of models, analysis tools and compensation methods
   for the control of machines with friction, Automatica 30 (1994) 1083-1138: friction that falls with slip.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, Whole, fault
from linkwright.kernel.description.curve import curve_faults
from linkwright.kernel.units.kinds import ENERGY, FORCE, INERTIA, LENGTH, RATIO, TIME, TORQUE
from linkwright.kernel.units.marks import QuantityList, Speeds, not_negative, positive
from linkwright.torsion.model.train_base import (
    GROUND,
    Damping,
    PositiveSpeed,
    PositiveStiffness,
    PositiveTorque,
)

_Share = Annotated[float, positive(RATIO)]
_Shares = Annotated[tuple[float, ...], QuantityList(RATIO)]
_Torque = Annotated[float, not_negative(TORQUE)]


class FrictionPart(CheckedDescription):
    """What a part with dry friction carries: a torque, or a coefficient of friction with force and radius."""

    sliding: _Torque | None = Field(
        None, description="Sliding torque; with stribeck_speed that far from rest."
    )
    static: PositiveTorque | None = Field(
        None,
        description="Static capacity: torque up to which it sticks. Default: the sliding torque at rest.",
    )
    slip: Speeds | None = Field(
        None, description="Slips, from 0, of a curve of the sliding torque; held beyond the last."
    )
    torque: Annotated[tuple[float, ...], QuantityList(TORQUE)] | None = Field(
        None, description="Sliding torque at each slip, instead of sliding; linear between them."
    )
    friction: _Share | None = Field(
        None, description="Coefficient of sliding friction, with force and radius instead of sliding."
    )
    friction_static: _Share | None = Field(
        None, description="Coefficient of static friction, with force and radius instead of static."
    )
    friction_curve: _Shares | None = Field(
        None,
        description="Coefficient of sliding friction at each slip, with force and radius instead of torque.",
    )
    force: Annotated[float, positive(FORCE)] | None = Field(
        None, description="Normal force on the friction surfaces at full engagement."
    )
    radius: Annotated[float, positive(LENGTH)] | None = Field(
        None, description="Mean radius of the friction surfaces."
    )
    surfaces: Whole = Field(1, ge=1, description="Number of friction surfaces.")
    stribeck_speed: PositiveSpeed | None = Field(
        None, description="Slip at which the excess of static over sliding torque has fallen to 1/e."
    )
    torque_permitted: PositiveTorque | None = Field(
        None, description="Permitted torque in a manoeuvre, either way."
    )
    heat_permitted: Annotated[float, positive(ENERGY)] | None = Field(
        None, description="Permitted friction work in a manoeuvre."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        wrong = list(self._force_faults()) or list(self._curve_faults())
        yield from wrong
        if wrong:
            return
        if self.curve is None and self.sliding is None and self.friction is None:
            remedy = 'give sliding, such as "200 N m", or slip and torque, or friction, force and radius'
            yield fault(expected="a friction torque", remedy=remedy)
        elif self.held < self.at_rest:
            found, expected = self.held, f"at least the sliding torque at rest, {self.at_rest:.6g} N m"
            key = "static" if self.static is not None else "friction_static"
            yield fault(key, found=found, expected=expected)
        elif self.stribeck_speed is not None and self.curve is not None:
            yield fault(
                "stribeck_speed", found=self.stribeck_speed, expected="none beside a curve over the slip"
            )

    def _force_faults(self) -> Iterator[InitErrorDetails]:
        coefficients = ("friction", "friction_static", "friction_curve")
        given = [name for name in coefficients if getattr(self, name) is not None]
        for name in ("force", "radius"):
            if given and getattr(self, name) is None:
                yield fault(name, expected=f"a value beside {given[0]}")
            if not given and getattr(self, name) is not None:
                yield fault("friction", expected=f"the coefficient of friction beside {name}")
        pairs = zip(coefficients, ("sliding", "static", "torque"), strict=True)
        for one, other in pairs:
            if getattr(self, one) is not None and getattr(self, other) is not None:
                yield fault(other, found=getattr(self, other), expected=f"none beside {one}")

    def _curve_faults(self) -> Iterator[InitErrorDetails]:
        name = "torque" if self.friction_curve is None else "friction_curve"
        values = getattr(self, name)
        if (self.slip is None) != (values is None):
            missing = "slip" if self.slip is None else "torque"
            yield fault(missing, expected="both slip and torque, or neither")
            return
        if self.slip is None:
            return
        yield from curve_faults(self, "slip", (name,))
        if self.slip and self.slip[0] != 0.0:
            yield fault("slip", 0, found=self.slip[0], expected="0, where the part is at rest")
        for n, value in enumerate(values):
            if value < 0:
                yield fault(name, n, found=value, expected="0 or more")
        single = "sliding" if self.sliding is not None else "friction"
        if getattr(self, single) is not None:
            yield fault(single, found=getattr(self, single), expected="none beside a curve over the slip")

    @property
    def lever(self) -> float:
        """Torque for a coefficient of friction of 1 [N m]."""
        return (self.force or 0.0) * (self.radius or 0.0) * self.surfaces

    @property
    def curve(self) -> tuple[tuple[float, ...], tuple[float, ...]] | None:
        """Sliding torque over slip [rad/s, N m], if it is given by points."""
        if self.slip is None:
            return None
        if self.torque is not None:
            return self.slip, self.torque
        return self.slip, tuple(self.lever * value for value in self.friction_curve or ())

    @property
    def at_speed(self) -> float:
        """Sliding torque, with a falling one that far from rest [N m]."""
        if self.curve is not None:
            return self.curve[1][-1]
        return self.sliding if self.sliding is not None else self.lever * (self.friction or 0.0)

    @property
    def at_rest(self) -> float:
        """Sliding torque without slip, before static friction counts [N m]."""
        return self.at_speed if self.curve is None else self.curve[1][0]

    @property
    def held(self) -> float:
        """Static capacity [N m]."""
        if self.static is not None:
            return self.static
        return self.at_rest if self.friction_static is None else self.lever * self.friction_static


class EngagedPart(FrictionPart):
    """A friction part that a force closes, more or less over the time of a manoeuvre."""

    closed: bool = Field(True, description="Engaged at the start of a manoeuvre.")
    times: Annotated[tuple[float, ...], QuantityList(TIME)] | None = Field(
        None, description="Times of a course of the engagement in a manoeuvre, instead of events."
    )
    engagement: _Shares | None = Field(
        None, description="Share of the normal force at each time; linear between them."
    )

    def _faults(self) -> Iterator[InitErrorDetails]:
        yield from super()._faults()
        if (self.times is None) != (self.engagement is None):
            missing = "times" if self.times is None else "engagement"
            yield fault(missing, expected="both times and engagement, or neither")
        elif self.times is not None:
            yield from curve_faults(self, "times", ("engagement",))
            for n, share in enumerate(self.engagement or ()):
                if share < 0:
                    yield fault("engagement", n, found=share, expected="0 or more")


class Clutch(EngagedPart):
    """A friction clutch between two discs; stuck it is rigid."""

    between: tuple[str, str] = Field(description="The two discs that it connects.")
    closed: bool = Field(
        True,
        description="Engaged at the start of a manoeuvre. In modes and forced vibration an engaged clutch is "
        "rigid and an open one carries nothing.",
    )


class Brake(EngagedPart):
    """A friction brake on a disc against the ground, or dry friction of a bearing or a drill bit."""

    on: str = Field(description="Disc that it brakes.")


class Freewheel(CheckedDescription):
    """A one-way clutch: it locks where its first disc would overtake the second, which may overrun it.

    With a stiffness it is in series with a spring, as in overrunning decouplers: the locked ring drives the
    second disc through the spring, and overruns with it.
    """

    between: tuple[str, str] = Field(
        description='The driving disc and the driven one; "ground" as the first makes a backstop, which lets '
        "the disc turn only forwards."
    )
    drag: _Torque = Field(0.0, description="Friction torque while it is overrun.")
    stiffness: PositiveStiffness | None = Field(
        None, description="Stiffness of a spring between its ring and the driven disc. Default: rigid."
    )
    damping: Damping = Field(0.0, description="Viscous damping of the spring.")
    ring_inertia: Annotated[float, positive(INERTIA)] | None = Field(
        None, description="Moment of inertia of the ring between freewheel and spring."
    )
    torque_permitted: PositiveTorque | None = Field(None, description="Permitted torque while it locks.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.stiffness is None:
            for name in ("ring_inertia", "damping"):
                if getattr(self, name):
                    expected = f"a stiffness beside {name}"
                    yield fault("stiffness", expected=expected, remedy='such as "500 N m/rad"')
            return
        if self.ring_inertia is None:
            yield fault("ring_inertia", expected="the inertia of the ring, which the spring turns")
        if GROUND in self.between:
            remedy = "leave it out; an elastic backstop is a disc with a backstop, on a shaft"
            yield fault("stiffness", found=self.stiffness, expected="none of a backstop", remedy=remedy)

    @staticmethod
    def parts(name: str) -> tuple[str, str]:
        """Names of the ring and of the spring of an elastic one."""
        return f"{name}_ring", f"{name}_spring"
