"""The option ``--study`` of commands that are presets of studies: the equivalent study file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.out import out_option, say_written

if TYPE_CHECKING:
    from linkwright.machine.machine import Machine
    from linkwright.studies.plan import StudyPlan

ToStudy = Annotated[
    Path | None,
    out_option("Write the equivalent study, for `linkwright sweep` or `optimise`, there.", "FILE", "--study"),
]


def hand_over_study(
    plan: StudyPlan,
    place: Path,
    source: Path,
    described: Machine | None,
    *,
    force: bool,
    quiet: bool,
    out: Path | None = None,
) -> None:
    """Write the study file of a plan and say where it is, on standard error if `quiet`.

    `source`: the machine file; `described`: its machine, None if other entries were given beside it; `out`:
    what the command writes besides. Raises `InputError` if a file cannot be written, or is `out`.
    """
    from linkwright.kernel.errors import InputError
    from linkwright.kernel.files.output import require_place
    from linkwright.studies.write import beside, write_study

    if out is not None:
        if out.resolve() in (place.resolve(), beside(place).resolve()):
            raise InputError(f"--out {out}: found a file that --study writes; name another one")
        require_place(out, replace=force)
    say_written(write_study(plan, place, source, described, force=force), quiet=quiet)
