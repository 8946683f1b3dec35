"""Where a lift or one of its derivatives jumps, the ends of the law included."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.errors import InputError

Floats = NDArray[np.float64]
Ends = Literal["dwell", "turn"]

# Share of a derivative's own size below which a jump is rounding of the law's coefficients.
_ROUNDING = 1e-9


def steps(law: MotionLaw, order: int, ends: Ends) -> Floats:
    """By how much a derivative jumps at each break, (pieces + 1,)."""
    first, last = float(law.at(law.start, order)), float(law.at(law.end, order, "before"))
    outer = [first - last, 0.0] if ends == "turn" else [first, -last]
    found = np.concatenate([outer[:1], law.jumps(order), outer[1:]])
    if ends == "dwell" and order == 0:
        # A dwell may be at any height.
        found[[0, -1]] = 0.0
    return np.where(np.abs(found) > _ROUNDING * size(law, order), found, 0.0)


def size(law: MotionLaw, order: int) -> float:
    """How large a derivative becomes, by itself or by what it would be for so much lift."""
    places = np.linspace(law.start, law.end, 65)
    heights = [float(np.ptp(law.at(places))) / law.length**order, float(np.abs(law.at(places, order)).max())]
    return max(heights)


def continuity(law: MotionLaw, ends: Ends, most: int = 6) -> int:
    """The highest order up to which the law and all its derivatives have no jump."""
    for order in range(most + 1):
        if steps(law, order, ends).any():
            return order - 1
    return most


def without_steps(law: MotionLaw, ends: Ends) -> None:
    """Raise if the lift itself jumps."""
    if ends == "turn" and abs(law.length - 2 * np.pi) > 1e-9:
        raise InputError(
            f"lift: found a law over {law.length:.9g} rad, expected one revolution, {2 * np.pi:.9g} rad"
        )
    jumps = steps(law, 0, ends)
    if jumps.any():
        k = int(np.flatnonzero(jumps)[0])
        raise InputError(f"lift: found a jump by {jumps[k]:.6g} m at {law.breaks[k]:.6g} rad, expected none")
