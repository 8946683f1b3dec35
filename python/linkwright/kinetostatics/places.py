"""Where members, points and guides are at every crank angle, and how they move."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kinetostatics.motion import Motion
from linkwright.linkages.kinematics import kinematics
from linkwright.linkages.model.element import Guide
from linkwright.linkages.model.structure import FRAME, Structure, structure
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

if TYPE_CHECKING:
    from linkwright.kinetostatics.wrench import Mass


def structure_of(machine: Machine) -> Structure:
    """Members and pairs of a machine, worked out once."""
    kept = compile_machine(machine).kept
    known: Structure | None = kept.get("structure")
    if known is None:
        known = kept["structure"] = structure(machine.linkage)
    return known


class Scene:
    """A machine at all crank angles of a motion.

    Parameters
    ----------
    machine : Machine
        One machine.
    motion : Motion

    Raises
    ------
    ShapeError
        The entries describe many machines.
    InputError
        Nothing moves.
    """

    # Those of `linkwright.kinetostatics.wrench.masses`, once they are known.
    masses: tuple[Mass, ...] | None = None

    def __init__(self, machine: Machine, motion: Motion) -> None:
        compiled = compile_machine(machine)
        # Refuses entries that are arrays over many machines.
        _ = compiled.one
        self.machine = machine
        self.mechanism = machine.linkage
        self.motion = motion
        self.structure = structure_of(machine)
        if not self.structure.members:
            raise InputError("mechanism: found nothing that moves, expected a crank or a linear driver")
        self.links = self.mechanism.links()
        self.kinematics = kinematics(machine, motion.crank_angle)
        self.n = len(motion.crank_angle)
        self.index = {name: i for i, name in enumerate((*self.structure.members, FRAME))}
        self._still = self.zeros(self.n, 2)
        self._rates: dict[str, Floats] = {}
        lengths = [link.length for link in self.links.values() if link.length]
        # Any length of the mechanism's size makes forces and moments comparable.
        self.size = float(np.mean(lengths)) if lengths else 1.0

    def zeros(self, *shape: int) -> Floats:
        """An array to be filled with what follows from the machine."""
        return np.zeros(shape)

    def carrier(self, point: str) -> str:
        """The member that carries a point."""
        return self.structure.carriers[point]

    def point(self, name: str, order: int = 0) -> Floats:
        """Position, first or second derivative of a point by the crank angle, (n, 2)."""
        if name == "":
            return self._still
        motion = self.kinematics.points[name]
        return (motion.position, motion.d1, motion.d2)[order]

    def angle(self, link: str | None, order: int = 0) -> Floats:
        """Angle of a link, or its derivative by the crank angle, (n,); zero for what does not turn."""
        if link is None:
            return np.zeros(self.n)
        motion = self.kinematics.links[link]
        return (motion.angle, motion.d1, motion.d2)[order]

    def reference(self, member: str, order: int = 0) -> Floats:
        """A member's point that its moments count about, (n, 2); the origin for the frame."""
        return self._still if member == FRAME else self.point(self.structure.members[member].point, order)

    def arm(self, member: str, place: Floats) -> Floats | None:
        """From a member's reference point to a place (n, 2); None where that is the point itself."""
        reference = self.reference(member)
        if place is reference:
            return None
        return place if member == FRAME else place - reference

    def turning(self, member: str, order: int = 1) -> Floats:
        """First or second derivative of a member's angle by the crank angle, (n,)."""
        return np.zeros(self.n) if member == FRAME else self.angle(self.structure.members[member].link, order)

    @cached_property
    def squares(self) -> Floats:
        """Square of the crank's speed, (n, 1)."""
        squares: Floats = self.motion.speed[:, None] ** 2
        return squares

    def rate(self, member: str) -> Floats:
        """First derivatives of a member's place and angle, (n, 3)."""
        if member not in self._rates:
            rate = self._rates[member] = self.zeros(self.n, 3)
            rate[:, :2], rate[:, 2] = self.reference(member, 1), self.turning(member)
        return self._rates[member]

    def moved(self, member: str, place: Floats) -> Floats:
        """First derivative, by the crank angle, of the place (n, 2) as a point of a member."""
        arm = place - self.reference(member)
        return self.reference(member, 1) + self.turning(member)[:, None] * left(arm)

    def direction(self, guide: Guide) -> Floats:
        """Unit vector along a guide, (n, 2)."""
        return unit(self.angle(guide.on) + guide.angle)


def unit(angle: Floats) -> Floats:
    """Unit vectors (n, 2) at angles (n,)."""
    return _vectors(np.cos(angle), np.sin(angle))


def left(vector: Floats) -> Floats:
    """Vectors (…, 2) turned by 90° counter-clockwise."""
    return _vectors(-vector[..., 1], vector[..., 0])


def _vectors(x: Floats, y: Floats) -> Floats:
    """Vectors (…, 2) of their components, which may carry derivatives."""
    if type(x) is not np.ndarray:
        return np.stack((x, y), axis=-1)
    vectors = np.empty((*x.shape, 2))
    vectors[..., 0], vectors[..., 1] = x, y
    return vectors


def cross(a: Floats, b: Floats) -> Floats:
    """Moment of b about the foot of a, (…)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def dot(a: Floats, b: Floats) -> Floats:
    """Scalar product (…)."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
