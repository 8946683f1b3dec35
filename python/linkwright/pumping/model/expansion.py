"""The mechanism that a pumping unit is, with its rotator: elements like any other.

| description | makes |
| --- | --- |
| `pumping_unit` | points `crankshaft`, `saddle`; crank `crank`; rocker `beam`; cable `polished_rod` |
| `rod_rotator` | point `rotator_pin` on the beam; rocker `rotator`: coupler the link, rocker the lever |
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault
from linkwright.kernel.description.place import keys, look
from linkwright.linkages.model.element import Cable, Crank, FixedPoint, RigidPoint, Rocker
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.topology import TABLES
from linkwright.pumping.model.rod_rotator import PIN, ROTATOR, RodRotator
from linkwright.pumping.model.rotator_lengths import lengths
from linkwright.pumping.model.unit import BEAM, BEAM_LINK, CRANK, CRANKSHAFT, ROD, SADDLE, PumpingUnit

T = TypeVar("T", bound=BaseModel)

# Names of the elements that a unit expands into, and what they refer to, as a file would say it.
UNIT: dict[str, dict[str, dict[str, str]]] = {
    "points": {CRANKSHAFT: {}, SADDLE: {}},
    "cranks": {CRANK: {"pivot": CRANKSHAFT}},
    "rockers": {BEAM: {"crank": CRANK, "pivot": SADDLE}},
    "cables": {ROD: {"link": BEAM_LINK}},
}
ROTATOR_PARTS: dict[str, dict[str, dict[str, str]]] = {
    "rigid_points": {PIN: {"link": BEAM_LINK}},
    "rockers": {ROTATOR: {"crank": PIN, "pivot": ROD}},
}


def mechanism_of(unit: PumpingUnit, rotator: RodRotator | None = None) -> Mechanism:
    """The mechanism that a pumping unit is, with its rotator if it has one; numbers may be arrays over many
    units.

    Its elements are unchecked: a unit that does not close is reported by the analyses.
    """
    x, y = unit.saddle
    parts: dict[str, dict[str, Any]] = {
        "points": {CRANKSHAFT: _made(FixedPoint, x=0.0, y=0.0), SADDLE: _made(FixedPoint, x=x, y=y)},
        "cranks": {CRANK: _made(Crank, radius=unit.R, phase=unit.crank_phase, pivot=CRANKSHAFT)},
        "rockers": {
            BEAM: _made(
                Rocker,
                crank=CRANK,
                pivot=SADDLE,
                coupler=unit.P,
                rocker=unit.C,
                assembly="left" if unit.is_left else "right",
            )
        },
        "cables": {
            ROD: _made(
                Cable,
                link=BEAM_LINK,
                radius=unit.A,
                length=unit.cable,
                reference=unit.turned_arm(unit.psi_top),
                angle=-np.pi / 2,
                # To the left of "down" is the right.
                side="right" if unit.is_mirrored else "left",
            )
        },
    }
    if rotator is not None:
        link, lever = lengths(unit, rotator)
        along = rotator.pin_distance if unit.is_class_3 else -rotator.pin_distance
        parts["rigid_points"] = {PIN: _made(RigidPoint, link=BEAM_LINK, along=along, across=0.0)}
        parts["rockers"][ROTATOR] = _made(
            Rocker, crank=PIN, pivot=ROD, coupler=link, rocker=lever, assembly=rotator.assembly
        )
    return _made(Mechanism, **parts)


def _made(model: type[T], **entries: Any) -> T:
    return model.model_construct(**entries)


def expansion_faults(machine: object) -> Iterator[InitErrorDetails]:
    """What is wrong between a mechanism, checked or raw, and what a pumping unit adds to it.

    Neither mechanism nor unit; a rotator without a unit, or too far out on the beam; names that are taken.
    """
    own, unit, rotator = (look(machine, key) for key in ("mechanism", "pumping_unit", "rod_rotator"))
    if unit is None:
        if rotator is not None:
            yield fault("rod_rotator", found="a table", expected="a [pumping_unit] that it works on")
        return
    taken = {
        name
        for part in (UNIT, *((ROTATOR_PARTS,) if rotator else ()))
        for element in part.values()
        for name in element
    }
    for table in TABLES:
        for name in keys(look(own, table)):
            if name in taken:
                remedy = "the pumping unit has a part of this name: choose another"
                yield fault("mechanism", table, name, found=name, expected="a new name", remedy=remedy)
    yield from _rotator_faults(unit, rotator)


def _rotator_faults(unit: object, rotator: object) -> Iterator[InitErrorDetails]:
    """A pin beyond the horsehead: the distance to the hanger then has an extreme inside the stroke."""
    if not isinstance(unit, PumpingUnit) or not isinstance(rotator, RodRotator):
        return
    if rotator.regime == "continuous" and rotator.pin_distance >= unit.A:
        expected = f"less than pumping_unit.A, {unit.A:.6g} m"
        remedy = "beyond it link and lever would come into line inside the stroke"
        yield fault(
            "rod_rotator", "pin_distance", found=rotator.pin_distance, expected=expected, remedy=remedy
        )
