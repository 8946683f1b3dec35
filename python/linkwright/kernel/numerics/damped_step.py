"""Steps of Levenberg and Marquardt's method for many least-squares problems at once.

Source: D. Marquardt, An algorithm for least-squares estimation of nonlinear parameters, SIAM 11 (1963)
431–441.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def damped_step(residual: Floats, J: Floats, damping: Floats) -> Floats:
    """Damped Gauss–Newton steps, (m, k): least squares of the Jacobian with the damping below it.

    The augmented system is solved by orthogonal factors, so that the residual of an exact solution reaches
    rounding.

    Parameters
    ----------
    residual : ndarray, shape (m, n)
        Residuals of m problems.
    J : ndarray, shape (m, n, k)
        Their derivatives by k unknowns.
    damping : ndarray, shape (m,)
        Share of each column's length that is laid below it, squared [–].

    Returns
    -------
    ndarray, shape (m, k)
        What to add to the unknowns.
    """
    k = J.shape[2]
    scale = np.sqrt(damping)[:, None] * np.maximum(np.linalg.norm(J, axis=1), 1e-12)
    below = scale[:, :, None] * np.eye(k)
    tall = np.concatenate([J, below], axis=1)
    right = np.concatenate([-residual, np.zeros((len(J), k))], axis=1)
    Q, R = np.linalg.qr(tall)
    step: Floats = np.linalg.solve(R, np.einsum("mnk,mn->mk", Q, right)[:, :, None])[:, :, 0]
    return step
