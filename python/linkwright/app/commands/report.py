"""``linkwright report COMMAND …``: the answer of a command as a report that one hands in."""

from __future__ import annotations

from contextlib import redirect_stdout
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from linkwright.kernel.command.answer import Answer, finish, taken
from linkwright.kernel.command.out import Force, command_line, output_files, say_written
from linkwright.kernel.command.parameter import Argument, Option
from linkwright.kernel.errors import InputError

if TYPE_CHECKING:
    from linkwright.app.report.answered import Variant
    from linkwright.kernel.page.content import Content

Words = Annotated[
    list[str],
    Argument("COMMAND …", "The command with its file and options, as without `report`.", takes_rest=True),
]
To = Annotated[
    list[str] | None,
    Option("--to", "FILE", "FILE.html or FILE.pdf. Repeatable. Default: report.html."),
]
Company = Annotated[
    Path | None,
    Option(
        "--company", "FILE", "TOML file with company, logo, project, document and author for the letterhead."
    ),
]
Sections = Annotated[
    str | None,
    Option(
        "--sections",
        "LIST",
        "Sections to include, separated by commas: summary, sketch, results, formulas, data, "
        "assumptions, repeat.",
    ),
]
Lang = Annotated[str, Option("--lang", "CODE", "Language of the report: en, uk (Ukrainian).")]
Variants = Annotated[
    list[str] | None,
    Option(
        "--variant",
        '"NAME: PATH=VALUE; …"',
        'Compare with a variant, such as "heavier: bodies.cart1.mass=900 kg". Repeatable.',
    ),
]


def report(
    words: Words,
    to: To = None,
    company: Company = None,
    sections: Sections = None,
    variant: Variants = None,
    lang: Lang = "en",
    force: Force = False,
) -> None:
    """Write the answer of a command as a report, as a page or as PDF.

    As in `linkwright report --to carts.pdf --company company.toml run roller_two_carts`. Options of the
    report stand before the command.
    """
    from linkwright.app.report.answered import compared
    from linkwright.app.report.answered import variant as of_text
    from linkwright.app.report.company import read_heading
    from linkwright.kernel.page.content import Heading
    from linkwright.kernel.page.translation import in_language
    from linkwright.kernel.reader.language import language

    to_language = language(lang)
    places = output_files("--to", to or ["report.html"], (".html", ".pdf"), force=force)
    wanted = _sections(sections)
    head = read_heading(company) if company is not None else Heading()
    variants = [of_text(text) for text in variant or ()]
    if len({one.name for one in variants}) < len(variants):
        raise InputError("--variant: found one name twice, expected a name for each")
    everything = _content(words, command_line())
    content = everything if wanted is None else everything.only(wanted)
    if variants:
        others = {one.name: _content(_varied(words, one), "") for one in variants}
        content = compared(content, everything, others)
    _write(in_language(replace(content, heading=head), to_language), places, force=force)
    finish(Answer(machine=None, findings=content.findings))


def _sections(text: str | None) -> list[str] | None:
    from linkwright.kernel.description.base import suggestion
    from linkwright.kernel.page.content import SECTIONS

    if text is None:
        return None
    wanted = [section.strip() for section in text.split(",") if section.strip()]
    for name in wanted:
        if name not in SECTIONS:
            raise InputError(f'--sections: found "{name}"; {suggestion(name, SECTIONS)}')
    return wanted


def _content(words: list[str], command: str) -> Content:
    from linkwright.app.application import application
    from linkwright.app.report.answered import answered

    contents: list[Content] = []
    commands = application()
    # What the command prints in passing is no part of the report; what stops it, stops the report.
    with (
        taken(lambda answer: contents.append(answered(answer, command))),
        redirect_stdout(StringIO()),
        commands.make_context("linkwright", list(words)) as context,
    ):
        commands.invoke(context)
    if not contents:
        raise InputError(f"`linkwright {words[0]}` has no report")
    return contents[0]


def _varied(words: list[str], variant: Variant) -> list[str]:
    return [*words, *(word for entry in variant.entries for word in ("--set", entry))]


def _write(content: Content, places: list[Path], *, force: bool) -> None:
    from linkwright.kernel.command.console import progress
    from linkwright.kernel.files.output import write_file
    from linkwright.kernel.page.html import html
    from linkwright.kernel.page.typeset import pdf

    made: dict[Path, str | bytes] = {}
    for place in places:
        with progress(f"writing {place.name}"):
            made[place] = pdf(content) if place.suffix.lower() == ".pdf" else html(content)
    # What cannot be made leaves no file behind, nor half of them.
    for place, data in made.items():
        write_file(place, data, replace=force)
    say_written(places, quiet=False)
