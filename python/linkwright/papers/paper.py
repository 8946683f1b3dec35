"""A paper computed anew: what all five have in common.

A paper is a file of data, ``paperN.toml``, with its claims, conclusions, tables and captions, and a class
that computes the quantities which they name. Rows, verdicts, conclusions and tables follow from these alone.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cache, cached_property
from importlib import import_module
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

from linkwright.kernel.errors import InputError
from linkwright.papers.claim import Row, judged
from linkwright.papers.page import conclusion, filled, named

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAPERS = {
    1: "Speed fluctuation of the drives of roller-forming machines, one to four carts",
    2: "Cam drive of a roller-forming machine with a combined mode of motion",
    3: "Torsional vibration of V-type engines, and the speed fluctuation of their rotation",
    4: "Lever mechanism of a worm-type rotator of a sucker-rod string",
    5: "Movement of a topper knife over the head of a root, and the length of its edge",
}


class Text(NamedTuple):
    """A cell of a table, and the kind of its verdict if it has one."""

    text: str
    kind: str = ""


class Table(NamedTuple):
    """A table: what stands above it, the heads of its columns, its rows, and what stands below."""

    title: str
    about: str
    heads: list[str]
    rows: list[list[Text]]
    notes: list[str]


@dataclass(frozen=True)
class Paper:
    """What is published in a paper, and what comes out."""

    published: dict[str, Any]  # the file of data

    @property
    def number(self) -> int:
        """Of the paper."""
        return int(self.published["number"])

    @property
    def title(self) -> str:
        """Of the paper, in English."""
        return str(self.published["title"])

    def quantities(self) -> Mapping[str, Any]:
        """Further quantities by name, beside the fields of the class [SI]."""
        return {}

    def entries(self) -> dict[str, Any]:
        """Computed values, ready for JSON."""
        raise NotImplementedError

    def figures(self) -> dict[str, Figure]:
        """All figures, under names for files."""
        module = import_module(f"linkwright.papers.paper{self.number}.figures")
        drawn: dict[str, Figure] = module.figures(self)
        return drawn

    @cached_property
    def values(self) -> dict[str, Any]:
        """All that claims, conclusions and tables may name: ``paper``, ``printed``, fields, quantities."""
        own = {field.name: getattr(self, field.name) for field in fields(self)}
        return {"paper": self, "printed": self.published} | own | dict(self.quantities())

    @property
    def rows(self) -> tuple[Row, ...]:
        """Every claim with its verdict."""
        return tuple(judged(claim, self.values) for claim in self.published["claim"])

    @property
    def conclusions(self) -> list[str]:
        """What the numbers say, in a few sentences each."""
        values = self.values | {"rows": self.rows}
        return [conclusion(entry, values) for entry in self.published["conclusion"]]

    @property
    def tables(self) -> list[Table]:
        """Further tables."""
        return [table for entry in self.published.get("table", ()) for table in _tables(entry, self.values)]

    def text(self, name: str) -> str:
        """One of the texts in the file of data, filled."""
        return filled(self.published[name], self.values)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        results = {"rows": [row.to_dict() for row in self.rows], "conclusions": self.conclusions}
        return self.entries() | results


def _tables(data: Mapping[str, Any], values: Mapping[str, Any]) -> Iterator[Table]:
    for item in named(values, data["of"]) if "of" in data else (values,):
        columns, notes = data["columns"], named(item, data["notes"]) if "notes" in data else []
        yield Table(
            filled(data["title"], item),
            filled(data.get("about", ""), item),
            [filled(column["head"], values) for column in columns],
            [[_cell(column, row) for column in columns] for row in named(item, data["rows"])],
            notes,
        )


def _cell(column: Mapping[str, str], row: Any) -> Text:
    return Text(filled(column["text"], row), named(row, column["kind"]) if "kind" in column else "")


def known_paper(number: int) -> int:
    """The number of a paper, if it is one of `PAPERS`; else an `InputError`."""
    if number not in PAPERS:
        raise InputError(f"no paper {number}; there is {', '.join(map(str, PAPERS))}")
    return number


@cache
def printed_values(number: int) -> dict[str, Any]:
    """The file of data of a paper, in SI. Raises InputError: there is no such paper."""
    n = known_paper(number)
    text = files(f"linkwright.papers.paper{n}").joinpath(f"paper{n}.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def paper(number: int) -> Paper:
    """Recompute a paper; an `InputError` if there is no such one."""
    n = known_paper(number)
    computed: Paper = getattr(import_module(f"linkwright.papers.paper{n}.paper"), f"paper{n}")()
    return computed
