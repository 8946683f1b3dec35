r"""The forces of accelerated masses, by d'Alembert.

.. math:: \mathbf F = -m\,\ddot{\mathbf p}_S, \qquad M = -J_S\,\ddot\psi

Source: Wittenbauer, *Graphische Dynamik*; Norton, *Design of Machinery*, chapter 11.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kinetostatics.places import Scene, left, unit
from linkwright.kinetostatics.wrench import Wrenches
from linkwright.machine.program.loads import link_body

Floats = NDArray[np.float64]


class Mass(NamedTuple):
    """A mass on a member, with its centre and the derivatives of that by the crank angle, (n, 2) each."""

    name: str
    member: str
    mass: float
    inertia: float
    centre: Floats
    d1: Floats
    d2: Floats

    def acceleration(self, scene: Scene) -> Floats:
        """Of the centre, (n, 2) [m/s²]."""
        motion = scene.motion
        found: Floats = self.d2 * motion.speed[:, None] ** 2 + self.d1 * motion.acceleration[:, None]
        return found


def masses(scene: Scene) -> Iterator[Mass]:
    """All masses of a machine. Returns: one for each body of the description."""
    for name, body in scene.machine.bodies.items():
        on = body.on or name
        if on not in scene.links:
            places = [scene.point(on, order) for order in (0, 1, 2)]
            yield Mass(name, scene.carrier(on), float(body.mass or 0.0), 0.0, *places)
            continue
        along, across, mass, inertia = link_body(body, scene.links[on].length)
        yield Mass(name, on, float(mass), float(inertia), *_on_link(scene, on, along, across))


def _on_link(scene: Scene, link: str, along: float, across: float) -> tuple[Floats, Floats, Floats]:
    """A point of a link and its derivatives."""
    e = unit(scene.angle(link))
    arm = along * e + across * left(e)
    turn, bend = scene.angle(link, 1)[:, None], scene.angle(link, 2)[:, None]
    start = [scene.reference(link, order) for order in (0, 1, 2)]
    return start[0] + arm, start[1] + turn * left(arm), start[2] + bend * left(arm) - turn**2 * arm


def inertia_forces(scene: Scene) -> Wrenches:
    """The forces of all masses. Returns: −m a at the centre and −J ψ̈ on each member."""
    wrenches = Wrenches(scene)
    speed, acceleration = scene.motion.speed, scene.motion.acceleration
    for mass in masses(scene):
        wrenches.force(mass.member, -mass.mass * mass.acceleration(scene), mass.centre)
        if mass.inertia:
            turning = scene.turning(mass.member, 2) * speed**2 + scene.turning(mass.member) * acceleration
            wrenches.couple(mass.member, -mass.inertia * turning)
    return wrenches
