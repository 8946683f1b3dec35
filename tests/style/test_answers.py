"""Commands hand their answer over: one module gives it as JSON, and one place ends a command."""

from __future__ import annotations

import ast
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "python" / "linkwright"


def _in_commands() -> dict[str, ast.Module]:
    """Modules of the command line: of the kernel, of the application, of every room."""
    return {
        path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
        for path in PACKAGE.rglob("*.py")
        if {"command", "commands"} & {*path.relative_to(PACKAGE).parts, path.stem}
    }


def test_one_module_makes_the_json_of_answers() -> None:
    makers = set()
    for name, tree in _in_commands().items():
        for node in ast.walk(tree):
            imported = [node.module] if isinstance(node, ast.ImportFrom) else []
            imported += [each.name for each in node.names] if isinstance(node, ast.Import) else []
            if "json" in imported:
                makers.add(name)
    # The schema of machine files is JSON, and no answer about a machine.
    assert makers == {"kernel/command/answer.py", "app/commands/schema.py"}


def test_one_place_ends_a_command_with_a_finding() -> None:
    enders = {
        name
        for name, tree in _in_commands().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and node.attr == "Exit"
    }
    # `common` does so for errors.
    assert enders == {"kernel/command/answer.py", "kernel/command/common.py"}
