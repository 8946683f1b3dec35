"""Paper 4 computed anew: the rotator of a sucker-rod string on the pumping unit UP12T-5500.

The paper prints crank, pitman, rear arm, stroke, cable and the place of the pin, but not the radius k_1 of
the horsehead, the extreme angles of the beam, or the place of the crankshaft. What it prints of the
continuous regime determines them: `recomputed_unit` shows how.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.pumping_unit import PumpingUnitMotion, pumping_unit
from linkwright.analysis.rod_rotator import RodRotatorMotion, rod_rotator
from linkwright.errors import ConvergenceError
from linkwright.files.library import library_path
from linkwright.files.read import read
from linkwright.papers.cell import Cell
from linkwright.papers.paper4_conclusions import conclusions
from linkwright.papers.paper4_formulas import LeverFormula, Unit

Floats = NDArray[np.float64]

# Intervals of the turn.
_ANGLES = 1440

# Newton's method on two smooth equations ends in a handful of steps.
_STEPS = 50


@dataclass(frozen=True)
class Place:
    """A place of the crankshaft that the printed lengths allow.

    Attributes
    ----------
    unit : Unit
        The unit with it.
    least_angle : float
        Least angle between pitman and rear arm, or its supplement, over the turn [rad].
    upstroke : float
        Angle that the crank turns in the upstroke, counter-clockwise with the well to the right [rad].
    """

    unit: Unit
    least_angle: float
    upstroke: float


@dataclass(frozen=True)
class Row:
    """One printed number or statement, and what comes out.

    Attributes
    ----------
    name, printed, computed, verdict : str
        In words, with units.
    kind : str
        ``"reproduced"``, ``"near"``, ``"far"`` or ``"none"``.
    """

    name: str
    printed: str
    computed: str
    verdict: str
    kind: str


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


@cache
def published4() -> dict[str, Any]:
    """The printed values of paper 4."""
    return tomllib.loads(files("linkwright.papers").joinpath("paper4.toml").read_text(encoding="utf-8"))


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
    data = published4()
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
    rounded = _rounded(data)
    found = _rows(data, places, rounded, turning, printed, closing, straightness)
    return Paper4(data, places, rounded, motion, turning, rocking, straightness, closing, found)


def recomputed_places(data: dict[str, Any]) -> tuple[Place, ...]:
    """Horsehead, angles of the beam and places of the crankshaft from what is printed.

    Parameters
    ----------
    data : dict
        Printed values.

    Returns
    -------
    tuple of Place
        The one with the larger angle between pitman and rear arm first.

    Notes
    -----
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
    found = [
        _place(
            Unit(
                r=given["r"],
                L=given["L"],
                k=given["k"],
                k_1=float(k_1),
                x=float(x),
                y=float(y),
                l_K=given["l_K"],
                l_3=given["l_3"],
            )
        )
        for x, y in _meets(high, low, given["L"] - given["r"], given["L"] + given["r"])
    ]
    return tuple(sorted(found, key=lambda each: -each.least_angle))


def _extremes(given: dict[str, float], k_1: float, top: float) -> tuple[float, float]:
    """Diagonal at the top and at the bottom, (5) and (6)."""
    l_3, l_K, bottom = given["l_3"], given["l_K"], top - given["S"] / k_1
    least = np.hypot(l_K + l_3 * np.sin(top), k_1 - l_3 * np.cos(top))
    greatest = np.hypot(l_K + given["S"] + l_3 * np.sin(bottom), k_1 - l_3 * np.cos(bottom))
    return float(least), float(greatest)


def _newton(gaps: Callable[[Floats], Floats], x: Floats) -> Floats:
    """Root of smooth equations, the Jacobian by central differences.

    Raises
    ------
    ConvergenceError
        There is no root near the start.
    """
    step = 1e-6
    for _ in range(_STEPS):
        columns = [(gaps(x + at) - gaps(x - at)) / (2 * step) for at in step * np.eye(len(x))]
        change = np.linalg.solve(np.stack(columns, axis=1), gaps(x))
        x = x - change
        if np.abs(change).max() < 1e-13:
            return x
    raise ConvergenceError("Newton's method for horsehead and beam of paper 4 does not converge")


def _meets(first: Floats, second: Floats, a: float, b: float) -> tuple[Floats, Floats]:
    """Where circles of radii a about the first and b about the second point meet."""
    between = second - first
    apart = float(np.hypot(*between))
    along = (a**2 - b**2 + apart**2) / (2 * apart)
    across = np.sqrt(a**2 - along**2)
    unit = between / apart
    foot, normal = first + along * unit, np.array([-unit[1], unit[0]])
    return foot + across * normal, foot - across * normal


def _place(unit: Unit) -> Place:
    """What a place of the crankshaft does to the unit."""
    K = float(np.hypot(unit.x, unit.y))
    cosines = [
        (unit.L**2 + unit.k**2 - reach**2) / (2 * unit.L * unit.k) for reach in (K - unit.r, K + unit.r)
    ]
    (top, _), (bottom, _) = unit.ends()
    return Place(unit, float(min(np.arccos(abs(each)) for each in cosines)), (top - bottom) % (2 * np.pi))


def _rounded(data: dict[str, Any]) -> tuple[float, float]:
    """Link and lever with k_1 = 3 m and the beam placed so that the printed link comes out."""
    given, wanted = data["given"], data["continuous"]["l_4"]

    def gap(x: Floats) -> Floats:
        return np.array([0.5 * sum(_extremes(given, 3.0, float(x[0]))) - wanted])

    top = float(_newton(gap, np.array([0.45]))[0])
    least, greatest = _extremes(given, 3.0, top)
    return 0.5 * (least + greatest), 0.5 * (greatest - least)


def _closing(printed: LeverFormula) -> tuple[float, float]:
    """Crank angles from 12 o'clock between which link and lever reach, by bisection of l_d = l_4 + l_5."""
    (top, _), (bottom, _) = printed.unit.ends()

    def spare(phi: float) -> float:
        return printed.l_4 + printed.l_5 - float(printed.unit.diagonal_rates(np.asarray(phi))[0])

    edges = []
    for far in (bottom, bottom - 2 * np.pi if bottom > top else bottom + 2 * np.pi):
        good, bad = top, far
        for _ in range(60):
            middle = 0.5 * (good + bad)
            good, bad = (middle, bad) if spare(middle) >= 0 else (good, middle)
        edges.append(good)
    low, high = sorted(edges)
    # The machine file counts from 12 o'clock.
    return float((low - np.pi / 2) % (2 * np.pi)), float((high - np.pi / 2) % (2 * np.pi))


def _rows(
    data: dict[str, Any],
    places: tuple[Place, ...],
    rounded: tuple[float, float],
    turning: RodRotatorMotion,
    printed: LeverFormula,
    closing: tuple[float, float],
    straightness: float,
) -> tuple[Row, ...]:
    """Every printed number, and every statement about the figures."""
    given, lengths = data["given"], data["continuous"]
    rows = [_taken(name, given[name]) for name in ("r", "L", "k", "l_3", "l_K")]
    stroke = places[0].unit.k_1 * (places[0].unit.ends()[0][1] - places[0].unit.ends()[1][1])
    rows.append(_number("S", given["S"], stroke, "four-bar with the recomputed crankshaft"))
    rows.append(
        _number(
            "l_4, continuous", lengths["l_4"], turning.link_length, "from the extremes of the machine file"
        )
    )
    rows.append(
        _number(
            "l_5, continuous", lengths["l_5"], turning.lever_length, "from the extremes of the machine file"
        )
    )
    rows.append(
        _number("l_5, continuous, k_1 = 3 m", lengths["l_5"], rounded[1], "l_4 fitted by the beam's position")
    )
    least, greatest = printed.unit.extremes()
    does_close = printed.l_4 + printed.l_5 > greatest
    edges = "…".join(f"{np.degrees(each):.1f}°" for each in closing)
    rows.append(
        Row(
            "l_4, l_5, intermittent",
            f"{printed.l_4} m, {printed.l_5} m",
            f"close for θ = {edges} only",
            "reproduced"
            if does_close
            else f"not reproduced because l_d = {least:.3f}…{greatest:.3f} m, their reach is "
            f"{printed.l_4 + printed.l_5:.3f} m",
            "reproduced" if does_close else "far",
        )
    )
    return (*rows, *_statements(turning, printed, straightness))


def _taken(name: str, value: float) -> Row:
    return Row(name, f"{value} m", f"{value} m", "taken from the paper", "none")


def _number(name: str, printed: float, computed: float, how: str) -> Row:
    cell = Cell(printed, computed, how)
    return Row(name, f"{printed} m", f"{computed:.4f} m ({how})", cell.verdict, cell.kind)


def _statements(turning: RodRotatorMotion, printed: LeverFormula, straightness: float) -> list[Row]:
    """What the paper says of its figures 3 to 6."""
    phi = np.linspace(0.0, 2 * np.pi, _ANGLES)
    rates = printed.rocking(phi)[1]
    low, high = turning.transfer_min, turning.transfer_max
    keeps = low * high > 0
    l_6 = printed.unit.l_6(printed.unit.front(phi)[0])
    holds = printed.l_5 + l_6 > printed.unit.l_3 + printed.l_4
    changes = bool(np.nanmin(rates) < 0 < np.nanmax(rates))
    return [
        Row(
            "figure 3, φ_5(φ_1) continuous",
            "nearly a straight line",
            f"within {np.degrees(straightness):.1f}° of a straight line, one turn in a turn",
            "one full turn reproduced; the line waves by more than the words suggest",
            "near",
        ),
        Row(
            "figure 4, dφ_5/dφ_1 continuous",
            "keeps its sign, never zero",
            f"{low:.4f}…{high:.4f}",
            "reproduced" if keeps else "not reproduced",
            "reproduced" if keeps else "far",
        ),
        Row(
            "figures 5 and 6, intermittent",
            "the lever rocks, dφ_5/dφ_1 changes sign",
            f"where the printed lengths close, {'both signs' if changes else 'one sign'}",
            "reproduced in part: no cycle closes with the printed lengths",
            "near" if changes else "far",
        ),
        Row(
            "condition (18), intermittent",
            "l_5 + l_6 > l_3 + l_4",
            f"holds for {100 * holds.mean():.0f} % of the turn",
            "not sufficient: where it holds, at the bottom of the stroke, the printed lengths do not close",
            "far",
        ),
    ]
