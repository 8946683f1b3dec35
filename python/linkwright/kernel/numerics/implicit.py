r"""Derivatives of what an equation is solved for.

The solution z of :math:`f(z, p) = 0` follows the numbers p of the equation by

.. math:: \frac{\partial f}{\partial z}\,\mathrm dz = -\frac{\partial f}{\partial p}\,\mathrm dp

however it was found. Where z is found by an iteration z ← g(z, p), of which only the effect on derivatives is
at hand, :math:`\mathrm dz = g_z\,\mathrm dz + g_p\,\mathrm dp` is solved by GMRES.

References
----------
.. [1] Saad, Schultz, GMRES: A Generalized Minimal Residual Algorithm for Solving Nonsymmetric Linear Systems,
   SIAM J. Sci. Stat. Comput. 7 (1986) 856.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError
from linkwright.kernel.numerics.tangent import Tangent

# Steps of GMRES at most, and the residual over the first one at which it ends.
_STEPS, _TOLERANCE = 60, 1e-10


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


def iterated_along(step: Callable[[Floats], Floats], n: int, k: int) -> Floats:
    """The derivatives d (n, k) by k variables that an iteration leaves as they are, d = step(d).

    `step` is linear in each column of d, with a constant; each column has a Krylov space of its own.
    """
    constant = step(np.zeros((n, k)))
    size = np.linalg.norm(constant, axis=0)
    scale = np.where(size > 0, size, 1.0)
    basis = [constant / scale]
    known = np.zeros((_STEPS + 1, _STEPS, k))
    for j in range(_STEPS):
        image = basis[j] - (step(basis[j] * scale) - constant) / scale
        for i, vector in enumerate(basis):
            known[i, j] = (vector * image).sum(axis=0)
            image = image - vector * known[i, j]
        known[j + 1, j] = np.linalg.norm(image, axis=0)
        basis.append(image / np.where(known[j + 1, j] > 0, known[j + 1, j], 1.0))
        first = (size / scale)[:, None] * np.eye(1, j + 2)
        spaces = known[: j + 2, : j + 1].transpose(2, 0, 1)
        shares = [np.linalg.lstsq(space, right)[0] for space, right in zip(spaces, first, strict=True)]
        rest = first - np.einsum("cij,cj->ci", spaces, np.array(shares))
        if np.linalg.norm(rest, axis=1).max(initial=0.0) <= _TOLERANCE:
            return np.asarray(np.einsum("jnc,cj->nc", np.array(basis[:-1]), np.array(shares)) * scale)
    raise ConvergenceError("derivatives of an iteration were not found: it hardly determines its solution")
