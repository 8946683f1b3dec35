"""What is left open of a program until its mechanism has been placed once; `settle` fills it in."""

from __future__ import annotations

from typing import Any, NamedTuple


class Side(NamedTuple):
    """The sign of a dyad at a joint is that of the place where the joint is assembled."""

    joint: str
    slot: int
    pin: int
    # Point at the other end of a dyad RRR; a guide as its link, none for the frame, and direction in it.
    pivot: int | None = None
    guide: tuple[int | None, Any] | None = None


class Continuous(NamedTuple):
    """The continuous angle of a link."""

    name: str
    link: int
    winding: int
    centre: int
    # The turn is the one in which the angle at the start is nearest to this.
    near: Any = 0.0


class Foldable(NamedTuple):
    """A dyad RRR or RRP that may have change points."""

    name: str
    element: int
    sign: int


class Solved(NamedTuple):
    """A group, whose motion has to be followed once."""

    names: tuple[str, ...]
    element: int
    inverse_turns: int


Pending = Side | Continuous | Foldable | Solved
