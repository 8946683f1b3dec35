"""Results and machines as a notebook shows them: words, symbols, numbers and units in plain HTML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np
from markupsafe import Markup

from linkwright.kernel.page.formulas import with_index
from linkwright.kernel.quantities import quantities_of
from linkwright.kernel.reader.numbers import parted
from linkwright.kernel.reader.out_units import with_units_of
from linkwright.kernel.units.reading import is_number


def table_html(title: str, rows: Iterable[Sequence[str]]) -> str:
    """A small table as HTML, the first cell of each row its head; nothing in a cell is taken for HTML."""
    lines = [
        f'<tr><th scope="row" style="text-align:left">{escape(head)}</th>'
        + "".join(f'<td style="text-align:left">{_shown(cell)}</td>' for cell in cells)
        + "</tr>"
        for head, *cells in rows
    ]
    caption = f'<caption style="text-align:left;font-weight:600">{escape(title)}</caption>'
    return f"<table>{caption}<tbody>{''.join(lines)}</tbody></table>"


def _shown(cell: str) -> str:
    """The text of a cell as HTML; a symbol whose index is lowered is HTML already."""
    return cell if isinstance(cell, Markup) else escape(cell)


def result_html(result: Any, title: str = "") -> str:
    """The scalars of a result as HTML, and which curves it has; its class is the title without another."""
    owner: type = type(result)
    declared = list(quantities_of(owner))
    rows: list[tuple[str, ...]] = []
    for quantity in declared:
        value = getattr(result, quantity.name, None) if quantity.kind == "scalar" else None
        if is_number(value):
            rows.append(
                (quantity.word, with_index(quantity.symbol), *parted(value, result.unit_of(quantity.name)))
            )
    rows += [(word, with_index(symbol), *_parted(*value)) for word, symbol, *value in result.shown_rows()]
    if curves := result.usual_curves():
        rows.append(("curves, for .plot()", "", ", ".join(curves), ""))
    return table_html(title or owner.__name__, rows)


def _parted(value: float | tuple[float, float], unit: str) -> tuple[str, str]:
    if not isinstance(value, tuple):
        return parted(value, unit)
    (low, _), (high, shown) = (parted(end, unit) for end in value)
    return f"{low} … {high}", shown


def study_html(study: Any, results: Mapping[str, Any]) -> str:
    """Failed checks, warnings and all results of a study as HTML, in the units of its machine."""
    words = [("failed check", finding) for finding in study.findings]
    words += [("warning", warning) for warning in study.warnings]
    head = table_html(study.machine.name, words or [("checks", "none failed")])
    with with_units_of(study.machine.units):
        return head + "".join(result_html(result, name) for name, result in results.items())


def batch_html(batch: Any) -> str:
    """The range of each quantity of many machines as HTML, of the rows with an answer."""
    rows = []
    for quantity in quantities_of(type(batch)):
        values = getattr(batch, quantity.name)
        known = values[np.isfinite(values)] if isinstance(values, np.ndarray) else np.array(())
        if quantity.symbol and known.size:
            (low, unit), (high, _) = (parted(float(end), quantity.unit) for end in (known.min(), known.max()))
            rows.append((quantity.word, with_index(quantity.symbol), f"{low} … {high}", unit))
    count = f"{np.count_nonzero(batch.status == 0)} of {len(batch.status)} machines solved"
    if unsettled := np.count_nonzero(batch.fast_starts):
        count += f", {unsettled} of them not reached from all fast starts (fast_starts)"
    return table_html(f"{type(batch).__name__}: {count}", rows)
