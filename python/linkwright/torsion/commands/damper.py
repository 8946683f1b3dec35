"""``linkwright torsion damper FILE``: the best damper for a mode of a train."""

from __future__ import annotations

from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, hand_over, is_reported
from linkwright.kernel.command.common import File, Json, Outside, Sets, option_value
from linkwright.kernel.command.out import Force, out_option, output_folder
from linkwright.kernel.command.parameter import Option

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.machine.machine import Machine
    from linkwright.torsion.damper.damper_design import DamperDesign


class Kind(StrEnum):
    """What holds the ring."""

    viscous = "viscous"
    tuned = "tuned"
    rubber = "rubber"


On = Annotated[str, Option("--on", metavar="DISC", help="Disc that carries the damper.")]
Ring = Annotated[
    str, Option("--ring-inertia", metavar="J", help='Moment of inertia of the ring, such as "0.4 kg m^2".')
]
Mode = Annotated[
    int | None,
    Option(
        "--mode",
        metavar="N",
        help="Number of the mode, as f_N in the table. Default: the first elastic mode.",
    ),
]
Kinds = Annotated[Kind, Option("--kind", help="viscous: fluid; tuned: spring and fluid; rubber: elastomer.")]
Loss = Annotated[float | None, Option("--loss-factor", metavar="ETA", help="Loss factor of the rubber.")]
Folder = Annotated[
    Path | None, out_option("Write damper.json, damper.toml and the response as SVG and PNG there.")
]


def damper(
    file: File,
    on: On,
    ring_inertia: Ring,
    mode: Mode = None,
    kind: Kinds = Kind.viscous,
    loss_factor: Loss = None,
    set: Sets = None,
    allow_outside: Outside = False,
    json: Json = False,
    out: Folder = None,
    force: Force = False,
) -> None:
    """The best damper for a mode: damping, and stiffness, that minimise its resonance."""
    from linkwright.kernel.units.kinds import INERTIA
    from linkwright.machine.read import read
    from linkwright.torsion.damper.damper_design import design_damper

    folder = output_folder(out, force=force)
    machine = read(file, set or [], allow_outside=allow_outside)
    ring = option_value("--ring-inertia", ring_inertia, INERTIA)
    design = design_damper(machine, on, ring, mode=mode, kind=kind.value, loss_factor=loss_factor)
    hand_over(_answer(machine, design), json=json, folder=folder)


def _answer(machine: Machine, design: DamperDesign) -> Answer:
    """The damper, also as lines of a machine file."""
    from linkwright.machine.table import part_names
    from linkwright.torsion.tables.engine import damper_lines, damper_table

    return Answer(
        machine=machine.name,
        names=part_names(machine) if is_reported() else (),
        units=machine.units,
        results=lambda _: {"damper": design.to_dict(curves=True)},
        tables=lambda: [damper_table(design)],
        tail=partial(damper_lines, design),
        results_file="damper.json",
        files=lambda: {"damper.toml": damper_lines(design)},
        figures=partial(_figures, design),
    )


def _figures(design: DamperDesign) -> dict[str, Figure]:
    """The response, with and without it."""
    from linkwright.torsion.figures.forced import damper_figure

    return {"damper": damper_figure(design)}
