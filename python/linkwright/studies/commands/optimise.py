"""``linkwright optimise``: the machine that is best by the goal of a study."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from linkwright.kernel.command.answer import Answer, hand_over
from linkwright.kernel.command.common import Json, Outside, Sets, belong_to
from linkwright.kernel.command.out import Force, Out
from linkwright.kernel.command.parameter import Option
from linkwright.kernel.errors import FindingError
from linkwright.studies.commands.sweep import StudyArgument, one_by_one_warnings

if TYPE_CHECKING:
    from linkwright.studies.front import Front
    from linkwright.studies.optimise import Optimum
    from linkwright.studies.plan import StudyPlan

Evaluations = Annotated[
    int,
    Option(
        "--evaluations",
        metavar="N",
        help="Maximum number of machines for each combination of values.",
        min=10,
    ),
]
Way = Annotated[
    Literal["both", "global", "gradient"],
    Option(
        "--method",
        help="both: CMA-ES, then derivatives; global: CMA-ES; gradient: derivatives from several starts.",
    ),
]
Starts = Annotated[int, Option("--starts", metavar="N", help="Number of starts of --method gradient.", min=1)]
Points = Annotated[
    int, Option("--points", metavar="N", help="Number of machines of the front of two goals.", min=3)
]
Seed = Annotated[int, Option("--seed", metavar="N", help="Seed of the random generator.", min=0)]

Log = Annotated[
    Path | None,
    Option("--log", metavar="FILE", help="Log of the search; the same command resumes a search from it."),
]


def optimise(
    file: StudyArgument,
    set: Sets = None,
    allow_outside: Outside = False,
    evaluations: Evaluations = 4000,
    seed: Seed = 0,
    method: Way = "both",
    starts: Starts = 8,
    points: Points = 9,
    log: Log = None,
    json: Json = False,
    out: Out = None,
    force: Force = False,
) -> None:
    """The best machine by the goal of a study, within its constraints; with --out as a machine file.

    Of two goals the machines of which none is better in both; with --out that in the middle. Exit code 1 if
    none keeps the constraints.
    """
    from linkwright.studies.read import read_study

    plan = read_study(file, set or [], allow_outside=allow_outside)
    belong_to(
        *(
            ("--method both or global", "evaluations")
            if method == "gradient"
            else ("--method gradient", "starts")
        )
    )
    if len(plan.study.goals) == 2:
        options = {"seed": seed, "method": method, "starts": starts, "log": log}
        _hand_over_front(plan, points, evaluations, options, json=json, out=out, force=force)
        return
    belong_to("a study of two goals", "points")
    search = {"evaluations": evaluations, "seed": seed, "method": method, "starts": starts, "log": log}
    hand_over_optimum(plan, search, json=json, out=Path(out) if out else None, force=force)


def hand_over_optimum(
    plan: StudyPlan, options: dict[str, Any], *, json: bool, out: Path | None, force: bool, untried: str = ""
) -> None:
    """The best machine of a study, or why there is none, with what was left `untried`."""
    from linkwright.machine.write import dumps
    from linkwright.studies.optimise import optimise as compute
    from linkwright.studies.tables import optimum_tables

    try:
        optimum = compute(plan, **options)
    except FindingError as error:
        hand_over(Answer(machine=plan.machine.name, findings=[f"{error}{untried}"]), json=json)
        return
    answer = Answer(
        machine=plan.machine.name,
        names=plan.columns,
        units=plan.machine.units,
        results=lambda _: {"optimum": optimum.to_dict()},
        findings=optimum.findings,
        warnings=[
            *_flat_warnings(optimum),
            *([optimum.fast_starts] if optimum.fast_starts else []),
            *one_by_one_warnings(optimum.one_by_one),
        ],
        head=lambda: _head(plan.machine.name, optimum),
        tables=lambda: optimum_tables(optimum, plan.units),
        machine_file=lambda: dumps(optimum.machine),
    )
    hand_over(answer, json=json, out=out, force=force)


def _hand_over_front(
    plan: StudyPlan,
    points: int,
    evaluations: int,
    options: dict[str, Any],
    *,
    json: bool,
    out: Path | None,
    force: bool,
) -> None:
    """The machines of which none is better in both goals."""
    from linkwright.machine.write import dumps
    from linkwright.studies.front import front
    from linkwright.studies.tables import front_tables

    try:
        best = front(plan, points, evaluations, **options)
    except FindingError as error:
        hand_over(Answer(machine=plan.machine.name, findings=[str(error)]), json=json)
        return
    middle = best.machines[len(best.machines) // 2]
    answer = Answer(
        machine=plan.machine.name,
        names=plan.columns,
        units=plan.machine.units,
        results=lambda _: {"front": best.to_dict()},
        warnings=[
            *dict.fromkeys(text for machine in best.machines for text in _flat_warnings(machine)),
            *(f"no machine has {limit}: {reason}" for limit, reason in best.failed.items()),
            *_short_warnings(best, points),
            *(f"Machine {n}: {one.fast_starts}" for n, one in enumerate(best.machines, 1) if one.fast_starts),
            *one_by_one_warnings(best.one_by_one),
        ],
        head=lambda: f"{plan.machine.name}\n{best.n_evaluations} machines computed",
        tables=lambda: front_tables(best, plan.units),
        machine_file=lambda: dumps(middle.machine),
    )
    hand_over(answer, json=json, out=Path(out) if out else None, force=force)


def _short_warnings(best: Front, points: int) -> list[str]:
    """That the front has fewer machines than were asked for."""
    without = points - len(best.failed) - len(best.machines)
    if without <= 0:
        return []
    counted = f"{without} of the {points} machines sought {'is' if without == 1 else 'are'} left out"
    return [f"{counted}: others are as good in {best.goals[0]} and in {best.goals[1]}"]


def _flat_warnings(optimum: Optimum) -> list[str]:
    """That no machine is better than another."""
    if not optimum.is_flat:
        return []
    value = f"{optimum.responses[optimum.goal]:.6g}"
    return [f"{optimum.goal} is {value} for all machines: it does not depend on the variables"]


def _head(name: str, optimum: Optimum) -> str:
    """What was done, and what limits the answer."""
    failed = f", {optimum.n_failed} without a result" if optimum.n_failed else ""
    limits = "; ".join(optimum.active) or "no limit is active"
    return "\n".join([name, f"{optimum.n_evaluations} machines computed{failed}", limits, *optimum.worth])
