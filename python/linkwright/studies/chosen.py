"""The machine that shares of the variables describe: numbers, and what stands in lists."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from linkwright.kernel.arrays import Floats
from linkwright.kernel.units.reading import is_number
from linkwright.machine.address import get
from linkwright.machine.machine import Machine
from linkwright.studies.axes import Axis, variant
from linkwright.studies.engine import sound_variant
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import Rows


def machine_of(plan: StudyPlan, rows: Rows) -> Machine:
    """The machine of the first row."""
    lists = [axis for axis in plan.axes if not axis.is_number]
    base = _with_choices(plan, {axis.name: axis.choices[int(rows.columns[axis.name][0])] for axis in lists})
    named = [(axis.name, axis.addresses) for axis in plan.axes if axis.is_number]
    named += [(entry.name, entry.addresses) for entry in plan.derived]
    return sound_variant(
        base, {place: float(rows.columns[name][0]) for name, places in named for place in places}
    )


def numbers_alone(plan: StudyPlan, shares: Floats) -> tuple[StudyPlan, list[int]]:
    """The study with what is no number chosen, and the places of the variables that are left."""
    kept = [i for i, axis in enumerate(plan.axes) if axis.is_number]
    pairs = zip(plan.axes, shares, strict=True)
    machine = _with_choices(plan, {axis.name: choice(axis, s) for axis, s in pairs if not axis.is_number})
    return replace(plan, machine=machine, axes=tuple(plan.axes[i] for i in kept)), kept


def given_shares(plan: StudyPlan, shares: Floats) -> Floats | None:
    """The machine of a study as shares, those of choices as they are; None outside of its ranges."""
    given = shares.copy()
    for i, axis in enumerate(plan.axes):
        if axis.choices:
            continue
        entries = {get(plan.machine, address) for address in axis.addresses}
        value = entries.pop()
        share = axis.share(value) if is_number(value) and not entries else math.nan
        if not 0.0 <= share <= 1.0:
            return None
        given[i] = share
    return given


def choice(axis: Axis, share: float) -> Any:
    """What stands in the list at a share."""
    return axis.choices[min(int(share * len(axis.choices)), len(axis.choices) - 1)]


def _with_choices(plan: StudyPlan, chosen: Mapping[str, Any]) -> Machine:
    changes = [
        (place, chosen[axis.name]) for axis in plan.axes if axis.name in chosen for place in axis.addresses
    ]
    return variant(plan.machine, changes) if changes else plan.machine
