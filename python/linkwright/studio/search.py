"""Sweeps and optimisations of the machine on the page: studies made of its entries, told as they go on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from time import monotonic
from typing import Any

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.machine.machine import Machine
from linkwright.studies.engine import evaluate
from linkwright.studies.optimise import optimise
from linkwright.studies.plan import StudyPlan
from linkwright.studies.rows import fast_start_warnings
from linkwright.studio.design import kept, study_of
from linkwright.studio.document import short

Body = dict[str, Any]
Tell = Callable[[Body], None]

# Values of a curve, and of each entry of a map, at most; machines of a search.
_VALUES, _SIDE, _MACHINES = 401, 61, 20_000

# Rows that are computed before the first message to the page, and seconds between two messages of a search.
_ROWS, _PAUSE = 64, 0.15


def search(machine: Machine, asked: Body, tell: Tell) -> Body:
    """Compute a curve or a map over entries, or the best machine, and tell what is there so far.

    `asked`: ``kind``, ``"sweep"`` or ``"optimise"``; ``response``; ``bounds``, what other results keep to;
    ``entries``, each with ``address``,
    ``low`` and ``high`` [SI]; of a sweep, ``steps`` of each entry; of an optimisation ``direction``,
    ``"minimise"`` or ``"maximise"``, and ``machines``.

    Returns all of it: of a sweep ``axes`` and ``values``, NaN as gaps; of an optimisation ``entries``,
    address → value, ``value``, and how the search went on; ``warnings`` say which rows fail, or run away from
    fast starts.
    """
    run = {"sweep": _sweep, "optimise": _optimise}.get(str(asked.get("kind")))
    if run is None:
        raise InputError("expected a sweep or an optimisation")
    return run(machine, asked, tell)


def _plan(machine: Machine, asked: Body, **more: Any) -> StudyPlan:
    entries = {
        entry["address"]: {"range": (entry["low"], entry["high"])}
        | ({"steps": entry["steps"]} if "steps" in entry else {})
        for entry in asked["entries"]
    }
    return study_of(machine, asked["response"], entries, asked.get("bounds", {}), **more)


def _sweep(machine: Machine, asked: Body, tell: Tell) -> Body:
    entries, most = asked["entries"], _VALUES if len(asked["entries"]) == 1 else _SIDE
    if len(entries) > 2 or any(not 2 <= int(entry["steps"]) <= most for entry in entries):
        raise InputError(f"steps: expected 2 to {most} of each of at most two entries")
    study = _plan(machine, asked)
    values = np.full(study.n_rows, np.nan)
    reasons, fast_starts = Counter[str](), Counter[str]()
    axes = [
        {"address": entry["address"], "values": np.linspace(entry["low"], entry["high"], int(entry["steps"]))}
        for entry in entries
    ]
    done = 0
    while True:
        sweep = {"of": "search", "kind": "sweep", "response": asked["response"], "axes": axes}
        warnings = [f"{n} without an answer: {why}" for why, n in reasons.items()]
        warnings += fast_start_warnings(fast_starts)
        sweep |= {"values": values, "done": done, "rows": len(values), "warnings": warnings}
        if done == len(values):
            return sweep
        tell(sweep)
        end = min(done + _ROWS, len(values))
        rows = evaluate(study, study.rows(done, end))
        keeps = kept(study, rows.columns)
        values[done:end] = np.where(keeps, rows.columns["y"], np.nan)
        reasons.update(rows.failures())
        if broken := int(np.sum(~keeps & np.isfinite(rows.columns["y"]))):
            reasons["beyond the limits of other results"] += broken
        fast_starts.update(rows.not_settling())
        done = end


def _optimise(machine: Machine, asked: Body, tell: Tell) -> Body:
    direction, machines = str(asked.get("direction")), min(int(asked.get("machines", 2000)), _MACHINES)
    study = _plan(machine, asked, goals={"y": direction})
    addresses = {f"v{n}": entry["address"] for n, entry in enumerate(asked["entries"])}
    counts: list[int] = []
    course: list[float] = []
    last = [monotonic()]

    def body(at: dict[str, float], value: float | None, **more: Any) -> Body:
        entries = {addresses[name]: float(short(value)) for name, value in at.items()}
        answer = {"of": "search", "kind": "optimise", "response": asked["response"], "rows": machines}
        answer |= {"course": {"machines": np.array(counts, float), "best": np.array(course)}}
        return answer | {"done": counts[-1] if counts else 0, "entries": entries, "value": value, **more}

    def watch(count: int, value: float | None, at: dict[str, float]) -> None:
        counts.append(count)
        course.append(np.nan if value is None else value)
        if monotonic() - last[0] > _PAUSE:
            last[0] = monotonic()
            tell(body(at, value))

    optimum = optimise(study, machines, watch=watch)
    best = {name: float(value) for name, value in optimum.variables.items()}
    warnings = [optimum.fast_starts] if optimum.fast_starts else []
    return body(best, optimum.responses["y"], last=True, failed=optimum.n_failed, warnings=warnings)
