"""What sizing says of a machine besides its motor: contacts that it loses, limits that are not judged."""

from __future__ import annotations

from linkwright.drive.cautions import unjudged_limits
from linkwright.kinetostatics.contact import lost_contacts
from linkwright.machine.machine import Machine


def lost(machine: Machine | None) -> tuple[str, ...]:
    """Contacts that the machine loses with its motor, in sentences."""
    return () if machine is None else lost_contacts(machine)


def unjudged(machine: Machine) -> tuple[str, ...]:
    """Limits of its shafts that are not judged, in sentences."""
    return tuple(unjudged_limits(machine))
