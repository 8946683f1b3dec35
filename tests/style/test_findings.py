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

# Handlers that leave an error of ours without a word, and why nothing is lost by it.
SILENT = {
    (
        "linkages/study.py",
        "_whole",
    ): "the study and the check tell of lengths that no rotator has",
    (
        "app/application.py",
        "_machine_name",
    ): "the name of the machine belongs to a finding, which is reported",
    ("app/report/scene.py", "_closes"): "the same, and a mechanism that does not move is not drawn",
    ("linkages/law_jumps.py", "_bodies_moved"): "what a driver moves is not known, so that all bodies count",
    ("cam/scene.py", "_contacts"): "a cam without room for its second follower is reported by the study",
    ("torsion/figures/captions.py", "_manoeuvre"): "a record too short for orders has no waterfall",
    (
        "studio/controls.py",
        "_number",
    ): "a text that is no quantity is a problem of the file, which stands beside it",
    ("studio/views.py", "thumbnail"): "a machine that cannot be drawn has no picture; opening it says why",
    ("sizing/flywheel.py", "_unevenness"): "no steady motion is an answer there: δ counts as infinite",
    ("studies/sweep.py", "_try"): "what a machine cannot do as it is, its variants may, and each row says so",
    (
        "studies/front.py",
        "_end",
    ): "the best by one goal stands, where a search does not find another that is as good by it",
    (
        "studies/responses.py",
        "require_place",
    ): "a machine without an answer has no list whose length tells anything, and each row says why",
    (
        "studies/slopes.py",
        "_source",
    ): "what has no exact derivatives is differenced, where the analysis says again what is wrong",
    (
        "torsion/study.py",
        "_at_critical",
    ): "a mode in which the first disc is at rest has no Holzer table from that disc",
    (
        "torsion/limits/overlay.py",
        "_kind",
    ): "a unit that none of the quantities has is reported with those that have one",
    (
        "linkages/model/drawing.py",
        "_number",
    ): "a number of the file that is wrong is reported by the element that it stands in",
    (
        "linkages/model/drawing.py",
        "_places",
    ): "a wrong place becomes a fault of the drawing, with its name",
    (
        "kernel/units/spellings.py",
        "_from_pint",
    ): "a text that pint does not know is reported with the units that are known",
    ("drive/settling.py", "in_time"): "what was not found is told; it stays with the advice",
    ("drive/obstacles.py", "_dc_motor"): "without a steady motion no motor is offered; the findings tell why",
}


@cache
def trees() -> tuple[tuple[str, ast.Module], ...]:
    """Modules in which one of the words that are looked for stands at all."""
    texts = ((path, path.read_text(encoding="utf-8")) for path in sorted(SOURCE.rglob("*.py")))
    return tuple(
        (path.relative_to(SOURCE).as_posix(), ast.parse(text))
        for path, text in texts
        if any(word in text for word in ("except", "Findings", "suppress"))
    )


def caught(handler: ast.ExceptHandler) -> set[str]:
    """Names of the types that a handler catches."""
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


def silent_handlers() -> set[tuple[str, str]]:
    found = set()
    for file, tree in trees():
        for function in ast.walk(tree):
            if isinstance(function, ast.FunctionDef):
                for node in ast.walk(function):
                    if isinstance(node, ast.ExceptHandler) and caught(node) & OURS and not is_told(node):
                        found.add((file, function.name))
    return found


def test_no_handler_forgets_an_error_of_ours() -> None:
    assert silent_handlers() == SILENT.keys()


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
        "app/soundness.py",
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
