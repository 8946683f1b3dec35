"""``linkwright optimise``: the machine that is best by the goal of a study."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Output, Seed, belong_to, to_file
from linkwright.kernel.command.console import progress
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import FindingError
from linkwright.kernel.later import later
from linkwright.studies.commands.study_file import Study
from linkwright.studies.commands.sweep import one_by_one_warnings

if TYPE_CHECKING:
    from linkwright.studies.front import Front
    from linkwright.studies.optimise import Optimum
    from linkwright.studies.plan import StudyPlan

Evaluations = Annotated[
    int,
    Option("--evaluations", "N", "Maximum number of machines for each combination of values.", min=10),
]
Way = Annotated[
    Literal["both", "global", "gradient"],
    Option(
        "--method",
        help="both: CMA-ES, then derivatives; global: CMA-ES; gradient: derivatives from several starts.",
    ),
]
Starts = Annotated[int, Option("--starts", "N", "Number of starts of --method gradient.", min=1)]
Points = Annotated[int, Option("--points", "N", "Number of machines of the front of two goals.", min=3)]
Log = Annotated[
    Path | None,
    Option("--log", "FILE", "Log of the search; the same command resumes a search from it."),
]


def optimise(
    file: Study,
    evaluations: Evaluations = 4000,
    seed: Seed = 0,
    method: Way = "both",
    starts: Starts = 8,
    points: Points = 9,
    log: Log = None,
    *,
    to: Annotated[Output, to_file("Write there.")],
) -> None:
    """The best machine by the goal of a study, within its constraints; with --out as a machine file.

    Of two goals the machines of which none is better in both; with --out that in the middle. Exit code 1 if
    none keeps the constraints.
    """
    plan = file.study()
    belong_to(
        *(
            ("--method both or global", "evaluations")
            if method == "gradient"
            else ("--method gradient", "starts")
        )
    )
    search = {"evaluations": evaluations, "seed": seed, "method": method, "starts": starts, "log": log}
    if len(plan.study.goals) == 2:
        to.hand_over(_front(plan, points, search))
        return
    belong_to("a study of two goals", "points")
    to.hand_over(optimum_answer(plan, search))


def optimum_answer(plan: StudyPlan, options: dict[str, Any], untried: str = "") -> Answer:
    """The best machine of a study, or why there is none, with what was left `untried`."""
    from linkwright.studies.optimise import optimise as compute

    try:
        with progress("computing machines") as shown:
            optimum = compute(plan, **options, watch=_watch(shown))
    except FindingError as error:
        return Answer(machine=plan.machine, findings=[f"{error}{untried}"])
    return Answer(
        machine=plan.machine,
        names=plan.columns,
        results={"optimum": optimum},
        findings=optimum.findings,
        warnings=[
            *_flat_warnings(optimum),
            *([optimum.fast_starts] if optimum.fast_starts else []),
            *one_by_one_warnings(optimum.one_by_one),
        ],
        head=_head(plan.machine.name, optimum),
        tables=later("studies.tables:optimum_tables", optimum, plan.units),
        machine_file=later("machine.write:dumps", optimum.machine),
    )


def _watch(shown: Any) -> Callable[..., None] | None:
    """How many machines were computed, where somebody looks."""
    if shown is None:
        return None
    return lambda count, value, at: shown.update(f"machines computed: {count}")


def _front(plan: StudyPlan, points: int, options: dict[str, Any]) -> Answer:
    from linkwright.studies.front import front

    try:
        best = front(plan, points, **options)
    except FindingError as error:
        return Answer(machine=plan.machine, findings=[str(error)])
    middle = best.machines[len(best.machines) // 2]
    return Answer(
        machine=plan.machine,
        names=plan.columns,
        results={"front": best},
        warnings=[
            *dict.fromkeys(text for machine in best.machines for text in _flat_warnings(machine)),
            *(f"no machine has {limit}: {reason}" for limit, reason in best.failed.items()),
            *_short_warnings(best, points),
            *(f"Machine {n}: {one.fast_starts}" for n, one in enumerate(best.machines, 1) if one.fast_starts),
            *one_by_one_warnings(best.one_by_one),
        ],
        head=f"{plan.machine.name}\n{best.n_evaluations} machines computed",
        tables=later("studies.tables:front_tables", best, plan.units),
        machine_file=later("machine.write:dumps", middle.machine),
    )


def _short_warnings(best: Front, points: int) -> list[str]:
    without = points - len(best.failed) - len(best.machines)
    if without <= 0:
        return []
    counted = f"{without} of the {points} machines sought {'is' if without == 1 else 'are'} left out"
    return [f"{counted}: others are as good in {best.goals[0]} and in {best.goals[1]}"]


def _flat_warnings(optimum: Optimum) -> list[str]:
    if not optimum.is_flat:
        return []
    value = f"{optimum.responses[optimum.goal]:.6g}"
    return [f"{optimum.goal} is {value} for all machines: it does not depend on the variables"]


def _head(name: str, optimum: Optimum) -> str:
    failed = f", {optimum.n_failed} without a result" if optimum.n_failed else ""
    limits = "; ".join(optimum.active) or "no limit is active"
    return "\n".join([name, f"{optimum.n_evaluations} machines computed{failed}", limits, *optimum.worth])
