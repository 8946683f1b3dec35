"""Bodies: the masses on the links and on the points of a mechanism.

| on | given | is |
| --- | --- | --- |
| a link | `mass_per_length` | a uniform rod as long as the link |
| a link | `mass` | a uniform slender rod, centre of mass in the middle, m l²/12 about it |
| a link | `mass`, `inertia` | centre of mass in the middle, `inertia` about it |
| a link | `mass`, `inertia`, `along`, `across` | centre of mass there, `inertia` about it |
| a link | `inertia` | a disc without mass |
| a link | `plate` | cut from a plate by its outline, which gives mass, place and inertia |
| a point or a slider | `mass` | a point mass, or a body that does not turn |

The name of a crank means its link; a mass at its pin has `along` equal to the radius and `inertia` zero.
"""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Self

from pydantic import BaseModel, Field, model_validator
from pydantic_core import InitErrorDetails

from linkwright.kernel.description.base import CheckedDescription, fault, suggestion
from linkwright.kernel.description.place import keys, look
from linkwright.kernel.units.kinds import INERTIA, MASS, MASS_PER_LENGTH
from linkwright.kernel.units.marks import Length, not_negative
from linkwright.kinetostatics.model.plate import Plate
from linkwright.linkages.model.topology import Topology

# What a plate gives.
_OF_PLATE = ("mass", "inertia", "along", "across")


class Body(CheckedDescription):
    """A mass on a link or on a point."""

    on: str | None = Field(None, description="Link or moving point that carries it. Default: its own name.")
    mass: Annotated[float, not_negative(MASS)] | None = Field(None, description="Mass of the body.")
    mass_per_length: Annotated[float, not_negative(MASS_PER_LENGTH)] | None = Field(
        None, description="Mass per length of a uniform rod of the length of the link."
    )
    inertia: Annotated[float, not_negative(INERTIA)] | None = Field(
        None,
        description="Moment of inertia about the centre of mass. Default: that of a uniform slender rod.",
    )
    along: Length | None = Field(
        None,
        description="Position of the centre of mass along the link, from its start. Default: the middle.",
    )
    across: Length = Field(
        0.0, description="Position of the centre of mass across the link, positive to the left."
    )
    axial: Length = Field(
        0.0,
        description="Position along the axis of the crankshaft, positive towards an observer who sees "
        "counter-clockwise rotation; for the shaking couple.",
    )
    plate: Plate | None = Field(
        None, description="Link cut from a plate: its outline gives mass, centre and moment of inertia."
    )

    @model_validator(mode="after")
    def _complete(self) -> Self:
        self._fill()
        return self

    def with_entries(self, entries: Mapping[str, Any]) -> Self:
        """Copy with some entries exchanged, unchecked; what follows from a plate is computed anew."""
        copy = super().with_entries(entries)
        copy._fill()
        return copy

    def _fill(self) -> None:
        """Mass, inertia and place of a plate."""
        for name in _OF_PLATE if self.plate is not None else ():
            if name not in self.model_fields_set:
                # The model is frozen for its users; these entries are part of making it.
                object.__setattr__(self, name, getattr(self.plate, name))

    def _faults(self) -> Iterator[InitErrorDetails]:
        if self.plate is not None:
            for name in ("mass_per_length", *_OF_PLATE):
                if name in self.model_fields_set and getattr(self, name) is not None:
                    yield fault(
                        name,
                        found=getattr(self, name),
                        expected=f"either plate or {name}",
                        remedy="a plate gives mass, centre and moment of inertia",
                    )
        elif self.mass_per_length is not None:
            yield from self._uniform_faults()
        elif self.mass is None and self.inertia is None:
            yield fault(expected="mass, mass_per_length, inertia or plate")
        elif self._centre_given() and self.mass is None:
            yield fault("mass", expected="a mass, because the place of its centre is given")
        elif self._centre_given() and self.inertia is None:
            yield fault(
                "inertia",
                expected="the inertia about the centre of mass, because the place of the centre is given",
                remedy="write inertia = 0 for a point mass",
            )

    def _uniform_faults(self) -> Iterator[InitErrorDetails]:
        for name in ("mass", "inertia", "along", "across"):
            if name in self.model_fields_set and getattr(self, name) is not None:
                expected = f"either mass_per_length or {name}"
                remedy = "mass_per_length means a uniform rod, which fixes the rest"
                yield fault(name, found=getattr(self, name), expected=expected, remedy=remedy)

    def _centre_given(self) -> bool:
        return self.along is not None or "across" in self.model_fields_set


def body_faults(topology: Topology, bodies: object) -> Iterator[InitErrorDetails]:
    """Bodies on nothing or on the frame; entries on a point that only a link can have."""
    for name in keys(bodies):
        body = look(bodies, name)
        on = look(body, "on")
        place = ("bodies", name) if on is None else ("bodies", name, "on")
        carrier = name if on is None else on
        if not isinstance(carrier, str) or not isinstance(body, BaseModel | Mapping):
            continue
        if carrier not in topology.links and carrier not in topology.moving_points:
            yield _on_nothing(topology, carrier, place)
        elif carrier not in topology.links:
            yield from _point_faults(name, carrier, body, topology)


def _on_nothing(topology: Topology, carrier: str, place: tuple[str, ...]) -> InitErrorDetails:
    if carrier in topology.fixed_points:
        remedy = f'"{carrier}" is a fixed point: a mass at rest has no effect'
        return fault(*place, found=carrier, expected="the name of a link or a moving point", remedy=remedy)
    known = dict.fromkeys([*topology.links, *topology.moving_points])
    expected = "the name of a link or a moving point" + ("" if place[-1] == "on" else ", or an entry on")
    return fault(*place, found=carrier, expected=expected, remedy=suggestion(carrier, known))


def _point_faults(name: str, carrier: str, body: object, topology: Topology) -> Iterator[InitErrorDetails]:
    links = [link for link, element in topology.links.items() if element == carrier]
    remedy = f'"{carrier}" is a point' + (f'; the link is "{links[0]}"' if links else "")
    has_plate = look(body, "plate") is not None
    for key in ("plate",) if has_plate else ("mass_per_length", "inertia", "along", "across"):
        value = look(body, key)
        given = key in keys(body) and value not in (None, 0.0) if key == "across" else value is not None
        if given:
            yield fault("bodies", name, key, found=value, expected="only a mass on a point", remedy=remedy)
