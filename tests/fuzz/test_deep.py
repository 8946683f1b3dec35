"""The runner of random cases itself: whatever a case does, its process goes on and says what came of it."""

from __future__ import annotations

from typing import Any

import deep
import kinds
import pytest
from numpy.random import Generator

from linkwright.kernel.errors import AssemblyError


class Pipe:
    """Hands out cases and keeps the answers."""

    def __init__(self, cases: list[tuple[str, int]]) -> None:
        self.cases, self.answers = cases, list[Any]()

    def recv(self) -> tuple[str, int]:
        if not self.cases:
            raise EOFError
        return self.cases.pop(0)

    def send(self, answer: Any) -> None:
        self.answers.append(answer)


def test_an_error_that_escapes_a_case_is_told_and_the_next_case_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    def case(_random: Generator) -> None:
        raise AssemblyError("the links do not close at 30 deg")

    monkeypatch.setitem(kinds.KINDS, "escaping", kinds.Kind(case, 1, 1))
    monkeypatch.setitem(kinds.KINDS, "sound", kinds.Kind(lambda _random: None, 1, 1))
    monkeypatch.setattr(deep.resource, "setrlimit", lambda *_: None)
    pipe = Pipe([("escaping", 1), ("sound", 2)])
    with pytest.raises(EOFError):
        deep.worker(pipe)  # type: ignore[arg-type]
    (what, inputs), answer = pipe.answers
    assert what == "the case itself failed: AssemblyError: the links do not close at 30 deg"
    assert "in case" in inputs["traceback.txt"]
    assert answer is None
