"""``linkwright new TEMPLATE``: a machine file to start from."""

from __future__ import annotations

from typing import Annotated

import typer

from linkwright.cli.common import Force, Out, put

Template = Annotated[
    str | None,
    typer.Argument(metavar="TEMPLATE", help="Name of the template; --list names them.", show_default=False),
]
List = Annotated[bool, typer.Option("--list", help="Name the templates.")]


def new(template: Template = None, out: Out = None, force: Force = False, list: List = False) -> None:
    """Write a machine file to start from.

    It goes to standard output, or to --out.
    """
    from linkwright.files.templates import template as text_of
    from linkwright.files.templates import templates

    if list or template is None:
        rows = (f"  {name:<14} {words}" for name, words in templates().items())
        typer.echo("\n".join(rows))
        return
    put(text_of(template), out, force=force)
