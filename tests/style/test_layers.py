"""Imports point down, from a layer to the ones below it; within one layer only inside one's own folder."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2] / "python" / "linkwright"

LEVEL = {
    "limits": 0,
    "errors": 1,
    "units": 2,
    "public": 2,
    "motion_laws": 3,
    "machine": 4,
    "files": 5,
    "engine": 5,
    "analysis": 6,
    "sweep": 7,
    "synthesis": 8,
    "sizing": 8,
    "plot": 9,
    "exchange": 9,
    "report": 10,
    "papers": 10,
    "cli": 11,
    "studio": 11,
}


def imports(path: Path, root: Path = ROOT) -> Iterator[tuple[str, ...]]:
    """Dotted names below linkwright that a file imports, also inside its functions."""
    package = path.relative_to(root).parent.parts
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for each in node.names:
                parts = tuple(each.name.split("."))
                if parts[0] == "linkwright" and len(parts) > 1:
                    yield parts[1:]
        elif isinstance(node, ast.ImportFrom):
            yield from _imported_from(node, package)


def _imported_from(node: ast.ImportFrom, package: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """Dotted names below linkwright of one ``from … import …``."""
    parts = tuple((node.module or "").split(".")) if node.module else ()
    if node.level:
        parts = (*package[: len(package) - node.level + 1], *parts)
    elif parts[:1] == ("linkwright",):
        parts = parts[1:]
    else:
        return
    yield from [parts] if parts else [(each.name,) for each in node.names]


def wrong_imports(root: Path) -> list[str]:
    """Imports that do not point down; `engine` alone may import the compiled core."""
    wrong = []
    for path in sorted(root.rglob("*.py")):
        part = path.relative_to(root).with_suffix("").parts[0]
        if part.startswith("__"):
            continue
        for target in imports(path, root):
            top = target[0]
            if top == "_core":
                allowed = part == "engine"
            else:
                allowed = top == part or (top in LEVEL and part in LEVEL and LEVEL[top] < LEVEL[part])
            if not allowed:
                wrong.append(f"{path.relative_to(root)} imports {'.'.join(target)}")
    return wrong


def test_imports_point_down() -> None:
    wrong = wrong_imports(ROOT)
    assert not wrong, "\n".join(wrong)


def test_every_part_has_a_level() -> None:
    parts = {path.relative_to(ROOT).with_suffix("").parts[0] for path in ROOT.rglob("*.py")}
    assert {part for part in parts if not part.startswith("__")} <= set(LEVEL)


def test_a_wrong_import_is_found(tmp_path: Path) -> None:
    files = {
        "units.py": "from linkwright.machine import Machine",
        "files/read.py": "def f():\n    from linkwright import engine",
        "engine.py": "from linkwright import _core\nfrom . import files\nimport linkwright.machine",
        "sizing/motor.py": "from ..synthesis import cam\nfrom .shaft import x\nfrom linkwright import _core",
        "errors.py": "import numpy",
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    assert wrong_imports(tmp_path) == [
        "engine.py imports files",
        "files/read.py imports engine",
        "sizing/motor.py imports synthesis",
        "sizing/motor.py imports _core",
        "units.py imports machine",
    ]
