"""Measure the product and what a user would use instead: ``python benches/run.py [--quick] [CASE …]``.

Prints one table and writes `benches/results.json`. What is compared, and how to read it: `benches/README.md`.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import asdict, replace
from importlib import import_module
from pathlib import Path

from common import FLOOR, PACE, Row, facts, keep_memory
from peers import kernels
from rich.console import Console
from rich.table import Table

# One file per question.
CASES = (
    "steady_one",
    "study_one",
    "sensitivity_one",
    "transient_one",
    "steady_many",
    "sweep_many",
    "motions_many",
    "positions_one",
    "general_many",
    "cam_one",
    "cams_many",
    "topper_heads",
    "rods_many",
    "servo_choice",
    "elastic_many",
    "torsion_modes",
    "torsion_forced",
    "trains_many",
    "torsion_engine",
    "torsion_transient",
    "start_up",
)

RESULTS = Path(__file__).parent / "results.json"


def main() -> None:
    """Run the cases that are asked for."""
    parser = argparse.ArgumentParser(description="Measure Linkwright and what a user would use instead.")
    parser.add_argument("cases", nargs="*", metavar="CASE", help=f"of {', '.join(CASES)}; without it, all")
    parser.add_argument("--quick", action="store_true", help="fewer repetitions and smaller batches")
    asked = parser.parse_args()
    unknown = set(asked.cases) - set(CASES)
    if unknown:
        parser.error(f"no case {', '.join(sorted(unknown))}; there is {', '.join(CASES)}")
    # Wide enough for the table where the output is no terminal.
    console = Console(width=None if sys.stdout.isatty() else 150)
    here = facts() | {"keeps_memory": keep_memory()}
    rows: list[Row] = []
    for name in asked.cases or CASES:
        with console.status(f"{name} …"):
            rows += at_pace(import_module(name).rows, asked.quick)
    console.print(table(rows, title(here)))
    for nth, row in enumerate(rows, start=1):
        console.print(f"{nth:>2}  {row.note}", highlight=False)
    write(rows, here)
    console.print(f"written to {RESULTS}")
    apart = [row.case for row in rows if not row.is_sound]
    if apart:
        sys.exit(f"more than {FLOOR:g} times worse than aimed at: {', '.join(apart)}")


def at_pace(measured: Callable[[bool], list[Row]], quick: bool) -> list[Row]:
    """Rows of a case, with what the processor did just before and after."""
    if not kernels.is_here():
        return measured(quick)
    before = kernels.pace()
    rows = measured(quick)
    pace = min(before, kernels.pace())
    return [replace(row, pace=pace) for row in rows]


def title(here: dict[str, object]) -> str:
    """Where and when the numbers are from."""
    pace = f", four-bar by hand {kernels.pace():.2g} ns a position" if kernels.is_here() else ""
    return f"{here['processor']}, {here['cores']} cores, load {here['load_average']}{pace}, {here['date']}"


def table(rows: list[Row], head: str) -> Table:
    """All rows for the terminal."""
    made = Table(title=head, title_justify="left", box=None, pad_edge=False)
    made.add_column("", justify="right")
    made.add_column("case")
    for column in ("product", "peer", "unit", "ratio", f"at {PACE} ns"):
        made.add_column(column, justify="right")
    made.add_column("aim")
    made.add_column("peer")
    for nth, row in enumerate(rows, start=1):
        values = (number(row.product), number(row.peer), row.unit, number(row.ratio), number(row.paced))
        made.add_row(str(nth), row.case, *values, aim(row), row.peer_name)
    return made


def number(value: float | None) -> str:
    """Three digits, or a dash."""
    if value is None:
        return "–"
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def aim(row: Row) -> str:
    """The target and whether it is met."""
    if row.target is None:
        return ""
    sign = "≤" if row.aim == "at most" else "≥"
    word = "ratio " if row.aim == "ratio" else ""
    verdict = {True: " [green]met[/]", False: " [red]missed[/]", None: " [yellow]not measured[/]"}[row.is_met]
    return f"{word}{sign} {row.target:g}{verdict}"


def write(rows: list[Row], here: dict[str, object]) -> None:
    """All rows with the facts of the machine, as JSON."""
    listed = [asdict(row) | {"paced": row.paced, "is_met": row.is_met} for row in rows]
    RESULTS.write_text(json.dumps({"machine": here, "rows": listed}, indent=2, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
