"""``linkwright loads FILE``: loads on single links, for finite elements."""

from __future__ import annotations

from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.drive.crank_speed import speed_words, speeds_of
from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Curves, FolderOutput, ZeroAt, belong_to, to_folder
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.kinetostatics.commands import Acceleration, Angle, Frictions, Span, Speed
from linkwright.machine.file_argument import File

if TYPE_CHECKING:
    from linkwright.finite_elements.result import LinkLoads
    from linkwright.finite_elements.steps import Model, NodeSet


class Solver(StrEnum):
    """For which program steps are written."""

    abaqus = "abaqus"
    calculix = "calculix"


class Unit(StrEnum):
    """Unit of length of the model."""

    mm = "mm"
    m = "m"


Links = Annotated[
    list[str] | None,
    Option("--link", "NAME", "Link or block, such as R.coupler. Repeatable. Default: all."),
]
SolverName = Annotated[
    Solver | None, Option("--solver", help="With --out: steps with the loads at the peaks of each link.")
]
UnitName = Annotated[
    Unit,
    Option("--length-unit", help="With --solver: of the model; mm goes with N, t and s, m with N, kg and s."),
]
Elements = Annotated[str, Option("--elements", "ELSET", "With --solver: set of all elements.")]
Nodes = Annotated[
    list[str] | None,
    Option(
        "--nodes",
        '"LOAD: NSET, N"',
        "With --solver: node set of a joint, drive or load, and how many nodes share the force, such as "
        '"A: PIN_A, 24". Repeatable. Default: one reference node, N_A.',
    ),
]
Grid = Annotated[
    Path | None,
    Option(
        "--mesh",
        "FILE",
        "With --solver calculix: mesh of the link in its axes, for the load of the angular acceleration.",
    ),
]
To = Annotated[
    FolderOutput,
    to_folder("Write results.json, a CSV file and steps of each link, and figures there.", curves=Curves),
]


def loads(
    file: File,
    link: Links = None,
    speed: Speed = None,
    acceleration: Acceleration = None,
    angles: Span = None,
    zero: ZeroAt = None,
    friction: Frictions = None,
    solver: SolverName = None,
    length_unit: UnitName = Unit.mm,
    elements: Elements = "EALL",
    nodes: Nodes = None,
    mesh: Grid = None,
    *,
    pressure_angle: Angle,
    to: To,
) -> None:
    """Loads on single links in their own axes, for finite elements.

    Forces and moments at each joint, weight, inertia, acceleration field and an estimate of the bending
    moment over the cycle; with --out as CSV, with --solver as steps of Abaqus or CalculiX at the peaks.
    """
    from linkwright.finite_elements.loads import loads_of_links
    from linkwright.kernel.files.output import file_names
    from linkwright.kinetostatics.commands import angle_range, frictions_of, nothing_to_carry
    from linkwright.kinetostatics.motion import motion_at
    from linkwright.kinetostatics.places import Scene
    from linkwright.linkages.zero import zero_over

    if solver is None:
        belong_to("--solver", "length_unit", "elements", "nodes", "mesh")
    elif to.out is None:
        raise InputError("--solver: found without --out, expected the folder of the steps")
    if acceleration is not None and speed is None:
        raise InputError("--acceleration: it belongs to --speed; a steady motion has its own")
    machine = file.read()
    motion = motion_at(
        machine, None, speed=speed, acceleration=acceleration or 0.0, angles=angle_range(angles, speed)
    )
    scene = Scene(machine, motion)
    wanted = tuple(dict.fromkeys(link or scene.structure.members))
    links = loads_of_links(scene, wanted, frictions_of(machine, friction or []), pressure_angle)
    model = None if solver is None else _model(solver, length_unit, elements, nodes or [], mesh, links)
    speeds = speeds_of(motion.speed, machine, speed)
    names = file_names(dict.fromkeys(links, ""))
    answer = Answer(
        machine=machine,
        is_described=True,
        zero=zero_over(machine, zero, *links.values()),
        results={"loads": links},
        findings=next(iter(links.values())).findings,
        warnings=[*nothing_to_carry(machine), *_left_out(links, model)],
        head=partial(speed_words, speeds),
        tables=later("finite_elements.tables:links_tables", links),
        files={
            f"{names[name]}.csv": later("kernel.page.table:curves_csv", one) for name, one in links.items()
        }
        | (
            {} if model is None else {f"{names[name]}.inp": _steps(one, model) for name, one in links.items()}
        ),
        figures=later("finite_elements.figures:captioned_links", links),
    )
    to.hand_over(answer)


def _steps(loads: LinkLoads, model: Model) -> str:
    from dataclasses import replace

    from linkwright.finite_elements.steps import step_text

    own = {name: nodes for name, nodes in model.sets.items() if name in loads.loads}
    return step_text(loads, replace(model, sets=own))


def _model(
    solver: Solver,
    unit: Unit,
    elements: str,
    nodes: list[str],
    mesh: Path | None,
    links: dict[str, LinkLoads],
) -> Model:
    """The model that the steps are for; wrong options are reported before anything is written."""
    from linkwright.finite_elements.mesh import read_mesh
    from linkwright.finite_elements.steps import Model

    if mesh is not None and (solver is not Solver.calculix or len(links) != 1):
        raise InputError("--mesh: it belongs to --solver calculix and one --link")
    sets = dict(_node_set(text) for text in nodes)
    known = dict.fromkeys(name for loads in links.values() for name in loads.loads)
    if unknown := [name for name in sets if name not in known]:
        raise InputError(f'--nodes: found "{unknown[0]}", expected one of {", ".join(known)}')
    length = 1e-3 if unit is Unit.mm else 1.0
    return Model(solver.value, length, elements, sets, None if mesh is None else read_mesh(mesh))


def _node_set(text: str) -> tuple[str, NodeSet]:
    """Name of a load, and its node set."""
    from linkwright.finite_elements.steps import NodeSet

    # The last colon with a blank: a pin's name may hold one.
    name, colon, entries = text.rpartition(": ")
    own, _, count = (part.strip() for part in entries.partition(","))
    if not colon or not own or (count and not count.isdecimal()) or count == "0":
        example = '"A: PIN_A, 24"'
        raise InputError(f'--nodes: found "{text}", expected load, colon, set and number, as in {example}')
    return name, NodeSet(own, int(count or 1))


def _left_out(links: dict[str, LinkLoads], model: Model | None) -> list[str]:
    """Links whose angular acceleration CalculiX cannot take without a mesh."""
    if model is None or model.solver != "calculix" or model.mesh is not None:
        return []
    turning = [name for name, loads in links.items() if loads.acceleration.any()]
    return [
        f"The steps of {name} leave out its angular acceleration, for which CalculiX has no load: give its "
        "mesh with --mesh."
        for name in turning
    ]
