"""The core's cam: one contact of a follower with a cam, its law and its dimensions.

Everything is in the contact's own frame: the follower stands on the x axis, and the cam is seen as it stands
where its programme begins. `crates/linkwright-cam/src/lib.rs` has the formulas.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.cam.laws.motion_law import MotionLaw, Side
from linkwright.cam.model.follower import Sizes
from linkwright.kernel.arrays import Floats
from linkwright.kernel.numerics.tangent import Tangent, lifted, primal, variables_of
from linkwright.machine.program.numbers import core_law

CamOffset = _core.CamOffset
CamSearch = _core.CamSearch


class Extreme(NamedTuple):
    """A maximum or minimum value."""

    angle: float  # cam angle from the start of the programme [rad]
    value: float  # how much


class Passes(NamedTuple):
    """Cam angles where a row passes a level, (k,) [rad], and the sign of row less level behind each, (k,)."""

    angle: Floats
    sign: Floats


@dataclass(frozen=True, slots=True)
class Shape:
    """A contact over one revolution."""

    # (n,): cam angles from the start of the programme [rad], increasing; each joint of the law stands twice.
    angle: Floats
    piece: NDArray[np.uint32]  # (n,): piece of the law
    rows: dict[str, Floats]  # (n,): by the names of `linkwright._core.CamShape`
    # `greatest`, `least`: of the pressure angle, of the bend, and of the place along a flat face (``along``).
    greatest: dict[str, Extreme]
    least: dict[str, Extreme]
    passes: tuple[Passes, ...]  # for each level asked for


@dataclass(frozen=True, slots=True)
class CamKernel:
    """One contact in the core's terms."""

    law: MotionLaw  # lift over the cam angle from 0 to 2π [m or rad]
    sizes: Sizes
    is_oscillating: bool  # whether the follower turns about a pivot
    is_roller: bool  # whether it is a roller or an edge; else a flat face
    is_opposite: bool  # whether the cam turns against the crank
    is_left: bool  # whether the follower stands on the left
    core: _core.Cam = field(init=False, repr=False, compare=False)  # made of the law and the follower
    size: _core.CamDimensions = field(init=False, repr=False, compare=False)  # made of the sizes

    def __post_init__(self) -> None:
        """Make the core's cam and its dimensions."""
        core = _core.Cam(
            core_law(self.law.primal),
            is_oscillating=self.is_oscillating,
            is_roller=self.is_roller,
            sense=-1.0 if self.is_opposite else 1.0,
            side=1.0 if self.is_left else -1.0,
        )
        object.__setattr__(self, "core", core)
        size = {name: float(primal(value)) for name, value in self.sizes._asdict().items()}
        object.__setattr__(self, "size", _core.CamDimensions(**size))

    def __reduce__(self) -> tuple[type[CamKernel], tuple[Any, ...]]:
        """Pickled and copied without the core's parts, which are made anew."""
        follower = (self.is_oscillating, self.is_roller, self.is_opposite, self.is_left)
        return CamKernel, (self.law, self.sizes, *follower)

    def with_sizes(self, sizes: Sizes) -> CamKernel:
        """The same with other dimensions."""
        return replace(self, sizes=sizes)

    def shape(self, n: int, levels: Sequence[tuple[str, float]] = ()) -> Shape:
        """The contact at about n angles per revolution; see `Shape`."""
        shape = self.core.shape(self.size, n, list(levels))
        greatest, least = (
            {name: Extreme(extreme.angle, extreme.value) for name, extreme in extremes.items()}
            for extremes in (shape.greatest, shape.least)
        )
        passes = tuple(Passes(row.angle, row.sign) for row in shape.passes)
        return Shape(shape.angle, shape.piece, shape.rows, greatest, least, passes)

    def rows(self, angle: ArrayLike, *, before: bool = False) -> dict[str, Floats]:
        """Rows at angles of the programme; at a joint those after it, or ``before``."""
        rows = self.core.rows(self.size, _floats(primal(angle)), before)
        return rows if self._variables(angle) is None else self._along(rows, angle, before)

    def _variables(self, angle: Any) -> int | None:
        """By how many variables rows at angles have derivatives."""
        return variables_of((*self.sizes, angle)) or self.law.variables

    def _along(self, rows: dict[str, Floats], angle: Any, before: bool) -> dict[str, Any]:
        n = self._variables(angle) or 0
        sizes = np.stack([lifted(size, n).d for size in self.sizes])
        angles = lifted(angle, n).reshape(-1)
        side: Side = "before" if before else "after"
        lift = [lifted(self.law.at(angles.value, order, side), n).d for order in range(4)]
        along = self.core.rows_along(
            self.size, _floats(angles.value), before, sizes.ravel(), np.ravel(lift), np.ravel(angles.d)
        )
        return {name: Tangent(row, along[name].reshape(-1, n)) for name, row in rows.items()}

    def curve(self, angle: ArrayLike, away: float, *, before: bool = False) -> _core.CamOffset:
        """A curve ``away`` from the pitch one [m] at cam angles; see `_core.CamOffset`."""
        return self.core.curve(self.size, _floats(angle), before, away)

    def search(self, sizes: Sizes, lift: ArrayLike, per_turn: int) -> _core.CamSearch:
        """Largest tan γ, minimum soundness, bends of many cams; ``lift``: factor on it, one or one a cam."""
        columns = {name: _floats(column) for name, column in sizes._asdict().items()}
        columns["lift"] = _floats(lift)
        return self.core.search(**columns, n=max(map(len, columns.values())), per_turn=per_turn)


def _floats(values: ArrayLike) -> Floats:
    return np.ascontiguousarray(np.atleast_1d(np.asarray(values, dtype=float)))


def cam_kernel(
    law: MotionLaw,
    sizes: Sizes,
    *,
    oscillating: bool,
    roller: bool,
    opposite: bool = False,
    left: bool = True,
) -> CamKernel:
    """A contact. ``law``: lift over the cam angle from 0 to 2π [m or rad]."""
    return CamKernel(law, sizes, oscillating, roller, opposite, left)


def crossings(points: Floats) -> _core.CamCrossings:
    """Where a closed polygon (n, 2) crosses itself."""
    x, y = np.ascontiguousarray(points.T)
    return _core.cam_crossings(x, y)
