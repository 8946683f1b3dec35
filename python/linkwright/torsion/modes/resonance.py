r"""Speeds at which an order of a torque meets a natural frequency of the train: νΩ = ω_n."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.torsion.response.excited_train import ExcitedTrain

Floats = NDArray[np.float64]

# Share of the largest ω² below which a motion is without stiffness.
_FREE = 1e-13


class Resonance(NamedTuple):
    """A speed at which an order meets a natural frequency."""

    speed: float  # of the first disc [rad/s]
    order: float  # cycles per revolution of the first disc
    mode: int  # of the natural frequencies in increasing order, from 0


def resonances(at: ExcitedTrain) -> tuple[Resonance, ...]:
    """Resonances between the lowest and the highest speed, by speed.

    Without damping, of all orders, however small their torque.
    """
    speeds = np.sort(at.torques.speeds)
    omega = _frequencies(at)[np.argsort(at.torques.speeds)]
    found = []
    for mode in range(omega.shape[1]):
        for order in at.torques.orders.tolist():
            gap = omega[:, mode] - order * speeds
            found += [Resonance(speed, order, mode) for speed in _zeros(speeds, gap)]
    return tuple(sorted(found))


def _frequencies(at: ExcitedTrain) -> Floats:
    """Natural frequencies above zero at every speed, (speeds, modes) [rad/s]."""
    # Rings in a fluid hang on nothing elastic: LAPACK takes what is no train in pieces.
    columns, place = np.unique(at.operating.stiffness, axis=1, return_inverse=True)
    scale = 1.0 / np.sqrt(at.referred.inertia)
    matrices = np.array([replace(at.referred, stiffness=column).stiffness_matrix for column in columns.T])
    square = np.linalg.eigvalsh(scale[:, None] * matrices * scale)
    # Rounding leaves some 10⁻¹⁵ of the largest where a part turns freely.
    moving = square.min(axis=0) > _FREE * square.max(initial=0.0)
    found: Floats = np.sqrt(square[place.ravel()][:, moving])
    return found


def _zeros(x: Floats, y: Floats) -> list[float]:
    """Where a curve through points passes zero."""
    n = np.flatnonzero(y[:-1] * y[1:] < 0)
    share = y[n] / (y[n] - y[n + 1])
    between: list[float] = (x[n] + share * (x[n + 1] - x[n])).tolist()
    return [*between, *x[y == 0].tolist()]
