"""``linkwright torsion damper FILE``: the best damper for a mode of a train."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, to_folder
from linkwright.kernel.command.parameter import Option, Value
from linkwright.kernel.later import later
from linkwright.kernel.units.kinds import INERTIA
from linkwright.machine.file_argument import File


class Kind(StrEnum):
    """What holds the ring."""

    viscous = "viscous"
    tuned = "tuned"
    rubber = "rubber"


On = Annotated[str, Option("--on", "DISC", "Disc that carries the damper.")]
Ring = Annotated[
    float,
    Value("--ring-inertia", INERTIA, 'Moment of inertia of the ring, such as "0.4 kg m^2".', metavar="J"),
]
Mode = Annotated[
    int | None,
    Option("--mode", "N", "Number of the mode, as f_N in the table. Default: the first elastic mode."),
]
Kinds = Annotated[Kind, Option("--kind", help="viscous: fluid; tuned: spring and fluid; rubber: elastomer.")]
Loss = Annotated[float | None, Option("--loss-factor", "ETA", "Loss factor of the rubber.")]
To = Annotated[
    FolderOutput, to_folder("Write damper.json, damper.toml and the response as SVG and PNG there.")
]


def damper(
    file: File,
    on: On,
    ring_inertia: Ring,
    mode: Mode = None,
    kind: Kinds = Kind.viscous,
    loss_factor: Loss = None,
    *,
    to: To,
) -> None:
    """The best damper for a mode: damping, and stiffness, that minimise its resonance."""
    from linkwright.torsion.damper.damper_design import design_damper

    machine = file.read()
    design = design_damper(machine, on, ring_inertia, mode=mode, kind=kind.value, loss_factor=loss_factor)
    lines = later("torsion.tables.engine:damper_lines", design)
    answer = Answer(
        machine=machine,
        results=lambda _: {"damper": design.to_dict(curves=True)},
        tables=later("torsion.tables.engine:damper_table", design),
        tail=lines,
        results_file="damper.json",
        files={"damper.toml": lines},
        figures={"damper": later("torsion.figures.forced:damper_figure", design)},
    )
    to.hand_over(answer)
