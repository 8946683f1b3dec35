"""The table of `docs/notation.md` names what is in the code."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "notation.md"
PYTHON = ROOT / "python" / "linkwright"
CORE = ROOT / "crates"

_NAME = re.compile(r"`(\w+)`")


def rows(page: str) -> Iterator[tuple[str, str, str]]:
    """Term, our words and symbols of each row of the table of terms."""
    table = page.split("## Terms", 1)[1].split("\n## ", 1)[0]
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| ") and len(cells) == 6 and cells[0] not in ("symbol", "---"):
            yield cells[1], cells[4], cells[5]


@cache
def words_of_python() -> set[str]:
    """Names of arguments, of fields and of properties in the rooms of all subjects, and of the machine."""
    found: set[str] = set()
    for path in PYTHON.rglob("*.py"):
        if path.relative_to(PYTHON).parts[0] not in ("kernel", "papers", "app"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                    found.add(node.target.id)
                elif isinstance(node, ast.FunctionDef):
                    found.add(node.name)
                    found |= {each.arg for each in (*node.args.args, *node.args.kwonlyargs)}
    return found


@cache
def words_of_core() -> set[str]:
    texts = (path.read_text(encoding="utf-8") for path in CORE.rglob("*.rs"))
    code = (re.sub(r"//.*", "", text) for text in texts)
    return {word for text in code for word in re.findall(r"\b[A-Za-z_]\w*\b", text)}


def missing(page: str) -> list[str]:
    wrong = []
    for meaning, words, symbols in rows(page):
        wrong += [f"{meaning}: {word}" for word in _NAME.findall(words) if word not in words_of_python()]
        wrong += [
            f"{meaning}: {word} (core)" for word in _NAME.findall(symbols) if word not in words_of_core()
        ]
    return wrong


def test_names_of_the_table_exist() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert len(list(rows(page))) > 30
    assert missing(page) == []


def test_a_name_that_does_not_exist_is_found() -> None:
    page = "## Terms\n\n| φ | angle | IFToMM | rad | `crank_angel` | `phii` |\n"
    assert missing(page) == ["angle: crank_angel", "angle: phii (core)"]
