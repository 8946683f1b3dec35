"""Tables of motion laws: their factors, and the bounds from below."""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.cam.law_factors import LawFactors
from linkwright.cam.laws.bounds import BOUNDS
from linkwright.cam.laws.catalogue import LAWS
from linkwright.kernel.page.numbers import number
from linkwright.kernel.page.table import Row, Table

_COLUMNS = {
    "C_v": "C_v",
    "C_a": "C_a",
    "C_j": "C_j",
    "C_M": "C_M",
    "acceleration_squared": "∫a²",
    "jerk_squared": "∫j²",
}


def law_table(factors: Mapping[str, LawFactors]) -> Table:
    """Factors of laws, a law a row.

    Parameters
    ----------
    factors : Mapping of str to LawFactors
        Name of the law → its factors.

    Returns
    -------
    Table
        Six digits; ∞ where something jumps.
    """
    rows = [
        (_named(name), _jumps(each), *(_shown(getattr(each, factor)) for factor in _COLUMNS))
        for name, each in factors.items()
    ]
    title = "Motion laws between two dwells, for a lift and a length of one"
    return Table("cam_laws", title, ("law", "jumps", *_COLUMNS.values()), rows)


def bound_table() -> Table:
    """Theoretical lower bounds, and which law gets there.

    Returns
    -------
    Table
        A bound a row.
    """
    rows: list[Row] = [
        (each.holds_for, _COLUMNS[each.name], number(each.value), _named(each.reached_by)) for each in BOUNDS
    ]
    return Table(
        "cam_law_bounds", "Theoretical lower bound", ("for laws with", "factor", "bound", "reached by"), rows
    )


def _named(name: str) -> str:
    """A law's name, with the order that a law of several kinds is shown for."""
    order = LAWS[name].parameters.get("order")
    return name if order is None else f"{name}, order {order}"


def _shown(value: float | None) -> str:
    return "∞" if value is None else number(value, 6)


def _jumps(factors: LawFactors) -> str:
    """What jumps, in one word."""
    return factors.remarks[0].split(" ", 1)[0] if factors.remarks else ""
