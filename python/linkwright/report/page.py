"""The page of a report, by Jinja2, from `templates/report.html`."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import linkwright
from linkwright.analysis.result import finite
from linkwright.analysis.study import Study
from linkwright.files.output import write_file
from linkwright.files.write import dumps
from linkwright.machine import InductionMotor
from linkwright.public import public
from linkwright.report.assumptions import assumptions
from linkwright.report.figures import figures
from linkwright.report.formulas import PAPER_1, Formula, formulas
from linkwright.report.inline import inline_svg
from linkwright.report.machine_table import Part, machine_parts
from linkwright.report.quantities import number
from linkwright.report.scene import scene
from linkwright.report.scene_topper import topper_scene
from linkwright.report.tables import tables
from linkwright.report.topper_words import PAPER_5, topper_formulas, topper_headline

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

_FOLDER = Path(__file__).with_name("templates")

# A symbol of one letter and its index.
_INDEX = re.compile(r"\b([^\W\d_])_(\w+(?:,\w+)?)")


@public
def write_report(study: Study, path: str | os.PathLike[str], *, command: str = "") -> None:
    """Write the report of a study to a file.

    Parameters
    ----------
    study : Study
        The study.
    path : path
        The HTML file; replaced if it exists.
    command : str
        Command line that made the study, for the section on how to repeat it.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    write_file(path, report_html(study, command=command))


def report_html(study: Study, *, command: str = "") -> str:
    """The report of a study as one HTML page that needs nothing else: style, figures and script are in it.

    Parameters
    ----------
    study : Study
        The study.
    command : str
        Command line that made the study.

    Returns
    -------
    str
        The page; the same study gives the same page.
    """
    return environment().get_template("report.html").render(_context(study, command))


def _context(study: Study, command: str) -> dict[str, Any]:
    """All that the template asks for."""
    drawn = [(each, picture(each.figure, each.name, each.title)) for each in figures(study)]
    return {
        "study": study,
        "machine": study.machine,
        "headline": list(_headline(study)),
        "groups": grouped(machine_parts(study.machine)),
        "tables": tables(study),
        "figures": drawn,
        "scene": _embedded(scene(study)),
        "topper_scene": _embedded(topper_scene(study)),
        "formulas": _formulas(study),
        "paper": _papers(study),
        "assumptions": assumptions(study),
        "file": dumps(study.machine),
        "command": command or "linkwright run machine.toml --out report",
        "version": linkwright.__version__,
    }


def picture(figure: Any, name: str, title: str) -> Markup:
    """A figure as markup inside the page."""
    from markupsafe import Markup

    return Markup(inline_svg(figure, name, title))


def _embedded(scene: dict[str, Any] | None) -> str:
    """Data for a script element: nothing in it may end that element."""
    return json.dumps(finite(scene), separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def grouped(parts: list[Part]) -> list[tuple[str, list[Part]]]:
    """Parts of a machine with the heading of each group."""
    return [(group, list(found)) for group, found in groupby(parts, key=lambda part: part.group)]


def _formulas(study: Study) -> list[Formula]:
    cut = topper_formulas(study)
    if study.machine.is_topper_alone:
        return cut
    motor = study.machine.drive.motor if study.machine.drive else None
    is_induction = isinstance(motor, InductionMotor)
    steps = study.step_method is not None
    return [*cut, *formulas(induction=is_induction, motor=motor is not None, steps=steps)]


def _papers(study: Study) -> str:
    """The papers that formulas are from."""
    if study.machine.topper is None:
        return PAPER_1
    return PAPER_5 if study.machine.is_topper_alone else f"{PAPER_1}. {PAPER_5}"


def _headline(study: Study) -> Iterator[tuple[str, str, str]]:
    """The few numbers that one looks for first: symbol and word, value, unit."""
    yield from topper_headline(study)
    steady, run_up, reduced = study.steady_state, study.run_up, study.reduction
    if steady is not None:
        yield "mean speed", number(steady.speed_mean_time, 4), "rad/s"
        yield "unevenness δ", number(steady.unevenness, 4), ""
        yield "dynamism H", number(steady.dynamism, 4), ""
        # Without losses the mean is zero but for rounding.
        power = steady.power_motor_mean if steady.power_motor_mean > 1e-9 * steady.power_motor_max else 0.0
        yield "mean motor power", number(power, 4), "W"
    if run_up is not None:
        yield "run-up time", number(run_up.time, 4), "s"
    if steady is None and reduced is not None:
        yield "least reduced inertia", number(reduced.inertia_min, 4), "kg m²"
        yield "greatest reduced inertia", number(reduced.inertia_max, 4), "kg m²"
        yield "mean resisting torque", number(reduced.torque_load_mean, 4), "N m"


def environment() -> Environment:
    """Jinja2 with the templates and filters of all pages."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["index"] = _with_index
    environment.filters["safe_math"] = _as_markup
    environment.globals["include_raw"] = _raw
    return environment


def _with_index(text: str) -> Markup:
    """A text in which the index of each symbol is lowered."""
    from markupsafe import Markup, escape

    return Markup(_INDEX.sub(r"\1<sub>\2</sub>", str(escape(text))))


def _as_markup(text: str) -> Markup:
    """Text that is markup already: formulas of this package, never words of a file."""
    from markupsafe import Markup

    return Markup(text)


def _raw(name: str) -> Markup:
    """A file of the templates, as it is."""
    return _as_markup((_FOLDER / name).read_text(encoding="utf-8"))
