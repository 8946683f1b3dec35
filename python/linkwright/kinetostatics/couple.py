r"""Shaking couples: forces of inertia at their places along the crankshaft.

A body with the force of inertia **F** in the plane z, counted along the axis of the crankshaft towards
an observer who sees counter-clockwise rotation, adds to the frame the couple about the axes x and y

.. math:: \mathbf C = \sum z\,(-F_y,\ F_x), \qquad \mathbf F = -m\,\ddot{\mathbf p}_S

References
----------
.. [1] Norton, Design of Machinery, chapter 12: balancing in two planes.
"""

from __future__ import annotations

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kinetostatics.places import Scene
from linkwright.kinetostatics.wrench import masses
from linkwright.machine.machine import Machine


def has_axial(machine: Machine) -> bool:
    """Whether a body has a place along the crankshaft."""
    return any(body.axial != 0.0 for body in machine.bodies.values())


def inertia_force_and_couple(scene: Scene) -> tuple[Floats, Floats]:
    """Force of inertia [N] and its couple about x and y at the origin [N m], (n, 2) each."""
    force, couple = np.zeros((scene.n, 2)), np.zeros((scene.n, 2))
    for mass in masses(scene):
        own = -mass.mass * mass.acceleration(scene)
        force += own
        couple += couple_of(own, mass.axial)
    return force, couple


def couple_of(force: Floats, axial: float) -> Floats:
    """Couple about x and y of forces (n, 2) in a plane [N m]."""
    return axial * np.stack((-force[:, 1], force[:, 0]), axis=-1)
