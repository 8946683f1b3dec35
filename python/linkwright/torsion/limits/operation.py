"""How a train may be operated: what follows from all verdicts, in a few sentences.

Limits that are exceeded come first, then barred speed ranges, then speeds to be
avoided with a cylinder misfiring.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from linkwright.torsion.limits.barred_range import joined_ranges, together
from linkwright.torsion.limits.misfire import MisfireVerdict
from linkwright.torsion.limits.verdict import Verdict

_RPM = math.pi / 30


def operation(speeds: tuple[float, float], verdict: Verdict, misfire: MisfireVerdict | None) -> str:
    """Restrictions of the operation in words. `speeds`: lowest and highest looked at [rad/s]."""
    if not verdict.judgements:
        return ""
    return " ".join((*_normal(speeds, verdict), *_misfiring(misfire)))


def _normal(speeds: tuple[float, float], verdict: Verdict) -> Iterator[str]:
    """With all cylinders firing."""
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
    """With one cylinder misfiring."""
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
    """A range of speeds."""
    if high == low:
        return f"{low / _RPM:.5g} rpm"
    return f"{low / _RPM:.5g} to {high / _RPM:.5g} rpm"
