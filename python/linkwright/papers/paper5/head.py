"""The diameter of the head in paper 5 against the sphere that it is cut from."""

from __future__ import annotations

import numpy as np

from linkwright.topping.head import cap_volume, head_diameter


def head_difference(root_diameter: float) -> float:
    """Greatest difference of the discs from the sphere, as a share of its volume.

    Parameters
    ----------
    root_diameter : float
        D [m].

    Returns
    -------
    float
        Discs of the diameter d piled up over h_p against the cap that they fill [–]. d² is of the second
        degree in h_p, so that Simpson's rule piles them up without error.
    """
    heights = np.linspace(0, root_diameter, 41)
    area = np.pi / 4 * head_diameter(root_diameter, heights) ** 2
    low, middle, high = area[:-2:2], area[1:-1:2], area[2::2]
    piled = np.cumsum((low + 4 * middle + high) * (heights[2] - heights[0]) / 6)
    caps = cap_volume(root_diameter, heights[2::2])
    return float(np.abs(piled - caps).max() / caps[-1])
