"""Elements that are added to a machine, with sizes of the drawing, and links that are drawn with the mouse.

Each kind of element says what it may be built on, best first; the first that makes a sound machine is taken.
A link that is drawn is a crank if nothing drives the mechanism yet, else a bar. Where it begins in the plane
is a point of the frame; where it ends in the plane, a new joint, or a point of the frame if it comes from a
joint that needs no more than that. Links wait until each new joint has two. A driving cylinder is a link too;
a passive one holds no joint, and ends in the plane at a point of the frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, NamedTuple

from linkwright.axes.model.axis_catalogue import read_servo_motors
from linkwright.kernel.description.place import join, keys, look
from linkwright.kernel.errors import InputError, LinkwrightError
from linkwright.linkages.model.topology import ORIGIN, Topology
from linkwright.machine.read import loads
from linkwright.studio.document import changed, tables_of

Entries = dict[str, Any]


@dataclass(frozen=True)
class Site:
    """What an element is built on."""

    raw: Mapping[str, Any]
    topology: Topology
    size: float  # of the drawing [m]
    unit: str  # of lengths in the file
    picked: str  # point that was picked last; empty for none
    folder: Path | None = None  # of the file

    @classmethod
    def of(cls, text: str, size: float, picked: str = "", path: str = "") -> Site:
        """That of a file."""
        raw = tables_of(text)
        unit = "mm" if ' mm"' in text or look(look(raw, "units"), "length") == "mm" else "m"
        folder = Path(path).parent if path else None
        return cls(raw, Topology.of(look(raw, "mechanism")), size, unit, picked, folder)

    def names(self, table: str) -> list[str]:
        """Names in a table of the file, which may be none."""
        return list(keys(look(self.raw, table)))

    def length(self, share: float) -> str:
        """A share of the drawing's size as the file writes lengths."""
        return self.metres(share * self.size, 2)

    def metres(self, value: float, digits: int = 4) -> str:
        """A length as the file writes it."""
        size = value * (1000 if self.unit == "mm" else 1)
        return f"{float(f'{size:.{digits}g}'):.12g} {self.unit}"

    def fresh(self, head: str, more: Sequence[str] = ()) -> str:
        """A name that nothing has."""
        names = {element.name for element in self.topology.elements} | {*self.names("loads"), *more}
        return next(name for n in count(1) if (name := f"{head}{n}") not in names)

    def first(self, names: Sequence[str]) -> list[str]:
        """Names, that of the picked point first."""
        return [*(name for name in names if name == self.picked), *(n for n in names if n != self.picked)]

    @property
    def moving(self) -> list[str]:
        """Moving points; pins and joints before others."""
        return self.first(self.topology.moving_points)

    @property
    def fixed(self) -> list[str]:
        """Fixed points, those with names of their own first."""
        return self.first([*(n for n in self.topology.fixed_points if n != ORIGIN), ORIGIN])

    @property
    def links(self) -> list[str]:
        """Links."""
        return list(self.topology.links)

    @property
    def slides(self) -> list[str]:
        """Coordinates along guides."""
        return self.first(self.topology.slides)


Made = Iterator[tuple[tuple[str, ...], Any]]


class Kind(NamedTuple):
    """A kind of element: its word, its group in the menu, what it needs, and what it may be."""

    word: str
    group: str
    needs: str
    made: Callable[[Site], Made]


def _one(table: str, head: str, entries: Callable[[Site], Iterator[Entries]]) -> Callable[[Site], Made]:

    def made(site: Site) -> Made:
        yield from ((("mechanism", table, site.fresh(head)), element) for element in entries(site))

    return made


def _load(head: str, entries: Callable[[Site], Iterator[Entries]]) -> Callable[[Site], Made]:

    def made(site: Site) -> Made:
        yield from ((("loads", site.fresh(head)), load) for load in entries(site))

    return made


def _on(names: Callable[[Site], Sequence[str]], **entries: Any) -> Callable[[Site], Iterator[Entries]]:
    return lambda site: ({**entries, "on": name} for name in names(site))


def _between(**entries: Any) -> Callable[[Site], Iterator[Entries]]:
    return lambda site: (
        {**entries, "between": [fixed, moving]} for moving in site.moving for fixed in site.fixed
    )


def _slots(site: Site) -> Iterator[Entries]:
    for pin in site.moving:
        yield from ({"pin": pin, "pivot": pivot} for pivot in site.fixed)


def _cylinders(site: Site) -> Iterator[Entries]:
    ends = ((fixed, moving) for moving in site.moving for fixed in site.fixed)
    return ({"start": start, "end": end, "damping": "1000 N s/m"} for start, end in ends)


def _driving(site: Site, start: str, end: str, size: float, angle: float = 0.0) -> Entries:
    """A cylinder as long as it is drawn, at a crank angle; it extends by a tenth of that and returns."""
    half = float(f"{0.05 * size:.1g}")
    length = site.metres(size - half * (1 - math.cos(angle)), 7)
    return {"start": start, "end": end, "start_length": length, "law": f"{half:g} * (1 - cos(phi))"}


def _lift(site: Site) -> Made:
    """A boom about a point of the frame, lifted by a cylinder from another."""
    joint, far = site.fresh("J"), site.fresh("P")
    size = site.size
    boom, cylinder = ({"start": start, "end": joint} for start in (site.fixed[0], far))
    for name in site.fixed:
        yield (
            ("mechanism",),
            {
                f"points.{far}": {"x": site.length(0.4), "y": site.length(-0.2)},
                f"joints.{joint}": {"x": site.length(0.6), "y": site.length(0.3)},
                f"bars.{site.fresh('B')}": {**boom, "start": name, "length": site.length(0.67)},
                f"cylinders.{site.fresh('Z')}": _driving(site, cylinder["start"], joint, 0.54 * size),
            },
        )


def _axes(site: Site) -> Made:
    """An axis for each driver that has none, with a swing or a lift where it has no motion of its own."""
    taken = {look(look(look(site.raw, "axes"), name), "driver") or name for name in site.names("axes")}
    mechanism = look(site.raw, "mechanism")
    for table in ("cranks", "linear_drivers", "cylinders", "cams"):
        for name in site.first(list(keys(look(mechanism, table)))):
            own = look(look(mechanism, table), name)
            if name in taken or (table == "cylinders" and look(own, "start_length") is None):
                continue
            entries: Entries = {"sections": _sections("swing", "60 deg")} if table == "cranks" else {}
            if any(look(own, key) is not None for key in ("law", "advance")):
                entries = {}
            # Without a cycle time nothing is known of torques.
            timed = any(look(look(site.raw, "drive"), key) is not None for key in ("speed", "motor"))
            master = {} if timed or "master" in site.raw else {"master": {"cycle_time": "1 s"}}
            yield (), {**master, f"axes.{join((name,))}": entries or {"driver": name}}


def _axis_motors(entries: Callable[[Site], Iterator[Entries]]) -> Callable[[Site], Made]:

    def made(site: Site) -> Made:
        for name in site.names("axes"):
            axis = look(look(site.raw, "axes"), name)
            if look(axis, "motor") is None:
                for motor in entries(site):
                    yield ("axes", name, "motor"), motor
                    # Along a line it turns a screw or a pinion.
                    parts = {"motor": motor, "gearbox.per_turn": site.length(0.05)}
                    yield (), {f"axes.{join((name,))}.{key}": entry for key, entry in parts.items()}

    return made


def _from_catalogues(site: Site) -> Iterator[Entries]:
    """The first type of each catalogue of servo motors beside the file."""
    for file in sorted(site.folder.glob("*.csv")) if site.folder is not None else ():
        try:
            motors = read_servo_motors(file)
        except LinkwrightError:
            # silent: another table than a catalogue of servo motors
            continue
        yield from ({"file": file.name, "catalogue": motor.type} for motor in motors[:1])


_SERVO: Entries = {
    "inertia": "1 kg cm^2",
    "continuous": {"speed": "0, 3000 rpm", "torque": "2.4, 2.3 N m"},
    "peak": {"speed": "0, 3000 rpm", "torque": "7.1, 7.1 N m"},
}


def _rockers(site: Site) -> Iterator[Entries]:
    for crank in site.moving:
        for pivot in site.fixed:
            lengths = {"coupler": site.length(0.5), "rocker": site.length(0.4)}
            yield {"crank": crank, "pivot": pivot, **lengths}


def _crossings(site: Site) -> Iterator[Entries]:
    for link in site.links:
        yield {"first": {"on": link}, "second": {"angle": "90 deg", "offset": site.length(-0.2)}}
        yield {"first": {"on": link}, "second": {"offset": site.length(0.2)}}


def _gears(site: Site) -> Iterator[Entries]:
    for link in site.links:
        for pivot in site.fixed:
            yield {"pivot": pivot, "meshes": link, "size": 40, "size_other": 20}


def _cam(site: Site) -> Entries:
    sizes = {"base_radius": site.length(0.15), "roller_radius": site.length(0.05)}
    return {"contact": "roller", **sizes}


def _sections(key: str, much: str) -> list[Entries]:
    rise, back = f"{much}", f"-{much}"
    law = {"law": "modified_sine"}
    steps: tuple[Entries, ...] = ({key: rise, **law}, {}, {key: back, **law}, {})
    return [{"angle": "90 deg", **step} for step in steps]


def _oscillating(site: Site) -> Made:
    pivot = site.fresh("P")
    cam = {"follower": "oscillating", **_cam(site), "arm_pivot": pivot, "arm_length": site.length(0.35)}
    yield (
        ("mechanism",),
        {
            f"points.{pivot}": {"x": site.length(0.4), "y": "0 m"},
            f"cams.{site.fresh('C')}": cam | {"sections": _sections("swing", "20 deg")},
        },
    )


def _dyad(site: Site) -> Made:
    joint = site.fresh("J")
    bars = [site.fresh("B"), site.fresh("B", [site.fresh("B")])]
    for moving in site.moving:
        for fixed in site.fixed:
            yield (
                ("mechanism",),
                {
                    f"joints.{joint}": {"x": site.length(0.4), "y": site.length(0.4)},
                    f"bars.{bars[0]}": {"start": moving, "end": joint, "length": site.length(0.5)},
                    f"bars.{bars[1]}": {"start": fixed, "end": joint, "length": site.length(0.4)},
                },
            )


def _bodies(site: Site) -> Made:
    for name in [*(n for n in site.moving if n == site.picked), *site.slides, *site.links, *site.moving]:
        if name not in site.names("bodies"):
            yield ("bodies", name), {"mass": "1 kg"}


def _drive(key: str, entry: Any) -> Callable[[Site], Made]:

    def made(site: Site) -> Made:
        if key not in site.names("drive"):
            yield ("drive", key), entry

    return made


def _gravity(site: Site) -> Made:
    loads = look(site.raw, "loads")
    if all(look(look(loads, name), "kind") != "gravity" for name in site.names("loads")):
        yield ("loads", "gravity"), {"kind": "gravity"}


_MOVING, _LINK, _SLIDE = "a moving point, such as the pin of a crank", "a link", "a slider"
_BOTH = f"{_MOVING}, and a fixed point"
_FORCES = ["100 N", "100 N"]
_NO_MOTOR = "a servo axis without a motor"

KINDS: dict[str, Kind] = {
    "points": Kind(
        "Fixed point",
        "Mechanism",
        "",
        _one("points", "P", lambda site: iter([{"x": site.length(0.5), "y": "0 m"}])),
    ),
    "cranks": Kind(
        "Crank",
        "Mechanism",
        "",
        _one("cranks", "A", lambda site: iter([{"radius": site.length(0.15), "phase": "0 deg"}])),
    ),
    "linear_drivers": Kind(
        "Linear driver",
        "Mechanism",
        "",
        _one("linear_drivers", "D", lambda site: iter([{"law": f"{0.2 * site.size:.2g} * sin(phi)"}])),
    ),
    "sliders": Kind(
        "Rod and slider",
        "Mechanism",
        _MOVING,
        _one("sliders", "S", lambda site: ({"crank": name, "rod": site.length(0.7)} for name in site.moving)),
    ),
    "rockers": Kind("Coupler and rocker", "Mechanism", _BOTH, _one("rockers", "R", _rockers)),
    "slotted_levers": Kind("Slotted lever", "Mechanism", _BOTH, _one("slotted_levers", "L", _slots)),
    "cylinders": Kind("Passive cylinder", "Mechanism", _BOTH, _one("cylinders", "Z", _cylinders)),
    "driving cylinders": Kind("Boom on a driving cylinder", "Mechanism", "", _lift),
    "crossings": Kind("Pin in two guides", "Mechanism", _LINK, _one("crossings", "X", _crossings)),
    "yokes": Kind(
        "Yoke", "Mechanism", _MOVING, _one("yokes", "Y", lambda site: ({"pin": n} for n in site.moving))
    ),
    "rigid_points": Kind(
        "Point of a link",
        "Mechanism",
        _LINK,
        _one(
            "rigid_points",
            "K",
            lambda site: (
                {"link": name, "along": site.length(0.3), "across": site.length(0.1)} for name in site.links
            ),
        ),
    ),
    "joints": Kind("Joint of two bars", "Mechanism", _BOTH, _dyad),
    "gears": Kind("Gear", "Mechanism", f"{_LINK}, and a fixed point", _one("gears", "G", _gears)),
    "racks": Kind(
        "Rack",
        "Mechanism",
        _LINK,
        _one("racks", "T", lambda site: ({"gear": name, "radius": site.length(0.1)} for name in site.links)),
    ),
    "cables": Kind(
        "Cable",
        "Mechanism",
        _LINK,
        _one(
            "cables",
            "H",
            lambda site: (
                {"link": name, "radius": site.length(0.3), "length": site.length(1)} for name in site.links
            ),
        ),
    ),
    "cams": Kind(
        "Cam, translating follower",
        "Mechanism",
        "",
        _one(
            "cams",
            "C",
            lambda site: iter([{**_cam(site), "sections": _sections("lift", site.length(0.1))}]),
        ),
    ),
    "oscillating cams": Kind("Cam, oscillating follower", "Mechanism", "", _oscillating),
    "bodies": Kind("Body", "Bodies and loads", "something that moves", _bodies),
    "gravity": Kind("Gravity", "Bodies and loads", "", _gravity),
    "dry": Kind(
        "Friction load",
        "Bodies and loads",
        _SLIDE,
        _load("load", _on(lambda site: [*site.slides, *site.links], kind="dry", force="100 N")),
    ),
    "viscous": Kind(
        "Viscous load",
        "Bodies and loads",
        _SLIDE,
        _load("load", _on(lambda site: site.slides, kind="viscous", damping="100 N s/m")),
    ),
    "force": Kind(
        "Constant force",
        "Bodies and loads",
        _SLIDE,
        _load("load", _on(lambda site: [*site.slides, *site.moving], kind="force", force="100 N")),
    ),
    "torque": Kind(
        "Constant torque",
        "Bodies and loads",
        _LINK,
        _load("load", _on(lambda site: site.links, kind="torque", torque="10 N m")),
    ),
    "spring": Kind(
        "Spring",
        "Bodies and loads",
        _BOTH,
        lambda site: _load(
            "load",
            _between(kind="spring", stiffness="1000 N/m", free_length=site.length(0.5)),
        )(site),
    ),
    "damper": Kind(
        "Damper", "Bodies and loads", _BOTH, _load("load", _between(kind="damper", damping="100 N s/m"))
    ),
    "gas_spring": Kind(
        "Gas spring",
        "Bodies and loads",
        _BOTH,
        lambda site: _load(
            "load",
            _between(
                kind="gas_spring",
                force_extended="200 N",
                length_extended=site.length(2),
                length_compressed=site.length(0.05),
                progression=1.3,
            ),
        )(site),
    ),
    "torsional_spring": Kind(
        "Torsional spring",
        "Bodies and loads",
        _LINK,
        _load("load", _on(lambda site: site.links, kind="torsional_spring", stiffness="10 N m/rad")),
    ),
    "torsional_damper": Kind(
        "Torsional damper",
        "Bodies and loads",
        _LINK,
        _load("load", _on(lambda s: s.links, kind="torsional_damper", damping_torsional="1 N m s/rad")),
    ),
    "force_position": Kind(
        "Force over the position",
        "Bodies and loads",
        _SLIDE,
        lambda site: _load(
            "load",
            _on(
                lambda site: site.slides,
                kind="force_position",
                position=[site.length(-1), site.length(2)],
                forward=_FORCES,
            ),
        )(site),
    ),
    "force_angle": Kind(
        "Force over the crank angle",
        "Bodies and loads",
        _SLIDE,
        _load("load", _on(lambda s: s.slides, kind="force_angle", angle=["0 deg", "180 deg"], force=_FORCES)),
    ),
    "torque_angle": Kind(
        "Torque over the crank angle",
        "Bodies and loads",
        "",
        _load(
            "load",
            lambda _: iter(
                [{"kind": "torque_angle", "angle": ["0 deg", "180 deg"], "torque": ["10 N m", "20 N m"]}]
            ),
        ),
    ),
    "torque_speed": Kind(
        "Torque over the speed",
        "Bodies and loads",
        "",
        _load(
            "load",
            lambda _: iter(
                [{"kind": "torque_speed", "speed": ["0 rad/s", "100 rad/s"], "torque": ["0 N m", "50 N m"]}]
            ),
        ),
    ),
    "torque_swing": Kind(
        "Torque over the swing",
        "Bodies and loads",
        _LINK,
        _load(
            "load",
            _on(
                lambda site: site.links,
                kind="torque_swing",
                angle=["-180 deg", "180 deg"],
                forward=["10 N m", "10 N m"],
            ),
        ),
    ),
    "formula": Kind(
        "Load by a formula",
        "Bodies and loads",
        _SLIDE,
        _load("load", _on(lambda site: site.slides, kind="formula", force="100 * sin(phi)")),
    ),
    "motor": Kind(
        "Motor",
        "Drive",
        "",
        _drive("motor", {"kind": "constant_speed", "speed": "10 rad/s"}),
    ),
    "axes": Kind("Servo axis", "Drive", "a crank, linear driver, cylinder or cam without an axis", _axes),
    "servo motor": Kind("Servo motor", "Drive", _NO_MOTOR, _axis_motors(lambda _: iter([_SERVO]))),
    "catalogue servo": Kind(
        "Servo motor of a catalogue",
        "Drive",
        f"{_NO_MOTOR}, and a CSV file of servo motors in the folder",
        _axis_motors(_from_catalogues),
    ),
    "gearbox": Kind("Gearbox", "Drive", "", _drive("gearbox", {"ratio": 10})),
    "flywheel": Kind("Flywheel", "Drive", "", _drive("flywheel", {"inertia": "1 kg m^2", "on": "crank"})),
    "brake": Kind("Brake", "Drive", "", _drive("brake", {"torque": "100 N m"})),
}

# How many places for an element are tried.
_TRIES = 40


def menu() -> list[dict[str, str]]:
    """All kinds of elements for the page."""
    return [{"kind": name, "word": kind.word, "group": kind.group} for name, kind in KINDS.items()]


def added(text: str, kind: str, size: float, picked: str, path: str = "") -> str:
    """The text with an element more; an `InputError` that says what it needs.

    `size`: of the drawing [m]; `picked`: point that was picked last, empty for none. In a file that is not
    sound yet the first place is taken.
    """
    if kind not in KINDS:
        raise InputError(f"{kind!r}: expected one of {', '.join(KINDS)}")
    element, site = KINDS[kind], Site.of(text, size, picked, path)
    try:
        loads(text, path=path)
        is_sound = True
    except LinkwrightError:
        # silent: a file that is not sound has its problems beside its entries
        is_sound = False
    why = (
        f"{element.word} needs {element.needs}" if element.needs else f"{element.word}: there is one already"
    )
    for _, (place, entries) in zip(range(_TRIES), element.made(site), strict=False):
        parts = entries if len(place) < 2 else {"": entries}
        head = join(place) if place else ""
        new = changed(text, {".".join(filter(None, (head, key))): e for key, e in parts.items()})
        if not is_sound:
            return new
        try:
            loads(new, path=path)
        except LinkwrightError as error:
            why = f"{element.word} was not added: {error}"
            continue
        return new
    raise InputError(why)


class End(NamedTuple):
    """Where a link that was drawn begins or ends: a point of the drawing, or a place in the plane [m]."""

    x: float
    y: float
    point: str = ""


def drawn(
    text: str, links: Sequence[Sequence[Any]], angle: float, pixel: float, path: str = ""
) -> tuple[str, str]:
    """The text with links that were drawn, and words where they wait for further ones.

    `links`: both ends of each, and its kind, ``link``, ``driving`` or ``passive`` cylinder; `angle`: of the
    crank in the drawing [rad]; `pixel`: size of one [m]. Raises a `LinkwrightError` if they make no machine.
    """
    drawing = _Drawing(Site.of(text, 1.0), angle, pixel)
    for start, end, *kind in links:
        drawing.link(start, end, *kind)
    if waiting := drawing.waiting():
        return text, f"{waiting} has one link: draw a second from it"
    new = changed(text, drawing.entries)
    loads(new, path=path)
    return new, ""


class _Drawing:
    """Links that were drawn one after another."""

    def __init__(self, site: Site, angle: float, pixel: float) -> None:
        self.site, self.angle = site, angle
        self.step = 10.0 ** math.floor(math.log10(pixel))
        self.entries: Entries = {}
        self.names: list[str] = []
        self.places: dict[tuple[float, float], str] = {}  # of what is new
        self.held: dict[str, int] = {}  # new joint → links that hold it
        self.is_driven = bool(site.topology.drivers)

    def link(self, start: End, end: End, kind: str = "link") -> None:
        first = start.point or self.places.get((start.x, start.y)) or self._fixed(start)
        known = end.point or self.places.get((end.x, end.y))
        size = self._round(math.hypot(end.x - start.x, end.y - start.y))
        length = self.site.metres(size, 12)
        if kind == "passive":
            second = known or self._fixed(end)
            self._put("cylinders", self._name("Z"), {"start": first, "end": second, "damping": "1000 N s/m"})
            return
        if kind == "link" and not self.is_driven and not known and self._is_fixed(first):
            self.is_driven = True
            name = self._name("A", end)
            phase = math.degrees(math.atan2(end.y - start.y, end.x - start.x) - self.angle)
            pivot = {} if first == ORIGIN else {"pivot": first}
            self._put("cranks", name, {**pivot, "radius": length, "phase": f"{phase:.1f} deg"})
            return
        second = known or (self._fixed(end) if self.held.get(first) == 1 else self._joint(end))
        for name in (first, second):
            if name in self.held:
                self.held[name] += 1
        if kind == "driving":
            self.is_driven = True
            self._put("cylinders", self._name("Z"), _driving(self.site, first, second, size, self.angle))
            return
        self._put("bars", self._name("B"), {"start": first, "end": second, "length": length})

    def waiting(self) -> str:
        return next((name for name, links in self.held.items() if links < 2), "")

    def _is_fixed(self, name: str) -> bool:
        return name in self.site.topology.fixed_points or join(("mechanism", "points", name)) in self.entries

    def _fixed(self, at: End) -> str:
        name = self._name("P", at)
        self._put("points", name, self._place(at))
        return name

    def _joint(self, at: End) -> str:
        name = self._name("J", at)
        self.held[name] = 0
        self._put("joints", name, self._place(at))
        return name

    def _place(self, at: End) -> Entries:
        return {axis: self.site.metres(self._round(getattr(at, axis)), 12) for axis in ("x", "y")}

    def _name(self, head: str, at: End | None = None) -> str:
        name = self.site.fresh(head, self.names)
        self.names.append(name)
        if at is not None:
            self.places[at.x, at.y] = name
        return name

    def _put(self, table: str, name: str, entries: Entries) -> None:
        self.entries[join(("mechanism", table, name))] = entries

    def _round(self, value: float) -> float:
        return round(value / self.step) * self.step
