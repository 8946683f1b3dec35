"""One published value beside a computed one: the deviation, and a verdict in words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

# Up to this deviation a value counts as reproduced: papers print three to five digits.
REPRODUCED = 1e-3

# Up to this deviation a value is near enough to be told by its deviation alone.
NEAR = 0.05


@dataclass(frozen=True)
class Cell:
    """A published and a computed value.

    Attributes
    ----------
    published : float
        As printed, in SI.
    computed : float or None
        None where a way of computing has no such value.
    because : str
        Why it differs, if it does.
    given : bool
        Whether the computation takes the published value, so that agreement says nothing.
    """

    published: float
    computed: float | None
    because: str
    given: bool = False

    @property
    def deviation(self) -> float | None:
        """Computed over published, less one [–]."""
        return None if self.computed is None else self.computed / self.published - 1

    @property
    def kind(self) -> str:
        """``"reproduced"``, ``"near"``, ``"far"``, or ``"none"`` where there is nothing to compare."""
        if self.deviation is None or self.given:
            return "none"
        off = abs(self.deviation)
        return "reproduced" if off <= REPRODUCED else "near" if off <= NEAR else "far"

    @property
    def verdict(self) -> str:
        """In words."""
        if self.deviation is None:
            return f"no value: {self.because}"
        if self.given:
            return "taken from the paper"
        if self.kind == "reproduced":
            return "reproduced"
        if self.kind == "near":
            # Up to the next tenth of a percent, but not for the sake of rounding.
            return f"within {math.ceil(1e3 * abs(self.deviation) - 1e-6) / 10:.1f} %"
        return f"not reproduced because {self.because}"

    def to_dict(self) -> dict[str, Any]:
        """Its entries, ready for JSON."""
        return {
            "published": self.published,
            "computed": self.computed,
            "deviation_percent": None if self.deviation is None else 100 * self.deviation,
            "verdict": self.verdict,
        }
