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

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.quantities import About
from linkwright.kernel.result import Result
from linkwright.kernel.units import Kind
from linkwright.machine.machine import Machine
from linkwright.torsion.limits.criteria import PASSING_STRESS, Criterion
from linkwright.torsion.response.engine_torques import (
    CylinderStates,
    EnginePlace,
    cylinder_torques,
    sound_factors,
    throw_sources,
)
from linkwright.torsion.response.excited_train import ExcitedTrain, highest_order, under
from linkwright.torsion.response.harmonics import Source
from linkwright.torsion.response.survey import Survey

Floats = NDArray[np.float64]


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
    above: tuple[float, float] | None  # lowest and highest speed looked at above the limit [rad/s]

    @property
    def is_kept(self) -> bool:
        """Whether the limit is kept at all speeds looked at."""
        return self.above is None


@dataclass(frozen=True)
class MisfireVerdict(Result):
    """All limits of a train with one cylinder misfiring."""

    judgements: Annotated[tuple[MisfireJudgement, ...], About("As in normal firing, in the same order.")]

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Judgements as a table."""
        keys = ("part", "what", "found", "permitted", "speed", "cylinder", "above", "is_kept")
        rows = [{key: getattr(row, key) for key in keys} | {"unit": row.kind.unit} for row in self.judgements]
        return {"judgements": rows}


def misfire_verdict(machine: Machine, seen: Survey) -> MisfireVerdict | None:
    """Limits with the worst single misfire.

    None without an engine whose cylinders all fire, or without limits.
    """
    normal = [criterion for criterion in seen.criteria if _counts(criterion)]
    cases = list(misfires(machine, seen.at)) if normal else []
    if not cases:
        return None
    worst: list[MisfireJudgement | None] = [None] * len(normal)
    for case in cases:
        for n, criteria in enumerate(_criteria(seen, case.at)):
            judged = _judged(criteria, seen.speeds, case.cylinder)
            before = worst[n]
            if before is None or _ratio(judged) > _ratio(before):
                worst[n] = judged
    return MisfireVerdict(tuple(judged for judged in worst if judged is not None))


def misfires(machine: Machine, at: ExcitedTrain) -> Iterator[MisfireCase]:
    """The train with each cylinder in turn without combustion, at the speeds at which it was prepared."""
    train, speeds = machine.train, at.torques.speeds
    engines = () if train is None else train.installed
    if train is None or not engines or not all(sound_factors(one.engine).all() for one in engines):
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
    """Whether a limit holds in continuous operation."""
    return criterion.what != PASSING_STRESS and not np.isnan(criterion.permitted).all()


def _criteria(seen: Survey, at: ExcitedTrain) -> list[Criterion]:
    """The limits that count of another train at the speeds of a survey, in its order."""
    limits = replace(seen, at=at).criteria_at(seen.speeds)
    return [limit for limit, normal in zip(limits, seen.criteria, strict=True) if _counts(normal)]


def _judged(criterion: Criterion, speeds: Floats, cylinder: str) -> MisfireJudgement:
    """One limit where found over permitted is largest."""
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
    """Found over permitted."""
    return judged.found / judged.permitted if judged.permitted > 0 else np.inf
