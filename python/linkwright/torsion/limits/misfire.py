"""The worst single misfire: each limit with one cylinder without combustion, whichever is worst for it.

Rules of class ask for torsional vibration with one cylinder misfiring beside normal firing. Here each
cylinder of each engine in turn keeps its compression and has no combustion; loads and couplings follow its
operating point. Looked at are the speeds of the run, the resonances, and the peaks of normal firing. What is
exceeded then restricts the operation with a cylinder out; it is no fault of the train.

References
----------
.. [1] Korean Register, Rules for the Classification of Steel Ships, part 5, chapter 4.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import Kind
from linkwright.machine.machine import Machine
from linkwright.torsion.excitation.engine_torques import (
    CylinderStates,
    EnginePlace,
    cylinder_torques,
    sound_factors,
    throw_sources,
)
from linkwright.torsion.excitation.excited_train import ExcitedTrain, highest_order, under
from linkwright.torsion.excitation.harmonics import Source
from linkwright.torsion.limits.barred_range import BarredRange, not_barred
from linkwright.torsion.limits.criteria import PASSING_STRESS, Criterion, criteria
from linkwright.torsion.limits.survey import Survey, in_a_row
from linkwright.torsion.response.forced import torsion_response
from linkwright.torsion.response.mesh_torque import MeshTorque, meshed


class MisfireCase(NamedTuple):
    """A train of which one cylinder has no combustion."""

    cylinder: str  # its number, after the name of one of several engines
    at: ExcitedTrain


class MisfireJudgement(NamedTuple):
    """One limit, with the cylinder whose misfire is worst for it."""

    part: str  # name of the shaft, coupling, damper or gear stage
    what: str  # in words
    kind: Kind  # the quantity
    found: float  # SI
    permitted: float  # SI
    speed: float  # of the first disc [rad/s]
    cylinder: str  # that does not fire
    above: tuple[float, float] | None  # lowest and highest speed examined above the limit [rad/s]

    @property
    def is_kept(self) -> bool:
        """Whether the limit is kept at all speeds examined."""
        return self.above is None


class MisfireGear(NamedTuple):
    """A gear stage, with the cylinders whose misfire is worst for its torque."""

    stage: str
    mean: float  # at the speed of service, of the case with the largest K_A there [N m]
    vibratory: float  # likewise [N m]
    application_factor: float  # K_A at the speed of service
    cylinder: str  # that does not fire there
    application_factor_max: float  # largest K_A of all speeds
    speed: float  # there, of the first disc [rad/s]
    cylinder_max: str  # that does not fire there


class MisfireTorque(NamedTuple):
    """The largest vibratory torque of a shaft at speeds that are not barred, by the worst misfire."""

    shaft: str
    torque: float  # half the peak-to-peak torque [N m]
    speed: float  # of the first disc [rad/s]
    cylinder: str


@dataclass(frozen=True)
class MisfireVerdict(Result):
    """All limits of a train with one cylinder misfiring."""

    judgements: Annotated[tuple[MisfireJudgement, ...], About("As in normal firing, in the same order.")]
    gears: Annotated[
        tuple[MisfireGear, ...], About("Statically determinate gear stages, by the worst misfire.")
    ] = ()
    torques: Annotated[
        tuple[MisfireTorque, ...],
        About("Largest vibratory torque of each shaft at speeds that are not barred, by the worst misfire."),
    ] = ()

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Judgements and gear stages as tables."""
        keys = ("part", "what", "found", "permitted", "speed", "cylinder", "above", "is_kept")
        rows = [{key: getattr(row, key) for key in keys} | {"unit": row.kind.unit} for row in self.judgements]
        gears, torques = ([one._asdict() for one in listed] for listed in (self.gears, self.torques))
        return {"judgements": rows, "gears": gears, "torques": torques}


def misfire_verdict(
    machine: Machine, seen: Survey, barred: Sequence[BarredRange] = ()
) -> MisfireVerdict | None:
    """Limits with the worst misfire; None without a wholly firing engine or limits."""
    normal = [criterion for criterion in seen.criteria if _counts(criterion)]
    engines = () if machine.train is None else machine.train.installed
    is_asked = bool(normal) or any(one.engine.fatigue for one in engines)
    cases = list(misfires(machine, seen.at)) if is_asked else []
    if not cases:
        return None
    worst: list[MisfireJudgement | None] = [None] * len(normal)
    gears: dict[str, MisfireGear] = {}
    torques: dict[str, MisfireTorque] = {}
    kept = not_barred(seen.speeds, [span.barred for span in barred])
    for case in cases:
        limits, meshes, vibratory = _looked_at(seen, case.at)
        for shaft, row in zip(seen.found.shafts, vibratory[:, kept], strict=True):
            n = int(np.nan_to_num(row, nan=np.inf).argmax())
            twisted = MisfireTorque(shaft, float(row[n]), float(seen.speeds[kept][n]), case.cylinder)
            torques[shaft] = max(torques.get(shaft, twisted), twisted, key=lambda one: one.torque)
        for n, criterion in enumerate(limits):
            judged = _judged(criterion, seen.speeds, case.cylinder)
            before = worst[n]
            if before is None or _ratio(judged) > _ratio(before):
                worst[n] = judged
        for gear in _gears(meshes, seen.service, case.cylinder):
            gears[gear.stage] = _worse(gears.get(gear.stage, gear), gear)
    rows = tuple(judged for judged in worst if judged is not None)
    return MisfireVerdict(rows, tuple(gears.values()), tuple(torques.values()))


def misfires(machine: Machine, at: ExcitedTrain) -> Iterator[MisfireCase]:
    """The train with each cylinder in turn without combustion, at the speeds at which it was prepared."""
    train, speeds = machine.train, at.torques.speeds
    engines = () if train is None else train.installed
    if train is None or train.is_driven or not all(sound_factors(one.engine).all() for one in engines):
        return
    places, gases = [], []
    for one in engines:
        first = at.referred.discs.index(one.throws[0])
        places.append(EnginePlace(first, float(at.referred.speed[first]), one.phase))
        gases.append(cylinder_torques(one.engine, places[-1].turning * speeds, highest_order(train)))

    def sources(engine: int, factors: Floats) -> list[Source]:
        states = CylinderStates(factors[:, None])
        return throw_sources(engines[engine].engine, gases[engine], states, places[engine])

    sound = [sources(k, sound_factors(one.engine)) for k, one in enumerate(engines)]
    for k, one in enumerate(engines):
        for number in range(one.engine.n_cylinders):
            factors = sound_factors(one.engine)
            factors[number] = 0.0
            every = [*sound[:k], sources(k, factors), *sound[k + 1 :]]
            torques = [member for group in every for member in group]
            yield MisfireCase(
                f"{one.name} {number + 1}".strip(), under(machine, at.train, at.referred, speeds, torques)
            )


def _counts(criterion: Criterion) -> bool:
    return criterion.what != PASSING_STRESS and not np.isnan(criterion.permitted).all()


def _looked_at(seen: Survey, at: ExcitedTrain) -> tuple[list[Criterion], list[MeshTorque], Floats]:
    """The limits that count of another train at the speeds of a survey, with its vibratory torques [N m]."""
    parts, gears, torques = [], [], []
    for part in replace(seen, at=at).parts(seen.speeds):
        response = torsion_response(part)
        meshes = meshed(part, response) if part.train.gears else None
        parts.append(criteria(seen.machine, part, response, seen.service, meshes))
        gears += [] if meshes is None else [meshes]
        torques.append(response.shaft_torque_vibratory)
    limits = zip(in_a_row(parts), seen.criteria, strict=True)
    return [limit for limit, normal in limits if _counts(normal)], gears, np.concatenate(torques, axis=1)


def _gears(parts: Sequence[MeshTorque], service: float, cylinder: str) -> Iterator[MisfireGear]:
    for stage, name in enumerate(parts[0].stages if parts else ()):
        speeds = np.concatenate([part.speeds for part in parts])
        mean, vibratory, factor = (
            np.concatenate([getattr(part, curve)[stage] for part in parts])
            for curve in ("mean", "vibratory", "application_factor")
        )
        if parts[0].toothed[stage] and not np.isnan(factor).any():
            at, worst = int(np.abs(speeds - service).argmin()), int(factor.argmax())
            numbers = (float(abs(mean[at])), float(vibratory[at]), float(factor[at]))
            yield MisfireGear(name, *numbers, cylinder, float(factor[worst]), float(speeds[worst]), cylinder)


def _worse(one: MisfireGear, other: MisfireGear) -> MisfireGear:
    service = max(one, other, key=lambda gear: gear.application_factor)
    peak = max(one, other, key=lambda gear: gear.application_factor_max)
    return service._replace(
        application_factor_max=peak.application_factor_max, speed=peak.speed, cylinder_max=peak.cylinder_max
    )


def _judged(criterion: Criterion, speeds: Floats, cylinder: str) -> MisfireJudgement:
    """A limit at its largest utilisation."""
    ratio = criterion.ratio
    n = int(ratio.argmax())
    over = speeds[ratio > 1]
    value = float(criterion.found[n]) if np.isfinite(criterion.found[n]) else np.inf
    return MisfireJudgement(
        criterion.part,
        criterion.what,
        criterion.kind,
        value,
        float(criterion.permitted[n]),
        float(speeds[n]),
        cylinder,
        (float(over.min()), float(over.max())) if len(over) else None,
    )


def _ratio(judged: MisfireJudgement) -> float:
    return judged.found / judged.permitted if judged.permitted > 0 else np.inf
