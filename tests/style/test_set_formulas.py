"""Formulas of the documentation are LaTeX that can be set; indices in sentences are set, names left alone."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest
from docs_scripts import docs_script
from markdown import Markdown

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.rglob("*.md"))

_FENCE = re.compile(r"^ *```math\n(.*?)^ *```$", re.DOTALL | re.MULTILINE)
# After an empty line and not below an item of a list, what is indented is shown as it is typed.
_INDENTED = re.compile(r"^(?! *[-*\d]).*\n\n {4}\S.*$", re.MULTILINE)


def hook() -> ModuleType:
    return docs_script("formulas")


@pytest.mark.parametrize("page", [page for page in PAGES if "```math" in page.read_text("utf-8")], ids=str)
def test_formulas_are_set(page: Path) -> None:
    formulas = hook()
    for latex in _FENCE.findall(page.read_text(encoding="utf-8")):
        for part in formulas.separate(latex):
            assert "\\" not in formulas.mathml(part), latex


def docstrings() -> Iterator[str]:
    for path in sorted((ROOT / "python" / "linkwright").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and "math:" in node.value:
                yield inspect.cleandoc(node.value)


def test_formulas_of_docstrings_are_set() -> None:
    formulas = hook()
    count = 0
    for text in docstrings():
        fences = _FENCE.findall("\n".join(formulas.Directives().run(text.splitlines())))
        for latex in fences + re.findall(formulas.ROLE, text):
            count += 1
            assert "\\" not in "".join(map(formulas.mathml, formulas.separate(latex))), latex
    assert count > 300


def test_several_lines_of_a_docstring_are_a_table() -> None:
    lines = [r".. math:: x &= 1 \\", "    y &= 2", "", "with z"]
    fence = ["```math", r"\begin{aligned}", r"x &= 1 \\", "y &= 2", r"\end{aligned}", "```", "", "with z"]
    assert hook().Directives().run(lines) == fence


def test_sources_of_a_docstring_are_a_list() -> None:
    assert hook().Directives().run([".. [1] Wilson, p. 2,", "   and 3.", ".. [2] Korn."]) == [
        "1. Wilson, p. 2,",
        "   and 3.",
        "2. Korn.",
    ]


def test_formulas_stand_in_fences() -> None:
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        assert "$$" not in text, page.name
        assert not re.search(r"\$\\", text), page.name
        assert not [block for block in _INDENTED.findall(text) if "```" not in block], page.name


def test_derivatives_by_time_are_dots_above_the_letter() -> None:
    one, two, three = (hook().mathml(rf"\{name}{{φ}}") for name in ("dot", "ddot", "dddot"))
    assert [each.split("<mo>")[1][0] for each in (one, two, three)] == [".", "‥", "…"]


def test_what_is_no_latex_is_refused() -> None:
    with pytest.raises(Exception, match="nowhere"):
        hook().mathml(r"x = \nowhere{2}")


@pytest.mark.parametrize(
    ("written", "set_"),
    [
        ("torque M_k, 2J_S", "torque M<sub>k</sub>, 2J<sub>S</sub>"),
        ("M_g,ν and P_0.7, ẏ_max", "M<sub>g,ν</sub> and P<sub>0.7</sub>, ẏ<sub>max</sub>"),
        ("e^{iφ}, w^0.8, ε^(−1/4)", "e<sup>iφ</sup>, w<sup>0.8</sup>, ε<sup>−1/4</sup>"),
        ("e^{−iν φ_f}, θ_{i+1}", "e<sup>−iν φ<sub>f</sub></sup>, θ<sub>i+1</sub>"),
        ("energy_motor, A_b_c, `x_j`", "energy_motor, A_b_c, <code>x_j</code>"),
        ("[x](a_b.md)", '<a href="a_b.md">x</a>'),
        ("by Jansen [2]_; so", "by Jansen [2]; so"),
        ("of :math:`x_1`.", "of <math><msub><mi>x</mi><mn>1</mn></msub></math>."),
    ],
)
def test_indices_of_sentences(written: str, set_: str) -> None:
    assert Markdown(extensions=[hook().Sentences()]).convert(written) == f"<p>{set_}</p>"
