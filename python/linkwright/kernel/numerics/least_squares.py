r"""Linear least squares with what it can tell, by singular values; damped steps for many problems at once.

.. math:: A = U S V^T, \qquad \hat x = V S^{-1} U^T y, \qquad \mathrm{cov}\, \hat x = \sigma^2 V S^{-2} V^T

σ is 1 where equations are divided by their noise, else estimated from what is left over. What has no singular
value is left at zero, and the parameters that take part in it are open.

References
----------
.. [1] Golub and Van Loan, Matrix Computations, 4th ed. 2013, section 5.5: least squares by singular values.
.. [2] D. Marquardt, An algorithm for least-squares estimation of nonlinear parameters, SIAM 11 (1963)
   431–441: the damped step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Bools, Floats

# Singular values below this share of the largest are rounding, also of columns that are differences.
_ROUNDING = 1e-9
# Part of a parameter in what cannot be determined from which on it is open.
_OPEN = 1e-6


class Fit(NamedTuple):
    """Parameters that fit some equations best."""

    values: Floats  # (parameters,): the smallest of all that fit equally well
    deviation: Floats  # (parameters,): standard deviations; infinite for what is open
    covariance: Floats  # (parameters, parameters): as far as it can be determined
    is_open: Bools  # (parameters,): what the equations do not tell
    condition: float  # largest over smallest singular value; infinite where something is open
    misfit: float  # root of what is left over for each degree of freedom; NaN without any
    freedom: int  # equations less parameters told


def least_squares(A: Floats, y: Floats, *, is_known: bool) -> Fit:
    """Fit parameters to equations A (equations, parameters) with right-hand sides y (equations,).

    `is_known`: whether the noise of each is 1, or estimated from what is left over.
    """
    # Rows of Vt beyond the equations are what these leave open; columns of U beyond the parameters are idle.
    U, s, Vt = np.linalg.svd(A, full_matrices=A.shape[0] < A.shape[1])
    # A parameter that does nothing has no singular value at all if equations are fewer.
    rank = int((s > _ROUNDING * s.max(initial=0.0)).sum())
    freedom = len(y) - rank
    values = Vt[:rank].T @ ((U[:, :rank].T @ y) / s[:rank])
    left = y - A @ values
    misfit = float(np.sqrt(left @ left / freedom)) if freedom else float("nan")
    covariance = (Vt[:rank].T / s[:rank] ** 2) @ Vt[:rank] * (1.0 if is_known else misfit**2)
    is_open = np.linalg.norm(Vt[rank:], axis=0) > _OPEN
    return Fit(
        values=values,
        deviation=np.where(is_open, np.inf, np.sqrt(np.diag(covariance))),
        covariance=covariance,
        is_open=is_open,
        condition=float(s[0] / s[-1]) if rank == A.shape[1] else float("inf"),
        misfit=misfit,
        freedom=freedom,
    )


def scaled(fit: Fit, factor: float) -> Fit:
    """The same fit with deviations larger by a factor."""
    return fit._replace(deviation=factor * fit.deviation, covariance=factor**2 * fit.covariance)


def damped_step(residual: Floats, J: Floats, damping: Floats) -> Floats:
    """Damped Gauss–Newton steps, (m, k): least squares of the Jacobian with the damping below it [2]_.

    Residuals (m, n) and their derivatives (m, n, k) of m problems; damping (m,) is the share of each column's
    length that is laid below it, squared. The augmented system is solved by orthogonal factors, so that the
    residual of an exact solution reaches rounding.
    """
    k = J.shape[2]
    scale = np.sqrt(damping)[:, None] * np.maximum(np.linalg.norm(J, axis=1), 1e-12)
    below = scale[:, :, None] * np.eye(k)
    tall = np.concatenate([J, below], axis=1)
    right = np.concatenate([-residual, np.zeros((len(J), k))], axis=1)
    Q, R = np.linalg.qr(tall)
    step: Floats = np.linalg.solve(R, np.einsum("mnk,mn->mk", Q, right)[:, :, None])[:, :, 0]
    return step
