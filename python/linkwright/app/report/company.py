"""A company file: the head of a report. Its logo may be an SVG, a document that could run and load."""

from __future__ import annotations

import datetime
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Annotated
from xml.etree import ElementTree

from pydantic import BeforeValidator, Field

from linkwright.kernel.description.base import Title
from linkwright.kernel.description.problems import WholeDescription
from linkwright.kernel.errors import InputError, MachineError, MachineFileError, Problem
from linkwright.kernel.files.lines import located
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.files.text_file import TextError, data_of, text_of
from linkwright.kernel.limits import FILE_BYTES, LOGO_BYTES
from linkwright.kernel.page.content import Heading
from linkwright.kernel.public import public
from linkwright.machine.read import tables_of

# Kinds of pictures that a page and Typst both show.
_KINDS = ("svg", "png", "jpg", "jpeg")

# What is shown and does nothing: other elements run, load, link or hold HTML.
_ELEMENTS = """
svg g defs symbol use title desc metadata style path rect circle ellipse line polyline polygon text tspan
textPath linearGradient radialGradient stop clipPath mask pattern marker image filter switch view
"""

# Vocabularies, as ElementTree writes them.
_SVG, _HTML = "{http://www.w3.org/2000/svg", "{http://www.w3.org/1999/xhtml"

# A picture within the picture, whole in its address.
_WITHIN = re.compile(r"data:image/(?:png|jpeg|gif|webp);base64,[\w+/=\s]*")

# What a style loads, unless it is an element of the same picture.
_LOADED = re.compile(r"@import|\\|url\(\s*['\"]?(?!\s*['\"]?#)", re.IGNORECASE)


def _as_text(value: object) -> object:
    return value.isoformat() if isinstance(value, datetime.date) else value


class CompanyFile(WholeDescription):
    """What a company file says; each entry may be left out."""

    company: Title = Field("", description="Name of the company.")
    address: Title = Field("", description="Its address, on one line.")
    logo: str = Field("", description="Picture beside the name, SVG, PNG or JPEG; beside this file.")
    project: Title = Field("", description="Project that the report belongs to.")
    document: Title = Field("", description="Number of the document.")
    revision: Title = Field("", description="Its revision.")
    author: Title = Field("", description="Author.")
    checked: Title = Field("", description="Checked by.")
    date: Annotated[Title, BeforeValidator(_as_text)] = Field("", description="Date of the document.")


@public
def read_heading(path: str | os.PathLike[str]) -> Heading:
    """Read the head of reports from a company file.

    Parameters
    ----------
    path : path
        A TOML file with entries such as ``company``, ``logo``, ``document``, ``author``.

    Returns
    -------
    Heading
        With the logo as bytes.

    Raises
    ------
    MachineFileError
        The file is wrong; all problems are listed.
    InputError
        The logo cannot be read.
    """
    place = Path(path)
    try:
        text = text_of(place, FILE_BYTES)
    except TextError as error:
        expected = error.expected or "a company file"
        raise MachineFileError([Problem("", error.found, expected, error.remedy, str(place))]) from None
    tables = tables_of(text, str(place))
    try:
        known = CompanyFile.model_validate(tables)
    except MachineError as error:
        raise MachineFileError(located(error.problems, text, str(place))) from None
    entries = known.model_dump(exclude={"logo"})
    return Heading(logo=_picture(known.logo, place) if known.logo else None, **entries)


def _picture(name: str, document: Path) -> tuple[str, bytes]:
    path = _named(name, document)
    ending = path.suffix.lower().removeprefix(".")
    if ending not in _KINDS:
        raise InputError(f"logo: found {path}, expected a picture that ends in {', '.join(_KINDS)}")
    try:
        data = data_of(path, LOGO_BYTES)
    except TextError as error:
        expected = error.expected or "a picture"
        raise InputError(f"logo: {path}: found {error.found}, expected {expected}") from None
    if ending == "svg" and (fault := svg_fault(data)):
        raise InputError(f"logo: {path}: found {fault}, expected a picture without scripts and links")
    return ending, data


def _named(name: str, document: Path) -> Path:
    try:
        return named_file(name, document.parent, "logo", document="company file")
    except MachineFileError as error:
        raise MachineFileError([replace(problem, path=str(document)) for problem in error.problems]) from None


def svg_fault(data: bytes) -> str:
    """What of an SVG a report does not take, such as a script or a link; empty if it takes all of it."""
    if b"<!ENTITY" in data:
        return "an entity"
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        return f"no SVG that can be read ({error})"
    if _local(root.tag) != "svg":
        return "no SVG"
    return next((fault for element in root.iter() for fault in _faults(element)), "")


def _faults(element: ElementTree.Element) -> Iterator[str]:
    """What of an element a report does not take; those of other vocabularies say things about the picture."""
    space, _, name = element.tag.rpartition("}")
    is_shown = space in ("", _SVG)
    if space == _HTML or (is_shown and name not in _ELEMENTS.split() and not name.startswith("fe")):
        yield f"an element <{name}>"
    if is_shown and name == "style" and _LOADED.search(element.text or ""):
        yield "a style that loads something"
    for key, value in element.attrib.items():
        yield from _attribute_faults(_local(key).lower(), value.strip())


def _attribute_faults(key: str, value: str) -> Iterator[str]:
    if key.startswith("on"):
        yield f"a script ({key})"
    elif (
        key in ("href", "src") and not (value.startswith("#") or _WITHIN.fullmatch(value))
    ) or _LOADED.search(value):
        yield f"a link ({key})"


def _local(name: str) -> str:
    return name.rpartition("}")[2]
