"""Figure 3 of paper 5: the length of the edge over root diameter and knife speed, for each forward speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.topping.required_length import constant_speed_lengths, length_published
from linkwright.topping.roots import head_diameter

Floats = NDArray[np.float64]

# Points along both axes.
_POINTS = 61


@dataclass(frozen=True)
class Surface:
    """Lengths at one forward speed.

    Attributes
    ----------
    forward_speed : float
        v [m/s].
    root_diameters, knife_speeds : ndarray
        D [m] and v_h [m/s], shape (n,).
    published, exact : ndarray
        By (10), and exact for constant speed [m], shape (n, n): a row for each v_h.
    """

    forward_speed: float
    root_diameters: Floats
    knife_speeds: Floats
    published: Floats
    exact: Floats

    @property
    def published_range(self) -> tuple[float, float]:
        """Extremes by (10) [m]."""
        return float(self.published.min()), float(self.published.max())

    @property
    def exact_range(self) -> tuple[float, float]:
        """Exact extremes [m]."""
        return float(self.exact.min()), float(self.exact.max())

    def to_dict(self) -> dict[str, Any]:
        """Its extremes, ready for JSON."""
        return {
            "forward_speed": self.forward_speed,
            "length_published": list(self.published_range),
            "length_exact_constant_speed": list(self.exact_range),
        }


def surfaces(data: dict[str, Any]) -> tuple[Surface, ...]:
    """One for each forward speed, from printed and chosen values."""
    given, chosen = data["given"], data["chosen"]
    D, v_h = (
        np.linspace(low, high, _POINTS) for low, high in (chosen["root_diameters"], given["knife_speeds"])
    )
    alpha, delta = np.radians(chosen["edge_angle"]), chosen["offset"]
    d = head_diameter(D, chosen["cut_height"])
    return tuple(
        Surface(
            v,
            D,
            v_h,
            length_published(d + 2 * delta, alpha, v_h[:, None] / v),
            constant_speed_lengths(d, delta, alpha, v, v_h[:, None]).max(axis=0),
        )
        for v in given["forward_speeds"]
    )
