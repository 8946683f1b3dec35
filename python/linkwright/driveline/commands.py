"""``linkwright elastic FILE``: steady motion of an elastic driveline, also over a number of its file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import FolderOutput, belong_to, to_folder
from linkwright.kernel.command.parameter import Group, Option
from linkwright.kernel.errors import InputError
from linkwright.kernel.later import later
from linkwright.machine.file_argument import File
from linkwright.machine.machine import Machine

Over = Annotated[
    str | None,
    Option("--over", "ADDRESS", 'Follow the motion over this number, such as "drive.crankshaft.stiffness".'),
]
First = Annotated[str | None, Option("--from", "VALUE", 'First end of its range, such as "5 kN m/rad".')]
Last = Annotated[str | None, Option("--to", "VALUE", "Other end of its range.")]
To = Annotated[FolderOutput, to_folder("Write results.json and the figure as SVG and PNG there.")]


@dataclass(frozen=True)
class RangeOptions:
    """The number that is changed."""

    over: Over = None
    first: First = None
    last: Last = None


def elastic(file: File, *, along: Annotated[RangeOptions, Group(RangeOptions)], to: To) -> None:
    """Steady motion of a torsionally flexible driveline with its mechanism.

    Torques of the shafts, motion of the stations, Floquet multipliers, and further steady motions where links
    have backlash or a torque curve. With --over: the branch of steady motions over a number of the file, also
    through folds, with the motions that are stable and the points where their stability changes. Exit code 1
    if there is no steady motion, or a permitted torque is exceeded.

    Example: linkwright elastic press.toml --over drive.crankshaft.stiffness --from "5 kN m/rad" --to
    "50 kN m/rad".
    """
    if along.over is None:
        belong_to("--over", "first", "last")
    machine = file.read()
    to.hand_over(_motion(machine) if along.over is None else _branches(machine, along.over, along))


def _motion(machine: Machine) -> Answer:
    from linkwright.driveline.elastic_motion import elastic_motion

    motion = elastic_motion(machine, others=True)
    return Answer(
        machine=machine,
        results=lambda curves: {"elastic_motion": motion.to_dict(curves=curves)},
        findings=motion.findings,
        tables=later("driveline.tables:elastic_tables", motion),
        figures={"elastic_motion": later("driveline.figures:elastic_figure", motion)},
    )


def _branches(machine: Machine, address: str, along: RangeOptions) -> Answer:
    from linkwright.driveline.branches import elastic_branches

    first, last = (
        _value(machine, address, option, text)
        for option, text in (("--from", along.first), ("--to", along.last))
    )
    branches = elastic_branches(machine, address, first, last)
    return Answer(
        machine=machine,
        results=lambda _: {"elastic_branches": branches.to_dict()},
        tables=later("driveline.branch_tables:branch_tables", branches),
        figures={"elastic_branches": later("driveline.branch_tables:branch_figure", branches)},
    )


def _is_plain(text: str) -> bool:
    """Whether a text is a plain number, which is taken in SI."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _value(machine: Machine, address: str, option: str, text: Any) -> float:
    from linkwright.machine.address import kind
    from linkwright.machine.size_limits import parsed

    its_kind = kind(machine, address)
    if its_kind is None:
        raise InputError(f"--over: found {address}, expected the address of a number")
    if text is None:
        raise InputError(f"{option}: found nothing, expected an end of the range of {address}")
    return parsed(option, float(text) if _is_plain(text) else text, its_kind)
