r"""All loads on one link in its own axes: x from its start to its end, y to the left, about its start.

.. math:: \sum \mathbf F + m\,\mathbf g - m\,\mathbf a_S = 0, \qquad
    \mathbf a(\mathbf r) = \mathbf a_0 + \alpha \times \mathbf r - \omega^2 \mathbf r

where a₀ is the acceleration of the start, ω and α are the speed and the acceleration of the link.

Source: Norton, *Design of Machinery*, chapter 11; d'Alembert's principle.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linkwright.drive.steady_state import SteadyState
from linkwright.drive.transient import Transient
from linkwright.finite_elements.bending import LinkMass, bending_moments
from linkwright.finite_elements.result import LinkLoad, LinkLoads
from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.public import public
from linkwright.kinetostatics.applied import AppliedLoad, gravity, together
from linkwright.kinetostatics.collect import DRIVES, Collector
from linkwright.kinetostatics.forces import PRESSURE_ANGLE, acting, solved
from linkwright.kinetostatics.friction import Friction
from linkwright.kinetostatics.model.loads import Gravity
from linkwright.kinetostatics.motion import Motion, motion_at
from linkwright.kinetostatics.places import Scene, cross, unit
from linkwright.kinetostatics.wrench import masses
from linkwright.machine.machine import Machine


@public
def link_loads(
    machine: Machine,
    link: str,
    motion: SteadyState | Transient | Motion | None = None,
    *,
    speed: float | None = None,
    acceleration: float = 0.0,
    angles: ArrayLike | None = None,
    n: int = 360,
    friction: Mapping[str, Friction] | None = None,
    pressure_angle: float = PRESSURE_ANGLE,
) -> LinkLoads:
    """Loads on one link in its own axes, for its stress analysis.

    Parameters
    ----------
    machine : Machine
        The machine, with bodies and loads.
    link : str
        Name of the link or block, such as ``"R.coupler"``.
    motion, speed, acceleration, angles, n, friction, pressure_angle
        As of `forces`.

    Returns
    -------
    LinkLoads
        Forces and moments at its joints, weight, inertia, acceleration field, bending moment.

    Raises
    ------
    FindingError
        As of `forces`.
    InputError
        There is no such link, or as of `forces`.
    """
    at = motion_at(machine, motion, speed=speed, acceleration=acceleration, angles=angles, n=n)
    return loads_of_links(Scene(machine, at), (link,), friction or {}, pressure_angle)[link]


def loads_of_links(
    scene: Scene, links: tuple[str, ...], friction: Mapping[str, Friction], pressure_angle: float
) -> dict[str, LinkLoads]:
    """The loads of several links by one solution for all forces."""
    known = scene.structure.members
    for link in links:
        if link not in known:
            expected = f"a link of the machine; {suggestion(link, known)}".removesuffix("; ")
            raise InputError(f"link: found {show(link)}, expected {expected}")
    models, sources = acting(scene, friction, pressure_angle)
    columns = {"": together(scene, sources.values())}
    solution = solved(scene, models, columns)[1]
    collector = Collector(scene, models, sources, columns, solution)
    findings = collector.forces().findings
    return {link: _Link(scene, link, collector, sources).loads(findings) for link in links}


@dataclass
class _Link:
    """A member with all that acts on it."""

    scene: Scene
    name: str
    collector: Collector
    sources: Mapping[str, AppliedLoad]

    def loads(self, findings: tuple[str, ...]) -> LinkLoads:
        """Everything in the axes of the link."""
        scene, motion = self.scene, self.scene.motion
        omega = scene.turning(self.name) * motion.speed
        alpha = scene.turning(self.name, 2) * motion.speed**2 + scene.turning(self.name) * motion.acceleration
        origin = self._turned(self._acceleration())
        weights = self._weights()
        carried = tuple(self._masses(origin, omega, alpha, weights))
        parts = {part.name: part for part in self._parts()}
        known = scene.links.get(self.name)
        length = None if known is None or not known.length else float(known.length)
        places, moments = bending_moments(tuple(parts.values()), carried, omega, alpha, length)
        largest = np.argmax(np.abs(moments), axis=1)
        row, still = np.arange(scene.n), np.zeros(scene.n)
        return LinkLoads(
            crank_angle=motion.crank_angle,
            time=motion.time,
            link=self.name,
            length=length,
            angle=scene.turning(self.name, 0),
            speed=omega,
            acceleration=alpha,
            origin_acceleration=origin,
            gravity=weights,
            mass=sum(mass.mass for mass in carried),
            weight=sum((mass.mass * weights for mass in carried), start=np.zeros((scene.n, 2))),
            weight_moment=sum((cross(mass.centre, mass.mass * weights) for mass in carried), start=still),
            inertia_force=sum(
                (-mass.mass * mass.acceleration for mass in carried), start=np.zeros((scene.n, 2))
            ),
            inertia_moment=sum(
                (
                    -mass.mass * cross(mass.centre, mass.acceleration) - mass.inertia * alpha
                    for mass in carried
                ),
                start=still,
            ),
            bending=moments[row, largest],
            bending_place=places[largest],
            loads=parts,
            turns=scene.structure.members[self.name].turns,
            size=scene.size,
            findings=findings,
        )

    def _acceleration(self) -> Floats:
        """Acceleration of the start of the link, (n, 2)."""
        scene = self.scene
        d1, d2 = (scene.reference(self.name, order) for order in (1, 2))
        return d2 * scene.squares + d1 * scene.motion.acceleration[:, None]

    def _turned(self, vector: Floats) -> Floats:
        """Vectors (n, 2) in the axes of the link."""
        e = unit(self.scene.turning(self.name, 0))
        return np.stack([(vector * e).sum(axis=1), cross(e, vector)], axis=1)

    def _weights(self) -> Floats:
        """Acceleration of gravity in the axes of the link, (n, 2)."""
        total = gravity(self.scene.machine)
        return self._turned(np.broadcast_to(total, (self.scene.n, 2)))

    def _masses(self, origin: Floats, omega: Floats, alpha: Floats, gravity: Floats) -> Iterator[LinkMass]:
        for mass in masses(self.scene):
            if mass.member == self.name:
                arm = self._turned(mass.centre - self.scene.reference(self.name))
                yield LinkMass(
                    mass.name,
                    float(mass.mass),
                    float(mass.inertia),
                    arm,
                    self._turned(mass.acceleration(self.scene)),
                    gravity,
                )

    def _parts(self) -> Iterator[LinkLoad]:
        """What joints, drives and loads do."""
        collector, structure = self.collector, self.scene.structure
        for model, span in zip(collector.models, collector.spans, strict=True):
            if not model.acts_on(self.name):
                continue
            wrench = collector.passed(model, span, collector.total, self.name)
            if model.extra is not None and model.friction.viscous:
                wrench = wrench + model.viscous[:, None] * model.extra.on_member(self.name)
            # A crank's pin and its drive have one name.
            pair = None if model.kind in DRIVES else structure.pairs[model.name]
            name = f"{model.name} drive" if pair is None else pair.name
            yield self._at(name, "drive" if pair is None else pair.kind, pair and pair.point, wrench)
        for name, source in self.sources.items():
            load = self.scene.machine.all_loads.get(name.removeprefix("loads."))
            wrench = source.wrenches.on_member(self.name)
            if load is None or isinstance(load, Gravity) or not wrench.any():
                continue
            yield self._at(name, "load", self._point_of(load), wrench)

    def _point_of(self, load: object) -> str | None:
        """The point of the link that a load acts on; None where it is not one of them."""
        named = [getattr(load, "on", None), *(getattr(load, "between", None) or ())]
        own = [point for point in named if self.scene.structure.carriers.get(point or "") == self.name]
        return own[0] if len(own) == 1 else None

    def _at(self, name: str, kind: str, point: str | None, wrench: Floats) -> LinkLoad:
        """A force and a moment about the start of the link, moved to the point where they act."""
        start = self.scene.reference(self.name)
        place = (
            np.zeros((self.scene.n, 2)) if point is None else self._turned(self.scene.point(point) - start)
        )
        force = self._turned(wrench[:, :2])
        return LinkLoad(name, kind, place, force, wrench[:, 2] - cross(place, force))
