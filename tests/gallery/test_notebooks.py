"""Every cell of the notebooks in the documentation runs, and what it shows can be shown."""

from __future__ import annotations

import ast
import json
from io import BytesIO
from pathlib import Path

import pytest
from matplotlib.figure import Figure

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))


def cells(notebook: Path) -> list[str]:
    """Code of a notebook, without commands of the notebook itself."""
    sources = (
        "".join(cell["source"])
        for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]
        if cell["cell_type"] == "code"
    )
    return ["\n".join(line for line in code.splitlines() if not line.startswith("%")) for code in sources]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_cell_runs(notebook: Path) -> None:
    names: dict[str, object] = {}
    for code in cells(notebook):
        tree = ast.parse(code)
        *before, last = tree.body
        exec(compile(ast.Module(before, []), notebook.name, "exec"), names)
        if not isinstance(last, ast.Expr):
            exec(compile(ast.Module([last], []), notebook.name, "exec"), names)
            continue
        value = eval(compile(ast.Expression(last.value), notebook.name, "eval"), names)
        if isinstance(value, Figure):
            value.savefig(BytesIO())
        elif hasattr(value, "_repr_html_"):
            assert "<table" in value._repr_html_()
        elif isinstance(value, bool):
            assert value, code


def test_notebooks_are_kept_without_results() -> None:
    assert len(NOTEBOOKS) == 5
    for notebook in NOTEBOOKS:
        for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
            assert not cell.get("outputs")
