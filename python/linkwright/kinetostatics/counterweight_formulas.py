"""Counterweights by formulas: a share of a slider's mass, and the full balance of a four-bar."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineError, Problem
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units import RATIO, not_negative
from linkwright.kinetostatics.balancing import Balance, require_turning, with_counterweights
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.inertia import masses
from linkwright.kinetostatics.motion import motion_at
from linkwright.kinetostatics.places import Scene, left, unit
from linkwright.machine.machine import Machine

Floats = NDArray[np.float64]


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
    """A counterweight on a crank against what turns and a share of what a slider moves back and forth.

    Parameters
    ----------
    machine : Machine
        The machine.
    slider : str
        A slider that is driven by the pin of a crank.
    share : float
        Of the reciprocating mass: 0 balances what turns alone, 1 all, which moves the force across the guide.
    speed : float, optional
        As for `balance`.
    radius : float, optional
        Distance of the counterweight from the pivot [m]; without it the crank's radius.
    n : int
        Intervals of the revolution.

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
    in_range(share=(share, not_negative(RATIO)))
    require_turning(speed)
    part = machine.linkage.sliders.get(slider)
    if part is None or part.crank not in machine.linkage.cranks:
        able = [
            name for name, each in machine.linkage.sliders.items() if each.crank in machine.linkage.cranks
        ]
        expected = f"a slider on the pin of a crank: {', '.join(able) or 'there is none'}"
        raise MachineError([Problem("slider", slider, expected, suggestion(slider, able))])
    scene = Scene(machine, motion_at(machine, None, speed=speed, n=n))
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
    return with_counterweights(machine, scene, {part.crank: -moment}, radius, before)


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
    """Member, mass, and place of each mass along and across its member."""
    first_moments = []
    for mass in masses(scene):
        arm = mass.centre[0] - scene.reference(mass.member)[0]
        e = unit(scene.angle(scene.structure.members[mass.member].link))[0]
        first_moments.append((mass.member, mass.mass, np.array([arm @ e, arm @ left(e)])))
    return first_moments
