r"""Derivatives of what an equation is solved for.

The solution z of :math:`f(z, p) = 0` follows the numbers p of the equation by

.. math:: \frac{\partial f}{\partial z}\,\mathrm dz = -\frac{\partial f}{\partial p}\,\mathrm dp

however it was found.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.kernel.numerics.tangent import Tangent


def solution_along(z: Any, residual: Any, slope: Any) -> Any:
    """A solution with the derivatives that its equation gives it; without any if the equation has none.

    `z`: numbers (…,), or vectors (…, n) of systems; `residual`: f at z held, in its shape; `slope`: ∂f/∂z, of
    each number, or matrices (…, n, n).
    """
    if not isinstance(residual, Tangent):
        return z
    if np.ndim(slope) > np.ndim(z):
        return Tangent(z, -np.linalg.solve(slope, residual.d))
    return Tangent(z, -residual.d / np.asarray(slope)[..., None])
