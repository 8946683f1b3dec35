"""What a synthesis returns is analysed again, and must be what was asked for."""

from __future__ import annotations

import numpy as np

from linkwright.kernel.errors import SynthesisError
from linkwright.linkages.cycle import ElementMotion, linkage
from linkwright.machine.machine import Machine

# Share by which a linkage may miss what was asked for. Lengths and places are good to some 1e-16 of the
# longest link; a crank of a ten-thousandth of it, with dead centres among such numbers, keeps seven digits.
MET = 1e-6


def require_met(
    what: str, wanted: float, found: float | None, unit: str = "", size: float | None = None
) -> None:
    """Raise unless a linkage has what was asked for.

    `wanted`, `found`: what was asked for, and what the analysis of the machine finds; None if it has no such
    thing; `unit`: unit of both, for the message; angles in ``"rad"`` are reported in degrees; `size`: what
    the difference is compared with, instead of the wanted value.
    """
    size = abs(wanted) if size is None else size
    # "not less or equal" holds for NaN too.
    if found is None or not abs(found - wanted) <= MET * size:
        factor, unit = (180 / np.pi, "°") if unit == "rad" else (1.0, f" {unit}".rstrip())
        has = "none" if found is None else f"{factor * found:.9g}{unit}"
        raise SynthesisError(
            f"the linkage made for {what} of {factor * wanted:.9g}{unit} has {has} when it is analysed "
            "again: its links are too unlike in length; ask for something less extreme"
        )


def element_of(machine: Machine, output: str) -> ElementMotion:
    """The motion of one output of a machine, by its analysis.

    `output`: name of the link or slide.
    """
    return next(each for each in linkage(machine).elements if each.output == output)


def require_transmission(wanted: float, found: ElementMotion) -> None:
    """Raise unless the minimum transmission angle over a revolution is the one that is returned.

    `wanted`: the one that is returned [rad]; `found`: by the analysis of the machine.
    """
    low, high = found.transmission_angle_min, found.transmission_angle_max
    least = None if low is None or high is None else min(low, np.pi - high)
    require_met("a minimum transmission angle", wanted, least, "rad", size=1.0)
