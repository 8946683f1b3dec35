r"""What turns with one crank throw: mass, static moment and moment of inertia, from its geometry.

Every part is a prism along the shaft or a lump. With its mass m, its centre at r from the axis, and its
inertia $J_S$ about its own centre, which is $m(D^2 + d^2)/8$ for a hollow cylinder,

.. math:: J = \sum (J_S + m r^2)

Drillings and bores are parts of negative mass. A drilling inclined by γ has

.. math:: J_S = m \left[\frac{d^2}{8} \cos^2 γ + \left(\frac{d^2}{16} + \frac{l^2}{12}\right) \sin^2 γ\right]

The published form has the pin, the main journal, disc webs at $R_3$ and two sets of drillings [1]_,

.. math::

    I_k = \frac{γ}{g} \Big\{ & V_{pin} \Big[\frac{D_2^2 + d_2^2}{8} + R^2\Big]
        + V_{main} \frac{D_1^2 + d_1^2}{8} + V_{web} \Big[\frac{D^2}{8} + R_3^2\Big] \\
        & - V_1 \Big[\frac{d_1^2}{8} + R_1^2\Big] - V_2 \frac{d_2^2}{8} \Big\}

It takes drillings as parallel to the shaft, and every bore as concentric.

References
----------
.. [1] Paper 3, equation (16). Its print is damaged; the last terms are read with the diameters of drillings.
.. [2] Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 1, 1956, chapter 2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.tangent import cos, sin, total
from linkwright.torsion.model.engine.polygon import Point, area_moments
from linkwright.torsion.model.engine.throw import Counterweight, CrankThrow, Drilling, Journal

# Webs of a throw.
_WEBS = 2


@dataclass(frozen=True, slots=True)
class ThrowPart:
    """One part of what turns with a throw; holes have negative mass."""

    name: str  # what it is, such as ``pin`` or ``drillings.0``
    mass: float  # its mass [kg]
    centre: Point  # its centre of mass, along the crank and across [m]
    own_inertia: float  # about its own centre, axis along the shaft [kg m²]

    @property
    def inertia(self) -> float:
        """About the axis of the shaft [kg m²]."""
        return self.own_inertia + self.mass * (self.centre[0] ** 2 + self.centre[1] ** 2)


@dataclass(frozen=True, slots=True)
class ThrowInertia:
    """What turns with a throw, as a whole and in parts."""

    parts: tuple[ThrowPart, ...]  # all parts, holes among them
    mass: float  # of the throw [kg]
    static_moment: Point  # mass times distance of its centre from the axis, along the crank and across [kg m]
    inertia: float  # about the axis of the shaft [kg m²]

    @property
    def unbalance(self) -> float:
        """Size of the static moment [kg m]."""
        return math.hypot(*self.static_moment)


def throw_inertia(throw: CrankThrow) -> ThrowInertia:
    """Mass, static moment and inertia of a throw, exact for its shapes, without fillets and chamfers."""
    parts = tuple(_parts(throw))
    mass, inertia = total(part.mass for part in parts), total(part.inertia for part in parts)
    if mass <= 0 or inertia <= 0:
        raise InputError(
            f"crank throw: found {mass:.6g} kg and {inertia:.6g} kg m² left after drillings and bores, "
            "expected more than 0; check diameters, lengths and radii of the drillings"
        )
    moment = tuple(total(part.mass * part.centre[n] for part in parts) for n in (0, 1))
    return ThrowInertia(parts, mass, (moment[0], moment[1]), inertia)


def _parts(throw: CrankThrow) -> Iterator[ThrowPart]:
    rho, R, pin = throw.density, throw.radius, throw.pin
    yield from _cylinder("journal", throw.journal, rho, 0.0, 0.0)
    yield from _cylinder("pin", pin, rho, R, R + pin.bore_offset)
    yield _webs(throw)
    for n, drilling in enumerate(throw.drillings):
        yield _hole(f"drillings.{n}", drilling, rho)
    for n, weight in enumerate(throw.counterweights):
        yield _counterweight(f"counterweights.{n}", weight, rho)


def _round(name: str, diameter: float, length: float, density: float, at: float) -> ThrowPart:
    """A cylinder along the shaft; of negative density for a hole."""
    mass = density * _volume(diameter, length)
    return ThrowPart(name, mass, (at, 0.0), mass * diameter**2 / 8)


def _cylinder(name: str, journal: Journal, density: float, at: float, bore: float) -> Iterator[ThrowPart]:
    yield _round(name, journal.diameter, journal.length, density, at)
    if journal.inner_diameter > 0:
        yield _round(f"{name}.bore", journal.inner_diameter, journal.length, -density, bore)


def _webs(throw: CrankThrow) -> ThrowPart:
    web, volume = throw.web, _WEBS * throw.web.thickness
    if web.outline == "polygon":
        area, centre, polar = area_moments(web.corners)
        return ThrowPart("webs", throw.density * volume * area, centre, throw.density * volume * polar)
    if web.outline == "disc":
        assert web.diameter is not None
        return _round("webs", web.diameter, volume, throw.density, throw.web_centre)
    a, b = throw.web_length, web.breadth
    mass = throw.density * volume * a * b
    return ThrowPart("webs", mass, (throw.web_centre, 0.0), mass * (a * a + b * b) / 12)


def _hole(name: str, drilling: Drilling, density: float) -> ThrowPart:
    """A drilling, as negative mass."""
    d, length, gamma = drilling.diameter, drilling.length, drilling.inclination
    mass = -density * _volume(d, length)
    own = d**2 / 8 * cos(gamma) ** 2 + (d**2 / 16 + length**2 / 12) * sin(gamma) ** 2
    return ThrowPart(name, mass, (drilling.radius, 0.0), mass * own)


def _counterweight(name: str, weight: Counterweight, density: float) -> ThrowPart:
    if weight.mass is not None:
        assert weight.radius is not None
        mass, r, own = weight.mass, weight.radius, weight.inertia or 0.0
    else:
        mass, r, own = _sector(weight, density if weight.density is None else weight.density)
    at = (r * cos(weight.direction), r * sin(weight.direction))
    return ThrowPart(name, mass, at, own)


def _sector(weight: Counterweight, density: float) -> tuple[float, float, float]:
    """Mass, distance of the centre from the axis, and own inertia of a sector of a ring."""
    assert weight.outer_radius is not None
    assert weight.angle is not None
    assert weight.thickness is not None
    b, a, half = weight.outer_radius, weight.inner_radius or 0.0, weight.angle / 2
    mass = density * weight.thickness * half * (b - a) * (b + a)
    centre = 2 / 3 * (a * a + a * b + b * b) / (a + b) * sin(half) / half
    return mass, centre, mass * ((a * a + b * b) / 2 - centre**2)


def published_inertia(throw: CrankThrow) -> float:
    """Inertia about the shaft by the published (16), disc webs, drillings parallel to the shaft [kg m²]."""
    web, pin, journal, R = throw.web, throw.pin, throw.journal, throw.radius
    if web.outline != "disc":
        raise InputError(
            f'formula (16): found webs of outline "{web.outline}", expected "disc"; throw_inertia takes any'
        )
    assert web.diameter is not None
    terms = [
        _ring_volume(pin) * ((pin.diameter**2 + pin.inner_diameter**2) / 8 + R**2),
        _ring_volume(journal) * (journal.diameter**2 + journal.inner_diameter**2) / 8,
        _volume(web.diameter, _WEBS * web.thickness) * (web.diameter**2 / 8 + throw.web_centre**2),
    ]
    holes = ((drilling.diameter, drilling.length, drilling.radius) for drilling in throw.drillings)
    terms += [-_volume(d, length) * (d**2 / 8 + at**2) for d, length, at in holes]
    inertia: float = throw.density * total(terms)
    return inertia


def _volume(diameter: float, length: float) -> float:
    return math.pi / 4 * diameter**2 * length


def _ring_volume(journal: Journal) -> float:
    d, bore = journal.diameter, journal.inner_diameter
    return math.pi / 4 * (d - bore) * (d + bore) * journal.length
