r"""Forces and couples on members, and those of accelerated masses by d'Alembert.

.. math:: \mathbf F = -m\,\ddot{\mathbf p}_S, \qquad M = -J_S\,\ddot\psi

Source: Wittenbauer, *Graphische Dynamik*; Norton, *Design of Machinery*, chapter 11.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Bools, Floats
from linkwright.kinetostatics.places import Scene, cross, left, unit
from linkwright.linkages.model.element import Guide
from linkwright.linkages.model.structure import FRAME, Pair
from linkwright.machine.program.loads import link_body


class Wrenches:
    """A force and a moment on each member that anything acts on, the frame among them.

    Parameters
    ----------
    scene : Scene
        What the members are.

    Attributes
    ----------
    on : dict of str to ndarray, shape (n, 3)
        By member: force along x and y [N] and moment about the member's reference point [N m]; of the frame
        about the origin.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.on: dict[str, Floats] = {}

    def _to(self, member: str) -> Floats:
        if member not in self.on:
            self.on[member] = self.scene.zeros(self.scene.n, 3)
        return self.on[member]

    def on_member(self, member: str) -> Floats:
        """Force and moment on one member, (n, 3)."""
        return self.on[member] if member in self.on else self.scene.zeros(self.scene.n, 3)

    @property
    def values(self) -> Floats:
        """Forces and moments on all members and, last, on the frame, (n, members + 1, 3)."""
        values = self.scene.zeros(self.scene.n, len(self.scene.index), 3)
        for member, wrench in self.on.items():
            values[:, self.scene.index[member]] += wrench
        return values

    def add(self, other: Wrenches, factor: Floats | None = None) -> Wrenches:
        """Add others, times factors (n,)."""
        for member, wrench in other.on.items():
            more = wrench if factor is None else factor[:, None] * wrench
            self.on[member] = self.on[member] + more if member in self.on else more.copy()
        return self

    def taken_over(self, other: Wrenches, own: Bools) -> None:
        """Keep these where they are one's own, (n,), and take others elsewhere."""
        for member in {**self.on, **other.on}:
            self.on[member] = np.where(own[:, None], self.on_member(member), other.on_member(member))

    def force(self, member: str, force: Floats, place: Floats) -> Wrenches:
        """Add a force (n, 2) at a place (n, 2)."""
        arm, is_first = self.scene.arm(member, place), member not in self.on
        to = self._to(member)
        if is_first:
            to[:, :2] = force
        else:
            to[:, :2] += force
        if arm is not None:
            to[:, 2] += cross(arm, force)
        return self

    def couple(self, member: str, moment: Floats) -> Wrenches:
        """Add a moment (n,)."""
        self._to(member)[:, 2] += moment
        return self

    def between(self, first: str, second: str, force: Floats, place: Floats) -> Wrenches:
        """Add a force on the second member, and the opposite one on the first."""
        return self.force(second, force, place).force(first, -force, place)

    def on_guide(self, pair: Pair, force: Floats) -> Wrenches:
        """Add a force on the second member of a guide; the guide's body takes the opposite one.

        It goes to what carries the point that the guide passes through, its moment about that point to what
        turns the guide: as a rule the same body.
        """
        assert pair.guide is not None
        place = self.scene.point(pair.point)
        self.force(pair.second, force, place)
        through = self.scene.structure.guide_point(pair.guide)
        holder, turner = _holds_guide(pair.guide, through, self.scene), turns_guide(pair.guide, self.scene)
        if holder == turner:
            return self.force(holder, -force, place)
        foot = self.scene.point(through)
        return self.force(holder, -force, foot).couple(turner, -cross(place - foot, force))

    def turning_guide(self, pair: Pair) -> Wrenches:
        """Add 1 N m on the second member of a guide; what turns the guide takes the opposite one."""
        assert pair.guide is not None
        one = np.ones(self.scene.n)
        return self.couple(pair.second, one).couple(turns_guide(pair.guide, self.scene), -one)

    def along_slide(self, on: str, force: Floats) -> Wrenches:
        """Add a force (n,) along a slide on what slides, and its opposite on the guide."""
        pair = self.scene.structure.pairs[f"{on}.guide"]
        assert pair.guide is not None
        t = self.scene.direction(pair.guide)
        return self.on_guide(pair, force[:, None] * t)

    def at_point(self, point: str, force: Floats) -> Wrenches:
        """Add a force (n, 2) on what carries a point."""
        return self.force(self.scene.carrier(point), force, self.scene.point(point))

    def power(self) -> Floats:
        """Σ F·p′ + M ψ′ over the members, (n,) [N m]; times the speed it is power."""
        total = self.scene.zeros(self.scene.n)
        for member, wrench in self.on.items():
            if member != FRAME:
                total = total + np.einsum("nc,nc->n", wrench, self.scene.rate(member))
        return total


def units_between(scene: Scene, first: str, second: str, place: Floats) -> list[Wrenches]:
    """1 N along x, and along y, at a place (n, 2) on the second member; the opposite one on the first."""
    units = along_x, along_y = Wrenches(scene), Wrenches(scene)
    for member, size in ((second, 1.0), (first, -1.0)):
        on_x, on_y = (unit.on.setdefault(member, scene.zeros(scene.n, 3)) for unit in units)
        on_x[:, 0] = on_y[:, 1] = size
        arm = scene.arm(member, place)
        if arm is not None:
            on_x[:, 2], on_y[:, 2] = arm[:, 1] * -size, arm[:, 0] * size
    return [along_x, along_y]


def _holds_guide(guide: Guide, through: str, scene: Scene) -> str:
    """The member that takes the force on a guide: its link, or what carries a point elsewhere."""
    if guide.on is not None and through in (scene.links[guide.on].start, scene.links[guide.on].end):
        return guide.on
    return scene.carrier(through)


def turns_guide(guide: Guide, scene: Scene) -> str:
    """The member that keeps the direction of a guide: its link, the block it rides on, or the frame."""
    if guide.on is not None:
        return guide.on
    carrier = FRAME if guide.through is None else scene.carrier(guide.through)
    return carrier if carrier == FRAME or _keeps_direction(carrier, scene) else FRAME


def _keeps_direction(member: str, scene: Scene) -> bool:
    """Whether a member slides without turning, and can take a moment: a block, or a yoke on the frame."""
    body = scene.structure.members[member]
    yoke = scene.mechanism.yokes.get(member)
    return body.turns and (body.link is None or (yoke is not None and yoke.guide.on is None))


class Mass(NamedTuple):
    """A mass on a member, with its centre and the derivatives of that by the crank angle, (n, 2) each."""

    name: str
    member: str
    mass: float
    inertia: float
    centre: Floats
    d1: Floats
    d2: Floats
    axial: float  # place along the crankshaft [m]

    def acceleration(self, scene: Scene) -> Floats:
        """Of the centre, (n, 2) [m/s²]."""
        acceleration: Floats = self.d2 * scene.squares + self.d1 * scene.motion.acceleration[:, None]
        return acceleration


def masses(scene: Scene) -> tuple[Mass, ...]:
    """All masses of a machine. Returns: one for each body of the description."""
    if scene.masses is None:
        scene.masses = tuple(_masses(scene))
    return scene.masses


def _masses(scene: Scene) -> Iterator[Mass]:
    for name, body in scene.machine.bodies.items():
        on = body.on or name
        if on not in scene.links:
            centre, d1, d2 = (scene.point(on, order) for order in (0, 1, 2))
            mass = 0.0 if body.mass is None else body.mass
            yield Mass(name, scene.carrier(on), mass, 0.0, centre, d1, d2, body.axial)
            continue
        along, across, mass, inertia = link_body(body, scene.links[on].length)
        yield Mass(name, on, mass, inertia, *_on_link(scene, on, along, across), body.axial)


def _on_link(scene: Scene, link: str, along: float, across: float) -> tuple[Floats, Floats, Floats]:
    e = unit(scene.angle(link))
    arm = along * e + across * left(e)
    turn, bend = scene.angle(link, 1)[:, None], scene.angle(link, 2)[:, None]
    start = [scene.reference(link, order) for order in (0, 1, 2)]
    return start[0] + arm, start[1] + turn * left(arm), start[2] + bend * left(arm) - turn**2 * arm


def inertia_forces(scene: Scene) -> Wrenches:
    """The forces of all masses. Returns: −m a at the centre and −J ψ̈ on each member."""
    wrenches = Wrenches(scene)
    squares, acceleration = scene.squares[:, 0], scene.motion.acceleration
    for mass in masses(scene):
        wrenches.force(mass.member, -mass.mass * mass.acceleration(scene), mass.centre)
        # A zero that carries derivatives counts.
        if not (isinstance(mass.inertia, float) and mass.inertia == 0.0):
            turning = scene.turning(mass.member, 2) * squares + scene.turning(mass.member) * acceleration
            wrenches.couple(mass.member, -mass.inertia * turning)
    return wrenches
