"""How large the scheme of a train is drawn, and what is written beside its parts."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from textwrap import wrap

import numpy as np

from linkwright.kernel.figure.style import NAME_LETTERS, SMALL, WIDTH, shortened
from linkwright.kernel.reader.numbers import quantity
from linkwright.torsion.figures.scheme_layout import Bridge, Layout, layout
from linkwright.torsion.model.train import GROUND
from linkwright.torsion.modes.scheme import Connection, Scheme

# What a letter and a line take [inch]: DejaVu Sans is 0.6 em wide in the mean of names and numbers.
_LETTER, LINE = 0.6 * SMALL / 72, 1.25 * SMALL / 72

# Ratios of speed nearer to one than this are those of the first disc: what is referred is then what is.
_SAME = 1e-9

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""))


@dataclass(frozen=True)
class Words:
    """Lines above and below a part."""

    # `above`, `below`: from top to bottom.
    above: tuple[str, ...]
    below: tuple[str, ...]

    @property
    def width(self) -> float:
        """Room of the longest line [inch]."""
        return max((wide(line) for line in (*self.above, *self.below)), default=0.0)


def wide(line: str) -> float:
    """Room of a line [inch]."""
    return _LETTER * len(line)


def disc_words(scheme: Scheme, n: int) -> Words:
    """Name, inertia, and where the speed is another one, the referred inertia in brackets."""
    own = quantity(scheme.inertia[n], "kg m²")
    referred = () if _same(scheme.speed[n]) else (f"({scheme.inertia_referred[n]:.4g})",)
    return Words((shortened(scheme.discs[n], NAME_LETTERS),), (own, *referred))


def connection_words(connection: Connection) -> Words:
    """Name and stiffness; the referred stiffness in brackets, and the equivalent length."""
    name = shortened(connection.name, NAME_LETTERS)
    if connection.kind == "gears":
        return Words((), (f"{name} i = {connection.ratio:.4g}",))
    if connection.kind in ("bearing", "clutch"):
        return Words((), (connection.kind,))
    if connection.stiffness is None or connection.stiffness_referred is None:
        return Words((name,), ())
    own = stiffness(connection.stiffness)
    below = (
        []
        if _same(connection.stiffness_referred / connection.stiffness)
        else [f"({stiffness(connection.stiffness_referred)})"]
    )
    if connection.kind == "mesh":
        return Words((), (f"{name} i = {connection.ratio:.4g}", own, *below))
    return Words((name, own), (*below, metres(connection.equivalent_length or 0.0)))


def stiffness(value: float) -> str:
    """A stiffness with the prefix of its size."""
    factor, prefix = next(((f, p) for f, p in _PREFIXES if abs(value) >= f), _PREFIXES[-1])
    return f"{value / factor:.4g} {prefix}N m/rad"


def metres(length: float) -> str:
    """A length with three digits, without powers of ten where it is long."""
    return f"{length:.0f} m" if length >= 1000 else quantity(length, "m", 3)


def _same(factor: float) -> bool:
    return abs(factor - 1) < _SAME


# Height of the highest and of the lowest bar to either side of the shaft, and half of a bar's width [inch].
HIGH, LOW, HALF = 0.42, 0.05, 0.045

# Between words and lines, and around the drawing [inch].
GAP, MARGIN = 0.06, 0.25

# Drawn length of a shaft over that of the middle one, at most; what is longer is drawn broken.
_BROKEN = 2.5

# A picture is not narrower than this, so that its note has room [inch].
_NARROW = 4.5

# What fits a page [inch].
_PAGE = (WIDTH, 9.0)


@dataclass(frozen=True)
class Page:
    """A scheme with its words and places, in inches."""

    scheme: Scheme  # the train
    # `discs`, `parts`: what is written beside each disc, and each connection.
    discs: dict[str, Words]
    parts: dict[str, Words]
    places: Layout  # where all is
    broken: frozenset[str]  # shafts that are drawn shorter than their compliance
    turned: bool  # whether words are written upwards

    @property
    def left(self) -> float:
        """End of the picture on the left, without its margin."""
        ways = [self.way_round(bridge) for bridge in self.places.bridges if self.is_between_rows(bridge)]
        return min([0.0, *(x - 1.5 * LINE for x in ways)])

    @property
    def width(self) -> float:
        """Of the picture."""
        ends = [x for x, _ in self.places.discs.values()]
        ends += [x for span in self.places.spans for x in (span.start, span.stop)]
        side = 2 * LINE if self.turned else max(words.width for words in self.discs.values()) + GAP
        return max(max(ends) + side + 2 * MARGIN - self.left, _NARROW)

    @property
    def oversize(self) -> float:
        """Size of the picture over that of a page."""
        return max(self.width / _PAGE[0], -self.levels()[-1][2] / _PAGE[1])

    def levels(self) -> list[tuple[float, float, float]]:
        """Height of the shafts of each row, of its upper end, and of its lower end or that of the picture."""
        rows = [row for _, row in self.places.discs.values()] + [span.row for span in self.places.spans]
        heights: list[tuple[float, float, float]] = []
        for row in range(1 + max(rows)):
            above, below = self._above(row), self._below(row)
            y = min([-above, *(heights[other][0] - self._apart(other, row) for other in range(row))])
            heights.append((y, y + above, min([y - below, *(bottom for _, _, bottom in heights)])))
        return heights

    def _apart(self, upper: int, lower: int) -> float:
        """Distance of the shafts of two rows; words that are written upwards meet in a column alone."""
        if not self.turned or any(self.row_of(bridge) == lower for bridge in self.places.bridges):
            return self._below(upper) + self._above(lower)
        meeting = (
            down + up
            for start, stop, down in self._reaches(upper, -1)
            for begin, end, up in self._reaches(lower, 1)
            if start < end and begin < stop
        )
        return max(meeting, default=0.0) + 4 * GAP

    def _reaches(self, row: int, side: int) -> list[tuple[float, float, float]]:
        """From where to where each part of a row reaches how far above (+1) or below (−1) its shafts."""
        reaches = []
        for name, (x, at) in self.places.discs.items():
            if at == row:
                lines = self.discs[name].above if side > 0 else self.discs[name].below
                reaches.append((x - LINE, x + 2 * LINE, HIGH + 2 * GAP + wide(", ".join(lines))))
        for span in self.places.spans:
            if span.row == row:
                middle = 0.5 * (span.start + span.stop)
                down = wide(in_a_row(self.parts[span.part.name])) if side < 0 else 0.0
                reaches.append((span.start, span.stop, 2 * GAP))
                reaches.append((middle - LINE, middle + LINE, 2 * GAP + down))
        for riser in self.places.risers:
            if riser.to_row == row and riser.side == side:
                height = self._above(row) if side > 0 else self._below(row)
                reaches.append((riser.x - LINE, riser.x + 2 * LINE, height))
        return reaches

    def bridge_height(self, bridge: Bridge) -> float:
        """Of a bridge above the shafts of its row."""
        return self._names(self.row_of(bridge)) + 2.2 * LINE * bridge.nth

    def row_of(self, bridge: Bridge) -> int:
        """The upper row of its two ends."""
        return min(self.places.discs[end][1] for end in (bridge.part.first, bridge.part.second))

    def is_between_rows(self, bridge: Bridge) -> bool:
        """Whether its ends are in different rows."""
        return len({self.places.discs[end][1] for end in (bridge.part.first, bridge.part.second)}) > 1

    def way_round(self, bridge: Bridge) -> float:
        """Where a bridge between two rows runs, on the left of both its ends."""
        ends = (bridge.part.first, bridge.part.second)
        return min(self.places.discs[end][0] for end in ends) - (bridge.nth + 1) * 3 * LINE

    def note(self) -> list[str]:
        """What heights and lengths mean, in lines as wide as the picture."""
        text = (
            "Height of a disc: fourth root of its referred inertia, as the diameter at equal thickness. "
            "Length of a shaft: its compliance, as far as labels permit; in metres: length of a solid steel "
            f"shaft of {1e3 * self.scheme.diameter:.4g} mm"
        )
        text += ", shortened at a break." if self.broken else "."
        if (np.abs(self.scheme.speed - 1) > 1e-9).any():
            text += f" In brackets: referred to the speed of {self.scheme.discs[0]}."
        return wrap(text, int((self.width - 2 * MARGIN) / wide("x")))

    def _in_row(self, row: int) -> list[Words]:
        return [self.discs[name] for name, (_, at) in self.places.discs.items() if at == row]

    def _names(self, row: int) -> float:
        lines = [line for words in self._in_row(row) for line in words.above]
        return HIGH + 2 * GAP + (max(map(wide, lines)) if self.turned and lines else LINE)

    def _above(self, row: int) -> float:
        bridges = sum(
            self.row_of(bridge) == row and not self.is_between_rows(bridge) for bridge in self.places.bridges
        )
        return self._names(row) + 2.2 * LINE * bridges + GAP + self._entering(row, 1)

    def _below(self, row: int) -> float:
        own = self._in_row(row)
        spans = [self.parts[span.part.name] for span in self.places.spans if span.row == row]
        if self.turned:
            values = max((wide(", ".join(words.below)) for words in own), default=0.0)
            down = max([HIGH + values, *(wide(in_a_row(words)) for words in spans)])
        else:
            down = HIGH + LINE * max((len(words.below) for words in own), default=0)
        return down + 4 * GAP + self._entering(row, -1)

    def _entering(self, row: int, side: int) -> float:
        """What the words of gears take that enter a row from above (+1) or from below (−1)."""
        entering = [riser for riser in self.places.risers if riser.to_row == row and riser.side == side]
        return max((self._beside(connection.part) for connection in entering), default=0.0)

    def _beside(self, part: Connection) -> float:
        """What the words beside gears between two rows take; shafts have theirs in a row."""
        if not part.is_geared:
            return 0.0
        words = self.parts[part.name]
        return wide(in_a_row(words)) if self.turned else LINE * len(words.below)


def page(scheme: Scheme, *, turned: bool) -> Page:
    """Lay a scheme out."""
    discs = {name: disc_words(scheme, n) for n, name in enumerate(scheme.discs)}
    parts = {part.name: connection_words(part) for part in scheme.connections}
    lengths, broken = _lengths(scheme, discs, parts, turned)
    room = 1.5 * LINE if turned else 0.5 * max(words.width for words in discs.values())
    return Page(scheme, discs, parts, layout(scheme.discs, scheme.connections, lengths, room), broken, turned)


def in_a_row(words: Words) -> str:
    """All words of a part in one line."""
    return ", ".join((*words.above, *words.below))


def _lengths(
    scheme: Scheme, discs: dict[str, Words], parts: dict[str, Words], turned: bool
) -> tuple[dict[str, float], frozenset[str]]:
    """Drawn length of each part, as its compliance where words leave room; and which parts are broken."""
    sides = _sides_turned(scheme) if turned else _sides(scheme, discs, parts)
    least = {part.name: _least(part, parts[part.name], sides, turned) for part in scheme.connections}
    rows = [part for part in scheme.connections if not part.is_geared]
    soft = dict.fromkeys(least, 0.0) | {row.name: row.equivalent_length or 0.0 for row in rows}
    known = [length for length in soft.values() if length > 0]
    if not known:
        return least, frozenset()
    middle = float(np.median([least[name] for name, length in soft.items() if length > 0]))
    scale = middle / float(np.median(known))
    drawn = {name: max(min(scale * soft[name], _BROKEN * middle), room) for name, room in least.items()}
    return drawn, frozenset(name for name in drawn if scale * soft[name] > 1.001 * drawn[name])


def _sides(scheme: Scheme, discs: dict[str, Words], parts: dict[str, Words]) -> dict[str, float]:
    """Room of a disc's words to each side: half of them, or all where a line leaves upwards or downwards."""
    ends = Counter(end for part in scheme.connections for end in (part.first, part.second))
    sides = {name: words.width * (1.0 if ends[name] > 2 else 0.5) for name, words in discs.items()}
    for part in scheme.connections:
        if part.is_geared:
            for end in (part.first, part.second):
                sides[end] = max(sides[end], discs[end].width + GAP, parts[part.name].width + 3 * GAP)
    return sides


def _sides_turned(scheme: Scheme) -> dict[str, float]:
    ends = Counter(end for part in scheme.connections for end in (part.first, part.second))
    geared = [end for part in scheme.connections if part.is_geared for end in part[2:4]]
    return {name: LINE * (2.2 if ends[name] > 2 or name in geared else 1.0) for name in scheme.discs}


def _least(part: Connection, words: Words, sides: dict[str, float], turned: bool) -> float:
    ends = sum(sides[end] for end in (part.first, part.second) if end != GROUND)
    return max(2.8 * LINE if turned else words.width + 2 * GAP, ends + (LINE if turned else 0.0)) + 2 * HALF
