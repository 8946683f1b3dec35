"""What can be seen of a pumping unit and of its rotator at once."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.findings import Findings
from linkwright.machine.machine import Machine
from linkwright.pumping.rod_rotator import rod_rotator
from linkwright.pumping.unit import PolishedRod


def check_unit(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the crank rotates fully."""
    if machine.pumping_unit is not None:
        findings.of(PolishedRod.of, machine, machine.pumping_unit)
        yield "pumping unit: full rotation of its crank"


def check_rotator(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the lever does as its regime asks."""
    findings.of(rod_rotator, machine)
    yield "rod rotator: lengths, and the motion of its regime"
