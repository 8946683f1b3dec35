"""What a topper cannot do, and what its user should know: sentences with numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.topping.model.topper import Topper
from linkwright.topping.topper import TopperStudy, leaves

# Lengths that differ by less than this share are the same: rounding of their formulas.
_SAME = 1e-12


def topper_findings(described: Topper, found: TopperStudy) -> Iterator[str]:
    """What the knife does not do.

    Parameters
    ----------
    described : Topper
        The topper.
    found : TopperStudy
        Its study.

    Yields
    ------
    str
        Sentences.
    """
    length = described.edge_length
    if found.obstacle:
        yield found.obstacle
    elif not np.isfinite(found.length_exact):
        yield "The edge moves along itself and cuts nothing: no length is enough."
    elif found.length_exact > length * (1 + _SAME) and leaves(found):
        yield (
            f"The edge of {length:.6g} m does not cut through every head: it leaves up to "
            f"{100 * found.uncut_share:.3g} % of {_head(found)}; it needs {found.length_exact:.6g} m."
        )


def _head(found: TopperStudy) -> str:
    """The head of which most is left."""
    place, side = abs(found.uncut_offset), "left" if found.uncut_offset > 0 else "right"
    where = f"a head {place:.4g} m to the {side} of the row" if place else "a head on the row"
    return f"{where}, at the phase {round(np.degrees(found.uncut_phase), 3):.6g}°" if found.stroke else where


def topper_cautions(described: Topper, found: TopperStudy) -> Iterator[str]:
    """What should be known although every head is cut.

    Parameters
    ----------
    described : Topper
        The topper.
    found : TopperStudy
        The study.

    Yields
    ------
    str
        Sentences.
    """
    if described.cut_height > 0.5 * described.root_diameter:
        yield (
            f"The cut passes below the middle of the root, {described.cut_height:.4g} m below its top: the "
            "head is narrower there than the root above it."
        )
    if found.edge_retreats:
        speed = -found.least_advance
        yield (
            f"The edge runs backwards at times, by up to {speed:.4g} m/s along its normal: there its back "
            "meets the head; reduce the edge angle or the knife speed."
        )
