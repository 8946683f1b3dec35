r"""How much the lengths of paper 5 fall short of what a knife of constant speed needs.

With :math:`\tan\theta = v_h/v` the printed length (10) and the exact one are

.. math:: L_{10} = (d + 2\Delta)\frac{\sin(\alpha + \theta)}{\cos\theta}, \qquad
    L = \frac{d + 2\Delta\cos\theta}{|\cos(\alpha + \theta)|}.

Since d + 2Δ cos θ is at least (d + 2Δ) cos θ,

.. math:: \frac{L}{L_{10}} \ge \frac{2\cos^2\theta}{|\sin 2(\alpha + \theta)|} \ge 2\cos^2\theta .

For v_h ≤ v, θ ≤ 45°, that is at least one: the printed length is too short for all angles, heads and offsets,
the more so the slower the knife. Equality needs a head of no size at α = 45° − θ; with no offset the bound is
2 cos θ. Only a knife faster than the machine can make (10) long enough.

The scan here looks at what is proved, and at the length by (4), for which there is no such short proof.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.topping.required_length import constant_speed_lengths, length_consistent, length_published
from linkwright.topping.verdict import Claim

Floats = NDArray[np.float64]

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
    (by_10, by_4) = ((float(each.min()), float(each.max())) for each in chosen)
    return {
        # 2 cos²θ at the maximum v_h/v: nothing is below it.
        "bound": 2 / (1 + claim.ratios[1] ** 2),
        # Minimum exact length over (10), and v_h/v, α and share of the offsets there; the minimum without
        # offset.
        "least": float(over_10.min()),
        "least_at": [float(each[at]) for each in shape],
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
