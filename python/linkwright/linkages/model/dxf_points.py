"""Points of a drawing from a DXF file: a layer with the name of a point has it as a point or a circle.

Circles about one centre are one point, as pins are drawn; dimensions, lines and other layers are passed over.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.kernel.files.dxf import read_drawing, unit_of, wrong_drawing
from linkwright.kernel.files.named_file import named_file

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

# Places within this share of the drawing's size are one.
_SAME = 1e-6

_KEY = "drawing.file"


class Layers(dict[str, list[list[float]]]):
    """Places in each layer of a DXF file [m], in place of its name."""


def with_dxf_points(tables: dict[str, Any], folder: Path, *, allow_outside: bool = False) -> None:
    """Put the places of the DXF file that a drawing names in place of its name; `tables` is changed.

    Raises MachineFileError: the file lies outside, cannot be read, has no unit, or two places in one layer.
    """
    drawing = tables.get("drawing")
    if not isinstance(drawing, dict) or not isinstance(drawing.get("file"), str):
        return
    path = named_file(drawing["file"], folder, "drawing.file", allow_outside=allow_outside)
    drawing["file"] = _places(path, drawing.pop("unit", None))


def _places(path: Path, unit: Any) -> Layers:
    """Places in each layer [m]; circles about one centre are one."""
    drawn, size = read_drawing(path, _KEY, lambda sheet: (list(_drawn(sheet)), unit_of(sheet, unit, _KEY)))
    places: dict[str, list[tuple[float, float]]] = {}
    for layer, place in drawn:
        places.setdefault(layer, []).append(place)
    if not places:
        raise wrong_drawing(
            path, _KEY, "no point, circle or arc", "a layer for each point, with a point or a circle in it"
        )
    reach = max(math.hypot(*place) for group in places.values() for place in group) or 1.0
    apart = {layer: list(_apart(group, _SAME * reach)) for layer, group in places.items()}
    if all(len(group) > 1 for group in apart.values()):
        listed = ", ".join(places)
        raise wrong_drawing(
            path, _KEY, f"several places in each of the layers {listed}", "one point in a layer"
        )
    return Layers({layer: [[x * size, y * size] for x, y in group] for layer, group in apart.items()})


def _apart(group: list[tuple[float, float]], same: float) -> Iterator[tuple[float, float]]:
    yield group[0]
    yield from (place for place in group if math.dist(place, group[0]) > same)


def _drawn(document: Document) -> Iterator[tuple[str, tuple[float, float]]]:
    for entity in document.modelspace().query("POINT CIRCLE ARC INSERT"):
        place = entity.dxf.location if entity.dxftype() == "POINT" else None
        if place is None:
            place = entity.dxf.insert if entity.dxftype() == "INSERT" else entity.dxf.center
        yield entity.dxf.layer, (float(place.x), float(place.y))
