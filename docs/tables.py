"""Write the tables of the pages that are said by the code already: ``python docs/tables.py``.

In `docs/file_format.md` a table stands between ``<!-- keys: NAME -->`` and ``<!-- end -->``, where NAME is a
description that a machine file may hold (`descriptions`); in `docs/units.md` the ranges of all quantities
between ``<!-- ranges -->`` and ``<!-- end -->``; in `docs/limits.md` all limits, ``<!-- limits -->``; in
`docs/notation.md` the quantities of results that have a symbol, ``<!-- quantities -->``; in
`docs/glossary.md` the terms. A test fails if a
page is not what this file would write.
"""

from __future__ import annotations

import pkgutil
import re
from functools import cache
from importlib import import_module
from itertools import groupby
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

import linkwright
from linkwright.kernel.description.schema_walk import mark_of, model_of, models_in, words_of
from linkwright.kernel.limits import ALL, grouped
from linkwright.kernel.page.glossary import Term, glossary
from linkwright.kernel.quantities import quantities_of
from linkwright.kernel.result import Record, Result
from linkwright.kernel.units.kinds import COUNT, KINDS, size_words
from linkwright.kernel.units.marks import Quantity, QuantityList
from linkwright.machine.machine import Machine

PAGES = tuple(
    Path(__file__).with_name(name)
    for name in ("file_format.md", "units.md", "limits.md", "notation.md", "glossary.md")
)

_RANGES = re.compile(r"(<!-- ranges -->\n).*?(<!-- end -->)", re.DOTALL)
_BLOCK = re.compile(r"(<!-- keys: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)

_LIMITS = re.compile(r"(<!-- limits -->\n).*?(<!-- end -->)", re.DOTALL)

_GLOSSARY = re.compile(r"(<!-- glossary -->\n).*?(<!-- end -->)", re.DOTALL)

_QUANTITIES = re.compile(r"(<!-- quantities -->\n).*?(<!-- end -->)", re.DOTALL)

_HEAD = "| key | is | unit | default | meaning |\n| --- | --- | --- | --- | --- |\n"


def written(text: str) -> str:
    """The page with all its tables made anew."""
    text = _RANGES.sub(lambda block: block[1] + ranges() + block[2], text)
    text = _QUANTITIES.sub(lambda block: block[1] + quantities() + block[2], text)
    text = _LIMITS.sub(lambda block: block[1] + limits() + block[2], text)
    text = _GLOSSARY.sub(lambda block: block[1] + terms() + block[2], text)
    return _BLOCK.sub(lambda block: block[1] + table(descriptions()[block[2]]) + block[3], text)


@cache
def descriptions() -> dict[str, type[BaseModel]]:
    """All descriptions that a machine file may hold; ``Train`` stands before names that others have."""
    found: dict[str, type[BaseModel]] = {}
    left: list[Any] = [Machine]
    seen: set[Any] = set()
    while left:
        each = left.pop()
        for model in models_in(each):
            if model not in seen:
                seen.add(model)
                left += [_annotation(field) for field in model.model_fields.values()]
    of_trains = {model for model in seen if model.__module__.startswith("linkwright.torsion")}
    for model in (*(seen - of_trains), *of_trains):
        name = model.__name__ if model.__name__ not in found else f"Train{model.__name__}"
        assert name not in found, name
        found[name] = model
    return found


def limits() -> str:
    """How much of everything there may be."""
    rows = "".join(f"| {grouped(each.most)} | {each.of} | {each.reason} |\n" for each in ALL)
    return f"| at most | of | since |\n| ---: | --- | --- |\n{rows}"


def results() -> list[type[Record]]:
    """All classes whose attributes are declared, by their modules."""
    for found in pkgutil.walk_packages(linkwright.__path__, "linkwright."):
        if not found.name.endswith("__main__"):
            import_module(found.name)
    left, classes = [Record], set()
    while left:
        below = {each for each in left.pop().__subclasses__() if each.__module__.startswith("linkwright.")}
        classes |= below
        left += below
    return sorted(classes - {Result}, key=lambda each: (each.__module__, each.__name__))


def quantities() -> str:
    """The quantities of all results that have a symbol, with the results that have them."""
    found: dict[tuple[str, ...], list[str]] = {}
    for result in results():
        for each in quantities_of(result):
            if each.symbol:
                cells = (each.symbol, each.word, each.unit or "–", f"`{each.name}`")
                found.setdefault(cells, []).append(f"`{result.__name__}`")
    head = "| symbol | the term | unit | ours | results |\n| --- | --- | --- | --- | --- |\n"
    return head + "".join(f"| {' | '.join(cells)} | {', '.join(of)} |\n" for cells, of in found.items())


def ranges() -> str:
    """The sizes that each quantity may have."""
    head = "| quantity | unit | smallest | largest |\n| --- | --- | --- | --- |\n"
    rows = ((kind.noun, kind.unit or "–", *size_words(kind)) for kind in (*KINDS, COUNT))
    return head + "".join("| " + " | ".join(row) + " |\n" for row in rows)


def terms() -> str:
    """The terms of the field, subject by subject."""
    heads = ("term", "symbol", "unit", "definition", "source", "in files and results")
    head = f"| {' | '.join(heads)} |\n{'| --- ' * len(heads)}|\n"
    text = ""
    for subject, group in groupby(glossary(), key=lambda term: term.subject):
        text += f"## {subject}\n\n{head}" + "".join(map(_term, group)) + "\n"
    return text


def _term(term: Term) -> str:
    """A term as a row."""
    names = ", ".join(f"`{name}`" for name in term.names)
    cells = (term.term, term.symbol or "–", term.unit or "–", term.definition, term.source, names or "–")
    return "| " + " | ".join(cells) + " |\n"


def models(text: str) -> list[str]:
    """Names of the classes that the page has a table for."""
    return [block[1] for block in _BLOCK.findall(text)]


def table(model: type[BaseModel]) -> str:
    """All keys of one table of a machine file."""
    fields = model.model_fields.items()
    return _HEAD + "".join(_row(field.alias or name, field) for name, field in fields)


def _row(key: str, field: FieldInfo) -> str:
    mark = mark_of(_annotation(field))
    unit = mark.kind.unit or "–" if mark else "–"
    cells = (f"`{key}`", _what(field, mark), unit, _default(field), field.description or _kind(field))
    return "| " + " | ".join(cells) + " |\n"


def _annotation(field: FieldInfo) -> Any:
    """The annotation with its marks, which pydantic keeps apart where there is no union."""
    return Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation


def _what(field: FieldInfo, mark: Quantity | QuantityList | None) -> str:
    """The quantity with its bound, or the words for anything else."""
    if isinstance(mark, QuantityList):
        return f"list of {mark.kind.plural}"
    if isinstance(mark, Quantity):
        return mark.kind.noun + mark.bound.words.rstrip(",")
    if get_origin(field.annotation) is dict or model_of(field.annotation) is not None:
        return "table"
    if _literals(field):
        return _choices(field)
    if (
        get_origin(field.annotation) is tuple
        and get_origin(entry := get_args(field.annotation)[0]) is Literal
    ):
        return "list of " + " or ".join(f"`{word}`" for word in get_args(entry))
    return words_of(field.annotation).removeprefix("a ").replace("another value", "a number")


def _literals(field: FieldInfo) -> list[Any]:
    """The alternatives that are given words."""
    is_list = get_origin(field.annotation) is tuple
    parts = () if is_list else (field.annotation, *get_args(field.annotation))
    return [part for part in parts if get_origin(part) is Literal]


def _choices(field: FieldInfo) -> str:
    """The words that may stand here."""
    words = " or ".join(
        f"`{word!r}`".replace("'", '"') for part in _literals(field) for word in get_args(part)
    )
    return f"a number or {words}" if float in get_args(field.annotation) else words


def _default(field: FieldInfo) -> str:
    """What holds if the key is left out."""
    if field.is_required():
        return "**required**"
    if field.default_factory is not None:
        return "its defaults" if model_of(field.annotation) else "none"
    if field.default in (None, "", (), PydanticUndefined):
        return "–"
    if isinstance(field.default, BaseModel):
        return "its defaults"
    if isinstance(field.default, tuple):
        return _list(field.default)
    if isinstance(field.default, bool):
        return f"`{str(field.default).lower()}`"
    is_number = isinstance(field.default, int | float)
    return f"`{field.default:.6g}`" if is_number else f'`"{field.default}"`'


def _list(default: tuple[Any, ...]) -> str:
    """A list that holds if the key is left out."""
    if isinstance(default[0], BaseModel):
        return "one that is usual"
    return f"`[{', '.join(f'{each:.6g}' for each in default)}]`"


def _kind(field: FieldInfo) -> str:
    """The meaning of the key ``kind``, which has no description of its own."""
    return "Selects this kind." if get_args(field.annotation) else ""


if __name__ == "__main__":
    for page in PAGES:
        page.write_text(written(page.read_text(encoding="utf-8")), encoding="utf-8")
