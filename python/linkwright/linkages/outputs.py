"""What a mechanism moves back and forth: links on fixed points, sliders, levers, racks, by element."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from linkwright.linkages.dyads import LINK, SLIDE
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.program.compiled import Compiled
from linkwright.machine.program.core import Element


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
    """The outputs of a machine in build order; for a rocker its link on the pivot. Returns: none of the
    drivers.
    """
    names = _Names(compiled, mechanism)
    return [each for element in compiled.elements for each in names.of(element)]


class _Names:
    """Names of links and slides by the core's index."""

    def __init__(self, compiled: Compiled, mechanism: Mechanism) -> None:
        self.compiled, self.mechanism = compiled, mechanism
        self.links = {index: name for name, index in compiled.links.items()}
        self.slides = {index: name for name, index in compiled.slides.items()}
        self.grounds = {fixed.point for fixed in compiled.ground}

    def of(self, element: Element) -> Iterator[Output]:
        """What one element moves."""
        dyads = self.compiled.dyads
        match element:
            case Element.SliderRod() | Element.GuidedRod():
                yield self._stroke(dyads[element.dyad], element.slide)
            case Element.Rocker():
                yield self._swing(dyads[element.dyad], self._hung(element))
            case Element.SlottedLever():
                yield self._swing(dyads[element.dyad], element.link)
                yield self._stroke(dyads[element.dyad], element.slide)
            case Element.Crossing():
                yield from (self._stroke(dyads[element.dyad], slide) for slide in element.slides)
            case Element.Runner(slide=slide) if self.slides[slide] not in self.mechanism.linear_drivers:
                yield self._stroke(self.slides[slide], slide)
            case Element.Turn(link=link) if self.links[link] in self.mechanism.gears:
                yield self._swing(self.links[link], link)
            case Element.Group():
                yield from self._group(dyads[element.dyad])

    def _stroke(self, element: str, slide: int) -> Output:
        return Output(element, self.slides[slide], "stroke", SLIDE, slide)

    def _swing(self, element: str, link: int) -> Output:
        name = self.links[link].removesuffix(" reversed")
        return Output(element, name, "swing", LINK, self.compiled.links[name])

    def _hung(self, dyad: Element.Rocker) -> int:
        """The link of a dyad RRR that hangs on a fixed point, the second if both or none do."""
        first = dyad.pin in self.grounds and dyad.pivot not in self.grounds
        return dyad.coupler_link if first else dyad.rocker_link

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
