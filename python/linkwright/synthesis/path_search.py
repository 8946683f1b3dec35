r"""Search for a path: where it begins, and its refinement by Levenberg and Marquardt.

Shapes and crank angles of the points fill their ranges evenly, by a sequence of low discrepancy. For each of
them scale, pose and coupler point follow from a linear least-squares problem with three complex unknowns,

.. math:: \min_{s, z, t} \sum_i |s A_i + z e^{i\chi_i} + t - w_i|^2

so that a start is judged at the best it can be. Where timing is free, the points are met in their order, in
either direction, over a part of a revolution or all of it.

Source: G. H. Golub, V. Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems
whose variables separate, SIAM J. Numer. Anal. 10 (1973) 413–432; for the sequence: M. Roberts, The
unreasonable effectiveness of quasirandom sequences, 2018.

Where timing is free, the crank angle of each point is one more unknown. It moves its own point only, along
the tangent τ of the curve; so for any step of the others the best step of the crank angle is known, and what
is left to be made small is the distance across the curve,

.. math:: \operatorname{Im} \bar\tau_i (P_i + J_i\,\delta - w_i), \qquad
    \delta\varphi_i = -\operatorname{Re} \bar\tau_i (P_i + J_i\,\delta - w_i)/|P'_i|

A constraint that is broken by g is the residual w (g + λ) while that is positive. The shift λ grows by what
is left of g every few steps, until nothing is: so constraints are met with a small weight w, which lets a
linkage move along them. The weight grows where what is left does not fall.

Source: as for `damped_step`; J. Nocedal, S. J. Wright, Numerical Optimization, 2006, 17.3: the augmented
Lagrangian of Hestenes and Powell, w λ being half its multiplier over w.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.kernel.arrays import Bools, Complexes, Floats, Indices
from linkwright.kernel.numerics.least_squares import damped_step
from linkwright.synthesis.path_model import MARGIN, Linkages, PathModel, free_numbers, pin_and_coupler, shape

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
    best = [_best(model, _trials(model, shares[group], number[group])) for group in groups]
    return Linkages(
        *(
            np.concatenate([getattr(population, name) for population in best])
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


def _trials(model: PathModel, shares: Floats, number: Indices) -> Linkages:
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
    pose = _posed(model.target, A, e) if model.pivots is None else _about(model, A, e)
    p = np.column_stack([q, *(part for column in pose for part in (column.real, column.imag))])
    if model.timed is not None:
        p = np.column_stack([p, start])
    return Linkages(p, phi, is_double, side)


def _doubles(linkage: str, number: Indices) -> Bools:
    if linkage == "any":
        return np.asarray(number // 4 % 2 == 1)
    return np.full(len(number), linkage == "double-crank")


def _timing(target: Complexes, shares: Floats) -> Floats:
    """Crank angles of the points from the first, by the lengths between them, bent, (m, n) [rad]."""
    chords = np.abs(np.diff(target))
    along = np.concatenate([[0.0], np.cumsum(chords)]) / chords.sum()
    closing = float(np.abs(target[-1] - target[0]))
    # Half the trials close the path over a whole revolution, as points all round a curve ask for.
    cycle = chords.sum() / (chords.sum() + closing)
    part = np.exp(np.log(_SPAN) * (1 - 2 * shares[:, 0]))
    span = np.where(shares[:, 0] < 0.5, part, cycle)
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
    aa, ff = ((np.abs(point) ** 2).sum(axis=1) for point in (a, f))
    af = (np.conj(a) * f).sum(axis=1)
    aw, fw = ((np.conj(point) * w).sum(axis=1) for point in (a, f))
    apart = _APART * (aa + ff)
    aa, ff = aa + apart, ff + apart
    determinant = aa * ff - np.abs(af) ** 2
    s = (ff * aw - af * fw) / determinant
    z = (aa * fw - np.conj(af) * aw) / determinant
    return s, z, middle - s * A.mean(axis=1) - z * e.mean(axis=1)


def _about(model: PathModel, A: Complexes, e: Complexes) -> tuple[Complexes, Complexes, Complexes]:
    """s, z and t about given pivots, z of least squares, (m,) each."""
    assert model.pivots is not None
    s, t = (np.full(len(A), number) for number in model.pivots)
    z: Complexes = (np.conj(e) * (model.target - s[:, None] * A - t[:, None])).mean(axis=1)
    return s, z, t


def _best(model: PathModel, trials: Linkages) -> Linkages:
    off = (np.abs(model.places(trials) - model.target) ** 2).mean(axis=1)
    broken = np.maximum(model.excess(trials.p, trials.is_double), 0.0)
    judged = (off + _BROKEN * (broken**2).sum(axis=1)).reshape(-1, TRIALS)
    return trials.take(judged.argmin(axis=1) + TRIALS * np.arange(len(judged)))


# Maximum step of a crank angle [rad]: beyond it the tangent says nothing.
_ANGLE = 0.3

# Steps of Newton to the foot of a point on the curve: the first is that of the linear problem.
_FEET = 2

# Damping at the beginning, what it is multiplied by after a failure and divided by after a success.
_DAMPING = 1e-2
_HARDER, _EASIER = 3.0, 5.0

# Steps after which shifts are adapted and rest is looked for; shares of the sum of squares and of the
# size of the path by which a linkage at rest changes in them.
_ROUND = 20
_AT_REST = 1e-6
_STILL = 1e-9

# What is left of broken constraints falls to this share from round to round, else their weight is doubled.
_FALLS = 0.5

# Sum of squares below which a linkage is exact to rounding.
_EXACT = 1e-30


def refine(model: PathModel, rows: Linkages, weight: float, steps: int) -> Iterator[int]:
    """Improve linkages in place, step by step.

    `weight`: of broken constraints at the beginning, beside distances over the size of the path. Returns:
    after every step: how many linkages it took.
    """
    active = np.arange(len(rows.p))
    damping = np.full(len(active), _DAMPING)
    shift = np.zeros_like(model.excess(rows.p, rows.is_double))
    weights, left = np.full(len(active), weight), np.full(len(active), np.inf)
    cost = _cost(model, rows, weights, shift)
    before = _squares(model, rows)
    for number in range(1, steps + 1):
        trial = _stepped(model, rows.take(active), weights[active], shift[active], damping[active])
        new = _cost(model, trial, weights[active], shift[active])
        better = new < cost[active]
        which = active[better]
        rows.put(which, trial.take(better))
        cost[which] = new[better]
        damping[active] = np.where(better, damping[active] / _EASIER, damping[active] * _HARDER)
        yield 2 * len(active)
        if number % _ROUND == 0:
            here = rows.take(active)
            broken = np.maximum(model.excess(here.p, here.is_double) + MARGIN + shift[active], 0.0)
            moved = np.abs(broken - shift[active]).max(axis=1)
            squares = _squares(model, here)
            rests = (np.abs(squares - before[active]) <= _AT_REST * before[active]) & (moved <= _STILL)
            # Twice the weight is a quarter of the shift: the force of the constraint stays.
            grow = np.where((moved > _STILL) & (moved > _FALLS * left[active]), 2.0, 1.0)
            weights[active] *= grow
            shift[active], before[active], left[active] = broken / grow[:, None] ** 2, squares, moved
            cost[active] = _cost(model, here, weights[active], shift[active])
            damping[active] = np.minimum(damping[active], _DAMPING)
            active = active[~rests & (squares > _EXACT)]
        if not len(active):
            return


def _squares(model: PathModel, rows: Linkages) -> Floats:
    return np.asarray((np.abs(model.places(rows) - model.target) ** 2).sum(axis=1))


def _cost(model: PathModel, rows: Linkages, weights: Floats, shift: Floats) -> Floats:
    """Sum of squares of distances and violations, (m,); infinite where a step went too far."""
    with np.errstate(over="ignore", invalid="ignore"):
        broken = np.maximum(model.excess(rows.p, rows.is_double) + MARGIN + shift, 0.0)
        cost = _squares(model, rows) + weights**2 * (broken**2).sum(axis=1)
    return np.where(np.isfinite(cost), cost, np.inf)


def _stepped(model: PathModel, rows: Linkages, weights: Floats, shift: Floats, damping: Floats) -> Linkages:
    places, J, slope = model.linearised(rows)
    off = places - model.target
    broken, by_p = model.penalties(rows.p, rows.is_double, shift)
    if model.timed is not None:
        J = np.concatenate([J, slope[:, :, None]], axis=2)
        by_p = np.concatenate([by_p, np.zeros((*by_p.shape[:2], 1))], axis=2)
        distance, by = np.concatenate([off.real, off.imag], axis=1), np.concatenate([J.real, J.imag], axis=1)
    else:
        speed = np.maximum(np.abs(slope), 1e-12)
        along = np.conj(slope / speed)
        distance, by = (along * off).imag, (along[:, :, None] * J).imag
    residual = np.concatenate([distance, weights[:, None] * broken], axis=1)
    by = np.concatenate([by, weights[:, None, None] * by_p], axis=1)
    step = np.zeros((len(residual), by.shape[2]))
    step[:, model.free] = damped_step(residual, by[:, :, model.free], np.clip(damping, 1e-15, None))
    if model.timed is not None:
        phi = rows.phi + step[:, 9:]
    else:
        ahead = (along * (off + np.einsum("mnk,mk->mn", J, step))).real / speed
        phi = rows.phi - np.clip(ahead, -_ANGLE, _ANGLE)
    trial = Linkages(rows.p + step, phi, rows.is_double, rows.side)
    return trial if model.timed is not None else _nearest(model, trial)


def _nearest(model: PathModel, rows: Linkages) -> Linkages:
    """The linkages with the crank angles at which they are nearest to the points, by Newton's method."""
    phi = rows.phi
    for _ in range(_FEET):
        with np.errstate(over="ignore", invalid="ignore"):
            places, slope = model.moving(Linkages(rows.p, phi, rows.is_double, rows.side))
            ahead = (np.conj(slope) * (places - model.target)).real / np.maximum(np.abs(slope) ** 2, 1e-24)
        phi = phi - np.nan_to_num(np.clip(ahead, -_ANGLE, _ANGLE))
    return Linkages(rows.p, phi, rows.is_double, rows.side)
