"""No finding is dropped: one collector a study, and no handler that forgets what it caught."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import linkwright
from linkwright.kernel import errors

SOURCE = Path(linkwright.__file__).parent

OURS = {
    name
    for name, each in vars(errors).items()
    if isinstance(each, type) and issubclass(each, errors.LinkwrightError)
} | {"Exception", "BaseException"}


@cache
def trees() -> tuple[tuple[str, ast.Module], ...]:
    texts = ((path, path.read_text(encoding="utf-8")) for path in sorted(SOURCE.rglob("*.py")))
    return tuple(
        (path.relative_to(SOURCE).as_posix(), ast.parse(text))
        for path, text in texts
        if any(word in text for word in ("except", "Findings", "suppress"))
    )


def caught(handler: ast.ExceptHandler) -> set[str]:
    kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return {
        each.attr if isinstance(each, ast.Attribute) else getattr(each, "id", "BaseException")
        for each in kinds
    }


def is_told(handler: ast.ExceptHandler) -> bool:
    """Whether the error is raised on, replaced by another, or used by its name."""
    inside = [node for statement in handler.body for node in ast.walk(statement)]
    names = {node.id for node in inside if isinstance(node, ast.Name)}
    return handler.name in names or any(isinstance(node, ast.Raise) for node in inside)


def test_a_handler_that_forgets_an_error_of_ours_says_why() -> None:
    forgotten = []
    for file, tree in trees():
        lines = (SOURCE / file).read_text(encoding="utf-8").splitlines()
        handlers = [node for node in ast.walk(tree) if isinstance(node, ast.ExceptHandler)]
        silent = [node for node in handlers if caught(node) & OURS and not is_told(node)]
        forgotten += [
            f"{file}:{node.lineno}"
            for node in silent
            if "# silent: " not in "".join(lines[node.lineno - 1 : node.body[0].lineno])
        ]
    assert not forgotten, forgotten


def test_a_study_has_one_collector_of_findings() -> None:
    # A second collector is one whose findings nobody asks for; a check is a study of its own, and so are
    # a motion in time, contacts, and what the studio computes while a slider is held.
    made = [
        file
        for file, tree in trees()
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Findings"
    ]
    assert sorted(made) == [
        "app/feasibility.py",
        "app/study.py",
        "drive/commands.py",
        "kernel/findings.py",
        "kinetostatics/contact.py",
        "studio/analyses.py",
    ]


def test_nothing_is_suppressed_by_contextlib() -> None:
    used = [
        file for file, tree in trees() for node in ast.walk(tree) if getattr(node, "id", "") == "suppress"
    ]
    assert used == []
