r"""The rim of a flywheel: its speed, hoop stress, mass and cross-section.

A thin ring of mean radius R and density ρ that turns at ω has, away from arms and hub, the hoop stress

.. math:: \sigma = \rho v^2, \qquad v = \omega R,

whatever its cross-section, and with the share k of the flywheel's moment of inertia J_f in the rim

.. math:: m = \frac{k J_f}{R^2}, \qquad A = \frac{m}{2\pi R \rho}.

References
----------
.. [1] R. S. Khurmi, J. K. Gupta, Theory of Machines, 14th edition, chapter 16: dimensions of the rim.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from linkwright.turning.model import FlywheelRim


class RimSize(NamedTuple):
    """What follows for a rim; fields of the diagram."""

    rim_radius: float | None = None
    rim_speed: float | None = None
    rim_stress: float | None = None
    rim_mass: float | None = None
    rim_area: float | None = None
    rim_width: float | None = None
    rim_thickness: float | None = None


def rim_size(rim: FlywheelRim | None, speed: Any, inertia: Any) -> RimSize:
    """A rim at its mean speed [rad/s], for the moment of inertia of its flywheel [kg m²]."""
    if rim is None:
        return RimSize()
    if rim.stress is None:
        assert rim.radius is not None
        radius = rim.radius
    else:
        radius = np.sqrt(rim.stress / rim.density) / speed
    v = speed * radius
    moving = RimSize(radius, v, rim.density * v**2)
    if not inertia:
        return moving
    mass = rim.inertia_share * inertia / radius**2
    area = mass / (2 * math.pi * radius * rim.density)
    sized = moving._replace(rim_mass=mass, rim_area=area)
    if rim.width_ratio is None:
        return sized
    thickness = np.sqrt(area / rim.width_ratio)
    return sized._replace(rim_width=rim.width_ratio * thickness, rim_thickness=thickness)
