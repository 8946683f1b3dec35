r"""Worst case of tolerances: the machine itself at the two corners that the signs of the derivatives name.

.. math:: f_\mathrm{max} = f\bigl(x_i = \bar x_i + t_i\,\mathrm{sgn}\,\partial f/\partial x_i\bigr)

is exact where f is monotone in each variable, however many there are and however curved f is. At each corner
every variable is moved alone, a little inwards and to its other end: where that goes beyond the corner, f is
not monotone, and the extremes of all that was computed bound the worst case from within.

References
----------
.. [1] Chase, Greenwood, Design issues in mechanical tolerance analysis, Manufacturing Review 1 (1988) 50.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Floats, Indices
from linkwright.studies.engine import evaluate
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import SOLVED, Rows

# Step inwards from a corner as a share of the range: between the accuracy of responses and their curvature.
_INWARDS = 0.05

# What a response may be beyond its corner, as a share of the worst case and of itself: rounding, and the
# accuracy of searched extremes.
_BEYOND, _ROUNDING = 1e-4, 1e-9


@dataclass(frozen=True)
class WorstCase:
    """The range of a response [SI]; `doubt` says why it may be wider, and is empty where it is exact."""

    low: float
    high: float
    doubt: str = ""


def worst_case(
    plan: StudyPlan,
    middles: Floats,
    slopes: Mapping[str, Floats],
    values: Mapping[str, float],
    drawn: Mapping[str, Floats],
) -> dict[str, WorstCase]:
    """The worst case of each response.

    `middles`: of the variables, (variables,) [SI]; `slopes`: response → derivatives there, likewise;
    `values`: response → value there; `drawn`: response → values of random machines, (rows,).
    """
    low, high = np.array([(axis.low, axis.high) for axis in plan.axes]).T
    bounded = [name for name in plan.responses if np.isfinite((high - low)[slopes[name] != 0]).all()]
    endless = {name: WorstCase(-np.inf, np.inf) for name in plan.responses if name not in bounded}
    places = [_places(plan, middles, way * slopes[name]) for name in bounded for way in (-1, 1)]
    if not places:
        return endless
    points, back = np.unique(np.vstack(places), axis=0, return_inverse=True)
    rows = evaluate(plan, {axis.name: points[:, i].copy() for i, axis in enumerate(plan.axes)})
    own = dict(
        zip(bounded, np.split(back.ravel(), 2 * np.arange(1, len(bounded)) * len(places[0])), strict=True)
    )
    cases = {
        name: _judged(plan, rows, name, own[name].reshape(2, -1), slopes[name], values[name], drawn[name])
        for name in bounded
    }
    return {name: (cases | endless)[name] for name in plan.responses}


def _places(plan: StudyPlan, middles: Floats, rise: Floats) -> Floats:
    """The corner of the steepest rise, then each variable alone inwards and at both ends, (1 + 3 n, n)."""
    low, high = np.array([(axis.low, axis.high) for axis in plan.axes]).T
    corner = np.where(rise > 0, high, np.where(rise < 0, low, middles))
    places = np.tile(corner, (1 + 3 * len(corner), 1))
    for i, axis in enumerate(plan.axes):
        if np.isfinite(high[i] - low[i]):
            inwards = corner[i] - np.sign(rise[i]) * _INWARDS * (high[i] - low[i])
            places[1 + 3 * i : 4 + 3 * i, i] = inwards if axis.is_continuous else corner[i], low[i], high[i]
    return places


def _judged(
    plan: StudyPlan,
    rows: Rows,
    name: str,
    own: Indices,
    slopes: Floats,
    value: float,
    drawn: Floats,
) -> WorstCase:
    """Both corners of a response and what lies beyond them; `own`: its rows, (2, 1 + 3 n)."""
    column = rows.columns[name]
    solved = rows.status[own] == SOLVED
    widths = np.array([axis.high - axis.low for axis in plan.axes])
    if not solved[:, 0].all():
        reach = 0.5 * float(np.abs(np.where(slopes == 0, 0.0, slopes * widths)).sum())
        low, high = min(value - reach, drawn.min()), max(value + reach, drawn.max())
        return WorstCase(low, high, "a machine at the corner of all tolerances has no result")
    corners = column[own[:, 0]]
    seen = np.concatenate([column[own[solved]], drawn, corners])
    low, high = float(seen.min()), float(seen.max())
    room = max(_BEYOND * (high - low), _ROUNDING * float(np.abs(corners).max()))
    if low >= corners[0] - room and high <= corners[1] + room:
        return WorstCase(low, high)
    return WorstCase(low, high, _not_monotone(plan, column, own, solved, room))


def _not_monotone(plan: StudyPlan, column: Floats, own: Indices, solved: Indices, room: float) -> str:
    way = np.array([[-1.0], [1.0]])
    beyond = np.where(solved, way * (column[own] - column[own[:, :1]]), 0.0)[:, 1:]
    leads = np.flatnonzero((beyond.reshape(2, -1, 3) > room).any(axis=(0, 2)))
    names = [plan.axes[i].name for i in leads]
    return (
        f"it is not monotone in {', '.join(names)}" if names else "machines inside the tolerances exceed it"
    )
