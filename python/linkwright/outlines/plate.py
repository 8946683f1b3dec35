r"""Properties of a link by the drawing of its outline.

.. math:: m = \rho\,t\,A, \qquad J = \rho\,t\,I_p

with the area A and its polar second moment I_p about the centre of area, both exact on lines, arcs and
splines by Green's theorem (`linkwright.outlines.model.loops`).
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import DENSITY, LENGTH
from linkwright.kernel.units.marks import positive
from linkwright.outlines.model.section import Section, section_of


@dataclass(frozen=True)
class PlateProperties(Result):
    """Area, mass, centre and moment of inertia of a plate in the axes of its link."""

    area: Annotated[float, Label("area", "A", "m²", "Without holes.", table="plate")]
    along: Annotated[
        float, Label("centre along the link", "x_S", "m", "From the start of the link.", table="plate")
    ]
    across: Annotated[
        float, Label("centre across the link", "y_S", "m", "Positive to the left.", table="plate")
    ]
    second_moment: Annotated[
        float, Label("polar second moment of area", "I_p", "m⁴", "About the centre.", table="plate")
    ]
    distance: Annotated[
        float | None,
        Label("distance of the joints", "l", "m", "None where the end is not given.", table="plate"),
    ]
    mass: Annotated[
        float | None, Label("mass", "m", "kg", "None without thickness and density.", table="plate")
    ]
    inertia: Annotated[
        float | None,
        Label("moment of inertia about the centre of mass", "J_S", "kg m²", table="plate"),
    ]
    accuracy: Annotated[
        float, Label("relative accuracy of the integrals", "", "", "By spans of half the length, and gaps.")
    ]
    holes: Annotated[tuple[str, ...], About("Numbers of the holes, as names.")]
    hole_along: Annotated[Floats, Label("place of a hole along the link", "", "m", shape="(holes,)")]
    hole_across: Annotated[Floats, Label("place of a hole across the link", "", "m", shape="(holes,)")]
    hole_diameter: Annotated[
        Floats, Label("diameter of a hole", "d", "m", "NaN for a hole that is no circle.", shape="(holes,)")
    ]
    section: Annotated[Any, About("The outline and its holes.")]


@public
def outline(
    path: str | os.PathLike[str],
    *,
    layers: Sequence[str] = (),
    unit: float | None = None,
    start: Sequence[float] | None = None,
    end: Sequence[float] | None = None,
    thickness: float | None = None,
    density: float | None = None,
) -> PlateProperties:
    """Area, mass, centre and moment of inertia of a link by the drawing of its outline.

    Parameters
    ----------
    path : path
        DXF file with one closed outline and its holes: lines, arcs, circles, ellipses, polylines, splines.
    layers : sequence of str
        Their layers; without names, the only layer that has curves.
    unit : float, optional
        Unit of the drawing [m]; without it, the one that the drawing states.
    start, end : sequence of float, optional
        Joints of the link in the drawing [m]; without them its origin, and its x axis.
    thickness, density : float, optional
        Of the plate [m], of its material [kg/m³].

    Returns
    -------
    PlateProperties
        In the axes of the link: x from its start to its end, y to the left.

    Raises
    ------
    MachineFileError
        The file cannot be read, or its outline is open, crosses itself, or is not the only one.
    InputError
        A value is out of range, or the end is the start.
    """
    for name, value, kind in (
        ("unit", unit, LENGTH),
        ("thickness", thickness, LENGTH),
        ("density", density, DENSITY),
    ):
        if value is not None:
            in_range(**{name: (value, positive(kind))})
    for name, joint in (("start", start), ("end", end)):
        if joint is not None and (len(joint) != 2 or not np.isfinite(joint).all()):
            raise InputError(f"{name}: found {joint}, expected x and y in metres")
    if end is not None and tuple(end) == ((0.0, 0.0) if start is None else tuple(start)):
        raise InputError("end: found the start of the link, expected a joint apart from it")
    section = section_of(Path(path), "", layers=layers, unit=unit, start=start, end=end)
    weight = None if thickness is None or density is None else thickness * density
    return _properties(section, weight)


def _properties(section: Section, weight: float | None) -> PlateProperties:
    """Of a section; `weight`: mass per area [kg/m²]."""
    holes = section.region.holes
    circles = [hole.circle for hole in holes]
    middles = [
        hole.polygon.mean(axis=0) if circle is None else circle[0]
        for hole, circle in zip(holes, circles, strict=True)
    ]
    places = section.in_link(np.array(middles).reshape(-1, 2))
    diameters = [np.nan if circle is None else 2 * circle[1] * section.scale for circle in circles]
    return PlateProperties(
        area=section.area,
        along=float(section.centre[0]),
        across=float(section.centre[1]),
        second_moment=section.second_moment,
        distance=section.distance,
        mass=None if weight is None else weight * section.area,
        inertia=None if weight is None else weight * section.second_moment,
        accuracy=section.accuracy,
        holes=tuple(str(n) for n in range(1, len(holes) + 1)),
        hole_along=places[:, 0],
        hole_across=places[:, 1],
        hole_diameter=np.array(diameters),
        section=section,
    )
