r"""When each cylinder fires: from the angles of throws and banks and the firing order.

A throw at the angle α behind throw 1, counted in the sense of rotation, points along a cylinder at the angle
β from the vertical when the crank angle is :math:`\varphi = \beta - \alpha`, once per revolution. In which of
the revolutions of a cycle a cylinder fires follows from the order: each fires at its first dead centre after
the one before it, and when the first fires again, just one cycle must have passed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

# Angles that differ by less are the same but for rounding of what was typed [rad].
_EQUAL = 1e-6


class CylinderPlace(NamedTuple):
    """Where a cylinder is."""

    # `throw`, `bank`: counted from 0.
    throw: int
    bank: int
    along: float  # crank angle at which its throw points along it, 0 to 2π [rad]


def cylinder_places(
    throws: Sequence[float], banks: Sequence[float], numbering: str = "by_bank"
) -> list[CylinderPlace]:
    """All cylinders in the order of their numbers. `throws`: [rad]; `banks`: [rad]."""
    if numbering == "by_throw":
        pairs = [(t, b) for t in range(len(throws)) for b in range(len(banks))]
    else:
        pairs = [(t, b) for b in range(len(banks)) for t in range(len(throws))]
    return [CylinderPlace(t, b, _turn(banks[b] - throws[t])) for t, b in pairs]


def firing_angles(
    places: Sequence[CylinderPlace], order: Sequence[int], cycle: float
) -> tuple[list[float], float]:
    """Crank angle at which each cylinder fires, as near as its throw points along it.

    Gives `angles`: by number, of the first in the order 0 to 2π [rad]; `found`: after which the first fires
    again; the order fits if it is the cycle [rad]. `cycle`: crank angle of a working cycle [rad].
    """
    along = [places[number - 1].along for number in order]
    steps = [_turn(after - here) for here, after in zip(along, [*along[1:], along[0]], strict=True)]
    # Where two in a row have their dead centres together, the second fires with the first or turns later.
    together = steps.count(0.0)
    turns = round((cycle - sum(steps)) / (2 * math.pi))
    if turns == 1 and together == len(steps):
        # All fire at once, every revolution.
        steps[-1] = 2 * math.pi
    elif together and turns > 0 and turns % together == 0:
        steps = [step or 2 * math.pi * (turns // together) for step in steps]
    angles, now = [0.0] * len(places), along[0]
    for number, step in zip(order, steps, strict=True):
        angles[number - 1] = now
        now += step
    return angles, sum(steps)


def _turn(angle: float) -> float:
    """An angle from 0 up to a revolution; what is a revolution but for rounding is 0."""
    turned = angle % (2 * math.pi)
    return 0.0 if turned < _EQUAL or 2 * math.pi - turned < _EQUAL else turned
