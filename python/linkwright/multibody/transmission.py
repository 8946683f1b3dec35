r"""Positions of the joints of the tree over the crank angle, with their derivatives.

A hinge turns by the angle of its body relative to the one that carries it, a slide travels along its axis
:math:`\mathbf a`, which turns with the carrier:

.. math:: q = \mathbf r\cdot\mathbf a, \quad q' = \mathbf r'\cdot\mathbf a, \quad
    q'' = \mathbf r''\cdot\mathbf a + \psi'^2 q

Here r is the way of the body's origin from its initial place on the carrier, and ψ the carrier's angle.
All positions are zero at the initial crank angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record, Result
from linkwright.kinetostatics.places import Scene, dot, left, unit
from linkwright.linkages.kinematics import columns_of
from linkwright.linkages.model.structure import FRAME
from linkwright.multibody.tree import Body, Tree, carrying, turned


@dataclass(frozen=True)
class JointMotion(Record):
    """A joint over the crank angle; arrays (n,)."""

    unit: Annotated[str, About('SI unit of the position: "rad" of a hinge, "m" of a slide.')]
    position: Annotated[Floats, About("From the initial position [rad or m].")]
    d1: Annotated[Floats, About("First derivative by the crank angle [– or m/rad].")]
    d2: Annotated[Floats, About("Second derivative [– or m/rad²].")]


@dataclass(frozen=True)
class Transmission(Result):
    """Positions of all joints of a tree over the crank angle: the table that its joints follow."""

    angles: Annotated[Floats, Label("crank angles", "φ", "rad")]
    joints: Annotated[dict[str, JointMotion], About("By the names of the joints, in the order of the tree.")]

    def curves(self) -> dict[str, np.ndarray]:
        """The angles and all columns: ``O``, ``O.d1``, ``O.d2``, ``S.guide``, …."""
        curves = {"angles": self.angles}
        for name, joint in self.joints.items():
            curves |= columns_of(name, joint.position, {"d1": joint.d1, "d2": joint.d2})
        return curves

    @public
    def unit_of(self, name: str) -> str:
        """SI unit of an attribute or a column by its name."""
        of, _, order = name.rpartition(".")
        if name in self.joints:
            return self.joints[name].unit
        if of not in self.joints:
            return super().unit_of(name)
        powers = {"d1": {"rad": "", "m": "m/rad"}, "d2": {"rad": "1/rad", "m": "m/rad²"}}
        return powers[order][self.joints[of].unit]


def transmission(tree: Tree, scene: Scene) -> Transmission:
    """The joints of a tree at the crank angles of a scene, of which the first is that of the tree."""
    joints = {name: _motion(scene, body, tree) for name, body in tree.joints().items()}
    return Transmission(scene.motion.crank_angle, joints)


def _motion(scene: Scene, body: Body, tree: Tree) -> JointMotion:
    turning = [_turning(scene, body.name, n) - _turning(scene, body.parent, n) for n in range(3)]
    if body.kind == "hinge":
        return JointMotion("rad", turning[0] - turning[0][0], turning[1], turning[2])
    angle, d1, d2 = (_turning(scene, body.parent, n) for n in range(3))
    foot = "" if body.parent == FRAME else tree.bodies[body.parent].point
    own, carrier = ([scene.point(point, n) for n in range(3)] for point in (body.point, foot))
    # Where the body would be without its travel, as a point of the carrier.
    arm = _on(angle, body.place)
    way = own[0] - carrier[0] - arm
    way_1 = own[1] - carrier[1] - d1[:, None] * left(arm)
    way_2 = own[2] - carrier[2] - d2[:, None] * left(arm) + d1[:, None] ** 2 * arm
    axis = _on(angle, turned(body.axis, body.turned))
    position = dot(way, axis)
    return JointMotion("m", position, dot(way_1, axis), dot(way_2, axis) + d1**2 * position)


def _on(angle: Floats, vector: Floats) -> Floats:
    """A vector (2,) of a body that has these angles (n,), (n, 2)."""
    e = unit(angle)
    on: Floats = vector[0] * e + vector[1] * left(e)
    return on


def _turning(scene: Scene, name: str, order: int) -> Floats:
    """Angle of a body, or its derivative, (n,); a block turns with what carries it."""
    if name == FRAME:
        return np.zeros(scene.n)
    if name in scene.structure.members:
        return scene.angle(scene.structure.members[name].link, order)
    return _turning(scene, carrying(scene, name)[0], order)


def start_speeds(tree: Tree, speed: float) -> dict[str, float]:
    """Speeds of all joints at the initial position for a speed of the crank [rad/s]."""
    motion = transmission(tree, tree.scene).joints
    return {name: speed * float(joint.d1[0]) for name, joint in motion.items()}
