"""What can be seen of a pumping unit and of its rotator at once."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.findings import Findings
from linkwright.machine.machine import Machine
from linkwright.pumping.rod_rotator import rod_rotator
from linkwright.pumping.unit import pumping_unit
from linkwright.pumping.warnings import unit_findings


def check_unit(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the crank rotates fully, and ratings are not exceeded."""
    unit = findings.of(pumping_unit, machine)
    findings.add(unit_findings(unit) if unit is not None else ())
    yield "pumping unit: full rotation of its crank, ratings of gearbox and structure"


def check_rotator(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether the lever does as its regime asks."""
    findings.of(rod_rotator, machine)
    yield "rod rotator: lengths, and motion in its regime"
