"""Handles of the drawing: points that can be dragged, and the entries of the file that follow.

| point | entries |
| --- | --- |
| fixed point | its coordinates |
| pin of a crank | radius and phase |
| slider | length of the rod |
| joint of a coupler and a rocker | both lengths |
| point of a link | its place on the link |
| joint of bars | lengths of the bars that end there |
| linear driver | its place at crank angle zero |
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.kernel.description.text import join
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.topology import ORIGIN
from linkwright.machine.machine import Machine

# Table of the mechanism → entries that place its point.
_PLACES = {
    "points": ("x", "y"),
    "cranks": ("radius", "phase"),
    "sliders": ("rod",),
    "rockers": ("coupler", "rocker"),
    "rigid_points": ("along", "across"),
    "linear_drivers": ("start",),
}


def handles(machine: Machine) -> list[dict[str, Any]]:
    """The points that can be dragged.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    list of dict
        ``point``, its name, and ``entries``, addresses of what follows.
    """
    found = dict(_handles(machine.mechanism))
    return [{"point": name, "entries": addresses} for name, addresses in found.items() if addresses]


def entries_of(machine: Machine, point: str) -> list[str]:
    """Addresses of the entries that follow a point; none if it cannot be dragged."""
    return dict(_handles(machine.mechanism)).get(point, [])


def _handles(mechanism: Mechanism) -> Iterator[tuple[str, list[str]]]:
    for table, names in _PLACES.items():
        for name, element in getattr(mechanism, table).items():
            if name != ORIGIN or table != "points":
                given = [name for name in names if getattr(element, name) is not None]
                yield name, [join(("mechanism", table, name, each)) for each in given]
    for name in mechanism.joints:
        bars = [each for each, bar in mechanism.bars.items() if name in (bar.start, bar.end)]
        yield name, [join(("mechanism", "bars", bar, "length")) for bar in bars]
