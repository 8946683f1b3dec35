"""The longest portion of a path that is straight: that hardly leaves its chord."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.linkages.sweep import Cycle

Places = Callable[[Floats], Floats]

# Portions of the path between which all straight ones are looked for.
_PORTIONS = 90

# Points of a portion when it is examined closely, and halvings when it is found not to be straight.
_CLOSELY = 65
_HALVINGS = 40


def straightest(at: Places, cycle: Cycle, straight: float) -> tuple[float, float, float, float]:
    """The straight portion of a path with the longest chord.

    All portions between every few samples are examined, then those whose ends are moved by less.

    `at`: gives places (n, 2) at crank angles (n,); `straight`: maximum distance from the chord
    over its length. Returns: crank angles at its ends [rad], its chord and the maximum distance from that
    [m].
    """
    n = len(cycle.angles) - 1
    stride = max(1, n // _PORTIONS)
    # Two revolutions of a closed path, so that a portion may pass the first sample.
    place = at(cycle.angles)
    path = np.concatenate([place[:-1], place]) if cycle.repeats else place
    chord, start, end = max(_longest(path, n, stride, straight), _longest(path, 2 * stride, 1, straight))
    if cycle.repeats and start <= stride:
        start, end = start + n, end + n
    before = -1.0
    while chord > before:
        before = chord
        around = range(max(0, start - stride), start + stride + 1), range(end - stride, end + stride + 1)
        for first, last in product(*around):
            fits = 0 < last - first <= n and last < len(path)
            best = _chord(path[first : last + 1]) if fits else (0.0, 0.0)
            if best[0] > chord and best[1] <= straight * best[0]:
                start, end, chord = first, last, best[0]
    low, high = cycle.angles[0] + cycle.span / n * np.array([start, end])
    return _confirmed(at, float(low), float(high), straight)


def _confirmed(at: Places, low: float, high: float, straight: float) -> tuple[float, float, float, float]:
    """The portion examined closely, and shrunk about its middle until it is straight."""
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    good, bad = 0.0, 2.0
    for share in (1.0, *[0.0] * _HALVINGS):
        share = share or 0.5 * (good + bad)
        chord, error = _chord(_between(at, middle - share * half, middle + share * half))
        good, bad = (share, bad) if error <= straight * chord else (good, share)
        if good == 1.0:
            break
    low, high = middle - good * half, middle + good * half
    return low, high, *_chord(_between(at, low, high))


def _between(at: Places, low: float, high: float) -> Floats:
    return at(np.linspace(low, high, _CLOSELY))


Portion = tuple[float, int, int]


def _longest(path: Floats, most: int, stride: int, straight: float) -> Portion:
    """Chord, first and last sample of the longest straight portion of up to ``most`` intervals."""
    best: Portion = (0.0, 0, 1)
    for count in range(stride, min(most, len(path) - 1) + 1, stride):
        starts = np.arange(0, len(path) - count, stride)
        chords, errors = _off_chords(path[starts[:, None] + np.arange(count + 1)])
        fits = np.where(errors <= straight * chords, chords, 0.0)
        at = int(fits.argmax())
        best = max(best, (float(fits[at]), int(starts[at]), int(starts[at]) + count))
    return best


def _chord(part: Floats) -> tuple[float, float]:
    chords, errors = _off_chords(part[None])
    return float(chords[0]), float(errors[0])


def _off_chords(parts: Floats) -> tuple[Floats, Floats]:
    """Chords of portions (k, samples, 2), and the maximum distance from each, or beyond its ends."""
    along = parts[:, -1] - parts[:, 0]
    chords = np.hypot(*along.T)
    unit = along / np.maximum(chords, 1e-300)[:, None]
    x, y = (parts - parts[:, :1]).transpose(2, 0, 1)
    from_start = x * unit[:, :1] + y * unit[:, 1:]
    across = np.abs(y * unit[:, :1] - x * unit[:, 1:])
    beyond = np.maximum(-from_start, from_start - chords[:, None])
    return chords, np.maximum(across, beyond).max(axis=1)
