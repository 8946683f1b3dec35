"""What sizing says of a machine besides its motor: contacts that it loses, limits that are not judged."""

from __future__ import annotations

from linkwright.drive.warnings import unjudged_limits
from linkwright.kinetostatics.contact import lost_contacts
from linkwright.linkages.law_jumps import drivers_with_laws
from linkwright.machine.machine import Machine


def lost(machine: Machine | None) -> tuple[str, ...]:
    """Contacts that the machine loses with its motor, in sentences."""
    return () if machine is None else lost_contacts(machine)


def unjudged(machine: Machine) -> tuple[str, ...]:
    """Which shaft is sized where drivers follow laws, and limits that are not judged, in sentences."""
    drivers = drivers_with_laws(machine)
    names, axes = ", ".join(drivers), ", ".join(f"[axes.{name}]" for name in drivers)
    law = (
        f"The sized motor drives the input shaft of the law of {names} at constant speed, with the law "
        "acting as a cam; a servo motor that generates the motion needs other torques and speeds: give it "
        f"{axes} and use linkwright axes"
    )
    return (*((law,) if names else ()), *unjudged_limits(machine))
