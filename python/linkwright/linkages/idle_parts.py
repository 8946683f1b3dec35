"""Parts of a mechanism that its drivers do not move: joints, sliders, bars, although W = 1.

The count of links and pairs holds for the mechanism as a whole: a driver without a load and a structure
without a driver have one freedom together (Norton, *Design of Machinery*, section 2.5: paradoxes of the
formula).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.linkages.closure import turn_angles
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Crank angles that are examined, a prime number, and rates that are rounding, as a share of the largest.
_LOOKS = 97
_STILL = 1e-9


def idle_parts(machine: Machine) -> Iterator[str]:
    """A sentence that names what no driver moves; none where all moves, or nothing closes."""
    compiled = compile_machine(machine).first()
    phi = turn_angles(_LOOKS, compiled.turns)
    rates = {
        name: float(np.nanmax(np.abs(compiled.point_motion(index, phi).d1), initial=0.0))
        for name, index in compiled.points.items()
    }
    size = max(rates.values(), default=0.0)
    if not size > 0:
        return
    still = {name for name, rate in rates.items() if rate <= _STILL * size}
    mechanism = machine.linkage
    parts = {
        "joint": [name for name in mechanism.joints if name in still],
        "slider": [name for name in mechanism.sliders if name in still],
        "rocker": [name for name in mechanism.rockers if name in still],
        "bar": [name for name, bar in mechanism.bars.items() if {bar.start, bar.end} <= still],
    }
    listed = [
        f"{kind if len(names) == 1 else kind + 's'} {', '.join(names)}"
        for kind, names in parts.items()
        if names
    ]
    if listed:
        yield (
            f"{' and '.join(listed)} never move over the cycle, since nothing connects them with a driver: "
            f"{_cylinder(machine, parts['bar'])}correct the points that they are attached to, or leave them "
            "out"
        )


def _cylinder(machine: Machine, idle: list[str]) -> str:
    """The cylinder that a linear driver on the guide of an idle bar stands for; empty where there is none."""
    mechanism = machine.linkage
    for name, driver in mechanism.linear_drivers.items():
        for bar in (mechanism.bars[bar] for bar in idle if bar == driver.guide.on):
            return (
                f"to move them, replace {name} and its bar by a cylinder between {bar.start} and {bar.end}, "
                f"[mechanism.cylinders.{name}]; else "
            )
    return ""
