"""What a report says, before it is a page or a PDF: one content, whatever it becomes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from linkwright.kernel.reader.language import ENGLISH, Language

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from linkwright.kernel.figure.style import CaptionedFigure
    from linkwright.kernel.page.formulas import Formula
    from linkwright.kernel.page.table import Table

# Sections by name, in the order of a report; what failed and the warnings are always there.
SECTIONS = ("summary", "sketch", "results", "formulas", "data", "assumptions", "repeat")


class Part(NamedTuple):
    """A part of the results: its heading, its tables, and its figures."""

    title: str
    tables: Sequence[Table] = ()
    figures: Sequence[CaptionedFigure] = ()


class Few(NamedTuple):
    """One of the few numbers that one looks for first: its words, the number, its unit."""

    word: str
    value: str
    unit: str


class Heading(NamedTuple):
    """What stands at the head of a report that is handed in: of a company file, each line if it is given."""

    company: str = ""
    address: str = ""
    logo: tuple[str, bytes] | None = None
    project: str = ""
    document: str = ""
    revision: str = ""
    author: str = ""
    checked: str = ""
    date: str = ""

    def rows(self) -> list[tuple[str, str]]:
        """What is known of the document: word and entry."""
        words = {
            "Project": self.project,
            "Document": self.document,
            "Revision": self.revision,
            "Author": self.author,
            "Checked by": self.checked,
            "Date": self.date,
        }
        return [(word, entry) for word, entry in words.items() if entry]


_NO_HEADING = Heading()


@dataclass(frozen=True, kw_only=True)
class Content:
    """What a report says."""

    # Name of the machine, one sentence about it, where its numbers are from.
    title: str
    names: Collection[str] = ()  # further names that its author gave, which stay in every language
    heading: Heading = _NO_HEADING  # what stands at its head
    about: str = ""  # its description, in the words of its author
    lead: str = ""
    source: str = ""
    notes: Sequence[tuple[str, str]] = ()  # what must be read first, heading and text
    # What the machine cannot do; what its designer should know besides.
    findings: Sequence[str] = ()
    warnings: Sequence[str] = ()
    passed: str = ""  # what is said where all checks pass
    headline: Sequence[Few] = ()  # the few numbers that one looks for first
    # Data of the moving drawings, by what they show: `"mechanism"`, `"topper"`.
    scenes: Mapping[str, dict[str, Any]] = field(default_factory=dict)
    sketch: Callable[[], Figure] | None = None  # draws the machine at one instant, for paper
    parts: Sequence[Part] = ()  # the results
    formulas: Sequence[Formula] = ()  # what the numbers rest on
    papers: str = ""  # where the formulas are from
    # Data of the machine: heading → parts of `linkwright.machine.table`.
    groups: Sequence[tuple[str, Sequence[Any]]] = ()
    assumptions: Sequence[str] = ()  # what was taken for granted
    file: str = ""  # the machine as a machine file in its units; empty without one
    command: str = ""  # the command line that gives the same
    language: Language = ENGLISH  # that it is written in, by `linkwright.kernel.reader.language.in_language`

    def __post_init__(self) -> None:
        """A page has figures in place of what letters draw."""
        parts = [
            part._replace(tables=[one for one in part.tables if not one.is_drawing]) for part in self.parts
        ]
        object.__setattr__(self, "parts", parts)

    @property
    def has_figures(self) -> bool:
        """Whether there is a figure among the results."""
        return any(part.figures for part in self.parts)

    def only(self, sections: Sequence[str]) -> Content:
        """The content with these of `SECTIONS` alone."""
        empty: dict[str, dict[str, Any]] = {
            "summary": {"headline": ()},
            "sketch": {"scenes": {}, "sketch": None},
            "results": {"parts": ()},
            "formulas": {"formulas": (), "papers": ""},
            "data": {"groups": ()},
            "assumptions": {"assumptions": ()},
            "repeat": {"file": "", "command": ""},
        }
        left_out = [empty[name] for name in SECTIONS if name not in sections]
        return replace(self, **{key: value for section in left_out for key, value in section.items()})
