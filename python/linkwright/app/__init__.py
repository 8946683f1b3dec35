"""The command line, ``linkwright COMMAND …``.

It begins here, before anything large is imported, so that an interrupt from the keyboard is heard at any
time.

| module | |
| --- | --- |
| `application` | All commands, one a file |
| `commands/` | Commands that are of no single subject |
| `curves` | Curves of a study by name: those of all its results, and of its motion over the cycle |
| `lean_start` | What a process that runs one command leaves out when it starts |
| `quantities` | What quantities there are: of a result, and of a whole study |
| `report/` | The report of a study: page, tables, figures, moving sketch, assumptions |
| `soundness` | What a machine can be seen to be unable to do without solving for its motion |
| `study` | A study |
"""

from __future__ import annotations

import gc
import sys
from io import TextIOWrapper

from linkwright.kernel.command.interrupt import Interrupts

# As in `typing`, which is not imported before the command line listens to interrupts.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from linkwright.kernel.command.group import Commands


def application() -> Commands:
    """The command line with all its commands."""
    from linkwright.app.application import application

    return application()


def main() -> None:
    """Run the command line, for the console script."""
    with Interrupts() as interrupts:
        from linkwright.app.lean_start import leave_out

        leave_out()
        # Names may hold letters that the terminal has not; they are no reason to fail.
        if isinstance(sys.stdout, TextIOWrapper):
            sys.stdout.reconfigure(errors="backslashreplace")
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
