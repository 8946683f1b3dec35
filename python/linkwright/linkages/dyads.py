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

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.machine.program.compiled import FOLDING, Compiled

Floats = NDArray[np.float64]
Channel = tuple[int, int]

POINT, LINK, SLIDE = 0, 1, 2

# Numbers that the core gives for a point, a link and a slide.
_WIDTHS = (6, 4, 3)

# Kinds of rows (`crates/linkwright-core/src/plan.rs`) that are dyads → name, and place of the dyad's index.
_DYADS: dict[int, tuple[str, int]] = {
    2: ("RRP", 4),
    3: ("RRR", 4),
    5: ("RRP", 4),
    6: ("RPR", 3),
    7: ("PRP", 4),
    11: ("RRR", 4),
    12: ("group", 1),
    15: ("RRP", 4),
}
_ROD = 2

# Place of its reach among the numbers of a change point.
_REACH = 4

_GUIDED_RODS = (5, 15)


@dataclass(frozen=True)
class Dyad:
    """One dyad, or a group.

    Attributes
    ----------
    name : str
        Of its element, or of its joint.
    kind : str
        ``"RRR"``, ``"RRP"``, ``"RPR"``, ``"PRP"`` (RPP too) or ``"group"``.
    row : tuple of int
        Kind and entries of its row in the core's program.
    change_points : tuple of float
        Crank angles at which it passes a change point [rad].
    """

    name: str
    kind: Literal["RRR", "RRP", "RPR", "PRP", "group"]
    row: tuple[int, ...]
    change_points: tuple[float, ...] = ()


def dyads_of(compiled: Compiled) -> list[Dyad]:
    """The dyads and groups of a machine in build order."""
    return [_dyad(compiled, row) for row in compiled.rows if row[0] in _DYADS]


def _dyad(compiled: Compiled, row: tuple[int, ...]) -> Dyad:
    kind, at = _DYADS[row[0]]
    passed = _change_points(compiled, row, FOLDING[row[0]]) if row[0] in FOLDING else ()
    return Dyad(compiled.dyads[row[at]], kind, row, passed)  # type: ignore[arg-type]


def _change_points(compiled: Compiled, row: tuple[int, ...], at: int) -> tuple[float, ...]:
    """Crank angles from the cosines and sines in a row with change points."""
    number, slots = row[at], row[at + 1 :]
    width = len(slots) // number
    q = compiled.parameters
    # One that only other machines of a batch have is out of reach.
    present = [k * width for k in range(number) if q[slots[k * width + _REACH]] > 0]
    angles = [np.arctan2(q[slots[k + 1]], q[slots[k]]) for k in present]
    return tuple(sorted(float(angle) % (2 * np.pi) for angle in angles))


def evaluate(compiled: Compiled, channels: list[Channel], angles: Floats) -> list[Floats]:
    """Numbers of points, links and slides of the first machine, (6, 4 or 3, n) each."""
    widths = [_WIDTHS[part] for part, _ in channels]
    out = np.empty((sum(widths), len(angles)))
    compiled.motions(angles, channels, out.reshape(-1))
    return np.split(out, np.cumsum(widths)[:-1]) if channels else []


def transmission_channels(compiled: Compiled, dyad: Dyad) -> list[Channel]:
    """What `transmission` asks of the core."""
    row = dyad.row
    if dyad.kind == "RRR":
        return [(LINK, row[2]), (LINK, row[3])]
    if dyad.kind == "RPR":
        return [(SLIDE, row[2])]
    if row[0] == _ROD:
        return [(LINK, row[2])]
    if row[0] in _GUIDED_RODS:
        return [(LINK, row[2]), *_carrier(compiled, row[7])]
    return [each for link in (row[6], row[11]) for each in _carrier(compiled, link)]


def transmission(compiled: Compiled, dyad: Dyad, found: list[Floats]) -> tuple[Floats, Floats]:
    """Transmission angle, and a smooth function with the sign changes of its derivative, up to the sign.

    Parameters
    ----------
    compiled : Compiled
        The machine.
    dyad : Dyad
        Not a group.
    found : list of ndarray, shapes (4, n) and (3, n)
        What the core gave for `transmission_channels`.

    Returns
    -------
    mu : ndarray, shape (n,)
        0 to π [rad].
    slope : ndarray, shape (n,)
        ±dμ/dφ, for a dyad RPR ±ds/dφ of its slot; NaN at a limit of crank rotation.
    """
    if dyad.kind == "RPR":
        offset = compiled.parameters[dyad.row[6]]
        return np.arctan2(np.abs(found[0][0]), offset), found[0][1] * float(offset != 0)
    (e, e1), (f, f1) = _directions(compiled, dyad, list(found))
    cross, dot = e[0] * f[1] - e[1] * f[0], e[0] * f[0] + e[1] * f[1]
    # At a limit of crank rotation both rates are infinite, and their difference is no number.
    with np.errstate(invalid="ignore"):
        slope = np.broadcast_to(f1 - e1, cross.shape)
    return np.arctan2(np.abs(cross), dot), slope


def _directions(compiled: Compiled, dyad: Dyad, found: list[Floats]) -> list[tuple[Floats, Floats]]:
    """The two directions between which μ lies, with the rates of their angles."""
    row, q = dyad.row, compiled.parameters
    if dyad.kind == "RRR":
        return [(each[:2], each[2]) for each in found]
    if row[0] == _ROD:
        normal = np.array([[-q[row[11]]], [q[row[10]]]])
        return [(found[0][:2], found[0][2]), (normal, np.zeros(1))]
    if row[0] in _GUIDED_RODS:
        rod = found.pop(0)
        along, rate = _guide(compiled, row[7:10], found)
        return [(rod[:2], rod[2]), (np.stack([-along[1], along[0]]), rate)]
    return [_guide(compiled, row[k : k + 3], found) for k in (6, 11)]


def _carrier(compiled: Compiled, link: int) -> list[Channel]:
    """The link that carries a guide; the frame is the link after the last, and at rest."""
    return [] if link == len(compiled.links) else [(LINK, link)]


def _guide(compiled: Compiled, entries: tuple[int, ...], found: list[Floats]) -> tuple[Floats, Floats]:
    """Direction of a guide and the rate of its angle; takes its link from what was found."""
    link, cos, sin = entries[0], *(compiled.parameters[slot] for slot in entries[1:])
    if link == len(compiled.links):
        return np.array([[cos], [sin]]), np.zeros(1)
    carrier = found.pop(0)
    x, y = carrier[:2]
    return np.stack([x * cos - y * sin, x * sin + y * cos]), carrier[2]
