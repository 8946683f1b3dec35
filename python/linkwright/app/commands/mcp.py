"""``linkwright mcp``: checks, results and meanings for assistants, over the Model Context Protocol."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import click

from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.extras import require

Folder = Annotated[
    Path | None,
    Option(
        "--folder", "DIR", "Folder of the machine files; nothing outside is read. Default: the present one."
    ),
]
Seconds = Annotated[float, Option("--seconds", "S", "Maximum time of a tool [s].")]
Skill = Annotated[bool, Option("--skill", help="Print the skill file for assistants, and serve nothing.")]


def mcp(folder: Folder = None, seconds: Seconds = 60.0, skill: Skill = False) -> None:
    """Serve an assistant: check, run, sweep and explain machine files.

    The assistant starts this command and speaks the Model Context Protocol over standard input and output.
    It reads files below one folder, writes none and executes no code.
    """
    if skill:
        from linkwright.app.assistant import SKILL

        click.echo(SKILL.read_text(encoding="utf-8"), nl=False)
        return
    root = folder or Path()
    if not root.is_dir():
        raise InputError(f"--folder: there is no folder {root}")
    if not seconds > 0:
        raise InputError(f"--seconds: found {seconds:g}, expected a time above 0")
    require("mcp.server.mcpserver", "mcp", "a server for assistants needs mcp 2")
    from linkwright.app.assistant.server import server

    if sys.stdin.isatty():
        click.echo("An assistant starts this command and speaks with it; end with Ctrl+C.", err=True)
    server(root, seconds).run("stdio")
