"""Drawings as DXF (AutoCAD 2010), in millimetres.

An outline of arcs or chords is one closed LWPOLYLINE with bulges, a spline one closed SPLINE. Numbers are
written so that they read back exactly.

Source: Autodesk, *DXF Reference* (2012): LWPOLYLINE, SPLINE, $INSUNITS.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.cam.manufacture.drawing import CENTRE, CUTTER_PATH, PITCH_CURVE, TEXT, ZERO_ANGLE, Drawing
from linkwright.cam.manufacture.fit import FileOutline
from linkwright.cam.manufacture.outline import Outline
from linkwright.cam.manufacture.spline import EvaluatedSpline, Spline
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ExchangeError
from linkwright.kernel.files import dxf

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.layout import Modelspace
    from ezdxf.math import BSpline

# AutoCAD 2010: the oldest format with all that is used here that programs still agree on.
_VERSION = "R2010"

# Code of the millimetre in $INSUNITS.
_MILLIMETRE = 4

# AutoCAD's colour numbers; other layers are black or white.
_COLOURS = {PITCH_CURVE: 3, CUTTER_PATH: 1, CENTRE: 5, ZERO_ANGLE: 6, TEXT: 8}
_PLAIN = 7

# Height of letters over the largest radius.
_LETTERS = 0.05

# Ends closer than this share of their distance from the centre meet: the rounding of an evaluation.
_CLOSED = 1e-14


def new_document() -> Document:
    """An empty drawing in millimetres."""
    document = dxf.new_document(_VERSION, units=_MILLIMETRE)
    document.header["$MEASUREMENT"] = 1
    return document


def write_dxf(
    file: File, drawing: Drawing, paths: Mapping[str, Outline | Spline], notes: tuple[str, ...] = ()
) -> None:
    """Write a drawing as DXF."""
    document = new_document()
    space = document.modelspace()
    for layer, path in paths.items():
        _add_layer(document, layer)
        _add_outline(space, path, layer)
    _add_marks(document, drawing)
    _add_notes(document, drawing, notes)
    document.set_modelspace_vport(height=3000 * drawing.radius, center=(0, 0))
    document.saveas(file)


def _add_layer(document: Document, name: str) -> None:
    document.layers.add(name, color=_COLOURS.get(name, _PLAIN))


def _add_outline(space: Modelspace, path: Outline | Spline, layer: str) -> None:
    attributes = {"layer": layer}
    if isinstance(path, Outline):
        rows = np.column_stack([1e3 * path.vertices, path.bulges]).tolist()
        space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs=attributes)
        return
    spline = space.add_spline(degree=path.degree, dxfattribs=attributes)
    spline.control_points = [(x, y, 0.0) for x, y in (1e3 * path.controls).tolist()]
    spline.knots = path.knots.tolist()
    spline.closed = True


def _add_marks(document: Document, drawing: Drawing) -> None:
    space, half = document.modelspace(), 1e3 * drawing.cross
    _add_layer(document, CENTRE)
    _add_layer(document, ZERO_ANGLE)
    space.add_point((0, 0), dxfattribs={"layer": CENTRE})
    space.add_line((-half, 0), (half, 0), dxfattribs={"layer": CENTRE})
    space.add_line((0, -half), (0, half), dxfattribs={"layer": CENTRE})
    start, end = (1e3 * drawing.mark).tolist()
    space.add_line(start, end, dxfattribs={"layer": ZERO_ANGLE})


def _add_notes(document: Document, drawing: Drawing, notes: tuple[str, ...]) -> None:
    if not notes:
        return
    _add_layer(document, TEXT)
    height = 1e3 * _LETTERS * drawing.radius
    for i, line in enumerate(notes):
        place = (-1e3 * drawing.radius, -1.2e3 * drawing.radius - 1.6 * height * i)
        text = document.modelspace().add_text(line, height=height, dxfattribs={"layer": TEXT})
        text.set_placement(place)


def read_dxf(file: File, layers: tuple[str, ...]) -> dict[str, FileOutline]:
    """Read the outlines of a DXF file."""
    from ezdxf.lldxf.const import DXFError

    try:
        document = dxf.read_document(file)
    except (OSError, DXFError) as error:
        raise ExchangeError(f"{file}: is not a DXF file that can be read ({error})") from None
    faults = document.audit().errors
    if faults:
        raise ExchangeError(f"{file}: {len(faults)} faults, the first: {faults[0].message}")
    if document.units != _MILLIMETRE:
        raise ExchangeError(f"{file}: $INSUNITS is {document.units}, expected {_MILLIMETRE} (millimetres)")
    return {layer: _outline_of(file, document, layer) for layer in layers}


def _outline_of(file: File, document: Document, layer: str) -> FileOutline:
    entities: list[Any] = [entity for entity in document.modelspace() if entity.dxf.layer == layer]
    kinds = [entity.dxftype() for entity in entities]
    if kinds not in (["LWPOLYLINE"], ["SPLINE"]):
        there = ", ".join(kinds) or "nothing"
        raise ExchangeError(f"{file}: layer {layer} holds {there}, expected one LWPOLYLINE or SPLINE")
    entity = entities[0]
    if not entity.closed:
        raise ExchangeError(f"{file}: the {kinds[0]} of layer {layer} is not marked as closed")
    if kinds[0] == "SPLINE":
        return FileOutline(_spline_of(file, entity.construction_tool(), layer), "SPLINE")
    rows = np.array(entity.get_points("xyb"))
    return FileOutline(Outline(1e-3 * rows[:, :2], rows[:, 2]), "LWPOLYLINE")


def _spline_of(file: File, tool: BSpline, layer: str) -> EvaluatedSpline:

    def values(x: Floats) -> tuple[Floats, Floats]:
        """Places and first derivatives [m]."""
        places_slopes = np.array(
            [[(p.x, p.y) for p in pair] for pair in tool.derivatives(x.ravel().tolist(), 1)]
        )
        return 1e-3 * places_slopes[:, 0].reshape(*x.shape, 2), 1e-3 * places_slopes[:, 1].reshape(
            *x.shape, 2
        )

    cuts = np.unique(tool.knots())
    ends, _ = values(cuts[[0, -1]])
    gap = float(np.linalg.norm(ends[1] - ends[0]))
    if gap > _CLOSED * float(np.linalg.norm(ends[0])):
        raise ExchangeError(f"{file}: the ends of the SPLINE of layer {layer} are {1e3 * gap:.3g} mm apart")
    return EvaluatedSpline(cuts, values)
