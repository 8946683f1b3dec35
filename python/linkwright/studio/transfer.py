"""Transfer functions of the outputs as plots of the page: position and its first two derivatives by the crank
angle, at the angles of the drawing.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

from linkwright.kernel.arrays import Floats
from linkwright.linkages.kinematics import Kinematics
from linkwright.linkages.sweep import Output, outputs_of
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine

# Order of the derivative → its words, and what stands behind the symbol.
_WORDS = ("position", "first transfer function", "second transfer function")
_MARKS = ("", "′", "″")

# Kind of an output → its words, symbol, and the unit of each derivative.
_KINDS: dict[Literal["stroke", "swing"], tuple[str, str, tuple[str, str, str]]] = {
    "stroke": ("sliders", "s", ("m", "m/rad", "m/rad²")),
    "swing": ("links", "ψ", ("rad", "", "1/rad")),
}


def transfer_functions(machine: Machine, motion: Kinematics) -> list[dict[str, Any]]:
    """Plots as of `shown`, those of sliders before those of links; none where nothing is moved."""
    outputs = outputs_of(compile_machine(machine), machine.linkage)
    return [plot for kind in _KINDS for plot in _plots(kind, outputs, motion)]


def _plots(
    kind: Literal["stroke", "swing"], outputs: list[Output], motion: Kinematics
) -> Iterator[dict[str, Any]]:
    """Position and derivatives of the outputs of one kind."""
    names = [output.name for output in outputs if output.kind == kind and _curves(motion, output.name)]
    words, symbol, units = _KINDS[kind]
    for order, (word, mark, unit) in enumerate(zip(_WORDS, _MARKS, units, strict=True)):
        if names:
            yield {
                "key": f"transfer.{kind}{order}",
                "title": f"{word} of {words}",
                "unit": unit,
                "x": {"name": "crank_angle", "word": "crank angle", "symbol": "φ", "unit": "rad"}
                | {"values": motion.angles},
                "curves": [
                    {"name": name, "word": name, "symbol": f"{symbol}{mark} {name}", "own": True}
                    | {"unit": unit, "values": _curves(motion, name)[order]}
                    for name in names
                ],
            }


def _curves(motion: Kinematics, name: str) -> tuple[Floats, ...]:
    """Position and derivatives of a slide or a link; none if it is neither."""
    if name in motion.slides:
        slide = motion.slides[name]
        return slide.position, slide.d1, slide.d2
    if name in motion.links:
        link = motion.links[name]
        return link.angle, link.d1, link.d2
    return ()
