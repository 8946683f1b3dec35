"""One check of a machine against a limit: value, limit, and whether it is kept.

A check that cannot be made says why, and does not pass.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Record

# What tables and sentences call the checks whose names are not words already.
_WORDS = {
    "starting_torque_worst": "starting torque, worst angle",
    "run_up": "run-up time",
    "torque_rms": "root mean square torque",
    "torque_peak": "peak torque",
    "gearbox_torque_rms": "root mean square torque of the gearbox",
    "gearbox_torque_peak": "peak torque of the gearbox",
    "gearbox_speed": "input speed of the gearbox",
    "resistor_power_mean": "mean power of the brake resistor",
    "resistor_power_peak": "peak power of the brake resistor",
}


@dataclass(frozen=True)
class Check(Record):
    """One check."""

    name: Annotated[str, About("Of the check.")]
    value: Annotated[float | None, About("The value, in ``unit``.")]
    limit: Annotated[float | None, About("The limit or requirement, in ``unit``.")]
    unit: Annotated[str, About("Unit of both.")]
    passed: Annotated[bool | None, About("None if it is not determined.")]
    at_most: Annotated[bool, About("Whether the value must be at most the limit, not at least.")] = False
    note: Annotated[str, About("Why it is not determined, what it rests on, or how it failed.")] = ""

    @property
    def utilisation(self) -> Annotated[float | None, Label("utilisation", "", "")]:
        """Share of what is allowed that is used; above 1 the check fails."""
        if self.value is None or self.limit is None or not self.value > 0 or not self.limit > 0:
            return None
        return self.value / self.limit if self.at_most else self.limit / self.value

    @property
    def title(self) -> str:
        """What it compares."""
        return title_of(self.name)

    @property
    def words(self) -> str:
        """The check in one line."""
        title = self.title
        if self.value is None or self.limit is None:
            return f"{title}: {self.note}"
        wanted = "at most" if self.at_most else "at least"
        limit = f"{wanted} {_shown(self.limit, self.unit)}"
        text = f"{title} {_shown(self.value, self.unit)}, {limit}{self._factor()}"
        return f"{text} ({self.note})" if self.note else text

    @property
    def brief(self) -> str:
        """How it fails, in a few words."""
        title = self.title
        if self.passed is None:
            return f"{title} not known"
        return f"{title}{self._factor().lstrip(':')}" if self._factor() else f"{title} fails"

    def _factor(self) -> str:
        """By how much a check fails."""
        share = self.utilisation
        if self.passed is not False or share is None:
            return ""
        return (
            f": {100 * share:.3g} % of the limit"
            if self.at_most
            else f": {100 / share:.3g} % of the requirement"
        )

    def to_dict(self) -> dict[str, Any]:
        """Its entries, ready for JSON."""
        names = ("name", "value", "limit", "unit", "passed", "utilisation", "note")
        return {name: getattr(self, name) for name in names}


def _shown(value: float, unit: str) -> str:
    """A number of four digits with its unit; powers in kW, as motors are rated."""
    value, unit = (value / 1e3, "kW") if unit == "W" else (value, unit)
    digits = max(0, 3 - math.floor(math.log10(abs(value)))) if value else 0
    return f"{value:.{min(digits, 3)}f} {unit}".rstrip()


def title_of(name: str) -> str:
    """What a check compares, by its name."""
    return _WORDS.get(name, name.replace("_", " "))
