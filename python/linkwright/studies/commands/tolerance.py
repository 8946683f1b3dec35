"""``linkwright tolerance``: how results scatter with the tolerances of a machine, and the yield."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json, Outside, Sets
from linkwright.kernel.command.parameter import Option
from linkwright.studies.commands.sweep import StudyArgument

if TYPE_CHECKING:
    from linkwright.studies.plan import StudyPlan
    from linkwright.studies.tolerance import Tolerance

RowCount = Annotated[int, Option("--rows", metavar="N", help="Machines drawn at random.", min=2)]
Seed = Annotated[int, Option("--seed", metavar="N", help="Seed of the random generator.", min=0)]
Blocks = Annotated[
    int, Option("--indices", metavar="N", help="Blocks for Sobol indices, such as 1000; 0 for none.", min=0)
]


def tolerance(
    file: StudyArgument,
    set: Sets = None,
    allow_outside: Outside = False,
    rows: RowCount = 10_000,
    seed: Seed = 0,
    indices: Blocks = 0,
    json: Json = False,
) -> None:
    """How results scatter with the tolerances of a machine, what contributes, and the yield within limits.

    Exit code 1 if no machine within the tolerances keeps the constraints.
    """
    from linkwright.studies.read import read_study
    from linkwright.studies.tables import tolerance_tables
    from linkwright.studies.tolerance import tolerance as compute

    plan = read_study(file, set or [], allow_outside=allow_outside)
    found = compute(plan, rows, seed=seed, indices=indices)
    failed = f"{found.n_failed} of {found.n_rows} machines have no answer; they count as outside the limits."
    answer = Answer(
        machine=plan.machine.name,
        units=plan.machine.units,
        results=lambda _: {"tolerance": found.to_dict()},
        findings=["No machine within the tolerances keeps all limits."] if found.share_within == 0 else [],
        warnings=[
            *([failed] if found.n_failed else []),
            *(f"{name} has a derivative on either side only: {why}" for name, why in found.ties.items()),
        ],
        head=lambda: _head(plan, found),
        tables=lambda: tolerance_tables(found, plan.units),
    )
    hand_over(answer, json=json)


def _head(plan: StudyPlan, found: Tolerance) -> str:
    """Name of the machine and its yield."""
    rest = [name for name in plan.responses if name not in found.exact]
    how = f"by differences of {', '.join(rest)}, exact otherwise" if rest else "exact"
    lines = [plan.machine.name, f"{found.n_rows} machines; derivatives {how}"]
    if found.share_within is not None:
        low, high = 100 * (found.share_low or 0.0), 100 * (found.share_high or 0.0)
        lines.append(
            f"yield {100 * found.share_within:.4g} % within the limits, {low:.4g} to {high:.4g} % at a level "
            f"of {100 * found.level:g} %"
        )
    return "\n".join(lines)
