"""``linkwright balance FILE``: counterweights against the shaking forces."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from linkwright.drive.crank_speed import speed_words, speeds_of
from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import File, Json, Outside, Sets, option_value
from linkwright.kernel.command.out import Force, out_option
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import InputError
from linkwright.kinetostatics.commands.forces import Speed

if TYPE_CHECKING:
    from linkwright.kernel.page.table import Table
    from linkwright.kinetostatics.balancing import Balance
    from linkwright.machine.machine import Machine

Links = Annotated[
    str | None,
    Option(
        "--links",
        metavar="LINK,…",
        help="Links with counterweights, such as A,R.rocker; they turn about fixed points.",
        show_default=False,
    ),
]
Partial = Annotated[
    str | None,
    Option(
        "--slider",
        metavar="SLIDER",
        help="Instead of --links: a counterweight on the crank against a share of this slider's mass.",
        show_default=False,
    ),
]
Share = Annotated[
    float, Option("--share", metavar="X", help="With --slider: share of the reciprocating mass.")
]
Radius = Annotated[
    str | None,
    Option(
        "--radius",
        metavar="LENGTH",
        help="Distance of the counterweights from their pivots. Without it, the length of the link.",
        show_default=False,
    ),
]
OutFile = Annotated[Path | None, out_option("Write the machine with counterweights there.", "FILE")]


def balance(
    file: File,
    set: Sets = None,
    allow_outside: Outside = False,
    links: Links = None,
    slider: Partial = None,
    share: Share = 0.5,
    radius: Radius = None,
    speed: Speed = None,
    json: Json = False,
    out: OutFile = None,
    force: Force = False,
) -> None:
    """Find counterweights.

    Those on given links that minimise the shaking force of inertia, or one on the crank against a
    share of a slider's mass; and what they change.
    """
    from linkwright.machine.read import read

    machine = read(file, set or (), allow_outside=allow_outside)
    found = _found(machine, links, slider, share, radius, speed)
    speeds = speeds_of(found.before.speed, machine, speed)
    hand_over(_answer(machine, found, speeds), json=json, out=out, force=force)


def _found(
    machine: Machine,
    links: str | None,
    slider: str | None,
    share: float,
    radius: str | None,
    speed: str | None,
) -> Balance:
    """The counterweights that the options ask for."""
    from linkwright.kernel.units import LENGTH, SPEED
    from linkwright.kinetostatics.balancing import balance as fit
    from linkwright.kinetostatics.counterweight_formulas import partial_balance

    at = None if radius is None else option_value("--radius", radius, LENGTH)
    omega = None if speed is None else option_value("--speed", speed, SPEED)
    if (links is None) == (slider is None):
        found = "neither" if links is None else "both"
        raise InputError(f"--links or --slider: found {found}, expected one of them")
    if slider is not None:
        return partial_balance(machine, slider, share=share, speed=omega, radius=at)
    names = [each.strip() for each in (links or "").split(",") if each.strip()]
    return fit(machine, names, speed=omega, radius=at)


def _answer(machine: Machine, found: Balance, speeds: dict[str, Any]) -> Answer:
    """The counterweights, and what they change."""
    from linkwright.machine.write import dumps

    measures = {name: {"before": a, "after": b} for name, (a, b) in found.measures().items()}
    weights = {
        each.link: {k: v for k, v in vars(each).items() if k != "link"} for each in found.counterweights
    }
    return Answer(
        machine=machine.name,
        results=lambda _: {"balance": {**speeds, "counterweights": weights, "rms": measures}},
        findings=found.after.findings,
        head=lambda: speed_words(speeds),
        tables=partial(_tables, found),
        machine_file=lambda: dumps(found.machine),
    )


def _tables(found: Balance) -> list[Table]:
    """Tables for people."""
    from linkwright.kinetostatics.tables import balance_tables

    return balance_tables(found)
