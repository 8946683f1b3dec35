"""What the report of a study says, and its page."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.app.report.assumptions import assumptions
from linkwright.app.report.figures import figures
from linkwright.app.report.scene import moving_scene, scene
from linkwright.app.report.tables import DETAIL_TABLES, MOTION_TABLES, tables
from linkwright.app.study import Study
from linkwright.drive.model.motor import InductionMotor
from linkwright.kernel.files.output import write_file
from linkwright.kernel.page.angle_zero import zero_shown
from linkwright.kernel.page.content import Content, Few, Heading, Part
from linkwright.kernel.page.formulas import PAPER_1, Formula, formulas
from linkwright.kernel.page.html import html
from linkwright.kernel.page.numbers import degrees, number, parted, zero_words
from linkwright.kernel.page.out_units import with_units_of
from linkwright.kernel.page.sentences import sentences
from linkwright.kernel.public import public
from linkwright.machine.table import grouped, machine_parts
from linkwright.machine.write import dumps

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
    from linkwright.kernel.page.language import in_language
    from linkwright.kernel.page.language import language as of_code

    to = of_code(language, "language")
    report = in_language(replace(content(study, command), heading=heading or Heading()), to)
    if Path(path).suffix.lower() != ".pdf":
        write_file(path, html(report))
        return
    from linkwright.kernel.page.typeset import pdf

    write_file(path, pdf(report))


def report_html(study: Study, *, command: str = "") -> str:
    """The report of a study as one HTML page that contains its style, figures and script, in the units of the
    machine; `command`: the command line that made the study.
    """
    return html(content(study, command))


def content(study: Study, command: str = "") -> Content:
    """What the report of a study says, in the units of the reader, else of the machine file."""
    with with_units_of(study.machine.units):
        return _content(study, command)


def _content(study: Study, command: str) -> Content:
    machine = study.machine
    drawn, listed = list(figures(study)), tables(study)
    moving = [figure for figure in drawn if figure.name.startswith(_MOTION_FIGURES)]
    motion = [table for table in listed if table.name in MOTION_TABLES]
    details = [table for table in listed if table.name in DETAIL_TABLES]
    results = [table for table in listed if table not in motion and table not in details]
    parts = (
        Part("Motion", motion, moving),
        Part("Results", results, [figure for figure in drawn if figure not in moving]),
        Part("Details", details),
    )
    scenes = {"topper": knife_scene(study), "mechanism": scene(study)}
    return Content(
        title=machine.name,
        about=machine.description or "",
        lead=zero_words(zero_shown()),
        source=machine.source or "",
        findings=sentences(study.findings),
        warnings=sentences(study.warnings),
        headline=[Few(*line) for line in _headline(study)],
        scenes={name: scene for name, scene in scenes.items() if scene is not None},
        sketch=_sketch(study) if scenes["mechanism"] is not None else None,
        parts=[part for part in parts if part.tables or part.figures],
        formulas=_formulas(study),
        papers=_papers(study),
        groups=grouped(machine_parts(machine)),
        assumptions=assumptions(study),
        file=dumps(machine),
        command=command or "linkwright run machine.toml --out report",
    )


def _sketch(study: Study) -> Callable[[], Figure]:
    """Draws the mechanism at one instant."""

    def drawn() -> Figure:
        from linkwright.app.report.sketch import sketch_figure

        moving = moving_scene(study.machine, study.steady_state)
        assert moving is not None
        return sketch_figure(moving)

    return drawn


# Figures of the part on motion begin so.
_MOTION_FIGURES = ("motion_", "transmission", "coupler_curves")


def knife_scene(study: Study) -> dict[str, Any] | None:
    """Data of the moving view of a topper from above; None without one."""
    if study.knife is None:
        return None
    from linkwright.topping.scene import topper_scene

    return topper_scene(study.machine, *study.knife)


def _topper_formulas(study: Study) -> list[Formula]:
    if study.machine.topper is None:
        return []
    from linkwright.topping.tables.words import topper_formulas

    return topper_formulas(study.machine.topper, study.topper)


def _turning_formulas(study: Study) -> list[Formula]:
    if study.turning_moment is None:
        return []
    from linkwright.turning.tables import turning_formulas

    return turning_formulas(study.turning_moment)


def _turning_headline(study: Study) -> Iterator[tuple[str, str, str]]:
    if study.turning_moment is not None:
        from linkwright.turning.tables import turning_headline

        yield from turning_headline(study.turning_moment)


def _topper_headline(study: Study) -> Iterator[tuple[str, str, str]]:
    if study.knife is None:
        return
    from linkwright.topping.tables.words import topper_headline

    yield from topper_headline(*study.knife)


# Outputs among the few numbers.
_OUTPUTS = 2


def _motion_headline(study: Study) -> Iterator[tuple[str, str, str]]:
    """Strokes, swings and time ratios, and the worst transmission angle."""
    if study.linkage is None:
        return
    moving = [element for element in study.linkage.elements if element.turns is None]
    for moved in (
        [*{element.output: element for element in moving[::-1]}.values()][::-1]
        if len(moving) <= _OUTPUTS
        else ()
    ):
        if moved.stroke is not None:
            yield f"stroke of {moved.output}", *parted(moved.stroke, "m", 4)
        elif moved.swing is not None:
            yield f"swing of {moved.output}", degrees(moved.swing), ""
        if moved.time_ratio is not None:
            yield f"time ratio of {moved.output}", number(moved.time_ratio, 4), ""
    worst = [element.transmission_angle_worst for element in study.linkage.elements]
    known = [angle for angle in worst if angle is not None]
    if known:
        yield "worst transmission angle", degrees(min(known)), ""


def _formulas(study: Study) -> list[Formula]:
    cut = [*_turning_formulas(study), *_topper_formulas(study)]
    if study.machine.is_topper_alone or study.machine.is_diagram_alone:
        return cut
    motor = study.machine.drive.motor if study.machine.drive else None
    is_induction = isinstance(motor, InductionMotor)
    steps = study.step_method is not None
    return [*cut, *formulas(induction=is_induction, motor=motor is not None, steps=steps)]


def _papers(study: Study) -> str:
    """The papers that formulas are from."""
    if study.machine.is_diagram_alone:
        return ""
    if study.machine.topper is None:
        return PAPER_1
    from linkwright.topping.tables.words import PAPER_5

    return PAPER_5 if study.machine.is_topper_alone else f"{PAPER_1}. {PAPER_5}"


def _headline(study: Study) -> Iterator[tuple[str, str, str]]:
    """The few numbers that one looks for first: symbol and word, value, unit."""
    yield from _turning_headline(study)
    yield from _topper_headline(study)
    yield from _motion_headline(study)
    steady, run_up, reduced = study.steady_state, study.run_up, study.reduction
    if steady is not None:
        yield "mean speed", *parted(steady.speed_mean_time, "rad/s", 4)
        yield "speed fluctuation δ", number(steady.unevenness, 4), ""
        yield "dynamic factor H", number(steady.dynamism, 4), ""
        # Without losses the mean is zero but for rounding.
        power = steady.power_motor_mean if steady.power_motor_mean > 1e-9 * steady.power_motor_max else 0.0
        yield "mean motor power", *parted(power, "W", 4)
    if run_up is not None:
        yield "run-up time", *parted(run_up.time, "s", 4)
    if steady is None and reduced is not None:
        yield "minimum reduced inertia", *parted(reduced.inertia_min, "kg m²", 4)
        yield "maximum reduced inertia", *parted(reduced.inertia_max, "kg m²", 4)
        yield "mean load torque", *parted(reduced.torque_load_mean, "N m", 4)
