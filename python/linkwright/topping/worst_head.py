"""The worst of the heads that a knife may meet: over offsets on both sides of the row and over phases."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.topping.edge import Edge

Floats = NDArray[np.float64]

# What is looked at: of an edge, for offsets [m] and phases [rad] of heads, (n,).
Measure = Callable[[Edge, Floats, Floats], Floats]

# First look at the worst head: phases, and offsets.
_PHASES, _OFFSETS = 360, 5

# Then the look narrows: places to either side of the best, rounds, and by how much in each.
_BESIDE, _ROUNDS, _NARROWER = 4, 20, 0.25

# Of edges that retreat, which take some thousand times as long, so many times fewer heads are looked at, and
# places are narrowed to 1e-6.
SPARING = 4


@dataclass(frozen=True)
class Worst:
    """The worst of many heads.

    Attributes
    ----------
    value : float
        The maximum, found there.
    phase, offset : float
        Of that head [rad, m].
    edge : Edge
        The edge, of one or two directions.
    """

    value: float
    phase: float
    offset: float
    edge: Edge


def worst_head(
    edges: Sequence[Edge],
    offset: float,
    phase: float | None,
    measure: Measure,
) -> Worst:
    """The head at which a measure has its maximum, over offsets up to Δ on both sides and over all phases.

    Parameters
    ----------
    edges : sequence of Edge
        One edge, or its two directions.
    offset : float
        Δ [m].
    phase : float or None
        The only phase [rad]; None for all.
    measure : callable
        Edge, offsets and phases (n,) → what is looked at, (n,).

    Returns
    -------
    Worst
        Value and place.

    Notes
    -----
    A look at many heads, then a look about the best of them that narrows fourfold each round: tops may be
    smooth or edges.
    """
    found = [_worst(edge, offset, phase, measure) for edge in edges]
    return max(found, key=lambda each: each.value)


def _worst(edge: Edge, offset: float, phase: float | None, measure: Measure) -> Worst:
    """The worst head of one direction."""
    n, rounds = (_PHASES // SPARING, _ROUNDS // 2) if edge.retreats else (_PHASES, _ROUNDS)
    every: Floats = np.linspace(0.0, 2 * np.pi, n if edge.knife.rate else 1, endpoint=False)
    phases = every if phase is None else np.array([phase], dtype=np.float64)
    offsets: Floats = np.asarray(np.linspace(-offset, offset, _OFFSETS if offset else 1))
    wide = [np.pi / n if len(phases) > 1 else 0.0, offset / (_OFFSETS - 1)]
    best = _best(edge, phases, offsets, measure)
    for _ in range(rounds):
        share = np.arange(-_BESIDE, _BESIDE + 1) / _BESIDE
        phases = best.phase + 2 * wide[0] * share if wide[0] else np.array([best.phase])
        offsets = np.clip(best.offset + 2 * wide[1] * share, -offset, offset) if wide[1] else np.zeros(1)
        best = max(best, _best(edge, phases, offsets, measure), key=lambda each: each.value)
        wide = [_NARROWER * each for each in wide]
    return Worst(best.value, float(np.mod(best.phase, 2 * np.pi)), best.offset, edge)


def _best(edge: Edge, phases: Floats, offsets: Floats, measure: Measure) -> Worst:
    """The maximum of a grid."""
    phi, delta = (each.ravel() for each in np.meshgrid(phases, offsets, indexing="ij"))
    values = measure(edge, delta, phi)
    at = int(np.argmax(values))
    return Worst(float(values[at]), float(phi[at]), float(delta[at]), edge)
