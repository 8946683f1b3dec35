"""Paper 4 computed anew: the rotator of a sucker-rod string on the pumping unit UP12T-5500.

The paper prints crank, pitman, rear arm, stroke, cable and the place of the pin, but not the radius k_1 of
the horsehead, the extreme angles of the beam, or the place of the crankshaft. What it prints of the
continuous regime determines them: `unit` shows how.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.files.library import library_path
from linkwright.kernel.numerics.roots import zero
from linkwright.machine.read import read
from linkwright.papers.paper import Paper, printed_values
from linkwright.papers.paper4.formulas import LeverFormula, Unit
from linkwright.papers.paper4.unit import Place, recomputed_places, rounded_lengths
from linkwright.pumping.rod_rotator import RodRotatorMotion, rod_rotator

# Intervals of the revolution.
_ANGLES = 1440

# What counts as nearly a straight line: a degree, the width of a line as figures of angles are printed [rad].
_NEARLY = np.radians(1.0)


@dataclass(frozen=True)
class Paper4(Paper):
    """Paper 4, published against computed.

    Attributes
    ----------
    places : tuple of Place
        Places of the crankshaft, the chosen one first.
    rounded : tuple of float
        Link and lever with k_1 = 3 m, the beam placed so that the link comes out [m].
    continuous, intermittent : RodRotatorMotion
        The rotators of the library.
    straightness : float
        Maximum distance of φ_5 from the straight line of one revolution in one revolution, continuous regime
        [rad].
    closing : tuple of float
        Crank angles of the machine file between which the printed intermittent lengths close [rad].
    """

    places: tuple[Place, ...]
    rounded: tuple[float, float]
    continuous: RodRotatorMotion
    intermittent: RodRotatorMotion
    straightness: float
    closing: tuple[float, float]

    @property
    def unit(self) -> Unit:
        """The unit as recomputed."""
        return self.places[0].unit

    @property
    def printed_intermittent(self) -> LeverFormula:
        """The printed lengths of the intermittent regime on the unit."""
        return _printed(self.published, self.unit)

    def quantities(self) -> dict[str, Any]:
        """Lengths [m], angles of the beam [rad], and what the statements of the paper come to."""
        unit, lever, turning = self.unit, self.printed_intermittent, self.continuous
        (_, top), (_, bottom) = unit.ends()
        diagonal, reach = unit.extremes(), lever.l_4 + lever.l_5
        phi = np.linspace(0.0, 2 * np.pi, _ANGLES)
        rates, closes = lever.rocking(phi)[1], lever.closes(phi)
        condition = lever.l_5 + unit.l_6(unit.front(phi)[0]) > unit.l_3 + lever.l_4
        changes_sign = bool(np.nanmin(rates) < 0 < np.nanmax(rates))
        chosen, other = self.places
        # Half of the last digit printed, 0.1 m.
        rounds = abs(self.rounded[1] - self.published["continuous"]["l_5"]) < 0.05
        return {
            "stroke": unit.k_1 * (top - bottom),
            "beam": (top, bottom),
            "diagonal": diagonal,
            "reach": reach,
            "least_lever": 0.5 * (diagonal[1] - diagonal[0]),
            "lengths_close": reach > diagonal[1],
            "lengths_fail": reach <= diagonal[1],
            "rounds_to_printed": rounds,
            "second_jams": other.least_angle < 0.5 * chosen.least_angle and chosen.upstroke > np.pi,
            "is_straight": self.straightness < _NEARLY,
            "turns_once": turning.lever_turns_per_cycle == 1,
            "keeps_sign": turning.transfer_min * turning.transfer_max > 0,
            "has_change_points": len(turning.change_points) == 2,
            "changes_sign": changes_sign,
            "rocks": changes_sign and bool(closes.all()),
            "condition_share": condition.mean(),
            "condition_suffices": bool(closes[condition].all()),
            "swings": self.intermittent.transfer_min < 0 < self.intermittent.transfer_max,
        }

    def entries(self) -> dict[str, Any]:
        """Computed values, ready for JSON."""
        return {
            "recomputed": {
                "k_1": self.unit.k_1,
                "phi_3_max": self.unit.ends()[0][1],
                "phi_3_min": self.unit.ends()[1][1],
                "crankshaft": [[place.unit.x, place.unit.y] for place in self.places],
                "least_angle_of_pitman": [place.least_angle for place in self.places],
                "upstroke_angle": [place.upstroke for place in self.places],
            },
            "with_k_1_of_3_m": {"l_4": self.rounded[0], "l_5": self.rounded[1]},
            "continuous": self.continuous.to_dict(),
            "intermittent": self.intermittent.to_dict(),
            "straightness": self.straightness,
            "printed_intermittent_closes": list(self.closing),
        }


def paper4() -> Paper4:
    """Compute paper 4 anew.

    Source: Paper 4, whole.
    """
    data = printed_values(4)
    places = recomputed_places(data)
    turning, rocking = (
        rod_rotator(read(library_path(f"rod_rotator_{name}")), n=_ANGLES)
        for name in ("continuous", "intermittent")
    )
    off = turning.lever_angle - turning.lever_angle[0] - turning.crank_angle
    return Paper4(
        data,
        places,
        rounded_lengths(data),
        turning,
        rocking,
        straightness=float(0.5 * np.ptp(off)),
        closing=_closing(_printed(data, places[0].unit)),
    )


def _printed(data: dict[str, Any], unit: Unit) -> LeverFormula:
    """Link and lever of the intermittent regime."""
    return LeverFormula(unit, data["intermittent"]["l_4"], data["intermittent"]["l_5"])


def _closing(printed: LeverFormula) -> tuple[float, float]:
    """Crank angles from 12 o'clock between which link and lever reach, where l_d = l_4 + l_5."""
    (top, _), (bottom, _) = printed.unit.ends()

    def spare(phi: float) -> float:
        return printed.l_4 + printed.l_5 - float(printed.unit.diagonal_rates(np.asarray(phi))[0])

    turn = -2 * np.pi if bottom > top else 2 * np.pi
    low, high = sorted(zero(spare, top, far) for far in (bottom, bottom + turn))
    # The machine file counts from 12 o'clock.
    return float((low - np.pi / 2) % (2 * np.pi)), float((high - np.pi / 2) % (2 * np.pi))
