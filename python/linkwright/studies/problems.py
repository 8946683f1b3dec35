"""Values of a variable as quantities of its entry, and what is wrong in them, by the key in the study."""

from __future__ import annotations

from linkwright.kernel.errors import MachineError
from linkwright.kernel.units.kinds import Kind
from linkwright.machine import size_limits


def problem(name: str, key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    """What is wrong at a key of a variable."""
    return size_limits.problem(f"variables.{name}.{key}", found, expected, remedy)


def parsed(name: str, key: str, value: object, kind: Kind) -> float:
    """A value as the quantity of its entry."""
    return size_limits.parsed(f"variables.{name}.{key}", value, kind)
