"""``linkwright torsion FILE``: torsional vibration of a train."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from linkwright.cli.common import File, Json, Sets
from linkwright.errors import InputError

if TYPE_CHECKING:
    from linkwright.analysis.torsion.forced import ForcedVibration
    from linkwright.analysis.torsion.free import FreeVibration
    from linkwright.analysis.torsion.holzer import HolzerTable
    from linkwright.analysis.torsion.scheme import Scheme

Folder = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Write results.json, the equivalent scheme and the mode shapes as SVG and PNG there.",
        show_default=False,
    ),
]
Holzer = Annotated[
    list[float] | None,
    typer.Option(
        "--holzer",
        metavar="HZ",
        help="Holzer's table at this frequency. May be given again.",
        show_default=False,
    ),
]


def torsion(
    file: File, set: Sets = None, json: Json = False, holzer: Holzer = None, out: Folder = None
) -> None:
    """Torsional vibration of a train: natural frequencies, mode shapes, nodes, energy."""
    from linkwright.analysis.torsion.excited import is_excited
    from linkwright.analysis.torsion.forced import forced_vibration
    from linkwright.analysis.torsion.free import free_vibration
    from linkwright.analysis.torsion.holzer import holzer_table
    from linkwright.analysis.torsion.scheme import scheme
    from linkwright.files.read import read

    machine = read(file, set or [])
    found = free_vibration(machine)
    tables = [holzer_table(machine, frequency) for frequency in holzer or ()]
    forced = forced_vibration(machine) if is_excited(machine) else None
    equivalent = scheme(machine)
    shown = _object(machine.name, equivalent, found, tables, forced)
    if json:
        typer.echo(shown, nl=False)
    else:
        _print(found, tables)
    if out is not None:
        _write(equivalent, found, shown, out, quiet=json)


def _object(
    name: str,
    equivalent: Scheme,
    found: FreeVibration,
    tables: list[HolzerTable],
    forced: ForcedVibration | None,
) -> str:
    """One JSON object."""
    from json import dumps

    from linkwright.analysis.result import finite

    free = found.to_dict(curves=True)
    free["nodes"] = [[node._asdict() for node in nodes] for nodes in found.nodes]
    results: dict[str, Any] = {"scheme": equivalent.to_dict(curves=True), "free": free}
    if tables:
        results["holzer"] = [each.to_dict(curves=True) for each in tables]
    if forced is not None:
        results["forced"] = forced.to_dict()
    told: dict[str, Any] = {"machine": name, "results": finite(results), "findings": [], "warnings": []}
    return dumps(told, allow_nan=False, ensure_ascii=False) + "\n"


def _print(found: FreeVibration, tables: list[HolzerTable]) -> None:
    """Tables for people."""
    from linkwright.cli.tables import print_tables
    from linkwright.report.torsion_tables import holzer_tables, torsion_tables

    shown = [*torsion_tables(found), *(each for table in tables for each in holzer_tables(table))]
    print_tables("", shown, ())


def _write(equivalent: Scheme, found: FreeVibration, shown: str, folder: Path, *, quiet: bool) -> None:
    """Results and figures; says where they are."""
    from linkwright.plot import modes_figure, scheme_figure, svg

    figures = {"scheme": scheme_figure(equivalent), "mode_shapes": modes_figure(found)}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "results.json").write_text(shown, encoding="utf-8")
        for name, figure in figures.items():
            (folder / f"{name}.svg").write_text(svg(figure), encoding="utf-8")
            figure.savefig(folder / f"{name}.png", dpi=150)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written to ({error.strerror or error})") from None
    names = ["results.json", *(f"{name}.{kind}" for name in figures for kind in ("svg", "png"))]
    typer.echo("Written:\n" + "\n".join(f"  {folder / name}" for name in names), err=quiet)
