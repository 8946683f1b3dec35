"""The core's program of a whole mechanism: fixed points, then elements in build order."""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright import _core
from linkwright.kernel.numerics.tangent import primal
from linkwright.linkages.model.assembly import Step
from linkwright.linkages.model.mechanism import Mechanism
from linkwright.machine.program.elements import Elements
from linkwright.machine.program.numbers import table
from linkwright.machine.program.places import GuideLine, PendingGroup, Side


class MechanismProgram(Elements):
    """Collects numbers and elements while it walks through a mechanism."""

    def __init__(self, mechanism: Mechanism) -> None:
        super().__init__(mechanism)
        # How many of the numbers are the mechanism's own.
        self.n_own = 0
        # Links that were placed before the group that is being made.
        self.known: set[str] = set()

    def build(self) -> None:
        """Fixed points first, then the moving elements in build order."""
        self.origin = self._fixed("", 0.0, 0.0)
        self.fixed = self.mechanism.fixed_points()
        for name, point in self.fixed.items():
            self._fixed(name, point.x, point.y)
        for step in self.mechanism.steps():
            if step.kind == "element":
                self._element(step.names[0])
            elif step.kind == "dyad":
                self._dyad_of_bars(step)
            else:
                self._group(step)
        # The hidden origin has served: nobody can ask for it by name.
        self.points.pop("")
        self.n_own = len(self.parameters)

    # -- joints held by bars -----------------------------------------------------------------------------

    def _held(self, bar: str, joint: str) -> tuple[str, str, Any]:
        """Link, far end and length of a bar that holds a joint; one that starts there has a hidden link."""
        held = self.mechanism.bars[bar]
        if held.start == joint:
            return f"{bar} reversed", held.end, held.length
        return bar, held.start, held.length

    def _dyad_of_bars(self, step: Step) -> None:
        """A joint held by two bars, or by a bar and a guide, on the side where it is given."""
        joint = step.names[0]
        held = [self._held(bar, joint) for bar in step.conditions if bar in self.mechanism.bars]
        if len(held) == 2:
            links, ends, lengths = zip(*held, strict=True)
            place = len(self.pending)
            slot = self._dyad_rrr(joint, links, ends, lengths, 1.0)
            pin, pivot = (self.points[end] for end in ends)
            # The side is needed before change points are looked for.
            self.pending.insert(place, Side(joint, slot, pin, pivot))
            return
        link, end, length = held[0]
        guide = self.mechanism.joints[joint].guide
        assert guide is not None
        line = self._guide(guide)
        place = len(self.pending)
        slot = self._rod(joint, link, end, line, length, 1.0)
        self.pending.insert(place, Side(joint, slot, self.points[end], guide=(line.link, line.angle)))

    # -- groups ------------------------------------------------------------------------------------------

    def _group(self, step: Step) -> None:
        """Joints that are found together."""
        joints, rigid = self.mechanism.joints, self.mechanism.rigid_points
        self.known = set(self.links)
        bars = [name for name in step.conditions if name in self.mechanism.bars]
        lengths = {
            name: self._cylinder_length(name, self.mechanism.cylinders[name])
            for name in step.conditions
            if name in self.mechanism.cylinders
        }
        unknowns = [self._point(name) for name in step.names]
        carried = self._carried(bars, step)
        bars = list(dict.fromkeys([*bars, *(rigid[name].link for name in carried)]))
        places = [value for name in step.names for value in (joints[name].x, joints[name].y)]
        turns = self.slot(1.0)
        self.pending.append(PendingGroup(step.names, len(self.elements), turns))
        self.elements.append(
            _core.Element.Group(
                dyad=self._dyad(" and ".join(step.names)),
                unknowns=unknowns,
                bar_points=[self._carried_point(name) for name in carried],
                bars=[self._placed_bar(name, self.mechanism.bars[name]) for name in bars],
                conditions=[self._condition(name, lengths) for name in step.conditions],
                starts=[table((0.0,), (float(np.ravel(primal(value))[0]),)) for value in places],
                inverse_turns=turns,
                repeats=True,
            )
        )

    def _carried(self, bars: list[str], step: Step) -> list[str]:
        """Points fixed to bars of the group that its conditions refer to, each after those it hangs on."""
        carried: list[str] = []

        def need(name: str) -> None:
            part = self.mechanism.rigid_points.get(name)
            if part is not None and name not in self.points:
                for end in (self.mechanism.bars[part.link].start, self.mechanism.bars[part.link].end):
                    need(end)
                self._point(name)
                carried.append(name)

        for bar in bars:
            need(self.mechanism.bars[bar].start)
            need(self.mechanism.bars[bar].end)
        for name in set(step.conditions) & set(self.mechanism.cylinders):
            need(self.mechanism.cylinders[name].start)
            need(self.mechanism.cylinders[name].end)
        for name in step.conditions:
            guide = self.mechanism.joints[name].guide if name in self.mechanism.joints else None
            if guide is not None and guide.through is not None:
                need(guide.through)
        return carried

    def _carried_point(self, name: str) -> _core.BarPoint:
        part = self.mechanism.rigid_points[name]
        bar = self.mechanism.bars[part.link]
        return _core.BarPoint(
            point=self.points[name],
            start=self.points[bar.start],
            end=self.points[bar.end],
            along=self.slot(part.along / bar.length),
            across=self.slot(part.across / bar.length),
        )

    def _condition(self, name: str, lengths: dict[str, int]) -> _core.Condition:
        """A bar's length, that of a cylinder, or a joint on its guide."""
        if name in lengths:
            cylinder = self.mechanism.cylinders[name]
            ends = self.points[cylinder.start], self.points[cylinder.end]
            return _core.Condition.Length(start=ends[0], end=ends[1], slide=lengths[name])
        if name in self.mechanism.bars:
            bar = self.mechanism.bars[name]
            ends = self.points[bar.start], self.points[bar.end]
            return _core.Condition.Distance(start=ends[0], end=ends[1], length=self.slot(bar.length))
        guide = self.mechanism.joints[name].guide
        assert guide is not None
        point, slide = self.points[name], self._slide(name)
        if guide.on in self.mechanism.bars and guide.on not in self.known:
            carrier = self.mechanism.bars[guide.on]
            through = carrier.start if guide.through is None else guide.through
            line = self._line(GuideLine(self.points[through], None, guide.angle, guide.offset))
            on = self._placed_bar(guide.on, carrier)
            return _core.Condition.OnBar(point=point, line=line, slide=slide, bar=on)
        return _core.Condition.OnLine(point=point, line=self._line(self._guide(guide)), slide=slide)
