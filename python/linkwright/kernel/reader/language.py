"""Reports in another language than English: texts by a catalogue, numbers and units as it writes them.

A catalogue, ``texts_CODE.toml``, has an English text and its translation a line. In a text, ``#`` stands for
a number with its unit, or a list of them, and ``{}`` for names; in the translation they come in the same
order, or as ``#2``, ``{1}`` where the order is another one. A text of several sentences is translated
sentence by sentence. What has no translation stays as it is: names of a machine file, symbols, sources.
Its table ``keys`` has the words of machine files, of which the entries of a machine are put together.
The title of a report is such a name, unless a command made the machine: its titles are listed as `titles`.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path

from linkwright.kernel.errors import InputError

# A number as `linkwright.kernel.reader.numbers` writes it, no digits of a name.
_DIGITS = r"(?<![\w.])[-−+]?\d+(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+|e[-−+]?\d+)?(?![\w]|\.\d)"
_NUMERAL = re.compile(_DIGITS)
# A name, or a few words; it does not go on behind the end of a sentence.
_NAME = r"((?:(?![.;:] ).)+?)"
_WORD = re.compile(r"[A-Za-z]{2}")
_WORDS = re.compile(r"[a-z]{2,} [a-z]{2,}")
# The beginning of a sentence, no name of one word.
_SENTENCE = re.compile(r"[A-Z][a-z]* ")
# Ends of sentences and of parts of sentences, with which a text may be written or not.
_STOPS = frozenset(".;:,")
# Where a number or a name stands in a translation.
_PLACE = re.compile(r"#(\d?)|\{(\d?)\}")

# Between entries of a list, not between the arguments of a function.
_LISTED = re.compile(r", (?![^()]*(?:\([^()]*\)[^()]*)*\))")

# What makes an entry a formula, in which names are no words.
_FORMULA = re.compile(r"[*^()=<>]| [-+/] ")


@dataclass(frozen=True)
class Language:
    """A language that reports are written in."""

    code: str = "en"  # as of ISO 639-1: `"en"`, `"uk"`
    # English text or unit → the language's own.
    texts: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    decimal: str = "."  # decimal sign
    # Of the texts, tables, keys and choices of a machine file.
    keys: Mapping[str, str] = field(default_factory=dict)
    titles: tuple[str, ...] = ()  # texts of titles of machines that commands make
    names: frozenset[str] = frozenset()  # what stays as it is

    def __call__(self, text: str) -> str:
        """A text in this language; the text itself where it has no translation."""
        if self.code == "en" or not text.strip():
            return text
        known = self._known(text)
        if known is not None:
            return known
        for ends, between in ((r"(?<=[.;:]) ", " "), (", ", ", ")):
            parts = re.split(ends, text)
            if len(parts) > 1:
                return between.join(map(self, parts))
        names = text.split(" and ")
        if len(names) > 1 and all(not _WORDS.search(name) or self._known(name) for name in names):
            return f" {self.texts['and']} ".join(map(self, names))
        # A name and its number.
        bare = text.rstrip("".join(_STOPS))
        name, _, number = bare.rpartition(" ")
        if name in self.names and _NUMERAL.fullmatch(number):
            return f"{name} {self.number(number)}{text[len(bare) :]}"
        return text

    def _known(self, text: str) -> str | None:
        """The translation of a whole text; None if there is none."""
        body = text.strip()
        if body in self.names:
            return text
        if "#" in body:
            # A sign of the user's own, which would count as a number.
            return None
        if body[-1:] in _STOPS and (known := self._known(body[:-1])) is not None:
            return known + body[-1]
        # A list of numbers stands where a text has one, unless it has each.
        ways = {way.sub("#", body): way.findall(body) for way in (self._number, self._listed)}
        for key, numbers in ways.items():
            pattern = self.texts.get(body) or self.texts.get(key)
            if pattern is None and _SENTENCE.match(key):
                pattern = _capital(self.texts.get(_small(body)) or self.texts.get(_small(key)) or "")
            if pattern or not _WORD.search(key):
                # Numbers and signs alone are a text that is the same in every language.
                return _filled(pattern or key, [*map(self.numbers, numbers)], [])
        return self._named(ways)

    def template(self, text: str) -> str:
        """A text in this language whose numbers, ``#``, are still to come."""
        bare = text[:-1] if text[-1:] in _STOPS else text
        return self.texts.get(bare, bare) + text[len(bare) :]

    def _named(self, ways: Mapping[str, list[str]]) -> str | None:
        """The translation of a text with names in it, of which there are ways to tell its numbers."""
        for form, pattern in self._forms:
            for key, numbers in ways.items():
                if match := form.fullmatch(key):
                    return self._around(match, form, pattern, numbers)
        return None

    def _around(self, match: re.Match[str], form: re.Pattern[str], pattern: str, numbers: list[str]) -> str:
        """A text with its names in place; numbers inside a name belong to the name."""
        key = match.string
        parts = key.split(", ")
        if len(parts) > 1 and all(map(form.fullmatch, parts)):
            # A list, whose first part would take the others for a name.
            return ", ".join(map(self, _filled(key, numbers, []).split(", ")))
        places = [place for place, letter in enumerate(key) if letter == "#"]
        spans = [match.span(n + 1) for n in range(form.groups)]
        held: list[list[str]] = [[] for _ in range(len(spans) + 1)]
        for place, number in zip(places, numbers, strict=True):
            held[next((n for n, (a, b) in enumerate(spans) if a <= place < b), -1)].append(number)
        names = [self(_filled(key[a:b], own, [])) for (a, b), own in zip(spans, held, strict=False)]
        text = _filled(pattern, [*map(self.numbers, held[-1])], names)
        return _capital(text) if spans[0][0] and key[0].isupper() else text

    @cached_property
    def _forms(self) -> list[tuple[re.Pattern[str], str]]:
        """Texts with names as expressions, those with most letters of their own first.

        What is said after a name begins with a small letter, what is said alone with a capital.
        """
        named = sorted((text for text in self.texts if "{}" in text), key=len, reverse=True)
        forms = (re.escape(text).replace(r"\{\}", _NAME) for text in named)
        either = (f"[{form[0].upper()}{form[0]}]{form[1:]}" if form[0].islower() else form for form in forms)
        return [
            (re.compile(form, re.DOTALL), self.texts[text]) for form, text in zip(either, named, strict=True)
        ]

    @cached_property
    def _unit(self) -> re.Pattern[str]:
        """A unit: parts of it with powers, between strokes and spaces."""
        names = sorted(map(re.escape, self.units.keys() - {"per"}), key=len, reverse=True)
        part = rf"(?:{'|'.join(names)})[²³⁴]?"
        parts = rf"{part}(?:[ /·]{part})*"
        return re.compile(rf"(?:(?:1/)?{parts}(?: per {parts})?|per {parts})(?![\w²³⁴/])")

    @cached_property
    def _number(self) -> re.Pattern[str]:
        return re.compile(rf"{_DIGITS}(?: ?°| ?%| {self._unit.pattern})?")

    @cached_property
    def _listed(self) -> re.Pattern[str]:
        """A number, or several with commas between them."""
        return re.compile(rf"{self._number.pattern}(?:, {self._number.pattern})*")

    def numbers(self, text: str) -> str:
        """A number with its unit, or a list of them."""
        return ", ".join(map(self.number, text.split(", ")))

    def number(self, text: str) -> str:
        """A number with its unit."""
        match = re.match(_DIGITS, text)
        end = match.end() if match else 0
        return text[:end].replace(".", self.decimal) + self.unit(text[end:])

    def unit(self, text: str) -> str:
        """A unit, whatever stands before it."""
        written = re.sub(r"[A-Za-z]+", lambda part: self.units.get(part[0], part[0]), text.lstrip())
        joined = re.sub(r"(?<=\w|[²³⁴]) (?=\w)(?!на )(?<!на )", "·", written)
        return " " * (len(text) - len(text.lstrip())) + joined

    def entry(self, text: str) -> str:
        """Words of an entry of a machine: a key, a value, or a list of keys with their values."""
        return text if self.code == "en" else ", ".join(map(self._keyed, _LISTED.split(text)))

    def _keyed(self, text: str) -> str:
        """A key, alone or before a value or a further key; what else there is stays, as formulas do."""
        known = self._known(text)
        words = text.split(" ")
        for n in range(len(words) - 1, 0, -1) if known is None and not _FORMULA.search(text) else ():
            if key := self.keys.get(" ".join(words[:n])):
                rest = " ".join(words[n:])
                return f"{key}{':' if rest in self.keys else ''} {self._keyed(rest)}"
        return text if known is None else known

    def heading(self, text: str) -> str:
        """The heading of a table of a machine file, whose key it may be with a capital."""
        key = self.keys.get(_small(text), "")
        return _capital(key) if key and text not in self.texts else self(text)

    def label(self, text: str) -> str:
        """A label of an axis or the head of a column: words, and a unit in brackets at the end."""
        match = re.fullmatch(r"(.*?)\s*\[([^\[\]]+)\]", text, re.DOTALL)
        if match is None or self.code == "en":
            return self(text)
        return f"{self(match[1])} [{self.unit(match[2])}]"


def _filled(pattern: str, numbers: list[str], names: list[str]) -> str:
    """A translation with its numbers and names in place."""
    counted: dict[str, Iterator[str]] = {"#": iter(numbers), "{": iter(names)}

    def filling(place: re.Match[str]) -> str:
        values, which = (numbers, place[1]) if place[0][0] == "#" else (names, place[2])
        return values[int(which) - 1] if which else next(counted[place[0][0]], place[0])

    return _PLACE.sub(filling, pattern)


def _small(text: str) -> str:
    """A text with a small letter at its beginning."""
    return text[:1].lower() + text[1:]


def _capital(text: str) -> str:
    """A text with a capital at its beginning."""
    return text[:1].upper() + text[1:]


ENGLISH = Language()


@cache
def language(code: str, where: str = "--lang") -> Language:
    """A language by its code; an `InputError` if there is no catalogue for it."""
    if code == "en":
        return ENGLISH
    known = {path.stem.removeprefix("texts_"): path for path in Path(__file__).parent.glob("texts_*.toml")}
    if code not in known:
        raise InputError(f'{where}: found "{code}", expected one of {", ".join(sorted(["en", *known]))}')
    tables = tomllib.loads(known[code].read_text(encoding="utf-8"))
    keys = tables["keys"]
    texts = keys | tables["texts"]
    return Language(code, texts, tables["units"], tables["decimal"], keys, tuple(tables["titles"]))
