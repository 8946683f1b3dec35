"""``linkwright topper best FILE``: the best knife of a topper within its limits."""

from __future__ import annotations

from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import typer

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import File, Json, Outside, Sets
from linkwright.kernel.command.out import Force, output_folder
from linkwright.topping.commands.field import Folder, Seed

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.topping.best.best_knife import KnifeSearch


class Objective(StrEnum):
    """What is best."""

    shortest = "shortest"
    fastest = "fastest"


Best = Annotated[
    Objective,
    typer.Option(
        "--objective",
        help="The shortest edge at the forward speed of the file, or the maximum forward speed with an edge "
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
    hand_over(_answer(machine.name, found), json=json, folder=folder)


def _answer(name: str, found: KnifeSearch) -> Answer:
    """The best knife, also as lines of a machine file; or that none keeps the limits."""
    from linkwright.topping.tables.best import best_lines, best_table, best_warnings

    best, failing = found.best, found.failing
    results: dict[str, Any] = {
        "objective": found.objective,
        "tried": found.tried,
        **({} if best is None else best.to_dict()),
        "failing": failing and {key: getattr(failing, key) for key in ("limit", "wanted", "reached")},
    }
    return Answer(
        machine=name,
        results=lambda _: {"topper_best": results},
        findings=[] if failing is None else [failing.words + "."],
        warnings=[] if failing else list(best_warnings(found)),
        head=lambda: name,
        tables=lambda: [] if best is None else [best_table(found, best)],
        tail=lambda: "" if best is None else best_lines(best),
        files=partial(_files, found),
        figures=partial(_figures, found),
    )


def _files(found: KnifeSearch) -> dict[str, str]:
    """The map, and the knife as lines of a machine file."""
    from linkwright.topping.tables.best import best_lines, map_csv

    texts = {"map.csv": map_csv(found)}
    if found.best is not None:
        texts["topper.toml"] = best_lines(found.best)
    return texts


def _figures(found: KnifeSearch) -> dict[str, Figure]:
    """The map; a line is none, nor is a plane without any edge that would do."""
    import numpy as np

    if min(found.map_length.shape) < 2 or not np.isfinite(found.map_length).any():
        return {}
    from linkwright.topping.figures.sweep import best_knife_figure

    return {"map": best_knife_figure(found)}
