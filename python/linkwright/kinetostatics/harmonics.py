r"""Harmonics of a force over the revolution: amplitudes of Fourier's series.

.. math:: F(\varphi) = a_0 + \sum_k a_k \cos k\varphi + b_k \sin k\varphi
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.kernel.errors import ShapeError
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About
from linkwright.kernel.result import Record

Floats = NDArray[np.float64]

# Part of a step by which the angles of an even turn may differ from it.
_EVEN = 1e-6


@dataclass(frozen=True)
class Harmonics(Record):
    """Coefficients of a series."""

    cosine: Annotated[
        Floats, About("a_k in the unit of the quantity; the mean is a₀.", "(order + 1, components)")
    ]
    sine: Annotated[Floats, About("b_k, likewise.", "(order + 1, components)")]

    @property
    def amplitude(self) -> Annotated[Floats, About("Amplitudes.", "(order + 1, components)")]:
        """√(a_k² + b_k²) of each component."""
        found: Floats = np.hypot(self.cosine, self.sine)
        return found


@public
def harmonics(crank_angle: Floats, values: ArrayLike, order: int = 8) -> Harmonics:
    """Fourier's series of a quantity over one revolution.

    Parameters
    ----------
    crank_angle : ndarray, shape (n,)
        Angles of one revolution in even steps, its end included [rad].
    values : ndarray, shape (n,) or (n, components)
        The quantity.
    order : int
        Highest order; at most half of the steps.

    Returns
    -------
    Harmonics
        Orders 0 to ``order``.

    Raises
    ------
    ShapeError
        The angles are not one revolution in even steps, a value is missing, or the order is too high.
    """
    phi = np.asarray(crank_angle, dtype=np.float64)
    table = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if len(table) != len(phi):
        raise ShapeError(f"values: found {len(table)} rows, expected one for each of {len(phi)} crank angles")
    table = table.reshape(len(phi), -1)[:-1]
    steps = len(table)
    even = steps > 1 and np.allclose(np.diff(phi), 2 * np.pi / steps, rtol=0, atol=_EVEN * 2 * np.pi / steps)
    if not even:
        raise ShapeError("harmonics need a revolution of the crank in even steps; give forces n, not angles")
    if not np.isfinite(table).all() or not 0 <= order < steps / 2:
        raise ShapeError(
            f"harmonics of order {order} need finite values at more than {2 * order} steps, found {steps}"
        )
    c = np.fft.rfft(table, axis=0)[: order + 1] / steps
    c[1:] *= 2
    # A revolution that does not begin at zero has its phase in the coefficients.
    c = c * np.exp(-1j * np.arange(order + 1) * phi[0])[:, None]
    return Harmonics(c.real.copy(), -c.imag)
