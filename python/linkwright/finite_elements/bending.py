r"""Bending moment of a link as a straight beam between its joints.

.. math:: M(s) = \sum_{x_i < s} \bigl[(x_i - s) F_{y,i} - y_i F_{x,i} + M_i\bigr]

over joints, loads and the inertia of the part before the section s. A body counts as the uniform rod along
the link that has its mass m, its centre and its moment of inertia J, of the length √(12 J/m).

Source: Norton, *Machine Design*, section 3.9; d'Alembert's principle.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from linkwright.finite_elements.result import LinkLoad
from linkwright.kernel.arrays import Floats

# Sections over the length of a link, beside those at its joints.
_SECTIONS = 200

# How far beside a joint its sections are, as a share of the length.
_BESIDE = 1e-9


class LinkMass(NamedTuple):
    """A body on a link, in the axes of the link; arrays (n, 2)."""

    name: str
    mass: float
    inertia: float
    centre: Floats
    acceleration: Floats  # of the centre
    gravity: Floats


def bending_moments(
    loads: Sequence[LinkLoad], masses: Sequence[LinkMass], omega: Floats, alpha: Floats, length: float | None
) -> tuple[Floats, Floats]:
    """Sections along the link, (k,), and the bending moments there, (n, k)."""
    fixed = [float(load.place[0, 0]) for load in loads if load.is_fixed]
    ends = [0.0, length or 0.0, *fixed]
    low, high = min(ends), max(ends)
    beside = _BESIDE * ((high - low) or 1.0)
    corners = [place + side for place in {*ends} for side in (-beside, beside)]
    sections = np.unique([*np.linspace(low, high, _SECTIONS + 1), *corners])
    total = np.zeros((len(omega), len(sections)))
    for load in loads:
        x, y = load.place[:, :1], load.place[:, 1:]
        before = x < sections
        own = (x - sections) * load.force[:, 1:] - y * load.force[:, :1] + load.moment[:, None]
        total += np.where(before, own, 0.0)
    for mass in masses:
        total += _inertia(mass, sections, omega[:, None], alpha[:, None])
    return sections, total


def _inertia(mass: LinkMass, sections: Floats, omega: Floats, alpha: Floats) -> Floats:
    """Moment about each section of weight and inertia of the part of a body before it, (n, k)."""
    x, y = mass.centre[:, :1], mass.centre[:, 1:]
    pull = mass.mass * (mass.gravity - mass.acceleration)
    if mass.mass <= 0 or mass.inertia <= 0:
        # A point mass, or a disc without mass.
        own = (x - sections) * pull[:, 1:] - y * pull[:, :1] - mass.inertia * alpha
        return np.where(x < sections, own, 0.0)
    rod = np.sqrt(12 * mass.inertia / mass.mass)
    # Load per length q₀ + q₁ ξ across and p₀ + p₁ ξ along, over the distance ξ from the centre.
    q0, p0 = pull[:, 1:] / rod, pull[:, :1] / rod
    q1, p1 = -mass.mass * alpha / rod, mass.mass * omega**2 / rod
    arm = x - sections

    def over(xi: Floats) -> Any:
        """The integral of the moment about the section, up to ξ."""
        across = q0 * (arm * xi + xi**2 / 2) + q1 * (arm * xi**2 / 2 + xi**3 / 3)
        return across - y * (p0 * xi + p1 * xi**2 / 2)

    start = np.full_like(arm, -rod / 2)
    moment: Floats = over(np.clip(-arm, -rod / 2, rod / 2)) - over(start)
    return moment
