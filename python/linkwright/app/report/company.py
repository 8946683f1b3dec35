"""A company file: what stands at the head of a report that is handed in."""

from __future__ import annotations

import datetime
import os
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from pydantic import BeforeValidator, Field

from linkwright.kernel.description.base import Title
from linkwright.kernel.description.problems import WholeDescription
from linkwright.kernel.errors import InputError, MachineError, MachineFileError, Problem
from linkwright.kernel.files.lines import located
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.files.picture import svg_fault
from linkwright.kernel.files.text_file import TextError, data_of, text_of
from linkwright.kernel.limits import FILE_BYTES, LOGO_BYTES
from linkwright.kernel.page.content import Heading
from linkwright.kernel.public import public
from linkwright.machine.read import tables_of

# Kinds of pictures that a page and Typst both show.
_KINDS = ("svg", "png", "jpg", "jpeg")


def _as_text(value: object) -> object:
    """A date as TOML has it, as text."""
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
    """Ending and bytes of a logo, which lies in the folder of its company file."""
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
    """The file of a logo; the error for one elsewhere names the company file."""
    try:
        return named_file(name, document.parent, "logo", document="company file")
    except MachineFileError as error:
        raise MachineFileError([replace(problem, path=str(document)) for problem in error.problems]) from None
