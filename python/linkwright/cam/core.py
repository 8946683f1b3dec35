"""The core's cam: one contact of a follower with a cam, its law and its dimensions.

Everything is in the contact's own frame: the follower stands on the x axis, and the cam is seen as it stands
where its programme begins. `crates/linkwright-core/src/cam/mod.rs` has the formulas.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright import _core
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.model.follower import Sizes
from linkwright.machine.program.numbers import core_law

Floats = NDArray[np.float64]

# Rows of the core in its order; the first twelve numbers of each angle.
ROWS = (
    *("lift", "lift_d1", "lift_d2", "lift_d3"),
    *("pitch_x", "pitch_y", "normal_x", "normal_y"),
    *("pressure_angle", "bend", "soundness", "along"),
)

# What extremes are given of, maximum and minimum of each; the last only under a flat face.
_EXTREMES = ("pressure_angle", "bend", "along")


class Extreme(NamedTuple):
    """A maximum or minimum value.

    Attributes
    ----------
    angle : float
        Cam angle from the start of the programme [rad].
    value : float
        How much.
    """

    angle: float
    value: float


@dataclass(frozen=True, slots=True)
class Shape:
    """A contact over one revolution."""

    # (n,): cam angles from the start of the programme [rad], increasing; each joint of the law stands twice.
    angle: Floats
    piece: NDArray[np.uint32]  # (n,): piece of the law
    rows: dict[str, Floats]  # (n,): by the names of `ROWS`
    # greatest, least: of the pressure angle, of the bend, and of the place along a flat face (``along``).
    greatest: dict[str, Extreme]
    least: dict[str, Extreme]
    # (k, 2): for each level asked for: angles, and +1 where the row is above the level from there on, −1
    # where below.
    passes: tuple[Floats, ...]


@dataclass(frozen=True, slots=True)
class CamKernel:
    """One contact in the core's terms."""

    law: MotionLaw  # lift over the cam angle from 0 to 2π [m or rad]
    kind: int  # of the follower, as the core counts them
    # Whether it is the opposite follower, −1 or 1, and stands on the left, 1 or −1.
    signs: tuple[float, float]
    size: Floats  # (6,): dimensions in the order of `linkwright.cam.model.follower.Sizes`
    is_roller: bool  # whether it is a roller or an edge; else a flat face
    core: _core.Cam = field(init=False, repr=False, compare=False)  # made of law, kind and signs

    def __post_init__(self) -> None:
        """Make the core's cam."""
        object.__setattr__(self, "core", _core.Cam(core_law(self.law), self.kind, *self.signs))

    def __reduce__(self) -> tuple[type[CamKernel], tuple[Any, ...]]:
        """Pickled and copied without the core's cam, which is made anew."""
        return CamKernel, (self.law, self.kind, self.signs, self.size, self.is_roller)

    def with_sizes(self, sizes: Sizes) -> CamKernel:
        """The same with other dimensions."""
        return replace(self, size=np.array(sizes, dtype=float))

    def shape(self, n: int, levels: Sequence[tuple[str, float]] = ()) -> Shape:
        """The contact at about n angles per revolution; see `Shape`."""
        wanted = [(ROWS.index(row), level) for row, level in levels]
        shape = self.core.shape(self.size, n, wanted)
        found = [Extreme(*pair) for pair in shape.extremes]
        names = _EXTREMES[: len(found) // 2]
        greatest, least = (
            dict(zip(names, found[::2], strict=True)),
            dict(zip(names, found[1::2], strict=True)),
        )
        rows = dict(zip(ROWS, shape.rows, strict=True))
        return Shape(shape.angle, shape.piece, rows, greatest, least, tuple(shape.passes))

    def rows(self, angle: ArrayLike, *, before: bool = False) -> dict[str, Floats]:
        """All rows at cam angles from the start of the programme; at a joint after it, or ``before``."""
        return dict(zip(ROWS, self.core.rows(self.size, _floats(angle), before), strict=True))

    def curve(self, angle: ArrayLike, away: float, *, before: bool = False) -> Floats:
        """Place and two derivatives [m, m/rad, m/rad²] of a curve ``away`` from the pitch one, (3, 2, n)."""
        return self.core.curve(self.size, _floats(angle), before, away).reshape(3, 2, -1)

    def search(self, columns: Sequence[ArrayLike], per_turn: int) -> Floats:
        """Largest tan γ, minimum soundness, maximum and minimum bend of many cams, (n, 4).

        ``columns`` are the six dimensions and the factor on the lift, each a number or one for every cam.
        """
        listed = [_floats(column) for column in columns]
        return self.core.search(listed, max(map(len, listed)), per_turn)


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
    kind = 2 * oscillating + (not roller)
    signs = (-1.0 if opposite else 1.0, 1.0 if left else -1.0)
    return CamKernel(law, kind, signs, np.array(sizes, dtype=float), roller)


def crossings(points: Floats) -> Floats:
    """Where a closed polygon (n, 2) crosses itself: side and share along it of both, and place, (k, 4)."""
    x, y = np.ascontiguousarray(points.T)
    return _core.cam_crossings(x, y)
