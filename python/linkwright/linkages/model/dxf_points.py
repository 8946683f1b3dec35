"""Points of a drawing from a DXF file: a layer with the name of a point has it as a point or a circle.

Circles about one centre are one point, as pins are drawn; dimensions, lines and other layers are passed over.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.kernel.errors import MachineFileError, Problem, UnitError
from linkwright.kernel.files.dxf import read_document
from linkwright.kernel.files.named_file import named_file
from linkwright.kernel.files.text_file import TextError, data_of
from linkwright.kernel.limits import POINT_BYTES
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.reading import parse

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

# Places within this share of the drawing's size are one.
_SAME = 1e-6

# Units of $INSUNITS that drawings are in [m]; DXF Reference, header variables.
_UNITS = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 13: 1e-6, 14: 1e-1}


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
    drawn, code = _read(path)
    size = _unit(code, unit, path)
    places: dict[str, list[tuple[float, float]]] = {}
    for layer, place in drawn:
        places.setdefault(layer, []).append(place)
    if not places:
        raise _wrong(
            path, "no point, circle or arc", "a layer for each point, with a point or a circle in it"
        )
    reach = max(math.hypot(*place) for group in places.values() for place in group) or 1.0
    apart = {layer: list(_apart(group, _SAME * reach)) for layer, group in places.items()}
    if all(len(group) > 1 for group in apart.values()):
        listed = ", ".join(places)
        raise _wrong(path, f"several places in each of the layers {listed}", "one point in a layer")
    return Layers({layer: [[x * size, y * size] for x, y in group] for layer, group in apart.items()})


def _apart(group: list[tuple[float, float]], same: float) -> Iterator[tuple[float, float]]:
    yield group[0]
    yield from (place for place in group if math.dist(place, group[0]) > same)


def _read(path: Path) -> tuple[list[tuple[str, tuple[float, float]]], int]:
    """Layers with their places, and the code of the unit; ezdxf raises any error for a damaged file."""
    try:
        data_of(path, POINT_BYTES)
    except TextError as error:
        raise _wrong(path, error.found, error.expected or "a DXF file", error.remedy) from None
    try:
        document = read_document(path)
        return list(_drawn(document)), int(document.header.get("$INSUNITS", 0))
    except Exception as error:
        words = " ".join(str(error).split()) or type(error).__name__
        raise _wrong(path, f"a file that cannot be read as DXF ({words})", "a DXF file") from None


def _drawn(document: Document) -> Iterator[tuple[str, tuple[float, float]]]:
    for entity in document.modelspace().query("POINT CIRCLE ARC INSERT"):
        place = entity.dxf.location if entity.dxftype() == "POINT" else None
        if place is None:
            place = entity.dxf.insert if entity.dxftype() == "INSERT" else entity.dxf.center
        yield entity.dxf.layer, (float(place.x), float(place.y))


def _unit(code: int, unit: Any, path: Path) -> float:
    """Length of a unit of the drawing [m]."""
    if unit is not None:
        try:
            return parse(unit, LENGTH)
        except UnitError as error:
            found, expected = error.problem.found, 'the length of a unit of the drawing, such as "1 mm"'
            raise MachineFileError([Problem("drawing.unit", found, expected, error.problem.remedy)]) from None
    known = _UNITS.get(code)
    if known is None:
        raise _wrong(
            path, "a drawing that does not say its unit ($INSUNITS)", 'an entry unit = "1 mm" beside it'
        )
    return known


def _wrong(path: Path, found: str, expected: str, remedy: str = "") -> MachineFileError:
    return MachineFileError([Problem("drawing.file", found, expected, remedy, str(path))])
