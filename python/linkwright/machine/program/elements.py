"""Elements of the core's program for drivers, dyads, gears, racks, cables and rigid points, one by one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from linkwright import _core
from linkwright.kernel.description import formula
from linkwright.kernel.units.reading import is_number
from linkwright.linkages.model.cylinder import Cylinder
from linkwright.linkages.model.element import (
    TURN,
    Cable,
    Crank,
    Crossing,
    Gear,
    Guide,
    LinearDriver,
    Rack,
    Rocker,
    Slider,
    SlottedLever,
    Yoke,
)
from linkwright.machine.program.places import Foldable, GuideLine, Places, angle_name, length_name

# Name of what a law advances by among its constants; no constant of a file has a colon.
_ADVANCE = ":advance"


class Elements(Places):
    """Makes the elements of a mechanism that are placed one by one."""

    def _element(self, name: str) -> None:
        """What one element of the description needs, by the table that it stands in."""
        mechanism = self.mechanism
        makers = {
            "cranks": self._crank,
            "linear_drivers": self._linear_driver,
            "sliders": self._slider,
            "rockers": self._rocker,
            "slotted_levers": self._slotted_lever,
            "crossings": self._crossing,
            "yokes": self._yoke,
            "rigid_points": self._rigid_point,
            "gears": self._gear,
            "racks": self._rack,
            "cables": self._cable,
            "bars": self._bar,
            "cylinders": self._cylinder,
        }
        for table, make in makers.items():
            element = getattr(mechanism, table).get(name)
            if element is not None:
                make(name, element)  # type: ignore[operator]
                return

    # -- drivers -----------------------------------------------------------------------------------------

    def _crank(self, name: str, crank: Crank) -> None:
        pivot = self._fixed_or_origin(crank.pivot)
        programme = crank.follows()
        if programme is not None:
            start, terms = self._followed(name, programme, crank.turn)  # type: ignore[attr-defined]
            self._turn(name, crank.phase + start, terms)
            self._point_on_link(name, self.links[name], pivot, crank.radius, 0.0)
            return
        if crank.law is not None:
            self._turn(name, crank.phase, [(self._law(name, crank), 1.0)])
            self._point_on_link(name, self.links[name], pivot, crank.radius, 0.0)
            return
        self.elements.append(
            _core.Element.Crank(
                pin=self._point(name),
                link=self._link(name),
                pivot=pivot,
                radius=self.slot(crank.radius),
                cos=self.slot(np.cos(crank.phase)),
                sin=self.slot(np.sin(crank.phase)),
            )
        )

    def _linear_driver(self, name: str, driver: LinearDriver) -> None:
        start, terms = self._travel(name, driver)
        self._runner(name, self._guide(driver.guide), driver.start + start, terms)

    def _travel(self, name: str, driver: LinearDriver | Cylinder) -> tuple[Any, list[tuple[int | None, Any]]]:
        """Constant and terms of what a driver follows: a lift, a formula or the crank."""
        programme = driver.follows()
        if programme is not None:
            return self._followed(name, programme, 1.0)
        if driver.law is not None:
            return 0.0, [(self._law(name, driver), 1.0)]
        assert isinstance(driver, LinearDriver)
        assert driver.per_turn is not None
        return 0.0, [(None, driver.per_turn / TURN)]

    def _cylinder_length(self, name: str, cylinder: Cylinder) -> int:
        """The length of a driver as a coordinate, on which a group of joints depends."""
        hidden = length_name(name)
        axis = GuideLine(self.origin, None, 0.0, 0.0)
        start, terms = self._travel(name, cylinder)
        self._runner(hidden, axis, cylinder.start_length + start, terms)
        return self.slides[hidden]

    def _cylinder(self, name: str, cylinder: Cylinder) -> None:
        """Barrel and rod between points that are placed: directions, and the distance as a coordinate."""
        ends = self.points[cylinder.start], self.points[cylinder.end]
        rod = f"{name}.rod"
        for link, slide, (pivot, pin) in ((name, name, ends), (rod, length_name(rod), ends[::-1])):
            lever = _core.Element.SlottedLever(
                link=self._link(link),
                slide=self._slide(slide),
                dyad=self._dyad(link),
                pin=pin,
                pivot=pivot,
                offset=self.slot(0.0),
                sign=self.slot(1.0),
            )
            self.elements.append(lever)

    def _law(self, name: str, driver: Crank | LinearDriver | Cylinder) -> int:
        """A coordinate that is a formula of the crank angle."""
        assert driver.law is not None
        slide = self._slide(f"{name}.law")
        known = {key: self.slot(value) for key, value in driver.constants.items()}
        law = formula.parse(driver.law)
        if driver.advance is not None:
            known[_ADVANCE] = self.slot(driver.advance)
            law = formula.restarted(law, "phi", _ADVANCE)
        followed = self.formula(law, known)
        self.elements.append(_core.Element.Law(slide=slide, formula=followed))
        return slide

    def _followed(self, name: str, programme: Any, sense: float) -> tuple[Any, list[tuple[int | None, Any]]]:
        """Constant and terms of a place that follows a lift and advances in every cycle."""
        slide = self._slide(f"{name}.lift")
        phase = self.slot(programme.phase)
        law = self.motion_law(programme.lift)
        self.elements.append(_core.Element.Programme(slide=slide, phase=phase, law=law))
        terms: list[tuple[int | None, Any]] = [(slide, sense)]
        if is_number(programme.advance) and programme.advance == 0:
            return 0.0, terms
        rate = programme.advance / TURN
        return -rate * programme.phase, [*terms, (None, rate)]

    # -- dyads -------------------------------------------------------------------------------------------

    def _slider(self, name: str, slider: Slider) -> None:
        if slider.on is not None or slider.through not in (None, *self.fixed):
            self._guided_rod(name, slider)
            return
        driver = self.mechanism.cranks.get(slider.crank)
        rod = _core.Element.SliderRod(
            point=self._point(name),
            link=self._link(f"{name}.rod"),
            slide=self._slide(name),
            dyad=self._dyad(name),
            pin=self.points[slider.crank],
            through=self._fixed_or_origin(slider.through or (driver.pivot if driver else None)),
            rod=self.slot(slider.rod),
            inverse_rod=self.slot(1.0 / slider.rod),
            offset=self.slot(slider.offset),
            cos=self.slot(np.cos(slider.angle)),
            sin=self.slot(np.sin(slider.angle)),
            sign=self.slot(1.0 if slider.assembly == "positive" else -1.0),
        )
        self._foldable(name, rod, rod.sign)

    def _guided_rod(self, name: str, slider: Slider) -> None:
        guide = Guide(through=slider.through, on=slider.on)
        # Checked numbers, which may carry derivatives or be arrays over many machines.
        guide = guide.with_entries({"angle": slider.angle, "offset": slider.offset})
        sign = 1.0 if slider.assembly == "positive" else -1.0
        self._rod(name, f"{name}.rod", slider.crank, self._guide(guide), slider.rod, sign)

    def _rod(self, name: str, link: str, pin: str, line: GuideLine, length: Any, sign: float) -> int:
        """A rod from a pin to a slider on any guide; gives the slot of its sign."""
        rod = _core.Element.GuidedRod(
            point=self._point(name),
            link=self._link(link),
            slide=self._slide(name),
            dyad=self._dyad(name),
            pin=self.points[pin],
            line=self._line(line),
            rod=self.slot(length),
            inverse_rod=self.slot(1.0 / length),
            sign=self.slot(sign),
            change_points=[],
        )
        return self._foldable(name, rod, rod.sign)

    def _foldable(self, name: str, element: _core.Element, sign: int) -> int:
        """Adds a dyad that may have change points; gives the slot of its sign."""
        self.pending.append(Foldable(name, len(self.elements), sign))
        self.elements.append(element)
        return sign

    def _rocker(self, name: str, rocker: Rocker) -> None:
        links = (f"{name}.coupler", f"{name}.rocker")
        sign = 1.0 if rocker.assembly == "left" else -1.0
        self._dyad_rrr(name, links, (rocker.crank, rocker.pivot), (rocker.coupler, rocker.rocker), sign)

    def _dyad_rrr(
        self, name: str, links: Sequence[str], ends: Sequence[str], lengths: Sequence[Any], sign: float
    ) -> int:
        """Two links that meet in a joint; gives the slot of its sign."""
        rocker = _core.Element.Rocker(
            joint=self._point(name),
            coupler_link=self._link(links[0]),
            rocker_link=self._link(links[1]),
            dyad=self._dyad(name),
            pin=self.points[ends[0]],
            pivot=self.points[ends[1]],
            coupler=self.slot(lengths[0]),
            rocker=self.slot(lengths[1]),
            inverse_coupler=self.slot(1.0 / lengths[0]),
            inverse_rocker=self.slot(1.0 / lengths[1]),
            sign=self.slot(sign),
            change_points=[],
        )
        return self._foldable(name, rocker, rocker.sign)

    def _slotted_lever(self, name: str, lever: SlottedLever) -> None:
        self.elements.append(
            _core.Element.SlottedLever(
                link=self._link(name),
                slide=self._slide(name),
                dyad=self._dyad(name),
                pin=self.points[lever.pin],
                pivot=self.points[lever.pivot],
                offset=self.slot(lever.offset),
                sign=self.slot(1.0 if lever.assembly == "ahead" else -1.0),
            )
        )

    def _crossing(self, name: str, crossing: Crossing) -> None:
        slides = [self._slide(f"{name}.first"), self._slide(f"{name}.second")]
        self._cross(name, slides, [self._guide(crossing.first), self._guide(crossing.second)])

    def _cross(self, name: str, slides: list[int], lines: list[GuideLine]) -> None:
        self.elements.append(
            _core.Element.Crossing(
                point=self._point(name),
                slides=slides,
                dyad=self._dyad(name),
                lines=[self._line(line) for line in lines],
            )
        )

    def _yoke(self, name: str, yoke: Yoke) -> None:
        guide = self._guide(yoke.guide)
        slot = GuideLine(self.points[yoke.pin], guide.link, guide.angle + yoke.slot, 0.0)
        self._cross(name, [self._slide(name), self._slide(f"{name}.slot")], [guide, slot])
        terms: list[tuple[int | None, Any]] = []
        if yoke.guide.on is not None:
            terms.append((self._angle(yoke.guide.on), 1.0))
        self._turn(name, guide.angle, terms)

    # -- points and links --------------------------------------------------------------------------------

    def _rigid_point(self, name: str, part: Any) -> None:
        """A point on a link; one that a group has placed with its bars is there already."""
        if name not in self.points:
            link, start = self.links[part.link], self.starts[part.link]
            self._point_on_link(name, link, start, part.along, part.across)

    def _point_on_link(self, name: str, link: int, origin: int, along: Any, across: Any) -> None:
        self.elements.append(
            _core.Element.RigidPoint(
                point=self._point(name),
                link=link,
                origin=origin,
                along=self.slot(along),
                across=self.slot(across),
            )
        )

    def _bar(self, name: str, bar: Any) -> None:
        """A bar whose ends are placed; one that a dyad or a group has placed is there already."""
        if name not in self.links:
            self.elements.append(_core.Element.Link(bar=self._placed_bar(name, bar)))

    def _placed_bar(self, name: str, bar: Any) -> _core.Bar:
        return _core.Bar(
            link=self._link(name),
            start=self.points[bar.start],
            end=self.points[bar.end],
            inverse_length=self.slot(1.0 / bar.length),
        )

    # -- coupled motions ---------------------------------------------------------------------------------

    def _gear(self, name: str, gear: Gear) -> None:
        """ψ = (1 − κ) ψ_carrier + κ ψ_other + phase, κ = −z_other/z where the sense is reversed."""
        ratio = gear.size_other / gear.size
        ratio = -ratio if gear.kind in ("external", "crossed_belt") else ratio
        terms: list[tuple[int | None, Any]] = []
        if gear.meshes is not None:
            terms.append((self._angle(gear.meshes), ratio))
        if gear.carrier is not None:
            terms.append((self._angle(gear.carrier), 1.0 - ratio))
        self._turn(name, gear.phase, terms)

    def _rack(self, name: str, rack: Rack) -> None:
        """s = start ± R (ψ − ψ_guide): right of a gear that turns to the left the rack goes ahead."""
        radius = rack.radius if rack.side == "right" else -rack.radius
        terms: list[tuple[int | None, Any]] = [(self._angle(rack.gear), radius)]
        if rack.guide.on is not None:
            terms.append((self._angle(rack.guide.on), -radius))
        self._runner(name, self._guide(rack.guide), rack.start, terms)

    def _cable(self, name: str, cable: Cable) -> None:
        """s = length ± R (reference − ψ): an arc to the left draws the cable in as it turns to the left."""
        radius = cable.radius if cable.side == "left" else -cable.radius
        line = GuideLine(self.starts[cable.link], None, cable.angle, radius)
        start = cable.length + radius * cable.reference
        angle = self._angle_near(cable.link, angle_name(name), cable.reference)
        self._runner(name, line, start, [(angle, -radius)])
