"""What can be seen of the knife of a topper at once, and what it consists of."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

from linkwright.kernel.findings import Findings
from linkwright.kernel.reader.numbers import quantity
from linkwright.machine.machine import Machine
from linkwright.topping.coverage import require_advance
from linkwright.topping.edge import edges_of
from linkwright.topping.model.topper import Topper
from linkwright.topping.roots import draw_roots, head_diameter
from linkwright.topping.warnings import knife_look


def check_knife(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the knife advances, over its field too, and is long enough."""
    described = machine.topper
    if described is None:
        return
    looked = findings.of(lambda: tuple(knife_look(machine, described)))
    findings.add(looked or ())
    if looked is not None and described.field is not None:
        findings.of(lambda: require_advance(edges_of(machine, described), draw_roots(described)))
    yield "knife of the topper: advance of the edge, and its length for every head"


def topper_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """The head that is cut, the edge, and how the knife moves."""
    cut = machine.topper
    if cut is None:
        return
    d = float(head_diameter(cut.root_diameter, cut.cut_height))
    beside = f", up to {_mm(cut.offset)} beside the row" if cut.offset else ", on the row"
    across = f"{_mm(d)} across: root {_mm(cut.root_diameter)}, cut {_mm(cut.cut_height)} below its top"
    yield "head", across + beside
    speed = quantity(cut.forward_speed, "m/s")
    yield "edge", f"{_mm(cut.edge_length)} at {degrees(cut.edge_angle):.4g}°, {speed} along the row"
    yield "knife", _knife(cut)
    yield "field", _field(cut)


def _knife(cut: Topper) -> str:
    motion = cut.motion
    if motion.kind == "member":
        return f"moved by {motion.of}"
    if not cut.knife_speed:
        return "at rest"
    stroke = f", stroke {_mm(motion.stroke)}" if motion.stroke else ", one direction over a head"
    word = "harmonic" if motion.kind == "harmonic" else "constant speed"
    return f"{word}{stroke}, {quantity(cut.knife_speed, 'm/s')} across the row in the mean"


def _field(cut: Topper) -> str:
    if cut.field is None:
        return ""
    if cut.field.kind == "random":
        return f"{cut.field.roots} random roots in {cut.field.rows} rows"
    return f"{len(cut.field.root_diameter)} measured roots, each in {cut.field.phases} phases"


def _mm(value: float) -> str:
    return quantity(value, "m", usual="mm")
