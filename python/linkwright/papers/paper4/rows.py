"""Every printed number of paper 4, and every statement about its figures, with a verdict."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.papers.cell import Cell
from linkwright.papers.paper4.formulas import LeverFormula
from linkwright.papers.paper4.unit import Place
from linkwright.papers.row import Row
from linkwright.pumping.rod_rotator import RodRotatorMotion

# Angles of the turn at which statements are looked at, a quarter of a degree.
_ANGLES = 1440


def rows_of(
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
    return Row.taken(name, f"{value} m")


def _number(name: str, printed: float, computed: float, how: str) -> Row:
    return Row.number(name, "m", Cell(printed, computed, how), f"{computed:.4f} m ({how})")


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
