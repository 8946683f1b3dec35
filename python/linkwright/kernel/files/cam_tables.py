"""Tables of motion controllers as text: Structured Text, `.tab` of a CNC, and pairs of numbers.

| text | rows |
| --- | --- |
| Structured Text | structures ``(dX := 0.0, dY := 1.5)`` and assignments ``cam[3].x := 1.5;`` |
| `.tab` | the lines between ``Begintable`` and ``EndTable`` |
| pairs | the number of pairs on the first line, and a pair on each of the others |

What the columns of a foreign text mean, and in which units they are, its reader has to know.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import NamedTuple


class TableRow(NamedTuple):
    """A row of a table: its line in the text, counted from 1, and its entries by name."""

    line: int
    entries: dict[str, str]


# Where a comment begins, and where each kind ends.
_COMMENT = re.compile(r"\(\*|//")
_ENDS = {"(*": "*)", "//": "\n"}
_FIELD = r"\w++\s*+:=\s*+[^(),;\[\]]++"
_STRUCTURE = re.compile(rf"\(\s*+({_FIELD}(?:,\s*+{_FIELD})*+)\)")
_ASSIGNMENT = re.compile(r"(?<!\w)\w++\[\s*+(\d++)\s*+\]\.(\w++)\s*+:=\s*+([^;:=\[\]]++);")


def without_comments(text: str) -> str:
    """Structured Text without its comments, on the same lines."""
    parts, at = [], 0
    while comment := _COMMENT.search(text, at):
        mark = _ENDS[comment[0]]
        end = text.find(mark, comment.end())
        after = len(text) if end < 0 else end + (len(mark) if mark == "*)" else 0)
        parts += [text[at : comment.start()], "\n" * text.count("\n", comment.start(), after)]
        at = after
    return "".join([*parts, text[at:]])


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
    apart = re.search(r"[;\t]", line) is not None
    parts = re.split(r"\s*[;\t]\s*" if apart else r"\s*,\s*|\s+", line)
    parts = [part.replace(",", ".") for part in parts]
    names = ("master", "slave", *(f"column {i}" for i in range(3, len(parts) + 1)))
    return TableRow(n, dict(zip(names, parts, strict=False)))


# Fields of points in Structured Text: master, position, and with four also velocity and acceleration.
_FIELDS = (
    ("dX", "dY", "dV", "dA"),
    ("MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc"),
    ("leadingValue", "followingValue", "velocityRatio", "accelerationRatio"),
    ("Master", "Slave"),
    ("x", "y"),
)

# What a text of this program says of its units.
_UNITS = re.compile(r"\bmaster in deg, position in (\S++)")

# What the head of a `.tab` says of its length.
_LINES = re.compile(r"^\s*+Lines\s*+=\s*+(\d++)", re.MULTILINE | re.IGNORECASE)

# The steps in which a `.tab` counts, of a degree and of a millimetre.
TAB_STEP = 1e-4


class ControllerTable(NamedTuple):
    """A table of a controller as columns: their heads, None where the text has no units, and its rows."""

    heads: list[str] | None
    rows: list[tuple[int, list[str]]]  # line and cells
    announced: int | None = None  # how many points the text says that it has
    present: int = 0  # how many it has


def controller_table(text: str) -> ControllerTable | None:
    """The points of a text of a controller; None if it is none."""
    if (rows := tab_rows(text)) is not None:
        # The first point is the last one too, one revolution on.
        cells = [(row.line, [_in_steps(entry) for entry in row.entries.values()]) for row in rows]
        turn = _number(cells[0][1][0]) + 360.0 if cells else 0.0
        if cells and _number(cells[-1][1][0]) < turn - TAB_STEP:
            cells.append((cells[-1][0], [repr(turn), *cells[0][1][1:]]))
        lines = _LINES.search(text)
        said = int(lines[1][:9]) if lines else None
        return ControllerTable(["angle [deg]", "lift [mm]"], cells, said, len(rows))
    if (rows := pair_rows(text)) is not None:
        said = int(lines_of_table(text)[0][1][:9])
        pairs = [(row.line, list(row.entries.values())) for row in rows]
        return ControllerTable(None, pairs, said, len(rows))
    for names in _FIELDS if ":=" in text else ():
        if rows := structured_rows(text, *names):
            unit = _UNITS.search(text)
            heads = law_heads(unit[1], is_angle=unit[1] in ("deg", "rad"))[: len(names)] if unit else None
            return ControllerTable(heads, [(row.line, [row.entries[name] for name in names]) for row in rows])
    return None


def law_heads(unit: str, *, is_angle: bool) -> list[str]:
    """Heads of the columns of a law: master angle, position, three derivatives; `unit`: of the position."""
    family, prefix = ("swing", "swing_") if is_angle else ("lift", "")
    names = (family, *(f"{prefix}{name}" for name in ("velocity", "acceleration", "jerk")))
    per = ("", "/deg", "/deg^2", "/deg^3")
    return ["angle [deg]", *(f"{name} [{unit}{by}]" for name, by in zip(names, per, strict=True))]


def _number(text: str) -> float:
    """A number; NaN for any other text, which is reported where it is read."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def _in_steps(entry: str) -> str:
    """A number of steps in degrees or millimetres, with the digits that it has; another text as it is."""
    number = _number(entry)
    return entry if math.isnan(number) else repr(round(number * TAB_STEP, 9))
