"""``linkwright fit``: numbers of a machine from a measured record."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json, Outside, Sets
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option
from linkwright.studies.commands.sweep import StudyArgument

if TYPE_CHECKING:
    from linkwright.studies.fit import Fit
    from linkwright.studies.plan import StudyPlan

Recorded = Annotated[
    Path | None,
    Option(
        "--record",
        metavar="CSV",
        help="CSV file with a header such as `time [s], speed [rpm]`. Default: that of the study.",
    ),
]
Vary = Annotated[
    list[str] | None,
    Option(
        "--vary",
        metavar="ADDRESS[=LOW:HIGH]",
        help='Entry of a machine file to fit, such as  "drive.flywheel.inertia=50:200". Repeatable.',
    ),
]
Motion = Annotated[
    Literal["run_up", "run_down", "coast", "steady_state", "manoeuvre"] | None,
    Option("--motion", help="Recorded motion. Default: that of the study, or run_down."),
]
Level = Annotated[float, Option("--level", metavar="P", help="Confidence level of the intervals.")]
Out = Annotated[Path | None, out_option("Write the fitted machine, a figure and results.json there.")]


def fit(
    file: StudyArgument,
    record: Recorded = None,
    vary: Vary = None,
    motion: Motion = None,
    level: Level = 0.95,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    out: Out = None,
    force: Force = False,
) -> None:
    """Fit numbers of a machine to a measured record, with confidence intervals.

    FILE is a study with a table [fit], or a machine file with --vary. Exit code 1 if the record does not tell
    all that is sought.
    """
    from linkwright.machine.write import dumps
    from linkwright.studies.fit import fit as compute
    from linkwright.studies.record import read_record
    from linkwright.studies.tables import fit_tables

    folder = output_folder(out, force=force)
    plan = _plan(file, vary or [], motion, set or [], allow_outside=allow_outside)
    fitted = compute(
        plan, read_record(_record(file, record, plan, allow_outside=allow_outside), plan.machine), level=level
    )
    hand_over(
        Answer(
            machine=plan.machine.name,
            names=plan.columns,
            units=plan.machine.units,
            results=lambda curves: {"fit": fitted.to_dict(curves=curves)},
            findings=[
                f"{direction.words}." for direction in fitted.directions if not direction.is_determined
            ],
            warnings=[f"{warning}." for warning in fitted.warnings],
            head=lambda: _head(plan.machine.name, fitted),
            tables=lambda: fit_tables(fitted),
            files=lambda: {"fitted.toml": dumps(fitted.machine)},
            figures=lambda: _figures(fitted),
        ),
        json=json,
        folder=folder,
    )


def _plan(
    file: Path, vary: list[str], motion: str | None, changes: list[str], *, allow_outside: bool
) -> StudyPlan:
    """The study of a file, or that of a machine file and of what varies."""
    from linkwright.kernel.errors import InputError
    from linkwright.machine.read import read
    from linkwright.studies.read import new_study, read_study

    if vary:
        machine = read(file, changes, allow_outside=allow_outside)
        variables: dict[str, Any] = {}
        for text in vary:
            name, variable = _variable(text)
            if name in variables:
                raise InputError(f"--vary: found {variable['address']} twice, expected each entry once")
            variables[name] = variable
        return new_study(machine, {"variables": variables, "fit": {"motion": motion or "run_down"}})
    changes = [*changes, f"study.fit.motion={motion}"] if motion else changes
    plan = read_study(file, changes, allow_outside=allow_outside)
    if plan.study.fit is None:
        raise InputError(f"{file}: found no table [fit], expected one, or --vary ADDRESS of a machine file")
    return plan


def _variable(text: str) -> tuple[str, dict[str, Any]]:
    """A variable out of ``ADDRESS`` or ``ADDRESS=LOW:HIGH``, named as its address with other separators."""
    from linkwright.kernel.errors import InputError

    address, mark, ends = text.partition("=")
    name = address.strip().replace(".", "_").replace('"', "")
    if not mark:
        return name, {"address": address.strip()}
    parts = [_value(part) for part in ends.split(":")]
    if len(parts) != 2:
        raise InputError(f'--vary {text}: found "{ends}", expected LOW:HIGH, such as 50:200 or "0.1 kg:2 kg"')
    return name, {"address": address.strip(), "range": parts}


def _value(text: str) -> float | str:
    """A number, or a text with a unit."""
    try:
        return float(text)
    except ValueError:
        return text.strip()


def _record(file: Path, record: Path | None, plan: StudyPlan, *, allow_outside: bool) -> Path:
    """The file of the record; one that a study names lies in its folder."""
    from linkwright.kernel.errors import InputError
    from linkwright.kernel.files.named_file import named_file
    from linkwright.studies.read import study_file

    if record is not None:
        return record
    own = plan.study.fit.record if plan.study.fit is not None else None
    if own is None:
        raise InputError("--record: found nothing, expected a file with what was measured")
    folder = study_file(file).parent
    return named_file(own, folder, "fit.record", allow_outside=allow_outside)


def _head(name: str, fitted: Fit) -> str:
    """What was done, and what is known."""
    samples, channels = len(fitted.record.at), ", ".join(fitted.record.channels)
    how = "exact" if not fitted.jacobian_error else f"by differences, to {fitted.jacobian_error:.1g}"
    noise = ", ".join(
        f"{size:.3g} {fitted.record.unit(channel)}".rstrip() + f" in {channel}"
        for channel, size in fitted.noise.items()
    )
    lines = [name, f"{samples} samples of {channels}; derivatives {how}; noise {noise}"]
    weakest = next((direction for direction in fitted.directions if direction.is_determined), None)
    return "\n".join([*lines, *([] if weakest is None else [f"Worst determined: {weakest.words}."])])


def _figures(fitted: Fit) -> dict[str, Any]:
    from linkwright.studies.figures import fit_figure

    return {"fit": fit_figure(fitted)}
