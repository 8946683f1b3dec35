"""Straight-line linkages in unit size: their mechanisms, and the range of the crank in which they are used.

Each draws its line with a point ``P``; its crank angle is zero where P is in the middle of the line.

Source: Hartenberg, Denavit, Kinematic Synthesis of Linkages, 1964; Kempe, How to Draw a Straight Line, 1877;
Artobolevsky, Mechanisms in Modern Engineering Design.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.synthesis.four_bar import FourBar, plain_point, plain_rocker

Tables = dict[str, Any]


@dataclass(frozen=True)
class LineKind:
    """A kind of straight-line linkage."""

    kind: str  # its name in commands
    title: str  # its name in words
    exact: bool  # whether its line is straight by a theorem
    links: int  # links, the frame among them
    proportions: dict[str, float]  # lengths that may be chosen, with their usual values
    # Proportions → first and last crank angle of the usual range [rad].
    span: Callable[[dict[str, float]], tuple[float, float]]
    build: Callable[[dict[str, float]], Tables]  # proportions → tables of the mechanism
    source: str  # who found it, and the proportions


def _bar_tables(bar: FourBar, point: complex) -> Tables:
    return bar.machine("line", points={"P": point}).mechanism.model_dump(exclude_unset=True)


def _hoeken(p: dict[str, float]) -> Tables:
    """Equal coupler and rocker; P beyond the joint, as far again; midway the crank points away from B₀."""
    bar = FourBar(0j, p["frame"] + 0j, p["crank"], p["arm"], p["arm"], "left", np.pi)
    return _bar_tables(bar, 2 * p["arm"] + 0j)


def _chebyshev(p: dict[str, float]) -> Tables:
    """Crossed rockers of one length; P in the middle of the coupler, which is parallel to the frame there."""
    half = 0.5 * (p["frame"] + p["coupler"])
    pin = half + 1j * np.sqrt(p["arm"] ** 2 - half**2)
    joint = pin - p["coupler"]
    side = "left" if ((p["frame"] - pin).conjugate() * (joint - pin)).imag > 0 else "right"
    bar = FourBar(0j, p["frame"] + 0j, p["arm"], p["coupler"], p["arm"], side, float(np.angle(pin)))  # type: ignore[arg-type]
    return _bar_tables(bar, 0.5 * p["coupler"] + 0j)


# Share of the crank's range up to a place where links are in line: there the crank moves nothing well.
_INSIDE = 0.9


def _chebyshev_span(p: dict[str, float]) -> tuple[float, float]:
    """Nearly between the places of P above the pivots; links of usual proportions are in line there."""
    middle = np.arccos(0.5 * (p["frame"] + p["coupler"]) / p["arm"])
    low = np.arccos(min(1.0, p["frame"] / p["arm"]))
    return float(_INSIDE * (low - middle)), float(_INSIDE * (np.pi / 2 - middle))


def _watt(p: dict[str, float]) -> Tables:
    """Two rockers of one length on either side of the coupler, at right angles to it; P in its middle."""
    bar = FourBar(0j, 2 * p["arm"] + 1j * p["coupler"], p["arm"], p["coupler"], p["arm"], "left", 0.0)
    return _bar_tables(bar, 0.5 * p["coupler"] + 0j)


def _roberts(p: dict[str, float]) -> Tables:
    """Rockers of one length, a coupler of half the frame; P on the frame's line, as far as the pivots."""
    half, coupler = 0.5 * p["frame"], 0.5 * p["frame"]
    height = np.sqrt(p["arm"] ** 2 - (0.5 * (p["frame"] - coupler)) ** 2)
    pin = half - 0.5 * coupler + 1j * height
    bar = FourBar(0j, p["frame"] + 0j, p["arm"], coupler, p["arm"], "left", float(np.angle(pin)))
    return _bar_tables(bar, 0.5 * coupler - 1j * height)


def _roberts_span(p: dict[str, float]) -> tuple[float, float]:
    """Between the places where P is at the pivots: there crank and line to P fall together."""
    middle = np.arccos(0.25 * p["frame"] / p["arm"])
    low = np.arccos(0.5 * p["frame"] / p["arm"])
    high = low + 2 * np.arcsin(0.25 * p["frame"] / p["arm"])
    return float(_INSIDE * (low - middle)), float(_INSIDE * (high - middle))


def _evans(p: dict[str, float]) -> Tables:
    """Scott Russell's linkage with its slider carried by a long rocker instead ("grasshopper")."""
    # The joint B swings about the line through the crank's pivot; the middle of the range is where the crank
    # lies along that line, and the rod continues it, so B is 2 r away.
    r, arm = p["crank"], p["arm"]
    # Sideways on the line B moves between 2 r and 2 r cos(range); the rocker stands upright half-way between.
    reach = r * (1 + np.cos(_EVANS_RANGE))
    drop = np.sqrt(arm**2 - (2 * r - reach) ** 2)
    bar = FourBar(0j, reach - 1j * drop, r, r, arm, "left", 0.0)
    return _bar_tables(bar, -r + 0j)


# Half the crank's range for which the rocker of the grasshopper is placed [rad].
_EVANS_RANGE = np.radians(30)


def _scott_russell(p: dict[str, float]) -> Tables:
    """Crank and rod of one length; P on the rod, as far beyond the pin as the slider is from it."""
    return {
        "cranks": {"A": {"radius": p["crank"]}},
        "sliders": {"B": {"crank": "A", "rod": p["crank"]}},
        "rigid_points": {"P": plain_point("B.rod", -p["crank"] + 0j)},
    }


def _peaucellier(p: dict[str, float]) -> Tables:
    """Long arms from O to two corners of a rhombus; a third runs on a circle through O, the fourth is P."""
    arm, side, crank = p["arm"], p["side"], p["crank"]
    return {
        "points": {"O": {"x": 0.0, "y": 0.0}, "Q": {"x": crank, "y": 0.0}},
        "cranks": {"C": {"pivot": "Q", "radius": crank}},
        "rockers": {
            "B": plain_rocker("C", "O", side, arm, "left"),
            "D": plain_rocker("C", "O", side, arm, "right"),
            "P": plain_rocker("B", "D", side, side, "right"),
        },
    }


def _hart(p: dict[str, float]) -> Tables:
    """A crossed parallelogram ABCD; O, the pin R and P divide AB, AD and CB alike and are always in line."""
    # OR · OP = λ (1 − λ)(AB² − AD²), so P draws the inverse of the circle of R, which passes through O.
    long, short, part, crank = p["long"], p["short"], p["part"], p["crank"]
    return {
        "points": {"O": {"x": 0.0, "y": 0.0}, "Q": {"x": crank, "y": 0.0}},
        "cranks": {"R": {"pivot": "Q", "radius": crank}},
        "rockers": {
            "A": plain_rocker("R", "O", part * short, part * long, "left"),
            "C": plain_rocker("B", "D", short, long, "right"),
        },
        "rigid_points": {
            "B": plain_point("A.rocker", -(1 - part) * long + 0j),
            "D": plain_point("A.coupler", -(1 - part) * short + 0j),
            "P": plain_point("C.coupler", (1 - part) * short + 0j),
        },
    }


def _even(half: float) -> Callable[[dict[str, float]], tuple[float, float]]:
    """A range of so many degrees to both sides, whatever the proportions."""
    return lambda _: (float(-np.radians(half)), float(np.radians(half)))


KINDS: dict[str, LineKind] = {
    kind.kind: kind
    for kind in (
        LineKind(
            "hoeken",
            "Hoeken's linkage",
            False,
            4,
            {"crank": 1.0, "frame": 2.0, "arm": 2.5},
            _even(90),
            _hoeken,
            "Hoeken 1926; proportions 1 : 2 : 2.5 : 2.5 : 5, those of Chebyshev's lambda linkage",
        ),
        LineKind(
            "chebyshev",
            "Chebyshev's linkage",
            False,
            4,
            {"frame": 4.0, "coupler": 2.0, "arm": 5.0},
            _chebyshev_span,
            _chebyshev,
            "Chebyshev 1854; proportions 4 : 2 : 5",
        ),
        LineKind(
            "watt", "Watt's linkage", False, 4, {"arm": 2.0, "coupler": 1.0}, _even(20), _watt, "Watt 1784"
        ),
        LineKind(
            "roberts",
            "Roberts's linkage",
            False,
            4,
            {"frame": 2.0, "arm": 1.2},
            _roberts_span,
            _roberts,
            "Roberts; coupler half the frame",
        ),
        LineKind(
            "evans",
            "Evans's linkage (grasshopper)",
            False,
            4,
            {"crank": 1.0, "arm": 3.0},
            _even(30),
            _evans,
            "Evans; Scott Russell's linkage with a rocker for the slider",
        ),
        LineKind(
            "scott-russell",
            "Scott Russell's linkage",
            True,
            4,
            {"crank": 1.0},
            _even(60),
            _scott_russell,
            "Scott Russell 1803; crank and rod of one length",
        ),
        LineKind(
            "peaucellier",
            "Peaucellier and Lipkin's inversor",
            True,
            8,
            {"arm": 5.0, "side": 2.0, "crank": 1.9},
            _even(60),
            _peaucellier,
            "Peaucellier 1864, Lipkin 1870",
        ),
        LineKind(
            "hart",
            "Hart's inversor",
            True,
            6,
            {"long": 4.0, "short": 2.0, "part": 0.5, "crank": 0.8},
            _even(60),
            _hart,
            "Hart 1874",
        ),
    )
}
