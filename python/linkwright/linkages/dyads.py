r"""Dyads as the core has them, and the angle at which each passes on its force.

The transmission angle μ of a dyad is the angle between the driving force and the direction without motion
(Volmer, *Getriebetechnik*; Norton, *Design of Machinery*, section on transmission angle): 90° is best, at 0°
and 180° nothing is passed on.

| dyad | μ is the angle between |
| --- | --- |
| RRR | coupler and rocker, at their joint |
| RRP | rod and the normal of the guide |
| RPR | slot and the line from the pivot to the pin, less a right angle |
| PRP, RPP | the two guides |

A group has no single angle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.machine.program.compiled import CompiledMachine
from linkwright.machine.program.core import Channel, Element, Line
from linkwright.machine.program.motion import LinkRows, Rows, SlideRows

# What closes, and the dyad that it is.
Closing = (
    Element.SliderRod
    | Element.Rocker
    | Element.GuidedRod
    | Element.SlottedLever
    | Element.Crossing
    | Element.Group
)
_KINDS: dict[type[Element], Literal["RRR", "RRP", "RPR", "PRP", "group"]] = {
    Element.SliderRod: "RRP",
    Element.Rocker: "RRR",
    Element.GuidedRod: "RRP",
    Element.SlottedLever: "RPR",
    Element.Crossing: "PRP",
    Element.Group: "group",
}


@dataclass(frozen=True)
class Dyad:
    """One dyad, or a group."""

    name: str  # of its element, or of its joint
    # `"RRR"`, `"RRP"`, `"RPR"`, `"PRP"` (RPP too) or `"group"`.
    kind: Literal["RRR", "RRP", "RPR", "PRP", "group"]
    element: Closing  # what it is in the core's program
    change_points: tuple[float, ...] = ()  # crank angles at which it passes a change point [rad]


def dyads_of(compiled: CompiledMachine) -> list[Dyad]:
    """The dyads and groups of a machine in build order."""
    # Barrel and rod of a cylinder are in line, however they lie.
    rods = [name for name in compiled.dyads if name.endswith(".rod")]
    in_line = {*rods, *(name.removesuffix(".rod") for name in rods)}
    closing = (element for element in compiled.elements if isinstance(element, Closing))
    return [_dyad(compiled, part) for part in closing if compiled.dyads[part.dyad] not in in_line]


def _dyad(compiled: CompiledMachine, element: Closing) -> Dyad:
    name, kind = compiled.dyads[element.dyad], _KINDS[type(element)]
    return Dyad(name, kind, element, _change_points(compiled, element))


def _change_points(compiled: CompiledMachine, element: Closing) -> tuple[float, ...]:
    if not isinstance(element, Element.Rocker | Element.GuidedRod):
        return ()
    q = compiled.parameters
    # One that only other machines of a batch have is out of reach.
    angles = [np.arctan2(q[at.sin], q[at.cos]) for at in element.change_points if q[at.reach] > 0]
    return tuple(sorted(float(angle) % (2 * np.pi) for angle in angles))


def transmission_channels(compiled: CompiledMachine, dyad: Dyad) -> list[Channel]:
    """What `transmission` asks of the core."""
    match dyad.element:
        case Element.Rocker() as rocker:
            return [Channel.Link(rocker.coupler_link), Channel.Link(rocker.rocker_link)]
        case Element.SlottedLever(slide=slide):
            return [Channel.Slide(slide)]
        case Element.SliderRod(link=link):
            return [Channel.Link(link)]
        case Element.GuidedRod(link=link, line=line):
            return [Channel.Link(link), *_carrier(line)]
        case Element.Crossing(lines=lines):
            return [channel for line in lines for channel in _carrier(line)]
    return []


def transmission(q: Floats, dyad: Dyad, values: Sequence[Rows]) -> Floats:
    """Transmission angle, 0 to π, (n,) [rad]; `values`: motion of `transmission_channels`."""
    if isinstance(dyad.element, Element.SlottedLever):
        (slot,), offset = values, q[dyad.element.offset]
        assert isinstance(slot, SlideRows)
        swing: Floats = np.arctan2(np.abs(slot.position), offset)
        return swing
    (e, _), (f, _) = _directions(q, dyad, values)
    cross, dot = e[0] * f[1] - e[1] * f[0], e[0] * f[0] + e[1] * f[1]
    between: Floats = np.arctan2(np.abs(cross), dot)
    return between


def transmission_slope(q: Floats, dyad: Dyad, values: Sequence[Rows]) -> Floats:
    """A smooth function with the sign changes of the derivative of the transmission angle, up to the sign.

    ±dμ/dφ, for a dyad RPR ±ds/dφ of its slot, (n,) or (1,); NaN at a limit of crank rotation. It is linear in
    the rates of the motion.
    """
    if isinstance(dyad.element, Element.SlottedLever):
        (slot,), offset = values, q[dyad.element.offset]
        assert isinstance(slot, SlideRows)
        return slot.d1 * float(offset != 0)
    (_, e1), (_, f1) = _directions(q, dyad, values)
    # At a limit of crank rotation both rates are infinite, and their difference is no number.
    with np.errstate(invalid="ignore"):
        return f1 - e1


def _directions(q: Floats, dyad: Dyad, values: Sequence[Rows]) -> list[tuple[Floats, Floats]]:
    """The two directions between which μ lies, with the rates of their angles."""
    links = [link for link in values if isinstance(link, LinkRows)]
    match dyad.element:
        case Element.SliderRod(cos=cos, sin=sin):
            return [(links[0].direction, links[0].d1), (np.stack([-q[sin], q[cos]])[:, None], np.zeros(1))]
        case Element.GuidedRod(line=line):
            rod = links.pop(0)
            along, rate = _guide(q, line, links)
            return [(rod.direction, rod.d1), (np.stack([-along[1], along[0]]), rate)]
        case Element.Crossing(lines=lines):
            return [_guide(q, line, links) for line in lines]
    return [(link.direction, link.d1) for link in links]


def _carrier(line: Line) -> list[Channel]:
    return [] if line.link is None else [Channel.Link(line.link)]


def _guide(q: Floats, line: Line, links: list[LinkRows]) -> tuple[Floats, Floats]:
    """Direction of a guide and the rate of its angle; takes its link from what was found."""
    cos, sin = q[line.cos], q[line.sin]
    if line.link is None:
        return np.stack([cos, sin])[:, None], np.zeros(1)
    carrier = links.pop(0)
    x, y = carrier.direction
    return np.stack([x * cos - y * sin, x * sin + y * cos]), carrier.d1
