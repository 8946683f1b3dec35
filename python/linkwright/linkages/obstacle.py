"""Why an element does not close, in words, and what to change: a sentence for each kind of dyad and group."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine
from linkwright.machine.program.core import Channel
from linkwright.machine.program.places import length_name

# What is wrong, and the remedy.
Words = tuple[str, str]


def describe(element: str, machine: Machine) -> Words:
    """Why an element does not close, and the remedy.

    `element`: name of a dyad, or the joints of a group joined by "and", as in `Closure.element`. Returns:
    what cannot meet, with its lengths, and what to change.
    """
    mechanism = machine.linkage
    makers = {
        "sliders": _slider,
        "rockers": _rocker,
        "slotted_levers": _slotted_lever,
        "crossings": _crossing,
        "yokes": _crossing,
        "joints": _joint,
    }
    for table, make in makers.items():
        if element in getattr(mechanism, table):
            return make(element, mechanism)
    return _group(element, mechanism)


# Crank angles in each range, and over the cycle, at which lengths of cylinders are compared.
_LOOKS = 721


def missing_length(element: str, machine: Machine, ranges: Sequence[tuple[float, float]], turns: int) -> str:
    """How far a cylinder that moves a group would go beyond what it reaches, and where; empty without one.

    `element`: the joints of the group; `ranges`: crank angles in which it closes [rad].
    """
    compiled, worst = compile_machine(machine), (0.0, "")
    for name in _cylinders_at(tuple(element.split(" and ")), machine.linkage):
        length = Channel.Slide(compiled.slides[length_name(name)])
        phi = np.linspace(0.0, 2 * np.pi * turns, _LOOKS * turns)
        reached = np.concatenate([np.linspace(low, high, _LOOKS) for low, high in ranges])
        wanted, known = (compiled.motion([length], angles)[0][0] for angles in (phi, reached))
        beyond = np.maximum(wanted - known.max(), known.min() - wanted)
        at = int(beyond.argmax())
        end = known.max() if wanted[at] > known.max() else known.min()
        text = (
            f"the cylinder {name} reaches {end:.4g} m of {wanted[at]:.4g} m at a crank angle of "
            f"{np.degrees(phi[at]):.4g}°: {1e3 * beyond[at]:.4g} mm are missing"
        )
        worst = max(worst, (float(beyond[at]), text))
    return worst[1]


def change_point(element: str, machine: Machine) -> Words:
    """Why the speeds of an element are not determined where it closes with nothing to spare, and the remedy.

    `element`: name of a dyad or a group, as in `Closure.element`. Returns: what happens there, and what to
    change.
    """
    if element in machine.linkage.slotted_levers:
        what = "its pin passes through its pivot, where the direction of the lever is undefined"
        return what, "move the pivot, or give the slot an offset"
    what = "its links are in line there and the speeds are indeterminate"
    if " and " in element:
        what = "two motions are possible there and the speeds are indeterminate"
    return what, "change a length slightly"


def _slider(name: str, mechanism: Mechanism) -> Words:
    rod = mechanism.sliders[name].rod
    return f"the rod of {name} ({rod:g} m) does not reach its guide", "lengthen the rod or shorten the crank"


def _rocker(name: str, mechanism: Mechanism) -> Words:
    rocker = mechanism.rockers[name]
    lengths = f"{rocker.coupler:g} m and {rocker.rocker:g} m"
    remedy = "shorten the crank, or change coupler and rocker until the crank can turn fully (Grashof)"
    return f"coupler and rocker of {name} ({lengths}) cannot meet", remedy


def _slotted_lever(name: str, mechanism: Mechanism) -> Words:
    lever = mechanism.slotted_levers[name]
    what = f"the pin of {name} comes closer to its pivot than the offset of the slot ({lever.offset:g} m)"
    return what, "reduce the offset of the slot, or move the pivot away from the pin"


def _crossing(name: str, mechanism: Mechanism) -> Words:
    return f"the two guides of {name} are parallel", "turn one of them"


def _joint(name: str, mechanism: Mechanism) -> Words:
    bars = _bars_at((name,), mechanism)
    on_guide = " and its guide" if mechanism.joints[name].guide is not None else ""
    return f"{bars}{on_guide} cannot meet in the joint {name}", "change their lengths, or shorten the crank"


def _group(element: str, mechanism: Mechanism) -> Words:
    joints = tuple(element.split(" and "))
    what = f"{_bars_at(joints, mechanism)} cannot all meet in the joints {element}"
    return what, "change their lengths, or shorten the crank"


def _bars_at(joints: tuple[str, ...], mechanism: Mechanism) -> str:
    carried = {
        name for name, part in mechanism.rigid_points.items() if _hangs_on(part.link, joints, mechanism)
    }
    ends = {*joints, *carried}
    bars = [
        f"{name} ({bar.length:g} m)"
        for name, bar in mechanism.bars.items()
        if {bar.start, bar.end} & ends and not bar.redundant
    ]
    bars += _cylinders_at(joints, mechanism)
    return " and ".join(filter(None, [", ".join(bars[:-1]), *bars[-1:]]))


def _cylinders_at(joints: tuple[str, ...], mechanism: Mechanism) -> Iterator[str]:
    """Cylinders that drive joints, or points on bars that end in them."""
    for name, cylinder in mechanism.cylinders.items():
        for end in (cylinder.start, cylinder.end):
            part = mechanism.rigid_points.get(end)
            if cylinder.drives and (
                end in joints or (part is not None and _hangs_on(part.link, joints, mechanism))
            ):
                yield name
                break


def _hangs_on(link: str, joints: tuple[str, ...], mechanism: Mechanism) -> bool:
    bar = mechanism.bars.get(link)
    return bar is not None and bool({bar.start, bar.end} & set(joints))
