"""The linkage in the study of a machine: what is made of it, examined, and listed."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.kernel.errors import AssemblyError
from linkwright.kernel.findings import Findings
from linkwright.linkages.cycle import Linkage, linkage
from linkwright.linkages.idle_parts import idle_parts
from linkwright.linkages.law_jumps import law_warnings, shaft_of_laws
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.linkages.model.mobility import mobility
from linkwright.linkages.model.topology import TABLES
from linkwright.linkages.warnings import linkage_warnings
from linkwright.linkages.whole_cycle import over_whole_cycle
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine
from linkwright.machine.program.compiled import compile_machine


def made_linkage(known: Results, findings: Findings) -> Linkage | None:
    """Extreme positions, with what stands in the way of a cycle; None where no element has any."""
    machine = known.machine
    moved = findings.of(linkage, machine)
    if moved is None:
        return None
    findings.add(idle_parts(machine))
    findings.warn((*linkage_warnings(moved), *law_warnings(machine), *shaft_of_laws(machine)))
    if moved.closure.turns_fully and machine.drive is not None and machine.drive.motor is not None:
        findings.of(over_whole_cycle, compile_machine(machine))
    return moved if _has_outputs(machine, moved) else None


def _has_outputs(machine: Machine, moved: Linkage) -> bool:
    own = machine.linkage
    laws = any(crank.follows() is not None or crank.law is not None for crank in own.cranks.values())
    return bool(moved.elements or own.linear_drivers or laws)


def mechanism_summary(machine: Machine) -> Iterator[tuple[str, str]]:
    """Names of the elements, kind by kind, and the mobility."""
    # A cam is listed as such, not as the driver that it is in the complete mechanism.
    cams, mechanism = machine.mechanism.cams, _whole(machine)
    known = {table: [name for name in getattr(mechanism, table) if name not in cams] for table in TABLES}
    known["cams"] = list(cams)
    yield from ((table.replace("_", " "), ", ".join(names)) for table, names in known.items())
    yield "mobility", str(mobility(mechanism))


def _whole(machine: Machine) -> Mechanism:
    """The whole mechanism; without a rotator that has no lengths, which is a finding."""
    try:
        return machine.linkage
    except AssemblyError:
        # silent: the study and the check tell of lengths that no rotator has
        return machine.with_entries({"rod_rotator": None}).linkage
