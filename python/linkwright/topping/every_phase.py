r"""The exact length of the edge for every phase of a knife that goes back and forth.

Heads meet the knife as they may. A point of a head lies within d/2 + Δ of the axis of the row, the middle of
the edge within half of the stroke S; where the edge crosses the point, both differ by the way from the middle
of the edge, seen across the row. If the edge never retreats it crosses each point once, and at some head the
knife is at one end of its stroke just as it crosses the point farthest to the other side:

.. math:: L = \frac{S + d + 2\Delta}{\cos\alpha}.

The speeds do not count. A retreating edge never needs more.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def every_phase_length(
    diameter: ArrayLike, offset: ArrayLike, edge_angle: ArrayLike, stroke: ArrayLike
) -> Floats:
    """Minimum length of an edge that never retreats.

    Parameters
    ----------
    diameter, offset, edge_angle, stroke : array_like, shape (...)
        d of the head and maximum offset Δ [m], α [rad], S [m]; they broadcast.

    Returns
    -------
    ndarray, shape (...)
        [m]
    """
    band = np.asarray(diameter, dtype=float) + 2 * np.asarray(offset, dtype=float)
    return np.asarray((np.asarray(stroke, dtype=float) + band) / np.cos(edge_angle))
