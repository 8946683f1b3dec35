"""The whole mechanism of a machine: what its file builds of elements, with what a pumping unit expands into.

| description | makes |
| --- | --- |
| `pumping_unit` | points `crankshaft`, `saddle`; crank `crank`; rocker `beam`; cable `polished_rod` |
| a cam | the driver that follows it: a linear driver or a crank of its name |
| `rod_rotator` | point `rotator_pin` on the beam; rocker `rotator`: coupler the link, rocker the lever |
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel
from pydantic_core import InitErrorDetails

from linkwright.cam.model.cam import Cam
from linkwright.cam.model.follower import follower_of
from linkwright.kernel.description.base import fault
from linkwright.kernel.description.plain import arrays, keys, look
from linkwright.linkages.model.element import Cable, Crank, FixedPoint, LinearDriver, RigidPoint, Rocker
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.outline import TABLES, Outline
from linkwright.pumping.model.rod_rotator import PIN, ROTATOR, RodRotator
from linkwright.pumping.model.rotator_lengths import lengths
from linkwright.pumping.model.unit import BEAM, BEAM_LINK, CRANK, CRANKSHAFT, ROD, SADDLE, PumpingUnit

T = TypeVar("T", bound=BaseModel)

# Names of the elements that a unit expands into, and what they refer to, as a file would say it.
_UNIT: dict[str, dict[str, dict[str, str]]] = {
    "points": {CRANKSHAFT: {}, SADDLE: {}},
    "cranks": {CRANK: {"pivot": CRANKSHAFT}},
    "rockers": {BEAM: {"crank": CRANK, "pivot": SADDLE}},
    "cables": {ROD: {"link": BEAM_LINK}},
}
_ROTATOR: dict[str, dict[str, dict[str, str]]] = {
    "rigid_points": {PIN: {"link": BEAM_LINK}},
    "rockers": {ROTATOR: {"crank": PIN, "pivot": ROD}},
}


def with_followers(own: Mechanism) -> Mechanism:
    """A mechanism with a driver in place of each cam; the same mechanism gives the same.

    Parameters
    ----------
    own : Mechanism
        What the file builds of elements.
    """
    if not own.cams:
        return own
    return _kept((own,), partial(_driven, own), _has_arrays(*own.cams.values(), *own.points.values()))


def _driven(own: Mechanism) -> Mechanism:
    points = own.fixed_points()
    made = {name: follower_of(cam, points) for name, cam in own.cams.items()}
    cranks = {name: each for name, each in made.items() if isinstance(each, Crank)}
    drivers = {name: each for name, each in made.items() if isinstance(each, LinearDriver)}
    cams: dict[str, Cam] = {}
    return own.with_entries(
        {
            "cams": cams,
            "cranks": {**own.cranks, **cranks},
            "linear_drivers": {**own.linear_drivers, **drivers},
        }
    )


def mechanism_of(unit: PumpingUnit, rotator: RodRotator | None = None) -> Mechanism:
    """The mechanism that a pumping unit is, with its rotator if it has one.

    Parameters
    ----------
    unit : PumpingUnit
        The unit; its numbers may be arrays over many units.
    rotator : RodRotator, optional
        The rotator.

    Returns
    -------
    Mechanism
        Its elements, unchecked: a unit that does not close is told of by the analyses.
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
    """A description as it is, so that its numbers may be arrays."""
    return model.model_construct(**entries)


def merged(own: Mechanism, unit: PumpingUnit, rotator: RodRotator | None) -> Mechanism:
    """A mechanism together with what a unit expands into; the same parts give the same mechanism.

    Parameters
    ----------
    own : Mechanism
        What the file builds of elements.
    unit : PumpingUnit
        The unit.
    rotator : RodRotator or None
        The rotator.

    Returns
    -------
    Mechanism
        All elements.
    """
    parts = (own, unit, rotator)
    return _kept(parts, partial(_merged, *parts), _has_arrays(unit, rotator))


def _merged(own: Mechanism, unit: PumpingUnit, rotator: RodRotator | None) -> Mechanism:
    expanded = mechanism_of(unit, rotator)
    return own.with_entries({name: {**getattr(own, name), **getattr(expanded, name)} for name in TABLES})


def _has_arrays(*parts: BaseModel | None) -> bool:
    """Whether entries of some parts vary over many machines."""
    return any(True for _ in arrays(parts))


def _kept(parts: tuple[object, ...], make: Callable[[], Mechanism], varies: bool) -> Mechanism:
    """What is made of some parts, the same as before if they are the same."""
    key = tuple(map(id, parts))
    known = _known.get(key)
    if known is not None:
        return known[1]
    made = make()
    if varies:
        # Arrays are large, and may change in place.
        return made
    if len(_known) >= _KNOWN_MAX:
        _known.pop(next(iter(_known)), None)
    _known[key] = (parts, made)
    return made


# Mechanisms made last, with the parts they were made of: these keep their identity while they stand here,
# and the engine knows a machine again by the identity of its elements.
_known: dict[tuple[int, ...], tuple[tuple[object, ...], Mechanism]] = {}
_KNOWN_MAX = 16


def outline_of(machine: object) -> Outline:
    """Names of the whole mechanism of a machine, checked or raw."""
    own = look(machine, "mechanism")
    unit, rotator = look(machine, "pumping_unit"), look(machine, "rod_rotator")
    if not isinstance(unit, BaseModel | Mapping):
        return Outline.of(own)
    both = (_UNIT, _ROTATOR) if isinstance(rotator, BaseModel | Mapping) else (_UNIT,)
    return Outline.of({table: _joined(table, own, *both) for table in TABLES})


def _joined(table: str, own: object, *expanded: Mapping[str, Any]) -> dict[str, Any]:
    """One table of names: those of the file and those that are expanded."""
    found = look(own, table)
    joined = {name: look(found, name) for name in keys(found)}
    for each in expanded:
        joined |= each.get(table, {})
    return joined


def expansion_faults(machine: object) -> Iterator[InitErrorDetails]:
    """What is wrong between a mechanism and what a pumping unit adds to it.

    Parameters
    ----------
    machine : object
        The machine, checked or raw.

    Yields
    ------
    InitErrorDetails
        Neither mechanism nor unit; a rotator without a unit, or too far out on the beam; names that are
        taken.
    """
    own, unit, rotator = (look(machine, key) for key in ("mechanism", "pumping_unit", "rod_rotator"))
    if unit is None:
        if rotator is not None:
            yield fault("rod_rotator", found="a table", expected="a [pumping_unit] that it works on")
        return
    taken = {
        name for part in (_UNIT, *((_ROTATOR,) if rotator else ())) for each in part.values() for name in each
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
