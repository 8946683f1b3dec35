"""``linkwright fit``: numbers of a machine from a measured record."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, Level, to_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.studies.commands.study_file import Study, StudyFile

if TYPE_CHECKING:
    from linkwright.studies.fit import Fit
    from linkwright.studies.plan import StudyPlan

Recorded = Annotated[
    Path | None,
    Option(
        "--record",
        "CSV",
        "CSV file with a header such as `time [s], speed [rpm]`. Default: that of the study.",
    ),
]
Vary = Annotated[
    list[str] | None,
    Option(
        "--vary",
        "ADDRESS[=LOW:HIGH]",
        'Entry of a machine file to fit, such as  "drive.flywheel.inertia=50:200". Repeatable.',
    ),
]
Motion = Annotated[
    Literal["run_up", "run_down", "coast", "steady_state", "manoeuvre"] | None,
    Option("--motion", help="Recorded motion. Default: that of the study, or run_down."),
]
To = Annotated[FolderOutput, to_folder("Write the fitted machine, a figure and results.json there.")]


def fit(
    file: Study,
    record: Recorded = None,
    vary: Vary = None,
    motion: Motion = None,
    level: Level = 0.95,
    *,
    to: To,
) -> None:
    """Fit numbers of a machine to a measured record, with confidence intervals.

    FILE is a study with a table [fit], or a machine file with --vary. Exit code 1 if the record does not tell
    all that is sought.
    """
    from linkwright.studies.fit import fit as compute
    from linkwright.studies.record import read_record

    plan = _plan(file, vary or [], motion)
    fitted = compute(plan, read_record(_record(file, record, plan), plan.machine), level=level)
    answer = Answer(
        machine=plan.machine,
        names=plan.columns,
        results={"fit": fitted},
        findings=[f"{direction.words}." for direction in fitted.directions if not direction.is_determined],
        warnings=[f"{warning}." for warning in fitted.warnings],
        head=_head(plan.machine.name, fitted),
        tables=later("studies.tables:fit_tables", fitted),
        files={"fitted.toml": later("machine.write:dumps", fitted.machine)},
        figures={"fit": later("studies.figures:fit_figure", fitted)},
    )
    to.hand_over(answer)


def _plan(file: StudyFile, vary: list[str], motion: str | None) -> StudyPlan:
    from linkwright.studies.read import new_study

    if vary:
        machine = file.read()
        variables: dict[str, Any] = {}
        for text in vary:
            name, variable = _variable(text)
            if name in variables:
                raise InputError(f"--vary: found {variable['address']} twice, expected each entry once")
            variables[name] = variable
        return new_study(machine, {"variables": variables, "fit": {"motion": motion or "run_down"}})
    plan = file.study([f"study.fit.motion={motion}"] if motion else [])
    if plan.study.fit is None:
        raise InputError(
            f"{file.file}: found no table [fit], expected one, or --vary ADDRESS of a machine file"
        )
    return plan


def _variable(text: str) -> tuple[str, dict[str, Any]]:
    """A variable out of ``ADDRESS`` or ``ADDRESS=LOW:HIGH``, named as its address with other separators."""
    address, mark, ends = text.partition("=")
    name = address.strip().replace(".", "_").replace('"', "")
    if not mark:
        return name, {"address": address.strip()}
    parts = [_value(part) for part in ends.split(":")]
    if len(parts) != 2:
        raise InputError(f'--vary {text}: found "{ends}", expected LOW:HIGH, such as 50:200 or "0.1 kg:2 kg"')
    return name, {"address": address.strip(), "range": parts}


def _value(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text.strip()


def _record(file: StudyFile, record: Path | None, plan: StudyPlan) -> Path:
    from linkwright.kernel.files.named_file import named_file
    from linkwright.studies.read import study_file

    if record is not None:
        return record
    own = plan.study.fit.record if plan.study.fit is not None else None
    if own is None:
        raise InputError("--record: found nothing, expected a file with what was measured")
    folder = study_file(file.file).parent
    return named_file(own, folder, "fit.record", allow_outside=file.allow_outside)


def _head(name: str, fitted: Fit) -> str:
    samples, channels = len(fitted.record.at), ", ".join(fitted.record.channels)
    how = "exact" if not fitted.jacobian_error else f"by differences, to {fitted.jacobian_error:.1g}"
    noise = ", ".join(
        f"{size:.3g} {fitted.record.unit(channel)}".rstrip() + f" in {channel}"
        for channel, size in fitted.noise.items()
    )
    lines = [name, f"{samples} samples of {channels}; derivatives {how}; noise {noise}"]
    weakest = next((direction for direction in fitted.directions if direction.is_determined), None)
    return "\n".join([*lines, *([] if weakest is None else [f"Worst determined: {weakest.words}."])])
