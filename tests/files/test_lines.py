"""The scanner of TOML finds every key that `tomllib` finds, on the line where it stands."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

import tomlkit
from hypothesis import given, settings
from hypothesis import strategies as st
from sizes import cases

from linkwright.kernel.files.lines import key_lines, line_of

KEYS = st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), min_size=1, max_size=8)
VALUES = st.recursive(
    st.one_of(st.integers(-9, 9), st.booleans(), st.text(max_size=12), st.floats(-1, 1)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(KEYS, inner, max_size=3)),
    max_leaves=12,
)
TABLES = st.dictionaries(KEYS, VALUES, max_size=5)


def places(node: Any, place: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """All keys below a node; a list of tables counts as one entry, as in the scanner."""
    entries = node.items() if isinstance(node, dict) else ()
    for key, value in entries:
        yield (*place, key)
        yield from places(value, (*place, key))


@settings(deadline=None, max_examples=cases(200, 2000))
@given(TABLES)
def test_every_key_is_found(tables: dict[str, Any]) -> None:
    text = tomlkit.dumps(tables)
    read = tomllib.loads(text)
    found = key_lines(text)
    lines = text.split("\n")
    for place in places(read):
        assert place in found
        assert 1 <= found[place] <= len(lines)
        if place[-1].isascii() and place[-1].isalnum():
            assert place[-1] in lines[found[place] - 1]


TEXT = '''# a comment with [brackets] and "quotes"
format = 1
"quoted.key" = "a # no comment"
[a.b]
c.d = 1          # dotted
list = [         # over several lines
  "x",  # ] not the end
  { e = 2, f = [3] },
]
many = """
[not.a.table]
key = 1
"quoted" ""\\"""""
last = \'\'\'
x = 2\'\'\'
[ a . "c.d" ]
g = { h = { i = 1 } }
[[tables]]
j = 1
'''


def test_lines_of_a_text_with_everything() -> None:
    found = key_lines(TEXT)
    expected = {
        ("format",): 2,
        ("quoted.key",): 3,
        ("a",): 4,
        ("a", "b"): 4,
        ("a", "b", "c"): 5,
        ("a", "b", "c", "d"): 5,
        ("a", "b", "list"): 6,
        ("a", "b", "list", "0"): 7,
        ("a", "b", "list", "1"): 8,
        ("a", "b", "list", "1", "e"): 8,
        ("a", "b", "list", "1", "f"): 8,
        ("a", "b", "list", "1", "f", "0"): 8,
        ("a", "b", "many"): 10,
        ("a", "b", "last"): 14,
        ("a", "c.d"): 16,
        ("a", "c.d", "g"): 17,
        ("a", "c.d", "g", "h"): 17,
        ("a", "c.d", "g", "h", "i"): 17,
        ("tables",): 18,
        ("tables", "0"): 18,
        ("tables", "0", "j"): 19,
    }
    assert found == expected


def test_entries_of_a_list_of_tables_are_counted() -> None:
    text = "[a]\n[[a.b]]\nc = 1\n[[a.b]]\nc = 2\n[a.b.d]\ne = 3\n[[a.b.f]]\ng = 4\n[[a.b.f]]\ng = 5\n"
    found = key_lines(text)
    assert found[("a", "b", "0", "c")] == 3
    assert found[("a", "b", "1")] == 4
    assert found[("a", "b", "1", "c")] == 5
    assert found[("a", "b", "1", "d", "e")] == 7
    assert found[("a", "b", "1", "f", "0", "g")] == 9
    assert found[("a", "b", "1", "f", "1", "g")] == 11


def test_a_missing_key_has_the_line_of_its_table() -> None:
    lines = key_lines("a = 1\n\n[b]\nc = 2\n")
    assert line_of(lines, ("b", "d", "e")) == 3
    assert line_of(lines, ("x",)) == 1
