r"""Least squares on many linkages of a path at once, by the method of Levenberg and Marquardt.

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
from numpy.typing import NDArray

from linkwright.kernel.numerics.damped_step import damped_step
from linkwright.synthesis.path_model import MARGIN, Linkages, PathModel

Floats = NDArray[np.float64]

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
_REST = 1e-6
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
            rests = (np.abs(squares - before[active]) <= _REST * before[active]) & (moved <= _STILL)
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
    """Sum of squares of the distances, (m,)."""
    return np.asarray((np.abs(model.places(rows) - model.target) ** 2).sum(axis=1))


def _cost(model: PathModel, rows: Linkages, weights: Floats, shift: Floats) -> Floats:
    """Sum of squares of distances and of what is broken, (m,); infinite where a step went too far."""
    with np.errstate(over="ignore", invalid="ignore"):
        broken = np.maximum(model.excess(rows.p, rows.is_double) + MARGIN + shift, 0.0)
        cost = _squares(model, rows) + weights**2 * (broken**2).sum(axis=1)
    return np.where(np.isfinite(cost), cost, np.inf)


def _stepped(model: PathModel, rows: Linkages, weights: Floats, shift: Floats, damping: Floats) -> Linkages:
    """The linkages after a damped step."""
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
    step = damped_step(residual, by, np.clip(damping, 1e-15, None))
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
