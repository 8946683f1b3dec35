r"""The head of a root: a sphere of diameter D cut at the height h_p below its top.

The plane of the cut meets the sphere in a disc of diameter d, above which lies a cap of volume V:

.. math:: d = 2\sqrt{h_p (D - h_p)}, \qquad V = \frac{\pi h_p^2}{3}\left(\frac{3D}{2} - h_p\right).

References
----------
.. [1] Paper 5, d from D and h_p.
.. [2] Bronshtein, Semendyayev, *Handbook of Mathematics*: spherical segment.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def head_diameter(root_diameter: ArrayLike, cut_height: ArrayLike) -> Floats:
    """Diameter d of the disc that is cut.

    Parameters
    ----------
    root_diameter, cut_height : array_like, shape (...)
        D and h_p [m]; they broadcast.

    Returns
    -------
    ndarray, shape (...)
        [m]; zero where the cut passes above or below the root.
    """
    D, h = np.asarray(root_diameter, dtype=float), np.asarray(cut_height, dtype=float)
    return np.asarray(2 * np.sqrt(np.clip(h * (D - h), 0.0, None)))


def cap_volume(root_diameter: ArrayLike, cut_height: ArrayLike) -> Floats:
    """Volume V of the root above the cut.

    Parameters
    ----------
    root_diameter, cut_height : array_like, shape (...)
        D and h_p [m]; they broadcast.

    Returns
    -------
    ndarray, shape (...)
        [m³]; zero where the cut passes above the root, all of the root where it passes below.
    """
    D = np.asarray(root_diameter, dtype=float)
    h = np.clip(np.asarray(cut_height, dtype=float), 0.0, D)
    return np.asarray(np.pi * h**2 * (1.5 * D - h) / 3)
