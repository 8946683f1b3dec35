"""``linkwright topper field FILE``: a topper over a field of roots; ``topper best FILE``: its best knife."""

from __future__ import annotations

from enum import StrEnum
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import File, Json, Outside, Sets, option_value
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError, require_within
from linkwright.kernel.limits import FIELD_VARIANTS
from linkwright.studies.commands.study_file import ToStudy, hand_over_study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.kernel.page.table import Table
    from linkwright.machine.machine import Machine
    from linkwright.topping.best.best_knife import KnifeSearch
    from linkwright.topping.field import TopperField
    from linkwright.topping.sweep import FieldSweep


Over = Annotated[
    list[str] | None,
    Option(
        "--over",
        metavar="NAME=LOW:HIGH:N",
        help='Variable, such as edge_length=0.1:0.3:21 or edge_angle="0 deg":"40 deg":9: edge_length, '
        "edge_angle, forward_speed, knife_speed, cut_height. A second one: all combinations.",
    ),
]
Seed = Annotated[
    int | None,
    Option("--seed", metavar="N", help="Seed of the random generator, instead of that of the field."),
]
Level = Annotated[float, Option("--level", metavar="P", help="Confidence level of the intervals.")]
Folder = Annotated[
    Path | None, out_option("Write results.json, curves as CSV, and figures as SVG and PNG there.")
]

# Lengths at which the haulm that is left is looked at for its figure.
_LENGTHS = 31


def field(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    over: Over = None,
    seed: Seed = None,
    level: Level = 0.95,
    study: ToStudy = None,
    json: Json = False,
    out: Folder = None,
    force: Force = False,
) -> None:
    """A field of roots: share of heads cut through, haulm that is left, loss, length for all shares.

    Exit code 1 if the file has [topper.limits] that are not kept.
    """
    from linkwright.kernel.command.console import bar
    from linkwright.machine.read import read
    from linkwright.studies.knives import sweep_field
    from linkwright.topping.cautions import field_cautions, field_findings
    from linkwright.topping.edge import edges_of, require_topper
    from linkwright.topping.field import topper_field

    folder = output_folder(out, force=force)
    machine, axes = read(file, set or [], allow_outside=allow_outside), _axes(over or [])
    described = require_topper(machine)
    if study is not None:
        from linkwright.studies.knives import field_study

        if not axes:
            raise InputError("--study: found it without --over, expected an entry that varies beside it")
        plan = field_study(machine, axes, seed=seed, level=level)
        hand_over_study(plan, study, file, None if set else machine, force=force, quiet=json)
    with bar("heads") as watch:
        result = topper_field(machine, seed=seed, level=level, watch=watch)
    swept = None
    if axes:
        with bar("variants") as watch:
            swept = sweep_field(machine, axes, seed=seed, level=level, watch=watch)
    answer = Answer(
        machine=machine.name,
        units=machine.units,
        results=lambda _: _results(result, swept),
        findings=list(field_findings(result, described)),
        warnings=list(field_cautions(result, described, edges_of(machine, described)[0].knife)),
        head=lambda: machine.name,
        tables=partial(_tables, result, swept),
        **_written(machine, result, swept, seed),
    )
    hand_over(answer, json=json, folder=folder)


def _axes(wanted: list[str]) -> dict[str, Any]:
    """Values of all entries that vary."""
    axes = dict(_axis(text) for text in wanted)
    if len(axes) < len(wanted):
        raise InputError("--over: found the same name twice, expected each once")
    if len(axes) > 2:
        raise InputError(f"--over: found {len(axes)} names, expected two at most")
    return axes


def _axis(text: str) -> tuple[str, Any]:
    """Name and values of one ``NAME=LOW:HIGH:N``."""
    import numpy as np

    from linkwright.kernel.description.base import suggestion
    from linkwright.topping.sweep import ENTRIES

    name, _, values = text.partition("=")
    parts = [part.strip().strip("\"'") for part in values.split(":")]
    if name not in ENTRIES:
        expected = "expected an entry of the knife; "
        raise InputError(f'--over {text}: found "{name}", {expected}{suggestion(name, ENTRIES)}')
    if len(parts) != 3 or not parts[2].isdigit() or int(parts[2]) < 1:
        remedy = "such as edge_length=0.1:0.3:21 for 21 values from 0.1 to 0.3 m"
        raise InputError(f'--over {text}: found "{values}", expected LOW:HIGH:N; {remedy}')
    low, high = (option_value(f"--over {text}", part, ENTRIES[name]) for part in parts[:2])
    # A count of thousands of digits is no number for Python.
    count = int(parts[2][:16])
    require_within(FIELD_VARIANTS, count, text, "take fewer values")
    return name, np.linspace(low, high, count)


def _results(result: TopperField, swept: FieldSweep | None) -> dict[str, Any]:
    """The field, and what varies over it."""
    results: dict[str, Any] = {"topper_field": result.to_dict()}
    if swept is not None:
        columns = {key: column.tolist() for key, column in swept.columns().items()}
        results["topper_field_sweep"] = {"shape": list(swept.shape), **columns}
    return results


def _tables(result: TopperField, swept: FieldSweep | None) -> list[Table]:
    """Tables for people."""
    from linkwright.topping.tables.field import field_tables, sweep_table

    return [*field_tables(result), *([] if swept is None else [sweep_table(swept)])]


def _written(
    machine: Machine, result: TopperField, swept: FieldSweep | None, seed: int | None
) -> dict[str, Any]:
    """Curves and figures; the field over all lengths of the edge, which both show, is computed once."""

    @cache
    def over() -> FieldSweep:
        import numpy as np

        from linkwright.kernel.command.console import bar
        from linkwright.studies.knives import sweep_field

        lengths = np.linspace(0, result.length[-1], _LENGTHS)[1:]
        with bar("lengths") as watch:
            return sweep_field(machine, {"edge_length": lengths}, seed=seed, level=result.level, watch=watch)

    return {
        "files": lambda: _files(result, over(), swept),
        "figures": lambda: _figures(result, over(), swept),
    }


def _files(result: TopperField, over: FieldSweep, swept: FieldSweep | None) -> dict[str, str]:
    """Curves as CSV."""
    from linkwright.topping.tables.field import field_csv

    texts = {"share.csv": field_csv(result.curves()), "haulm.csv": field_csv(over.columns())}
    if swept is not None:
        texts["sweep.csv"] = field_csv(swept.columns())
    return texts


def _figures(result: TopperField, over: FieldSweep, swept: FieldSweep | None) -> dict[str, Figure]:
    """Figures by name."""
    from linkwright.topping.figures.field import (
        field_haulm_figure,
        field_length_figure,
        field_share_figure,
        sweep_figures,
    )

    figures = {
        "share": field_share_figure(result),
        "length_needed": field_length_figure(result),
        "haulm_and_loss": field_haulm_figure(result, over),
    }
    return figures if swept is None else figures | sweep_figures(swept)


class Objective(StrEnum):
    """What is best."""

    shortest = "shortest"
    fastest = "fastest"


Best = Annotated[
    Objective,
    Option(
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
    study: ToStudy = None,
    json: Json = False,
    out: Folder = None,
    force: Force = False,
) -> None:
    """The best angle, length and speed of the knife for a field of roots, within [topper.limits].

    The result is verified with other roots and finer steps. Exit code 1 if no knife keeps the limits.
    """
    from linkwright.kernel.command.console import bar
    from linkwright.machine.read import read
    from linkwright.topping.best.best_knife import best_knife

    folder = output_folder(out, force=force)
    machine = read(file, set or [], allow_outside=allow_outside)
    if study is not None:
        from linkwright.studies.best_knives import best_knife_study

        plan = best_knife_study(machine, objective=objective.value, seed=seed)
        hand_over_study(plan, study, file, None if set else machine, force=force, quiet=json)
    with bar("knives") as watch:
        knife = best_knife(machine, objective=objective.value, seed=seed, watch=watch)
    rests = knife.best is not None and knife.best.knife_speed == 0
    hint = [_RESTS] if study is not None and rests else []
    hand_over(_answer(machine, knife, hint), json=json, folder=folder)


# Of the study of a knife that the search alone finds.
_RESTS = "the best knife is at rest, which the study cannot find: its knife speed is greater than 0"


def _answer(machine: Machine, search: KnifeSearch, hint: list[str]) -> Answer:
    """The best knife, also as lines of a machine file; or that none keeps the limits."""
    from linkwright.topping.tables.field import best_lines, best_table, best_warnings

    best, failing = search.best, search.failing
    results: dict[str, Any] = {
        "objective": search.objective,
        "tried": search.tried,
        **({} if best is None else best.to_dict()),
        "failing": failing and {key: getattr(failing, key) for key in ("limit", "wanted", "reached")},
    }
    return Answer(
        machine=machine.name,
        units=machine.units,
        results=lambda _: {"topper_best": results},
        findings=[] if failing is None else [failing.words + "."],
        warnings=[] if failing else [*best_warnings(search), *hint],
        head=lambda: machine.name,
        tables=lambda: [] if best is None else [best_table(search, best)],
        tail=lambda: "" if best is None else best_lines(best),
        files=partial(_best_files, search),
        figures=partial(_best_figures, search),
    )


def _best_files(search: KnifeSearch) -> dict[str, str]:
    """The map, and the knife as lines of a machine file."""
    from linkwright.topping.tables.field import best_lines, map_csv

    texts = {"map.csv": map_csv(search)}
    if search.best is not None:
        texts["topper.toml"] = best_lines(search.best)
    return texts


def _best_figures(search: KnifeSearch) -> dict[str, Figure]:
    """The map; a line is none, nor is a plane without any edge that would do."""
    import numpy as np

    if min(search.map_length.shape) < 2 or not np.isfinite(search.map_length).any():
        return {}
    from linkwright.topping.figures.field import best_knife_figure

    return {"map": best_knife_figure(search)}
