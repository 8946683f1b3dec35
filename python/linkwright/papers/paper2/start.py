r"""Which start section has the least :math:`\int \dddot x^2 dt`, with what held fixed.

| law | position at its end | acceleration at its begin |
| --- | --- | --- |
| `printed` | 3/5 v t_p | zero |
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
from linkwright.papers.paper2.formulas import Formulas


@dataclass(frozen=True)
class Start:
    """A start section over u from 0 to 1, from rest to the velocity 1.

    Attributes
    ----------
    law : MotionLaw
        x(u).
    """

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
        """∫ jerk² of start and mirrored braking for a stroke of 1 in a time of 1.

        Parameters
        ----------
        share : float
            Of each of the two in the time.
        """
        speed = 1 / (2 * share * self.travel + 1 - 2 * share)
        return 2 * self.cost * speed**2 / share**3

    def to_dict(self) -> dict[str, float]:
        """Its numbers, ready for JSON."""
        names = ("travel", "cost", "acceleration_max", "jerk_max")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class Starts:
    """The printed start beside the minima.

    Attributes
    ----------
    printed, fixed_travel, free_travel, free_acceleration : Start
        As printed; the least for the printed travel; for any travel; and for any acceleration at rest too.
    """

    printed: Start
    fixed_travel: Start
    free_travel: Start
    free_acceleration: Start

    def to_dict(self) -> dict[str, dict[str, float]]:
        """All of them, ready for JSON."""
        return {name: start.to_dict() for name, start in vars(self).items()}


def starts(formulas: Formulas) -> Starts:
    """The printed start section, and those of least ∫ jerk².

    Parameters
    ----------
    formulas : Formulas
        As printed.

    Returns
    -------
    Starts
        By what is held fixed.
    """
    rest, end = {0: 0.0, 1: 0.0, 2: 0.0}, {1: 1.0, 2: 0.0}
    printed = Start(law_of(formulas))
    return Starts(
        printed=printed,
        fixed_travel=Start(optimal(3, rest, {0: printed.travel, **end})),
        free_travel=Start(optimal(3, rest, end)),
        free_acceleration=Start(optimal(3, {0: 0.0, 1: 0.0}, end)),
    )


def law_of(formulas: Formulas) -> MotionLaw:
    """The printed position of the start section as a law over u."""
    from linkwright.cam.laws.piece import Piece

    return MotionLaw((0.0, 1.0), (Piece(tuple(formulas.polynomial("start", 0).coef.tolist())),))
