"""The cam as a solid in a STEP file (AP214, millimetres): its profile extruded by its width, by Open CASCADE.

The kernel is the extra ``step``. The profile is a spline there: arcs as flat as
those beside an inflection are known to the kernel by angles of 1e-9 rad only, which is too coarse.

Source: ISO 10303-214; Open CASCADE Technology, *STEP Translator*.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path as File
from typing import Any

import numpy as np

from linkwright.cam.manufacture.fit import FileOutline
from linkwright.cam.manufacture.spline import EvaluatedSpline, Spline
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import ExchangeError
from linkwright.kernel.files.step import filled, kernel, prism, wire_of, write_solid

# How far above its plane the kernel may put the lower face [mm].
_PLANE = 1e-6


def write_step(file: File, name: str, path: Spline, width: float) -> None:
    """Write a solid as STEP. ``width``: its width [m]."""
    write_solid(file, name, prism(file, wire_of(file, [_edge(path)]), width))


def _edge(path: Spline) -> Any:
    gp, arrays = kernel("gp"), kernel("collections")
    cuts, repeated = np.unique(path.knots, return_counts=True)
    poles = [gp.gp_Pnt(x, y, 0) for x, y in (1e3 * path.controls).tolist()]
    curve = kernel("Geom").Geom_BSplineCurve(
        filled(arrays.Array1_gp_Pnt, poles),
        filled(arrays.Array1_double, cuts.tolist()),
        filled(arrays.Array1_int, repeated.tolist()),
        path.degree,
    )
    return kernel("BRepBuilderAPI").BRepBuilderAPI_MakeEdge(curve).Edge()


def read_step(file: File, sense: int) -> FileOutline:
    """Read the outline of a solid from a STEP file: that of its lower face."""
    reader = kernel("STEPControl").STEPControl_Reader()
    done = kernel("IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone
    if reader.ReadFile(str(file)) != done or not reader.TransferRoots():
        raise ExchangeError(f"{file}: is not a STEP file that can be read")
    pieces = [piece for wire in _lower_wires(reader.OneShape()) for piece in _pieces(wire)]
    if not pieces:
        raise ExchangeError(f"{file}: holds no solid with a face on the plane z = 0")
    corners = np.array([values(low)[0] for values, low, _ in pieces])
    x, y = corners.T
    if sense * float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) < 0:
        pieces = [(values, high, low) for values, low, high in reversed(pieces)]

    def evaluate(parameter: Floats) -> tuple[Floats, Floats]:
        """Places and first derivatives along the pieces [m]."""
        index = np.minimum(parameter.astype(int), len(pieces) - 1).ravel()
        values = [_at(pieces[i], u) for i, u in zip(index, parameter.ravel() - index, strict=True)]
        place, slope = np.array(values).transpose(1, 0, 2)
        return place.reshape(*parameter.shape, 2), slope.reshape(*parameter.shape, 2)

    return FileOutline(EvaluatedSpline(np.arange(len(pieces) + 1.0), evaluate), "solid")


def _at(piece: tuple[Any, float, float], u: float) -> tuple[Floats, Floats]:
    """Place and first derivative at a share of a piece."""
    values, low, high = piece
    place, slope = values(low + u * (high - low))
    return place, (high - low) * slope


def _lower_wires(shape: Any) -> Iterator[Any]:
    """Outer wires of the faces whose corners all lie on z = 0."""
    top, topology = kernel("TopAbs").TopAbs_ShapeEnum, kernel("TopoDS").TopoDS
    explorer = kernel("TopExp").TopExp_Explorer
    faces = explorer(shape, top.TopAbs_FACE)
    while faces.More():
        face = topology.Face(faces.Current())
        corners = explorer(face, top.TopAbs_VERTEX)
        heights = []
        while corners.More():
            heights.append(kernel("BRep").BRep_Tool.Pnt_s(topology.Vertex(corners.Current())).Z())
            corners.Next()
        if max(map(abs, heights)) < _PLANE:
            yield kernel("BRepTools").BRepTools.OuterWire_s(face)
        faces.Next()


def _pieces(wire: Any) -> Iterator[tuple[Any, float, float]]:
    """Pieces in order: what evaluates them, and the parameter at both ends; a spline's run between knots."""
    explorer = kernel("BRepTools").BRepTools_WireExplorer(wire)
    reversed_ = kernel("TopAbs").TopAbs_Orientation.TopAbs_REVERSED
    spline = kernel("GeomAbs").GeomAbs_CurveType.GeomAbs_BSplineCurve
    while explorer.More():
        edge = explorer.Current()
        curve = kernel("BRepAdaptor").BRepAdaptor_Curve(edge)
        ends = [curve.FirstParameter(), curve.LastParameter()]
        if curve.GetType() == spline:
            shape = curve.BSpline()
            ends = [shape.Knot(i) for i in range(1, shape.NbKnots() + 1)]
        if explorer.Orientation() == reversed_:
            ends.reverse()
        for low, high in pairwise(ends):
            yield _evaluator(curve), low, high
        explorer.Next()


def _evaluator(curve: Any) -> Any:
    """From a parameter to place and first derivative [m]."""
    gp = kernel("gp")

    def values(x: float) -> tuple[Floats, Floats]:
        """Place and slope at x [m]."""
        point, vector = gp.gp_Pnt(), gp.gp_Vec()
        curve.D1(x, point, vector)
        return 1e-3 * np.array([point.X(), point.Y()]), 1e-3 * np.array([vector.X(), vector.Y()])

    return values
