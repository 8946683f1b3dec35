"""The whole mechanism of a machine: what its file builds of elements, with what a pumping unit expands into.

| description | makes |
| --- | --- |
| a cam | the driver that follows it: a linear driver or a crank of its name |
| an axis with sections | the driver of its name, or of its `driver`, that follows them |
| a cylinder with a flow | one that follows its volume |
| `pumping_unit`, `rod_rotator` | what `linkwright.pumping.model.expansion` says |
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from linkwright.kernel.description.place import arrays, keys, look
from linkwright.linkages.model.element import Crank, LinearDriver
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.topology import TABLES, Topology

if TYPE_CHECKING:
    from linkwright.axes.model.axis import Axis, Master
    from linkwright.drive.model.drive import Drive
    from linkwright.pumping.model.rod_rotator import RodRotator
    from linkwright.pumping.model.unit import PumpingUnit


def with_followers(
    own: Mechanism, axes: Mapping[str, Axis], master: Master | None, drive: Drive | None
) -> Mechanism:
    """A mechanism with a driver for each cam and flow, and drivers that follow their axes.

    `own`: elements of the file. The same parts give the same mechanism.
    """
    if axes:
        from linkwright.axes.model.follower import with_axes

        parts = (own, axes, master, drive)
        own = _kept(parts, partial(with_axes, *parts), _has_arrays(*axes.values(), master, drive))
    flowing = [cylinder for cylinder in own.cylinders.values() if cylinder.flow is not None]
    if not (own.cams or flowing):
        return own
    varies = _has_arrays(*own.cams.values(), *own.points.values(), *flowing)
    return _kept((own,), partial(_driven, own), varies)


def _driven(own: Mechanism) -> Mechanism:
    from linkwright.cam.model.flow_law import flow_driven
    from linkwright.cam.model.follower import follower_of

    points = own.fixed_points()
    made = {name: follower_of(cam, points) for name, cam in own.cams.items()}
    cranks = {name: driver for name, driver in made.items() if isinstance(driver, Crank)}
    drivers = {name: driver for name, driver in made.items() if isinstance(driver, LinearDriver)}
    return own.with_entries(
        {
            "cams": {},
            "cranks": {**own.cranks, **cranks},
            "linear_drivers": {**own.linear_drivers, **drivers},
            "cylinders": {
                name: cylinder if cylinder.flow is None else flow_driven(cylinder)
                for name, cylinder in own.cylinders.items()
            },
        }
    )


def merged(own: Mechanism, unit: PumpingUnit, rotator: RodRotator | None) -> Mechanism:
    """A mechanism with what a unit expands into, the same for the same parts; `own`: those of the file."""
    parts = (own, unit, rotator)
    return _kept(parts, partial(_merged, *parts), _has_arrays(unit, rotator))


def _merged(own: Mechanism, unit: PumpingUnit, rotator: RodRotator | None) -> Mechanism:
    from linkwright.pumping.model.expansion import mechanism_of

    expanded = mechanism_of(unit, rotator)
    return own.with_entries({name: {**getattr(own, name), **getattr(expanded, name)} for name in TABLES})


def _has_arrays(*parts: BaseModel | None) -> bool:
    return any(True for _ in arrays(parts))


def _kept(parts: tuple[object, ...], make: Callable[[], Mechanism], varies: bool) -> Mechanism:
    """Parts made from others, cached while these stay the same."""
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


def topology_of(machine: object) -> Topology:
    """Names of the whole mechanism of a machine, checked or raw."""
    own = look(machine, "mechanism")
    unit, rotator = look(machine, "pumping_unit"), look(machine, "rod_rotator")
    if not isinstance(unit, BaseModel | Mapping):
        return Topology.of(own)
    from linkwright.pumping.model.expansion import ROTATOR_PARTS, UNIT

    both = (UNIT, ROTATOR_PARTS) if isinstance(rotator, BaseModel | Mapping) else (UNIT,)
    return Topology.of({table: _joined(table, own, *both) for table in TABLES})


def _joined(table: str, own: object, *expanded: Mapping[str, Any]) -> dict[str, Any]:
    elements = look(own, table)
    joined = {name: look(elements, name) for name in keys(elements)}
    for element in expanded:
        joined |= element.get(table, {})
    return joined
