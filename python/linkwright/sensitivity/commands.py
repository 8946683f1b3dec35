"""``linkwright sensitivity FILE``: how the results follow the numbers of the file."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import File, Json, Outside, Sets
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.sensitivity.gradient import Gradient

Of = Annotated[
    list[str] | None,
    Option(
        "--of",
        metavar="RESPONSE",
        help='Result or analysis, such as "steady_state.unevenness", "free_vibration". Repeatable.',
    ),
]
By = Annotated[
    list[str] | None,
    Option(
        "--by",
        metavar="ADDRESS",
        help='Entry, such as "mechanism.cranks.A2.phase". Repeatable. Default: all.',
    ),
]
Out = Annotated[Path | None, out_option("Write results.json and a figure for each response there.")]

# Shown to people without --of: the measures of speed fluctuation and what the motor bears.
_SHOWN = ("unevenness", "dynamism", "motion_coefficient", "speed_mean_time", "torque_motor_rms")


def sensitivity(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    responses: Of = None,
    variables: By = None,
    json: Json = False,
    out: Out = None,
    force: Force = False,
) -> None:
    """Derivatives of the results by the numbers of the file.

    Exact derivatives of every scalar result of the steady motion by every entry, per unit and as a share:
    which dimension, mass or motor entry matters most, and in which direction. Without a motor those of the
    linkage. With --of also of strokes, forces, cams, natural frequencies and torques of shafts.
    """
    from linkwright.machine.read import read
    from linkwright.sensitivity.gradient import gradient
    from linkwright.sensitivity.sources import lost_in
    from linkwright.sensitivity.tables import gradient_tables

    folder = output_folder(out, force=force)
    machine = read(file, set or (), allow_outside=allow_outside)
    derivatives = gradient(machine, responses, variables)
    shown = derivatives if responses else _few(derivatives)
    hand_over(
        Answer(
            machine=machine.name,
            units=machine.units,
            described=machine,
            results=lambda curves: derivatives.to_dict(),
            findings=lost_in(machine, derivatives.responses),
            warnings=[
                *(
                    f"{name} has only one-sided derivatives, or none: {why}"
                    for name, why in derivatives.ties.items()
                ),
                *(f"{name} has no derivative: {why}" for name, why in derivatives.missing.items()),
            ],
            tables=lambda: list(gradient_tables(shown)),
            figures=partial(_figures, shown),
        ),
        json=json,
        folder=folder,
    )


def _few(gradient: Gradient) -> Gradient:
    """What people are shown without --of."""
    few = gradient.only([f"steady_state.{name}" for name in _SHOWN])
    return few if few.responses else gradient


def _figures(gradient: Gradient) -> dict[str, Figure]:
    from linkwright.sensitivity.figures import influence_figure

    return {
        name.replace(".", "_"): influence_figure(gradient, name)
        for name, value in zip(gradient.responses, gradient.values, strict=True)
        if value != 0
    }
