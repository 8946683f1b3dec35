"""Files of the machine on the page: its report, its motion, one pose.

| kind | what |
| --- | --- |
| ``html``, ``pdf`` | the report of the study, or of torsional vibration, in the language of the page |
| ``gif``, ``mp4`` | the motion |
| ``dxf``, ``svg``, ``png`` | the pose at the crank angle of the drawing |
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.errors import FindingError, InputError
from linkwright.machine.machine import Machine
from linkwright.machine.read import loads
from linkwright.studio.language import in_units

if TYPE_CHECKING:
    from linkwright.kernel.page.content import Content

Body = dict[str, Any]

# What is in a file, and what is said with it.
File = tuple[str | bytes, str]

# Seconds that a moving picture may last.
_SHORTEST, _LONGEST = 0.1, 60.0


def export(machine: Machine, asked: Body, code: str) -> Body:
    """The file that was asked for, ``data`` in base64; an `InputError` if it cannot be made.

    `asked`: ``kind``; of a report ``of``, ``"study"`` or ``"torsion"``, ``sections``, ``units``, ``company``,
    a path, and ``variants``, each with ``name``, ``text`` and ``path``; of a motion ``seconds``; of a pose
    ``angle`` [rad].
    ``words`` say what a reader would not expect of the file.
    """
    kind = str(asked.get("kind"))
    run = _KINDS.get(kind)
    if run is None:
        raise InputError(f"{kind!r}: expected one of {', '.join(_KINDS)}")
    data, words = run(machine, asked, code)
    raw = data.encode("utf-8") if isinstance(data, str) else data
    return {"of": "export", "kind": kind, "data": base64.b64encode(raw).decode("ascii"), "words": words}


# -- reports ----------------------------------------------------------------------


def _html(machine: Machine, asked: Body, code: str) -> File:
    from linkwright.kernel.page.html import html

    with in_units(asked.get("units") or ()):
        return html(_report(machine, asked, code)), ""


def _pdf(machine: Machine, asked: Body, code: str) -> File:
    from linkwright.kernel.page.typeset import pdf

    with in_units(asked.get("units") or ()):
        return pdf(_report(machine, asked, code)), ""


def _report(machine: Machine, asked: Body, code: str) -> Content:
    """What the report says, with variants beside the machine if there are any."""
    from linkwright.app.report.answered import compared
    from linkwright.app.report.company import read_heading
    from linkwright.kernel.page.content import SECTIONS, Heading
    from linkwright.kernel.page.translation import in_language
    from linkwright.kernel.reader.language import language

    content_of, command = _contents(asked), str(asked.get("command", ""))
    everything = content_of(machine, command)
    sections = [name for name in SECTIONS if name in (asked.get("sections") or SECTIONS)]
    content = everything if len(sections) == len(SECTIONS) else everything.only(sections)
    variants = {
        str(one["name"]): content_of(loads(str(one["text"]), path=str(one["path"])), "")
        for one in asked.get("variants") or ()
    }
    if variants:
        content = compared(content, everything, variants)
    head = read_heading(str(asked["company"])) if asked.get("company") else Heading()
    return in_language(replace(content, heading=head), language(code, "language"))


def _contents(asked: Body) -> Callable[[Machine, str], Content]:
    if asked.get("of") == "torsion":

        def torsion(machine: Machine, command: str) -> Content:
            from linkwright.torsion.page import torsion_content
            from linkwright.torsion.study import torsion_study

            return torsion_content(torsion_study(machine), command)

        return torsion

    def study_content(machine: Machine, command: str) -> Content:
        from linkwright.app.report.page import content
        from linkwright.app.study import study

        return content(study(machine), command)

    return study_content


# -- drawings ---------------------------------------------------------------------


def _scene(machine: Machine, angle: float | None = None) -> tuple[Body, str]:
    """The moving drawing along the steady motion, and why it is at constant speed where there is none."""
    from linkwright.app.report.scene import moving_scene
    from linkwright.drive.steady_state import steady_state
    from linkwright.drive.study import has_motor

    steady, words = None, ""
    try:
        steady = steady_state(machine) if machine.has_crank and has_motor(machine) else None
    except FindingError as error:
        words = f"Drawn at constant speed: {error}"
    scene = moving_scene(machine, steady, angle)
    if scene is None:
        raise InputError("nothing to draw: the machine has no mechanism that moves")
    return scene, words


def _moving(machine: Machine, asked: Body, _code: str) -> File:
    from linkwright.app.report.moving import gif, mp4

    seconds = float(asked.get("seconds", 4.0))
    if not _SHORTEST <= seconds <= _LONGEST:
        raise InputError(f"found {seconds:g} s, expected {_SHORTEST:g} to {_LONGEST:g} s")
    scene, words = _scene(machine)
    return (gif if asked["kind"] == "gif" else mp4)(scene, seconds), words


def _pose(machine: Machine, asked: Body, _code: str) -> File:
    from linkwright.app.curves import bytes_of
    from linkwright.app.report.moving import dxf
    from linkwright.app.report.sketch import sketch_figure

    angle = float(asked.get("angle", 0.0))
    scene, _ = _scene(machine, angle)
    place = float(np.argmin(np.abs(scene["angles"] - angle))) / (len(scene["angles"]) - 1)
    if asked["kind"] == "dxf":
        return dxf(scene, place), ""
    return bytes_of(sketch_figure(scene, place), f".{asked['kind']}"), ""


_KINDS: Mapping[str, Callable[[Machine, Body, str], File]] = {
    "html": _html,
    "pdf": _pdf,
    "gif": _moving,
    "mp4": _moving,
    "dxf": _pose,
    "svg": _pose,
    "png": _pose,
}
