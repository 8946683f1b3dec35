"""What servo axes move by motors of their own: bodies and loads that the crankshaft does not feel.

A machine with a motor at its crankshaft, `[drive.motor]`, may have axes beside: its steady motion is that of
the parts that the crankshaft moves, and the axes follow its angle as their master.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.drive.model.drive import Drive
from linkwright.kernel.errors import FindingError
from linkwright.machine.machine import Machine
from linkwright.machine.whole_mechanism import topology_of

# Entries of a load, or of a body, that name a point, a link or a slide.
_PLACES = ("on", "between", "along", "against")


def axis_drivers(machine: Machine) -> dict[str, str]:
    """Driver of each axis → name of the axis."""
    return {axis.driver or name: name for name, axis in machine.axes.items()}


def without_drive(machine: Machine) -> Machine:
    """The machine without what its drive is made of; its speed still says how long a cycle is."""
    drive = None if machine.drive is None else Drive(speed=machine.drive.speed)
    return machine.with_entries({"drive": drive})


def on_crankshaft(machine: Machine, *, has_motor: bool = False) -> Machine:
    """The machine without bodies and loads that axes alone move, if a motor drives its crankshaft.

    `has_motor`: also where that motor is still to be chosen.
    """
    if not machine.axes or not (has_motor or (machine.drive and machine.drive.motor)):
        return machine
    own = set(axis_drivers(machine))
    felt = {
        table: {
            name: getattr(machine, table)[name]
            for name, drivers in _moved(machine, table)
            if not drivers or drivers - own
        }
        for table in ("bodies", "loads")
    }
    return machine.with_entries(felt)


def require_separate_axes(machine: Machine) -> None:
    """Raise FindingError if a part is moved by the crankshaft's motor and by an axis together."""
    if not machine.axes or machine.drive is None or machine.drive.motor is None:
        return
    own = axis_drivers(machine)
    for table in ("bodies", "loads"):
        for name, drivers in _moved(machine, table):
            axes, others = drivers & set(own), drivers - set(own)
            if axes and others:
                raise FindingError(
                    f"{table}.{name} is moved by the crankshaft ({', '.join(sorted(others))}) and by the "
                    f"axis {', '.join(own[driver] for driver in sorted(axes))} together: its motion "
                    "under [drive.motor] is not computed; give the crank an axis too, or replace the "
                    "motor by [master] with a constant speed"
                )


def _moved(machine: Machine, table: str) -> Iterator[tuple[str, set[str]]]:
    """Each body or load with the drivers that move it; none for what acts on the crankshaft, or on all."""
    topology = topology_of(machine)
    for name, part in getattr(machine, table).items():
        places = [name] if table == "bodies" and getattr(part, "on", None) is None else _places(part)
        yield name, {driver for place in places for driver in topology.drivers_of(place)}


def _places(part: Any) -> list[str]:
    """Points, links and slides that a body or load names."""
    values = (getattr(part, key, None) for key in _PLACES)
    return [
        place
        for value in values
        if value is not None
        for place in ((value,) if isinstance(value, str) else value)
    ]
