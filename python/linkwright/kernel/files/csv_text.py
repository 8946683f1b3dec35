"""Tables as comma-separated values (RFC 4180) that a spreadsheet takes as they are.

A spreadsheet runs a cell that begins with ``=``, ``+``, ``-`` or ``@`` as a formula, and names of a machine
file may begin so: such a text gets an apostrophe in front, by which a spreadsheet knows a text. Numbers are
written as they are and read back exactly.

Source: OWASP, *CSV Injection*.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from io import StringIO

# Also in the wide forms of East Asian writing, which some spreadsheets take for the same.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")


def csv_text(heads: Sequence[str], rows: Iterable[Sequence[str | float]]) -> str:
    """A table as CSV.

    Parameters
    ----------
    heads : sequence of str
        Heads of the columns.
    rows : iterable of sequences of str and float
        One entry a column; a number that is none (NaN) is an empty cell.

    Returns
    -------
    str
        A line for the heads and one for each row.
    """
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([_cell(head) for head in heads])
    writer.writerows([_cell(entry) for entry in row] for row in rows)
    return text.getvalue()


def _cell(entry: str | float) -> str | float:
    """A text that is no formula, or a number."""
    if isinstance(entry, str):
        return f"'{entry}" if entry.startswith(_FORMULA) else entry
    return "" if entry != entry else entry
