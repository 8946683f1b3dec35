"""What a report says of the answer of any command, and variants beside each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from linkwright.app.report.page import machine_sections
from linkwright.kernel.command.answer import Answer, shown_head
from linkwright.kernel.command.common import named_entries
from linkwright.kernel.errors import InputError
from linkwright.kernel.page.content import Content, Part
from linkwright.kernel.page.table import Row, Table
from linkwright.kernel.reader.sentences import sentences
from linkwright.machine.machine import Machine
from linkwright.machine.table import part_names


class Variant(NamedTuple):
    """A variant of a machine: its name and the entries that differ, ``PATH=VALUE``."""

    name: str
    entries: tuple[str, ...]


def variant(text: str) -> Variant:
    """A variant by ``"NAME: PATH=VALUE; …"``; an `InputError` without name or entry."""
    example = "heavier: bodies.cart1.mass=900 kg"
    name, entries = named_entries("--variant", text, example)
    if not entries:
        raise InputError(f'--variant: found "{text}", expected entries behind the colon, as in "{example}"')
    return Variant(name, tuple(entries))


def answered(answer: Answer, command: str) -> Content:
    """What a report of an answer says; an `InputError` if it has neither tables nor figures."""
    if answer.report is not None:
        return replace(answer.report(), command=command)
    machine, tables = answer.machine, answer.all_tables()
    figures = answer.all_figures()
    known = {} if callable(answer.results) else answer.results
    # The string of the drawing: as it was measured, or as it was predicted.
    string = known.get("card_diagnosis", known.get("rod_string"))
    if not (tables or figures or answer.findings):
        raise InputError("there is nothing to report: this command gives neither tables nor figures")
    return Content(
        title=answer.name or "Linkwright",
        names={*answer.names, *(part_names(machine) if isinstance(machine, Machine) else ())},
        lead=". ".join(line.strip().rstrip(".") for line in shown_head(answer).split("\n")),
        findings=sentences(answer.findings),
        warnings=sentences(answer.warnings),
        parts=[Part("Results", tables, figures)] if tables or figures else [],
        command=command,
        **(
            machine_sections(machine, None, string)
            if answer.is_described and isinstance(machine, Machine)
            else {}
        ),
    )


def compared(content: Content, of: Content, variants: Mapping[str, Content]) -> Content:
    """A report with a table for each table in which a number differs between variants before all else.

    `of`: the same before sections were chosen. Findings and warnings of variants are named.
    """
    differences = list(
        _compared_tables(_tables(of), {name: _tables(content) for name, content in variants.items()})
    )
    findings = [f"{name}: {finding}" for name, other in variants.items() for finding in other.findings]
    warnings = [
        f"{name}: {warning}"
        for name, other in variants.items()
        for warning in other.warnings
        if warning not in of.warnings
    ]
    return replace(
        content,
        parts=[*([Part("Variants", differences)] if differences else []), *content.parts],
        findings=[*content.findings, *findings],
        warnings=[*content.warnings, *warnings],
    )


def _tables(content: Content) -> list[Table]:
    return [table for part in content.parts for table in part.tables]


def _compared_tables(base: Sequence[Table], others: Mapping[str, Sequence[Table]]) -> Iterator[Table]:
    for table in base:
        same = {
            name: {_key(row): row for own in tables if own.name == table.name for row in own.rows}
            for name, tables in others.items()
        }
        rows = []
        for row in table.rows:
            values = [_value(same[name].get(_key(row))) for name in others]
            if len(row) > _KEY and any(value != row[_KEY] for value in values):
                rows.append((*row[: _KEY + 1], *values))
        if rows:
            words = (
                f"{table.title}: {table.heads[_KEY]}"
                if table.heads[_KEY] not in ("", "value")
                else table.title
            )
            yield Table(f"variants_{table.name}", words, (*table.heads[:_KEY], "as it is", *others), rows)


# Columns that name a row: its words and its symbol.
_KEY = 2


def _key(row: Row) -> Row:
    return row[:_KEY]


def _value(row: Row | None) -> str:
    return "–" if row is None or len(row) <= _KEY else row[_KEY]
