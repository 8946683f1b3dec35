"""``linkwright check FILE``: is the machine file sound, and the geometry that it describes?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, is_reported
from linkwright.kernel.command.common import Output, to_screen
from linkwright.kernel.page.table import Row, Table
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine


def check(file: File, *, to: Annotated[Output, to_screen()]) -> None:
    """Check a machine file.

    Says what is in it, or all that is wrong with it; and what its geometry does not allow, as far as that can
    be seen at once. Exit code 1 if the machine cannot do something, 2 if the file is wrong.
    """
    from linkwright.app.feasibility import feasibility

    machine = file.read()
    judged = feasibility(machine)
    count = len(judged.findings)
    verdict = f"{count} FINDING{'S' if count > 1 else ''}" if count else "OK"
    answer = Answer(
        machine=machine,
        results={"checked": list(judged.looked_at)},
        findings=judged.findings,
        warnings=judged.warnings,
        head=lambda: f"{verdict}  {file.file}\n\n{summary(machine)}",
        tables=_checks(judged.looked_at),
    )
    if is_reported():
        # A report has the name of the machine as its title, and tables in place of columns of a terminal.
        verdict = f"{count} finding{'s' if count > 1 else ''}" if count else "no finding"
        tables = [_parts(machine), _checks(judged.looked_at)]
        answer = replace(answer, head=f"Check of {file.file}: {verdict}", tables=tables)
    to.hand_over(answer)


def summary(machine: Machine) -> str:
    """What a machine consists of, a line for each part."""
    rows = [("machine", machine.name), *_rows(machine)]
    return "\n".join(f"  {word:<14} {text}" for word, text in rows)


def _parts(machine: Machine) -> Table:
    rows: list[Row] = [(word, "", text) for word, text in _rows(machine)]
    return Table("parts", "Parts of the machine", ("part", "", "what"), rows, is_whole=True)


def _rows(machine: Machine) -> list[tuple[str, str]]:
    from linkwright.app.subjects import ANALYSES

    summaries = [
        analysis.summary
        for analysis in ANALYSES
        if analysis.summary is not None and analysis.applies(machine)
    ]
    return [(word, text) for summary in summaries for word, text in summary(machine) if text]


def _checks(looked_at: Sequence[str]) -> Table:
    rows: list[Row] = []
    for text in looked_at:
        part, _, words = text.partition(": ")
        rows.append((part, "", words))
    return Table("checked", "Checked", ("part", "", "what"), rows, is_whole=True)
