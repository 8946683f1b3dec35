r"""An elastic coupling, linear or of a curve; a torsional damper, a ring held by a fluid or by rubber; a
centrifugal pendulum.

About the mean torque a coupling of a curve acts as one of its slope there, :math:`k = dM/d\Delta`.

References
----------
.. [1] Den Hartog, Mechanical Vibrations, 4th ed. 1956, sections 3.3 and 5.6: dampers with and without spring;
   chapter 5: centrifugal pendulums.

A centrifugal pendulum of mass m and length l on the radius R obeys, for small swings ψ at the speed Ω,

.. math:: m l^2\,\ddot\psi + m l (R + l)\,\ddot\theta + m R l\,\Omega^2 \psi = 0

With :math:`\theta + \psi l/(R + l)` for the angle of a ring, this is a tuned damper of

.. math:: J = m (R + l)^2, \qquad k = J\,\frac{R}{l}\,\Omega^2

tuned to the order :math:`\sqrt{R/l}` at every speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import CheckedDescription, Description, fault
from linkwright.kernel.description.curve import curve_faults, not_rising
from linkwright.kernel.numerics.implicit import solution_along
from linkwright.kernel.numerics.tangent import numbers, primal
from linkwright.kernel.numerics.zeros import zeros
from linkwright.kernel.units.kinds import ANGLE, INERTIA, LENGTH, MASS, POWER
from linkwright.kernel.units.marks import Angles, Torques, positive
from linkwright.torsion.model.train_base import Damping, LossFactor, PositiveStiffness, PositiveTorque


class Coupling(CheckedDescription):
    """An elastic coupling between two discs."""

    between: tuple[str, str] = Field(
        description='The two discs that it connects; one end may be "ground" (fixed).'
    )
    stiffness: PositiveStiffness | None = Field(
        None, description="Torsional stiffness for vibration: torque per angle of twist."
    )
    twist: Angles | None = Field(
        None,
        description="Angles of twist of a torque curve from 0, instead of the stiffness; the curve is odd.",
    )
    torque: Torques | None = Field(None, description="Torque at each angle of twist, from 0.")
    damping: Damping = Field(
        0.0, description="Viscous damping: torque per relative angular velocity of the two ends."
    )
    loss_factor: LossFactor = Field(
        0.0,
        description="Loss factor η = ψ/(2π), with the relative damping ψ: loss per cycle over peak strain "
        "energy.",
    )
    torque_permitted: PositiveTorque | None = Field(
        None, description="Permitted sum of mean and vibratory torque."
    )
    vibratory_torque_permitted: PositiveTorque | None = Field(
        None, description="Amplitude of the torque in continuous operation."
    )
    heat_permitted: Annotated[float, positive(POWER)] | None = Field(None, description="Permitted heat load.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        curve = self.twist is not None or self.torque is not None
        if (self.stiffness is None) != curve:
            found = "both" if curve else "neither"
            yield fault(found=found, expected="either stiffness, or twist and torque")
        if not curve:
            return
        yield from torque_curve_faults(self)

    def slope(self, torque: Floats | float = 0.0) -> Floats:
        """Stiffness at a mean torque.

        dM/dΔ of the smooth curve through its points; beyond the last, that at the last [N m/rad]. `torque`:
        mean torque that it carries [N m].
        """
        if self.stiffness is not None:
            return np.full_like(np.asarray(torque, float), self.stiffness)
        twist, torques, slopes = self.curve()
        knots = primal(torques)
        is_inside = np.abs(torque) < knots[-1]
        size = np.where(is_inside, np.abs(torque), torques[-1])
        n = np.minimum(np.searchsorted(knots, primal(size), side="right") - 1, len(knots) - 2)
        h, rise = twist[n + 1] - twist[n], torques[n + 1] - torques[n]
        piece = (rise, h * slopes[n], h * slopes[n + 1])

        # The curve rises everywhere, so that there is one twist.
        def beyond(z: Floats) -> Floats:
            over: Floats = torques[n] + _hermite(z, *piece)[0] - size
            return over

        low, high = np.zeros(np.shape(size)), np.ones(np.shape(size))
        z, _ = zeros(lambda z: np.asarray(primal(beyond(z))), low, high)
        z = solution_along(z, beyond(z), primal(_hermite(z, *piece)[1]))
        stiffness: Floats = _hermite(z, *piece)[1] / h
        return stiffness

    def curve(self) -> tuple[Floats, Floats, Floats]:
        """Twists, torques and slopes at the points of its curve, from zero upwards, (points,).

        [rad], [N m], [N m/rad]; between the points it is a cubic with these slopes, which rises everywhere
        (Fritsch and Butland 1984).
        """
        return rising_curve(self.twist, self.torque)


def torque_curve_faults(owner: Any) -> Iterator[InitErrorDetails]:
    """What is wrong with the curve of a part with entries `twist` and `torque`, of which one is given."""
    for name, other in (("twist", "torque"), ("torque", "twist")):
        if getattr(owner, name) is None:
            yield fault(name, expected=f"a list, one value for each {other}")
            return
    yield from curve_faults(owner, "twist", ("torque",))
    for name in ("twist", "torque"):
        points = getattr(owner, name)
        if points and points[0] != 0.0:
            yield fault(name, 0, found=points[0], expected="0, where the coupling is at rest")
    for n, (before, here) in enumerate(pairwise(owner.torque), start=1):
        if here <= before:
            yield not_rising(owner, "torque", n, before, here)


def rising_curve(twist: Any, torque: Any) -> tuple[Floats, Floats, Floats]:
    """Twists, torques and slopes of an odd curve through points from zero, which rises everywhere."""
    x, y = numbers(twist), numbers(torque)
    h = x[1:] - x[:-1]
    s = (y[1:] - y[:-1]) / h
    w = (h[:-1] + 2 * h[1:]) / (3 * (h[:-1] + h[1:]))
    inside = s[:-1] * s[1:] / (w * s[1:] + (1 - w) * s[:-1])
    # Odd about zero: the piece before the first is the same again.
    ends = (_end_slope(s[0], inside[0]), _end_slope(s[-1], inside[-1])) if len(s) > 1 else (s[0], s[0])
    return x, y, numbers([ends[0], *inside, ends[1]])


def _end_slope(chord: float, inside: float) -> float:
    """Slope at an end for a parabola-like piece, kept where the curve rises."""
    return min(max(1.5 * chord - 0.5 * inside, 0.1 * chord), 3 * chord)


def _hermite(z: Floats, rise: Floats, first: Floats, last: Floats) -> tuple[Floats, Floats]:
    """Cubic on 0…1 from 0 to a rise with slopes at both ends, and its slope."""
    value = z * (first + z * (3 * rise - 2 * first - last + z * (first + last - 2 * rise)))
    slope = first + z * (2 * (3 * rise - 2 * first - last) + 3 * z * (first + last - 2 * rise))
    return value, slope


class Damper(CheckedDescription):
    """A damper on a disc: viscous (Lanchester, Houde), or tuned by a spring or rubber."""

    on: str = Field(description="Disc that carries it; the inertia of its housing belongs to the disc.")
    kind: Literal["viscous", "tuned"] = Field(
        "viscous", description="Viscous damper (no spring) or tuned damper (with a spring)."
    )
    ring_inertia: Annotated[float, positive(INERTIA)] = Field(
        description="Moment of inertia of the ring about the axis."
    )
    damping: Damping = Field(0.0, description="Viscous damping between ring and disc.")
    stiffness: PositiveStiffness | None = Field(
        None, description="Stiffness of the spring of a tuned damper."
    )
    loss_factor: LossFactor = Field(0.0, description="Loss factor of the spring of a tuned damper.")
    heat_permitted: Annotated[float, positive(POWER)] | None = Field(None, description="Permitted heat load.")

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.kind == "tuned" and self.stiffness is None:
            yield fault("stiffness", expected="the stiffness of the spring of a tuned damper")
        if self.kind == "viscous":
            if self.stiffness is not None or self.loss_factor:
                remedy = 'make it kind = "tuned", or leave it out'
                name = "stiffness" if self.stiffness is not None else "loss_factor"
                yield fault(
                    name, found=getattr(self, name), expected="no spring in a viscous damper", remedy=remedy
                )
            if not self.damping:
                found = self.damping if "damping" in self.model_fields_set else None
                yield fault("damping", found=found, expected="the damping of a viscous damper, above 0")


class Pendulum(Description):
    """Centrifugal pendulums on a disc, all of one kind, swinging without rotation of their own (bifilar)."""

    on: str = Field(description="Disc that carries them; its inertia is without theirs.")
    mass: Annotated[float, positive(MASS)] = Field(description="Mass of all pendulums together.")
    radius: Annotated[float, positive(LENGTH)] = Field(
        description="Radius R from the axis of the disc to the centre of the path of the pendulum's mass."
    )
    length: Annotated[float, positive(LENGTH)] = Field(
        description="Length l: radius of the path of the centre of mass. The pendulum is tuned to the order "
        "√(R/l) of its disc."
    )
    damping: Damping = Field(
        0.0,
        description="Viscous damping, as torque on the disc per velocity of the pendulums about its axis.",
    )
    swing_permitted: Annotated[float, positive(ANGLE)] | None = Field(
        None, description="Permitted amplitude of the swing, for which the pendulum counts as linear."
    )

    @property
    def ring_inertia(self) -> float:
        """Moment of inertia about the axis of the disc, the pendulums in their middle [kg m²]."""
        inertia: float = self.mass * (self.radius + self.length) ** 2
        return inertia

    @property
    def swing_per_twist(self) -> float:
        """Angle of swing over the angle by which the mass leads the disc about its axis."""
        return (self.radius + self.length) / self.length

    def stiffness(self, speed: Any) -> Any:
        """Stiffness of the tuned damper that it is at a speed of its disc [N m/rad]."""
        return self.ring_inertia * self.radius / self.length * speed**2
