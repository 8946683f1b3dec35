"""The analyses of a rod string: its predicted motion, and the diagnosis of a measured card."""

from __future__ import annotations

from linkwright.machine.analysis import Analysis, of
from linkwright.machine.machine import Machine


def _has_card(machine: Machine) -> bool:
    return machine.rod_string is not None and machine.rod_string.card is not None


def _is_predicted(machine: Machine) -> bool:
    """Whether there is a string; one with a measured card needs no motion of its own."""
    from linkwright.rods.check import no_motion

    return machine.rod_string is not None and not (_has_card(machine) and no_motion(machine))


STRING = Analysis(
    name="rod_string",
    words="Rod string",
    lane="fast",
    function=of("rods.prediction:rod_string"),
    applies=_is_predicted,
    obstacle=of("rods.check:no_motion"),
    findings=of("rods.warnings:string_findings", "rod_string"),
    warnings=of("rods.warnings:string_warnings", "machine.rod_string", "rod_string"),
    tangents=of("rods.gradient:string_tangents"),
    check=of("rods.check:check_string"),
    summary=of("rods.check:string_summary"),
    tables=of("rods.tables:string_tables", "rod_string"),
    figures=of("rods.figures:string_figures", "machine.rod_string", "rod_string"),
    headline=of("rods.tables:string_headline", "rod_string"),
    assumptions=of("rods.check:string_assumptions", "machine.rod_string"),
)

CARD = Analysis(
    name="card_diagnosis",
    words="Measured card",
    function=of("rods.diagnosis:card_diagnosis"),
    applies=_has_card,
    findings=of("rods.warnings:card_findings", "card_diagnosis"),
    warnings=of("rods.warnings:diagnosis_warnings", "machine.rod_string", "card_diagnosis"),
    tables=of("rods.tables:diagnosis_tables", "card_diagnosis"),
    figures=of("rods.figures:diagnosis_figures", "machine.rod_string", "card_diagnosis", "?rod_string"),
    headline=of("rods.tables:diagnosis_headline", "card_diagnosis"),
)
