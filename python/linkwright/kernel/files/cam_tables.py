"""Tables of motion controllers as text: Structured Text, `.tab` of a CNC, and pairs of numbers.

| text | rows |
| --- | --- |
| Structured Text | structures ``(dX := 0.0, dY := 1.5)`` and assignments ``cam[3].x := 1.5;`` |
| `.tab` | the lines between ``Begintable`` and ``EndTable`` |
| pairs | the number of pairs on the first line, and a pair on each of the others |
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple


class TableRow(NamedTuple):
    """A row of a table: its line in the text, counted from 1, and its entries by name."""

    line: int
    entries: dict[str, str]


_COMMENT = re.compile(r"\(\*(?:[^*]|\*(?!\)))*\*\)|//[^\n]*")
_FIELD = r"\w++\s*+:=\s*+[^(),;\[\]]++"
_STRUCTURE = re.compile(rf"\(\s*+({_FIELD}(?:,\s*+{_FIELD})*+)\)")
_ASSIGNMENT = re.compile(r"\w++\[\s*+(\d++)\s*+\]\.(\w++)\s*+:=\s*+([^;]++);")


def without_comments(text: str) -> str:
    """Structured Text without its comments, on the same lines."""
    return _COMMENT.sub(lambda comment: "\n" * comment[0].count("\n"), text)


def structured_rows(text: str, *names: str) -> list[TableRow]:
    """Structures of Structured Text that have all of these fields, in their order, or as they are numbered.

    Assignments to the fields of one element are a row.
    """
    code = without_comments(text)
    rows = [
        TableRow(line, {name.strip(): value.strip() for name, _, value in fields})
        for line, body in _found(_STRUCTURE, code)
        for fields in [[field.partition(":=") for field in body[1].split(",")]]
    ]
    elements: dict[int, TableRow] = {}
    for line, match in _found(_ASSIGNMENT, code):
        elements.setdefault(int(match[1][:9]), TableRow(line, {})).entries[match[2]] = match[3].strip()
    rows += [elements[n] for n in sorted(elements)]
    return [row for row in rows if set(names) <= set(row.entries)]


def _found(pattern: re.Pattern[str], text: str) -> Iterator[tuple[int, re.Match[str]]]:
    """Line and match of all places of a pattern."""
    line, at = 1, 0
    for match in pattern.finditer(text):
        line, at = line + text.count("\n", at, match.start()), match.start()
        yield line, match


def lines_of_table(text: str) -> list[tuple[int, str]]:
    """Number and text of the lines that are neither empty nor a comment (``#``), without comments behind."""
    lines = ((n, line.partition("#")[0].strip()) for n, line in enumerate(text.splitlines(), start=1))
    return [(n, line) for n, line in lines if line]


def tab_rows(text: str) -> list[TableRow] | None:
    """Rows of a `.tab`, master and slave as they stand there; None if the text is no such table."""
    lines = lines_of_table(text)
    words = [line.lower() for _, line in lines]
    if "begintable" not in words:
        return None
    start = words.index("begintable") + 1
    end = words.index("endtable") if "endtable" in words else len(words)
    return [_pair(n, line) for n, line in lines[start:end]]


def pair_rows(text: str) -> list[TableRow] | None:
    """Rows of a table that begins with the number of its pairs; None if the text begins otherwise."""
    lines = lines_of_table(text)
    if not lines or not lines[0][1].isdigit():
        return None
    return [_pair(n, line) for n, line in lines[1:]]


def _pair(n: int, line: str) -> TableRow:
    """Master and slave of a line; a semicolon or a tab between them leaves the comma to decimals."""
    parts = re.split(r"\s*;\s*|\s*\t\s*", line)
    if len(parts) == 1:
        parts = re.split(r"\s*,\s*|\s+", line)
    else:
        parts = [part.replace(",", ".") for part in parts]
    return TableRow(n, dict(zip(("master", "slave"), parts, strict=False)) if len(parts) == 2 else {})
