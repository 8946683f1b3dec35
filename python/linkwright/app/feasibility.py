"""What a machine can be seen to be unable to do without solving for its motion: the cheap part of a study.

Each check is the function that the study itself calls, or decides as that does at a part of its places, so
what is a finding here is one there, and the other way round. What takes solving, such as steady motion,
forces and vibration under torques, is left to the study.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.app.subjects import ANALYSES
from linkwright.kernel.findings import Findings
from linkwright.machine.machine import Machine


@dataclass(frozen=True)
class Feasibility:
    """What was examined, and what was found."""

    looked_at: tuple[str, ...]  # what was examined, in words
    findings: tuple[str, ...]  # what the machine cannot do, in sentences
    warnings: tuple[str, ...]  # what its designer should know although it moves, in sentences


def feasibility(machine: Machine) -> Feasibility:
    """Look at all of a machine that can be judged without solving for its motion; with the findings."""
    findings = Findings()
    looked = [
        text
        for analysis in ANALYSES
        if analysis.check is not None and analysis.applies(machine)
        for text in analysis.check(machine, findings)
    ]
    return Feasibility(tuple(looked), findings.findings, findings.warnings)
