"""``linkwright tolerance``: how results scatter with the tolerances of a machine, and the yield."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Output, Seed, belong_to, to_screen
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import FindingError
from linkwright.kernel.later import later
from linkwright.studies.commands.study_file import Study
from linkwright.studies.commands.sweep import one_by_one_warnings, unwatched_contacts

if TYPE_CHECKING:
    from linkwright.studies.allocation import Allocation
    from linkwright.studies.plan import StudyPlan
    from linkwright.studies.tolerance import Tolerance

RowCount = Annotated[int, Option("--rows", "N", "Number of random machines.", min=2)]
Blocks = Annotated[
    int,
    Option("--indices", "N", "Number of blocks for Sobol indices, such as 1000; 0 for none.", min=0),
]

Wanted = Annotated[
    float | None,
    Option(
        "--allocate",
        "SHARE",
        "Find the cheapest tolerances for this yield, such as 0.99, from the `cost` of each.",
    ),
]
Power = Annotated[float, Option("--cost-power", "K", "Cost of a tolerance f times as wide: cost / f^K.")]


def tolerance(
    file: Study,
    rows: RowCount = 10_000,
    seed: Seed = 0,
    indices: Blocks = 0,
    wanted: Wanted = None,
    power: Power = 1.0,
    *,
    to: Annotated[Output, to_screen()],
) -> None:
    """How results scatter with the tolerances of a machine, what contributes, and the yield within limits.

    Exit code 1 if no machine within the tolerances keeps the constraints.
    """
    from linkwright.studies.plan import with_tolerances
    from linkwright.studies.rows import fast_start_warnings
    from linkwright.studies.tolerance import tolerance as compute

    plan = with_tolerances(file.study())
    if wanted is not None:
        belong_to("the scatter of the tolerances as they are, without --allocate", "indices")
        to.hand_over(_allocation(plan, wanted, power, rows, seed))
        return
    belong_to("--allocate", "power")
    scatter = compute(plan, rows, seed=seed, indices=indices)
    answer = Answer(
        machine=plan.machine,
        names=plan.columns,
        results={"tolerance": scatter},
        findings=["No machine within the tolerances keeps all limits."] if scatter.share_within == 0 else [],
        warnings=[
            *_failed(scatter),
            *_dropped(scatter, indices),
            *(_bent(name, scatter.responses[name], plan.units[name]) for name in scatter.bent),
            *(
                f"The worst case of {name} may be wider than stated: {why}"
                for name, why in scatter.beyond_corners.items()
            ),
            *(f"{name} has only one-sided derivatives, or none: {why}" for name, why in scatter.ties.items()),
            *fast_start_warnings(scatter.fast_starts),
            *one_by_one_warnings(scatter.one_by_one),
            *unwatched_contacts(plan),
        ],
        head=_head(plan, scatter),
        tables=later("studies.tables:tolerance_tables", scatter, plan.units),
    )
    to.hand_over(answer)


def _failed(scatter: Tolerance) -> list[str]:
    if not scatter.n_failed:
        return []
    return [
        f"{scatter.n_failed} of {scatter.n_rows} machines have no result; they count as outside the limits; "
        f"most often: {next(iter(scatter.reasons))}"
    ]


def _dropped(scatter: Tolerance, n: int) -> list[str]:
    if not scatter.n_dropped:
        return []
    total = {name: index for name, (_, index) in scatter.failure_indices.items()}
    most = max(total, key=total.__getitem__)
    return [
        f"{scatter.n_dropped} of {n} blocks are omitted from the Sobol indices, since a machine of each "
        f"has no result; {most} has the most influence on whether it has one, with a total index of "
        f"{total[most]:.3g}."
    ]


def _bent(name: str, row: Mapping[str, float], unit: str) -> str:
    from linkwright.kernel.reader.numbers import measured

    shown = {key: measured(value, unit) for key, value in row.items()}
    return (
        f"{name} is not linear within the tolerances, so that its contributions, which are to first "
        f"order, do not hold: 99.73 % of the machines lie from {shown['band_low']} to "
        f"{shown['band_high']}, its standard deviation is {shown['deviation']}, to first order "
        f"{shown['deviation_first_order']}."
    )


def _allocation(plan: StudyPlan, wanted: float, power: float, rows: int, seed: int) -> Answer:
    from linkwright.studies.allocation import allocate
    from linkwright.studies.rows import fast_start_warnings

    try:
        allocation = allocate(plan, wanted, power=power, rows=rows, seed=seed)
    except FindingError as error:
        return Answer(machine=plan.machine, findings=[str(error)])
    low, high = 100 * allocation.share_low, 100 * allocation.share_high
    head = (
        f"{plan.machine.name}\ncost {allocation.cost:.4g} instead of {allocation.cost_before:.4g}; yield "
        f"{100 * allocation.share_within:.4g} % ({low:.4g} to {high:.4g} %) instead of "
        f"{100 * allocation.share_before:.4g} %\n{_held(allocation)}"
    )
    return Answer(
        machine=plan.machine,
        names=plan.columns,
        results={"allocation": allocation},
        warnings=[
            *fast_start_warnings(allocation.fast_starts),
            *one_by_one_warnings(allocation.one_by_one),
        ],
        head=head,
        tables=later("studies.tables:allocation_tables", allocation, plan.units),
    )


def _held(allocation: Allocation) -> str:
    if allocation.active:
        return f"limited by {', '.join(allocation.active)}"
    return "no constraint limits them: they are at the upper end of the search"


def _head(plan: StudyPlan, scatter: Tolerance) -> str:
    rest = [name for name in plan.responses if name not in scatter.exact]
    how = f"by differences of {', '.join(rest)}, exact otherwise" if rest else "exact"
    lines = [plan.machine.name, f"{scatter.n_rows} machines; derivatives {how}"]
    if scatter.share_within is not None:
        low, high = 100 * (scatter.share_low or 0.0), 100 * (scatter.share_high or 0.0)
        lines.append(
            f"yield {100 * scatter.share_within:.4g} % within the limits, {low:.4g} to {high:.4g} % at a "
            f"level of {100 * scatter.level:g} %"
        )
    if scatter.indices:
        lines.append(
            f"Sobol indices ± half the width of their intervals at a level of {100 * scatter.level:g} %"
        )
    return "\n".join(lines)
