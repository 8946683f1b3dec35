r"""Angles with which a train starts as if it had run steadily before: its shafts carry the mean torques.

In steady running mean torques and the mean acceleration of the whole balance on every mass,

.. math:: \bar M_i(\theta) = \bar J_i\,\frac{\sum\bar M}{\sum\bar J}

over two revolutions. The twists that do so are found by Newton's method, whatever the curves of couplings
are. Without them a motion would begin with the shock of torques that set in at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import ConvergenceError
from linkwright.torsion.core.transient import MovingTrain

Floats = NDArray[np.float64]

# Angles of two revolutions: some twenty a wave of order 24.
_ANGLES = 1024

# A time before the start [s]: laws over time are what they are there, and nothing has set in that begins
# with it.
BEFORE = -1.0

# Twist by which stiffnesses are found [rad], and Newton's steps.
_STEP = 1e-7
_STEPS = 60

# Share of a coupling's steepest slope that it has at least, so that a gap is crossed: Newton then comes
# closer a thousandfold in each step at the worst.
_FLOOR = 1e-3

# Share of the torques that may be left, and of the stiffest shaft's torque per angle: rounding of two
# revolutions.
_LEFT, _ROUNDING = 1e-9, 1e-14


def loaded_angles(train: MovingTrain, angle: Floats, speed: Floats) -> Floats:
    """Angles of the masses under mean torques, (masses,).

    The first mass of a free train stays where it is [rad]. `angle`, `speed`: (masses,) [rad, rad/s].
    """
    is_free = not (train.tip < 0).any()
    # A train that is held does not turn: its torques are those at its angles.
    turns = 4 * np.pi * np.arange(_ANGLES) / _ANGLES if is_free else np.zeros(1)
    fixed = int(is_free)
    q = np.array(angle, dtype=float)
    steepest = train.lead**2 * (train.stiffness + _steepest(train))
    allowed = _ROUNDING * steepest.max(initial=0.0)
    for _ in range(_STEPS):
        torque, inertia = (each.mean(axis=0) for each in train.net_torques(BEFORE, q + turns[:, None], speed))
        left = torque - inertia * (torque.sum() / inertia.sum()) if is_free else torque
        # What only a fluid holds follows without twist.
        stiffness = _stiffness(train, q, speed)
        joined = stiffness.diagonal() > _LEFT * steepest.max(initial=0.0)
        allowed = max(allowed, _LEFT * float(np.abs(torque).max()))
        if np.abs(left[joined]).max(initial=0.0) <= allowed:
            return q
        q[fixed:] += np.linalg.lstsq(stiffness[fixed:, fixed:], left[fixed:], rcond=1e-13)[0]
    raise ConvergenceError(
        "no twist of the shafts carries the mean torques at the start; start without them: loaded = false",
        method="Newton",
        iterations=_STEPS,
    )


def _steepest(train: MovingTrain) -> Floats:
    """Steepest slope of the curve of each shaft, (shafts,) [N m/rad]."""
    return np.array([0.0 if curve is None else float(np.abs(curve.after).max()) for curve in train.curves])


def _stiffness(train: MovingTrain, angle: Floats, speed: Floats) -> Floats:
    """What turning each mass takes, (masses, masses) [N m/rad]."""
    n = len(angle)
    # Both sides of the angle, so that bends of curves cancel.
    rows = np.concatenate([angle + _STEP * np.eye(n), angle - _STEP * np.eye(n)])
    ahead, back = np.split(train.net_torques(BEFORE, rows, speed)[0], 2)
    matrix: Floats = (back - ahead).T / (2 * _STEP)
    # Torques over the angle of a disc have no part in what its shafts do.
    least = train.lead**2 * _FLOOR * _steepest(train)
    ends = np.where(train.tip < 0, n, train.mass[train.tip])
    for (a, b), k in zip(ends.tolist(), least.tolist(), strict=True):
        for i, j in ((a, b), (b, a)):
            if i < n:
                matrix[i, i] += k
                if j < n:
                    matrix[i, j] -= k
    return matrix
