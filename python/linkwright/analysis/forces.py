r"""Forces in pins, guides, teeth and cables, the driving torque, and what the machine does to its frame.

For every member, at every crank angle,

.. math:: \sum \mathbf F = m\,\mathbf a_S, \qquad \sum M = J_S\,\ddot\psi

with the motion given: kinetostatics, a linear system for all reactions and the driving torque together (Norton,
*Design of Machinery*, chapter 11; Wilson and Sadler, *Kinematics and Dynamics of Machinery*, chapter 10).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.analysis.kinetostatics.applied import Applied, applied
from linkwright.analysis.kinetostatics.equilibrium import Equilibrium, Solution
from linkwright.analysis.kinetostatics.friction import Friction, checked
from linkwright.analysis.kinetostatics.inertia import inertia_forces
from linkwright.analysis.kinetostatics.motion import Motion, motion_at
from linkwright.analysis.kinetostatics.pairs import PairModel, pair_models
from linkwright.analysis.kinetostatics.scene import Scene
from linkwright.analysis.kinetostatics.wrench import Wrenches
from linkwright.analysis.result import Result
from linkwright.analysis.steady_state import SteadyState
from linkwright.analysis.transient import Transient
from linkwright.engine import drive_inertia
from linkwright.errors import FindingError, InputError
from linkwright.machine import Drive, Machine

Floats = NDArray[np.float64]

# Pressure angle of involute teeth by DIN 867 and ISO 53 [rad].
PRESSURE_ANGLE = float(np.radians(20.0))

# Share of the greatest tension that a cable may push by rounding.
_SLACK = 1e-9


@dataclass(frozen=True)
class PairForce:
    """What a pair passes on; arrays (n,), vectors (n, 2).

    Attributes
    ----------
    name, kind : str
        Of the pair (`linkwright.machine.structure`).
    first, second : str
        Its members.
    force : ndarray, shape (n, 2)
        On the second member, friction included [N].
    moment : ndarray, shape (n,)
        Of a guide, and friction of a pin, on the second member about the point of the pair [N m].
    friction : ndarray, shape (n,)
        Share of friction: torque of a pin [N m], force along a guide or slot [N], on the second member.
    normal : ndarray, shape (n,)
        Of a guide or slot to the left of it, of teeth along their path, tension of a cable [N]; of a belt its
        torque on the gear [N m]; of a pin the size of its force.
    """

    name: str
    kind: str
    first: str
    second: str
    force: Floats
    moment: Floats
    friction: Floats
    normal: Floats

    @property
    def size(self) -> Floats:
        """Size of the force, (n,) [N]."""
        found: Floats = np.hypot(self.force[:, 0], self.force[:, 1])
        return found


@dataclass(frozen=True)
class Contribution:
    """The share of one source in the forces.

    Attributes
    ----------
    reactions : dict of str to ndarray, shape (n, 2)
        In the force of each pair on its second member [N].
    torque_drive : ndarray, shape (n,)
        In the driving torque [N m].
    shaking_force : ndarray, shape (n, 2)
        In the force on the frame [N].
    shaking_moment : ndarray, shape (n,)
        In the moment on the frame about the origin [N m].
    """

    reactions: dict[str, Floats]
    torque_drive: Floats
    shaking_force: Floats
    shaking_moment: Floats


@dataclass(frozen=True)
class Forces(Result):
    """Forces over the crank angle.

    Attributes
    ----------
    crank_angle : ndarray, shape (n,)
        [rad].
    time, speed, acceleration : ndarray, shape (n,)
        Of the motion [s, rad/s, rad/s²].
    torque_drive : ndarray, shape (n,)
        Driving torque at the crankshaft that the motion needs [N m].
    power_drive, power_load, power_friction : ndarray, shape (n,)
        Of the drive at the crankshaft, of all loads on the machine, of friction in the pairs [W].
    power_kinetic : ndarray, shape (n,)
        Change of the kinetic energy in time [W].
    shaking_moment : ndarray, shape (n,)
        On the frame about the origin, by pairs, springs and the torque of the drive [N m].
    shaking_force : ndarray, shape (n, 2)
        On the frame [N].
    pairs : dict of str to PairForce
        Forces of pins, guides, slots, teeth and cables by name.
    drives : dict of str to ndarray, shape (n,)
        Torque on each crank [N m], force on each linear driver along its guide [N].
    contributions : dict of str to Contribution
        ``"inertia"``, ``"friction"`` (its viscous share), and each load as ``"loads.name"``. Dry friction goes
        with what causes it.
    motion : Motion
        As it was given.
    findings : tuple of str
        Where forces are unbounded, friction locks, or a cable pushes, in sentences.
    """

    crank_angle: Floats
    time: Floats
    speed: Floats
    acceleration: Floats
    torque_drive: Floats
    power_drive: Floats
    power_load: Floats
    power_friction: Floats
    power_kinetic: Floats
    shaking_moment: Floats
    shaking_force: Floats
    pairs: dict[str, PairForce]
    drives: dict[str, Floats]
    contributions: dict[str, Contribution]
    motion: Motion
    findings: tuple[str, ...] = field(default=())

    @property
    def power_residual(self) -> Floats:
        """Driving, load and friction power less the change of kinetic energy, (n,) [W]: rounding."""
        found: Floats = self.power_drive + self.power_load + self.power_friction - self.power_kinetic
        return found

    @property
    def reactions(self) -> dict[str, Floats]:
        """Force of each pin on its second member by name, (n, 2) [N]."""
        return {name: pair.force for name, pair in self.pairs.items() if pair.kind == "pin"}

    @property
    def reaction_max(self) -> dict[str, float]:
        """Greatest force of each pair [N]."""
        return {name: float(np.nanmax(pair.size)) for name, pair in self.pairs.items()}

    @property
    def torque_drive_max(self) -> float:
        """Driving torque of the greatest size, with its sign [N m]."""
        return float(self.torque_drive[np.nanargmax(np.abs(self.torque_drive))])

    @property
    def shaking_force_max(self) -> float:
        """Greatest size of the force on the frame [N]."""
        return float(np.nanmax(np.hypot(self.shaking_force[:, 0], self.shaking_force[:, 1])))

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Scalars and greatest forces by name, with ``curves`` also all forces as lists.

        Parameters
        ----------
        curves : bool
            Whether arrays are included.

        Returns
        -------
        dict
            Plain numbers, texts and lists, ready for JSON.
        """
        found = super().to_dict(curves=curves) | {"reaction_max": self.reaction_max}
        if curves:
            found["reactions"] = {name: pair.force.tolist() for name, pair in self.pairs.items()}
            found["moments"] = {name: pair.moment.tolist() for name, pair in self.pairs.items()}
            found["drives"] = {name: torque.tolist() for name, torque in self.drives.items()}
        return found


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
) -> Forces:
    """Forces in all pairs, driving torque, and forces on the frame.

    Parameters
    ----------
    machine : Machine
        The machine, with bodies and loads.
    motion : SteadyState, Transient or Motion, optional
        The motion, with its own angles.
    speed, acceleration : float, optional
        Speed and acceleration of the crank instead, the same at all angles [rad/s, rad/s²]; speed 0 is a machine at
        rest. Without motion and speed: the steady motion of the motor, or the drive's design speed.
    angles : array_like, shape (n,), optional
        Crank angles for a speed [rad]; without them a turn.
    n : int
        Intervals of the turn.
    friction : mapping of str to Friction, optional
        Friction of pins, guides and slots by name of the pair.
    pressure_angle : float
        Of all teeth [rad].

    Returns
    -------
    Forces
        Over the crank angle; NaN at angles that a finding names.

    Raises
    ------
    FindingError
        There are no forces at any angle.
    InputError
        Motion and speed are both given, or neither where the machine has none; wrong friction.

    Notes
    -----
    Bars marked redundant carry no force between their ends: dimensions alone do not say what they would carry.

    References
    ----------
    .. [1] Norton, Design of Machinery, chapter 11.
    """
    if not 0 <= pressure_angle < np.pi / 2:
        raise InputError(
            f"pressure_angle: found {pressure_angle:g} rad, expected 0 or more and less than π/2"
        )
    scene = Scene(
        machine, motion_at(machine, motion, speed=speed, acceleration=acceleration, angles=angles, n=n)
    )
    models = pair_models(scene, checked(friction or {}, scene.structure.pairs), pressure_angle)
    sources = _sources(scene, models)
    loads = np.stack([each.wrenches.values for each in sources.values()], axis=-1)
    solution = Equilibrium(scene, models, loads).solve()
    return _Collector(scene, models, sources, solution).forces()


def _sources(scene: Scene, models: list[PairModel]) -> dict[str, Applied]:
    """Inertia, viscous friction, and the loads."""
    motion, drive = scene.motion, scene.machine.drive or Drive()
    at_shaft = float(drive_inertia(drive)) * motion.acceleration
    found = {"inertia": Applied(inertia_forces(scene), at_shaft)}
    if any(model.friction.viscous for model in models):
        slow = Wrenches(scene)
        for model in models:
            if model.extra is not None:
                slow.values += model.viscous[:, None, None] * model.extra.values
        found["friction"] = Applied(slow, np.zeros(scene.n))
    return found | {f"loads.{name}": applied(scene, load) for name, load in scene.machine.loads.items()}


class _Collector:
    """From the unknowns to named forces."""

    def __init__(
        self, scene: Scene, models: list[PairModel], sources: dict[str, Applied], solution: Solution
    ) -> None:
        self.scene, self.models, self.sources, self.solution = scene, models, sources, solution
        sizes = np.cumsum([0] + [len(model.unknowns) for model in models])
        self.spans = [slice(int(a), int(b)) for a, b in zip(sizes[:-1], sizes[1:], strict=True)]
        if (solution.singular | solution.locked).all():
            raise FindingError(_where(self.solution, scene.motion.crank_angle)[0])

    def forces(self) -> Forces:
        """Everything, by name."""
        shares = {name: self._contribution(k, each) for k, (name, each) in enumerate(self.sources.items())}
        total = self.solution.x.sum(axis=-1)
        pairs = {pair.name: pair for pair in self._pairs(total)}
        drives = {
            model.name: total[:, span.start]
            for model, span in zip(self.models, self.spans, strict=True)
            if model.kind in ("torque", "force")
        }
        motion = self.scene.motion
        torque = np.sum([each.torque_drive for each in shares.values()], axis=0)
        return Forces(
            crank_angle=motion.crank_angle,
            time=motion.time,
            speed=motion.speed,
            acceleration=motion.acceleration,
            torque_drive=torque,
            **self._powers(torque, total),
            shaking_moment=np.sum([each.shaking_moment for each in shares.values()], axis=0),
            shaking_force=np.sum([each.shaking_force for each in shares.values()], axis=0),
            pairs=pairs,
            drives=drives,
            contributions=shares,
            motion=motion,
            findings=tuple([*_where(self.solution, motion.crank_angle), *self._slack(pairs)]),
        )

    def _passed(self, model: PairModel, span: slice, x: Floats) -> Wrenches:
        """What a pair does to all members for values (n, unknowns) of all unknowns."""
        found = Wrenches(self.scene)
        for j, unknown in enumerate(model.unknowns):
            found.values += x[:, span.start + j, None, None] * unknown.values
        if model.extra is not None:
            found.values += self._dry(span, x)[:, None, None] * model.extra.values
        return found

    def _dry(self, span: slice, x: Floats) -> Floats:
        """Extra force of a pair that goes with its unknowns."""
        found: Floats = (self.solution.slopes[:, span] * x[:, span]).sum(axis=1)
        return found

    def _pairs(self, total: Floats) -> list[PairForce]:
        found = []
        for model, span in zip(self.models, self.spans, strict=True):
            pair = (
                self.scene.structure.pairs.get(model.name) if model.kind not in ("torque", "force") else None
            )
            if pair is None:
                continue
            passed = self._passed(model, span, total)
            teeth = model.kind in ("mesh", "rack")
            extra = (
                np.zeros(self.scene.n)
                if model.extra is None or teeth
                else self._dry(span, total) + model.viscous
            )
            if model.extra is not None:
                passed.values += model.viscous[:, None, None] * model.extra.values
            at = passed.on_member(pair.second)
            arm = self.scene.point(pair.point) - self.scene.reference(pair.second)
            moment = at[:, 2] - (arm[:, 0] * at[:, 1] - arm[:, 1] * at[:, 0])
            normal = total[:, span.start]
            if model.kind == "pin":
                normal = np.hypot(at[:, 0], at[:, 1])
            found.append(
                PairForce(pair.name, pair.kind, pair.first, pair.second, at[:, :2], moment, extra, normal)
            )
        return found

    def _contribution(self, k: int, source: Applied) -> Contribution:
        """The share of one source."""
        x = self.solution.x[..., k]
        torque = source.resisting + 0.0
        frame = source.wrenches.values[:, -1].copy()
        reactions = {}
        for model, span in zip(self.models, self.spans, strict=True):
            passed = self._passed(model, span, x)
            frame += passed.values[:, -1]
            if model.kind in ("torque", "force"):
                # The work of the drive on this member in a radian of the crank.
                torque = torque + x[:, span.start] * model.unknowns[0].power()
            else:
                reactions[model.name] = passed.on_member(model.second)[:, :2]
        return Contribution(reactions, torque, frame[:, :2], frame[:, 2])

    def _powers(self, torque: Floats, total: Floats) -> dict[str, Floats]:
        """Power of drive, loads and friction, and change of kinetic energy."""
        speed = self.scene.motion.speed
        by_source = {name: (s.wrenches.power() - s.resisting) * speed for name, s in self.sources.items()}
        kinetic = -by_source.pop("inertia")
        lost = by_source.pop("friction", np.zeros(self.scene.n))
        for model, span in zip(self.models, self.spans, strict=True):
            if model.extra is not None and model.kind not in ("mesh", "rack"):
                lost = lost + self._dry(span, total) * model.rate
        loads = np.sum([np.zeros(self.scene.n), *by_source.values()], axis=0)
        return {
            "power_drive": torque * speed,
            "power_load": loads,
            "power_friction": lost,
            "power_kinetic": kinetic,
        }

    def _slack(self, pairs: dict[str, PairForce]) -> list[str]:
        """Cables that would have to push."""
        found = []
        for name, pair in pairs.items():
            if pair.kind != "cable" or np.isnan(pair.normal).all():
                continue
            worst = int(np.nanargmin(pair.normal))
            if pair.normal[worst] < -_SLACK * np.nanmax(np.abs(pair.normal)):
                at = np.degrees(self.scene.motion.crank_angle[worst])
                found.append(
                    f"The cable {pair.second} is slack: at crank angle {at:.4g}° it would have to push with "
                    f"{-pair.normal[worst]:.4g} N; load its end more, or move it more slowly."
                )
        return found


def _where(solution: Solution, phi: Floats) -> list[str]:
    """Sentences about angles without an answer."""
    found = []
    if solution.singular.any():
        found.append(
            f"Forces are unbounded or not determined at crank angle {_angles(phi[solution.singular])}: the "
            "mechanism is in a dead or change point there, and no force of its pairs keeps it in equilibrium; "
            "values at these angles are left out."
        )
    if solution.locked.any():
        found.append(
            f"Friction locks the mechanism at crank angle {_angles(phi[solution.locked])}: no driving torque "
            "moves it there; less friction or a better angle of transmission is needed."
        )
    return found


def _angles(phi: Floats) -> str:
    """Crank angles in degrees; of many the first and the last."""
    shown = [f"{each:.4g}°" for each in np.degrees(phi)]
    return ", ".join(shown) if len(shown) <= 4 else f"{shown[0]} to {shown[-1]} ({len(shown)} angles)"
