"""A mechanism by its drawing: lengths and places that its elements leave open follow from coordinates.

| element | what follows |
| --- | --- |
| fixed point | `x`, `y` |
| crank | `radius`, `phase`; and `assembled_at`, the crank angle of the drawing |
| slider | `rod`, `offset`, `assembly` |
| rocker | `coupler`, `rocker`, `assembly` |
| rigid point, body on a link | `along`, `across` |
| bar | `length` |
| joint | `x`, `y` |
| yoke, linear driver, crossing, rack | `offset` of their guides; `start` of a linear driver |

An entry that the file gives counts as it is given, so that a variant may change it. The crank angle of the
drawing is `assembled_at` where that is given; else the first crank has its `phase`, or zero, and the angle
follows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Annotated, Any, NamedTuple

from pydantic import Field
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import Description, fault, suggestion
from linkwright.kernel.description.place import keys, look
from linkwright.kernel.errors import UnitError
from linkwright.kernel.units.kinds import ANGLE, LENGTH, Kind
from linkwright.kernel.units.marks import Lengths, positive
from linkwright.kernel.units.reading import parse, parse_list
from linkwright.linkages.model.dxf_points import Layers
from linkwright.linkages.model.topology import ORIGIN, Topology

Point = tuple[float, float]

# Share of the size of a drawing below which an offset is what rounding leaves of none.
_ROUNDING = 1e-9


class DrawingPoints(Description):
    """Coordinates of points in one position of the mechanism."""

    points: dict[str, Lengths] = Field(
        default_factory=dict,
        description="x and y of each point, by name; for a body on a link, of its centre of mass.",
    )
    file: str | None = Field(
        None, description="DXF file with a point, circle or arc on a layer named after each point."
    )
    unit: Annotated[float, positive(LENGTH)] | None = Field(
        None, description='Unit of the DXF file, such as "1 mm", if the file does not state it.'
    )


class SheetTables(NamedTuple):
    """Tables of a file with what follows from its drawing, and what is wrong with that."""

    tables: dict[str, Any]
    faults: list[InitErrorDetails]


def with_drawing(data: Mapping[str, Any]) -> SheetTables:
    """The tables of a machine file with lengths and places from its drawing, without the drawing itself.

    `data`: raw tables, with the places in the layers of a DXF file for its name.
    """
    tables = {key: value for key, value in data.items() if key != "drawing"}
    drawing, mechanism = data["drawing"], data.get("mechanism")
    if not isinstance(drawing, Mapping) or not isinstance(mechanism, Mapping):
        return SheetTables(
            dict(data), [fault("drawing", found=drawing, expected="a table, beside a mechanism")]
        )
    places, faults = _places(drawing, mechanism)
    if faults:
        return SheetTables(dict(data), faults)
    sheet = _Sheet(places, mechanism)
    if wrong := list(_unknown(drawing, mechanism, sheet, data.get("bodies"))):
        return SheetTables(dict(data), wrong)
    tables["mechanism"] = sheet.filled()
    if isinstance(data.get("bodies"), Mapping):
        tables["bodies"] = {
            name: sheet.body(name, body) if isinstance(body, Mapping) else body
            for name, body in data["bodies"].items()
        }
    return SheetTables(tables, [])


def _places(
    drawing: Mapping[str, Any], mechanism: Mapping[str, Any]
) -> tuple[dict[str, Point], list[InitErrorDetails]]:
    """Coordinates by name, from the origin of the mechanism, with those of fixed points that have them."""
    places: dict[str, Point] = {}
    faults = [
        fault("drawing", key, found=drawing[key], expected="points, file or unit")
        for key in drawing
        if key not in ("points", "file", "unit")
    ]
    faults += _file_faults(drawing)
    for name in keys(drawing.get("points")):
        value = look(drawing["points"], name)
        try:
            x, y = parse_list(value, LENGTH)
        except (UnitError, ValueError):
            # silent: a wrong place becomes a fault of the drawing, with its name
            expected = 'two lengths, x and y, such as "80, 25 mm"'
            faults.append(fault("drawing", "points", name, found=value, expected=expected))
        else:
            places[name] = x, y
    for name, (first, *others) in _layers(drawing).items():
        if not others:
            places.setdefault(name, (first[0], first[1]))
    # Wherever the sheet has its own origin, that of the mechanism is the point O.
    zero = places.get(ORIGIN, (0.0, 0.0)) if ORIGIN not in keys(mechanism.get("points")) else (0.0, 0.0)
    places = {name: (x - zero[0], y - zero[1]) for name, (x, y) in places.items()}
    for name in keys(mechanism.get("points")):
        given = [_number(look(mechanism["points"], name), key, LENGTH) for key in ("x", "y")]
        if name not in places and given != [None, None]:
            places[name] = given[0] or 0.0, given[1] or 0.0
    return places, faults


def _file_faults(drawing: Mapping[str, Any]) -> Iterator[InitErrorDetails]:
    """What is wrong with the name and the unit of a DXF file; the unit of one that was read is used up."""
    file = drawing.get("file")
    if "file" in drawing and not isinstance(file, Layers):
        yield fault("drawing", "file", found=file, expected='the name of a DXF file, such as "linkage.dxf"')
    elif "unit" in drawing:
        found = drawing["unit"]
        yield fault("drawing", "unit", found=found, expected="it beside a file, whose unit it is")


def _number(entry: object, key: str, kind: Kind) -> float | None:
    """A number of a raw table in SI; None where it is left out, or wrong, which its own field reports."""
    value = look(entry, key)
    try:
        return None if value is None else parse(value, kind)
    except UnitError:
        # silent: a number of the file that is wrong is reported by the element that it stands in
        return None


def _layers(drawing: Mapping[str, Any]) -> Mapping[str, Any]:
    file = drawing.get("file")
    return file if isinstance(file, Layers) else {}


def _unknown(
    drawing: Mapping[str, Any], mechanism: Mapping[str, Any], sheet: _Sheet, bodies: object
) -> Iterator[InitErrorDetails]:
    """Points that nothing in the file is named after, and points whose layer has several places."""
    # Other layers are passed over: drawings have many.
    topology = Topology.of(sheet.mechanism)
    known = {ORIGIN, *topology.candidates("point"), *sheet.referred, *keys(bodies)}
    for name in keys(drawing.get("points")):
        if name not in known:
            remedy = suggestion(name, sorted(known))
            yield fault(
                "drawing", "points", name, found=name, expected="the name of a point or a body", remedy=remedy
            )
    placed = {*keys(drawing.get("points")), *keys(mechanism.get("points"))}
    for layer, places in _layers(drawing).items():
        if len(places) > 1 and layer in known - placed:
            yield fault(
                "drawing",
                "file",
                found=f"{len(places)} places in the layer {layer}",
                expected="one point, one circle, or circles about one centre",
                remedy=f"leave one of them in the layer, or give {layer} in drawing.points",
            )


class _Sheet:
    """The drawing of a mechanism: places of points, directions of links."""

    def __init__(self, places: Mapping[str, Point], mechanism: Mapping[str, Any]) -> None:
        self.places = {ORIGIN: (0.0, 0.0), **places}
        self.mechanism = mechanism
        self.size = max((math.hypot(*place) for place in self.places.values()), default=0.0) or 1.0
        self.angle = self._crank_angle()

    @property
    def referred(self) -> set[str]:
        return {
            element.references[key]
            for element in Topology.of(self.mechanism).elements
            for key, wanted in element.kind.references.items()
            if wanted in ("point", "fixed point") and key in element.references
        }

    def filled(self) -> dict[str, Any]:
        made: dict[str, Any] = {}
        for table, entries in self.mechanism.items():
            fill = self._fills.get(table)
            if fill is None or not isinstance(entries, Mapping):
                made[table] = entries
            else:
                made[table] = {
                    name: {**self._known(fill(self, name, entry)), **entry}
                    if isinstance(entry, Mapping)
                    else entry
                    for name, entry in entries.items()
                }
        if self.angle is not None:
            made.setdefault("assembled_at", self.angle)
        made["points"] = self._fixed_points(made.get("points"))
        return self._with_guides(made)

    def _fixed_points(self, points: object) -> dict[str, Any]:
        """Fixed points with their places; one that is drawn and referred to need not be listed."""
        listed = {name: look(points, name) for name in keys(points)}
        moving = Topology.of(self.mechanism).moving_points
        new = {name for name in self.places if name in self.referred and name not in moving}
        for name in sorted(new - {ORIGIN} | ({ORIGIN} & set(listed))):
            given = listed.get(name, {})
            if isinstance(given, Mapping):
                x, y = self.places[name]
                listed[name] = {"x": x, "y": y, **given}
        for name in set(listed) & set(self.places):
            if isinstance(listed[name], Mapping):
                x, y = self.places[name]
                listed[name] = {"x": x, "y": y, **listed[name]}
        return listed

    def _known(self, entries: Mapping[str, Any]) -> dict[str, Any]:
        """Entries that the drawing tells; lengths that are rounding are zero."""
        return {
            key: 0.0 if isinstance(value, float) and abs(value) < _ROUNDING * self.size else value
            for key, value in entries.items()
            if value is not None
        }

    def _at(self, name: object) -> Point | None:
        return self.places.get(name) if isinstance(name, str) else None

    def _length(self, first: object, second: object) -> float | None:
        """Distance of two points; None where one is not drawn."""
        a, b = self._at(first), self._at(second)
        return None if a is None or b is None else math.dist(a, b)

    def _direction(self, first: object, second: object) -> float | None:
        """Angle of the line from one point to another; None where one is not drawn."""
        a, b = self._at(first), self._at(second)
        return None if a is None or b is None else math.atan2(b[1] - a[1], b[0] - a[0])

    def _crank_angle(self) -> float | None:
        """Crank angle of the drawing; None where no crank is drawn, or that is given."""
        given = _number(self.mechanism, "assembled_at", ANGLE)
        if given is not None:
            return given
        cranks = self.mechanism.get("cranks")
        for name in keys(cranks):
            crank = look(cranks, name)
            turned = self._direction(look(crank, "pivot") or ORIGIN, name)
            if turned is not None and look(crank, "law") is None:
                return (turned - (_number(crank, "phase", ANGLE) or 0.0)) % (2 * math.pi)
        return None

    def _crank(self, name: str, crank: Any) -> dict[str, Any]:
        pivot = look(crank, "pivot") or ORIGIN
        turned = self._direction(pivot, name)
        phase = None
        if turned is not None and self.angle is not None and look(crank, "law") is None:
            phase = math.remainder(turned - self.angle, 2 * math.pi)
        return {"radius": self._length(pivot, name), "phase": phase}

    def _slider(self, name: str, slider: Any) -> dict[str, Any]:
        driver = look(slider, "crank")
        made = {"rod": self._length(driver, name), "offset": self._offset(name, slider, driver)}
        a, b, way = self._at(driver), self._at(name), self._guide_angle(slider)
        if a is not None and b is not None and way is not None:
            ahead = (b[0] - a[0]) * math.cos(way) + (b[1] - a[1]) * math.sin(way)
            made["assembly"] = "positive" if ahead >= 0 else "negative"  # type: ignore[assignment]
        return made

    def _offset(self, name: str, guide: Any, driver: object = None) -> float | None:
        """Offset of a guide so that a point is on it; `driver`: whose pivot the guide of a slider passes."""
        place, way = self._at(name), self._guide_angle(guide)
        through = look(guide, "through")
        if through is None and look(guide, "on") is not None:
            through = self._ends(look(guide, "on"))[0]
        elif through is None:
            crank = look(self.mechanism.get("cranks"), driver) if isinstance(driver, str) else None
            through = look(crank, "pivot") or ORIGIN
        start = self._at(through)
        if place is None or way is None or start is None:
            return None
        return (place[1] - start[1]) * math.cos(way) - (place[0] - start[0]) * math.sin(way)

    def _guide_angle(self, guide: Any) -> float | None:
        """Direction of a guide from x; None where it is on a link that is not drawn."""
        own = _number(guide, "angle", ANGLE) or 0.0
        link = look(guide, "on")
        if link is None:
            return own
        turned = self._heading(link)
        return None if turned is None else turned + own

    def _heading(self, link: object) -> float | None:
        """Direction of a link from x; None where it does not follow from points, as that of a gear."""
        levers, yokes = self.mechanism.get("slotted_levers"), self.mechanism.get("yokes")
        if link in keys(yokes):
            return self._guide_angle(look(look(yokes, str(link)), "guide") or {})
        turned = self._direction(*self._ends(link))
        if link not in keys(levers) or turned is None:
            return turned
        lever = look(levers, str(link))
        aside, reach = _number(lever, "offset", LENGTH) or 0.0, self._length(*self._ends(link)) or 0.0
        along = math.sqrt(max(reach**2 - aside**2, 0.0))
        return turned - math.atan2(aside, -along if look(lever, "assembly") == "behind" else along)

    def _ends(self, link: object) -> tuple[object, object]:
        """Names of the points that a link runs between; nothing for those that have none."""
        name, _, part = str(link).partition(".")
        tables = self.mechanism
        if name in keys(tables.get("yokes")):
            return name, name
        if name in keys(tables.get("slotted_levers")):
            lever = look(tables["slotted_levers"], name)
            return look(lever, "pivot"), look(lever, "pin")
        if part in ("coupler", "rocker"):
            rocker = look(tables.get("rockers"), name)
            return look(rocker, "crank" if part == "coupler" else "pivot"), name
        if part == "rod":
            return look(look(tables.get("sliders"), name), "crank"), name
        if name in keys(tables.get("cranks")):
            return look(look(tables["cranks"], name), "pivot") or ORIGIN, name
        if name in keys(tables.get("bars")):
            bar = look(tables["bars"], name)
            return look(bar, "start"), look(bar, "end")
        return None, None

    def _rocker(self, name: str, rocker: Any) -> dict[str, Any]:
        driver, pivot = look(rocker, "crank"), look(rocker, "pivot")
        made: dict[str, Any] = {"coupler": self._length(driver, name), "rocker": self._length(pivot, name)}
        a, b, joint = self._at(driver), self._at(pivot), self._at(name)
        if a is not None and b is not None and joint is not None:
            side = (b[0] - a[0]) * (joint[1] - a[1]) - (b[1] - a[1]) * (joint[0] - a[0])
            made["assembly"] = "left" if side >= 0 else "right"
        return made

    def _on_link(self, name: str, link: object) -> dict[str, Any]:
        start, way, place = self._at(self._ends(link)[0]), self._heading(link), self._at(name)
        if start is None or way is None or place is None:
            return {}
        x, y, cos, sin = place[0] - start[0], place[1] - start[1], math.cos(way), math.sin(way)
        return {"along": x * cos + y * sin, "across": y * cos - x * sin}

    def _rigid_point(self, name: str, point: Any) -> dict[str, Any]:
        return self._on_link(name, look(point, "link"))

    def body(self, name: str, body: Mapping[str, Any]) -> dict[str, Any]:
        link = body.get("on", name)
        is_point = link in Topology.of(self.mechanism).moving_points and "." not in str(link)
        drawn = name in self.places and not (is_point and name == link)
        return {**(self._known(self._on_link(name, link)) if drawn else {}), **body}

    def _bar(self, name: str, bar: Any) -> dict[str, Any]:
        return {"length": self._length(look(bar, "start"), look(bar, "end"))}

    def _joint(self, name: str, joint: Any) -> dict[str, Any]:
        place = self._at(name)
        return {} if place is None else {"x": place[0], "y": place[1]}

    def _driver(self, name: str, driver: Any) -> dict[str, Any]:
        way, place = self._guide_angle(look(driver, "guide") or {}), self._at(name)
        per_turn, through = _number(driver, "per_turn", LENGTH), look(look(driver, "guide"), "through")
        start = self._at(through or ORIGIN)
        if way is None or place is None or start is None or per_turn is None:
            return {}
        along = (place[0] - start[0]) * math.cos(way) + (place[1] - start[1]) * math.sin(way)
        return {"start": along - per_turn * (self.angle or 0.0) / (2 * math.pi)}

    def _with_guides(self, made: dict[str, Any]) -> dict[str, Any]:
        for table, parts in _GUIDES.items():
            entries = made.get(table)
            if not isinstance(entries, Mapping):
                continue
            made[table] = {name: self._guided(name, entry, parts) for name, entry in entries.items()}
        return made

    def _guided(self, name: str, entry: Any, parts: tuple[str, ...]) -> Any:
        if not isinstance(entry, Mapping) or name not in self.places:
            return entry
        guides = {part: dict(look(entry, part) or {}) for part in parts if part in entry or part == "guide"}
        return {
            **entry,
            **{
                part: {**self._known({"offset": self._offset(name, guide)}), **guide}
                for part, guide in guides.items()
            },
        }

    _fills: Mapping[str, Callable[[_Sheet, str, Any], dict[str, Any]]] = {
        "cranks": _crank,
        "sliders": _slider,
        "rockers": _rocker,
        "rigid_points": _rigid_point,
        "bars": _bar,
        "joints": _joint,
        "linear_drivers": _driver,
    }


# Table → its guides.
_GUIDES = {"yokes": ("guide",), "linear_drivers": ("guide",), "crossings": ("first", "second")}
