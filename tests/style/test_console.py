"""Words of a machine file reach the terminal and the figures as they are, since one module makes them so."""

from __future__ import annotations

import ast
import re
from pathlib import Path

from rich.table import Table

from linkwright.kernel.command.console import console, styled
from linkwright.kernel.errors import printable

PACKAGE = Path(__file__).parents[2] / "python" / "linkwright"


def test_one_module_makes_consoles() -> None:
    makers, calls = set(), ("Console", "from_markup", "render_markup", "rprint")
    texts = ((path, path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py"))
    for path, text in texts:
        for node in ast.walk(ast.parse(text)) if any(call in text for call in calls) else ():
            if isinstance(node, ast.Call):
                name = getattr(node.func, "attr", getattr(node.func, "id", ""))
                if name in calls:
                    makers.add(path.relative_to(PACKAGE).as_posix())
    assert makers == {"kernel/command/console.py"}


def test_no_markup_is_written() -> None:
    markup = re.compile(r"\[/?(?:bold|dim|red|green|yellow|cyan|/)[^\]\"]*\]")
    found = [
        path.name
        for path in PACKAGE.rglob("*.py")
        if {"command", "commands"} & {*path.parts, path.stem} and markup.search(path.read_text("utf-8"))
    ]
    assert found == ["console.py"]


def test_markup_of_data_is_shown(capsys) -> None:  # type: ignore[no-untyped-def]
    words = "[/x] [red]a[/red] :smile: [link=http://x]y[/link] \\[b]"
    out = console()
    out.print(words)
    out.print(styled((words, "bold")))
    table = Table(words, title=words, caption=words)
    table.add_row(words)
    out.print(table)
    shown = capsys.readouterr().out
    assert shown.count("[red]a[/red] :smile: [link=http://x]y[/link] \\[b]") == 6


def test_letters_that_steer_the_terminal_are_shown() -> None:
    assert printable("a\x1b[2J\u202eb\r\nж😀") == "a\\x1b[2J\\u202eb\\r\nж😀"
