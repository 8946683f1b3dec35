"""A group of commands in which a word that is none of them goes to one command: ``linkwright cam FILE``."""

from __future__ import annotations

from typing import Any, ClassVar

from typer.core import TyperGroup

# Words that belong to the group itself.
_HELP = ("--help", "-h")


def group_with_default(name: str) -> type[TyperGroup]:
    """A kind of group with a default command.

    Parameters
    ----------
    name : str
        Command that takes what follows the group's name if that is no command.

    Returns
    -------
    type
        For ``typer.Typer(cls=…)``.
    """

    class WithDefault(TyperGroup):
        """A group that hands unknown first words to its default command."""

        default: ClassVar[str] = name

        def parse_args(self, context: Any, args: list[str]) -> list[str]:
            """Put the default command in front where none is named."""
            if args and args[0] not in self.commands and args[0] not in _HELP:
                args = [self.default, *args]
            return super().parse_args(context, args)

        def resolve_command(self, context: Any, args: list[str]) -> Any:
            """Leave the name of the default command out of what is shown as its usage."""
            found, command, rest = super().resolve_command(context, args)
            return None if found == self.default else found, command, rest

    return WithDefault
