"""The studio's drawing in a notebook: one anywidget (extra `notebook`), of the modules of the studio's page.

The page's modules are put together into one, since a widget is one module: what they import from one another
stands above, and each name stands for one thing.
"""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from linkwright.kernel.errors import FindingError, InputError
from linkwright.kernel.extras import require
from linkwright.kernel.public import public
from linkwright.machine.machine import Machine
from linkwright.studio.analyses import fast
from linkwright.studio.language import page_texts
from linkwright.studio.wire import packed

_STATIC = Path(__file__).with_name("static")

# Modules of the page that the drawing is made of, each after those that it imports, and what moves them.
_MODULES = ("timeline", "frame", "ink", "painter", "centres", "arrows", "wire")
_DRAWING = Path(__file__).with_name("notebook") / "drawing.js"

_IMPORT = re.compile(r"^import .*? from \"[^\"]*\";\n", re.MULTILINE)
_EXPORT = re.compile(r"^export (?!default)", re.MULTILINE)

# A look of the page, and a colour of it.
_LOOK = re.compile(r"^:root(?:\[data-look=\"(\w+)\"\])? \{(.*?)^\}", re.MULTILINE | re.DOTALL)
_COLOUR = re.compile(r"--([\w-]+): (#\w+)")

LAYERS = ("velocities", "accelerations", "forces", "centres")
# Height of the drawing on the page [px], and the smallest that shows anything.
_HEIGHT, _LEAST = 380, 80


@public
def widget(
    machine: Machine, *, layers: Sequence[str] = (), height: int = _HEIGHT, language: str = "en"
) -> Any:
    """The drawing of a machine in motion, for a notebook.

    Parameters
    ----------
    machine : Machine
        With a mechanism that moves.
    layers : sequence of str
        What is drawn besides: ``"velocities"``, ``"accelerations"``, ``"forces"``, ``"centres"``.
    height : int
        Of the drawing [px].
    language : str
        Of what the drawing says, ``"en"`` or ``"uk"``.

    Returns
    -------
    anywidget.AnyWidget
        With the traits ``angle``, of the crank [rad], ``playing``, ``layers`` and ``height``, which can be
        set and observed. Its attribute ``machine`` can be set to another machine.

    Raises
    ------
    InputError
        Without anywidget, or with a layer that does not exist.
    FindingError
        Nothing of the machine moves as a linkage.

    Examples
    --------
    >>> import linkwright as lw
    >>> drawing = lw.widget(lw.read("roller_two_carts"), layers=("velocities",))
    >>> drawing.angle
    0.0
    """
    if unknown := [layer for layer in layers if layer not in LAYERS]:
        raise InputError(f'layers: found "{unknown[0]}", expected some of {", ".join(LAYERS)}')
    if height < _LEAST:
        raise InputError(f"height: found {height}, expected {_LEAST} pixels or more")
    texts: dict[str, Any] = {"texts": {}, "decimal": "."} if language == "en" else page_texts(language)
    words = {"drawing": "Drawing of {}, to scale", "angle": "Crank angle", "play": "Play", "pause": "Pause"}
    said = {key: texts["texts"].get(text, text).replace("{}", machine.name) for key, text in words.items()}
    return _widget_class()(
        machine=machine,
        layers=list(layers),
        height=height,
        words=said | {"decimal": texts["decimal"]},
        looks=_looks(),
    )


@cache
def _widget_class() -> Any:
    """The class of the widget: anywidget is loaded when one is asked for."""
    require("anywidget", "notebook", "a widget needs anywidget")
    from anywidget import AnyWidget
    from traitlets import Bool, Bytes, Dict, Float, Int, List, Unicode

    class MachineWidget(AnyWidget):
        _esm = module()
        scene = Bytes().tag(sync=True)
        angle = Float(0.0).tag(sync=True)
        playing = Bool(False).tag(sync=True)
        layers = List(Unicode()).tag(sync=True)
        height = Int(_HEIGHT).tag(sync=True)
        words = Dict().tag(sync=True)
        looks = Dict().tag(sync=True)

        def __init__(self, machine: Machine, **traits: Any) -> None:
            self._machine = machine
            super().__init__(scene=_scene(machine), **traits)

        def _repr_mimebundle_(self, **wanted: Any) -> tuple[dict[str, Any], dict[str, Any]]:
            """The widget, and its pose as a picture for pages that nothing moves on."""
            shown, about = super()._repr_mimebundle_(**wanted) or ({}, {})
            return {**shown, "image/png": _still(self._machine)}, about

        @property
        def machine(self) -> Machine:
            return self._machine

        @machine.setter
        def machine(self, machine: Machine) -> None:
            self.scene = _scene(machine)
            self._machine = machine

    return MachineWidget


def _scene(machine: Machine) -> bytes:
    answers = fast(machine, held=False)
    if answers.scene is None:
        reasons = "; ".join(answers.findings) or "nothing of it moves as a linkage"
        raise FindingError(f"{machine.name}: no drawing: {reasons}")
    return packed(0, answers.scene)


def _still(machine: Machine) -> str:
    from linkwright.app.curves import bytes_of

    return b64encode(bytes_of(machine.plot(), ".png")).decode()


@cache
def module() -> str:
    """The modules of the drawing as one."""
    paths = [*(_STATIC / f"{name}.js" for name in _MODULES), _DRAWING]
    texts = [_IMPORT.sub("", path.read_text(encoding="utf-8")) for path in paths]
    return "\n".join(_EXPORT.sub("", text) for text in texts)


@cache
def _looks() -> dict[str, dict[str, str]]:
    sheet = (_STATIC / "studio.css").read_text(encoding="utf-8")
    return {look[1] or "light": dict(_COLOUR.findall(look[2])) for look in _LOOK.finditer(sheet)}
