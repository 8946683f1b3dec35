"""From the unknowns of all pairs to named forces, powers and findings."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce
from itertools import pairwise
from operator import add

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import FindingError
from linkwright.kernel.numerics.tangent import primal
from linkwright.kernel.public.immutable import LazyTable
from linkwright.kinetostatics.applied import AppliedLoad, together
from linkwright.kinetostatics.equilibrium import Solution
from linkwright.kinetostatics.model.loads.table import TorqueAngle, TorqueSpeed
from linkwright.kinetostatics.pairs import PairModel
from linkwright.kinetostatics.places import Scene, cross
from linkwright.kinetostatics.result import Contribution, Forces, PairForce
from linkwright.linkages.law_jumps import drivers_with_laws
from linkwright.linkages.model.structure import FRAME
from linkwright.machine.own_motors import axis_drivers

# Share of the maximum force by which rounding may push a cable, or pull a follower.
_SLACK = 1e-9

# How the finding about a follower begins.
LEAVES = "The follower leaves cam"

# What keeps a follower on its cam that would have to be pulled, and a cable tight that would have to push.
KEEPS = "increase the spring force, reduce the speed, or use a groove."
TIGHTENS = "increase the load on its end, or reduce the speed."

# Kinds of models that are no pairs.
DRIVES = ("torque", "force", "contact")


class Collector:
    """From the unknowns to named forces.

    Parameters
    ----------
    scene : Scene
        The machine and its motion.
    models : list of PairModel
        Its pairs and drives.
    sources : dict of str to AppliedLoad
        What acts, by name.
    columns : dict of str to AppliedLoad
        The same, or its sum: a column each of the solution.
    solution : Solution
        The unknowns.

    Raises
    ------
    FindingError
        There is no answer at any angle.
    """

    def __init__(
        self,
        scene: Scene,
        models: list[PairModel],
        sources: dict[str, AppliedLoad],
        columns: dict[str, AppliedLoad],
        solution: Solution,
    ) -> None:
        self.scene, self.models, self.solution = scene, models, solution
        self.sources, self.columns = sources, columns
        self.total = solution.x.sum(axis=-1)
        sizes = np.cumsum([0] + [len(model.unknowns) for model in models])
        self.spans = [slice(int(a), int(b)) for a, b in pairwise(sizes)]
        self.works = {model.name: model.unknowns[0].power() for model in models if model.kind in DRIVES}
        if (solution.singular | solution.locked).all():
            raise FindingError(_where(self.solution, scene.motion.crank_angle)[0])

    def forces(self) -> Forces:
        """Everything, by name."""
        total, drives = self.total, self.drives()
        pairs = {m.name: self._pair(m, span, total) for m, span in self._pairs()}
        motion = self.scene.motion
        torque, frame = self.drive_and_frame()
        return Forces(
            crank_angle=motion.crank_angle,
            time=motion.time,
            speed=motion.speed,
            acceleration=motion.acceleration,
            torque_drive=torque,
            **self._powers(torque, total),
            shaking_moment=frame[:, 2],
            shaking_force=frame[:, :2],
            pairs=pairs,
            drives=drives,
            shaft_torques=self.shaft_torques(),
            contributions=LazyTable({name: partial(self._share, k) for k, name in enumerate(self.columns)}),
            motion=motion,
            load_forces=self._load_forces(),
            load_torques=self._load_torques(),
            laws=tuple(
                dict.fromkeys([*drivers_with_laws(self.scene.machine), *axis_drivers(self.scene.machine)])
            ),
            findings=(
                *_where(self.solution, motion.crank_angle),
                *self._slack(pairs),
                *self._left(drives),
            ),
        )

    def drives(self) -> dict[str, Floats]:
        """Torque or force of each drive, (n,)."""
        spans = zip(self.models, self.spans, strict=True)
        return {m.name: self.total[:, span.start] for m, span in spans if m.kind in DRIVES}

    def drive_and_frame(self) -> tuple[Floats, Floats]:
        """Driving torque, (n,), and what acts on the frame, (n, 3)."""
        return self._borne(list(self.columns.values()), self.total)

    def reactions(self) -> dict[str, Floats]:
        """Force of each pair on its second member, (n, 2)."""
        return {m.name: self._on_second(m, span, self.total)[:, :2] for m, span in self._pairs()}

    def _pairs(self) -> list[tuple[PairModel, slice]]:
        spans = zip(self.models, self.spans, strict=True)
        return [(model, span) for model, span in spans if model.kind not in DRIVES]

    def _on_second(self, model: PairModel, span: slice, x: Floats) -> Floats:
        """What a pair does to its second member, viscous friction included, (n, 3)."""
        at = self.passed(model, span, x, model.second)
        return at + self._viscous(model) if model.extra is not None and model.friction.viscous else at

    def passed(self, model: PairModel, span: slice, x: Floats, member: str) -> Floats:
        """What a pair does to a member for values (n, unknowns): force and moment, (n, 3)."""
        passed: Floats = np.zeros((self.scene.n, 3))
        for j, unknown in enumerate(model.unknowns):
            if member in unknown.on:
                passed = passed + x[:, span.start + j, None] * unknown.on[member]
        if model.is_nonlinear and model.extra is not None:
            passed = passed + self._dry(span, x)[:, None] * model.extra.on_member(member)
        return passed

    def _viscous(self, model: PairModel) -> Floats:
        """Viscous friction of a pair on its second member, (n, 3)."""
        if model.extra is None or not model.friction.viscous:
            return np.zeros((self.scene.n, 3))
        viscous: Floats = model.viscous[:, None] * model.extra.on_member(model.second)
        return viscous

    def _dry(self, span: slice, x: Floats) -> Floats:
        dry: Floats = (self.solution.slopes[:, span] * x[:, span]).sum(axis=-1)
        return dry

    def _pair(self, model: PairModel, span: slice, total: Floats) -> PairForce:
        pair = self.scene.structure.pairs[model.name]
        at = self._on_second(model, span, total)
        arm = self.scene.point(pair.point) - self.scene.reference(pair.second)
        moment = at[:, 2] - cross(arm, at[:, :2])
        friction = np.zeros(self.scene.n)
        if model.kind in ("pin", "guide", "slot"):
            friction = self._dry(span, total) + model.viscous
        normal = np.hypot(at[:, 0], at[:, 1]) if model.kind == "pin" else total[:, span.start]
        return PairForce(pair.name, pair.kind, pair.first, pair.second, at[:, :2], moment, friction, normal)

    def _load_forces(self) -> dict[str, Floats]:
        forces = {}
        for name, load in self.scene.machine.all_loads.items():
            pair = self.scene.structure.pairs.get(f"{getattr(load, 'on', None)}.guide")
            if pair is not None and pair.guide is not None:
                force = self.sources[f"loads.{name}"].wrenches.on_member(pair.second)[:, :2]
                forces[name] = (force * self.scene.direction(pair.guide)).sum(axis=-1)
        return forces

    def _load_torques(self) -> dict[str, Floats]:
        torques = {}
        for name, load in self.scene.machine.all_loads.items():
            source, on = self.sources[f"loads.{name}"], getattr(load, "on", None)
            if on is None and isinstance(load, TorqueAngle | TorqueSpeed):
                torques[name] = -source.resisting
            elif on in self.scene.index and not _pushes(source):
                torques[name] = source.wrenches.on_member(on)[:, 2]
        return torques

    def shaft_torques(self) -> dict[str, Floats]:
        """Torque of each drive referred to the shaft that all follow, (n,)."""
        spans = zip(self.models, self.spans, strict=True)
        return {m.name: self._on_shaft(m, span, self.total) for m, span in spans if m.kind in DRIVES}

    def _on_shaft(self, model: PairModel, span: slice, x: Floats) -> Floats:
        """The work of a drive on its member in a radian of the shaft, with what a contact loses."""
        torque: Floats = x[:, span.start] * self.works[model.name]
        return torque if model.push is None else torque + self._dry(span, x) * model.push.lever

    def _borne(self, sources: Sequence[AppliedLoad], x: Floats) -> tuple[Floats, Floats]:
        """Driving torque and wrench on the frame, (n,) and (n, 3). `x`: values (n, unknowns)."""
        torque = reduce(add, [source.resisting for source in sources])
        frame = reduce(add, [source.wrenches.on_member(FRAME) for source in sources])
        for model, span in zip(self.models, self.spans, strict=True):
            if model.acts_on(FRAME):
                frame = frame + self.passed(model, span, x, FRAME)
            if model.kind in DRIVES:
                torque = torque + self._on_shaft(model, span, x)
        return torque, frame

    def _share(self, k: int) -> Contribution:
        (name, source), x = list(self.columns.items())[k], self.solution.x[:, :, k]
        torque, frame = self._borne([source], x)
        reactions = {}
        for model, span in zip(self.models, self.spans, strict=True):
            if model.kind not in DRIVES:
                at = self.passed(model, span, x, model.second)
                reactions[model.name] = (at + self._viscous(model) if name == "friction" else at)[:, :2]
        return Contribution(reactions, torque, frame[:, :2], frame[:, 2])

    def _powers(self, torque: Floats, total: Floats) -> dict[str, Floats]:
        speed = self.scene.motion.speed
        others = dict(self.sources)
        inertia, friction = others.pop("inertia"), others.pop("friction", None)
        lost = np.zeros(self.scene.n) if friction is None else self._power(friction) * speed
        for model, span in zip(self.models, self.spans, strict=True):
            if model.extra is not None and model.kind not in ("mesh", "rack"):
                lost = lost + self._dry(span, total) * model.rate
        return {
            "power_drive": torque * speed,
            "power_load": self._power(together(self.scene, others.values())) * speed,
            "power_friction": lost,
            "power_kinetic": -self._power(inertia) * speed,
        }

    def _power(self, source: AppliedLoad) -> Floats:
        power: Floats = source.wrenches.power() - source.resisting
        return power

    def _slack(self, pairs: dict[str, PairForce]) -> list[str]:
        slack = []
        for pair in pairs.values():
            normal: Floats = primal(pair.normal)
            if pair.kind != "cable" or np.isnan(normal).all():
                continue
            worst = int(np.nanargmin(normal))
            if normal[worst] < -_SLACK * np.nanmax(np.abs(normal)):
                at = np.degrees(self.scene.motion.crank_angle[worst])
                slack.append(
                    f"The cable {pair.second} is slack: at crank angle {at:.4g}° it would have to push with "
                    f"{-normal[worst]:.4g} N; {TIGHTENS}"
                )
        return slack

    def _left(self, drives: dict[str, Floats]) -> list[str]:
        left, motion = [], self.scene.motion
        for name, cam in self.scene.machine.mechanism.cams.items():
            force: Floats = primal(drives[name])
            if cam.closure != "spring" or np.isnan(force).all():
                continue
            worst = int(np.nanargmin(force))
            if force[worst] < -_SLACK * np.nanmax(np.abs(force)):
                at = np.degrees(motion.crank_angle[worst])
                left.append(
                    f"{LEAVES} {name}: at crank angle {at:.4g}° and {primal(motion.speed)[worst]:.4g} "
                    f"rad/s it would have to be pulled with {-force[worst]:.4g} N; these forces apply to a "
                    f"follower in contact; {KEEPS}"
                )
        return left


def _pushes(source: AppliedLoad) -> bool:
    return any(primal(wrench)[:, :2].any() for wrench in source.wrenches.on.values())


def _where(solution: Solution, phi: Floats) -> list[str]:
    where = []
    if solution.singular.any():
        where.append(
            f"Forces are unbounded or indeterminate at crank angle {_angles(phi[solution.singular])}: the "
            "mechanism is at a dead centre or change point, where its joints cannot keep it in equilibrium; "
            "values at these angles are omitted."
        )
    if solution.locked.any():
        where.append(
            f"Friction locks the mechanism at crank angle {_angles(phi[solution.locked])}: no driving torque "
            "moves it there; reduce the friction or improve the transmission angle."
        )
    return where


def _angles(phi: Floats) -> str:
    shown = [f"{degree:.4g}°" for degree in np.degrees(phi)]
    return ", ".join(shown) if len(shown) <= 4 else f"{shown[0]} to {shown[-1]} ({len(shown)} angles)"
