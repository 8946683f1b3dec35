"""``linkwright new TEMPLATE``: a machine file, a study or a task of synthesis to start from."""

from __future__ import annotations

from typing import Annotated

import click

from linkwright.kernel.command.out import Force, Out, put
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import InputError

Template = Annotated[str | None, Argument("TEMPLATE", "Name of the template; --list lists them.")]
List = Annotated[
    bool, Option("--list", help="List the templates; with pumping-unit, the units of the catalogue.")
]
Designation = Annotated[
    str | None, Option("--designation", help="Designation of a pumping unit, such as C-114D-133-54.")
]
Hole = Annotated[int | None, Option("--hole", help="Crank hole of the pumping unit, 1 for the outermost.")]

# The template that is filled from the catalogue of pumping units.
_UNIT = "pumping-unit"


def new(
    template: Template = None,
    designation: Designation = None,
    hole: Hole = None,
    out: Out = None,
    force: Force = False,
    list: List = False,
) -> None:
    """Write a machine file, a study or a task to start from.

    It goes to standard output, or to --out.
    """
    from linkwright.kernel.files.library import study_templates, task_templates, templates
    from linkwright.kernel.files.library import template as text_of
    from linkwright.pumping.model.unit_catalogue import unit_template

    if list or template is None:
        known = templates() | study_templates() | task_templates()
        click.echo("\n".join(_units() if template == _UNIT else _rows(known)))
        return
    if template == _UNIT:
        put(unit_template(designation, hole), out, force=force)
        return
    if designation is not None or hole is not None:
        raise InputError(f"--designation and --hole belong to the template {_UNIT}, found {template}")
    put(text_of(template), out, force=force)


def _rows(known: dict[str, str]) -> list[str]:
    words = known | {
        _UNIT: "Beam pumping unit of the catalogue: --designation, --hole; --list names the units"
    }
    return [f"  {name:<14} {text}" for name, text in sorted(words.items())]


def _units() -> list[str]:
    from linkwright.pumping.model.unit_catalogue import pumping_units

    return [
        f"  {unit.designation:<14} strokes "
        + ", ".join(f"{float(unit.unit(n).stroke):.3f} m" for n in range(1, len(unit.holes) + 1))
        for unit in pumping_units()
    ]
