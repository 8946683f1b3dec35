"""What an entry of the machine file, a quantity of a result, a term of the field or a message means.

Everything is declared elsewhere: entries by the descriptions, quantities by their labels, terms in the
glossary. Of a message that is whatever it names.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple, get_args, get_origin, get_type_hints

from pydantic.fields import FieldInfo

from linkwright.kernel.description.base import close_match
from linkwright.kernel.description.place import field_names, split
from linkwright.kernel.description.schema_walk import (
    annotation_at,
    kinds_of,
    mark_of,
    model_of,
    models_in,
    words_of,
)
from linkwright.kernel.errors import InputError, show
from linkwright.kernel.limits import TEXT, grouped
from linkwright.kernel.page.glossary import Term, glossary, matching
from linkwright.kernel.quantities import quantities_of
from linkwright.kernel.units.marks import Quantity, QuantityList

# How many entries, quantities or terms are listed.
_LISTED = 12

# What may be an address or a name in a message.
_NAME = re.compile(r"\w+(?:\.(?:\w+|\"[^\"]+\"))*")


class Entry(NamedTuple):
    """An entry that a machine file may have."""

    place: tuple[str, ...]  # keys from the top down; `NAME` where names are chosen, `N` in a list
    kinds: tuple[str, ...]  # words for ``kind`` of the table that it stands in
    annotation: Any
    field: FieldInfo


def explained(words: str) -> dict[str, Any]:
    """What the words name: `entries` of the machine file, `quantities` of results, `terms` of the field.

    `words`: an address or a key, a name of ``--json``, a term or its symbol, or a whole message. Raises
    `InputError` if there is nothing of that name.
    """
    text = words.strip()
    if not text or len(text) > TEXT.most:
        raise InputError(
            f"what: found {grouped(len(text))} characters, expected a name or a message, {TEXT.words}"
        )
    found = _named(text) if _NAME.fullmatch(text) else {}
    if not any(found.values()):
        found = {"entries": [], "quantities": [], "terms": list(matching(text)) or list(_terms_in(text))}
        for name in dict.fromkeys(_NAME.findall(text)):
            # A word alone names half a dozen keys; what has points is meant.
            if "." in name:
                named = _named(name)
                found = {of: [*known, *named.get(of, ())] for of, known in found.items()}
    if not any(found.values()):
        known = [entry.place[-1] for entry in entries()] + [term.term for term in glossary()]
        near = close_match(text, known) or "see the resource linkwright://schema, or `linkwright glossary`"
        raise InputError(f"found {show(text)}, which is no entry, quantity or term; {near}")
    say: dict[str, Callable[[Any], dict[str, Any]]] = {"entries": _entry, "quantities": dict, "terms": _term}
    return {of: [say[of](each) for each in known[:_LISTED]] for of, known in found.items() if known}


def _named(name: str) -> dict[str, list[Any]]:
    """What has exactly this name."""
    place = split(name)
    # A value of a list belongs to the entry that the list is.
    above = place[:-1] if place[-1].isdecimal() else place
    return {
        "entries": [entry for entry in entries() if _is_at(entry, place)]
        or [entry for entry in entries() if _is_at(entry, above)],
        "quantities": [each for each in quantities() if name in (each["name"], each["name"].split(".")[-1])],
        "terms": [term for term in matching(name) if name in (term.term, term.symbol, *term.names)],
    }


def _is_at(entry: Entry, place: tuple[str, ...]) -> bool:
    """Whether an entry stands at a place, or has the key that the place alone is."""
    if len(place) == 1:
        return entry.place[-1] == place[0]
    return len(entry.place) == len(place) and all(
        own in ("NAME", key) or (own == "N" and key.isdecimal())
        for own, key in zip(entry.place, place, strict=True)
    )


def _terms_in(text: str) -> Iterator[Term]:
    """Terms that occur in a text as whole words."""
    for term in glossary():
        words = [re.sub(r" \(.*?\)", "", term.term), *term.names]
        if any(re.search(rf"\b{re.escape(word)}\b", text, re.IGNORECASE) for word in words):
            yield term


@cache
def entries() -> tuple[Entry, ...]:
    """All entries that a machine file may have."""
    from linkwright.machine.machine import Machine

    return tuple(_below(Machine, (), ()))


def _below(annotation: Any, place: tuple[str, ...], above: tuple[type, ...]) -> Iterator[Entry]:
    for model in models_in(annotation):
        # A description may hold itself, as a load case does.
        for key, name in field_names(model).items() if model not in above else ():
            at = annotation_at(model, (key,))
            own = (*place, key)
            yield Entry(own, kinds_of(model), at, model.model_fields[name])
            yield from _below(at, (*own, *_names(at)), (*above, model))


def _names(annotation: Any) -> tuple[str, ...]:
    """What stands between an entry and the keys of its tables: names that are chosen, places in a list."""
    if model_of(annotation) is not None or mark_of(annotation) is not None:
        return ()
    branches = [get_origin(branch) for branch in (annotation, *get_args(annotation))]
    return ("NAME",) if dict in branches else ("N",) if tuple in branches else ()


def _entry(entry: Entry) -> dict[str, Any]:
    """An entry as it is answered."""
    mark = mark_of(entry.annotation)
    unit = mark.kind.unit if isinstance(mark, Quantity | QuantityList) else ""
    kinds = {"kinds": list(entry.kinds)} if entry.kinds else {}
    default = None if entry.field.is_required() else entry.field.get_default(call_default_factory=False)
    is_plain = isinstance(default, str | int | float) and default != ""
    keys = sorted({key for model in models_in(entry.annotation) for key in field_names(model)})
    return {
        "address": ".".join(entry.place),
        **kinds,
        "expected": words_of(entry.annotation),
        **({"unit": unit} if unit else {}),
        "required": entry.field.is_required(),
        **({"default": default} if is_plain else {}),
        "about": entry.field.description or "",
        **({"keys": keys} if keys else {}),
    }


@cache
def quantities() -> tuple[dict[str, str], ...]:
    """Quantities of the results of all analyses: name in ``--json``, words, symbol, SI unit, and more."""
    from linkwright.app.subjects import ANALYSES

    return tuple(
        {
            "name": f"{analysis.name}.{each.name}",
            "kind": each.kind,
            "word": each.word,
            "symbol": each.symbol,
            "unit": each.unit,
            "about": each.about,
        }
        for analysis in ANALYSES
        if analysis.function is not None
        for each in quantities_of(get_type_hints(analysis.analyse)["return"])
    )


def _term(term: Term) -> dict[str, Any]:
    """A term as it is answered."""
    return {name: value for name, value in term._asdict().items() if name not in ("key", "retired") and value}
