"""The field's words: terms with their definitions, symbols and sources, and the words that they replace.

They are data (`glossary.toml`), so that pages, the command line and the test of the texts have the same ones.
A language is a table of a term and a definition beside the English one.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib.resources import files
from typing import NamedTuple


class Term(NamedTuple):
    """A term of the field."""

    key: str  # name of the term for programs
    # The term and one sentence that defines it, in the language asked for.
    term: str
    definition: str
    subject: str  # the heading that it stands under
    source: str  # the standard or the handbook that it is taken from
    # As formulas write it, and its SI unit; empty where there is none.
    symbol: str = ""
    unit: str = ""
    names: tuple[str, ...] = ()  # keys of files and attributes of results that mean the same
    retired: tuple[str, ...] = ()  # regular expressions of words that texts use no longer for it


@cache
def _data() -> dict[str, dict[str, list[str]]]:
    return tomllib.loads((files(__package__) / "glossary.toml").read_text(encoding="utf-8"))


@cache
def glossary(language: str = "en") -> tuple[Term, ...]:
    """All terms that have words in a language, in the order of the file: by subject."""
    rest = ("subject", "source", "symbol", "unit")
    return tuple(
        Term(
            key,
            **entry[language],  # type: ignore[arg-type]
            **{name: entry[name] for name in rest if name in entry},  # type: ignore[arg-type]
            names=tuple(entry.get("names", ())),
            retired=tuple(entry["retired"]),
        )
        for key, entry in _data().items()
        if language in entry
    )


def matching(word: str) -> tuple[Term, ...]:
    """Terms in which a word occurs, in either case: in the term, its names, symbol, words it replaces."""
    wanted = word.casefold()

    def meant(term: Term) -> bool:
        words = (term.term.casefold(), *(name.casefold() for name in term.names))
        return (
            any(wanted in word for word in words)
            or word == term.symbol
            or any(re.fullmatch(retired, word, re.IGNORECASE) for retired in term.retired)
        )

    return tuple(term for term in glossary("en") if meant(term))
