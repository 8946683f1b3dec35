"""What is wrong between the loads and the mechanism: names that do not exist or are something else."""

from __future__ import annotations

import math
from collections.abc import Iterator

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault, suggestion
from linkwright.kernel.description.cycle import TURNS_MAX
from linkwright.kernel.description.place import keys, look
from linkwright.kinetostatics.model.loads.force import variable_faults
from linkwright.linkages.model.topology import Topology, Wanted

# Loads between two points.
_BETWEEN = ("spring", "damper", "gas_spring")

# Entry of a load → what its carrier must be. A crank is both: its pin and its link.
_ENTRY_WANTS: dict[tuple[str, str], Wanted] = {
    ("dry", "force"): "moving point",
    ("dry", "torque"): "link",
    ("viscous", "damping"): "moving point",
    ("viscous", "damping_torsional"): "link",
    ("force", "force"): "moving point",
    ("torque", "torque"): "link",
    ("formula", "force"): "moving point",
    ("formula", "torque"): "link",
    ("torque_swing", "forward"): "link",
    ("torsional_spring", "stiffness"): "link",
    ("torsional_damper", "damping_torsional"): "link",
}
_BELONGS = {
    ("dry", "moving point"): "force",
    ("dry", "link"): "torque",
    ("viscous", "moving point"): "damping",
    ("viscous", "link"): "damping_torsional",
    ("formula", "moving point"): "force",
    ("formula", "link"): "torque",
}
# Loads that act along a guide.
_GUIDED = ("force_position", "force_angle")

# Entries that name a further link.
_LINKS = ("along", "against")

# Variables of a formula by what it acts on.
_EVERYWHERE = frozenset({"phi", "omega", "t"})
_OF_POINTS = _EVERYWHERE | {"x", "y", "vx", "vy", "v"}
_OF_LINKS = frozenset({"psi", "psi_dot"})


def load_faults(topology: Topology, loads: object) -> Iterator[InitErrorDetails]:
    """What is wrong between the loads, checked or raw, and the mechanism.

    Loads on nothing; entries that do not belong to what the load acts on. As in the errors of pydantic, the
    kind of the load stands in the place, before its key.
    """
    yield from _cycle_faults(loads)
    for name in keys(loads):
        load = look(loads, name)
        kind, on = look(load, "kind"), look(load, "on")
        if kind in _BETWEEN:
            yield from _between_faults(topology, name, kind, look(load, "between"))
        elif not isinstance(on, str) or not isinstance(kind, str):
            continue
        elif kind in _GUIDED:
            yield from _slide_faults(topology, name, kind, on)
        else:
            yield from _carrier_faults(topology, name, load, kind, on)
            yield from _link_faults(topology, name, load, kind, on)
            if kind == "formula":
                yield from _formula_faults(topology, name, load, on)


def _cycle_faults(loads: object) -> Iterator[InitErrorDetails]:
    turns = [(name, getattr(look(loads, name), "turns", 1)) for name in keys(loads)]
    together = math.lcm(*(count for _, count in turns))
    if together > TURNS_MAX:
        name = max(turns, key=lambda load: load[1])[0]
        expected = f"cycles of loads that repeat together after {TURNS_MAX} revolutions or fewer"
        yield fault(
            "loads", name, "cycle", found=f"{together} revolutions with the others", expected=expected
        )


def _between_faults(topology: Topology, name: str, kind: str, between: object) -> Iterator[InitErrorDetails]:
    ends = [end for end in between if isinstance(end, str)] if isinstance(between, list | tuple) else []
    known = topology.candidates("point")
    here = ("loads", name, kind, "between")
    for place, end in enumerate(ends):
        if end not in known:
            expected, remedy = "the name of a point", suggestion(end, known)
            yield fault(*here, place, found=end, expected=expected, remedy=remedy)
    moving = any(end not in topology.fixed_points for end in ends)
    if len(ends) == 2 and (ends[0] == ends[1] or not moving):
        expected = "two points, at least one of them moving"
        yield fault(*here, found=" and ".join(ends), expected=expected)


def _slide_faults(topology: Topology, name: str, kind: str, on: str) -> Iterator[InitErrorDetails]:
    guided = guided_points(topology)
    if on not in guided:
        remedy = topology.instead(on) or suggestion(on, guided)
        place = ("loads", name, kind, "on")
        yield fault(*place, found=on, expected="the name of a point on a guide", remedy=remedy)


def guided_points(topology: Topology) -> list[str]:
    """Points that move along a guide of their own, as those of sliders, yokes and drivers do."""
    single = (name for element in topology.elements for name in element.made(element.kind.points))
    slides = set(topology.slides)
    return [name for name in single if name in slides and name not in topology.names("cables")]


def _carrier_faults(
    topology: Topology, name: str, load: object, kind: str, on: str
) -> Iterator[InitErrorDetails]:
    wants = [(key, want) for (of, key), want in _ENTRY_WANTS.items() if of == kind]
    known = list(dict.fromkeys(candidate for _, want in wants for candidate in topology.candidates(want)))
    if wants and on not in known:
        expected = "the name of a " + " or a ".join(dict.fromkeys(want for _, want in wants))
        remedy = topology.instead(on) or suggestion(on, known)
        yield fault("loads", name, kind, "on", found=on, expected=expected, remedy=remedy)
        return
    for key, want in wants:
        value = look(load, key)
        if value is not None and on not in topology.candidates(want):
            other: Wanted = "link" if want == "moving point" else "moving point"
            expected = _BELONGS.get((kind, other), f"the name of a {want}")
            remedy = f'"{on}" is a {other}: {expected} belongs here'
            yield fault("loads", name, kind, key, found=value, expected=expected, remedy=remedy)


def _link_faults(
    topology: Topology, name: str, load: object, kind: str, on: str
) -> Iterator[InitErrorDetails]:
    for key in _LINKS:
        link = look(load, key)
        if not isinstance(link, str):
            continue
        if link not in topology.candidates("link"):
            yield topology.unknown(link, "link", "loads", name, kind, key)
        elif key == "against" and link == on:
            yield fault("loads", name, kind, key, found=link, expected="another link")


def _formula_faults(topology: Topology, name: str, load: object, on: str) -> Iterator[InitErrorDetails]:
    key = "torque" if look(load, "torque") is not None else "force"
    along, direction = look(load, "along"), look(load, "direction")
    is_slide = on in guided_points(topology) and along is None and direction is None
    is_point = key == "force" and on in topology.moving_points
    if is_point and not is_slide and along is None and direction is None:
        expected = "direction (from the x axis) or along (a link that the force turns with)"
        yield fault("loads", name, "formula", "direction", expected=expected)
    known = _OF_POINTS if key == "force" else _EVERYWHERE
    known |= {"s"} if is_slide else frozenset()
    known |= _OF_LINKS if key == "torque" or along is not None else frozenset()
    what = "a force along a guide" if is_slide else f"a {key} on {on}"
    for entry, expected, remedy in variable_faults(key, look(load, key), known, what):
        target = look(load, entry)
        yield fault("loads", name, "formula", entry, found=target, expected=expected, remedy=remedy)
