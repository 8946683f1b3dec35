r"""Forces in pins, guides, teeth and cables, the driving torque, and what the machine does to its frame.

For every member, at every crank angle,

.. math:: \sum \mathbf F = m\,\mathbf a_S, \qquad \sum M = J_S\,\ddot\psi

with the motion given: kinetostatics, a linear system for all reactions and the driving torque together
(Norton, *Design of Machinery*, chapter 11; Wilson and Sadler, *Kinematics and Dynamics of Machinery*,
chapter 10).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from linkwright.drive.model.drive import Drive
from linkwright.drive.steady_state import SteadyState
from linkwright.drive.transient import Transient
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.units.kinds import ANGLE
from linkwright.kernel.units.marks import Bound, Quantity
from linkwright.kinetostatics.applied import AppliedLoad, applied, together
from linkwright.kinetostatics.collect import Collector
from linkwright.kinetostatics.couple import has_axial, inertia_force_and_couple
from linkwright.kinetostatics.equilibrium import Equilibrium, Solution, require_room
from linkwright.kinetostatics.friction import Friction, checked
from linkwright.kinetostatics.motion import Motion, motion_at
from linkwright.kinetostatics.pairs import PairModel, pair_models, with_pulls
from linkwright.kinetostatics.places import Scene, structure_of
from linkwright.kinetostatics.result import Forces
from linkwright.kinetostatics.wrench import Wrenches, inertia_forces
from linkwright.machine.machine import Machine
from linkwright.machine.program.drive_line import drive_inertia

# Pressure angle of involute teeth by DIN 867 and ISO 53 [rad].
PRESSURE_ANGLE = float(np.radians(20.0))


# Teeth press along a line between their common tangent, 0, and the line of centres.
_ACUTE = Bound(
    " of 0 or more and below 90 deg,",
    {"minimum": 0, "exclusiveMaximum": np.pi / 2},
    lambda value: 0 <= value < np.pi / 2,
)


@public
def forces(
    machine: Machine,
    motion: SteadyState | Transient | Motion | None = None,
    *,
    speed: float | None = None,
    acceleration: float = 0.0,
    angles: ArrayLike | None = None,
    n: int = 360,
    friction: Mapping[str, Friction] | None = None,
    pressure_angle: float = PRESSURE_ANGLE,
    contributions: bool = True,
) -> Forces:
    """Forces in all pairs, driving torque, and shaking forces.

    Parameters
    ----------
    machine : Machine
        The machine, with bodies and loads.
    motion : SteadyState, Transient or Motion, optional
        The motion, with its own angles.
    speed, acceleration : float, optional
        Speed and acceleration of the crank instead, the same at all angles [rad/s, rad/s²]; speed 0 is a
        machine at rest. Without motion and speed: the steady motion of the motor, or the drive's design
        speed.
    angles : array_like, shape (n,), optional
        Crank angles for a speed [rad]; without them a cycle: the revolutions after which
        all forces repeat, or the first if these are more than 24.
    n : int
        Intervals of a revolution.
    friction : mapping of str to Friction, optional
        Friction of pins, guides and slots by name of the pair.
    pressure_angle : float
        Of all teeth [rad].
    contributions : bool
        Whether the share of each load is wanted too; it is worked out when it is asked for.

    Returns
    -------
    Forces
        Over the crank angle; NaN at angles that a finding names.

    Raises
    ------
    FindingError
        The crank does not rotate fully, there are no forces at any angle, or more unknowns at all angles than
        are solved for at once.
    InputError
        Motion and speed are both given, or neither where the machine has none; wrong friction.

    Notes
    -----
    Bars marked redundant carry no force between their ends: dimensions alone do not say what they would
    carry.

    References
    ----------
    .. [1] Norton, Design of Machinery, chapter 11.
    """
    if motion is not None and angles is not None:
        raise InputError("angles: found together with a motion, which has its own; omit them")
    if motion is None:
        # Before a motion of as many angles is worked out.
        require_room(structure_of(machine), n + 1 if angles is None else np.size(angles))
    scene = Scene(
        machine, motion_at(machine, motion, speed=speed, acceleration=acceleration, angles=angles, n=n)
    )
    models, sources = acting(scene, friction or {}, pressure_angle)
    columns = sources if contributions else {"": together(scene, sources.values())}
    solution = solved(scene, models, columns)[1]
    result = Collector(scene, models, sources, columns, solution).forces()
    if has_axial(machine):
        result = replace(result, shaking_couple=inertia_force_and_couple(scene)[1])
    return result if contributions else replace(result, contributions={})


def acting(
    scene: Scene, friction: Mapping[str, Friction], pressure_angle: float = PRESSURE_ANGLE
) -> tuple[list[PairModel], dict[str, AppliedLoad]]:
    """Pairs and drives of a scene, and what acts on it."""
    in_range(pressure_angle=(pressure_angle, Quantity(ANGLE, _ACUTE)))
    models = pair_models(scene, checked(friction, scene.structure.pairs), pressure_angle)
    return models, _sources(scene, models)


def equilibrium(scene: Scene, models: list[PairModel], columns: Mapping[str, AppliedLoad]) -> Equilibrium:
    """The linear systems of pairs and drives under loads."""
    return Equilibrium(scene, models, [column.wrenches.values for column in columns.values()])


def solved(
    scene: Scene, models: list[PairModel], columns: Mapping[str, AppliedLoad]
) -> tuple[Equilibrium, Solution]:
    """The systems, with second contacts of cams where the first would have to pull, and their solution."""
    system = equilibrium(scene, models, columns)
    solution = system.solve()
    if with_pulls(scene, models, solution.x.sum(axis=-1)):
        system = equilibrium(scene, models, columns)
        solution = system.solve()
    return system, solution


def _sources(scene: Scene, models: list[PairModel]) -> dict[str, AppliedLoad]:
    motion, drive = scene.motion, scene.machine.drive or Drive()
    at_shaft = drive_inertia(drive) * motion.acceleration
    sources = {"inertia": AppliedLoad(inertia_forces(scene), at_shaft)}
    if any(model.friction.viscous for model in models):
        slow = Wrenches(scene)
        for model in models:
            if model.extra is not None:
                slow.add(model.extra, model.viscous)
        sources["friction"] = AppliedLoad(slow, np.zeros(scene.n))
    return sources | {f"loads.{name}": applied(scene, load) for name, load in scene.machine.all_loads.items()}
