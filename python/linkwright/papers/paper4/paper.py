"""Paper 4 computed anew: the rotator of a sucker-rod string on the pumping unit UP12T-5500.

The paper prints crank, pitman, rear arm, stroke, cable and the place of the pin, but not the radius k_1 of
the horsehead, the extreme angles of the beam, or the place of the crankshaft. What it prints of the
continuous regime determines them: `paper4_unit` shows how.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.files.library import library_path
from linkwright.kernel.numerics.roots import zero
from linkwright.machine.read import read
from linkwright.papers.paper4.conclusions import conclusions
from linkwright.papers.paper4.formulas import LeverFormula, Unit
from linkwright.papers.paper4.rows import rows_of
from linkwright.papers.paper4.unit import Place, recomputed_places, rounded_lengths
from linkwright.papers.published import printed_values
from linkwright.papers.row import Row
from linkwright.pumping.rod_rotator import RodRotatorMotion, rod_rotator
from linkwright.pumping.unit import PumpingUnitMotion, pumping_unit

Floats = NDArray[np.float64]

# Intervals of the turn.
_ANGLES = 1440


@dataclass(frozen=True)
class Paper4:
    """Paper 4, published against computed.

    Attributes
    ----------
    published : dict
        What is printed.
    places : tuple of Place
        Places of the crankshaft, the chosen one first.
    rounded : tuple of float
        Link and lever with k_1 = 3 m, the beam placed so that the link comes out [m].
    motion : PumpingUnitMotion
        The unit.
    continuous, intermittent : RodRotatorMotion
        The rotators of the library.
    straightness : float
        Greatest distance of φ_5 from the straight line of one turn in a turn, continuous regime [rad].
    closing : tuple of float
        Crank angles of the machine file between which the printed intermittent lengths close [rad].
    rows : tuple of Row
        Every printed number with its verdict.
    """

    published: dict[str, Any]
    places: tuple[Place, ...]
    rounded: tuple[float, float]
    motion: PumpingUnitMotion
    continuous: RodRotatorMotion
    intermittent: RodRotatorMotion
    straightness: float
    closing: tuple[float, float]
    rows: tuple[Row, ...]

    @property
    def number(self) -> int:
        """Of the paper."""
        return int(self.published["number"])

    @property
    def title(self) -> str:
        """Of the paper, in English."""
        return str(self.published["title"])

    @property
    def unit(self) -> Unit:
        """The unit as recomputed."""
        return self.places[0].unit

    @property
    def printed_intermittent(self) -> LeverFormula:
        """The printed lengths of the intermittent regime on the unit."""
        given = self.published["intermittent"]
        return LeverFormula(self.unit, given["l_4"], given["l_5"])

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "recomputed": {
                "k_1": self.unit.k_1,
                "phi_3_max": self.unit.ends()[0][1],
                "phi_3_min": self.unit.ends()[1][1],
                "crankshaft": [[each.unit.x, each.unit.y] for each in self.places],
                "least_angle_of_pitman": [each.least_angle for each in self.places],
                "upstroke_angle": [each.upstroke for each in self.places],
            },
            "with_k_1_of_3_m": {"l_4": self.rounded[0], "l_5": self.rounded[1]},
            "continuous": self.continuous.to_dict(),
            "intermittent": self.intermittent.to_dict(),
            "straightness": self.straightness,
            "printed_intermittent_closes": list(self.closing),
            "rows": [vars(row) for row in self.rows],
            "conclusions": conclusions(self),
        }


def paper4() -> Paper4:
    """Compute paper 4 anew.

    Returns
    -------
    Paper4
        Published and computed values with verdicts.

    References
    ----------
    .. [1] Paper 4, whole.
    """
    data = printed_values(4)
    places = recomputed_places(data)
    continuous, intermittent = (
        read(library_path(f"rod_rotator_{name}")) for name in ("continuous", "intermittent")
    )
    turning, rocking = (rod_rotator(each, n=_ANGLES) for each in (continuous, intermittent))
    motion = pumping_unit(continuous, n=_ANGLES)
    off = turning.lever_angle - turning.lever_angle[0] - turning.crank_angle
    straightness = float(0.5 * np.ptp(off))
    unit = places[0].unit
    printed = LeverFormula(unit, data["intermittent"]["l_4"], data["intermittent"]["l_5"])
    closing = _closing(printed)
    rounded = rounded_lengths(data)
    found = rows_of(data, places, rounded, turning, printed, closing, straightness)
    return Paper4(data, places, rounded, motion, turning, rocking, straightness, closing, found)


def _closing(printed: LeverFormula) -> tuple[float, float]:
    """Crank angles from 12 o'clock between which link and lever reach, where l_d = l_4 + l_5."""
    (top, _), (bottom, _) = printed.unit.ends()

    def spare(phi: float) -> float:
        return printed.l_4 + printed.l_5 - float(printed.unit.diagonal_rates(np.asarray(phi))[0])

    edges = []
    for far in (bottom, bottom - 2 * np.pi if bottom > top else bottom + 2 * np.pi):
        edges.append(zero(spare, top, far))
    low, high = sorted(edges)
    # The machine file counts from 12 o'clock.
    return float((low - np.pi / 2) % (2 * np.pi)), float((high - np.pi / 2) % (2 * np.pi))
