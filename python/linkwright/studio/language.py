"""The studio in another language than English: what the server says, and the texts of the page.

A catalogue, ``texts_CODE.toml``, adds texts to that of reports (`linkwright.kernel.reader.language`):
``page`` for those that the page draws itself beside the words of machine files, ``file`` for the
declarations of entries.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from linkwright.kernel.reader.language import ENGLISH, Language, language
from linkwright.kernel.reader.out_units import OutUnits, reader, shown_in
from linkwright.kernel.reader.sentences import sentences
from linkwright.machine.machine import Machine

# What a message says in sentences or words; everything else is read by the page, or is the user's own.
_TEXTS = frozenset(
    (
        *(
            "about",
            "caption",
            "expected",
            "findings",
            "found",
            "mend",
            "obstacle",
            "reason",
            "remedy",
            "waits",
        ),
        *("tie", "title", "warnings", "word", "words"),
    )
)

# What stands in quotes, and a letter of no language in its place while the rest is translated.
_QUOTED = re.compile('"[^"]*"')
_MARK = "\ue000"


@cache
def spoken(code: str) -> Language:
    """The language of a tab; an `InputError` if there is no catalogue for it."""
    of = language(code, "language")
    if of is ENGLISH:
        return of
    return replace(of, texts={**of.texts, **_catalogue(code)["file"]})


@cache
def page_texts(code: str) -> dict[str, Any]:
    """What the page needs to draw itself in a language: ``code``, ``texts``, ``units`` and ``decimal``."""
    of = language(code, "language")
    texts = {**of.keys, **_catalogue(code)["page"]}
    return {"code": code, "texts": texts, "units": of.units, "decimal": of.decimal}


def _catalogue(code: str) -> dict[str, dict[str, str]]:
    return tomllib.loads(Path(__file__).with_name(f"texts_{code}.toml").read_text(encoding="utf-8"))


def as_read(body: dict[str, Any]) -> dict[str, Any]:
    """A message with the numbers of its sentences in the units of whoever reads it."""
    if not reader().chosen:
        return body
    changed = {key: sentences(body[key]) for key in ("findings", "warnings") if body.get(key)}
    return {**body, **changed}


# How the page writes units, and how files do.
_WRITTEN = str.maketrans({"°": "deg", "²": "^2", "³": "^3"})


def in_units(units: Iterable[str]) -> AbstractContextManager[None]:
    """Numbers of sentences, reports and figures in the units of the page, as long as the block lasts."""
    return shown_in(", ".join(str(unit).translate(_WRITTEN) for unit in units))


# SI units of the kinds that the page lets choose.
_KINDS = ("m", "rad", "rad/s", "m/s", "m/s²", "N", "N m", "kg", "kg m²", "W", "s", "J", "Pa")


def units_of(machine: Machine) -> dict[str, tuple[str, float]]:
    """Units of the table ``[units]`` of a file: SI unit → unit, and its size in SI."""
    chosen = OutUnits.of_table(machine.units)
    return {unit: chosen.shown(unit) for unit in _KINDS if chosen.has(unit)}


def in_words(body: Any, code: str, key: str = "") -> Any:
    """A message with its texts in a language."""
    if code == "en":
        return body
    if isinstance(body, Mapping):
        if body.get("own"):
            # Names are the user's own, also those that are words of ours.
            return body
        return {
            name: _titled(value, code)
            if name == "machines" and isinstance(value, list)
            else in_words(value, code, name)
            for name, value in body.items()
        }
    if isinstance(body, list | tuple):
        return [in_words(value, code, key) for value in body]
    return _said(body, code) if isinstance(body, str) and key in _TEXTS else body


def _titled(machines: list[dict[str, str]], code: str) -> list[dict[str, str]]:
    """Machines of the gallery: what templates are is said, names of other machines are the user's own."""
    texts = spoken(code).texts
    return [
        {**machine, "title": texts.get(machine["title"], machine["title"])}
        if machine["place"] == "template"
        else machine
        for machine in machines
    ]


@lru_cache(4096)
def _said(text: str, code: str) -> str:
    """A text; of an unknown list each part by itself. What is quoted stays as files have it."""
    to = spoken(code)
    if (translated := to.template(text)) != text:
        return translated
    quoted = _QUOTED.findall(text)
    bare = _QUOTED.sub(_MARK, text)
    listed = bare.split(", ")
    # A list of known texts comes first: "torque of {}" would take all that follows for the name.
    is_list = bare not in to.texts and all(part in to.texts or part == "…" for part in listed)
    words = bare if is_list else to(bare)
    words = words if words != bare else ", ".join(map(to, listed))
    parts = iter(quoted)
    return re.sub(_MARK, lambda _: next(parts), words)
