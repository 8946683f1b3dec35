"""Curves of a DXF file: what is drawn on some of its layers.

| entity | becomes |
| --- | --- |
| LINE | a line |
| ARC, CIRCLE | an arc of a circle |
| ELLIPSE | an arc of an ellipse |
| LWPOLYLINE, POLYLINE | lines and arcs by their bulges |
| SPLINE | a rational B-spline |
| INSERT | what its block draws |

Texts, dimensions, hatches, points and construction lines are passed over; any other entity is refused.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.dxf import DrawingError, unit_of
from linkwright.outlines.model.curves import Arc, Curve, Line, Spline, bulged, circular

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

# What a drawing has besides outlines.
_IGNORED = frozenset(
    (
        *("ATTDEF", "ATTRIB", "HATCH", "IMAGE", "LEADER", "MLEADER", "MTEXT", "MULTILEADER", "OLE2FRAME"),
        *(
            "ACAD_TABLE",
            "ARC_DIMENSION",
            "DIMENSION",
            "INSERT",
            "LARGE_RADIAL_DIMENSION",
            "POINT",
            "RAY",
            "TEXT",
        ),
        *("TOLERANCE", "UNDERLAY", "VIEWPORT", "WIPEOUT", "XLINE"),
    )
)

# Curves that an outline may have, entities of a drawing and its blocks, and blocks inside one another.
_CURVES_MOST, _ENTITIES_MOST, _DEPTH_MOST = 10_000, 100_000, 8

# Mark of the vertices of the frame of a smoothed polyline, which lie beside its curve; DXF Reference, VERTEX.
_OF_FRAME = 16

Drawn = tuple[str, Curve]


def curves_of(document: Document, layers: Collection[str], unit: Any, key: str) -> tuple[list[Curve], float]:
    """The curves on some layers, all without names, and the length of a unit of the drawing [m].

    `unit`: the unit beside the entry `key` that names the file; None without it. Raises DrawingError: the
    layers have no curves, or something that is no plane curve.
    """
    size = unit_of(document, unit, key)
    drawn = list(_drawn(document, {name.casefold() for name in layers}))
    there = list(dict.fromkeys(layer for layer, _ in drawn))
    if not drawn:
        listed = ", ".join(sorted({layer.dxf.name for layer in document.layers}))
        found = "no curve" + (f" on the layers {', '.join(layers)}" if layers else "")
        raise DrawingError(found, "the outline of a link", f"the layers of the drawing are {listed}")
    if not layers and len(there) > 1:
        found = f"curves on the layers {', '.join(there)}"
        raise DrawingError(
            found, "curves on one layer", f'name those of the outline: layers = ["{there[0]}"]'
        )
    return [curve for _, curve in drawn], size


def _drawn(document: Document, layers: Collection[str]) -> Iterator[Drawn]:
    """Curves with their layers, of those layers that are wanted."""
    count = 0
    for nth, (layer, entity) in enumerate(_entities(document.modelspace(), "0", 0)):
        if nth >= _ENTITIES_MOST:
            raise DrawingError(f"more than {_ENTITIES_MOST} entities", "a drawing of fewer entities")
        kind = entity.dxftype()
        if kind in _IGNORED or (layers and layer.casefold() not in layers):
            continue
        if kind not in _READERS:
            found = f"{kind} on the layer {layer}"
            raise DrawingError(found, "lines, arcs, circles, ellipses, polylines, splines", "explode it")
        for curve in _READERS[kind](entity):
            count += 1
            if count > _CURVES_MOST:
                raise DrawingError(f"more than {_CURVES_MOST} curves", "an outline of fewer curves")
            yield layer, curve


def _entities(container: Any, layer: str, depth: int) -> Iterator[tuple[str, Any]]:
    """Layers and entities of a drawing, with those of its blocks in place."""
    for entity in container:
        # In a block, layer 0 means that of its reference.
        own = layer if entity.dxf.layer == "0" else entity.dxf.layer
        # A reference itself is passed over; it counts as the entity that it is.
        yield own, entity
        if entity.dxftype() != "INSERT":
            continue
        if depth >= _DEPTH_MOST:
            found = f"more than {_DEPTH_MOST} blocks inside one another"
            raise DrawingError(found, "blocks that are not inside themselves", "explode them")
        # A block may be repeated in rows and columns.
        for each in entity.multi_insert() if entity.mcount > 1 else (entity,):
            yield from _entities(each.virtual_entities(), own, depth + 1)


def _mirror(entity: Any) -> float:
    """−1 for what is drawn in a plane seen from behind, 1 otherwise. Raises DrawingError: it is inclined."""
    x, y, z = entity.dxf.extrusion if entity.dxf.hasattr("extrusion") else (0.0, 0.0, 1.0)
    if max(abs(x), abs(y)) > 1e-9 * abs(z):
        raise _inclined(entity)
    return math.copysign(1.0, z)


def _inclined(entity: Any) -> DrawingError:
    return DrawingError(f"{entity.dxftype()} out of the plane of the drawing", "a plane drawing")


def _require_level(entity: Any, points: Iterable[Any]) -> None:
    """All points of a curve are at one height, which may be any."""
    places = np.array([list(point) for point in points], dtype=float)
    rise, *sides = np.ptp(places[:, ::-1], axis=0)
    if rise > 1e-9 * max(sides):
        raise _inclined(entity)


def _line(entity: Any) -> Iterator[Curve]:
    _require_level(entity, (entity.dxf.start, entity.dxf.end))
    yield Line(_xy(entity.dxf.start), _xy(entity.dxf.end))


def _circle(entity: Any) -> Iterator[Curve]:
    mirror = _mirror(entity)
    first, sweep = 0.0, 2 * math.pi
    if entity.dxftype() == "ARC":
        low, high = entity.dxf.start_angle, entity.dxf.end_angle
        first, sweep = math.radians(low), math.radians((high - low) % 360.0 or 360.0)
    centre = _xy(entity.dxf.center) * (mirror, 1.0)
    yield circular(centre, float(entity.dxf.radius), first, sweep, mirror)


def _ellipse(entity: Any) -> Iterator[Curve]:
    # Centre and major axis are in the plane of the drawing; the minor one turns with its side.
    mirror = _mirror(entity)
    a = _xy(entity.dxf.major_axis)
    b = mirror * float(entity.dxf.ratio) * np.array([-a[1], a[0]])
    low, high = float(entity.dxf.start_param), float(entity.dxf.end_param)
    sweep = (high - low) % (2 * math.pi)
    if sweep <= 1e-12 or 2 * math.pi - sweep <= 1e-12:
        sweep = 2 * math.pi
    yield Arc(_xy(entity.dxf.center), a, b, low, sweep)


def _polyline(entity: Any) -> Iterator[Curve]:
    mirror = _mirror(entity)
    if entity.dxftype() == "LWPOLYLINE":
        vertices = [(float(x), float(y), float(bulge)) for x, y, bulge in entity.get_points("xyb")]
    else:
        if not entity.is_2d_polyline and not entity.is_3d_polyline:
            raise DrawingError("a POLYLINE that is a mesh", "plane polylines", "draw the outline alone")
        own = [vertex for vertex in entity.vertices if not vertex.dxf.flags & _OF_FRAME]
        places = [(vertex.dxf.location, vertex.dxf.get("bulge", 0.0)) for vertex in own]
        _require_level(entity, (place for place, _ in places))
        vertices = [(float(place.x), float(place.y), float(bulge)) for place, bulge in places]
    after = [*vertices[1:], *(vertices[:1] if entity.is_closed else [])]
    for (x, y, bulge), (x2, y2, _) in zip(vertices, after, strict=False):
        start, end = np.array([mirror * x, y]), np.array([mirror * x2, y2])
        if (start != end).any():
            yield bulged(start, end, mirror * bulge)


def _spline(entity: Any) -> Iterator[Curve]:
    tool = entity.construction_tool()
    _require_level(entity, tool.control_points)
    controls = np.array([[point.x, point.y] for point in tool.control_points])
    weights = np.array(tool.weights()) if tool.is_rational else np.ones(len(controls))
    yield Spline(tool.order - 1, np.array(tool.knots(), dtype=float), controls, weights)


def _xy(point: Any) -> Floats:
    return np.array([float(point.x), float(point.y)])


_READERS = {
    "LINE": _line,
    "ARC": _circle,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _polyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
}
