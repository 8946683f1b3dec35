r"""Counterweights against the forces that a mechanism does to its frame.

A counterweight on a link that turns about a fixed point adds to the shaking force

.. math:: -\frac{d^2}{dt^2}\left(\mathbf R(\psi)\,\mathbf u\right), \qquad \mathbf u = m\,(x, y)

which is linear in its moment **u** about the pivot: the best counterweights are a linear problem of least
squares. For a four-bar on whose crank and rocker they sit, the rest is zero, and they are those of Berkof and
Lowen. In two planes across the crankshaft they balance the couple as well: the shaking force is divided
between both planes, as between two bearings, and the squares of both parts are minimised. Formulas give
counterweights for a share of a slider's mass, and for the full balance of a four-bar.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, MachineError, Problem
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.reader.numbers import NOISE
from linkwright.kernel.result import Record
from linkwright.kernel.units.kinds import LENGTH, MASS, RATIO, SPEED
from linkwright.kernel.units.marks import SHARE, Quantity, not_negative, positive
from linkwright.kinetostatics.couple import couple_of
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.model.body import Body
from linkwright.kinetostatics.motion import Motion, has_speed, motion_at
from linkwright.kinetostatics.places import Scene, left, unit
from linkwright.kinetostatics.result import Forces
from linkwright.kinetostatics.wrench import masses
from linkwright.linkages.model.structure import FRAME
from linkwright.machine.machine import Machine

# Moment of a counterweight, over the largest, that is not worth a body: rounding.
_NOTHING = 1e-12


@dataclass(frozen=True)
class Counterweight(Record):
    """A mass on a link that turns about a fixed point."""

    link: Annotated[str, About("The link.")]
    moment: Annotated[float, Label("mass times distance from the pivot", "", "kg m")]
    angle: Annotated[float, Label("direction from that of the link", "", "rad")]
    mass: Annotated[float, Label("mass", "", "kg")]
    radius: Annotated[float, Label("distance from the pivot", "", "m")]
    axial: Annotated[float, Label("position along the crankshaft", "z", "m")] = 0.0


@dataclass(frozen=True)
class Balance(Record):
    """A machine with counterweights, and what they do."""

    machine: Annotated[Machine, About("With a body for each counterweight.")]
    counterweights: Annotated[tuple[Counterweight, ...], About("In the order of the links.")]
    before: Annotated[Forces, About("Forces without them.")]
    after: Annotated[Forces, About("Forces with them, at the same motion.")]

    def measures(self) -> dict[str, tuple[float, float]]:
        """Root mean squares over time without and with the counterweights.

        ``shaking_force`` [N], that of inertia alone; ``shaking_moment`` about the origin, of inertia alone [N
        m]; ``torque_drive``, all of it [N m]; ``shaking_couple`` about the plane z = 0 [N m], where a body
        has a place along the crankshaft.
        """
        names = [*_MEASURES, *(["shaking_couple"] if self.after.shaking_couple is not None else [])]
        noise = _noise(Scene(self.machine, self.before.motion))
        measured = {name: (_rms(self.before, name), _rms(self.after, name)) for name in names}
        return {
            name: (_without(noise[name], before), _without(noise[name], after))
            for name, (before, after) in measured.items()
        }


_MEASURES = ("shaking_force", "shaking_moment", "torque_drive")

# Measures that are of inertia alone by themselves.
_WHOLE = ("torque_drive", "shaking_couple")


def _noise(scene: Scene) -> dict[str, float]:
    """Rounding level of the inertia forces of all bodies [N, N m]."""
    force = moment = 0.0
    for mass in masses(scene):
        size = mass.mass * float(np.hypot(*mass.acceleration(scene).T).max())
        force += size
        moment += size * (float(np.hypot(*mass.centre.T).max()) + abs(mass.axial))
    return dict.fromkeys(_MEASURES + _WHOLE, NOISE * moment) | {"shaking_force": NOISE * force}


def _without(noise: float, value: float) -> float:
    """A measure, 0 where it is rounding."""
    return 0.0 if value <= noise else value


def _rms(result: Forces, name: str) -> float:
    values = getattr(result if name in _WHOLE else result.contributions["inertia"], name)
    if values is None:
        return 0.0
    squares = values**2 if values.ndim == 1 else (values**2).sum(axis=1)
    return float(np.sqrt(result.motion.mean(squares)))


@public
def balance(
    machine: Machine,
    links: Sequence[str],
    *,
    speed: float | None = None,
    radius: float | Mapping[str, float] | None = None,
    planes: Sequence[float] = (0.0,),
    n: int = 360,
) -> Balance:
    """Counterweights on given links that minimise the rms of the shaking force of inertia.

    In two planes they minimise its couple as well.

    Parameters
    ----------
    machine : Machine
    links : sequence of str
        Links that turn about fixed points.
    speed : float, optional
        Of the crank [rad/s]. Default: the steady motion of the motor, the drive's design speed, or 1 rad/s.
        At a constant speed the counterweights do not depend on it.
    radius : float or mapping of str to float, optional
        Distance of the counterweights from their pivots, of all or by link [m]. Default: the link's
        length.
    planes : sequence of float
        Places along the crankshaft at which each link has a counterweight, one or two [m].
    n : int
        Intervals of a revolution.

    Returns
    -------
    Balance
        The machine with the counterweights, forces before and after.

    Raises
    ------
    MachineError
        A link that does not exist or does not turn about a fixed point.
    InputError
        A speed of 0, a radius that is not positive, or other than one plane or two.

    References
    ----------
    .. [1] Berkof, Lowen, A new method for completely force balancing simple linkages, J. Eng. Ind. 91 (1969).
    .. [2] Lowen, Tepper, Berkof, Balancing of linkages – an update, Mech. Mach. Theory 18 (1983).
    """
    scene = Scene(machine, _turning(machine, speed, n))
    _check_links(scene, links)
    before = forces(machine, scene.motion)
    places = [(link, plane) for link in links for plane in _checked_planes(planes)]
    weights = np.sqrt(_time_weights(scene.motion))[:, None]

    def divided(force: Floats, couple: Floats) -> Floats:
        return np.concatenate([(weights * part).ravel() for part in _in_planes(force, couple, planes)])

    units = [(force, couple_of(force, z)) for link, z in places for force in _unit_forces(scene, link)]
    A = np.stack([divided(*unit) for unit in units], axis=-1)
    still = np.zeros((scene.n, 2))
    couple = still if before.shaking_couple is None else before.shaking_couple
    b = divided(before.contributions["inertia"].shaking_force, couple)
    known = np.isfinite(b)
    u = np.linalg.lstsq(A[known], -b[known], rcond=None)[0].reshape(-1, 2)
    return with_counterweights(machine, scene, dict(zip(places, u, strict=True)), radius, before)


def _checked_planes(planes: Sequence[float]) -> Sequence[float]:
    if len(planes) not in (1, 2) or len(set(planes)) < len(planes) or not np.isfinite(planes).all():
        found = ", ".join(f"{plane:.6g} m" for plane in planes) or "none"
        raise InputError(f"planes: found {found}, expected one plane, or two that are apart")
    in_range(planes=(planes, Quantity(LENGTH)))
    return planes


def _in_planes(force: Floats, couple: Floats, planes: Sequence[float]) -> list[Floats]:
    """Force (n, 2) with its couple about x and y, as forces in one plane or two."""
    if len(planes) == 1:
        return [force]
    first, second = planes
    moment = np.stack((couple[:, 1], -couple[:, 0]), axis=-1)  # Σ z F
    far = (moment - first * force) / (second - first)
    return [force - far, far]


def _check_links(scene: Scene, links: Sequence[str]) -> None:
    members = scene.structure.members
    able = [n for n, member in members.items() if member.link == n and scene.carrier(member.point) == FRAME]
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
    return [-(gain * left(direction) - rate**2 * direction) for direction in (e, left(e))]


def _time_weights(motion: Motion) -> Floats:
    """Weights of the trapezoidal rule over time."""
    step = np.abs(np.diff(motion.time))
    time_weights: Floats = 0.5 * (np.append(step, 0.0) + np.append(0.0, step))
    return time_weights


def with_counterweights(
    machine: Machine,
    scene: Scene,
    moments: Mapping[tuple[str, float], Floats],
    radius: Any,
    before: Forces,
) -> Balance:
    """A machine with counterweights of given moments.

    `moments` (2,): link and place along the crankshaft → mass times place along the link and to its left
    [kg m]. Returns: with the forces of the new machine.
    """
    largest = max(float(np.hypot(*u)) for u in moments.values())
    # Moments whose force is rounding beside the inertia of the bodies are none.
    noise = _noise(scene)["shaking_force"] / float(np.nanmax(np.abs(scene.motion.speed))) ** 2
    least = max(_NOTHING * largest, noise)
    counterweights, bodies = [], dict(machine.bodies)
    for (link, axial), u in moments.items():
        at = radius.get(link) if isinstance(radius, Mapping) else radius
        at = scene.links[link].length if at is None else at
        in_range(**{f"radius of {link}": (at, positive(LENGTH))})
        size, angle = _polar(u, least)
        counterweights.append(Counterweight(link, size, angle, size / at, at, axial))
        if size > 0:
            in_range(**{f"mass of the counterweight on {link}": (size / at, not_negative(MASS))})
            place = {"along": at * float(np.cos(angle)), "across": at * float(np.sin(angle))}
            bodies[_free_name(link, bodies)] = Body(
                on=link, mass=size / at, inertia=0.0, axial=axial, **place
            )
    balanced = machine.with_entries({"bodies": bodies})
    return Balance(balanced, tuple(counterweights), before, forces(balanced, scene.motion))


def _polar(u: Floats, least: float) -> tuple[float, float]:
    """Size of a moment (2,) and its direction [rad]; 0 where rounding is as large."""
    size = float(np.hypot(*u))
    if size <= least:
        return 0.0, 0.0
    # The sign of what rounding leaves across the link would turn 180° into −180°.
    across = 0.0 if abs(u[1]) <= _NOTHING * size else float(u[1])
    return size, float(np.arctan2(across, u[0]))


# Speed at which a machine is balanced that has none: counterweights are the same at any [rad/s].
UNIT_SPEED = 1.0


def _turning(machine: Machine, speed: float | None, n: int) -> Motion:
    """The motion in which inertia is balanced: at a speed, the machine's own, or the unit of speed."""
    if speed is not None:
        in_range(speed=(abs(speed), positive(SPEED)))
    elif not has_speed(machine):
        speed = UNIT_SPEED
    return motion_at(machine, None, speed=speed, n=n)


def _free_name(link: str, bodies: Mapping[str, Body]) -> str:
    name = f"counterweight_{link.replace('.', '_')}"
    while name in bodies:
        name += "_2"
    return name


@public
def partial_balance(
    machine: Machine,
    slider: str,
    *,
    share: float = 0.5,
    speed: float | None = None,
    radius: float | None = None,
    n: int = 360,
) -> Balance:
    """Counterweight on a crank for the rotating mass and a share of the reciprocating mass.

    Parameters
    ----------
    machine : Machine
    slider : str
        A slider that is driven by the pin of a crank.
    share : float
        Of the reciprocating mass: from 0, which balances what turns alone, to 1, all, which moves the force
        across the guide.
    speed : float, optional
        As for `balance`.
    radius : float, optional
        Distance of the counterweight from the pivot [m]; without it the crank's radius.
    n : int
        Intervals of a revolution.

    Returns
    -------
    Balance
        The machine with the counterweight, forces before and after.

    Raises
    ------
    MachineError
        No slider of that name, or one that no crank drives.

    Notes
    -----
    The rod is replaced by two masses at its ends with the same centre of mass.

    References
    ----------
    .. [1] Norton, Design of Machinery, chapter 13 (equivalent masses, balancing the engine).
    """
    in_range(share=(share, Quantity(RATIO, SHARE)))
    part = machine.linkage.sliders.get(slider)
    if part is None or part.crank not in machine.linkage.cranks:
        able = [
            name
            for name, candidate in machine.linkage.sliders.items()
            if candidate.crank in machine.linkage.cranks
        ]
        expected = f"a slider on the pin of a crank: {', '.join(able) or 'there is none'}"
        raise MachineError([Problem("slider", slider, expected, suggestion(slider, able))])
    scene = Scene(machine, _turning(machine, speed, n))
    moment = np.zeros(2)
    crank = machine.linkage.cranks[part.crank]
    pin = np.array([crank.radius, 0.0])
    for member, mass, place in _first_moments(scene):
        if member == part.crank:
            moment += mass * place
        elif member == slider:
            moment += share * mass * pin
        elif member == f"{slider}.rod":
            at_slider = mass * place[0] / part.rod
            moment += (mass - at_slider) * pin + share * at_slider * pin
    before = forces(machine, scene.motion)
    return with_counterweights(machine, scene, {(part.crank, 0.0): -moment}, radius, before)


def four_bar_moments(machine: Machine, rocker: str) -> dict[str, complex]:
    """Moments of counterweights that keep the centre of mass of a four-bar at rest.

    `rocker`: a rocker about a fixed point, driven by the pin of a crank. Returns: link → mass times place
    from its start, along it and, as the imaginary part, to its left [kg m]. Raises MachineError: the rocker
    is not that of a four-bar.

    Source: Berkof, Lowen, A new method for completely force balancing simple linkages, J. Eng. Ind. 91
    (1969): the direction of the coupler is eliminated by the loop, and the factors of those of crank and
    rocker vanish.
    """
    mechanism = machine.linkage
    part = mechanism.rockers.get(rocker)
    if part is None or part.crank not in mechanism.cranks or part.pivot not in mechanism.fixed_points():
        expected = "a rocker about a fixed point that the pin of a crank drives"
        raise MachineError([Problem("rocker", rocker, expected)])
    scene = Scene(machine, motion_at(machine, None, speed=1.0, angles=[0.0]))
    mass: dict[str, float] = {}
    moment: dict[str, complex] = {}
    for member, m, place in _first_moments(scene):
        mass[member] = mass.get(member, 0.0) + m
        moment[member] = moment.get(member, 0j) + m * complex(*place)
    r = mechanism.cranks[part.crank].radius
    coupler, lever = f"{rocker}.coupler", f"{rocker}.rocker"
    z = moment.get(coupler, 0j)
    return {
        part.crank: -(moment.get(part.crank, 0j) + r * (mass.get(coupler, 0.0) - z / part.coupler)),
        lever: -(moment.get(lever, 0j) + z * part.rocker / part.coupler),
    }


def _first_moments(scene: Scene) -> list[tuple[str, float, Floats]]:
    first_moments = []
    for mass in masses(scene):
        arm = mass.centre[0] - scene.reference(mass.member)[0]
        e = unit(scene.angle(scene.structure.members[mass.member].link))[0]
        first_moments.append((mass.member, mass.mass, np.array([arm @ e, arm @ left(e)])))
    return first_moments
