"""Every text of the package that a report can show has a Ukrainian line, provoked by a test or not."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import pytest
from docs.tables import descriptions, results
from tests.report.test_language import UKRAINIAN

import linkwright
from linkwright import FindingError
from linkwright.kernel import errors
from linkwright.kernel.description.place import field_names
from linkwright.kernel.quantities import quantities_of

SOURCE = Path(linkwright.__file__).parent

# Modules whose texts no report shows: for the terminal, assistants, notebooks and whoever wrote a file
# that is refused, or belong to the studio and the papers, which are tested by themselves.
OTHERS = re.compile(
    r"(studio|papers|app/assistant|kernel/(files|description|command|units|public|figure))/"
    r"|kernel/(errors|quantities|result|system|extras|limits)\.py|kernel/page/(typeset|notebook|language)\.py"
    r"|app/(application|curves)\.py|app/commands/(schema|new|draw|glossary)\.py|app/report/(company|moving)\.py"
    r"|cam/laws/(boundary|limited|optimal|polynomial|spline)\.py|synthesis/(task|commands)\.py"
    r"|machine/(read|size_limits|address|overrides|iso286|tolerances)\.py|.*/(parquet|step)\.py"
    r"|outlines/model/.*|finite_elements/(steps|mesh)\.py"
    r"|studies/(point_responses|responses|plan|read|sought|knives|axes|model|engine)\.py|linkages/(law|zero)\.py"
    r"|axes/export/(formats|plain_text|structured_text)\.py"
    r"|fmi/(variables|description|program)\.py"
    r"|multibody/(refusals|mjcf_file|urdf_file)\.py"
    r"|(machine/machine|turning/model|machine/program/(compiled|core)|studies/folder|studies/sizes)\.py"
)

# What refuses input, waits, or tells how a figure is drawn.
UNSEEN = {
    *("InputError", "UnitError", "Problem", "MachineError", "LawError", "ShapeError", "InternalError"),
    *("NoPlaceError", "ValueError", "TypeError", "KeyError", "AttributeError", "RuntimeError", "fault"),
    *("wrong", "require", "require_within", "belong_to", "named_file", "Option", "Argument", "out_option"),
    *("Value", "to_file", "to_folder", "stepped"),
    *("progress", "echo", "About", "Label", "Bound", "filter", "fromkeys", "legend", "filterwarnings"),
    *("_unreadable", "ImportError", "annotate"),
}
# What a description can find of the machine; what else it says is that its file is wrong.
FINDINGS = {
    name for name, one in vars(errors).items() if isinstance(one, type) and issubclass(one, FindingError)
}
UNSEEN_KEYWORDS = {"method", "loc", "command", "tail", "help", "bbox_to_anchor"}

# Titles of books, keys of programs, messages for programmers, an error of input that a function returns.
KEPT = {
    *("pontryagin et al", "gelfand and fomin, calculus of variations (#"),
    *("biagiotti and melchiorri, trajectory planning (#", "den hartog, mechanical vibrations, 4th ed"),
    *("ker wilson, practical solution of torsional vibration problems, #–#", "?:φ = |crank angles? (?:of )?"),
    "kloss, drehmoment und schlüpfung des drehstrommotors, archiv für elektrotechnik, #",
    *("steady gradient", "fine steady motion", "slides along a jump at", "ground of", "too many steps"),
    *("a unit with a load", "has motors with", "expected at most", "the most powerful of these motors"),
    *("the series", "is now study", "offset points"),
    "dresig, holzweißig, dynamics of machinery, springer #, sections # and #",
}

# Two words, no name of a file and no option; a formula stands between signs.
_WORDS = re.compile(r"(?<![\w.-])[a-z]{2,} [a-z]{2,}(?![\w.=|-])")
_HOLE = "\0"
_ENDS = re.compile(rf"{_HOLE}(?:(?: ?°| ?%| {UKRAINIAN._unit.pattern})(?!\w))?|(?<=[.;:]) |[\"`\[\]]")


def _name(call: ast.expr) -> str:
    return call.attr if isinstance(call, ast.Attribute) else call.id if isinstance(call, ast.Name) else ""


def _literal(node: ast.AST) -> str | None:
    """A text with a hole for each value that is put in; None for what is no text."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return re.sub(r"\{\w*\}", _HOLE, node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(one.value if isinstance(one, ast.Constant) else _HOLE for one in node.values)
    return None


def _hidden(scope: ast.AST) -> set[str]:
    """Names of texts that become part of what nobody is shown."""
    calls = (node for node in ast.walk(scope) if isinstance(node, ast.Call) and _name(node.func) in UNSEEN)
    return {node.id for call in calls for node in ast.walk(call) if isinstance(node, ast.Name)}


def _texts(node: ast.AST, unseen: set[str]) -> Iterator[str]:
    """Texts below a node of a module, but for docstrings, annotations and what nobody is shown."""
    if isinstance(node, ast.Call) and _name(node.func) in UNSEEN:
        return
    if isinstance(node, ast.keyword) and node.arg in UNSEEN_KEYWORDS:
        return
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return
    if isinstance(node, ast.Assign) and unseen & {
        _name(name) for at in node.targets for name in ast.walk(at)
    }:
        return
    if isinstance(node, ast.FunctionDef):
        unseen = unseen | _hidden(node)
    text = _literal(node)
    if text is not None:
        yield text
    for name, child in ast.iter_fields(node):
        if name not in ("annotation", "returns"):
            inner = child if isinstance(child, list) else [child]
            parts = (one for one in inner if isinstance(one, ast.AST))
            yield from (
                found
                for part in parts
                if not (text is not None and isinstance(part, ast.Constant))
                for found in _texts(part, unseen)
            )


def _of_module(path: Path) -> Iterator[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    if "model" in path.parts:
        calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
        yield from (
            text
            for call in calls
            if _name(call.func) in FINDINGS
            for part in call.args
            for text in _texts(part, set())
        )
        return
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    yield from _texts(tree, {name for one in classes for name in _hidden(one) if name.startswith("_")})


@cache
def _known() -> str:
    return "\n".join(UKRAINIAN._number.sub("#", text) for text in UKRAINIAN.texts).lower()


def _english(text: str) -> Iterator[str]:
    """Runs of words, between values and ends of sentences, that no text of the catalogue has."""
    for run in _ENDS.split(UKRAINIAN._number.sub("#", " ".join(text.split()))):
        bare = re.sub(r"^(?:and|or) ", "", run.strip(" .,;:()–").lower())
        if _WORDS.search(bare) and bare not in _known():
            yield bare


MODULES = [
    path for path in sorted(SOURCE.rglob("*.py")) if not OTHERS.match(path.relative_to(SOURCE).as_posix())
]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(SOURCE).as_posix())
def test_texts_of_a_module_have_a_line(path: Path) -> None:
    """What a sentence is put together of stands in the catalogue, run by run between the values."""
    assert {run for text in _of_module(path) for run in _english(text)} - KEPT == set()


def test_a_sentence_without_a_line_is_found() -> None:
    """A number, a name or a further sentence beside it does not hide it."""
    tree = ast.parse(
        'def f(n):\n    """Why it is so."""\n    yield f"no steady motion: at {n} m it sings out {n}"'
    )
    assert {run for text in _texts(tree, set()) for run in _english(text)} == {"it sings out"}


def _choices(annotation: Any) -> Iterator[str]:
    if get_origin(annotation) is Literal:
        yield from (choice for choice in get_args(annotation) if isinstance(choice, str))
    for part in get_args(annotation):
        yield from _choices(part)


@pytest.mark.parametrize("kind", sorted(descriptions()))
def test_keys_and_choices_of_files_have_a_word(kind: str) -> None:
    model = descriptions()[kind]
    """Data of a machine are put together of them; names of rules and classes, in capitals, stay."""
    keys = field_names(model)
    choices = (choice for name in keys.values() for choice in _choices(model.model_fields[name].annotation))
    words = {word.replace("_", " ") for word in (*keys, *choices) if re.search("[a-z]{2}", word)}
    assert words - UKRAINIAN.texts.keys() == set()


def test_words_of_quantities_have_a_line() -> None:
    """Curves, responses of studies and derivatives are named by them, in any report."""
    words = {quantity.word for result in results() for quantity in quantities_of(result)}
    assert {word for word in words if UKRAINIAN(word) == word and re.search("[a-z]{3}", word)} == set()
