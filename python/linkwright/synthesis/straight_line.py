"""Straight lines from a catalogue: a linkage scaled to a wanted length of line, and how straight that is.

The deviation is the maximum distance of the point from the best straight line, which is the middle of the
narrowest strip that holds the whole curve; one side of that strip is a side of the curve's convex hull.

Source: ISO 1101 (straightness as the width of the narrowest strip); the kinds: see `line_kinds`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.description.base import suggestion
from linkwright.kernel.errors import InputError, SynthesisError
from linkwright.kernel.public import public
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import LENGTH
from linkwright.kernel.units.marks import positive
from linkwright.linkages.kinematics import motions
from linkwright.machine.machine import Machine
from linkwright.synthesis.four_bar import machine_of
from linkwright.synthesis.line_kinds import KINDS, LineKind, Tables

# Intervals of the crank's range at which the line is examined.
_STEPS = 1440

# Keys of a mechanism that are lengths.
_LENGTHS = {"x", "y", "radius", "rod", "coupler", "rocker", "offset", "along", "across"}

SOURCE = "From the catalogue of straight-line linkages of linkwright"


@dataclass(frozen=True)
class StraightLine(Result):
    """A linkage whose point ``P`` runs along a straight line."""

    kind: Annotated[str, About("Which linkage, as in commands.")]
    title: Annotated[str, About("Its name in words.")]
    exact: Annotated[bool, About("Whether the line is straight by a theorem.")]
    links: Annotated[int, Label("links", "", "", "The frame among them.")]
    length: Annotated[float, Label("length of the line", "", "m")]
    deviation: Annotated[float, Label("maximum distance from the best straight line", "", "m")]
    straightness: Annotated[
        float,
        Label(
            "straightness error over the length",
            "",
            "",
            "Width of the narrowest strip that holds the line, twice the deviation, over its length.",
        ),
    ]
    direction: Annotated[float, Label("direction of the line", "", "rad")]
    crank_angle_start: Annotated[float, Label("first crank angle of the range", "", "rad")]
    crank_angle_end: Annotated[float, Label("last crank angle of the range", "", "rad")]
    speed_ratio: Annotated[
        float, Label("maximum over minimum speed", "", "", "Of ``P`` in the range at constant crank speed.")
    ]
    size: Annotated[
        float, Label("size of the linkage", "", "m", "Longest distance between two points of it in one link.")
    ]
    turns_fully: Annotated[bool, About("Whether the crank can go on round.")]
    crank_angles: Annotated[Floats, Label("crank angles", "", "rad", "Over the range.")]
    x: Annotated[Floats, Label("place along x", "", "m", "Of ``P``.")]
    y: Annotated[Floats, Label("place along y", "", "m", "Of ``P``.")]
    machine: Annotated[Machine, About("The linkage.")]


@public
def straight_line(
    kind: str,
    length: float,
    *,
    proportions: Mapping[str, float] | None = None,
    crank_range: tuple[float, float] | None = None,
) -> StraightLine:
    """Take a straight-line linkage from the catalogue and scale it to a length of line.

    Parameters
    ----------
    kind : str
        Such as ``"hoeken"``; `straight_lines` lists them.
    length : float
        Of the line [m].
    proportions : mapping of str to float, optional
        Lengths that differ from the usual ones, in any unit; only their ratios matter.
    crank_range : tuple of float, optional
        First and last crank angle [rad], instead of the usual ones.

    Returns
    -------
    StraightLine
        The linkage, with its deviation from a straight line.

    Raises
    ------
    InputError
        An unknown kind or proportion, or a number that is not positive.
    SynthesisError
        The linkage does not close over the range.

    References
    ----------
    .. [1] Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964.
    """
    line = _kind(kind)
    in_range(length=(length, positive(LENGTH)))
    chosen = line.proportions | _checked(line, proportions or {})
    try:
        with np.errstate(all="raise"):
            span = crank_range or line.span(chosen)
            tables = line.build(chosen)
    except (FloatingPointError, ValueError):
        raise SynthesisError(_impossible(line, chosen)) from None
    if not span[0] < span[1]:
        raise InputError("crank_range: expected the smaller angle first")
    unit = _extent(*_line(machine_of(line.title, tables), line, chosen, span)[:2])[0]
    name = f"{line.title}, line of {length:.6g} m"
    machine = machine_of(name, _scaled(tables, length / unit), f"{SOURCE}: {line.source}")
    return _measured(line, machine, chosen, span, tables, length / unit)


@public
def straight_lines(length: float = 1.0) -> tuple[StraightLine, ...]:
    """The catalogue: all kinds with their usual proportions, for one length of line.

    Parameters
    ----------
    length : float
        Of the line [m].

    Returns
    -------
    tuple of StraightLine
        The approximate ones first.
    """
    return tuple(straight_line(kind, length) for kind in KINDS)


def narrowest_strip(x: Floats, y: Floats) -> tuple[float, float]:
    """Width [m] and direction, 0 to π [rad], of the narrowest strip about points `x`, `y` (n,) [m]."""
    corners = _hull(x, y)
    if len(corners) < 3:
        along = corners[-1] - corners[0]
        return 0.0, float(np.angle(along)) % np.pi
    sides = np.roll(corners, -1) - corners
    units = sides / np.abs(sides)
    widths = np.max(np.imag(np.conj(units)[:, None] * (corners[None, :] - corners[:, None])), axis=1)
    best = int(widths.argmin())
    return float(widths[best]), float(np.angle(units[best])) % np.pi


def _hull(x: Floats, y: Floats) -> Complexes:
    """Corners of the convex hull counter-clockwise, by Andrew's chain."""
    points = sorted(set(zip(x.tolist(), y.tolist(), strict=True)))
    if len(points) < 3:
        return np.array([complex(*point) for point in points])
    chain: list[complex] = []
    for listed in (points, points[::-1]):
        part: list[complex] = []
        for corner in (complex(*point) for point in listed):
            while len(part) > 1 and ((part[-1] - part[-2]).conjugate() * (corner - part[-2])).imag <= 0:
                part.pop()
            part.append(corner)
        chain += part[:-1]
    return np.array(chain)


def _kind(kind: str) -> LineKind:
    if kind not in KINDS:
        raise InputError(f'kind "{kind}": no such linkage; {suggestion(kind, KINDS)}')
    return KINDS[kind]


def _checked(kind: LineKind, proportions: Mapping[str, float]) -> dict[str, float]:
    for name, value in proportions.items():
        if name not in kind.proportions:
            raise InputError(f"{kind.title} has no length {name}; {suggestion(name, kind.proportions)}")
        in_range(**{name: (value, positive(LENGTH))})
    return dict(proportions)


def _impossible(kind: LineKind, chosen: Mapping[str, float]) -> str:
    given = ", ".join(f"{name} {value:g}" for name, value in chosen.items())
    usual = ", ".join(f"{name} {value:g}" for name, value in kind.proportions.items())
    return f"{kind.title} does not close with {given}; its usual proportions are {usual}"


def _line(
    machine: Machine, kind: LineKind, chosen: Mapping[str, float], span: tuple[float, float]
) -> tuple[Floats, Floats, Floats, Floats]:
    """P over the range: x, y [m], and speed [m/rad]; the crank angles [rad]."""
    angles = np.linspace(*span, _STEPS + 1)
    table = motions(machine, angles, points=["P"])[0]
    if np.isnan(table).any():
        closed = ~np.isnan(table).any(axis=0)
        if not closed.any():
            raise SynthesisError(_impossible(kind, chosen))
        gap = float(np.degrees(angles[~closed][0]))
        raise SynthesisError(
            f"{kind.title} does not close over crank angles {np.degrees(span[0]):.4g}° to "
            f"{np.degrees(span[1]):.4g}°: not at {gap:.4g}°, and in all over {closed.mean():.0%} of them; "
            "narrow the range or change the proportions"
        )
    return table[0], table[1], np.hypot(table[2], table[3]), angles


def _extent(x: Floats, y: Floats) -> tuple[float, float, float]:
    """Length of a line along its best direction, width of its strip [m], and that direction [rad]."""
    width, direction = narrowest_strip(x, y)
    along = x * np.cos(direction) + y * np.sin(direction)
    return float(np.ptp(along)), width, direction


def _scaled(tables: Tables, factor: float) -> Tables:
    return {
        key: _scaled(value, factor)
        if isinstance(value, dict)
        else (float(value) * factor if key in _LENGTHS and not isinstance(value, str) else value)
        for key, value in tables.items()
    }


def _measured(
    kind: LineKind,
    machine: Machine,
    chosen: Mapping[str, float],
    span: tuple[float, float],
    tables: Tables,
    factor: float,
) -> StraightLine:
    from linkwright.linkages.closure import closure

    x, y, speed, angles = _line(machine, kind, chosen, span)
    length, width, direction = _extent(x, y)
    closing = closure(machine)
    return StraightLine(
        kind=kind.kind,
        title=kind.title,
        exact=kind.exact,
        links=kind.links,
        length=length,
        deviation=0.5 * width,
        straightness=width / length,
        direction=direction,
        crank_angle_start=float(span[0]),
        crank_angle_end=float(span[1]),
        speed_ratio=float(speed.max() / speed.min()) if speed.min() > 0 else np.inf,
        size=factor * _longest(tables),
        turns_fully=closing.turns_fully and closing.change_point is None,
        crank_angles=angles,
        x=x,
        y=y,
        machine=machine,
    )


def _longest(tables: Tables) -> float:
    lengths = [0.0]
    for value in tables.values():
        for element in value.values():
            sizes = [float(element[key]) for key in ("radius", "rod", "coupler", "rocker") if key in element]
            lengths += [*sizes, float(np.hypot(element.get("along", 0.0), element.get("across", 0.0)))]
    return max(lengths)
