"""One edge over all heads that it may meet: offsets on both sides of the row, phases, and the worst head."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.topping.coverage import coverage
from linkwright.topping.edge import Edge
from linkwright.topping.model.topper import Topper

# What is examined: of an edge, for offsets [m] and phases [rad] of heads, (n,).
Measure = Callable[[Edge, Floats, Floats], Floats]

# First look at the worst head: phases, and offsets.
_PHASES, _OFFSETS = 360, 5

# Then the look narrows: places to either side of the best, rounds, and by how much in each.
_BESIDE, _ROUNDS, _NARROWER = 4, 20, 0.25

# Of edges that retreat, which take some thousand times as long, so many times fewer heads are examined, and
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
    """The head at which a measure has its maximum, over offsets up to Δ [m] on both sides and over all
    phases.

    `phase`: the only one [rad], None for all; `measure`: edge, offsets and phases (n,) → what is examined,
    (n,). A look at many heads, then a look about the best of them that narrows fourfold each round: tops may
    be smooth or edges.
    """
    heads = [_worst(edge, offset, phase, measure) for edge in edges]
    return max(heads, key=lambda head: head.value)


def _worst(edge: Edge, offset: float, phase: float | None, measure: Measure) -> Worst:
    phases, offsets, wide = _grid(edge, offset, phase)
    return _narrowed(_best(edge, phases, offsets, measure, _SAME), wide, offset, measure)


def _grid(edge: Edge, offset: float, phase: float | None) -> tuple[Floats, Floats, list[float]]:
    """Phases and offsets of the first look, and half their distances."""
    n = _PHASES // SPARING if edge.retreats else _PHASES
    every: Floats = np.linspace(0.0, 2 * np.pi, n if edge.knife.rate else 1, endpoint=False)
    phases = every if phase is None else np.array([phase], dtype=np.float64)
    offsets: Floats = np.asarray(np.linspace(-offset, offset, _OFFSETS if offset else 1))
    return phases, offsets, [np.pi / n if len(phases) > 1 else 0.0, offset / (_OFFSETS - 1)]


def _narrowed(best: Worst, wide: list[float], offset: float, measure: Measure) -> Worst:
    edge = best.edge
    for _ in range(_ROUNDS // 2 if edge.retreats else _ROUNDS):
        share = np.arange(-_BESIDE, _BESIDE + 1) / _BESIDE
        phases = best.phase + 2 * wide[0] * share if wide[0] else np.array([best.phase])
        offsets = np.clip(best.offset + 2 * wide[1] * share, -offset, offset) if wide[1] else np.zeros(1)
        best = max(best, _best(edge, phases, offsets, measure), key=lambda place: place.value)
        wide = [_NARROWER * place for place in wide]
    return Worst(best.value, float(np.mod(best.phase, 2 * np.pi)), best.offset, edge)


# Share by which tops of the first look may be lower than the worst head.
_NEAR = 0.02


def heads_as_bad(
    edges: Sequence[Edge], offset: float, phase: float | None, measure: Measure, worst: float
) -> list[Worst]:
    """Heads at which a measure is at its maximum `worst`, each once; arguments as of `worst_head`."""
    heads: list[Worst] = []
    for edge in edges:
        phases, offsets, wide = _grid(edge, offset, phase)
        phi, delta = np.meshgrid(phases, offsets, indexing="ij")
        values = measure(edge, delta.ravel(), phi.ravel()).reshape(phi.shape)
        beside = [np.roll(values, way, axis=0) for way in (-1, 1)]
        beside += [
            np.pad(values, ((0, 0), (1, 1)), constant_values=-np.inf)[:, at:][:, : phi.shape[1]]
            for at in (0, 2)
        ]
        tops = np.logical_and.reduce([values >= side for side in beside]) & (values >= worst * (1 - _NEAR))
        for i, k in zip(*np.nonzero(tops), strict=True):
            first = Worst(float(values[i, k]), float(phases[i]), float(offsets[k]), edge)
            top = _narrowed(first, wide, offset, measure)
            if top.value >= worst * (1 - _SAME) and all(_are_apart(top, other, wide) for other in heads):
                heads.append(top)
    return heads


def _are_apart(one: Worst, other: Worst, wide: list[float]) -> bool:
    phase = abs((one.phase - other.phase + np.pi) % (2 * np.pi) - np.pi)
    return one.edge is not other.edge or phase > wide[0] or abs(one.offset - other.offset) > wide[1]


# Share by which values that are the same may differ: areas are good to 1e-12 of a head.
_SAME = 1e-9


def _best(edge: Edge, phases: Floats, offsets: Floats, measure: Measure, same: float = 0.0) -> Worst:
    """The maximum of a grid; of values that differ by less than a share the first."""
    phi, delta = (values.ravel() for values in np.meshgrid(phases, offsets, indexing="ij"))
    values = measure(edge, delta, phi)
    most = values.max()
    # Half a revolution later the mirror image of a head asks the same, within rounding: the first of them.
    at = int(np.argmax(values if np.isnan(most) else values >= most * (1 - same)))
    return Worst(float(values[at]), float(phi[at]), float(delta[at]), edge)


# Phases of the curves, and offsets at which the worst is looked for.
_CURVE_PHASES, CURVE_OFFSETS = 180, 9

# Phases and offsets of the mean, amid even steps so that all count alike: it is good to three digits, of an
# edge that retreats to two.
_MEAN_PHASES, _MEAN_OFFSETS = 90, 41


def every_head(described: Topper, edges: list[Edge], d: float, *, charts: bool = True) -> dict[str, Any]:
    """What heads need, and what is left of them. ``d``: diameter of the heads [m]."""
    heads = unknown_heads() | _needed(described, edges, d)
    if charts or heads["length_exact"] > described.edge_length:
        heads |= _left(described, edges, d)
    return heads | _by_phase(described, edges, d) if charts else heads


def unknown_heads() -> dict[str, Any]:
    """The same entries for an edge that cannot be followed: NaN."""
    scalars = ("length_exact", "worst_phase", "worst_offset", "last_x", "last_y", "length_best_phase")
    left = ("uncut_share", "uncut_phase", "uncut_offset", "uncut_right", "uncut_left", "uncut_between")
    nothing = np.full(_CURVE_PHASES + 1, np.nan)
    curves = {"length_by_phase": nothing, "uncut_by_phase": nothing}
    numbers = dict.fromkeys((*scalars, *left, "best_phase", "uncut_share_mean"), float("nan"))
    return {"phase": np.linspace(0.0, 2 * np.pi, _CURVE_PHASES + 1)} | curves | numbers


def _needed(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    phase = described.motion.phase

    def needs(edge: Edge, offset: Floats, angle: Floats) -> Floats:
        return coverage(edge, d, offset, angle).length_needed

    worst = worst_head(edges, described.offset, phase, needs)
    there = coverage(worst.edge, d, worst.offset, worst.phase)
    return {
        "length_exact": worst.value,
        "worst_phase": worst.phase,
        "worst_offset": worst.offset,
        "last_x": float(there.last_x[0]),
        "last_y": float(there.last_y[0]),
    }


def _left(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    area, length = 0.25 * np.pi * d**2, described.edge_length

    def left(edge: Edge, offset: Floats, angle: Floats) -> Floats:
        return coverage(edge, d, offset, angle, length=length).uncut / area

    worst = worst_head(edges, described.offset, described.motion.phase, left)
    there = coverage(worst.edge, d, worst.offset, worst.phase, length=length)
    return {
        # All of it, within rounding.
        "uncut_share": min(worst.value, 1.0),
        "uncut_phase": worst.phase,
        "uncut_offset": worst.offset,
        "uncut_right": float(there.uncut_right[0] / area),
        "uncut_left": float(there.uncut_left[0] / area),
        "uncut_between": float(there.uncut_between[0] / area),
    }


def _by_phase(described: Topper, edges: list[Edge], d: float) -> dict[str, Any]:
    """What each phase needs and leaves at its worst offset, the best phase, and the mean of what is left."""
    phases = np.linspace(0.0, 2 * np.pi, _CURVE_PHASES + 1)
    n_offsets = CURVE_OFFSETS // SPARING + 1 if any(edge.retreats for edge in edges) else CURVE_OFFSETS
    offsets = np.linspace(-described.offset, described.offset, n_offsets if described.offset else 1)
    phi, delta = np.meshgrid(phases, offsets, indexing="ij")
    length = described.edge_length
    cuts = [coverage(edge, d, delta.ravel(), phi.ravel(), length=length) for edge in edges]
    needed = np.stack([cut.length_needed.reshape(phi.shape) for cut in cuts])
    left = np.stack([cut.uncut.reshape(phi.shape) for cut in cuts]) / (0.25 * np.pi * d**2)
    by_phase = needed.max(axis=(0, 2))
    best = int(np.argmin(by_phase))
    return {
        "phase": phases,
        "length_by_phase": by_phase,
        "uncut_by_phase": left.max(axis=(0, 2)),
        "length_best_phase": float(by_phase[best]),
        "best_phase": float(phases[best]),
        "uncut_share_mean": _mean_left(described, edges, d),
    }


def _mean_left(described: Topper, edges: list[Edge], d: float) -> float:
    shares, phases = mean_heads(described, edges)
    delta, length = shares * described.offset, described.edge_length
    left = [coverage(edge, d, delta, phases, length=length).uncut for edge in edges]
    return float(np.mean(left) / (0.25 * np.pi * d**2))


def mean_heads(described: Topper, edges: Sequence[Edge]) -> tuple[Floats, Floats]:
    """Heads that a mean is over, (n,) each: shares of the largest offset; phases, if none is given [rad]."""
    offset, phase = described.offset, described.motion.phase
    sparing = SPARING if any(edge.retreats for edge in edges) else 1
    shares = _amid(_MEAN_OFFSETS // sparing) if offset else np.zeros(1)
    moves = phase is None and any(edge.knife.rate for edge in edges)
    phases = np.pi * (1 + _amid(_MEAN_PHASES // sparing)) if moves else np.array([phase or 0.0])
    phi, share = (values.ravel() for values in np.meshgrid(phases, shares))
    return share, phi


def _amid(n: int) -> Floats:
    """Middles of even steps from −1 to 1, (n,)."""
    return np.asarray((2 * np.arange(n) + 1) / n - 1, dtype=np.float64)
