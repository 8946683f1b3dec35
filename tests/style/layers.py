"""All imports of the package, also those inside functions: circles of files, and edges that point up.

``python -m tests.style.layers`` prints both.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2] / "python" / "linkwright"


@cache
def files(root: Path = ROOT) -> dict[str, Path]:
    named = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        named[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return named


def imported(path: Path, root: Path = ROOT, *, types: bool = False) -> Iterator[str]:
    """Dotted names below the package that a file imports when it runs, anywhere in it.

    Also functions by their place; what type checkers alone import only with `types`.
    """
    package = path.relative_to(root).parent.parts
    tree = ast.parse(path.read_text(encoding="utf-8"))
    typed = {id(node) for block in ast.walk(tree) if _is_for_types(block) for node in ast.walk(block)}
    for node in ast.walk(tree):
        if id(node) in typed and not types:
            continue
        if isinstance(node, ast.Import):
            yield from (each.name[11:] for each in node.names if each.name.startswith("linkwright."))
        elif isinstance(node, ast.ImportFrom):
            yield from _from(node, package)
        elif (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id in ("of", "later", "at_place")
        ):
            place = node.args[0] if node.args else None
            if isinstance(place, ast.Constant) and ":" in str(place.value):
                yield str(place.value).replace(":", ".")


def _is_for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def _from(node: ast.ImportFrom, package: tuple[str, ...]) -> Iterator[str]:
    """Dotted names of one ``from … import …``."""
    parts = tuple((node.module or "").split(".")) if node.module else ()
    if node.level:
        parts = (*package[: len(package) - node.level + 1], *parts)
    elif parts[:1] == ("linkwright",):
        parts = parts[1:]
    else:
        return
    yield from (".".join((*parts, each.name)) for each in node.names)


def edges(root: Path = ROOT) -> dict[str, set[str]]:
    known = files(root)
    found: dict[str, set[str]] = {}
    for name, path in known.items():
        found[name] = set()
        for target in imported(path, root):
            # A name of a module, or the module itself.
            own = target if target in known else target.rpartition(".")[0]
            if own in known and own not in ("", name):
                found[name].add(own)
    return found


def circles(root: Path = ROOT) -> list[list[str]]:
    """Files that import each other in a circle, the largest circle first (Tarjan)."""
    graph, order, low, stack, found = edges(root), {}, {}, [], []

    def visit(name: str) -> None:
        order[name] = low[name] = len(order)
        stack.append(name)
        for target in sorted(graph[name]):
            if target not in order:
                visit(target)
                low[name] = min(low[name], low[target])
            elif target in stack:
                low[name] = min(low[name], order[target])
        if low[name] == order[name]:
            at = stack.index(name)
            circle, stack[at:] = stack[at:], []
            if len(circle) > 1:
                found.append(sorted(circle))

    for name in sorted(graph):
        if name not in order:
            visit(name)
    return sorted(found, key=len, reverse=True)


if __name__ == "__main__":
    for circle in circles():
        print(f"{len(circle)} files in a circle:", ", ".join(circle))
