r"""Which start section has the minimum :math:`\int \dddot x^2 dt`, with what held fixed.

| law | position at its end | acceleration at its begin |
| --- | --- | --- |
| `printed`, `fixed_travel` | 3/5 v t_p | zero |
| `free_travel` | free | zero |
| `free_acceleration` | free | free |

Euler's equation is :math:`x^{(6)} = 0`. A position that is free at the end adds :math:`x^{(5)} = 0` there,
an acceleration that is free at the begin :math:`\dddot x = 0` there (`linkwright.cam.laws.optimal`). The
jerk at an end cannot be prescribed: it may be changed there over a time as short as you like, at no cost.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.optimal import optimal
from linkwright.cam.laws.piece import Piece
from linkwright.papers.paper2.formulas import Formulas


@dataclass(frozen=True)
class Start:
    """A start section x(u) over u from 0 to 1, from rest to the velocity 1."""

    law: MotionLaw

    @property
    def travel(self) -> float:
        """Over v t_p [–]."""
        return float(self.law.at(1.0))

    @property
    def cost(self) -> float:
        """∫ jerk² over v²/t_p³ [–]."""
        return self.law.integral_of_square(3)

    @property
    def acceleration_max(self) -> float:
        """Over v/t_p [–]."""
        return self.law.peak(2).value

    @property
    def jerk_max(self) -> float:
        """Largest in size, over v/t_p² [–]."""
        return abs(self.law.peak(3).value)

    def over_stroke(self, share: float) -> float:
        """∫ jerk² of start and mirrored braking for a stroke of 1 in a time of 1, each a share of it."""
        speed = 1 / (2 * share * self.travel + 1 - 2 * share)
        return 2 * self.cost * speed**2 / share**3

    def to_dict(self) -> dict[str, float]:
        """Its numbers, ready for JSON."""
        return {name: getattr(self, name) for name in ("travel", "cost", "acceleration_max", "jerk_max")}


def starts(formulas: Formulas) -> dict[str, Start]:
    """The printed start section, and those of minimum ∫ jerk² by what is held fixed: the table above."""
    rest, end = {0: 0.0, 1: 0.0, 2: 0.0}, {1: 1.0, 2: 0.0}
    piece = Piece(tuple(formulas.polynomial("start", 0).coef.tolist()))
    printed = Start(MotionLaw((0.0, 1.0), (piece,)))
    return {
        "printed": printed,
        "fixed_travel": Start(optimal(3, rest, {0: printed.travel, **end})),
        "free_travel": Start(optimal(3, rest, end)),
        "free_acceleration": Start(optimal(3, {0: 0.0, 1: 0.0}, end)),
    }
