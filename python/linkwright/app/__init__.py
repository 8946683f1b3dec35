"""The command line, ``linkwright COMMAND …``.

It begins here, before anything large is imported, so that an interrupt from the keyboard is heard at any
time.
"""

from __future__ import annotations

import os
import sys
from io import TextIOWrapper
from typing import TYPE_CHECKING

from linkwright.kernel.command.interrupt import Interrupts

if TYPE_CHECKING:
    import typer


def application() -> typer.Typer:
    """The command line with all its commands."""
    from linkwright.app.application import application

    return application()


def main() -> None:
    """Run the command line, for the console script."""
    with Interrupts() as interrupts:
        # Looking for plugins of pydantic among all installed packages costs more than reading a machine file.
        os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
        # Names may hold letters that the terminal has not; they are no reason to fail.
        if isinstance(sys.stdout, TextIOWrapper):
            sys.stdout.reconfigure(errors="backslashreplace")
        app = application()
        interrupts.raise_from_now_on()
        app()
