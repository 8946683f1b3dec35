r"""The step of paper 5 from its condition (4) to its length (5).

(4) divided by cos α has :math:`S_x/\cos\alpha = d(1 + \tan\alpha\sin\alpha)` before :math:`v_h/v`; (5) has
d cos α there. The first over the second is

.. math:: \frac{\cos\alpha + \sin^2\alpha}{\cos^2\alpha}
    = 1 + \frac{(1 - \cos\alpha)(1 + 2\cos\alpha)}{\cos^2\alpha},

one at α = 0 alone. (5) would follow from :math:`S_x = d\cos^2\alpha`. A knife as long as (5) says has crossed
after the inverse of this factor of the time that (1) asks for.

The travel itself is short as well: with the knife at rest the edge passes the head in :math:`d/\cos\alpha`,
and :math:`S_x\cos\alpha/d = 1 - \sin^2\alpha\,(1 - \cos\alpha)`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.topping.required_length import (
    PublishedLengths,
    constant_speed_lengths,
    length_consistent,
    length_published,
    published_lengths,
)
from linkwright.topping.roots import cap_volume, head_diameter

Floats = NDArray[np.float64]

# Angles at which identities are looked at: every half degree of what the formulas are good for.
_ANGLES = np.radians(np.arange(0.5, 85.0, 0.5))

# Share of a length by which an edge is made shorter and longer to see (1) break and hold.
_HAIR = 1e-9


def step_checks(angles: Floats, ratio: float) -> dict[str, Any]:
    """The step from (4) to (5) at angles α of a table [rad], for the maximum v_h/v."""
    cos, sin = np.cos(_ANGLES), np.sin(_ANGLES)
    closed = 1 + (1 - cos) * (1 + 2 * cos) / cos**2
    travel = 1 - sin**2 * (1 - cos)
    return {
        "angles": angles,
        # What (4) has before v_h/v over what (5) has there; t_y/t_x of an edge as long as (5) says.
        "factors": factors(angles),
        "times": np.array([_at_printed_length(each, ratio) for each in angles.tolist()]),
        # The length by (4) over that by (5); S_x over the travel that passes the head, knife at rest.
        "longer": length_consistent(1.0, angles, ratio) / length_published(1.0, angles, ratio),
        "travels": _travels(angles),
        # Maximum differences of factors and travels from their closed forms.
        "identity": float(np.abs(factors(_ANGLES) / closed - 1).max()),
        "travel_identity": float(np.abs(_travels(_ANGLES) - travel).max()),
        # Whether (1) breaks a hair below the length by (4), and holds a hair above, at every angle.
        "flips": all(_flips(each, ratio) for each in _ANGLES.tolist()),
    }


def factors(angles: Floats) -> Floats:
    """What (4) has before v_h/v over what (5) has there [–]: rise of both lengths with v_h/v."""
    by_4, by_5 = (
        each(1.0, angles, 1.0) - each(1.0, angles, 0.0) for each in (length_consistent, length_published)
    )
    return np.asarray(by_4 / by_5)


def _travels(angles: Floats) -> Floats:
    return np.array([_edge(each, 1.0, 1.0).travel_along * np.cos(each) for each in angles.tolist()])


def _edge(angle: float, length: float, ratio: float) -> PublishedLengths:
    """An edge over a head of 1 m at v = 1 m/s."""
    return published_lengths(1.0, angle, length, 1.0, ratio)


def _at_printed_length(angle: float, ratio: float) -> float:
    found = _edge(angle, float(length_published(1.0, angle, ratio)), ratio)
    return found.time_across / found.time_along


def _flips(angle: float, ratio: float) -> bool:
    length = float(length_consistent(1.0, angle, ratio))
    short, long = (_edge(angle, length * (1 + each), ratio).holds for each in (-_HAIR, _HAIR))
    return long and not short


def condition_suffices(angles: Floats) -> bool:
    """Whether no edge meets (1) that is shorter than a head needs, its knife at rest."""
    shortest = np.sin(angles) + _HAIR
    meets = [
        _edge(a, length, 0.0).holds for a, length in zip(angles.tolist(), shortest.tolist(), strict=True)
    ]
    needed = constant_speed_lengths(1.0, 0.0, angles, 1.0, 0.0).max(axis=0)
    return not bool((np.array(meets) & (shortest < needed)).any())


def head_difference(root_diameter: float) -> float:
    """Discs of the printed diameter piled up over h_p against the cap of a sphere D [m] that they fill [–].

    d² is of the second degree in h_p, so that Simpson's rule piles them up without error.
    """
    heights = np.linspace(0, root_diameter, 41)
    area = np.pi / 4 * head_diameter(root_diameter, heights) ** 2
    low, middle, high = area[:-2:2], area[1:-1:2], area[2::2]
    piled = np.cumsum((low + 4 * middle + high) * (heights[2] - heights[0]) / 6)
    caps = cap_volume(root_diameter, heights[2::2])
    return float(np.abs(piled - caps).max() / caps[-1])
