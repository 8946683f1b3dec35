"""``linkwright topper best FILE``: the best knife of a topper within its limits."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any

import typer

from linkwright.kernel.command.common import File, Json, Outside, Sets
from linkwright.kernel.command.out import Force, output_folder, write_folder
from linkwright.topping.commands.field import Folder, Seed

if TYPE_CHECKING:
    from linkwright.kernel.files.output import OutputFolder
    from linkwright.topping.best.best_knife import KnifeSearch


class Objective(StrEnum):
    """What is best."""

    shortest = "shortest"
    fastest = "fastest"


Best = Annotated[
    Objective,
    typer.Option(
        "--objective",
        help="The shortest edge at the forward speed of the file, or the greatest forward speed with an edge "
        "of at most length_max.",
    ),
]


def best(
    file: File,
    objective: Best = Objective.shortest,
    set: Sets = None,
    allow_outside: Outside = False,
    seed: Seed = None,
    json: Json = False,
    out: Folder = None,
    force: Force = False,
) -> None:
    """The best angle, length and speed of the knife for a field of roots, within [topper.limits].

    What is found is looked at over other roots, and more finely. Exit code 1 if no knife keeps the limits.
    """
    from linkwright.kernel.command.bar import bar
    from linkwright.machine.read import read
    from linkwright.topping.best.best_knife import best_knife

    folder = output_folder(out, force=force)
    machine = read(file, set or [], allow_outside=allow_outside)
    with bar("knives") as watch:
        found = best_knife(machine, objective=objective.value, seed=seed, watch=watch)
    findings, warnings = _told(found)
    shown = _object(machine.name, found, findings, warnings)
    if json:
        typer.echo(shown, nl=False)
    else:
        _print(machine.name, found, findings, warnings)
    if folder is not None:
        _write(found, shown, folder, quiet=json)
    if findings:
        raise typer.Exit(1)


def _told(found: KnifeSearch) -> tuple[list[str], list[str]]:
    """What cannot be, and what to know of the best knife."""
    from linkwright.topping.tables.best import best_warnings

    if found.failing is not None:
        return [found.failing.words + "."], []
    return [], list(best_warnings(found))


def _object(name: str, found: KnifeSearch, findings: list[str], warnings: list[str]) -> str:
    """One JSON object."""
    from json import dumps

    from linkwright.kernel.result import finite

    failing = found.failing
    results: dict[str, Any] = {
        "objective": found.objective,
        "tried": found.tried,
        **({} if found.best is None else found.best.to_dict()),
        "failing": failing and {key: getattr(failing, key) for key in ("limit", "wanted", "reached")},
    }
    told = {"findings": findings, "warnings": [*findings, *warnings]}
    shown = {"machine": name, "results": {"topper_best": finite(results)}, **told}
    return dumps(shown, allow_nan=False, ensure_ascii=False) + "\n"


def _print(name: str, found: KnifeSearch, findings: list[str], warnings: list[str]) -> None:
    """A table, and the knife as lines of a machine file."""
    from linkwright.kernel.command.terminal import print_tables
    from linkwright.topping.tables.best import best_lines, best_table

    tables = [] if found.best is None else [best_table(found, found.best)]
    print_tables(name, tables, findings, warnings)
    if found.best is not None:
        typer.echo("\n" + best_lines(found.best), nl=False)


def _write(found: KnifeSearch, shown: str, folder: OutputFolder, *, quiet: bool) -> None:
    """Results, map and figure; says where they are."""
    import numpy as np

    from linkwright.topping.figures.sweep import best_knife_figure
    from linkwright.topping.tables.best import best_lines, map_csv

    texts = {"results.json": shown, "map.csv": map_csv(found)}
    if found.best is not None:
        texts["topper.toml"] = best_lines(found.best)
    figures = {}
    # A line is no map, nor is a plane without any edge that would do.
    if min(found.map_length.shape) > 1 and np.isfinite(found.map_length).any():
        figures["map"] = best_knife_figure(found)
    write_folder(folder, texts, figures, quiet=quiet)
