"""Texts use the field's words: pages, messages, tables and docstrings have none that the glossary retires.

Keys, names and formulas keep theirs: what stands between backticks, in braces of an f-string, as the name
of a parameter or as a string without a blank is no text.
"""

from __future__ import annotations

import ast
import importlib
import io
import pkgutil
import re
import tokenize
import tomllib
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path

import pytest

import linkwright as lw
from linkwright.kernel.page.glossary import glossary, matching
from linkwright.kernel.quantities import Label, declared
from linkwright.kernel.result import Result

ROOT = Path(__file__).parents[2]
GLOSSARY = ROOT / "python" / "linkwright" / "kernel" / "page" / "glossary.toml"

# The glossary names the retired words, the changelog says what they were, and this file looks for them.
EXCUSED = {
    Path(__file__),
    ROOT / "CHANGELOG.md",
    ROOT / "docs" / "glossary.md",
    GLOSSARY,
}

_LITERAL = re.compile(r'^([a-zA-Z]*)("""|\'\'\'|"|\')(.*)\2$', re.DOTALL)
_NO_TEXT = re.compile(r"\S*")
_PARAMETER = re.compile(r"^\s*\*{0,2}\w[\w, *]* : .*$|^\s*(?:>>>|\.\.\.) .*$", re.MULTILINE)
_CODE = re.compile(r"^```(?:python|toml|json)\n.*?^```$|``[^`]*``|`[^`\n]*`", re.DOTALL | re.MULTILINE)
_RUST = re.compile(r'//[^\n]*|"((?:[^"\\]|\\.)*)"', re.DOTALL)
# A comment on a line of its own, or behind code.
_COMMENT = re.compile(r"^\s*#:? (.*)|  # (.*)$")
_REMARK = re.compile(r"^\s*//[/!]? ?(.*)|[;,{})] // (.*)$")
_BLANK = r"(?:[^\S\n]+|[^\S\n]*\n[^\S\n]*)"


def expression(word: str) -> str:
    """A regular expression for whole words that may be divided by a line break."""
    return r"(?<![\w.-])(?:" + word.replace(" ", _BLANK) + r")(?!\w)"


RETIRED = {word: re.compile(expression(word), re.IGNORECASE) for term in glossary() for word in term.retired}
# Any of them: most texts have none.
ANY_RETIRED = re.compile(expression("|".join(word.replace(" ", _BLANK) for word in RETIRED)), re.IGNORECASE)
# Phrases in which a retired word is right, as "at least".
_PHRASES = tomllib.loads(GLOSSARY.read_text(encoding="utf-8"))["allowed"]["phrases"]
ALLOWED = re.compile("|".join(map(expression, _PHRASES)), re.IGNORECASE)


def faults(text: str) -> Iterator[str]:
    text = ALLOWED.sub(lambda phrase: "·" * len(phrase[0]), text)
    for pattern in RETIRED.values() if ANY_RETIRED.search(text) else ():
        for word in pattern.finditer(text):
            yield " ".join(text[max(0, word.start() - 40) : word.end() + 25].split())


def without_fields(text: str) -> str:
    """An f-string with 0 for what stands in braces; the texts within them stay."""
    parts, depth = [], 0
    for part in re.split(r"(\{\{|\}\}|[{}])", text):
        depth += (part == "{") - (part == "}")
        literals = (text[1:-1] for text in re.findall(r"\"[^\"]*\"|'[^']*'", part))
        shown = "".join(f"{text} " for text in literals if " " in text)
        parts.append(shown if depth else part.replace("}", "0"))
    return "".join(parts)


def of_python(source: str) -> Iterator[str]:
    yield from in_blocks("".join(next(iter(_COMMENT.findall(line)), "")) for line in source.splitlines())
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        literal = _LITERAL.match(token.string) if token.type == tokenize.STRING else None
        if literal is None or _NO_TEXT.fullmatch(literal[3]):
            continue
        text = without_fields(literal[3]) if "f" in literal[1].lower() else literal[3]
        yield _CODE.sub("·", _PARAMETER.sub("", text))


def of_test(source: str) -> Iterator[str]:
    """Docstrings and comments of a test; its other texts are the machines and the messages that it tries."""
    yield from in_blocks("".join(next(iter(_COMMENT.findall(line)), "")) for line in source.splitlines())
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            yield _CODE.sub("·", ast.get_docstring(node) or "")


def in_blocks(comments: Iterable[str]) -> Iterator[str]:
    """Comments of lines that follow one another as one text; empty strings divide them."""
    for is_comment, lines in groupby(comments, bool):
        if is_comment:
            yield _CODE.sub("·", "\n".join(lines))


def of_rust(source: str) -> Iterator[str]:
    """Comments of a Rust module, and what its messages are made of, but for its tests."""
    yield from in_blocks("".join(next(iter(_REMARK.findall(line)), "")) for line in source.splitlines())
    source = source.split("#[cfg(test)]")[0]
    for literal in _RUST.finditer(source):
        if literal[1] and not _NO_TEXT.fullmatch(literal[1]):
            yield re.sub(r"\{[^}]*\}", "", literal[1])


def of_template(source: str) -> Iterator[str]:
    yield re.sub(r"<(script|style).*?</\1>|\{[{%].*?[%}]\}|<[^>]*>", " ", source, flags=re.DOTALL)


def of_script(source: str) -> Iterator[str]:
    for literal in re.findall(r"\"[^\"\n]*\"|`[^`]*`", source):
        if not _NO_TEXT.fullmatch(literal):
            yield re.sub(r"\$\{[^}]*\}", "0", literal)


def of_page(source: str) -> Iterator[str]:
    yield _CODE.sub("·", source)


def of_machine(source: str) -> Iterator[str]:
    yield from re.findall(r"#.*|^(?:name|description) = .*$", source, re.MULTILINE)


def of_data(source: str) -> Iterator[str]:
    """Texts of a file of data, with 0 for what stands in braces."""
    for literal in re.findall(r'"""[\s\S]*?"""|"[^"\n]*"', source):
        if not _NO_TEXT.fullmatch(literal):
            yield without_fields(literal.strip('"'))


KINDS = {
    "pages": (of_page, ["*.md", "docs/**/*.md", "examples/**/*.md", "benches/*.md"]),
    "package": (of_python, ["python/**/*.py", "python/**/*.pyi", "docs/*.py", "examples/**/*.py"]),
    "benches": (of_python, ["benches/**/*.py"]),
    "tests": (of_test, ["tests/**/*.py"]),
    "notebooks": (of_data, ["docs/**/*.ipynb"]),
    "templates": (of_template, ["python/**/*.html"]),
    "scripts": (of_script, ["python/**/*.js"]),
    "core": (of_rust, ["crates/**/*.rs"]),
    "machines": (of_machine, ["machines/*.toml", "examples/**/*.toml", "python/**/*.toml"]),
    "papers": (of_data, ["python/linkwright/papers/**/*.toml"]),
    "messages": (of_page, ["tests/files/broken/*.txt"]),
}


@pytest.mark.parametrize("kind", KINDS)
def test_texts_use_the_words_of_the_field(kind: str) -> None:
    texts, places = KINDS[kind]
    paths = sorted({path for place in places for path in ROOT.glob(place)} - EXCUSED)
    assert paths
    found = [
        f"{path.relative_to(ROOT)}: {fault}"
        for path in paths
        for text in texts(path.read_text(encoding="utf-8"))
        for fault in faults(text)
    ]
    assert not found, "\n".join(found)


def quantities() -> Iterator[tuple[str, Label]]:
    for room in pkgutil.walk_packages(lw.__path__, "linkwright."):
        if not room.name.endswith("__main__"):
            importlib.import_module(room.name)
    kinds = [Result]
    while kinds:
        kind = kinds.pop()
        kinds += kind.__subclasses__()
        yield from ((name, mark) for name, (_, mark) in declared(kind).items() if isinstance(mark, Label))


def test_tables_use_the_terms_of_the_glossary() -> None:
    terms = {name: term for term in glossary() for name in term.names}
    # A name may stand for several quantities; that with the symbol of the term is the term's.
    told = {(n, mark) for n, mark in quantities() if n in terms and mark.symbol == terms[n].symbol != ""}
    assert len(told) > 10
    for name, mark in told:
        assert mark.word.startswith(terms[name].term.split(" (")[0]), name
    assert not [fault for _, mark in quantities() for fault in faults(f"{mark.word}. {mark.about}")]


def test_retired_words_are_found() -> None:
    assert list(faults("the coefficient of unevenness"))
    assert list(faults("the greatest\n    torque in a turn"))
    assert list(of_python('x = "the greatest torque"')) == ["the greatest torque"]
    assert not list(faults("at least 3, by least\nsquares, --unevenness"))
    assert list(of_page("the key `unevenness`")) == ["the key ·"]
    assert list(of_python('"""A.\n\n    least : float\n    """')) == ["A.\n\n    "]
    assert list(faults(*of_python("f\"{least:g} of {'the greatest' if least else 0}\""))) == [
        "0 of the greatest 0"
    ]
    assert list(of_rust('// greatest\nlet a = "in a turn"; // least')) == ["greatest\nleast", "in a turn"]
    assert list(of_python("# the greatest\n# torque `least`\nx = 1  # in a turn\n")) == [
        "the greatest\ntorque ·\nin a turn"
    ]


def test_terms_are_defined_once() -> None:
    terms = glossary()
    assert len({term.term for term in terms}) == len(terms) > 50
    for term in terms:
        assert term.definition.endswith("."), term.key
        assert not list(faults(term.term + ". " + term.definition)), term.key
    assert [term.key for term in matching("δ")] == ["speed_fluctuation"]
    assert [term.key for term in matching("unevenness")] == ["speed_fluctuation"]
    assert matching("xyzzy") == ()
