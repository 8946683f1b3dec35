"""The solid of a plate as STEP, in the axes of its link: exact lines, arcs and splines, in millimetres."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.step import filled, kernel, prism, solid_bytes, wire_of
from linkwright.outlines.model.curves import Arc, Curve, Line
from linkwright.outlines.model.loops import Loop
from linkwright.outlines.model.section import Section

# In messages of Open CASCADE's faults.
_NAME = Path("STEP")


def plate_bytes(name: str, section: Section, thickness: float) -> bytes:
    """A plate as the content of a STEP file; z = 0 is its middle plane.

    Raises InputError: Open CASCADE is not installed; ExchangeError: it does not make or write the solid.
    """
    return solid_bytes(name, plate_solid(section, thickness))


def plate_solid(section: Section, thickness: float) -> Any:
    """The solid of a plate in the axes of its link [mm]."""
    edges = _Edges(section, -500.0 * thickness)
    outer, *holes = (wire_of(_NAME, edges.of(loop)) for loop in section.region.loops)
    # A hole runs the other way round than the outline.
    signs = [loop.integrals(np.zeros(2))[0][0] for loop in section.region.loops]
    turned = [
        hole.Reversed() if sign * signs[0] > 0 else hole for hole, sign in zip(holes, signs[1:], strict=True)
    ]
    topology = kernel("TopoDS").TopoDS
    return prism(_NAME, outer, thickness, [topology.Wire(hole) for hole in turned])


@dataclass
class _Edges:
    """Edges of loops in the axes of a link, at one height [mm]."""

    section: Section
    height: float

    def of(self, loop: Loop) -> list[Any]:
        """The edges of a loop, one after the other."""
        make, made = kernel("BRepBuilderAPI").BRepBuilderAPI_MakeEdge, []
        for curve, is_reversed in loop.sides:
            for edge in self._edges(curve, make):
                made.append((edge, is_reversed))
        topology = kernel("TopoDS").TopoDS
        return [topology.Edge(edge.Reversed()) if back else edge for edge, back in made]

    def _edges(self, curve: Curve, make: Any) -> list[Any]:
        if isinstance(curve, Line):
            return [make(*self._points(np.array([curve.start, curve.end]))).Edge()]
        if isinstance(curve, Arc):
            return [self._arc(curve, make)]
        arrays = kernel("collections")
        low, high = curve.domain
        cuts, repeated = np.unique(curve.knots, return_counts=True)
        shape = kernel("Geom").Geom_BSplineCurve(
            filled(arrays.Array1_gp_Pnt, self._points(curve.controls)),
            filled(arrays.Array1_double, curve.weights.tolist()),
            filled(arrays.Array1_double, cuts.tolist()),
            filled(arrays.Array1_int, repeated.tolist()),
            curve.degree,
        )
        return [make(shape, low, high).Edge()]

    def _arc(self, arc: Arc, make: Any) -> Any:
        """An arc: from its larger semi-axis on, about z if b is left of a, about −z otherwise."""
        gp = kernel("gp")
        major, minor, first = arc.a, arc.b, arc.first
        if math.hypot(*minor) > math.hypot(*major):
            # a cos t + b sin t = b cos(t − 90°) − a sin(t − 90°)
            major, minor, first = arc.b, -arc.a, first - 0.5 * math.pi
        # In the drawing; the axes of the link are a rotation of it.
        sense = math.copysign(1.0, major[0] * minor[1] - major[1] * minor[0])
        (centre,) = self._points(arc.centre[None])
        direction = self.section.in_link((arc.centre + major)[None]) - self.section.in_link(arc.centre[None])
        axes = gp.gp_Ax2(centre, gp.gp_Dir(0, 0, sense), gp.gp_Dir(*direction[0].tolist(), 0))
        large, small = (1e3 * self.section.scale * math.hypot(*axis) for axis in (major, minor))
        shape = gp.gp_Circ(axes, large) if arc.radius is not None else gp.gp_Elips(axes, large, small)
        if arc.is_closed:
            return make(shape).Edge()
        low, high = sorted((first, first + arc.sweep))
        edge = make(shape, low, high).Edge()
        return kernel("TopoDS").TopoDS.Edge(edge.Reversed()) if arc.sweep < 0 else edge

    def _points(self, places: Floats) -> list[Any]:
        gp = kernel("gp")
        return [gp.gp_Pnt(x, y, self.height) for x, y in (1e3 * self.section.in_link(places)).tolist()]
