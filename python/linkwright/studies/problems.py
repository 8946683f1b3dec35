"""Values of a variable as quantities of its entry, and what is wrong in them, by the key in the study."""

from __future__ import annotations

from linkwright.kernel.errors import MachineError, Problem, UnitError
from linkwright.kernel.units import Kind, parse


def problem(name: str, key: str, found: str, expected: str, remedy: str = "") -> MachineError:
    """What is wrong at a key of a variable."""
    return MachineError([Problem(f"variables.{name}.{key}", found, expected, remedy)])


def parsed(name: str, key: str, value: object, kind: Kind) -> float:
    """A value as the quantity of its entry."""
    try:
        return parse(value, kind)
    except UnitError as error:
        wrong = error.problem
        raise problem(name, key, wrong.found, wrong.expected, wrong.remedy) from None
