"""Contacts that can be lost: a follower that only a spring keeps on its cam, a cable.

Results of a motion are those of a machine that stays in contact. The forces along it say whether it does.
"""

from __future__ import annotations

from linkwright.kernel.findings import Findings
from linkwright.kinetostatics.collect import KEEPS, TIGHTENS
from linkwright.kinetostatics.forces import forces
from linkwright.kinetostatics.motion import has_speed
from linkwright.machine.machine import Machine


def contacts(machine: Machine) -> list[tuple[str, str]]:
    """Kind and name of what can only press, and of what can only pull."""
    cams = machine.mechanism.cams.items()
    followers = [("cam", name) for name, cam in cams if cam.closure == "spring"]
    return [*followers, *(("cable", name) for name in machine.mechanism.cables)]


def lost_contacts(machine: Machine) -> tuple[str, ...]:
    """Contacts that a machine loses in its steady motion or at its design speed, in sentences."""
    if not has_speed(machine) or not contacts(machine) or not (machine.bodies or machine.all_loads):
        return ()
    collected = Findings()
    collected.of(forces, machine)
    return tuple(text for text in collected.findings if KEEPS in text or TIGHTENS in text)
