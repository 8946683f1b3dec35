r"""Counterweights against the forces that a mechanism does to its frame.

A counterweight on a link that turns about a fixed point adds to the shaking force

.. math:: -\frac{d^2}{dt^2}\left(\mathbf R(\psi)\,\mathbf u\right), \qquad \mathbf u = m\,(x, y)

which is linear in its moment **u** about the pivot: the best counterweights are a linear problem of least
squares. For a four-bar on whose crank and rocker they sit, the rest is zero, and they are those of Berkof
and Lowen.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Shown
from linkwright.kernel.result import Record
from linkwright.kernel.units import LENGTH, SPEED, positive
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.motion import Motion, motion_at
from linkwright.kinetostatics.places import Scene, left, unit
from linkwright.kinetostatics.result import Forces
from linkwright.linkages.model.structure import FRAME
from linkwright.machine.machine import Machine

Floats = NDArray[np.float64]

# Moment of a counterweight, over the largest, that is not worth a body: rounding.
_NOTHING = 1e-12


@dataclass(frozen=True)
class Counterweight(Record):
    """A mass on a link that turns about a fixed point."""

    link: Annotated[str, About("The link.")]
    moment: Annotated[float, Shown("mass times distance from the pivot", "", "kg m")]
    angle: Annotated[float, Shown("direction from that of the link", "", "rad")]
    mass: Annotated[float, Shown("mass", "", "kg")]
    radius: Annotated[float, Shown("distance from the pivot", "", "m")]


@dataclass(frozen=True)
class Balance(Record):
    """A machine with counterweights, and what they do."""

    machine: Annotated[Machine, About("With a body for each counterweight.")]
    counterweights: Annotated[tuple[Counterweight, ...], About("In the order of the links.")]
    before: Annotated[Forces, About("Forces without them.")]
    after: Annotated[Forces, About("Forces with them, at the same motion.")]

    def measures(self) -> dict[str, tuple[float, float]]:
        """Root mean squares over time without and with the counterweights.

        Returns
        -------
        dict of str to tuple of float
            ``shaking_force`` [N], that of inertia alone; ``shaking_moment`` about the origin, of inertia
            alone [N m]; ``torque_drive``, all of it [N m].
        """
        return {name: (_rms(self.before, name), _rms(self.after, name)) for name in _MEASURES}


_MEASURES = ("shaking_force", "shaking_moment", "torque_drive")


def _rms(result: Forces, name: str) -> float:
    """Root mean square over time, of shaking forces the share of inertia."""
    values = getattr(result if name == "torque_drive" else result.contributions["inertia"], name)
    squares = values**2 if values.ndim == 1 else (values**2).sum(axis=1)
    return float(np.sqrt(result.motion.mean(squares)))


@public
def balance(
    machine: Machine,
    links: Sequence[str],
    *,
    speed: float | None = None,
    radius: float | Mapping[str, float] | None = None,
    n: int = 360,
) -> Balance:
    """Counterweights on given links that minimise the rms of the shaking force of inertia.

    Parameters
    ----------
    machine : Machine
        The machine.
    links : sequence of str
        Links that turn about fixed points.
    speed : float, optional
        Of the crank [rad/s]. Default: the steady motion of the motor, or the drive's design speed. At a
        constant speed the counterweights do not depend on it.
    radius : float or mapping of str to float, optional
        Distance of the counterweights from their pivots, of all or by link [m]. Default: the link's
        length.
    n : int
        Intervals of the revolution.

    Returns
    -------
    Balance
        The machine with the counterweights, forces before and after.

    Raises
    ------
    MachineError
        A link that does not exist or does not turn about a fixed point.
    InputError
        A speed of 0, or a radius that is not positive.

    References
    ----------
    .. [1] Berkof, Lowen, A new method for completely force balancing simple linkages, J. Eng. Ind. 91 (1969).
    .. [2] Lowen, Tepper, Berkof, Balancing of linkages – an update, Mech. Mach. Theory 18 (1983).
    """
    require_turning(speed)
    scene = Scene(machine, motion_at(machine, None, speed=speed, n=n))
    _check_links(scene, links)
    before = forces(machine, scene.motion)
    columns = [column for link in links for column in _unit_forces(scene, link)]
    weights = np.sqrt(_time_weights(scene.motion))[:, None]
    A = np.stack([(weights * column).ravel() for column in columns], axis=-1)
    b = (weights * before.contributions["inertia"].shaking_force).ravel()
    known = np.isfinite(b)
    u = np.linalg.lstsq(A[known], -b[known], rcond=None)[0].reshape(-1, 2)
    return with_counterweights(machine, scene, dict(zip(links, u, strict=True)), radius, before)


def _check_links(scene: Scene, links: Sequence[str]) -> None:
    """Links must turn about fixed points."""
    members = scene.structure.members
    able = [n for n, each in members.items() if each.link == n and scene.carrier(each.point) == FRAME]
    wrong = [link for link in links if link not in able]
    if wrong or not links:
        expected = f"links that turn about fixed points: {', '.join(able)}"
        raise MachineError(
            [Problem("links", link, expected, suggestion(link, able)) for link in wrong or [""]]
        )


def _unit_forces(scene: Scene, link: str) -> list[Floats]:
    """Shaking force from a counterweight of 1 kg m along a link, and from one to its left."""
    e, motion = unit(scene.angle(link)), scene.motion
    rate = (scene.angle(link, 1) * motion.speed)[:, None]
    gain = (scene.angle(link, 2) * motion.speed**2 + scene.angle(link, 1) * motion.acceleration)[:, None]
    return [-(gain * left(each) - rate**2 * each) for each in (e, left(e))]


def _time_weights(motion: Motion) -> Floats:
    """Weights of the trapezoidal rule over time."""
    step = np.abs(np.diff(motion.time))
    time_weights: Floats = 0.5 * (np.append(step, 0.0) + np.append(0.0, step))
    return time_weights


def with_counterweights(
    machine: Machine, scene: Scene, moments: Mapping[str, Floats], radius: Any, before: Forces
) -> Balance:
    """A machine with counterweights of given moments.

    `moments` (2,): link → mass times place along the link and to its left [kg m]. Returns: with the forces of
    the new machine.
    """
    largest = max(float(np.hypot(*u)) for u in moments.values())
    found, bodies = [], dict(machine.bodies)
    for link, u in moments.items():
        at = radius.get(link) if isinstance(radius, Mapping) else radius
        at = scene.links[link].length if at is None else at
        in_range(**{f"radius of {link}": (at, positive(LENGTH))})
        size, angle = float(np.hypot(*u)), float(np.arctan2(u[1], u[0]))
        found.append(Counterweight(link, size, angle, size / at, at))
        if size > _NOTHING * largest:
            place = {"along": at * float(np.cos(angle)), "across": at * float(np.sin(angle))}
            bodies[_free_name(link, bodies)] = Body(on=link, mass=size / at, inertia=0.0, **place)
    balanced = machine.with_entries({"bodies": bodies})
    return Balance(balanced, tuple(found), before, forces(balanced, scene.motion))


def require_turning(speed: float | None) -> None:
    """Refuse a speed at which there is no inertia to balance."""
    if speed is not None:
        in_range(speed=(abs(speed), positive(SPEED)))


def _free_name(link: str, bodies: Mapping[str, Body]) -> str:
    """Name of a counterweight's body that no other has."""
    name = f"counterweight_{link.replace('.', '_')}"
    while name in bodies:
        name += "_2"
    return name
