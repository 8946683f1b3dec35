"""The outline of a link from a DXF file, in the axes of the link, and plates of a machine file by it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.description.place import join
from linkwright.kernel.errors import MachineFileError, Problem, UnitError, show
from linkwright.kernel.files.dxf import read_drawing
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.reading import parse_list
from linkwright.outlines.model.entities import curves_of
from linkwright.outlines.model.loops import closed_loops
from linkwright.outlines.model.region import Region, region_of

# Entries of a plate that say how its drawing is read.
_OF_FILE = ("layers", "unit", "start", "end")

# Share of the size of a section below which a place of its centre is rounding.
_NOTHING = 1e-13


@dataclass(frozen=True)
class Section:
    """An outline with its holes; a point p of the drawing is at R(p·scale − start) in the link's axes."""

    region: Region
    scale: float  # length of a unit of the drawing [m]
    start: Floats  # joint where the link starts, in the drawing, (2,) [m]
    angle: float  # of the link in the drawing [rad]
    distance: float | None  # of the two joints [m]; None where the drawing's x axis is that of the link
    area: float  # [m²]
    centre: Floats  # of the area, in the link's axes, (2,) [m]
    second_moment: float  # polar, about the centre [m⁴]
    accuracy: float  # relative, measured on the integrals

    def in_link(self, places: Floats) -> Floats:
        """Places of the drawing in the axes of the link, (n, 2) [m]."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        own: Floats = (places * self.scale - self.start) @ np.array([[cos, -sin], [sin, cos]])
        return own


def section_of(
    path: Path,
    key: str = "",
    *,
    layers: Sequence[str] = (),
    unit: Any = None,
    start: Sequence[float] | None = None,
    end: Sequence[float] | None = None,
) -> Section:
    """The section of a link by a drawing.

    `key`: the entry that names the file, for messages; `layers`: of the outline and its holes, the only one
    that has curves without names; `unit`: of the drawing, where that does not state it; `start`, `end`:
    joints of the link in the drawing [m]. Raises MachineFileError: the file cannot be read, or what it has is
    no outline.
    """

    def read(document: Any) -> tuple[Region, float, tuple[float, Floats, float, float]]:
        curves, scale = curves_of(document, layers, unit, key)
        region = region_of(closed_loops(curves))
        return region, scale, region.integrals()

    region, scale, (area, centre, moment, accuracy) = read_drawing(path, key, read)
    origin = np.array((0.0, 0.0) if start is None else start)
    chord = np.array([1.0, 0.0]) if end is None else np.array(end) - origin
    section = Section(
        region,
        scale,
        origin,
        math.atan2(chord[1], chord[0]),
        None if end is None else math.hypot(*chord),
        area * scale**2,
        centre,
        moment * scale**4,
        accuracy,
    )
    place = section.in_link(centre)
    # A centre on the line of the link lies there, and not within rounding of it.
    return replace(section, centre=np.where(np.abs(place) > _NOTHING * math.sqrt(section.area), place, 0.0))


def with_plates(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> None:
    """Put area, centre and moment of the outlines that plates name into their tables, in place.

    Entries that the machine file gives go first. Raises MachineFileError: a drawing lies outside, cannot be
    read, or has no outline.
    """
    bodies = tables.get("bodies")
    for name, body in bodies.items() if isinstance(bodies, dict) else ():
        plate = body.get("plate") if isinstance(body, dict) else None
        if isinstance(plate, dict) and isinstance(plate.get("file"), str):
            key = join(("bodies", name, "plate", "file"))
            path = named_file(plate.pop("file"), folder, key, allow_outside=allow_outside)
            given = {entry: plate.pop(entry, None) for entry in _OF_FILE}
            section = section_of(path, key, **_read_entries(given, key))
            found = {
                "area": section.area,
                "second_moment": section.second_moment,
                "along": float(section.centre[0]),
                "across": float(section.centre[1]),
                "distance": section.distance,
            }
            plate.update({entry: value for entry, value in found.items() if value is not None} | plate)


def _read_entries(given: dict[str, Any], key: str) -> dict[str, Any]:
    """What the machine file says of a drawing."""
    beside = key.removesuffix("file")
    layers = given["layers"]
    if layers is not None and not (
        isinstance(layers, list) and layers and all(isinstance(name, str) for name in layers)
    ):
        expected = 'a list of names of layers, such as ["outline", "holes"]'
        raise MachineFileError([Problem(f"{beside}layers", show(layers), expected)])
    joints = {name: _joint(given[name], f"{beside}{name}") for name in ("start", "end")}
    if joints["end"] is not None and joints["end"] == (joints["start"] or (0.0, 0.0)):
        raise MachineFileError([Problem(f"{beside}end", show(given["end"]), "a joint apart from the start")])
    return {"layers": layers or (), "unit": given["unit"], **joints}


def _joint(value: Any, key: str) -> tuple[float, float] | None:
    """x and y of a joint in the drawing [m]; None where it is not given."""
    if value is None:
        return None
    try:
        x, y = parse_list(value, LENGTH)
    except (UnitError, ValueError):
        expected = 'two lengths, x and y, such as "80, 25 mm"'
        raise MachineFileError([Problem(key, show(value), expected)]) from None
    return float(x), float(y)
