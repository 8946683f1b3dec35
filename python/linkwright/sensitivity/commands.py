"""``linkwright sensitivity FILE``: how the results follow the numbers of the file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, to_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.later import later
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.sensitivity.gradient import Gradient

Of = Annotated[
    list[str] | None,
    Option(
        "--of",
        "RESPONSE",
        'Result or analysis, such as "steady_state.unevenness", "free_vibration". Repeatable.',
    ),
]
By = Annotated[
    list[str] | None,
    Option("--by", "ADDRESS", 'Entry, such as "mechanism.cranks.A2.phase". Repeatable. Default: all.'),
]
To = Annotated[FolderOutput, to_folder("Write results.json and a figure for each response there.")]

# Shown to people without --of: the measures of speed fluctuation and what the motor bears.
_SHOWN = ("unevenness", "dynamism", "motion_coefficient", "speed_mean_time", "torque_motor_rms")


def sensitivity(file: File, responses: Of = None, variables: By = None, *, to: To) -> None:
    """Derivatives of the results by the numbers of the file.

    Exact derivatives of every scalar result of the steady motion by every entry, per unit and as a share:
    which dimension, mass or motor entry matters most, and in which direction. Without a motor those of the
    linkage. With --of also of strokes, forces, cams, natural frequencies and torques of shafts.
    """
    from linkwright.sensitivity.gradient import gradient
    from linkwright.sensitivity.sources import lost_in

    machine = file.read()
    derivatives = gradient(machine, responses, variables)
    shown = derivatives if responses else _few(derivatives)
    ties, missing = derivatives.ties.items(), derivatives.missing.items()
    answer = Answer(
        machine=machine,
        is_described=True,
        results=lambda curves: derivatives.to_dict(),
        findings=lost_in(machine, derivatives.responses),
        warnings=[
            *(f"{name} has only one-sided derivatives, or none: {why}" for name, why in ties),
            *(f"{name} has no derivative: {why}" for name, why in missing),
        ],
        tables=later("sensitivity.tables:gradient_tables", shown),
        figures={
            name.replace(".", "_"): later("sensitivity.figures:influence_figure", shown, name)
            for name, value in zip(shown.responses, shown.values, strict=True)
            if value != 0
        },
    )
    to.hand_over(answer)


def _few(gradient: Gradient) -> Gradient:
    few = gradient.only([f"steady_state.{name}" for name in _SHOWN])
    return few if few.responses else gradient
