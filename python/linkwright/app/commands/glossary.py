"""``linkwright glossary``: the field's words, with their definitions, symbols and sources."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer
from linkwright.kernel.command.common import Output, to_screen
from linkwright.kernel.command.parameter import Argument

if TYPE_CHECKING:
    from linkwright.kernel.page.glossary import Term

Words = Annotated[
    list[str] | None,
    Argument("[WORD]...", "A term, a symbol, a key or an older word. Default: all terms."),
]


def glossary(words: Words = None, *, to: Annotated[Output, to_screen()]) -> None:
    """Define the terms of tables, messages and reports.

    Each with its symbol, its unit, its source and its key in files and results.
    """
    from linkwright.kernel.errors import InputError
    from linkwright.kernel.page.glossary import glossary as terms
    from linkwright.kernel.page.glossary import matching

    word = " ".join(words or ())
    chosen = matching(word) if word else terms()
    if not chosen:
        raise InputError(f'the glossary has no term "{word}"; linkwright glossary lists all terms')
    answer = Answer(
        machine=None,
        results={term.key: _entry(term) for term in chosen},
        head=lambda: "\n\n".join(map(_words, chosen)),
    )
    to.hand_over(answer)


def _entry(term: Term) -> dict[str, object]:
    return {name: value for name, value in term._asdict().items() if name not in ("key", "retired")}


def _words(term: Term) -> str:
    unit = f" [{term.unit}]" if term.unit else ""
    keys = f" Key: {', '.join(term.names)}." if term.names else ""
    source = term.source.replace("*", "")
    return f"{f'{term.term} {term.symbol}'.rstrip()}{unit}\n  {term.definition}\n  Source: {source}.{keys}"
