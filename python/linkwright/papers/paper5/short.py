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

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.topping.constant_speed import constant_speed_lengths
from linkwright.topping.published import length_consistent, length_published
from linkwright.topping.verdict import Claim

Floats = NDArray[np.float64]

# Points of the scan over v_h/v, α and the share of the offsets in the band.
_RATIOS, _ANGLES, _SHARES = 141, 281, 21


@dataclass(frozen=True)
class ShortChecks:
    """The exact length over those of the paper, in the box of its speeds.

    Attributes
    ----------
    bound : float
        2 cos²θ at the greatest v_h/v [–]: nothing is below it.
    least : float
        Least exact length over (10) in the scan [–].
    least_at : tuple of float
        v_h/v [–], α [rad] and share 2Δ/(d + 2Δ) [–] there.
    least_axis : float
        Least without offset [–].
    least_consistent : float
        Least exact length over that by (4) [–].
    chosen : tuple of float
        Least and greatest exact length over (10) for the angle and heads chosen [–].
    chosen_consistent : tuple of float
        The same over that by (4) [–].
    across : float
        The exact length of an edge at rest across the row, over the band of the heads [–].
    across_published : float
        The same by (10) [–].
    """

    bound: float
    least: float
    least_at: tuple[float, float, float]
    least_axis: float
    least_consistent: float
    chosen: tuple[float, float]
    chosen_consistent: tuple[float, float]
    across: float
    across_published: float


def short_checks(claim: Claim, edge_angle: float, offset_share: tuple[float, float]) -> ShortChecks:
    """Scan the box of the speeds.

    Parameters
    ----------
    claim : Claim
        The box.
    edge_angle : float
        α chosen [rad].
    offset_share : tuple of float
        Least and greatest 2Δ/(d + 2Δ) of the heads chosen [–].
    """
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
    return ShortChecks(
        bound=2 / (1 + claim.ratios[1] ** 2),
        least=float(over_10.min()),
        least_at=tuple(float(each[at]) for each in shape),  # type: ignore[arg-type]
        least_axis=float(over_10[..., 0].min()),
        least_consistent=float(over_4.min()),
        chosen=by_10,
        chosen_consistent=by_4,
        across=float(constant_speed_lengths(0.5, 0.25, 0.0, 1.0, 0.0).max()),
        across_published=float(length_published(1.0, 0.0, 0.0)),
    )


def exact_over(ratio: Floats, edge_angle: Floats, offset_share: Floats) -> tuple[Floats, Floats]:
    """The exact length over (10), and over the length by (4), for a band of 1 m [–].

    Parameters
    ----------
    ratio, edge_angle, offset_share : ndarray
        v_h/v [–], α [rad], 2Δ/(d + 2Δ) [–]; they broadcast.
    """
    exact = constant_speed_lengths(1 - offset_share, offset_share / 2, edge_angle, 1.0, ratio).max(axis=0)
    return exact / length_published(1.0, edge_angle, ratio), exact / length_consistent(1.0, edge_angle, ratio)
