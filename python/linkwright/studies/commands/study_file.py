"""The study file of a command, and the option ``--study`` of commands that are presets of studies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.common import FolderOutput, Output
from linkwright.kernel.command.out import out_option, say_written
from linkwright.kernel.command.parameter import Argument, Group
from linkwright.machine.file_argument import MachineFile

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine
    from linkwright.studies.plan import StudyPlan

ToStudy = Annotated[
    Path | None,
    out_option("Write the equivalent study, for `linkwright sweep` or `optimise`, there.", "FILE", "--study"),
]


@dataclass(frozen=True)
class StudyFile(MachineFile):
    """A study file, the entries that override its own, and where the files may be that it names."""

    file: Annotated[Path, Argument("FILE", "A study file, or a machine file with a table `study`.")]

    def study(self, entries: Sequence[str] = ()) -> StudyPlan:
        """Its study, with further entries."""
        from linkwright.studies.read import read_study

        return read_study(self.file, [*(self.set or ()), *entries], allow_outside=self.allow_outside)


Study = Annotated[StudyFile, Group(StudyFile)]


def hand_over_study(
    plan: StudyPlan,
    place: Path,
    source: MachineFile | Path,
    machine: Machine | None,
    to: Output,
) -> None:
    """Write the study file of a plan and say where it is, on standard error if standard output is JSON.

    `source`: the file of the machine, or of a task; `to`: what the command writes besides. Raises
    `InputError` if a file cannot be written, or is the one that ``--out`` names.
    """
    from linkwright.kernel.errors import InputError
    from linkwright.kernel.files.output import require_place
    from linkwright.studies.write import beside, write_study

    out = to.out
    if out is not None and not isinstance(to, FolderOutput):
        if out.resolve() in (place.resolve(), beside(place).resolve()):
            raise InputError(f"--out {out}: found a file that --study writes; name another one")
        require_place(out, replace=to.force)
    given = source.file if isinstance(source, MachineFile) else source
    # A machine with other entries than those of its file is written whole.
    described = None if isinstance(source, MachineFile) and source.set else machine
    say_written(write_study(plan, place, given, described, force=to.force), quiet=to.json)
