"""What a cam table holds: points over the master angle, with derivatives where the maker takes them."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.kernel.arrays import Floats


@dataclass(frozen=True)
class CamData:
    """Points, or polynomials between them, over the master angle in degrees."""

    x: Floats  # (n,): master angle [deg], increasing
    y: Floats  # (n,): position [unit of the table]
    v: Floats | None = None  # (n,): first derivative [per deg]
    a: Floats | None = None  # (n,): second derivative [per deg²]
    j: Floats | None = None  # (n,): third derivative [per deg³]
    # Of each of n − 1 polynomials, coefficients of powers of the distance from its start.
    powers: tuple[tuple[float, ...], ...] = ()
    slopes: tuple[float, float] | None = None  # first derivative at both ends, of a spline [per deg]


@dataclass(frozen=True)
class CamTitle:
    """What the text of a table says beside its numbers."""

    machine: str  # name of the machine
    name: str  # of the cam or axis
    unit: str  # of the position, such as "mm"
    is_angle: bool  # whether the position is an angle
    advance: float  # by how much the position advances per cycle [unit]
