"""Results and machines as a notebook shows them: words, symbols, numbers and units in plain HTML."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from linkwright.kernel.page.numbers import parted
from linkwright.kernel.quantities import quantities_of
from linkwright.kernel.units import is_number


def table_html(title: str, rows: Iterable[Sequence[str]]) -> str:
    """A small table as HTML, the first cell of each row its head; nothing in a cell is taken for HTML."""
    lines = [
        f'<tr><th scope="row" style="text-align:left">{escape(head)}</th>'
        + "".join(f'<td style="text-align:left">{escape(cell)}</td>' for cell in cells)
        + "</tr>"
        for head, *cells in rows
    ]
    caption = f'<caption style="text-align:left;font-weight:600">{escape(title)}</caption>'
    return f"<table>{caption}<tbody>{''.join(lines)}</tbody></table>"


def result_html(result: Any, title: str = "") -> str:
    """The scalars of a result as HTML, and which curves it has; its class is the title without another."""
    owner: type = type(result)
    declared = list(quantities_of(owner))
    rows = []
    for quantity in declared:
        value = getattr(result, quantity.name, None) if quantity.kind == "scalar" else None
        if is_number(value):
            rows.append((quantity.word, quantity.symbol, *parted(value, result.unit_of(quantity.name))))
    drawn = result.curves()
    curves = [
        quantity.name
        for quantity in declared
        if quantity.kind == "curve" and quantity.over and quantity.name in drawn
    ]
    if curves:
        rows.append(("curves, for .plot()", "", ", ".join(curves), ""))
    return table_html(title or owner.__name__, rows)
