"""Check of a train against its limits: each limit with the value found, its speed, and the consequence.

A state is `ok`, `bar` (speeds are to be barred, and may be passed quickly), or `exceeds`. Speeds may be
barred for vibratory stresses of shafts; all else that is above its limit exceeds it, with the speeds at
which it does. What follows for the operation is said in a few sentences: exceeded limits first, then barred
speed ranges, then speeds to be avoided with a cylinder misfiring.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.quantities import About
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import Kind
from linkwright.machine.machine import Machine
from linkwright.torsion.limits.barred_range import BarredRange, joined_ranges, surveyed_ranges, together
from linkwright.torsion.limits.criteria import (
    CONTACT,
    PASSING_STRESS,
    VIBRATORY_STRESS,
    Criterion,
    Exceedance,
    shown_quantity,
)
from linkwright.torsion.limits.misfire import MisfireVerdict
from linkwright.torsion.limits.survey import Survey, survey
from linkwright.torsion.model.shaft_limit import RULES

State = Literal["ok", "bar", "exceeds"]
_RPM = math.pi / 30


@dataclass(frozen=True)
class Judgement:
    """One limit, and whether it is kept.

    Attributes
    ----------
    part : str
        Name of the shaft, coupling, damper or gear stage.
    what : str
        What is limited, in words.
    kind : Kind
        The quantity.
    found, permitted : float
        Where found over permitted is largest, SI; infinite at a resonance that nothing damps.
    speed : float
        There, of the first disc [rad/s].
    state : {"ok", "bar", "exceeds"}
        What follows.
    ranges : tuple of tuple of float
        Lowest and highest speed of each range in which the limit is exceeded, to be barred where the state
        is "bar" [rad/s].
    reason : str
        Why speeds may not be barred; else empty.
    rule : str
        Where the limit comes from: "given", or the name of a rule; empty for the contact of teeth.
    """

    part: str
    what: str
    kind: Kind
    found: float
    permitted: float
    speed: float
    state: State
    ranges: tuple[tuple[float, float], ...] = ()
    reason: str = ""
    rule: str = "given"

    @property
    def words(self) -> str:
        """The judgement as a sentence."""
        text = f"{self.part}: {self.what} {shown_quantity(self.found, self.kind)} at {_rpm(self.speed)}"
        text += f", permitted {shown_quantity(self.permitted, self.kind)}"
        listed = ", ".join(f"{_rpm(low)} to {_rpm(high)}" for low, high in self.ranges)
        if self.state == "ok":
            return f"{text}: within limit"
        if self.state == "bar":
            return f"{text}: barred speed range {listed}, pass quickly"
        return f"{text}: limit exceeded from {listed}" + (f"; {self.reason}" if self.reason else "")


@dataclass(frozen=True)
class Verdict(Result):
    """All limits of a train."""

    judgements: Annotated[tuple[Judgement, ...], About("Shafts, couplings, dampers, gear stages.")]
    barred: Annotated[
        tuple[BarredRange, ...],
        About("Ranges in which shafts are stressed more than permitted in continuous operation."),
    ]
    notes: Annotated[tuple[str, ...], About("Limits without verdict, with the reason.")]

    @property
    def state(self) -> State:
        """The worst of all."""
        states: tuple[State, ...] = ("exceeds", "bar")
        return next((state for state in states if any(row.state == state for row in self.judgements)), "ok")

    @property
    def words(self) -> tuple[str, ...]:
        """Each judgement as a sentence, those not kept first."""
        order = ("exceeds", "bar", "ok")
        rows = sorted(self.judgements, key=lambda row: order.index(row.state))
        return tuple(row.words for row in rows)

    def to_dict(self, *, curves: bool = False) -> dict[str, Any]:
        """Judgements and barred ranges as tables."""
        keys = ("part", "what", "rule", "found", "permitted", "speed", "state", "reason", "words")
        rows = [
            {key: getattr(row, key) for key in keys} | {"unit": row.kind.unit, "ranges": _lists(row.ranges)}
            for row in self.judgements
        ]
        barred = [span.to_dict() | {"not_passable": _lists(span.not_passable)} for span in self.barred]
        return {"state": self.state, "judgements": rows, "barred": barred, "notes": list(self.notes)}


def verdict(machine: Machine, seen: Survey | None = None) -> Verdict:
    """Check of a train against its limits over the run and its resonances; empty without limits or mesh."""
    seen = survey(machine) if seen is None else seen
    barred = surveyed_ranges(seen)
    peaks = np.array([exceedance.peak for exceedance in seen.exceeded])
    beside = seen.criteria_at(peaks) if len(peaks) else seen.criteria
    rows = []
    for n, criterion in enumerate(seen.criteria):
        over = [column for column, one in enumerate(seen.exceeded) if one.row == n]
        if criterion.what != PASSING_STRESS and not np.isnan(criterion.permitted).all():
            # Peaks lie beside resonances, a little.
            worst = _worst(criterion, seen.speeds) if not over else _worst(beside[n], peaks, over)
            judged = _judged(criterion, worst, [seen.exceeded[column] for column in over], barred)
            rows.append(replace(judged, rule=_rule(seen, criterion)))
    return Verdict(tuple(rows), barred, tuple(_notes(seen)))


def _rule(seen: Survey, criterion: Criterion) -> str:
    if criterion.what == CONTACT:
        return ""
    shaft = seen.at.train.shafts.get(criterion.part)
    limit = None if shaft is None else shaft.limit
    return RULES["given" if limit is None or criterion.what != VIBRATORY_STRESS else limit.kind]


def _worst(
    criterion: Criterion, speeds: Floats, places: list[int] | None = None
) -> tuple[float, float, float]:
    """Value, limit and speed of the largest utilisation at some indices."""
    at = np.arange(len(speeds)) if places is None else np.array(places)
    n = int(at[np.argmax(criterion.ratio[at])])
    # Orders without any bound have no sum either: NaN.
    value = float(criterion.found[n]) if math.isfinite(criterion.found[n]) else math.inf
    return value, float(criterion.permitted[n]), float(speeds[n])


def _judged(
    criterion: Criterion,
    worst: tuple[float, float, float],
    over: list[Exceedance],
    barred: tuple[BarredRange, ...],
) -> Judgement:
    state: State = "exceeds" if over else "ok"
    reason = "teeth lose contact" if over and criterion.what == CONTACT else ""
    ranges = tuple((one.low, one.high) for one in over)
    if over and criterion.what == VIBRATORY_STRESS:
        mine = [one for one in barred if one.shaft == criterion.part]
        reason = next(filter(None, map(_against_barring, mine)), "")
        if not reason:
            state, ranges = "bar", tuple(one.barred for one in mine)
    return Judgement(criterion.part, criterion.what, criterion.kind, *worst, state, ranges, reason)


def _against_barring(barred: BarredRange) -> str:
    if barred.not_passable:
        low, high = barred.not_passable[0]
        return f"passage not permitted from {_rpm(low)} to {_rpm(high)}"
    if barred.is_passable is None:
        return "no stress permitted in transient passage is given"
    if not barred.may_be_barred:
        highest = barred.ratio_permitted
        return f"speeds above {highest:.0%} of the service speed may not be barred in normal operation"
    if barred.barred[0] <= barred.service_speed <= barred.barred[1]:
        return "the range contains the service speed"
    return ""


def _notes(seen: Survey) -> Iterator[str]:
    said: dict[str, list[str]] = {}
    for criterion in seen.criteria:
        silent = np.isnan(criterion.permitted)
        if criterion.what == CONTACT and silent.all():
            text = "in a loop of rigid stages, whose torques are statically indeterminate"
        elif criterion.what == VIBRATORY_STRESS and silent.any():
            limit = seen.at.train.shafts[criterion.part].limit
            rule = "" if limit is None else f" by {RULES[limit.kind]}"
            text = f"no limit is given{rule} above {_rpm(float(seen.speeds[silent].min()))}"
        else:
            continue
        said.setdefault(text, []).append(criterion.part)
    for name, shaft in seen.at.train.shafts.items():
        if shaft.limit is not None and shaft.limit.counted_strength != shaft.limit.tensile_strength:
            counted = (shaft.limit.counted_strength or 0.0) / 1e6
            text = f"the rule counts the tensile strength as {counted:.4g} MPa"
            said.setdefault(text, []).append(name)
    yield from (f"{', '.join(parts)}: {text}" for text, parts in said.items())


def _lists(ranges: tuple[tuple[float, float], ...]) -> list[list[float]]:
    return [list(span) for span in ranges]


def _rpm(speed: float) -> str:
    return f"{speed / _RPM:.5g} rpm"


_RPM = math.pi / 30


def operation(speeds: tuple[float, float], verdict: Verdict, misfire: MisfireVerdict | None) -> str:
    """Restrictions of the operation in words. `speeds`: lowest and highest examined [rad/s]."""
    if not verdict.judgements:
        return ""
    return " ".join((*_normal(speeds, verdict), *_misfiring(misfire)))


def _normal(speeds: tuple[float, float], verdict: Verdict) -> Iterator[str]:
    exceeded = [row for row in verdict.judgements if row.state == "exceeds"]
    span = _between(*speeds)
    if exceeded:
        parts = ", ".join(f"{row.part} {row.what}" for row in exceeded)
        places = _listed(low_high for row in exceeded for low_high in row.ranges)
        yield f"Continuous operation is not permitted at {places}: limits are exceeded ({parts})."
    barred = together(one for one in verdict.barred if one.may_be_barred and one.is_passable)
    if barred and exceeded:
        yield f"Barred speed range, to be passed quickly: {_listed(barred)}."
    elif barred:
        yield (
            f"Continuous operation is permitted from {span} but for the barred speed range "
            f"{_listed(barred)}, to be passed quickly."
        )
    elif not exceeded:
        yield f"Continuous operation is permitted from {span} without restriction."


def _misfiring(misfire: MisfireVerdict | None) -> Iterator[str]:
    if misfire is None:
        return
    over = [(row.above, row.part) for row in misfire.judgements if row.above is not None]
    if not over:
        yield "With one cylinder misfiring, all limits are kept."
        return
    parts = ", ".join(dict.fromkeys(part for _, part in over))
    yield f"With one cylinder misfiring, avoid {_listed(above for above, _ in over)} ({parts})."


def _listed(ranges: Iterable[tuple[float, float]]) -> str:
    """Ranges of speeds, those that meet taken as one."""
    return ", ".join(_between(low, high) for low, high in joined_ranges(ranges))


def _between(low: float, high: float) -> str:
    if high == low:
        return f"{low / _RPM:.5g} rpm"
    return f"{low / _RPM:.5g} to {high / _RPM:.5g} rpm"
