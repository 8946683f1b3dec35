"""Lines of the keys in a TOML text.

`tomllib` gives the values but not where they stand. This scanner reads a text that `tomllib` has accepted, so
it only needs to tell keys, strings, brackets and comments apart; it takes no value at face value.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from linkwright.kernel.description.place import split
from linkwright.kernel.errors import Problem

Place = tuple[str, ...]

_SPACE = re.compile(r"(?:[ \t]|#[^\n]*|\r?\n)*")
_BLANK = re.compile(r"[ \t]*")
_KEY_PART = re.compile(r"""[ \t]*("(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[A-Za-z0-9_-]+)[ \t]*(\.?)""")
# A multi-line string may end in up to two quotes of its own before the three that close it.
_STRING = re.compile(
    r'"""(?:[^\\]|\\.)*?"{3,5}|'
    r"'''.*?'{3,5}|"
    r'"(?:[^"\\\n]|\\.)*"|'
    r"'[^'\n]*'",
    re.DOTALL,
)
_PLAIN = re.compile(r"[^,\]}#\n]+")


def key_lines(text: str) -> dict[Place, int]:
    r"""Line of every key, table and list entry of valid TOML, counted from 1.

    Places in a list are numbers as text. A table that is only implied by the name of another one has the line
    of its first mention.

    >>> key_lines("[a]\nb = 1\nc = [2, 3]")[("a", "c", "1")]
    3
    """
    scanner = _Scanner(text)
    scanner.document()
    return scanner.lines


def line_of(lines: dict[Place, int], place: Sequence[str]) -> int:
    """Line of a key, or of the nearest table above it that stands in the text; 1 if nothing above it does."""
    known = (lines.get(tuple(place[:n])) for n in range(len(place), 0, -1))
    return next((line for line in known if line is not None), 1)


def located(problems: Sequence[Problem], text: str, path: str, at: Place = ()) -> list[Problem]:
    """Problems of a file, or of its table `at`, with their lines, in the order of the file."""
    lines = key_lines(text)
    placed = []
    for problem in problems:
        place = (*at, *(split(problem.key) if problem.key else ()))
        key = ".".join((*at, problem.key)) if problem.key else ".".join(at)
        placed.append(replace(problem, key=key, path=path, line=line_of(lines, place)))
    return sorted(placed, key=lambda problem: problem.line or 0)


@dataclass
class _Scanner:
    """Goes once through the text; ``at`` is the position."""

    text: str
    at: int = 0
    lines: dict[Place, int] = field(default_factory=dict)
    # List of tables → how many of its entries have been met.
    _entries: dict[Place, int] = field(default_factory=dict)
    _counted: tuple[int, int] = (0, 1)

    def document(self) -> None:
        table: Place = ()
        self._skip(_SPACE)
        while self.at < len(self.text):
            table = self._header() if self._sees("[") else self._entry(table)
            self._skip(_SPACE)

    def _header(self) -> Place:
        """``[a.b]`` or ``[[a.b]]``; returns the place of the table, or of an entry of a list."""
        many = self._sees("[[")
        self.at += 2 if many else 1
        place = self._within(self._key(), many=many)
        for n in range(1, len(place) + 1):
            self._note(place[:n])
        self.at = self.text.index("]", self.at) + (2 if many else 1)
        return place

    def _within(self, key: Place, *, many: bool) -> Place:
        """The place that a header means: below the last entry of each list on the way, or a new entry."""
        place: Place = ()
        for n, part in enumerate(key, start=1):
            place = (*place, part)
            if many and n == len(key):
                self._entries[place] = self._entries.get(place, 0) + 1
            if place in self._entries:
                place = (*place, str(self._entries[place] - 1))
        return place

    def _entry(self, table: Place) -> Place:
        """``key = value`` in a table; returns the table."""
        place = (*table, *self._key())
        for n in range(len(table) + 1, len(place) + 1):
            self._note(place[:n])
        self._skip(_BLANK)
        self.at += 1
        self._value(place)
        return table

    def _key(self) -> Place:
        parts, more = [], True
        while more:
            match = _KEY_PART.match(self.text, self.at)
            assert match is not None, "the text is valid TOML"
            parts.append(_unquoted(match[1]))
            self.at, more = match.end(), match[2] == "."
        return tuple(parts)

    def _value(self, place: Place) -> None:
        self._skip(_BLANK)
        if self._sees("["):
            self._list(place)
        elif self._sees("{"):
            self._inline_table(place)
        else:
            self._skip(_STRING if self.text[self.at] in "\"'" else _PLAIN)

    def _list(self, place: Place) -> None:
        self.at += 1
        n = 0
        while not self._closes("]"):
            entry = (*place, str(n))
            self._note(entry)
            self._value(entry)
            n += 1

    def _inline_table(self, place: Place) -> None:
        self.at += 1
        while not self._closes("}"):
            self._entry(place)

    def _closes(self, bracket: str) -> bool:
        """Pass space and a comma, and the closing bracket if it is next."""
        self._skip(_SPACE)
        if self._sees(","):
            self.at += 1
            self._skip(_SPACE)
        if self._sees(bracket):
            self.at += 1
            return True
        return False

    def _sees(self, mark: str) -> bool:
        return self.text.startswith(mark, self.at)

    def _skip(self, pattern: re.Pattern[str]) -> None:
        match = pattern.match(self.text, self.at)
        self.at = match.end() if match else self.at

    def _note(self, place: Place) -> None:
        """Remember the line of a key at its first mention."""
        position, line = self._counted
        line += self.text.count("\n", position, self.at)
        self._counted = (self.at, line)
        self.lines.setdefault(place, line)


def _unquoted(key: str) -> str:
    if key[0] not in "\"'":
        return key
    value: str = tomllib.loads(f"k = {key}")["k"]
    return value
