"""The runner of random cases itself: whatever a case does, its process goes on and says what came of it."""

from __future__ import annotations

import multiprocessing as mp
import time
from functools import partial
from typing import Any

import broken
import kinds
import pytest
from broken import PromiseError, watched
from numpy.random import Generator
from sizes import generator, told

import linkwright as lw
from linkwright import AssemblyError

pytest.importorskip("resource", reason="limits of Unix")
import deep


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


def test_a_failed_case_is_told_by_its_seeds_and_its_machine_as_a_file() -> None:
    generator(7, 12)
    machine = lw.read("press_with_flywheel")
    with pytest.raises(PromiseError) as failed:
        raise PromiseError("energy", {"command": "run"})
    texts = told(failed.value)
    assert texts["command"] == "run"
    assert texts["random case"] == "generator(7, 12)"
    assert lw.loads(texts["machine.toml"]) == machine


def test_a_case_is_judged_by_the_processor_time_that_it_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A case that waits for a busy machine goes on; an endless computation and a deadlock are reported."""
    with watched({}, seconds=0.1):
        time.sleep(0.3)
    with pytest.raises(PromiseError, match=r"within 0\.1 s of processor time"), watched({}, seconds=0.1):
        _spin()
    monkeypatch.setattr(broken, "CLOCK", 2.0)
    with pytest.raises(PromiseError, match=r"within 0\.2 s on the clock"), watched({}, seconds=0.1):
        time.sleep(60.0)


def _spin() -> None:
    while True:
        pass


def test_a_process_that_cannot_be_interrupted_is_judged_by_its_processor_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    context = mp.get_context("fork")
    pipe, _ = context.Pipe()
    monkeypatch.setattr(deep, "HARD_SECONDS", 0.2)
    for work, hangs in ((_spin, True), (partial(time.sleep, 60.0), False)):
        process = context.Process(target=work, daemon=True)
        process.start()
        runner = deep.Runner(process, pipe, since=time.monotonic())
        end = time.monotonic() + (20.0 if hangs else 0.6)
        while not runner.hangs() and time.monotonic() < end:
            time.sleep(0.02)
        assert runner.hangs() is hangs
        process.kill()
        process.join()
