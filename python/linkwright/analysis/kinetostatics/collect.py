"""From the unknowns of all pairs to named forces, powers and findings."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.kinetostatics.applied import Applied
from linkwright.analysis.kinetostatics.equilibrium import Solution
from linkwright.analysis.kinetostatics.pairs import PairModel
from linkwright.analysis.kinetostatics.result import Contribution, Forces, PairForce
from linkwright.analysis.kinetostatics.scene import Scene
from linkwright.analysis.kinetostatics.wrench import Wrenches
from linkwright.errors import FindingError

Floats = NDArray[np.float64]

# Share of the greatest tension that a cable may push by rounding.
_SLACK = 1e-9


class Collector:
    """From the unknowns to named forces.

    Parameters
    ----------
    scene : Scene
        The machine and its motion.
    models : list of PairModel
        Its pairs and drives.
    sources : dict of str to Applied
        What acts, by name.
    solution : Solution
        The unknowns.

    Raises
    ------
    FindingError
        There is no answer at any angle.
    """

    def __init__(
        self, scene: Scene, models: list[PairModel], sources: dict[str, Applied], solution: Solution
    ) -> None:
        self.scene, self.models, self.sources, self.solution = scene, models, sources, solution
        sizes = np.cumsum([0] + [len(model.unknowns) for model in models])
        self.spans = [slice(int(a), int(b)) for a, b in pairwise(sizes)]
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
            findings=(*_where(self.solution, motion.crank_angle), *self._slack(pairs)),
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
        for pair in pairs.values():
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
            "mechanism is in a dead or change point there, and its pairs cannot keep it in equilibrium; "
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
