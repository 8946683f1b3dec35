"""The linkages that come nearest to more points of a function than a four-bar can meet.

Linkages of all proportions and those of Freudenstein's equation are refined until the sum of squares of the
structural error at the points is smallest, within the limits of the task (`function_refine`); from the best
minima the largest error over the range is minimised. Minima of the equation's residual are not those of the
error: they may lie in a valley of ever longer links.
"""

from __future__ import annotations

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.synthesis.expression import Scale
from linkwright.synthesis.freudenstein import Fit, begins, residual
from linkwright.synthesis.function_refine import FunctionModel, Rows, level, refine
from linkwright.synthesis.path_search import sequence
from linkwright.synthesis.task import FunctionTask

# Groups of trials, each of which gives its best to the refinement, and the trials of a group.
_GROUPS, _TRIALS = 240, 40

# What is broken of the limits counts so much beside the mean square of the error [rad²]: a start may break
# them, as refinement mends that.
_BROKEN = 0.05

# Linkages of Freudenstein's equation that are refined at most.
_MOST = 60

# Minima of least squares whose largest error is minimised, and intervals of the analysis over the range to
# one of the points where it is examined.
_LEVELLED = 12
_EVERY = 12

# Links over the frame beyond this stand for pivots that are infinitely far apart [–].
_FAR = 1e4

# Errors within this share are those of one minimum.
_SAME = 0.01


def nearest(task: FunctionTask, scale: Scale) -> tuple[list[Fit], int]:
    """Linkages whose largest structural error over the range is a minimum, and that keep all limits.

    Returns: the fits, the minimum of the largest errors first, each with the number of starts that ended at
    this error; and how many starts were refined.
    """
    free = np.array([True, True, True, task.crank_start is None, task.rocker_start is None])
    model = FunctionModel(
        scale.crank, scale.rocker, task.crank_range, free, task.length_ratio_max, task.transmission_angle_min
    )
    rows = _starts(task, scale, model)
    if not len(rows.x):
        return [], 0
    refined, rms, broken = refine(model, rows)
    kept = np.flatnonzero((broken <= 0.0) & np.isfinite(rms))
    kept = kept[np.argsort(rms[kept], kind="stable")]
    minima, counts = _minima(rms, kept)
    if not len(minima):
        return [], len(rows.x)
    levelled, largest = level(
        model.over(scale.crank_over[::_EVERY], scale.rocker_over[::_EVERY]), refined.take(minima)
    )
    fits = []
    for i in np.argsort(largest, kind="stable"):
        alike = np.abs(largest - largest[i]) <= _SAME * largest[i]
        fits.append(_fit(scale, levelled, int(i), int(np.array(counts)[alike].sum())))
    return fits, len(rows.x)


def _minima(rms: Floats, kept: Indices) -> tuple[Indices, list[int]]:
    """One linkage of each of the lowest minima, and how many ended there; ``kept`` in order of ``rms``."""
    minima: list[int] = []
    counts: list[int] = []
    while len(kept) and len(minima) < _LEVELLED:
        same = rms[kept] <= (1 + _SAME) * rms[kept[0]]
        minima.append(int(kept[0]))
        counts.append(int(same.sum()))
        kept = kept[~same]
    return np.array(minima, dtype=np.intp), counts


def _starts(task: FunctionTask, scale: Scale, model: FunctionModel) -> Rows:
    """The best trial of each group, and the best linkages of Freudenstein's equation."""
    groups = [_trials(task, model), _of_equation(task, scale, model)]
    return Rows(
        *(np.concatenate([getattr(group, name) for group in groups]) for name in ("x", "side", "turned"))
    )


def _trials(task: FunctionTask, model: FunctionModel) -> Rows:
    """Lengths and start angles that fill their ranges evenly, the best of each group."""
    n = _GROUPS * _TRIALS
    shares = sequence(n, 4, 0)
    number = np.arange(n)
    reach = np.log(min(task.length_ratio_max, _FAR))
    turns = 2 * np.pi * shares[:, 3]
    x = np.column_stack([reach * (2 * shares[:, :3] - 1), turns, np.zeros(n)])
    if task.crank_start is not None:
        x[:, 3] = task.crank_start
    # A link may point against its angle only where this is given; else the angle is turned instead.
    turned = np.column_stack(
        [(number // 2 % 2 == 1) & ~model.free[3], (number // 4 % 2 == 1) & ~model.free[4]]
    )
    rows = Rows(x, np.where(number % 2 == 0, 1.0, -1.0), turned)
    if task.rocker_start is None:
        # The start angle that suits a linkage best is its mean error.
        x[:, 4] = np.angle(np.exp(1j * model.errors(rows)[0]).mean(axis=1))
    else:
        x[:, 4] = task.rocker_start
    broken = np.maximum(model.excess(rows)[0], 0.0)
    merit = (model.errors(rows)[0] ** 2).mean(axis=1) + _BROKEN * (broken**2).sum(axis=1)
    best = merit.reshape(_GROUPS, _TRIALS).argmin(axis=1) + _TRIALS * np.arange(_GROUPS)
    return rows.take(best)


def _of_equation(task: FunctionTask, scale: Scale, model: FunctionModel) -> Rows:
    """Linkages of Freudenstein's equation that are real, the better side of each, the best of them."""
    K, starts = begins(scale.crank, scale.rocker, task.crank_start, task.rocker_start)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        r, b = 1 / K[:, 0], 1 / K[:, 1]
        square = 1 + r * r + b * b - 2 * r * b * K[:, 2]
        logs = np.log(np.column_stack([np.abs(r), np.sqrt(square), np.abs(b)]))
    real = np.isfinite(logs).all(axis=1) & (np.abs(logs) < np.log(_FAR)).all(axis=1)
    x = np.column_stack([logs, starts])[real]
    turned = np.column_stack([r < 0, b < 0])[real]
    sides = [Rows(x, np.full(len(x), side), turned) for side in (1.0, -1.0)]
    merit = np.array([(model.errors(side)[0] ** 2).sum(axis=1) for side in sides])
    chosen = np.argsort(merit.min(axis=0), kind="stable")[:_MOST]
    side = np.where(merit[0] <= merit[1], 1.0, -1.0)
    return Rows(x, side, turned).take(chosen)


def _fit(scale: Scale, rows: Rows, i: int, found_by: int) -> Fit:
    r, c, b = np.exp(rows.x[i, :3])
    r, b = (-angles if turned else angles for angles, turned in zip((r, b), rows.turned[i], strict=True))
    K = np.array([1 / r, 1 / b, (1 + r * r + b * b - c * c) / (2 * r * b)])
    phi, psi = (float(np.angle(np.exp(1j * start))) for start in rows.x[i, 3:])
    at = residual(scale.crank, scale.rocker, K[None], rows.x[i : i + 1, 3:])
    return Fit(K, phi, psi, float(at[0]), found_by)
