r"""The edge of a topper: a straight segment that moves parallel to itself, with the knife across the row and
with the machine along it.

Seen from the centre of a head, δ to the left of the row, the middle of the edge is at

.. math:: q = v t \sin\alpha + (y - \delta)\cos\alpha, \qquad p = v t \cos\alpha - (y - \delta)\sin\alpha

along the edge and normal to it, with the velocities

.. math:: u_t = v \sin\alpha + \dot y\cos\alpha, \qquad u_n = v \cos\alpha - \dot y\sin\alpha .

It retreats where :math:`u_n \le 0`.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics.extreme import greatest
from linkwright.kernel.numerics.tangent import plain
from linkwright.machine.machine import Machine
from linkwright.topping.core import KnifeKernel
from linkwright.topping.knife import Knife, knives
from linkwright.topping.model.topper import Topper
from linkwright.topping.required_length import ALONG_ITSELF

# Revolutions of the law over a head that are followed: for an edge that retreats the work grows with their
# square, for any other the core runs out of stations.
_TURNS, _TURNS_RETREATING = 60, 8


@dataclass(frozen=True)
class Edge:
    """An edge that goes over heads; its numbers may have derivatives.

    Attributes
    ----------
    knife : Knife
        How it goes across the row.
    angle : float
        α [rad], |α| < π/2.
    forward_speed : float
        v > 0 [m/s].
    """

    knife: Knife
    angle: float
    forward_speed: float

    @cached_property
    def kernel(self) -> KnifeKernel:
        """The edge in the core's terms."""
        return KnifeKernel(self.knife.way, self.angle, self.forward_speed)

    def place(self, time: Any, phase: Any = 0.0, offset: Any = 0.0) -> tuple[Any, Any]:
        """Middle of the edge, seen from the centre of a head: along it, to its left, and normal to it, ahead
        [m], (...).

        `time` from when it is abreast of the centre [s], `phase` of the knife then [rad], `offset` of the
        centre to the left of the row [m]; they broadcast.
        """
        ahead, aside = self.forward_speed * time, self.knife.at(time, phase) - offset
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        return ahead * sin + aside * cos, ahead * cos - aside * sin

    def velocity(self, time: Any, phase: Any = 0.0) -> tuple[Any, Any]:
        """Velocity along the edge, to its left, and normal, ahead [m/s], (...); `time` [s], `phase` [rad]."""
        v, across = self.forward_speed, self.knife.at(time, phase, 1)
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        return v * sin + across * cos, v * cos - across * sin

    @property
    def mean_advance(self) -> Any:
        """Mean speed of the edge along its normal [m/s]; negative for one that runs backwards."""
        return plain(self.forward_speed * np.cos(self.angle) - self.knife.drift * np.sin(self.angle))

    @property
    def least_advance(self) -> Any:
        """Minimum speed of the edge along its normal [m/s]; zero or less where it retreats."""
        worst = greatest(*(speed * np.sin(self.angle) for speed in self.knife.speeds))
        return plain(self.forward_speed * np.cos(self.angle) - worst)

    @property
    def retreats(self) -> bool:
        """Whether it runs backwards at times."""
        return bool(self.least_advance <= 0)

    @property
    def stands(self) -> bool:
        """Whether it moves along itself indefinitely, and cuts nothing."""
        speed = np.hypot(self.forward_speed, self.knife.drift)
        return bool(abs(self.mean_advance) <= ALONG_ITSELF * speed)

    @property
    def leans(self) -> tuple[Any, Any]:
        """Angle α + β of the path to the edge's normal, at minimum and maximum speed of the knife [rad]."""
        low, high = (self.angle + np.arctan2(w, self.forward_speed) for w in self.knife.speeds)
        return low, high

    def half_pass(self, diameter: float, offset: float) -> float:
        """Time from abreast of a head, up to the offset from the row, until it is surely passed [s]."""
        swing = (0.5 * self.knife.stroke + offset) * abs(np.sin(self.angle))
        return float((0.5 * diameter + swing) / abs(self.mean_advance))

    def turns(self, diameter: float, offset: float) -> float:
        """Revolutions of the law while the edge may be over a head up to the offset from the row."""
        return 2 * self.knife.frequency * self.half_pass(diameter, offset) if self.knife.rate else 0.0


def require_topper(machine: Machine) -> Topper:
    """The topper of a machine."""
    if machine.topper is None:
        raise InputError(f"{machine.name} has no [topper]: describe one, as `linkwright new topper` does")
    return machine.topper


def edges_of(machine: Machine, described: Topper) -> list[Edge]:
    """The edge of a topper; in both directions if its knife does not turn back over a head.

    Raises `AssemblyError` if the mechanism of the knife does not close all round, `FindingError` if the
    member that is the knife does not come back with each revolution.
    """
    ways = knives(machine, described)
    return [Edge(way, described.edge_angle, described.forward_speed) for way in ways]


def barely_advances(edge: Edge, diameter: float, offset: float) -> str | None:
    """Why an edge cannot be followed: its knife crosses a head again and again; d and Δ [m]."""
    turns, most = edge.turns(diameter, offset), _TURNS_RETREATING if edge.retreats else _TURNS
    if turns <= most:
        return None
    way = "Reduce the edge angle" if edge.retreats else "Use a longer stroke"
    return (
        f"The blade barely advances: the knife makes {turns:.3g} double strokes while it is over one head, "
        f"and is followed for {most}; what it cuts is not computed. {way}, or reduce the knife speed."
    )
