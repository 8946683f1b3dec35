"""What a mechanism moves back and forth: links on fixed points, sliders, levers, racks, by element."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from linkwright.linkages.dyads import LINK, SLIDE
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.program.compiled import Compiled


class Output(NamedTuple):
    """One coordinate that is moved.

    Attributes
    ----------
    element : str
        Name of the element, or of a joint held by bars.
    name : str
        Name of the link or slide.
    kind : str
        ``"swing"`` of a link or ``"stroke"`` along a guide.
    part, number : int
        What the core calls it.
    """

    element: str
    name: str
    kind: Literal["swing", "stroke"]
    part: int
    number: int


def outputs_of(compiled: Compiled, mechanism: Mechanism) -> list[Output]:
    """The outputs of a machine in build order; for a rocker its link on the pivot.

    Parameters
    ----------
    compiled : Compiled
        The machine.
    mechanism : Mechanism
        Its description, for the names.

    Returns
    -------
    list of Output
        None of the drivers.
    """
    names = _Names(compiled, mechanism)
    return [each for row in compiled.rows for each in names.of(row)]


class _Names:
    """Names of links and slides by the core's index."""

    def __init__(self, compiled: Compiled, mechanism: Mechanism) -> None:
        self.compiled, self.mechanism = compiled, mechanism
        self.links = {index: name for name, index in compiled.links.items()}
        self.slides = {index: name for name, index in compiled.slides.items()}
        self.grounds = {row[1] for row in compiled.rows if row[0] == 0}

    def of(self, row: tuple[int, ...]) -> Iterator[Output]:
        """The outputs of one row."""
        kind, dyads = row[0], self.compiled.dyads
        if kind in (2, 5, 15):
            yield self._stroke(dyads[row[4]], row[3])
        elif kind in (3, 11):
            yield self._swing(dyads[row[4]], self._hung(row))
        elif kind == 6:
            yield self._swing(dyads[row[3]], row[1])
            yield self._stroke(dyads[row[3]], row[2])
        elif kind == 7:
            yield from (self._stroke(dyads[row[4]], slide) for slide in row[2:4])
        elif kind == 9 and self.slides[row[2]] not in self.mechanism.linear_drivers:
            yield self._stroke(self.slides[row[2]], row[2])
        elif kind == 8 and self.links[row[1]] in self.mechanism.gears:
            yield self._swing(self.links[row[1]], row[1])
        elif kind == 12:
            yield from self._group(dyads[row[1]])

    def _stroke(self, element: str, slide: int) -> Output:
        return Output(element, self.slides[slide], "stroke", SLIDE, slide)

    def _swing(self, element: str, link: int) -> Output:
        name = self.links[link].removesuffix(" reversed")
        return Output(element, name, "swing", LINK, self.compiled.links[name])

    def _hung(self, row: tuple[int, ...]) -> int:
        """The link of a dyad RRR that hangs on a fixed point, the second if both or none do."""
        return row[2] if row[5] in self.grounds and row[6] not in self.grounds else row[3]

    def _group(self, dyad: str) -> Iterator[Output]:
        """Bars of a group that hang on fixed points, and joints on guides."""
        joints = dyad.split(" and ")
        fixed = self.mechanism.fixed_points()
        for name, bar in self.mechanism.bars.items():
            ends = (bar.start, bar.end)
            if any(end in joints for end in ends) and any(end in fixed for end in ends):
                yield self._swing(name, self.compiled.links[name])
        for joint in joints:
            if joint in self.compiled.slides:
                yield self._stroke(joint, self.compiled.slides[joint])
