r"""Where the search for a path begins: thousands of shapes and timings, each in its best pose at once.

Shapes and crank angles of the points fill their ranges evenly, by a sequence of low discrepancy. For each of
them scale, pose and coupler point follow from a linear least-squares problem with three complex unknowns,

.. math:: \min_{s, z, t} \sum_i |s A_i + z e^{i\chi_i} + t - w_i|^2

so that a start is judged at the best it can be. Where timing is free, the points are met in their order, in
either direction, over a part of a revolution or all of it.

Source: G. H. Golub, V. Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems
whose variables separate, SIAM J. Numer. Anal. 10 (1973) 413–432; for the sequence: M. Roberts, The
unreasonable effectiveness of quasirandom sequences, 2018.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.synthesis.path_model import Linkages, PathModel
from linkwright.synthesis.turning_shape import Bools, Complexes, free_numbers, pin_and_coupler, shape

Floats = NDArray[np.float64]

# Shapes and timings that are judged for each start that is refined.
TRIALS = 160

# Crank over frame: minimum, and its inverse for a double crank; share of D; S beyond its minimum.
_CRANK = 0.04
_BENT = 0.98
_REST = (0.02, 8.0)

# Minimum part of a revolution over which points are met; how unevenly, as a share of what keeps their order.
_SPAN = 0.1
_UNEVEN = 0.8

# What is broken of the constraints counts so much beside the mean square of the distances: a start may break
# them, as refinement mends that.
_BROKEN = 0.05

# A diagonal so small beside the columns that it changes nothing but keeps equal columns apart.
_APART = 1e-9

# Trials times points that are judged together, so that they fit into some ten megabytes.
_TOGETHER = 100_000


def starts(model: PathModel, count: int) -> Linkages:
    """The best trial of each of so many groups, so that the starts are independent of each other."""
    shares = sequence(count * TRIALS, 4 if model.timed is not None else 8, model.task.seed)
    number = np.arange(count * TRIALS)
    size = max(1, _TOGETHER // (TRIALS * len(model.target)))
    groups = [slice(i * TRIALS, min(i + size, count) * TRIALS) for i in range(0, count, size)]
    found = [_best(model, _trials(model, shares[group], number[group])) for group in groups]
    return Linkages(
        *(
            np.concatenate([getattr(each, name) for each in found])
            for name in ("p", "phi", "is_double", "side")
        )
    )


def sequence(count: int, dimensions: int, seed: int) -> Floats:
    """Points of the unit cube that fill it evenly, shifted at random, (count, dimensions)."""
    golden = 2.0
    # The root of x^{d+1} = x + 1; the iteration contracts by more than a half.
    for _ in range(60):
        golden = (1 + golden) ** (1 / (dimensions + 1))
    steps = golden ** -np.arange(1.0, dimensions + 1)
    shift = np.random.default_rng(seed).random(dimensions)
    return np.asarray((shift + np.outer(np.arange(count), steps)) % 1)


def _trials(model: PathModel, shares: Floats, number: NDArray[np.intp]) -> Linkages:
    """Linkages of the shares, each in its best pose."""
    side = np.where(number % 2 == 0, 1.0, -1.0)
    is_double = _doubles(model.task.linkage, number)
    crank = _CRANK + (1 - 2 * _CRANK) * shares[:, 0]
    low, high = np.log(_REST)
    q = free_numbers(
        np.where(is_double, 1 / crank, crank),
        _BENT * (2 * shares[:, 1] - 1),
        np.exp(low + (high - low) * shares[:, 2]),
        is_double,
    )
    start = 2 * np.pi * shares[:, 3:4]
    way = np.where(number // 2 % 2 == 0, 1.0, -1.0)[:, None]
    phi = start + (model.timed if model.timed is not None else way * _timing(model.target, shares[:, 4:]))
    A, e = pin_and_coupler(shape(q, is_double)[0], side, phi)
    pose = _posed(model.target, A, e)
    p = np.column_stack([q, *(part for each in pose for part in (each.real, each.imag))])
    if model.timed is not None:
        p = np.column_stack([p, start])
    return Linkages(p, phi, is_double, side)


def _doubles(linkage: str, number: NDArray[np.intp]) -> Bools:
    """Which trials are double cranks."""
    if linkage == "any":
        return np.asarray(number // 4 % 2 == 1)
    return np.full(len(number), linkage == "double-crank")


def _timing(target: Complexes, shares: Floats) -> Floats:
    """Crank angles of the points from the first, by the lengths between them, bent, (m, n) [rad]."""
    chords = np.abs(np.diff(target))
    along = np.concatenate([[0.0], np.cumsum(chords)]) / chords.sum()
    closing = float(np.abs(target[-1] - target[0]))
    # Half the trials close the path over a whole revolution, as points all round a curve ask for.
    whole = chords.sum() / (chords.sum() + closing)
    part = np.exp(np.log(_SPAN) * (1 - 2 * shares[:, 0]))
    span = np.where(shares[:, 0] < 0.5, part, whole)
    wave = 2 * np.pi * (along + shares[:, 2:3])
    bend = _UNEVEN * (2 * shares[:, 1:2] - 1) / (2 * np.pi)
    bent: Floats = along + bend * (np.sin(wave) - np.sin(wave[:, :1]))
    angles: Floats = 2 * np.pi * span[:, None] * bent / np.maximum(bent[:, -1:], 1.0)
    return angles


def _posed(target: Complexes, A: Complexes, e: Complexes) -> tuple[Complexes, Complexes, Complexes]:
    """s, z and t of least squares, (m,) each."""
    middle = target.mean()
    a, f = A - A.mean(axis=1, keepdims=True), e - e.mean(axis=1, keepdims=True)
    w = target - middle
    aa, ff = ((np.abs(each) ** 2).sum(axis=1) for each in (a, f))
    af = (np.conj(a) * f).sum(axis=1)
    aw, fw = ((np.conj(each) * w).sum(axis=1) for each in (a, f))
    apart = _APART * (aa + ff)
    aa, ff = aa + apart, ff + apart
    determinant = aa * ff - np.abs(af) ** 2
    s = (ff * aw - af * fw) / determinant
    z = (aa * fw - np.conj(af) * aw) / determinant
    return s, z, middle - s * A.mean(axis=1) - z * e.mean(axis=1)


def _best(model: PathModel, trials: Linkages) -> Linkages:
    """The best of each group of trials."""
    off = (np.abs(model.places(trials) - model.target) ** 2).mean(axis=1)
    broken = np.maximum(model.excess(trials.p, trials.is_double), 0.0)
    judged = (off + _BROKEN * (broken**2).sum(axis=1)).reshape(-1, TRIALS)
    return trials.take(judged.argmin(axis=1) + TRIALS * np.arange(len(judged)))
