"""The command line, ``linkwright COMMAND …``.

It begins here, before anything large is imported, so that an interrupt from the keyboard is heard at any
time.

| module | |
| --- | --- |
| `application` | All commands, one a file |
| `assistant/` | Tools for programs that write machine files |
| `commands/` | Commands that are of no single subject |
| `curves` | Curves of a study by name: those of all its results, and of its motion over the cycle |
| `feasibility` | What a machine can be seen to be unable to do without solving for its motion |
| `plotted` | What `plot` of machines, studies and sweeps draws |
| `quantities` | What quantities there are: of a result, and of a whole study |
| `report/` | The report of a study: page, tables, figures, moving sketch, assumptions |
| `study` | A study |
| `subjects` | All analyses, as their rooms declare them |
"""

from __future__ import annotations

import gc
import os
import sys
from io import StringIO, TextIOWrapper
from types import ModuleType

from linkwright.kernel.command.interrupt import Interrupts

# As in `typing`, which is not imported before the command line listens to interrupts.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from linkwright.kernel.command.group import Commands


def application() -> Commands:
    """The command line with all its commands."""
    from linkwright.app.application import application

    return application()


def _leave_out() -> None:
    """Leave out plugins of pydantic and threads of linear algebra, before either is imported."""
    # The command line alone does so: a program that imports the package keeps its own settings.
    # Looking for plugins of pydantic among all installed packages costs more than reading a machine file.
    # The module that would look for them imports what reads metadata of packages, and mails.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    sys.modules.setdefault("pydantic.plugin._loader", _without_plugins())
    # Threads of linear algebra start with NumPy and wait busily. The matrices of a machine are small; what is
    # large has threads of its own in the core.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def _without_plugins() -> ModuleType:
    """In place of the module of pydantic that looks for plugins: there are none."""
    module = ModuleType("pydantic.plugin._loader")
    module.get_plugins = tuple  # type: ignore[attr-defined]
    return module


def _take_all_letters() -> None:
    """Let standard output and standard error take letters that the terminal or the code page has not."""
    from linkwright.kernel.system import WINDOWS

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            # Pipes and files have the code page of Windows; JSON is UTF-8 (RFC 8259, 8.1).
            is_coded = WINDOWS and not stream.isatty() and "PYTHONIOENCODING" not in os.environ
            stream.reconfigure(encoding="utf-8" if is_coded else None, errors="backslashreplace")


def main() -> None:
    """Run the command line, for the console script."""
    with Interrupts() as interrupts:
        _leave_out()
        # A stream that the caller has closed takes nothing; the exit code still tells.
        for name in ("stdout", "stderr"):
            if getattr(sys, name) is None:
                setattr(sys, name, StringIO())
        _take_all_letters()
        # A start makes some 100 000 objects that all stay; looking among them for rubbish takes time.
        gc.set_threshold(200_000)
        commands = application()
        # The command that is asked for is imported while an interrupt still ends the program on the spot.
        commands.get_command(None, *sys.argv[1:2] or [""])
        interrupts.raise_from_now_on()
        try:
            commands()
        finally:
            # Nor is there a reason to look among them when the program ends.
            gc.freeze()
