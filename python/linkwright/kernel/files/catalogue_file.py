"""Catalogues of one's own: files of comma-separated values with a row for each type.

The head names each column, with its unit in brackets: ``type, power_rated [kW], speed_rated [rpm]``; without
a unit the numbers are SI. A cell with several values separates them by spaces or semicolons. Lines that begin
with ``#`` are comments.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import MachineFileError, Problem, UnitError, show
from linkwright.kernel.files.points import lines_of
from linkwright.kernel.units.marks import Quantity, QuantityList
from linkwright.kernel.units.reading import items, parse

# A number with a unit behind it, no power of ten.
_WITH_UNIT = re.compile(r"[-+.,\d]*+(?<=\d)\s*+(?![eE][-+\d])[A-Za-z%°].*")
_HEAD = re.compile(r"\s*+(\w++)\s*+(?:\[([^\]]*+)\])?\s*+")


@dataclass(frozen=True)
class Columns:
    """What a catalogue may hold beside the column ``type``."""

    noun: str  # what its rows are, such as "motors"
    numbers: Mapping[str, Quantity | QuantityList]
    words: tuple[str, ...]  # columns of texts
    example: str  # a head, for messages


class CatalogueFile:
    """The rows of a file by type, with their lines.

    `key`: the entry that names the file, for messages. Raises MachineFileError with file and line.
    """

    def __init__(self, path: Path, key: str, columns: Columns) -> None:
        self.path, self.key, self.columns = path, key, columns
        lines = lines_of(path, key)
        self._header = f'a header such as "{columns.example}"'
        if not lines:
            raise self.wrong(1, "an empty file", self._header)
        self.head_line = lines[0][0]
        self.heads = self._heads(*lines[0])
        self.types: dict[str, tuple[int, dict[str, str]]] = {}
        for line, row in lines[1:]:
            if len(row) != len(self.heads):
                expected = f"{len(self.heads)} values, one for each column"
                raise self.wrong(line, show(",".join(row)), expected)
            cells = {name: cell.strip() for name, cell in zip(self.heads, row, strict=True)}
            if cells["type"] in self.types:
                raise self.wrong(line, show(cells["type"]), "each type once")
            self.types[cells["type"]] = (line, cells)

    def known(self, wanted: object) -> str:
        """The name of a type of the file."""
        if isinstance(wanted, str) and wanted in self.types:
            return wanted
        remedy = suggestion(wanted if isinstance(wanted, str) else "", self.types)
        found = "nothing" if wanted is None else show(wanted)
        key = self.key.removesuffix("file") + "catalogue"
        raise MachineFileError([Problem(key, found, f"a type of {self.path.name}", remedy)])

    def numbers(self, type: str) -> dict[str, Any]:
        """The numbers of a type in SI, tuples where a cell holds several; an empty cell is none."""
        line, cells = self.types[type]
        return {
            name: self._value(line, name, cells[name])
            for name in self.heads
            if name in self.columns.numbers and cells[name]
        }

    def word(self, type: str, name: str) -> str:
        """The text of a type in a column; empty if there is none."""
        return self.types[type][1].get(name, "")

    def wrong(self, line: int, found: str, expected: str, remedy: str = "") -> MachineFileError:
        """What is wrong in a line."""
        return MachineFileError([Problem(self.key, found, expected, remedy, str(self.path), line)])

    def lacks(self, type: str, name: str, remedy: str = "") -> MachineFileError:
        """A column that a type needs."""
        return self.wrong(self.types[type][0], f"{type} without {name}", f"a column {name}", remedy)

    def _heads(self, line: int, row: list[str]) -> dict[str, str]:
        """Name → unit of each column."""
        matches = [_HEAD.fullmatch(cell) for cell in row]
        names = [match[1] for match in matches if match is not None]
        known = ("type", *self.columns.numbers, *self.columns.words)
        if len(names) < len(row) or "type" not in names:
            raise self.wrong(line, show(",".join(row)), self._header)
        for name in names:
            if name not in known:
                raise self.wrong(
                    line, show(name), f"a column of {self.columns.noun}", suggestion(name, known)
                )
            if names.count(name) > 1:
                raise self.wrong(line, show(name), "each column once")
        return {match[1]: match[2] or "" for match in matches if match is not None}

    def _value(self, line: int, name: str, cell: str) -> Any:
        """A cell in SI."""
        mark, unit = self.columns.numbers[name], self.heads[name]
        if _WITH_UNIT.fullmatch(cell):
            remedy = (
                f"the unit belongs in the header, [{unit}]"
                if unit
                else "give the unit in the header, in brackets"
            )
            raise self.wrong(line, show(cell), f"a number in the column {name}", remedy)
        several = isinstance(mark, QuantityList)
        try:
            if several and not unit:
                return tuple(parse(float(item), mark.kind) for item in re.split(r"[\s;]+", cell))
            if several:
                return tuple(parse(item, mark.kind) for item in items(f"{cell} {unit}", mark.kind))
            number = parse(f"{cell} {unit}" if unit else float(cell), mark.kind)
        except ValueError:
            expected = f"numbers in the column {name}" if several else f"a number in the column {name}"
            raise self.wrong(line, show(cell), expected) from None
        except UnitError as error:
            problem = replace(error.problem, key=f"{self.key}, column {name}", path=str(self.path), line=line)
            raise MachineFileError([problem]) from None
        if isinstance(mark, Quantity) and not mark.holds(number):
            expected = f"in the column {name} {mark.expected}"
            raise self.wrong(line, show(cell), expected, mark.remedy(number))
        return number
