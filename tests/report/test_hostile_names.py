"""Markup, quotes, scripts and formulas in every name and text of a file are words on every page.

All names of machines of the library are replaced, wherever they stand, and the pages of commands are read:
they have no elements, attributes and scripts but those of the templates and of figures.
"""

from __future__ import annotations

import re
import tomllib
from base64 import b64encode
from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
import tomlkit
from command_line import invoke
from tests.cli.test_answer import FILES, TEXTS

from linkwright.kernel.figure.svg import identifier
from linkwright.kernel.page.html import _policy

# Each ends what may stand around it, then brings a script; a name has no point, and quotes of one kind.
ATTACKS = (
    '"><img/src=x/onerror=title=7>',
    "' onload='title=7",
    "</script><script>title=7</script>",
    "javascript:title=7",
    "--><script>title=7</script>",
    "\\g<1>{{7*7}}\\input",
)
TEXT = (
    '"\'></title></pre></script><script>title=7</script>\r\n<a href="javascript:title=7">\u2028${7*7}{{7*7}}'
)

# Tables whose keys are names.
NAMED = re.compile(
    r"(mechanism|train|train\.run)\.\w+|bodies|loads|rod_rotator\.\w+|study\.(variables|responses)|variables|responses"
)
NOT_NAMED = ("train.run", "train.engine", "train.driver", "train.limits")

# Elements of the templates, and of formulas and figures.
ELEMENTS = """
html head meta title style body header main section div p h1 h2 h3 dl dt dd ul ol li nav figure figcaption
table caption thead tbody tr th td span a b small br sub sup pre code details summary script button label
input output img svg g defs clippath path rect use text tspan image circle line polyline polygon
math mrow mi mn mo msub msup msubsup mfrac msqrt mover munder munderover mtext mspace mtable mtr mtd
"""


def _names(table: Any, place: str = "") -> Iterator[str]:
    if not isinstance(table, dict):
        return
    is_named = NAMED.fullmatch(place) and not place.startswith(NOT_NAMED)
    for key, value in table.items():
        if is_named and isinstance(value, dict | str):
            yield key
        yield from _names(value, f"{place}.{key}" if place else key)


def _attacked(value: Any, known: dict[str, str]) -> Any:
    """A file with other names; what refers to them refers to the new ones."""
    if isinstance(value, dict):
        return {_attacked(key, known): _attacked(entry, known) for key, entry in value.items()}
    if isinstance(value, list):
        return [_attacked(entry, known) for entry in value]
    if isinstance(value, str) and re.fullmatch(r"[\w.]+", value):
        return ".".join(known.get(part, part) for part in value.split("."))
    return value


def hostile(text: str) -> tuple[str, dict[str, str]]:
    """A file whose names and texts are attacks, and the names by those that they replace."""
    data = tomllib.loads(text)
    # Words of the format stay where a name is the same.
    kinds = re.findall(r'\bkind *= *"(\w+)"', text)
    names = [name for name in dict.fromkeys(_names(data)) if name not in kinds and "." not in name]
    known = {name: f"{ATTACKS[n % len(ATTACKS)]}{n}" for n, name in enumerate(names)}
    data = _attacked(data, known)
    for key in ("name", "source"):
        data[key] = re.sub(r"[\r\n\u2028]", "", TEXT)
    data["description"] = TEXT
    return tomlkit.dumps(data), known


class Found(HTMLParser):
    """What of a page is no template, figure or word."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.scripts: list[str] = []
        self.wrong: list[str] = []
        self.names: list[str] = []
        self.is_script = False
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.is_script = tag == "script" and ("type", "application/json") not in attrs
        if self.is_script:
            self.scripts.append("")
        if tag not in ELEMENTS.split():
            self.wrong.append(f"<{tag}>")
        for key, value in attrs:
            if not re.fullmatch(r"[a-z][\w:-]*", key) or key.startswith("on"):
                self.wrong.append(f"{tag} {key}={value}")
            if key in ("href", "src", "xlink:href") and not (value or "").startswith(("#", "data:image/")):
                self.wrong.append(f"{tag} {key}={value}")
            if key == "id":
                self.names.append(value or "")

    def handle_endtag(self, tag: str) -> None:
        self.is_script = False

    def handle_data(self, data: str) -> None:
        if self.is_script:
            self.scripts[-1] += data


def require_sound(text: str) -> None:
    found = Found(text)
    assert not found.wrong
    assert not [name for name in found.names if re.search(r"[\s\"'<>&\\]", name)]
    hashes = {b64encode(sha256(script.encode()).digest()).decode() for script in found.scripts}
    assert hashes <= set(re.findall(r"sha256-([\w+/=]+)", _policy()))


# Name of a machine → commands that have much to say of it.
CASES = {
    "roller_two_carts": (
        "run",
        "motion",
        "forces",
        "check",
        "balance --links A1",
        "size",
        "sensitivity",
        "transient --revolutions 1",
    ),
    "roller_cam": ("cam", "run", "motion", "forces"),
    "undercut": ("cam",),
    "v8_diesel": ("torsion",),
    "engine": ("torsion",),
    "symmetric.toml": ("torsion damper --on left --ring-inertia 0.1",),
    "topper": ("topper", "run"),
    "field.toml": ("topper field",),
    "rod_rotator_continuous": ("run",),
}


@cache
def _file(name: str) -> str:
    return TEXTS[name] if name in TEXTS else Path(FILES[name]).read_text(encoding="utf-8")


# Long names leave some axes no room.
@pytest.mark.filterwarnings("ignore:constrained_layout not applied")
@pytest.mark.parametrize(
    ("name", "command"), [(name, command) for name, commands in CASES.items() for command in commands]
)
def test_names_and_texts_are_words(name: str, command: str, tmp_path: Path) -> None:
    text, known = hostile(_file(name))
    (tmp_path / "machine.toml").write_text(text, encoding="utf-8", newline="")
    words, *options = command.split(" --")
    page = tmp_path / "page.html"
    given = [known.get(word, word) for option in options for word in f"--{option}".split()]
    call = ["report", "--to", str(page), *words.split(), str(tmp_path / "machine.toml"), *given]
    done = invoke(*call)
    assert done.exit_code in (0, 1), done.output
    assert page.is_file(), done.output
    require_sound(page.read_text(encoding="utf-8"))


def test_page_brings_its_policy() -> None:
    policy = _policy()
    assert policy.startswith("default-src 'none'; img-src data:; script-src 'sha256-")
    assert "script-src 'unsafe" not in policy
    assert "; style-src 'sha256-" in policy


def test_identifiers_are_never_the_same() -> None:
    names = ["a b", "a.b", "a.20.b", "a<b", "a\\b", "ab", "a\nb", "a-b", "a_b"]
    assert len({identifier(name) for name in names}) == len(names)
    assert all(re.fullmatch(r"[\w.-]+", identifier(name)) for name in names)
