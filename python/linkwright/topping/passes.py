"""One pass of an edge over many roots, in portions, so that somebody may watch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import FindingError
from linkwright.topping.coverage import COARSE, coverage
from linkwright.topping.edge import Edge, hardly_goes_on
from linkwright.topping.roots import Roots

Floats = NDArray[np.float64]

# Told how much is done, from 0 to 1.
Watch = Callable[[float], None]

# Heads in a portion: some milliseconds, or a second for an edge that runs backwards.
_PORTION = 8192


@dataclass(frozen=True)
class Pass:
    """What an edge does to roots; arrays (n,), a root each.

    Attributes
    ----------
    length_needed : ndarray, shape (n,)
        Minimum length that cuts the head right through [m]; infinite for a root that is missed, zero for one
        that is lost.
    left : ndarray, shape (n,)
        Share of the head that is left [–]: all of one that is missed, nothing of one that is lost. Zero if
        no length was given.
    """

    length_needed: Floats
    left: Floats


def pass_over(
    edges: Sequence[Edge],
    roots: Roots,
    *,
    length: float | None = None,
    fine: int = COARSE,
    watch: Watch | None = None,
) -> Pass:
    """Let an edge go over roots.

    Parameters
    ----------
    edges : sequence of Edge
        The edge; of two directions, the first counts for the half turn about the phase 0, in which a knife
        that turns back goes to the left.
    roots : Roots
        What it meets.
    length : float, optional
        Of the edge [m]; without it, only what is needed is looked at.
    fine : int
        Stations per revolution of the law.
    watch : callable, optional
        Told how much is done, from 0 to 1.

    Returns
    -------
    Pass
        A value for each root.

    Raises
    ------
    FindingError
        The edge runs over heads and back again and again, and hardly goes on.
    """
    require_advance(edges, roots)
    phase = roots.phase(edges[0].knife.rate, edges[0].forward_speed)
    diameter, missed = roots.diameter, roots.is_missed
    needed, left = np.zeros(len(phase)), np.zeros(len(phase))
    done = 0
    for edge, heads in _shared(edges, phase, diameter):
        for start in range(0, len(heads), _PORTION):
            part = heads[start : start + _PORTION]
            found = coverage(edge, diameter[part], roots.offset[part], phase[part], length=length, fine=fine)
            needed[part] = found.length_needed
            left[part] = np.clip(found.uncut / (0.25 * np.pi * diameter[part] ** 2), 0.0, 1.0)
            done += len(part)
            if watch is not None:
                watch(done / len(phase))
    needed[missed] = np.inf
    if length is not None:
        left[missed] = 1.0
    return Pass(needed, left)


def require_advance(edges: Sequence[Edge], roots: Roots) -> None:
    """Refuse an edge that cannot be followed over the largest head farthest from the row.

    Parameters
    ----------
    edges : sequence of Edge
        The edge, or its two directions.
    roots : Roots
        The roots of a field.

    Raises
    ------
    FindingError
        It goes back and forth over that head too often; says how often.
    """
    largest, farthest = float(roots.diameter.max()), float(np.abs(roots.offset).max())
    for edge in edges:
        reason = hardly_goes_on(edge, largest, farthest)
        if reason is not None:
            raise FindingError(reason)


def _shared(edges: Sequence[Edge], phase: Floats, diameter: Floats) -> list[tuple[Edge, NDArray[np.intp]]]:
    """Which heads each direction meets."""
    if len(edges) == 1:
        return [(edges[0], np.flatnonzero(diameter > 0))]
    goes_left = np.cos(phase) >= 0
    sides = (goes_left, ~goes_left)
    return [(edge, np.flatnonzero(side & (diameter > 0))) for edge, side in zip(edges, sides, strict=True)]
