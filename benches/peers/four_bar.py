"""The four-bar linkage by hand: arrays of crank angles or machines, with NumPy.

Some dozen arrays of a block stay in the cache; in arrays as long as the result NumPy takes twice as long.
"""

from __future__ import annotations

from typing import Any

import numpy as np

# Crank, frame, rocker [m]; place of the coupler point along and across the coupler [m].
CRANK, FRAME, ROCKER = 0.1, 0.4, 0.3
ALONG, ACROSS = 0.2, 0.1


# Positions of a block: 200 kB an array.
BLOCK = 24_576


def motion(phi: Any, coupler: Any, out: Any) -> Any:
    """Coupler point over the crank angle into ``out``, block by block.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angles [rad].
    coupler : float or ndarray, shape (rows, 1)
        Length of the coupler [m].
    out : ndarray, shape (rows, 6, n)
        x, y, x′, y′, x″, y″ of the point.
    """
    rows, _, n = out.shape
    machines = max(1, BLOCK // n)
    for first in range(0, rows, machines):
        some = slice(first, first + machines)
        for begin in range(0, n, BLOCK):
            here = slice(begin, begin + BLOCK)
            _block(phi[here], coupler if np.ndim(coupler) == 0 else coupler[some], out[some, :, here])
    return out


def _block(phi: Any, coupler: Any, out: Any) -> None:
    """One of them."""
    c, s = np.cos(phi), np.sin(phi)
    ax, ay = CRANK * c, CRANK * s
    ux, uy = FRAME - ax, -ay
    u2 = ux * ux + uy * uy
    k = u2 + (coupler - ROCKER) * (coupler + ROCKER)
    S = np.sqrt(4.0 * coupler * coupler * u2 - k * k)
    half = 0.5 / u2
    bx, by = half * (k * ux - S * uy), half * (k * uy + S * ux)
    ex, ey = bx / coupler, by / coupler
    fx, fy = (bx - ux) / ROCKER, (by - uy) / ROCKER
    kappa = ex * fy - ey * fx
    # u′ = −a′, u″ = −a″
    chi_d1 = (ay * fx - ax * fy) / (coupler * kappa)
    psi_d1 = (ay * ex - ax * ey) / (ROCKER * kappa)
    wx = ax + coupler * chi_d1**2 * ex - ROCKER * psi_d1**2 * fx
    wy = ay + coupler * chi_d1**2 * ey - ROCKER * psi_d1**2 * fy
    chi_d2 = (wx * fx + wy * fy) / (coupler * kappa)
    qx, qy = ALONG * ex - ACROSS * ey, ALONG * ey + ACROSS * ex
    out[:, 0], out[:, 1] = ax + qx, ay + qy
    out[:, 2], out[:, 3] = -ay - chi_d1 * qy, ax + chi_d1 * qx
    out[:, 4] = -ax - chi_d2 * qy - chi_d1**2 * qx
    out[:, 5] = -ay + chi_d2 * qx - chi_d1**2 * qy
