"""The four-bar linkage by hand as a loop that numba compiles, on all threads: for those who have it."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from peers.four_bar import ACROSS, ALONG, CRANK, FRAME, ROCKER


@numba.njit(parallel=True, fastmath=True, cache=False)  # type: ignore[untyped-decorator]
def _fill(cos: Any, sin: Any, couplers: Any, out: Any) -> None:
    """Machines side by side; the angles of one are a plain loop."""
    for row in numba.prange(len(couplers)):
        coupler = couplers[row]
        for k in range(len(cos)):
            ax, ay = CRANK * cos[k], CRANK * sin[k]
            ux, uy = FRAME - ax, -ay
            u2 = ux * ux + uy * uy
            q = u2 + (coupler - ROCKER) * (coupler + ROCKER)
            S = np.sqrt(4.0 * coupler * coupler * u2 - q * q)
            half = 0.5 / u2
            bx, by = half * (q * ux - S * uy), half * (q * uy + S * ux)
            ex, ey = bx / coupler, by / coupler
            fx, fy = (bx - ux) / ROCKER, (by - uy) / ROCKER
            inverse = 1.0 / (ex * fy - ey * fx)
            chi_d1 = (ay * fx - ax * fy) * inverse / coupler
            psi_d1 = (ay * ex - ax * ey) * inverse / ROCKER
            wx = ax + coupler * chi_d1 * chi_d1 * ex - ROCKER * psi_d1 * psi_d1 * fx
            wy = ay + coupler * chi_d1 * chi_d1 * ey - ROCKER * psi_d1 * psi_d1 * fy
            chi_d2 = (wx * fx + wy * fy) * inverse / coupler
            qx, qy = ALONG * ex - ACROSS * ey, ALONG * ey + ACROSS * ex
            square = chi_d1 * chi_d1
            out[row, 0, k], out[row, 1, k] = ax + qx, ay + qy
            out[row, 2, k], out[row, 3, k] = -ay - chi_d1 * qy, ax + chi_d1 * qx
            out[row, 4, k] = -ax - chi_d2 * qy - square * qx
            out[row, 5, k] = -ay + chi_d2 * qx - square * qy


def motion(phi: Any, coupler: Any, out: Any) -> Any:
    """Coupler point of many machines over the crank angle into ``out``, as `peers.four_bar.motion`."""
    _fill(np.cos(phi), np.sin(phi), np.ravel(coupler), out)
    return out
