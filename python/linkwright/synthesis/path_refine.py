"""Least squares on the linkages of a search: the method of Levenberg and Marquardt with exact crank angles.

Where timing is free, the crank angle of each point is one more unknown. Derivatives by the crank angle are
exact, those by lengths are central differences, all linkages that they need computed as one batch.

Source: D. Marquardt, An algorithm for least-squares estimation of nonlinear parameters, SIAM 11 (1963)
431–441.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.synthesis.path_model import PathModel, disorder

Floats = NDArray[np.float64]

# Steps at most; a search ends in a valley that may be long and flat.
_STEPS = 200

# Step of the central differences over the size of the path: a third of the digits, so that their error, its
# square, is near rounding.
_STEP = 1e-5

# A cost that falls by less than this share has come to rest.
_REST = 1e-10


def refine(model: PathModel, row: Floats) -> tuple[float, Floats, int]:
    """Improve a linkage while it keeps its constraints.

    Parameters
    ----------
    model : PathModel
        The search space.
    row : ndarray, shape (k,)
        A linkage that keeps the constraints.

    Returns
    -------
    tuple of (float, ndarray, int)
        Mean square of the distances [m²], infinite if the row breaks a constraint; the improved row, with the
        crank angles of the points behind it where timing is free; how many linkages were computed.
    """
    angles = model.nearest(row) if model.timed is None else model.timed
    state = np.concatenate([row, angles]) if model.timed is None else row.copy()
    residual, J = _linearised(model, state)
    cost, damping, count = float(residual @ residual), 1e-3, 1 + 2 * model.n_entries
    if not _allowed(model, state):
        return np.inf, state, count
    for _ in range(_STEPS):
        trial = state + _step(residual, J, damping)
        new = _residual(model, trial)
        count += 1
        new_cost = float(new @ new)
        if not (new_cost < cost and _allowed(model, trial)):
            damping *= 5
            if damping > 1e12:
                break
            continue
        rests = cost - new_cost < _REST * cost
        state, cost, damping = trial, new_cost, max(damping / 5, 1e-14)
        if rests:
            break
        residual, J = _linearised(model, state)
        count += 2 * model.n_entries
    return cost / len(model.x), state, count


def _split(model: PathModel, state: Floats) -> tuple[Floats, Floats]:
    """The linkage and the crank angles of the points."""
    if model.timed is not None:
        return state, model.timed
    return state[: model.n_entries], state[model.n_entries :]


def _residual(model: PathModel, state: Floats) -> Floats:
    """Distances in x and in y, (2 n,) [m]."""
    row, angles = _split(model, state)
    places = model.places(row[None], angles)[0]
    return np.concatenate([places[0] - model.x, places[1] - model.y])


def _linearised(model: PathModel, state: Floats) -> tuple[Floats, Floats]:
    """Residual (2 n,) and its derivatives by the unknowns (2 n, k)."""
    row, angles = _split(model, state)
    k, n = model.n_entries, len(angles)
    # A direction of the crank has the size 1, a length that of the path.
    steps = _STEP * np.where(np.arange(k) == 9, 1.0, model.size)
    rows = np.concatenate([row[None], row + np.diag(steps), row - np.diag(steps)])
    table = model.places(rows, angles, slopes=True)
    ends = table[:, :2].reshape(len(rows), 2 * n)
    J = ((ends[1 : k + 1] - ends[k + 1 :]) / (2 * steps[:, None])).T
    if model.timed is None:
        J = np.concatenate([J, np.concatenate([np.diag(table[0, 2]), np.diag(table[0, 3])])], axis=1)
    return ends[0] - np.concatenate([model.x, model.y]), np.nan_to_num(J)


def _step(residual: Floats, J: Floats, damping: float) -> Floats:
    """A damped Gauss–Newton step."""
    scale = np.maximum(np.linalg.norm(J, axis=0), 1e-12 * np.abs(J).max())
    tall = np.concatenate([J, np.sqrt(damping) * np.diag(scale)])
    right = np.concatenate([-residual, np.zeros(J.shape[1])])
    return np.asarray(np.linalg.lstsq(tall, right, rcond=None)[0])


def _allowed(model: PathModel, state: Floats) -> bool:
    """Whether a linkage is in the box, keeps the constraints, and meets its points in order."""
    row, angles = _split(model, state)
    # The direction of the crank may pass ±π; all else must stay in its box.
    inside = ((row >= model.low) & (row <= model.high))[:9].all()
    if not inside or model.violation(row[None])[0] > 0:
        return False
    return model.timed is not None or bool(disorder(angles[None], 2 * np.pi)[0] == 0)
