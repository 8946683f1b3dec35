"""What the report of a study says, and its page."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.app.report.scene import moving_scene, scene
from linkwright.app.study import Study
from linkwright.app.subjects import ANALYSES
from linkwright.drive.steady_state import SteadyState
from linkwright.kernel.files.output import write_file
from linkwright.kernel.page.content import Content, Few, Heading, Part
from linkwright.kernel.page.html import html
from linkwright.kernel.public import public
from linkwright.kernel.reader.angle_zero import zero_shown
from linkwright.kernel.reader.numbers import degrees, zero_words
from linkwright.kernel.reader.out_units import with_units_of
from linkwright.kernel.reader.sentences import sentences
from linkwright.linkages.figures import POOR
from linkwright.linkages.tables import worst_transmission
from linkwright.machine.machine import Machine
from linkwright.machine.table import grouped, machine_parts
from linkwright.machine.write import in_own_units

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@public
def write_report(
    study: Study,
    path: str | os.PathLike[str],
    *,
    command: str = "",
    heading: Heading | None = None,
    language: str = "en",
) -> None:
    """Write the report of a study to a file.

    Parameters
    ----------
    study : Study
    path : path
        A file that ends in ``.pdf`` is a PDF, any other an HTML page; replaced if it exists.
    command : str
        Command line that made the study, for the section on how to repeat it.
    heading : Heading, optional
        What stands at its head, by `read_heading`.
    language : str
        ``"en"`` or ``"uk"``, Ukrainian.

    Raises
    ------
    InputError
        The file cannot be written, Typst is not installed, or nobody knows the language.
    """
    from linkwright.kernel.page.translation import in_language
    from linkwright.kernel.reader.language import language as of_code

    to = of_code(language, "language")
    report = in_language(replace(content(study, command), heading=heading or Heading()), to)
    if Path(path).suffix.lower() != ".pdf":
        write_file(path, html(report))
        return
    from linkwright.kernel.page.typeset import pdf

    write_file(path, pdf(report))


def report_html(study: Study, *, command: str = "") -> str:
    """Report of a study as one HTML page; `command`: the command line that made the study."""
    return html(content(study, command))


def content(study: Study, command: str = "") -> Content:
    """What the report of a study says, in the units of the reader, else of the machine file."""
    with with_units_of(study.machine.units):
        return _content(study, command)


def _content(study: Study, command: str) -> Content:
    machine = study.machine
    motion, other = ([analysis for analysis in ANALYSES if analysis.is_motion is so] for so in (True, False))
    shown = study.shown
    parts = (
        Part("Motion", list(shown(motion, "tables")), list(shown(motion, "figures"))),
        Part("Results", list(shown(other, "tables")), list(shown(other, "figures"))),
        Part("Details", list(study.showing("details"))),
    )
    sections = machine_sections(machine, study.steady_state, study.rod_string)
    knife = knife_scene(study)
    sections["scenes"] = {**({"topper": knife} if knife is not None else {}), **sections["scenes"]}
    sections["assumptions"] = list(study.showing("assumptions"))
    return Content(
        title=machine.name,
        about=machine.description or "",
        lead=zero_words(zero_shown()),
        findings=sentences(study.findings),
        warnings=sentences(study.warnings),
        passed="" if study.findings else _passed(study),
        headline=[Few(*line) for line in study.headline(ANALYSES)],
        parts=[part for part in parts if part.tables or part.figures],
        formulas=list(study.showing("formulas")),
        papers=". ".join(study.showing("papers")),
        command=command or "linkwright run machine.toml --out report",
        **sections,
    )


def _passed(study: Study) -> str:
    """What is said where all checks pass; a poor transmission angle is no fault, and none of them."""
    worst = None if study.linkage is None else worst_transmission(study.linkage)
    if worst is None or worst[0] >= np.radians(POOR):
        return "All checks passed."
    return (
        f"All checks passed; the transmission angle is not one of them: it falls to {degrees(worst[0])} at "
        f"{worst[1]}, below {POOR:g}°."
    )


def machine_sections(
    machine: Machine, steady: SteadyState | None = None, string: Any = None
) -> dict[str, Any]:
    """Sections of every report about a machine; `steady`: motion at whose speed the drawing moves; `string`:
    that of its rod string.
    """
    drawn = scene(machine, steady, string)
    return {
        "source": machine.source or "",
        "scenes": {} if drawn is None else {"mechanism": drawn},
        "sketch": None if drawn is None else _sketch(machine, steady, string),
        "groups": grouped(machine_parts(machine)),
        "assumptions": list(Study(machine).showing("assumptions")),
        "file": in_own_units(machine),
    }


def _sketch(machine: Machine, steady: SteadyState | None, string: Any) -> Callable[[], Figure]:

    def drawn() -> Figure:
        from linkwright.app.report.sketch import sketch_figure

        moving = moving_scene(machine, steady, string=string)
        assert moving is not None
        return sketch_figure(moving)

    return drawn


def knife_scene(study: Study) -> dict[str, Any] | None:
    """Data of the moving view of a topper from above; None without one."""
    own = [
        analysis.scene
        for analysis in ANALYSES
        if analysis.scene is not None and analysis.applies(study.machine)
    ]
    return next((dict(scene) for one in own if (scene := one.shown(study))), None)
