"""The text of a file that a user names, read whole up to a limit, as UTF-8; and sizes of what it holds.

Sizes are examined before any of it is understood, by loops over the file: what is nested deeper than
Python's stack, or longer than its patience, is reported like any other fault.
"""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from linkwright.kernel.description.place import join
from linkwright.kernel.errors import Problem, show
from linkwright.kernel.limits import DEPTH, ENTRIES, LIST, NAME, TEXT, Limit, grouped


class TextError(Exception):
    """Why a file has no text: what it is, and what to change; whoever reads it says where that stands."""

    def __init__(self, found: str, remedy: str = "", expected: str = "") -> None:
        super().__init__(found)
        self.found = found
        self.remedy = remedy
        self.expected = expected


def text_of(path: Path, limit: Limit) -> str:
    """The text of a file of at most so many bytes.

    A mark that editors on Windows put in front of the text is left out. Raises `TextError` as `data_of`, or
    if it is no UTF-8 text.
    """
    return _decoded(data_of(path, limit))


def data_of(path: Path, limit: Limit) -> bytes:
    """Bytes of a file or device, at most `limit`; `TextError` if it is unreadable or too large."""
    require_no_pipe(path)
    try:
        with path.open("rb") as file:
            data = file.read(limit.most + 1)
    except IsADirectoryError:
        raise TextError("a directory") from None
    except FileNotFoundError:
        raise TextError("no such file") from None
    except PermissionError:
        # Windows refuses to open a directory by the same error.
        raise TextError("a directory" if path.is_dir() else "a file without permission to read it") from None
    except (OSError, ValueError) as error:
        raise TextError(f"a file that cannot be read ({error})") from None
    if len(data) > limit.most:
        raise TextError("a larger file", expected=limit.words)
    return data


def require_no_pipe(path: Path) -> None:
    """Raise `TextError` for a pipe with a name: opening it waits for somebody to write.

    Pipes without a name, as a shell hands them over in ``<(…)`` and ``/dev/stdin``, have their writer.
    """
    try:
        # What is open already leads to no place among the files.
        is_pipe = stat.S_ISFIFO(os.lstat(os.path.realpath(path)).st_mode)
    except (OSError, ValueError):
        return
    if is_pipe:
        raise TextError("a named pipe", "write its content to a file, or use <(…) of the shell")


def _decoded(data: bytes) -> str:
    """The bytes as text, without what only programs write."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise TextError("UTF-16 text", "save the file as UTF-8")
    if b"\0" in data:
        place = data.index(b"\0") + 1
        raise TextError(f"no text (byte {place} is 0)", "save the file as UTF-8 text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TextError(f"no UTF-8 text (byte {error.start + 1})", "save the file as UTF-8") from None


# More faults of one kind than anybody reads.
_ENOUGH = 100

# A whole number that the core holds.
_WHOLE = 2**63

# A key with too many parts, where a key may stand: tomllib takes the square of their number.
_PART = r"""[ \t]*+(?:"[^"\n]*+"|'[^'\n]*+'|[A-Za-z0-9_-]++)[ \t]*+"""
_DEEP_KEY = re.compile(rf"(?:^|[\n{{,\[])(?:{_PART}\.){{{DEPTH.most}}}")
_BRACKETS = re.compile(rf"(?:[\[{{]\s*+(?:{_PART}=\s*+)?){{{DEPTH.most + 1}}}")

# Digits of a number that Python still reads.
_DIGITS = re.compile(r"[0-9_]{1001}")


def deep_line(text: str) -> int | None:
    """Line of the first key or list that is nested too deep to be read, counted from 1; None if none is."""
    match = _DEEP_KEY.search(text) or _BRACKETS.search(text)
    return None if match is None else text.count("\n", 0, match.end()) + 1


def long_number_line(text: str) -> int | None:
    """Line of the first number that has more digits than can be read, counted from 1; None if none has."""
    match = _DIGITS.search(text)
    return None if match is None else text.count("\n", 0, match.start()) + 1


def size_problems(tables: dict[str, Any]) -> list[Problem]:
    """Lists, tables, names, texts and numbers that are too large, with their keys; some, if they are many."""
    problems: list[Problem] = []
    places: list[tuple[tuple[str, ...], Any]] = [((), tables)]
    while places and len(problems) < _ENOUGH:
        place, node = places.pop()
        problems += _problems(place, node)
        if len(place) < DEPTH.most and isinstance(node, dict | list) and len(node) <= _most(node):
            below = node.items() if isinstance(node, dict) else enumerate(node)
            places += [((*place, str(key)), entry) for key, entry in below]
    return problems


def _most(node: dict[str, Any] | list[Any]) -> int:
    return (ENTRIES if isinstance(node, dict) else LIST).most


def _problems(place: tuple[str, ...], node: Any) -> Iterator[Problem]:
    key = join(part[: NAME.most] for part in place[:_SHOWN_DEPTH])
    if place and len(place[-1]) > NAME.most:
        yield Problem(key, f"a name of {grouped(len(place[-1]))} characters", NAME.words, "shorten it")
    if isinstance(node, dict | list):
        limit = ENTRIES if isinstance(node, dict) else LIST
        word = "a table with" if isinstance(node, dict) else "a list of"
        if len(node) > limit.most:
            remedy = "" if isinstance(node, dict) else "take fewer, or a file of points (file = …)"
            yield Problem(key, f"{word} {grouped(len(node))} entries", limit.words, remedy)
        elif len(place) >= DEPTH.most and node:
            yield Problem(key, "tables or lists inside one another", DEPTH.words, "remove what is inside")
    elif isinstance(node, str) and len(node) > TEXT.most:
        yield Problem(key, f"a text of {grouped(len(node))} characters", TEXT.words, "shorten it")
    elif isinstance(node, int) and abs(node) >= _WHOLE:
        yield Problem(key, show(node), "a number below 9.2e18", "write it as 1e19, or with another unit")


# Parts of a key that a message shows.
_SHOWN_DEPTH = 8
