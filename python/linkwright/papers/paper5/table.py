"""For which heads the result of paper 5 holds, as tables over the angle of the edge."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.papers.paper5.rows import millimetres
from linkwright.topping.verdict import WAYS

if TYPE_CHECKING:
    from linkwright.papers.paper5.paper import Paper5

# Heads: the angle, then a way each.
HEADS = ("α", *WAYS.values())


def band_cells(paper: Paper5) -> list[list[str]]:
    """Bands d + 2Δ for which the result holds.

    Parameters
    ----------
    paper : Paper5
        What was computed.

    Returns
    -------
    list of list of str
        A row an angle, a text a way.
    """
    return [
        [
            _degrees(verdict.edge_angle),
            *(millimetres(each.band_low, each.band_high) for each in verdict.demands),
        ]
        for verdict in paper.verdict.angles
    ]


def offset_cells(paper: Paper5) -> list[list[str]]:
    """Offsets Δ of the largest head for which the result holds.

    Parameters
    ----------
    paper : Paper5
        What was computed.

    Returns
    -------
    list of list of str
        A row an angle, a text a way.
    """
    found = paper.verdict
    return [
        [_degrees(verdict.edge_angle), *(millimetres(*each[row]) for each in found.offsets.values())]
        for row, verdict in enumerate(found.angles)
    ]


def tables(paper: Paper5) -> tuple[tuple[str, list[list[str]]], ...]:
    """Both tables, with their titles.

    Parameters
    ----------
    paper : Paper5
        What was computed.
    """
    chosen = paper.published["chosen"]
    D, h_p = 1e3 * chosen["root_diameters"][1], 1e3 * chosen["cut_height"]
    return (
        ("Band d + 2Δ", band_cells(paper)),
        (f"Offset Δ, roots up to D = {D:g} mm cut at h_p = {h_p:g} mm", offset_cells(paper)),
    )


def about(paper: Paper5) -> str:
    """What the tables tell.

    Parameters
    ----------
    paper : Paper5
        What was computed.
    """
    found, (slow, fast) = paper.verdict, paper.verdict.claim.forward_speeds
    low, high = found.claim.knife_speeds
    return (
        f"The longest edge needed over v = {slow:g}…{fast:g} m/s and v_h = {low:g}…{high:g} m/s lies in "
        f"{found.claim.lengths[0]:.2f}…{found.claim.lengths[1]:.2f} m. For the band the offsets take "
        f"{100 * found.shares[0]:.0f} % of it, which matters for the exact length at constant speed only; "
        f"every phase is that of a harmonic knife with a stroke of {1e3 * found.stroke.length:g} mm."
    )


def _degrees(angle: float) -> str:
    return f"{np.degrees(angle):.0f}°"
