"""Where a linkage stops, turns back or can branch: limits of crank rotation, change points, dead centres.

At a limit a radicand passes zero and the crank can go no farther. At a change point a radicand touches zero,
a double root: both assemblies meet, and the motion goes on. At a reversal an output stands still; driven by
that output, the mechanism is at a dead point there.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from linkwright.linkages.closure import Closure, limiter_at
from linkwright.machine.program.compiled import Compiled

if TYPE_CHECKING:
    from linkwright.linkages.sweep import LinkageSweep

LIMIT = "limit of crank rotation"
PASSED = "change point passed"
NOT_PASSED = "change point not passed"
REVERSAL = "dead centre of the output"


class DeadPoint(NamedTuple):
    """One of them.

    Attributes
    ----------
    angle : float
        Crank angle, within one revolution, or within the longer period or range [rad].
    element : str
        Name of the dyad, or of the link or slide that turns back.
    kind : str
        ``"limit of crank rotation"``, ``"change point passed"``, ``"change point not passed"`` (both links in
        line, their rates not determined) or ``"dead centre of the output"``.
    multiplicity : int
        Of the zero: 1 where a sign changes, 2 where a radicand touches zero.
    """

    angle: float
    element: str
    kind: str
    multiplicity: int


def dead_points(compiled: Compiled, swept: LinkageSweep, where: Closure) -> list[DeadPoint]:
    """The dead points of a linkage."""
    found = [*_of_closure(compiled, where), *_passed(swept), *_reversals(swept)]
    return sorted(found)


def _of_closure(compiled: Compiled, where: Closure) -> Iterator[DeadPoint]:
    """Limits, or a change point that is not passed."""
    if where.change_point is not None:
        yield DeadPoint(where.change_point, where.element, NOT_PASSED, 2)
    elif not where.turns_fully:
        for end in (end for limits in where.ranges for end in limits):
            at = end if where.turns is None else end % (2 * np.pi * where.turns)
            yield DeadPoint(at, limiter_at(compiled, end), LIMIT, 1)


def _passed(swept: LinkageSweep) -> Iterator[DeadPoint]:
    for dyad in swept.dyads:
        for angle in dyad.change_points:
            yield DeadPoint(angle, dyad.name, PASSED, 2)


def _reversals(swept: LinkageSweep) -> Iterator[DeadPoint]:
    for k, output in enumerate(swept.outputs):
        for angle in swept.reversals(k):
            yield DeadPoint(swept.cycle.named(angle), output.name, REVERSAL, 1)
