"""Checks against limits as a table."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.kernel.check import Check
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.numbers import measured

_VERDICTS = {True: "passes", False: "fails", None: "not known"}


def check_table(name: str, title: str, checks: Sequence[Check]) -> Table:
    """A row for each check: value, limit, verdict."""
    rows: list[Row] = [
        (
            check.title,
            "",
            measured(check.value, check.unit, abs(check.limit or 0.0)),
            measured(
                check.limit, check.unit, abs(check.value or 0.0), before="≤ " if check.at_most else "≥ "
            ),
            _VERDICTS[check.passed],
            check.note,
        )
        for check in checks
    ]
    return Table(name, title, ("check", "", "found", "limit", "verdict", "remark"), rows)
