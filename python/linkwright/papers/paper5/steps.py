r"""Step of the knife, short strokes, and the surface of lengths of paper 5.

With :math:`\tan\theta = v_h/v` the printed length (10) and the exact one are

.. math:: L_{10} = (d + 2\Delta)\frac{\sin(\alpha + \theta)}{\cos\theta}, \qquad
    L = \frac{d + 2\Delta\cos\theta}{|\cos(\alpha + \theta)|}.

Since d + 2Δ cos θ is at least (d + 2Δ) cos θ,

.. math:: \frac{L}{L_{10}} \ge \frac{2\cos^2\theta}{|\sin 2(\alpha + \theta)|} \ge 2\cos^2\theta .

For v_h ≤ v, θ ≤ 45°, that is at least one: the printed length is too short for all angles, heads and offsets,
the more so the slower the knife. Equality needs a head of no size at α = 45° − θ; with no offset the bound is
2 cos θ. Only a knife faster than the machine can make (10) long enough.

The scan here examines what is proved, and the length by (4), for which there is no such short proof.

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

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.papers.published_lengths import Claim
from linkwright.topping.required_length import (
    PublishedLengths,
    constant_speed_lengths,
    length_consistent,
    length_published,
    published_lengths,
)
from linkwright.topping.roots import cap_volume, head_diameter

# Points of the scan over v_h/v, α and the share of the offsets in the band.
_RATIOS, _ANGLES, _SHARES = 141, 281, 21


def short_checks(claim: Claim, edge_angle: float, offset_share: tuple[float, float]) -> dict[str, Any]:
    """Scan the box of the speeds; α [rad] and extremes of 2Δ/(d + 2Δ) are chosen. Ratios of lengths [–]."""
    ratios = np.linspace(*claim.ratios, _RATIOS)
    shape = np.meshgrid(
        ratios, np.radians(np.linspace(0, 70, _ANGLES)), np.linspace(0, 1, _SHARES), indexing="ij"
    )
    over_10, over_4 = exact_over(*shape)
    at = np.unravel_index(np.argmin(over_10), over_10.shape)
    chosen = exact_over(
        *np.meshgrid(ratios, [edge_angle], np.linspace(*offset_share, _SHARES), indexing="ij")
    )
    (by_10, by_4) = ((float(check.min()), float(check.max())) for check in chosen)
    return {
        # 2 cos²θ at the maximum v_h/v: nothing is below it.
        "bound": 2 / (1 + claim.ratios[1] ** 2),
        # Minimum exact length over (10), and v_h/v, α and share of the offsets there; the minimum without
        # offset.
        "least": float(over_10.min()),
        "least_at": [float(check[at]) for check in shape],
        "least_axis": float(over_10[..., 0].min()),
        # Minimum over the length by (4); extremes over both for the angle and heads chosen.
        "least_consistent": float(over_4.min()),
        "chosen": by_10,
        "chosen_consistent": by_4,
        # The length of an edge at rest across the row over the band of the heads, exact and by (10).
        "across": float(constant_speed_lengths(0.5, 0.25, 0.0, 1.0, 0.0).max()),
        "across_published": float(length_published(1.0, 0.0, 0.0)),
    }


def exact_over(ratio: Floats, edge_angle: Floats, offset_share: Floats) -> tuple[Floats, Floats]:
    """The exact length over (10) and over that by (4), of v_h/v, α [rad], 2Δ/(d + 2Δ), which broadcast."""
    exact = constant_speed_lengths(1 - offset_share, offset_share / 2, edge_angle, 1.0, ratio).max(axis=0)
    return exact / length_published(1.0, edge_angle, ratio), exact / length_consistent(1.0, edge_angle, ratio)


# Points along both axes.
_POINTS = 61


@dataclass(frozen=True)
class Surface:
    """Lengths at one forward speed."""

    forward_speed: float  # v [m/s]
    # D [m] and v_h [m/s], shape (n,).
    root_diameters: Floats
    knife_speeds: Floats
    # By (10), and exact for constant speed [m], shape (n, n): a row for each v_h.
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


# Angles at which identities are examined: every half degree of what the formulas are good for.
_STEP_ANGLES = np.radians(np.arange(0.5, 85.0, 0.5))

# Share of a length by which an edge is made shorter and longer to see (1) break and hold.
_HAIR = 1e-9


def step_checks(angles: Floats, ratio: float) -> dict[str, Any]:
    """The step from (4) to (5) at angles α of a table [rad], for the maximum v_h/v."""
    cos, sin = np.cos(_STEP_ANGLES), np.sin(_STEP_ANGLES)
    closed = 1 + (1 - cos) * (1 + 2 * cos) / cos**2
    travel = 1 - sin**2 * (1 - cos)
    return {
        "angles": angles,
        # What (4) has before v_h/v over what (5) has there; t_y/t_x of an edge as long as (5) says.
        "factors": factors(angles),
        "times": np.array([_at_printed_length(angle, ratio) for angle in angles.tolist()]),
        # The length by (4) over that by (5); S_x over the travel that passes the head, knife at rest.
        "longer": length_consistent(1.0, angles, ratio) / length_published(1.0, angles, ratio),
        "travels": _travels(angles),
        # Maximum differences of factors and travels from their closed forms.
        "identity": float(np.abs(factors(_STEP_ANGLES) / closed - 1).max()),
        "travel_identity": float(np.abs(_travels(_STEP_ANGLES) - travel).max()),
        # Whether (1) breaks a hair below the length by (4), and holds a hair above, at every angle.
        "flips": all(_flips(angle, ratio) for angle in _STEP_ANGLES.tolist()),
    }


def factors(angles: Floats) -> Floats:
    """What (4) has before v_h/v over what (5) has there [–]: rise of both lengths with v_h/v."""
    by_4, by_5 = (
        length(1.0, angles, 1.0) - length(1.0, angles, 0.0)
        for length in (length_consistent, length_published)
    )
    return np.asarray(by_4 / by_5)


def _travels(angles: Floats) -> Floats:
    return np.array([_edge(angle, 1.0, 1.0).travel_along * np.cos(angle) for angle in angles.tolist()])


def _edge(angle: float, length: float, ratio: float) -> PublishedLengths:
    """An edge over a head of 1 m at v = 1 m/s."""
    return published_lengths(1.0, angle, length, 1.0, ratio)


def _at_printed_length(angle: float, ratio: float) -> float:
    edge = _edge(angle, float(length_published(1.0, angle, ratio)), ratio)
    return edge.time_across / edge.time_along


def _flips(angle: float, ratio: float) -> bool:
    length = float(length_consistent(1.0, angle, ratio))
    short, long = (_edge(angle, length * (1 + hair), ratio).holds for hair in (-_HAIR, _HAIR))
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
