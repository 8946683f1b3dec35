"""Each source that a docstring names is in the list of references, by its authors."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
REFERENCES = ROOT / "docs" / "references.md"

_SOURCE = re.compile(r"^ *\.\. \[\d+\] (.*(?:\n +(?!\.\. )\S.*)*)", re.MULTILINE)
_NAME = r"(?:[A-Z]\. )*(?:de )?[^\W\da-z_][\w’'-]+"
_AUTHORS = re.compile(rf"{_NAME}(?:(?:, | and ){_NAME})*")
# What is derived in the package itself, and the five papers, which each have their row.
_OWN = re.compile(r"Derived here|The rest is derived here|Paper [1-5]\b|O\. Reynolds")


def sources() -> Iterator[tuple[str, str]]:
    for path in sorted((ROOT / "python" / "linkwright").rglob("*.py")):
        for note in _SOURCE.findall(path.read_text(encoding="utf-8")):
            for source in re.split(r"; (?=[A-Z][\w’'-]+,)", " ".join(note.split('"""')[0].split())):
                yield path.name, source


def missing(named: Iterator[tuple[str, str]], rows: list[str]) -> list[tuple[str, str]]:
    return [
        (file, source)
        for file, source in named
        if not _OWN.match(source)
        and not any(all(author in row for author in authors(source)) for row in rows)
    ]


def authors(source: str) -> list[str]:
    found = _AUTHORS.match(source)
    return re.findall(r"[^\W\da-z_][\w’'-]{2,}", found[0])[:2] if found else [source]


def test_sources_are_in_the_references() -> None:
    named = list(sources())
    assert len(named) > 150
    assert missing(iter(named), REFERENCES.read_text(encoding="utf-8").splitlines()) == []


def test_a_missing_source_is_found() -> None:
    rows = ["| Golub–Pereyra | …", "| Hairer–Wanner | …"]
    named = [
        ("a.py", "Hairer, Wanner, *II*."),
        ("a.py", "Golub and Van Loan, 2013."),
        ("a.py", "Paper 3, (2)."),
    ]
    assert missing(iter(named), rows) == [named[1]]
