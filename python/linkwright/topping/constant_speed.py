r"""The exact length of the edge for a knife that keeps its speed over the head.

The edge, along :math:`(\sin\alpha, \cos\alpha)`, moves with the velocity :math:`(v, \pm v_h)`. It sweeps a
band whose width is its length seen along the way:

.. math:: w = L\,\frac{|v\cos\alpha \mp v_h\sin\alpha|}{\sqrt{v^2 + v_h^2}}.

Heads of diameter d whose centres lie up to Δ to either side of the row take the width
:math:`d + 2\Delta\,v/\sqrt{v^2 + v_h^2}` of it. With the middle of the band over the row all of them are
cut if

.. math:: L \ge \frac{d\sqrt{v^2 + v_h^2} + 2\Delta v}{|v\cos\alpha \mp v_h\sin\alpha|}.

The worse direction is that in which the knife moves towards its leading end. The edge hardly advances there
if :math:`v_h\tan|\alpha|` comes near v: no length does for equality, and beyond it the edge runs backwards
over the head.

References
----------
.. [1] Derived here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

# Normal speed over the speed of the edge below which it moves along itself: the rounding of its terms.
ALONG_ITSELF = 4e-16


def constant_speed_lengths(
    diameter: ArrayLike,
    offset: ArrayLike,
    edge_angle: ArrayLike,
    forward_speed: ArrayLike,
    knife_speed: ArrayLike,
) -> Floats:
    """Minimum length for each direction of the knife.

    Parameters
    ----------
    diameter, offset : array_like, shape (...)
        d of the head and maximum offset Δ [m].
    edge_angle : array_like, shape (...)
        α [rad].
    forward_speed, knife_speed : array_like, shape (...)
        v > 0 and v_h ≥ 0 [m/s]; all broadcast.

    Returns
    -------
    ndarray, shape (2, ...)
        Knife to the left, then to the right [m]; infinite where the edge moves along itself.
    """
    given = diameter, offset, edge_angle, forward_speed, knife_speed
    d, delta, alpha, v, v_h = np.broadcast_arrays(*(np.asarray(each, dtype=float) for each in given))
    speed = np.hypot(v, v_h)
    along, across = v * np.cos(alpha), v_h * np.sin(alpha)
    advance = np.abs(np.stack([along - across, along + across]))
    with np.errstate(divide="ignore"):
        found = (d * speed + 2 * delta * v) / advance
    return np.where(advance > ALONG_ITSELF * speed, found, np.inf)
