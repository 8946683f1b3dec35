"""What is wrong with guides and gears: points of another body, guides and gears that nothing moves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import fault

if TYPE_CHECKING:
    from linkwright.linkages.model.topology import Element, Topology

# Which references of an element are points of each of its links, by the link's ending.
_ENDS: dict[str, dict[str, tuple[str, ...]]] = {
    "cranks": {"": ("pivot",)},
    "cams": {"": ("arm_pivot",)},
    "sliders": {".rod": ("crank",)},
    "rockers": {".coupler": ("crank",), ".rocker": ("pivot",)},
    "slotted_levers": {"": ("pivot",)},
    "gears": {"": ("pivot",)},
    "bars": {"": ("start", "end")},
    "cylinders": {"": ("start",), ".rod": ("end",)},
    "yokes": {"": ()},
}


# Tables of what moves on a guide without turning against it, and so can carry another guide.
_SLIDING = ("linear_drivers", "cams", "racks", "sliders", "yokes")


def guide_faults(topology: Topology) -> Iterator[InitErrorDetails]:
    """Guides through points of another body, crossings at rest, gears that nothing turns."""
    for element in topology.elements:
        for before in [key[: -len("through")] for key in element.kind.references if key.endswith("through")]:
            yield from _through(element, before, topology)
        if element.kind.table == "crossings" and not set(element.references.values()) - set(
            topology.fixed_points
        ):
            remedy = "put a guide on a link that moves"
            yield fault(
                "crossings",
                element.name,
                found="two guides at rest",
                expected="one that moves",
                remedy=remedy,
            )
        if element.kind.table == "gears" and not {"meshes", "carrier"} & set(element.references):
            expected = "the other gear, a carrier, or both"
            remedy = "a gear that meshes with one at rest and has no carrier does not turn"
            yield fault("gears", element.name, "meshes", expected=expected, remedy=remedy)


def _through(element: Element, before: str, topology: Topology) -> Iterator[InitErrorDetails]:
    """A guide on the frame or on what slides goes through its point, one on a link through a point of it."""
    name, on = element.references.get(f"{before}through"), element.references.get(f"{before}on")
    if name is None:
        return
    place = (element.kind.table, element.name, *f"{before}through".split("."))
    if on is None and name not in (*topology.fixed_points, *_sliding(topology)):
        remedy = f'{topology.instead(name)}; a guide that turns is carried by a link: say which with "on"'
        expected = "the name of a fixed point, or of something that slides"
        yield fault(*place, found=name, expected=expected, remedy=remedy)
    elif on is not None and name not in (own := points_of(on, topology)):
        remedy = "there is " + ", ".join(f'"{point}"' for point in own) if own else "leave it out"
        yield fault(*place, found=name, expected=f"the name of a point of {on}", remedy=remedy)


def _sliding(topology: Topology) -> list[str]:
    """Names of what slides without turning: its own guide is on no link."""
    return [
        element.name
        for element in topology.elements
        if element.kind.table in _SLIDING
        and element.kind.slides
        and not any(key.split(".")[-1] == "on" for key in element.references)
    ]


def points_of(link: str, topology: Topology) -> list[str]:
    """Names of the points that a link carries. Returns: its ends first, then the points fixed to it."""
    maker = next(element for element in topology.elements if element.name == topology.links[link])
    ends = [maker.references.get(key, "O") for key in _ENDS[maker.kind.table][link.removeprefix(maker.name)]]
    made = maker.made(maker.kind.points)
    fixed = [element.name for element in topology.elements if element.references.get("link") == link]
    carried = [name for name in fixed if name in topology.names("rigid_points")]
    return [*ends, *made, *carried]
