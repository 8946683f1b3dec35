"""What several analyses of a machine have in common is found once."""

from typing import Any

import pytest

import linkwright as lw
from linkwright.drive import gradient
from linkwright.machine import tangents


class _Counted:
    """Calls of a method of a solution."""

    def __init__(self, solution: Any, calls: list[str]) -> None:
        self._solution, self._calls = solution, calls

    def __getattr__(self, name: str) -> Any:
        self._calls.append(name)
        return getattr(self._solution, name)


def test_analyses_share_directions_solution_and_derivatives(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[str] = []
    solve, translate = gradient.solved_state, tangents.columns

    def solved(*of: Any) -> Any:
        calls.append("solved")
        state, solution = solve(*of)
        return state, _Counted(solution, calls)

    def columns(*of: Any) -> Any:
        calls.append("columns")
        return translate(*of)

    monkeypatch.setattr(gradient, "solved_state", solved)
    monkeypatch.setattr(tangents, "columns", columns)
    machine = lw.read("machines/roller_two_carts.toml")
    together = lw.gradient(machine, ["steady_state", "forces", "run_up"])
    assert [calls.count(name) for name in ("columns", "solved", "gradient")] == [1, 1, 1]
    alone = lw.gradient(machine, ["steady_state.unevenness"], ["mechanism.cranks.A2.phase"])
    assert [calls.count(name) for name in ("columns", "solved", "gradient")] == [2, 1, 2]
    for_all = together.of("steady_state.unevenness")["mechanism.cranks.A2.phase"]
    assert alone.derivatives[0, 0] == pytest.approx(for_all, rel=1e-12)
