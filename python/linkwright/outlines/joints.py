"""Whether the joints of a drawn plate are as far apart as those of its link."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.findings import Findings
from linkwright.kernel.reader.numbers import quantity
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine

# Relative difference that a drawing may have by rounding.
_ALIKE = 1e-3


def compare_joints(known: Results, findings: Findings) -> None:
    """Warnings about plates whose drawing is of another length than the link."""
    findings.warn(_differences(known.machine))


def check_plates(machine: Machine, findings: Findings) -> Iterator[str]:
    """The same without computing anything else."""
    findings.warn(_differences(machine))
    yield "plates: joints of the drawings against the links"


def has_plates(machine: Machine) -> bool:
    """Whether a body is cut from a plate."""
    return any(body.plate is not None for body in machine.bodies.values())


def _differences(machine: Machine) -> Iterator[str]:
    links = machine.linkage.links()
    for name, body in machine.bodies.items():
        link = links.get(body.on or name)
        drawn = None if body.plate is None else body.plate.distance
        if drawn is None or link is None or not link.length:
            continue
        if abs(drawn - link.length) > _ALIKE * link.length:
            yield (
                f"The joints of the plate {name} are {quantity(drawn, 'm')} apart in its drawing; the link "
                f"is {quantity(float(link.length), 'm')} long: correct the drawing, or the joints that "
                "the file gives"
            )
