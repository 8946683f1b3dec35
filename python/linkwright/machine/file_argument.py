"""The machine file of a command, with the options that change what is read of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.common import Outside, Sets
from linkwright.kernel.command.parameter import Argument, Group

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine


@dataclass(frozen=True)
class MachineFile:
    """A machine file, the entries that override its own, and where the files may be that it names."""

    file: Annotated[Path, Argument("FILE", "The machine file.")]
    set: Sets = None
    allow_outside: Outside = False

    def read(self, entries: Sequence[str] = ()) -> Machine:
        """Its machine, with further entries."""
        from linkwright.machine.read import read

        return read(self.file, [*(self.set or ()), *entries], allow_outside=self.allow_outside)


File = Annotated[MachineFile, Group(MachineFile)]
