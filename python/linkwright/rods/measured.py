"""The measured card of a machine file, diagnosed."""

from __future__ import annotations

import numpy as np

from linkwright.kernel.errors import InputError
from linkwright.machine.machine import Machine
from linkwright.rods.card import timed_card
from linkwright.rods.diagnosis import CardDiagnosis, diagnose_card


def card_diagnosis(machine: Machine) -> CardDiagnosis:
    """Diagnosis of the measured card of a machine; an `InputError` without one."""
    entries = machine.rod_string.card if machine.rod_string is not None else None
    if entries is None:
        raise InputError(f"{machine.name} has no [rod_string.card]: expected a measured card")
    times = None if entries.time is None else np.array(entries.time)
    card = timed_card(np.array(entries.position), np.array(entries.load), times, "rod_string.card")
    return diagnose_card(
        machine,
        card.position,
        card.load,
        period=card.period if entries.period is None else entries.period,
        damping=entries.damping,
        harmonics=entries.harmonics,
    )
