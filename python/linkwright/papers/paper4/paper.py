"""Paper 4 computed anew: the rotator of a sucker-rod string on the pumping unit UP12T-5500.

The paper prints crank, pitman, rear arm, stroke, cable and the place of the pin, but not the radius k_1 of
the horsehead, the extreme angles of the beam, or the place of the crankshaft. What it prints of the
continuous regime determines them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ConvergenceError
from linkwright.kernel.files.library import library_path
from linkwright.kernel.numerics.zeros import zero
from linkwright.machine.read import read
from linkwright.papers.paper import Paper, printed_values
from linkwright.papers.paper4.formulas import LeverFormula, Unit
from linkwright.pumping.rod_rotator import RodRotatorMotion, rod_rotator

# What a unit takes as printed.
_PRINTED = ("r", "L", "k", "l_K", "l_3")

# Newton's method on two smooth equations ends in a handful of steps.
_STEPS = 50


@dataclass(frozen=True)
class Place:
    """A place of the crankshaft that the printed lengths allow."""

    unit: Unit  # the unit with it
    # Minimum angle between pitman and rear arm, or its supplement, over the revolution [rad].
    least_angle: float
    # Angle that the crank turns in the upstroke, counter-clockwise with the well to the right [rad].
    upstroke: float


def recomputed_places(data: dict[str, Any]) -> tuple[Place, ...]:
    """Horsehead, angles of the beam and places of the crankshaft; the larger angle of the pitman first.

    By (7) the printed link and lever are half the sum and half the difference of the diagonal's extremes.
    With α = S/k_1, (5) and (6) are two equations for k_1 and φ_3max; Newton's method solves them. At the
    ends of the stroke crank and pitman are in line, so the crankshaft lies L − r from the end of the rear
    arm at the top and L + r from it at the bottom: two circles, which meet in two points.
    """
    given, lengths = data["given"], data["continuous"]
    m, M = lengths["l_4"] - lengths["l_5"], lengths["l_4"] + lengths["l_5"]

    def gaps(x: Floats) -> Floats:
        k_1, top = x
        least, greatest = _extremes(given, k_1, top)
        return np.array([least - m, greatest - M])

    k_1, top = _newton(gaps, np.array([given["S"], 0.5]))
    high, low = (-given["k"] * np.array([np.cos(at), np.sin(at)]) for at in (top, top - given["S"] / k_1))
    places = [
        _place(Unit(x=float(x), y=float(y), k_1=float(k_1), **{name: given[name] for name in _PRINTED}))
        for x, y in _meets(high, low, given["L"] - given["r"], given["L"] + given["r"])
    ]
    return tuple(sorted(places, key=lambda place: -place.least_angle))


def _extremes(given: dict[str, float], k_1: float, top: float) -> tuple[float, float]:
    """Diagonal at the top and at the bottom, (5) and (6)."""
    l_3, l_K, bottom = given["l_3"], given["l_K"], top - given["S"] / k_1
    least = np.hypot(l_K + l_3 * np.sin(top), k_1 - l_3 * np.cos(top))
    greatest = np.hypot(l_K + given["S"] + l_3 * np.sin(bottom), k_1 - l_3 * np.cos(bottom))
    return float(least), float(greatest)


def _newton(gaps: Callable[[Floats], Floats], x: Floats) -> Floats:
    step = 1e-6
    for _ in range(_STEPS):
        columns = [(gaps(x + at) - gaps(x - at)) / (2 * step) for at in step * np.eye(len(x))]
        change = np.linalg.solve(np.stack(columns, axis=1), gaps(x))
        x = x - change
        if np.abs(change).max() < 1e-13:
            return x
    raise ConvergenceError("Newton's method for horsehead and beam of paper 4 does not converge")


def _meets(first: Floats, second: Floats, a: float, b: float) -> tuple[Floats, Floats]:
    between = second - first
    apart = float(np.hypot(*between))
    along = (a**2 - b**2 + apart**2) / (2 * apart)
    across = np.sqrt(a**2 - along**2)
    unit = between / apart
    foot, normal = first + along * unit, np.array([-unit[1], unit[0]])
    return foot + across * normal, foot - across * normal


def _place(unit: Unit) -> Place:
    K = float(np.hypot(unit.x, unit.y))
    cosines = [
        (unit.L**2 + unit.k**2 - reach**2) / (2 * unit.L * unit.k) for reach in (K - unit.r, K + unit.r)
    ]
    (top, _), (bottom, _) = unit.ends()
    return Place(unit, float(min(np.arccos(abs(cosine)) for cosine in cosines)), (top - bottom) % (2 * np.pi))


def rounded_lengths(data: dict[str, Any]) -> tuple[float, float]:
    """Link and lever with the chosen k_1 and the beam placed so that the printed link comes out."""
    given, wanted, k_1 = data["given"], data["continuous"]["l_4"], data["chosen"]["k_1"]

    def gap(x: Floats) -> Floats:
        return np.array([0.5 * sum(_extremes(given, k_1, float(x[0]))) - wanted])

    top = float(_newton(gap, np.array([0.45]))[0])
    least, greatest = _extremes(given, k_1, top)
    return 0.5 * (least + greatest), 0.5 * (greatest - least)


# Intervals of the revolution.
_ANGLES = 1440

# What counts as nearly a straight line: a degree, the width of a line as figures of angles are printed [rad].
_NEARLY = np.radians(1.0)


@dataclass(frozen=True)
class Paper4(Paper):
    """Paper 4, published against computed."""

    places: tuple[Place, ...]  # places of the crankshaft, the chosen one first
    # Link and lever with k_1 = 3 m, the beam placed so that the link comes out [m].
    rounded: tuple[float, float]
    # The rotators of the library.
    continuous: RodRotatorMotion
    intermittent: RodRotatorMotion
    # Maximum distance of φ_5 from the straight line of one revolution in one revolution, continuous regime
    # [rad].
    straightness: float
    # Crank angles of the machine file between which the printed intermittent lengths close [rad].
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
    """Compute paper 4 anew. Source: Paper 4, whole."""
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
