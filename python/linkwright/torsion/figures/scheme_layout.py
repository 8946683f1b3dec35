"""Where the parts of a train's scheme are drawn: lines of discs in rows, gears between the rows.

Discs on one line of shafts stand in a row. A gear stage leads to another row at the same place, a third one
of a disc to a side that is free. A branch for which its row has no side left leads to another row, too. What
closes a loop becomes a bridge. Shafts lead to the right from their first end if that side is free.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from linkwright.torsion.model.train import GROUND
from linkwright.torsion.modes.scheme import Connection

# Step to the side for a further connection that leaves the same disc upwards or downwards [inch].
_ASIDE = 0.32

# Room between two lines in one row [inch].
_APART = 0.3


class Span(NamedTuple):
    """A straight part in a row, from x to x; `end` is a disc or the ground."""

    part: Connection
    start: float
    stop: float
    row: int
    to_ground: bool


class Riser(NamedTuple):
    """A vertical connection at x, from the row of one disc to another row."""

    part: Connection
    disc: str
    x: float
    row: int
    to_row: int

    @property
    def side(self) -> int:
        """Side from which it enters the other row: +1 from above, −1 from below."""
        return 1 if self.to_row > self.row else -1


class Bridge(NamedTuple):
    """A part that closes a loop between two discs that are placed already; the n-th from its row."""

    part: Connection
    nth: int


@dataclass
class Layout:
    """Places of all parts."""

    # x [inch] and row of each disc; rows count downwards from the highest.
    discs: dict[str, tuple[float, int]] = field(default_factory=dict)
    # `spans`, `risers`, `bridges`: what joins them.
    spans: list[Span] = field(default_factory=list)
    risers: list[Riser] = field(default_factory=list)
    bridges: list[Bridge] = field(default_factory=list)


@dataclass
class _Line:
    """Discs and shafts in one row, connected to an earlier line."""

    x: float
    parent: int | None = None
    part: Connection | None = None
    disc: str = ""
    low: float = 0.0
    high: float = 0.0
    row: int = 0


class _Edge(NamedTuple):
    """A connection seen from one of its discs; an end at the ground has a place of its own."""

    part: Connection
    other: str


def layout(
    discs: Sequence[str], parts: Sequence[Connection], lengths: Mapping[str, float], room: float
) -> Layout:
    """Place the parts: rows downwards, x from 0; `lengths`, `room` of discs to either side [inch]."""
    return _RowSearch(discs, parts, lengths, room).run()


class _RowSearch:
    """Walks through the train, then finds rows for its lines."""

    def __init__(
        self, discs: Sequence[str], parts: Sequence[Connection], lengths: Mapping[str, float], room: float
    ) -> None:
        self.lengths, self.room = lengths, room
        self.below, self.closing = _spanning(discs, parts)
        self.weight = _weights(discs[0], self.below)
        self.lines = [_Line(0.0)]
        self.line_of = {discs[0]: 0}
        self.x = {discs[0]: 0.0}
        self.free = {discs[0]: {1, -1}}
        self.spans: list[tuple[Span, int]] = []
        # Gears that leave each disc at its own place: one upwards, one downwards.
        self.leaving: dict[str, int] = {}

    def run(self) -> Layout:
        waiting = [next(iter(self.x))]
        self._widen(waiting[0])
        while waiting:
            at = waiting.pop()
            placed = list(self._children(at))
            waiting += reversed(placed)
        self._rows()
        return self._layout()

    def _children(self, at: str) -> Iterator[str]:
        """Place the children of a disc: shafts first, the heaviest straight on; then gears."""
        edges = sorted(
            self.below.get(at, []), key=lambda edge: (_geared(edge.part), -self.weight[edge.other])
        )
        for edge in edges:
            if _geared(edge.part) and not (self.leaving.get(at, 0) > 1 and self.free[at]):
                line = self._new_line(at, edge)
                self.x[edge.other], self.free[edge.other] = self.lines[line].x, {1, -1}
                self.leaving[edge.other] = 1
            else:
                line = self._in_row(at, edge)
            self.line_of[edge.other] = line
            self._widen(edge.other)
            yield edge.other

    def _in_row(self, at: str, edge: _Edge) -> int:
        """A shaft, or third gear of a disc, to the side of its ends, to a free one, or in a new line."""
        side = 1 if edge.part.first == at else -1
        start, line = self.x[at], self.line_of[at]
        if self.free[at]:
            side = side if side in self.free[at] else -side
            self.free[at].discard(side)
        else:
            line = self._new_line(at, edge)
            start = self.lines[line].x
        stop = start + side * self.lengths[edge.part.name]
        self.x[edge.other], self.free[edge.other] = stop, {side}
        self.spans.append((Span(edge.part, start, stop, 0, GROUND in edge.part[2:4]), line))
        return line

    def _new_line(self, at: str, edge: _Edge) -> int:
        """A line that leaves a disc upwards or downwards; a third gear without a free side a little aside."""
        x = self.x[at]
        if _geared(edge.part):
            nth = self.leaving.get(at, 0)
            self.leaving[at] = nth + 1
            x += (nth // 2) * _ASIDE
        self.lines.append(_Line(x, self.line_of[at], edge.part, at, x, x))
        return len(self.lines) - 1

    def _widen(self, disc: str) -> None:
        line, x = self.lines[self.line_of[disc]], self.x[disc]
        line.low, line.high = min(line.low, x - self.room), max(line.high, x + self.room)

    def _rows(self) -> None:
        """Give each line a near row in which it overlaps no other, crossing as little as possible."""
        for n, line in enumerate(self.lines[1:], start=1):
            assert line.parent is not None
            base, others = self.lines[line.parent].row, self.lines[:n]
            near = [base + step * sign for step in range(1, n + 1) for sign in (1, -1)]
            fits = [row for row in near if not self._taken(row, line, others)]
            line.row = min(fits, key=lambda row: (self._cost(base, row, line, others), near.index(row)))

    def _cost(self, base: int, row: int, line: _Line, others: Sequence[_Line]) -> int:
        """Cost of a row: crossings first, then the distance, then one more row of the drawing."""
        rows = [other.row for other in others]
        new = max(row - max(rows), min(rows) - row, 0)
        return 4 * self._crossed(base, row, line, others) + abs(row - base) + new

    @staticmethod
    def _taken(row: int, line: _Line, others: Sequence[_Line]) -> bool:
        return any(
            other.row == row and line.low < other.high + _APART and other.low < line.high + _APART
            for other in others
        )

    def _crossed(self, base: int, row: int, line: _Line, others: Sequence[_Line]) -> int:
        between = range(min(base, row) + 1, max(base, row))
        count = sum(other.row in between and other.low < line.x < other.high for other in others)
        for other in others:
            if other.parent is not None:
                low, high = sorted((other.row, self.lines[other.parent].row))
                count += low < row < high and line.low < other.x < line.high
                # Two ways at one place, over one another.
                both = max(low, min(base, row)) < min(high, max(base, row))
                count += 3 * (both and abs(other.x - line.x) < _ASIDE / 2)
        return count

    def _layout(self) -> Layout:
        """All places, rows from 0 and x from 0."""
        top = min(line.row for line in self.lines)
        left = min(line.low for line in self.lines)
        rows = [line.row - top for line in self.lines]
        # Ends at the ground are no discs.
        discs = {
            name: (x - left, rows[self.line_of[name]])
            for name, x in self.x.items()
            if not name.startswith(_AT_GROUND)
        }
        spans = [
            span._replace(start=span.start - left, stop=span.stop - left, row=rows[line])
            for span, line in self.spans
        ]
        risers = [
            Riser(line.part, line.disc, line.x - left, rows[line.parent], rows[n])
            for n, line in enumerate(self.lines)
            if line.part is not None and line.parent is not None
        ]
        return Layout(discs, spans, risers, list(_bridges(self.closing, discs)))


def _geared(part: Connection) -> bool:
    return part.is_geared


# No name of a disc has a blank before it.
_AT_GROUND = " ground of "


def _spanning(
    discs: Sequence[str], parts: Sequence[Connection]
) -> tuple[dict[str, list[_Edge]], list[Connection]]:
    """Spanning tree, depth first so that rings become chains, and the connections that close loops."""
    about: dict[str, list[_Edge]] = {name: [] for name in discs}
    for part in parts:
        for at, other in ((part.first, part.second), (part.second, part.first)):
            if at != GROUND:
                about[at].append(_Edge(part, _AT_GROUND + part.name if other == GROUND else other))
    below: dict[str, list[_Edge]] = {}
    seen, used = {discs[0]}, set()
    stack = [(discs[0], iter(about[discs[0]]))]
    while stack:
        at, edges = stack[-1]
        for edge in edges:
            if edge.other not in seen:
                seen.add(edge.other)
                used.add(edge.part.name)
                below.setdefault(at, []).append(edge)
                stack.append((edge.other, iter(about.get(edge.other, []))))
                break
        else:
            stack.pop()
    return below, [part for part in parts if part.name not in used]


def _weights(root: str, below: Mapping[str, Sequence[_Edge]]) -> dict[str, int]:
    order = [root]
    for at in order:
        order += [edge.other for edge in below.get(at, ())]
    weight: dict[str, int] = {}
    for at in reversed(order):
        weight[at] = 1 + sum(weight[edge.other] for edge in below.get(at, ()))
    return weight


def _bridges(closing: Sequence[Connection], discs: Mapping[str, tuple[float, int]]) -> Iterator[Bridge]:
    count: dict[int, int] = {}
    for part in closing:
        row = min(discs[part.first][1], discs[part.second][1])
        yield Bridge(part, count.get(row, 0))
        count[row] = count.get(row, 0) + 1
