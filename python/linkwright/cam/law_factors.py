r"""How hard a motion law is on the follower: factors of a law of rest to rest.

For a lift h over an angle β in the time T, the peaks are

.. math:: v = C_v \frac hT, \quad a = C_a \frac h{T^2}, \quad j = C_j \frac h{T^3}, \quad
          (v\,a) = C_M \frac{h^2}{T^3}

and C_M is the factor of the torque that inertia asks of the cam's shaft. The integrals are those of the law
brought to a lift and a length of one.

All are exact: the pieces of a law are polynomials and harmonics, and so are their derivatives. Where the
velocity jumps, at an end or inside, the acceleration is infinite there; where the acceleration jumps, the
jerk is. Such a factor is None, and the maximum value between the jumps stands under a name of its own.

Source: VDI 2143 Blatt 1 (1980); Norton, *Cam Design and Manufacturing Handbook* (2002); C_M as in VDI 2143.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.cam.laws.catalogue import LAWS
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.piece import Piece, zeros
from linkwright.kernel.public import public
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result

# A jump below this share of the derivative's maximum value is rounding.
_ROUNDING = 1e-9

_NAMES = ("velocity", "acceleration")


@dataclass(frozen=True)
class LawFactors(Result):
    """Factors of a motion law; all are numbers."""

    C_v: Annotated[float, Label("maximum velocity", "C_v", "")]
    C_a: Annotated[
        float | None, Label("peak absolute value of acceleration", "C_a", "", "None where it is infinite.")
    ]
    C_j: Annotated[
        float | None, Label("peak absolute value of jerk", "C_j", "", "None where it is infinite.")
    ]
    C_M: Annotated[
        float | None,
        Label("peak absolute value of velocity times acceleration", "C_M", "", "None where it is infinite."),
    ]
    acceleration_squared: Annotated[
        float | None, Label("integral of the square of acceleration", "∫a²", "", "None where it is infinite.")
    ]
    jerk_squared: Annotated[
        float | None, Label("integral of the square of jerk", "∫j²", "", "None where it is infinite.")
    ]
    C_a_inside: Annotated[float, Label("peak absolute value of acceleration between the jumps", "", "")]
    C_j_inside: Annotated[float, Label("peak absolute value of jerk between the jumps", "", "")]
    C_M_inside: Annotated[
        float, Label("peak absolute value of velocity times acceleration between the jumps", "", "")
    ]
    acceleration_max: Annotated[float, Label("maximum acceleration between the jumps", "", "")]
    acceleration_min: Annotated[float, Label("minimum acceleration between the jumps", "", "")]
    jerk_max: Annotated[float, Label("maximum jerk between the jumps", "", "")]
    jerk_min: Annotated[float, Label("minimum jerk between the jumps", "", "")]
    remarks: Annotated[tuple[str, ...], About("What jumps, and where.")]


@public
def law_factors(law: MotionLaw) -> LawFactors:
    """Factors of a motion law.

    Parameters
    ----------
    law : MotionLaw
        Between two dwells: what its derivatives are at its ends jumps from and to zero. Its lift must not be
        zero.

    Returns
    -------
    LawFactors
        For a lift and a length of one.
    """
    start = float(law.at(law.start))
    unit = law.scaled(1.0, -start).placed(0.0, 1.0)
    unit = unit.scaled(1 / float(unit.at(1.0, side="before")))
    return _of_unit(unit)


@public
def cam_laws() -> dict[str, LawFactors]:
    """Factors of all laws of the catalogue, with their usual parameters.

    Returns
    -------
    dict of str to LawFactors
        Name → factors, in the order of the catalogue.
    """
    return {name: law_factors(entry.normalised()) for name, entry in LAWS.items()}


def _of_unit(law: MotionLaw) -> LawFactors:
    (low_a, high_a), (low_j, high_j) = (
        [extreme.value for extreme in law.extremes(order)] for order in (2, 3)
    )
    peaks = [max(abs(low), abs(high)) for low, high in ((low_a, high_a), (low_j, high_j))]
    product = _peak_of_product(law)
    jumps = {name: _jumps(law, order) for order, name in enumerate(_NAMES, start=1)}
    hard, rough = bool(jumps["velocity"]), any(jumps.values())
    return LawFactors(
        C_v=abs(law.peak(1).value),
        C_a=None if hard else peaks[0],
        C_j=None if rough else peaks[1],
        C_M=None if hard else product,
        acceleration_squared=None if hard else law.integral_of_square(2),
        jerk_squared=None if rough else law.integral_of_square(3),
        C_a_inside=peaks[0],
        C_j_inside=peaks[1],
        C_M_inside=product,
        acceleration_max=high_a,
        acceleration_min=low_a,
        jerk_max=high_j,
        jerk_min=low_j,
        remarks=tuple(f"{name} jumps {' and '.join(where)}" for name, where in jumps.items() if where),
    )


def _jumps(law: MotionLaw, order: int) -> list[str]:
    """Where a derivative jumps, in words: at the start, inside, at the end."""
    limit = _ROUNDING * max(1.0, abs(law.peak(order).value))
    jumps = {
        "at the start": abs(float(law.at(0.0, order))),
        "inside": float(np.abs(law.jumps(order)).max(initial=0.0)),
        "at the end": abs(float(law.at(1.0, order, "before"))),
    }
    return [where for where, size in jumps.items() if size > limit]


def _peak_of_product(law: MotionLaw) -> float:
    """Peak absolute value of f′ f″: at an end of a piece, or where f″² + f′ f‴ = 0."""
    derivatives = (law.derivative(order).pieces for order in (1, 2, 3))
    return max(_peak_in_piece(v, a, j) for v, a, j in zip(*derivatives, strict=True))


def _peak_in_piece(v: Piece, a: Piece, j: Piece) -> float:
    degree = 2 * max(len(v.polynomial) - 1, 0)
    turns = zeros(lambda u: a.at(u) ** 2 + v.at(u) * j.at(u), degree, 2 * v.waves)
    u = np.array([0.0, *turns, 1.0])
    return float(np.abs(v.at(u) * a.at(u)).max())
