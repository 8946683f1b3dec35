"""Derivatives by differences, with which exact ones are compared."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


def sixth_order(at: Callable[[float], np.ndarray], step: float) -> np.ndarray:
    """The derivative of `at` at 0: central differences over h, 2h and 4h, extrapolated to sixth order."""
    near = {n: at(n * step) for n in (-4, -2, -1, 1, 2, 4)}
    once, twice, four = ((near[n] - near[-n]) / (2 * n * step) for n in (1, 2, 4))
    difference: np.ndarray = (64 * once - 20 * twice + four) / 45
    return difference
