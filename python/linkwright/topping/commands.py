"""``linkwright topper field FILE``: a topper over a field of roots; ``topper best FILE``: its best knife."""

from __future__ import annotations

from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, Level, to_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.command.value import stepped
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import at_place, later
from linkwright.kernel.limits import FIELD_VARIANTS
from linkwright.machine.file_argument import File
from linkwright.studies.commands.study_file import ToStudy, hand_over_study

if TYPE_CHECKING:
    from linkwright.topping.best.best_knife import KnifeSearch
    from linkwright.topping.sweep import FieldSweep


Over = Annotated[
    list[str] | None,
    Option(
        "--over",
        "NAME=LOW:HIGH:N",
        'Variable, such as edge_length=0.1:0.3:21 or edge_angle="0 deg":"40 deg":9: edge_length, '
        "edge_angle, forward_speed, knife_speed, cut_height. A second one: all combinations.",
    ),
]
Seed = Annotated[
    int | None,
    Option("--seed", "N", "Seed of the random generator, instead of that of the field."),
]
To = Annotated[
    FolderOutput, to_folder("Write results.json, curves as CSV, and figures as SVG and PNG there.")
]

# Lengths at which the haulm that is left is examined for its figure.
_LENGTHS = 31


def field(
    file: File, over: Over = None, seed: Seed = None, level: Level = 0.95, study: ToStudy = None, *, to: To
) -> None:
    """A field of roots: share of heads cut through, haulm that is left, loss, length for all shares.

    Exit code 1 if the file has [topper.limits] that are not kept.
    """
    import numpy as np

    from linkwright.kernel.command.console import bar
    from linkwright.studies.knives import sweep_field
    from linkwright.topping.edge import edges_of, require_topper
    from linkwright.topping.field import topper_field
    from linkwright.topping.warnings import field_findings, field_warnings

    machine, axes = file.read(), _axes(over or [])
    described = require_topper(machine)
    if study is not None:
        from linkwright.studies.knives import field_study

        if not axes:
            raise InputError("--study: found it without --over, expected an entry that varies beside it")
        plan = field_study(machine, axes, seed=seed, level=level)
        hand_over_study(plan, study, file, machine, to)
    with bar("heads") as watch:
        result = topper_field(machine, seed=seed, level=level, watch=watch)
    swept: FieldSweep | None = None
    if axes:
        with bar("variants") as watch:
            swept = sweep_field(machine, axes, seed=seed, level=level, watch=watch)

    @cache
    def over_lengths() -> FieldSweep:
        """The field over all lengths of the edge, which curves and figures show: computed once."""
        lengths = np.linspace(0, result.length[-1], _LENGTHS)[1:]
        with bar("lengths") as watch:
            return sweep_field(machine, {"edge_length": lengths}, seed=seed, level=level, watch=watch)

    results: dict[str, Any] = {"topper_field": result.to_dict()}
    tables = [later("topping.tables.field:field_tables", result)]
    files: dict[str, Any] = {
        "share.csv": later("topping.tables.field:field_csv", result.curves()),
        "haulm.csv": lambda: at_place("topping.tables.field:field_csv")(over_lengths().columns()),
    }
    if swept is not None:
        columns = {key: column.tolist() for key, column in swept.columns().items()}
        results["topper_field_sweep"] = {"shape": list(swept.shape), **columns}
        tables.append(later("topping.tables.field:sweep_table", swept))
        files["sweep.csv"] = later("topping.tables.field:field_csv", swept.columns())
    answer = Answer(
        machine=machine,
        results=results,
        findings=list(field_findings(result, described)),
        warnings=list(field_warnings(result, described, edges_of(machine, described)[0].knife)),
        head=machine.name,
        tables=tables,
        files=files,
        figures=lambda: {
            "share": at_place("topping.figures.field:field_share_figure")(result),
            "length_needed": at_place("topping.figures.field:field_length_figure")(result),
            "haulm_and_loss": at_place("topping.figures.field:field_haulm_figure")(result, over_lengths()),
            **({} if swept is None else at_place("topping.figures.field:sweep_figures")(swept)),
        },
    )
    to.hand_over(answer)


def _axes(wanted: list[str]) -> dict[str, Any]:
    import numpy as np

    from linkwright.topping.sweep import ENTRIES

    example = "edge_length=0.1:0.3:21 for 21 values from 0.1 to 0.3 m"
    axes = stepped("--over", wanted, ENTRIES, "an entry of the knife", example, FIELD_VARIANTS)
    if len(axes) > 2:
        raise InputError(f"--over: found {len(axes)} names, expected two at most")
    return {name: np.linspace(*steps) for name, steps in axes.items()}


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
    seed: Seed = None,
    study: ToStudy = None,
    *,
    to: To,
) -> None:
    """The best angle, length and speed of the knife for a field of roots, within [topper.limits].

    The result is verified with other roots and finer steps. Exit code 1 if no knife keeps the limits.
    """
    from linkwright.kernel.command.console import bar
    from linkwright.topping.best.best_knife import best_knife
    from linkwright.topping.tables.field import best_warnings

    machine = file.read()
    if study is not None:
        from linkwright.studies.best_knives import best_knife_study

        plan = best_knife_study(machine, objective=objective.value, seed=seed)
        hand_over_study(plan, study, file, machine, to)
    with bar("knives") as watch:
        search = best_knife(machine, objective=objective.value, seed=seed, watch=watch)
    best, failing = search.best, search.failing
    results: dict[str, Any] = {
        "objective": search.objective,
        "tried": search.tried,
        **({} if best is None else best.to_dict()),
        "failing": failing and {key: getattr(failing, key) for key in ("limit", "wanted", "reached")},
    }
    rests = study is not None and best is not None and best.knife_speed == 0
    lines = later("topping.tables.field:best_lines", best)
    answer = Answer(
        machine=machine,
        results={"topper_best": results},
        findings=[] if failing is None else [failing.words + "."],
        warnings=[] if failing else [*best_warnings(search), *([_RESTS] if rests else [])],
        head=machine.name,
        tables=[] if best is None else later("topping.tables.field:best_table", search, best),
        tail="" if best is None else lines,
        files={
            "map.csv": later("topping.tables.field:map_csv", search),
            **({} if best is None else {"topper.toml": lines}),
        },
        figures=_map(search),
    )
    to.hand_over(answer)


# Of the study of a knife that the search alone finds.
_RESTS = "the best knife is at rest, which the study cannot find: its knife speed is greater than 0"


def _map(search: KnifeSearch) -> dict[str, Any]:
    import numpy as np

    if min(search.map_length.shape) < 2 or not np.isfinite(search.map_length).any():
        return {}
    return {"map": later("topping.figures.field:best_knife_figure", search)}
