"""The pumping unit of paper 4, as far as it is not printed: horsehead, beam and crankshaft from the rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.kernel.errors import ConvergenceError
from linkwright.papers.paper4.formulas import Unit

Floats = NDArray[np.float64]

# What a unit takes as printed.
_PRINTED = ("r", "L", "k", "l_K", "l_3")

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
        Minimum angle between pitman and rear arm, or its supplement, over the revolution [rad].
    upstroke : float
        Angle that the crank turns in the upstroke, counter-clockwise with the well to the right [rad].
    """

    unit: Unit
    least_angle: float
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
    found = [
        _place(Unit(x=float(x), y=float(y), k_1=float(k_1), **{name: given[name] for name in _PRINTED}))
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
    """Root of smooth equations, the Jacobian by central differences. Raises ConvergenceError: there is no
    root near the start.
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
    return Place(unit, float(min(np.arccos(abs(cosine)) for cosine in cosines)), (top - bottom) % (2 * np.pi))


def rounded_lengths(data: dict[str, Any]) -> tuple[float, float]:
    """Link and lever with the chosen k_1 and the beam placed so that the printed link comes out."""
    given, wanted, k_1 = data["given"], data["continuous"]["l_4"], data["chosen"]["k_1"]

    def gap(x: Floats) -> Floats:
        return np.array([0.5 * sum(_extremes(given, k_1, float(x[0]))) - wanted])

    top = float(_newton(gap, np.array([0.45]))[0])
    least, greatest = _extremes(given, k_1, top)
    return 0.5 * (least + greatest), 0.5 * (greatest - least)
