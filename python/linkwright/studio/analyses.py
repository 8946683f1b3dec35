"""What can be computed of a machine, which data are missing, and how to add them.

Fast analyses follow every change at once; slow ones run beside them, in a process of their own.

| analysis | runs | needs |
| --- | --- | --- |
| motion | at once | a mechanism that closes somewhere |
| steady motion | at once | a motor, and a mechanism that closes over the whole revolution |
| forces | at once | bodies or loads, steady motion |
| rod string | at once | a motion of the polished rod |
| servo axes, DC bus, timing | at once | axes, or several cams, and a cycle time |
| study | beside | – ; everything that `linkwright run` computes |
| torsion | beside | a train, or a driveline with an elastic part |
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from linkwright.app.study import Study, study
from linkwright.app.subjects import ANALYSES
from linkwright.axes.analyses import AXIS, BUS, TIMING
from linkwright.axes.axis import ServoAxis
from linkwright.drive.obstacles import design_speed, no_mass
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.drive.study import has_motor
from linkwright.driveline.analyses import ELASTIC
from linkwright.kernel.errors import LinkwrightError
from linkwright.kernel.figure.style import CaptionedFigure
from linkwright.kernel.findings import Findings
from linkwright.kernel.page.content import Content, Few, Part
from linkwright.kernel.page.translation import in_language
from linkwright.kernel.reader.language import ENGLISH, Language
from linkwright.kernel.reader.sentences import sentence
from linkwright.kernel.result import Result
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.motion import Motion
from linkwright.machine.analysis import Analysis, Results
from linkwright.machine.machine import Machine
from linkwright.machine.table import grouped, machine_parts
from linkwright.rods.analyses import STRING
from linkwright.rods.check import no_motion
from linkwright.studio.drawing import drawing
from linkwright.studio.shown import cards_plot, shown
from linkwright.studio.timing import timing_view
from linkwright.studio.views import knife_view, train_view

if TYPE_CHECKING:
    from linkwright.torsion.study import TorsionStudy

# Intervals of the revolution of steady motion that the drawing and its plots follow, and of the forces while
# a slider is held: no line shows more.
_INTERVALS = 360
_EVERY = 3

# Accuracy of a rod string, and while a slider is held.
_FINE, _COARSE = 1e-3, 0.05

# Lanes in the order of their chips.
_ORDER = ("fast", "study", "torsion")


def chips(machine: Machine) -> list[dict[str, Any]]:
    """The analyses of a machine, and what stands in their way.

    Of each ``name``, ``word``, ``lane`` (``fast``, ``study`` or ``torsion``) and, where it is not ready,
    ``obstacle`` with ``mend`` and ``entries``.
    """
    listed = [analysis for analysis in ANALYSES if analysis.words and analysis.applies(machine)]
    return [
        {"name": analysis.name, "word": analysis.words, "lane": analysis.lane, **_obstacle(analysis, machine)}
        for analysis in sorted(listed, key=lambda analysis: _ORDER.index(analysis.lane))
    ]


def _obstacle(analysis: Analysis, machine: Machine) -> dict[str, Any]:
    obstacle = analysis.obstacle(machine) if analysis.obstacle is not None else None
    if obstacle is None:
        return {}
    return {"obstacle": obstacle.words, "mend": obstacle.remedy, "entries": dict(obstacle.entries or {})}


@dataclass(frozen=True)
class Answers:
    """What one lane has found."""

    results: list[dict[str, Any]]  # of `shown`
    # In sentences.
    findings: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    scene: dict[str, Any] | None = None  # of `drawing`, of the fast lane
    # Diagrams that are no curves, as SVG: `name`, `title`, `caption`, `svg`.
    figures: tuple[dict[str, str], ...] = ()
    views: tuple[dict[str, Any], ...] = ()  # pictures beside the drawing, of `views`
    tables: tuple[dict[str, Any], ...] = ()  # of the report: `name`, `title`, `heads`, `rows`
    headline: tuple[Few, ...] = ()  # of a train or driveline: word, value, unit of what one looks for first

    def body(self) -> dict[str, Any]:
        """All of it for a message."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def fast(machine: Machine, *, held: bool) -> Answers:
    """What follows every change: scene, steady motion, forces; at fewer angles while something is `held`."""
    findings = Findings()
    train = findings.of(train_view, machine) if machine.twists else None
    views = [] if train is None else [train]
    string = None
    if STRING.applies(machine) and no_motion(machine) is None:
        string = findings.of(STRING.analyse, machine, accuracy=_COARSE if held else _FINE)
    if not machine.has_crank:
        scene = None if string is None else drawing(machine, None, None, string)
        known = [] if string is None else [_cards(machine, string), shown(STRING.name, string)]
        return Answers(known, findings.findings, findings.warnings, scene, views=tuple(views))
    # Under a rod string the drive has another steady motion.
    steady = None if string is None else string.drive
    if steady is None and has_motor(machine):
        steady = findings.of(steady_state, machine, n=_INTERVALS)
    acting = None
    if no_mass(machine) is None:
        if steady is not None:
            acting = findings.beside_of(_forces, machine, steady, _EVERY if held else 1)
        elif design_speed(machine):
            acting = findings.beside_of(forces, machine, n=_INTERVALS, contributions=False)
    scene = findings.of(drawing, machine, steady, acting, string)
    results: dict[str, Result | None] = {"steady_state": steady, "forces": acting, STRING.name: string}
    known = [shown(name, result) for name, result in results.items() if result is not None]
    if string is not None:
        known.insert(0, _cards(machine, string))
    if scene is not None:
        known.append({"name": "transfer", "scalars": [], "plots": scene.pop("transfer")})
    axes = Results(machine)
    for analysis in (AXIS, BUS, TIMING):
        if analysis.applies(machine):
            axes.add(analysis, findings)
    # The timing diagram is a picture of its own.
    known += [shown(name, axes[name]) for name in axes if not name.startswith(TIMING.name)]
    duties = {name: result for name, result in axes.items() if isinstance(result, ServoAxis)}
    known += [shown(f"{name}.motor", axis.motor) for name, axis in duties.items()]
    if tracks := axes.each(TIMING.name):
        views.append(timing_view(machine, tracks))
    return Answers(known, findings.findings, findings.warnings, scene, views=tuple(views))


def _cards(machine: Machine, string: Any) -> dict[str, Any]:
    return {"name": "cards", "scalars": [], "plots": [cards_plot("cards", machine.rod_string, string)]}


def _forces(machine: Machine, steady: SteadyState, every: int) -> Any:
    some = slice(None, None, every)
    curves = (steady.crank_angle, steady.speed, steady.acceleration, steady.time)
    return forces(
        machine, Motion(*(np.ascontiguousarray(curve[some]) for curve in curves)), contributions=False
    )


def found(machine: Machine, lane: str) -> Any:
    """What the lane ``"study"`` or ``"torsion"`` computes: the same in every language and unit."""
    return _LANES[lane].found(machine)


def said(results: Any, lane: str, to: Language = ENGLISH) -> Answers:
    """What a lane beside has found, with the figures that are more than curves, in a language."""
    return _LANES[lane].said(results, to)


def lanes(machine: Machine) -> list[str]:
    """The lanes beside that a machine has, in their order."""
    is_studied = not machine.is_train_alone or machine.has_mounted_mechanisms
    return [*(["study"] if is_studied else []), *(["torsion"] if machine.twists else [])]


def _study(results: Study, to: Language) -> Answers:
    known = [shown(name, result) for name, result in _new_results(results)]
    if results.card_diagnosis is not None:
        string = results.machine.rod_string
        plot = cards_plot("measured_cards", string, results.card_diagnosis, results.rod_string)
        known.append({"name": "measured_cards", "scalars": [], "plots": [plot]})
    drawn = [figure for figure in results.figures() if figure.name not in _CURVES]
    knife = knife_view(results)
    # What the page does not find among scalars: peak torques, a row a shaft.
    lead = Content(title="", headline=[Few(*line) for line in results.headline([ELASTIC])])
    return Answers(
        known,
        results.findings,
        results.warnings,
        figures=tuple(_svg(one, to) for one in drawn),
        views=() if knife is None else (knife,),
        tables=tuple(_tables(Content(title="", parts=[Part("", results.tables())]), results.machine, to)),
        headline=tuple(in_language(lead, to).headline),
    )


# Figures of the report that plots of the studio show in more detail.
_CURVES = {"speed", "torque", "time", "reduction", "run_up"}


def _new_results(results: Study) -> Iterator[tuple[str, Result]]:
    known = ("steady_state", "forces", STRING.name, AXIS.name, BUS.name, TIMING.name)
    yield from ((name, result) for name, result in results.items() if name.partition(".")[0] not in known)


def _torsion_study(machine: Machine) -> TorsionStudy:
    from linkwright.torsion.study import torsion_study

    return torsion_study(machine)


def _torsion(results: TorsionStudy, to: Language) -> Answers:
    from linkwright.torsion.figures.captions import torsion_figures
    from linkwright.torsion.page import torsion_content

    parts = {field.name: getattr(results, field.name) for field in fields(results)}
    known = [shown(name, part) for name, part in parts.items() if isinstance(part, Result)]
    content = torsion_content(results)
    return Answers(
        known,
        figures=tuple(_svg(one, to) for one in torsion_figures(results)),
        tables=tuple(_tables(content, results.machine, to)),
        headline=tuple(in_language(content, to).headline),
    )


def _tables(content: Content, machine: Machine, to: Language) -> Iterator[dict[str, Any]]:
    """Tables of a report in a language; names of the machine's parts stay."""
    bare = Content(
        title="",
        parts=[Part("", part.tables) for part in content.parts],
        groups=grouped(machine_parts(machine)),
    )
    for part in in_language(bare, to).parts:
        for table in part.tables:
            yield {"name": table.name, "title": table.title, "heads": table.heads, "rows": table.rows}


def _svg(drawn: CaptionedFigure, to: Language) -> dict[str, str]:
    from linkwright.kernel.figure.svg import svg
    from linkwright.kernel.reader.axes import translated_figure

    text = svg(drawn.figure if to is ENGLISH else translated_figure(drawn.figure, to), transparent=True)
    return {"name": drawn.name, "title": drawn.title, "caption": sentence(drawn.caption), "svg": text}


class _Lane(NamedTuple):
    """A lane beside: what computes, and what says in a language what was found."""

    found: Callable[[Machine], Any]
    said: Callable[[Any, Language], Answers]


_LANES = {"study": _Lane(study, _study), "torsion": _Lane(_torsion_study, _torsion)}


def failed(error: LinkwrightError) -> Answers:
    """The answer of a lane that an error ended."""
    return Answers([], (str(error),))
