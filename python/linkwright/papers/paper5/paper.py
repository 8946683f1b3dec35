"""Paper 5 computed anew: the working length of the knife of a topper.

The paper prints formulas, ranges of the speeds and a range of the length, but neither the angle of the knife
nor cut height and offset of its figure 3. What is chosen for them here stands in ``paper5.toml``; the result
is judged for all of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.papers.paper5.conclusions import conclusions
from linkwright.papers.paper5.head import head_difference
from linkwright.papers.paper5.rows import rows_of
from linkwright.papers.paper5.short import ShortChecks, short_checks
from linkwright.papers.paper5.step import StepChecks, step_checks
from linkwright.papers.paper5.surface import Surface, surfaces
from linkwright.papers.paper5.verdict import ClaimVerdict, claim_verdict
from linkwright.papers.published import printed_values
from linkwright.papers.row import Row


@dataclass(frozen=True)
class Paper5:
    """Paper 5, published against computed.

    Attributes
    ----------
    published : dict
        What is printed, and what is chosen.
    head : float
        Discs of the printed diameter against the cap that they fill [–].
    step : StepChecks
        From (4) to (5).
    short : ShortChecks
        The exact length over those of the paper.
    surfaces : tuple of Surface
        Figure 3.
    verdict : ClaimVerdict
        On the result.
    rows : tuple of Row
        Every formula and range with its verdict.
    """

    published: dict[str, Any]
    head: float
    step: StepChecks
    short: ShortChecks
    surfaces: tuple[Surface, ...]
    verdict: ClaimVerdict
    rows: tuple[Row, ...] = ()

    @property
    def number(self) -> int:
        """Of the paper."""
        return int(self.published["number"])

    @property
    def title(self) -> str:
        """Of the paper, in English."""
        return str(self.published["title"])

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return {
            "chosen": self.published["chosen"],
            "step": self.step.to_dict(),
            "exact_over_published": vars(self.short) | {"least_at": list(self.short.least_at)},
            "figure3": [each.to_dict() for each in self.surfaces],
            "verdict": self.verdict.to_dict(),
            "rows": [vars(row) for row in self.rows],
            "conclusions": conclusions(self),
        }


def paper5() -> Paper5:
    """Compute paper 5 anew.

    Returns
    -------
    Paper5
        Published and computed values with verdicts.

    References
    ----------
    .. [1] Paper 5, (1) to (10), figure 3 and the result.
    """
    data = printed_values(5)
    chosen, verdict = data["chosen"], claim_verdict(data)
    angle, shown = float(np.radians(chosen["edge_angle"])), surfaces(data)
    found = Paper5(
        data,
        head_difference(chosen["root_diameters"][1]),
        step_checks(np.radians(data["verdict"]["angles"]), verdict.claim.ratios[1]),
        short_checks(verdict.claim, angle, verdict.shares),
        shown,
        verdict,
    )
    return replace(found, rows=rows_of(found))
