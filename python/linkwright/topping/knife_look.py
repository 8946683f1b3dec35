"""Whether an edge is long enough, seen at few heads: what a check says without following every head."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.machine.machine import Machine
from linkwright.topping.cautions import topper_findings
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge, edges_of, hardly_goes_on
from linkwright.topping.model.topper import Topper
from linkwright.topping.roots import head_diameter
from linkwright.topping.topper import NOTHING, topper

# Heads that are looked at: phases, and offsets with both ends.
_PHASES, _OFFSETS = 24, 3

# Share of a head that is certainly left: far above rounding.
_LEFT = 1e3 * NOTHING


def knife_look(machine: Machine, described: Topper) -> Iterator[str]:
    """What a knife is seen not to do.

    Parameters
    ----------
    machine : Machine
        A machine with a topper.
    described : Topper
        Its topper.

    Yields
    ------
    str
        Sentences. There are some if and only if the study has some: where the few heads do not decide, all
        are followed.
    """
    d = float(head_diameter(described.root_diameter, described.cut_height))
    edges = edges_of(machine, described)
    if not any(hardly_goes_on(edge, d, described.offset) for edge in edges):
        looks = [_look(described, edge, d) for edge in edges]
        needed, left = max(looks)[0], max(look[1] for look in looks)
        if left > _LEFT and np.isfinite(needed):
            yield (
                f"The edge of {described.edge_length:.6g} m does not cut through every head: some need "
                f"{needed:.4g} m or more; `linkwright run` tells the length that all need."
            )
            return
        if all(needed + room < described.edge_length for needed, _, room in looks):
            return
    yield from topper_findings(described, topper(machine, charts=False))


def _look(described: Topper, edge: Edge, d: float) -> tuple[float, float, float]:
    """Length needed at most [m], the share left there, and what heads in between may need more [m]."""
    knife = edge.knife
    given = described.motion.phase
    n = _PHASES if knife.rate and given is None else 1
    phases = np.linspace(0.0, 2 * np.pi, n, endpoint=False) if given is None else np.array([given])
    offsets = np.linspace(-described.offset, described.offset, _OFFSETS if described.offset else 1)
    phi, delta = (each.ravel() for each in np.meshgrid(phases, offsets))
    needed = coverage(edge, d, delta, phi).length_needed
    worst = slice(k := int(np.argmax(needed)), k + 1)
    there = coverage(edge, d, delta[worst], phi[worst], length=described.edge_length)
    left = float(there.uncut[0] / (0.25 * np.pi * d**2))
    moved = knife.speed_max / knife.rate * np.pi / n if n > 1 else 0.0
    beside = described.offset / (_OFFSETS - 1) if described.offset else 0.0
    return float(needed[k]), left, 2 * (moved + beside) * _along(edge)


def _along(edge: Edge) -> float:
    """Farthest that the place of a cut moves along the edge when the knife is moved by one across the row."""
    if edge.retreats:
        return np.inf
    # The point lies farther along by cos α, and is met later or earlier by sin α over the advance.
    along = edge.forward_speed * abs(np.sin(edge.angle)) + edge.knife.speed_max * np.cos(edge.angle)
    return float(np.cos(edge.angle) + abs(np.sin(edge.angle)) * along / edge.least_advance)
