"""Random machines with servo axes and cylinders: units side by side on one master, as text.

A unit is mirrored about the x axis by `side` = −1, and enlarged by `size`; laws in time stay the same.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

LAWS = ("cycloidal", "polynomial_3_4_5", "modified_sine", "modified_trapezoid", "harmonic", "parabolic")
ADVANCES = (60, 90, 120, 360)

MOTOR = """
[axes.{0}.motor]
inertia = "2 kg cm^2"
continuous = {{ speed = "0, 6000 rpm", torque = "3, 2 N m" }}
peak = {{ speed = "0, 6000 rpm", torque = "9, 6 N m" }}
"""


@dataclass
class AxisMachine:
    """A machine as text, with what virtual work needs of it."""

    text: str
    speed: float  # of the master [rad/s]
    gravity: np.ndarray  # [m/s²]
    # Axis → address of the start of its driver.
    starts: dict[str, str] = field(default_factory=dict)
    masses: dict[str, float] = field(default_factory=dict)  # of points [kg]
    inertias: dict[str, float] = field(default_factory=dict)  # of cranks [kg m²]
    forces: dict[str, np.ndarray] = field(default_factory=dict)  # on points [N]
    # Point that slides → friction [N] and the angle of its guide.
    frictions: dict[str, tuple[float, float]] = field(default_factory=dict)


def _sections(rng: Generator, key: str, amount: float, unit: str, advance: float = 0.0) -> str:
    """A rise, a dwell, and the way back as far as it does not advance."""
    angles = rng.uniform(60, 110, 3)
    law, back = rng.choice(LAWS, 2)
    rows = [f'{{ angle = "{angles[0]:.6f} deg", {key} = "{amount:.15g} {unit}", law = "{law}" }}']
    if advance == 0 or rng.random() < 0.5:
        less = advance - amount
        rows.append(f'{{ angle = "{angles[1]:.6f} deg" }}')
        if abs(less) > 1e-9:
            rows.append(f'{{ angle = "{angles[2]:.6f} deg", {key} = "{less:.15g} {unit}", law = "{back}" }}')
    return "\n  ".join(["sections = [", *(f"{row}," for row in rows)]) + "\n]"


def random_machine(
    rng: Generator, *, side: int = 1, size: float = 1.0, only: tuple[str, ...] = ()
) -> AxisMachine:
    """Two or three units. `only`: kinds of units to choose from."""
    speed = float(rng.uniform(3, 15))
    towards = rng.uniform(-np.pi, np.pi)
    gravity = 9.81 * size * np.array([np.cos(towards), side * np.sin(towards)])
    made = AxisMachine("", speed, gravity)
    direction = np.degrees(np.arctan2(gravity[1], gravity[0]))
    parts = [
        'format = 1\nname = "Random axes"',
        f"[master]\nspeed = {speed:.17g}",
        f"[loads.weight]\nkind = 'gravity'\nacceleration = {9.81 * size:.17g}",
        f"direction = '{direction:.17g} deg'",
    ]
    kinds = only or ("turn", "five", "line", "arm", "clamp")
    for k in range(int(rng.integers(2, 4))):
        kind = str(rng.choice(kinds))
        origin = np.array([3.0 * k, 0.0]) * size
        parts.append(_UNITS[kind](rng, made, f"{kind}{k}", origin, side, size))
    made.text = "\n".join(parts)
    return made


def _axis(rng: Generator, name: str, driver: str, sections: str, extra: str = "", along: float = 0.0) -> str:
    ratio, efficiency = rng.uniform(3, 30), rng.uniform(0.6, 1.0)
    lead = f"per_turn = {along:.17g}\n" if along else ""
    return (
        f"[axes.{name}]\ndriver = '{driver}'\nphase = '{rng.uniform(0, 300):.6f} deg'\n{extra}{sections}\n"
        f"[axes.{name}.gearbox]\nratio = {ratio:.17g}\n"
        f"efficiency = {efficiency:.17g}\n{lead}{MOTOR.format(name)}"
    )


def _force(rng: Generator, made: AxisMachine, point: str, side: int, size: float) -> str:
    """A constant force on a point."""
    strength, towards = rng.uniform(5, 50) * size, side * rng.uniform(-3, 3)
    made.forces[point] = strength * np.array([np.cos(towards), np.sin(towards)])
    return (
        f"[loads.force_{point}]\nkind = 'force'\n"
        f"on = '{point}'\nforce = {strength:.17g}\ndirection = {towards:.17g}\n"
    )


def _friction(rng: Generator, made: AxisMachine, point: str, angle: float, size: float) -> str:
    strength = float(rng.uniform(2, 20)) * size
    made.frictions[point] = strength, angle
    return f"[loads.friction_{point}]\nkind = 'dry'\non = '{point}'\nforce = {strength:.17g}\n"


def _mass(rng: Generator, made: AxisMachine, point: str, rest: str = "") -> str:
    mass = float(rng.uniform(1, 12))
    made.masses[point] = mass
    return f"[bodies.{point}]\nmass = {mass:.17g}\n{rest}"


def _turn(rng: Generator, made: AxisMachine, name: str, origin: np.ndarray, side: int, size: float) -> str:
    """A crank with a slider: it swings, or advances."""
    crank, slider, pivot = f"{name}A", f"{name}S", f"{name}P"
    radius, phase, guide = rng.uniform(0.08, 0.2) * size, side * rng.uniform(-3, 3), side * rng.uniform(-3, 3)
    rod, offset = radius * rng.uniform(2.2, 4), side * radius * rng.uniform(-0.3, 0.3)
    advance = float(rng.choice(ADVANCES)) * int(rng.random() < 0.4)
    amount = side * (advance or rng.uniform(30, 170))
    extra = f"advance = '{side * advance:.17g} deg'\n" if advance else ""
    inertia = float(rng.uniform(0.01, 0.2)) * size**2
    made.inertias[name] = inertia
    made.starts[name] = f"mechanism.cranks.{crank}.phase"
    sections = _sections(rng, "swing", amount, "deg", side * advance)
    return (
        f"[mechanism.points.{pivot}]\nx = {origin[0]:.17g}\ny = {origin[1]:.17g}\n"
        f"[mechanism.cranks.{crank}]\npivot = '{pivot}'\nradius = {radius:.17g}\nphase = {phase:.17g}\n"
        f"[mechanism.sliders.{slider}]\ncrank = '{crank}'\n"
        f"rod = {rod:.17g}\noffset = {offset:.17g}\nangle = {guide:.17g}\n"
        f"[bodies.{crank}]\ninertia = {inertia:.17g}\n"
        + _mass(rng, made, slider)
        + _force(rng, made, slider, side, size)
        + _friction(rng, made, slider, guide, size)
        + _axis(rng, name, crank, sections, extra)
    )


def _line(rng: Generator, made: AxisMachine, name: str, origin: np.ndarray, side: int, size: float) -> str:
    """A carriage on a screw."""
    guide = side * rng.uniform(-3, 3)
    made.starts[name] = f"mechanism.linear_drivers.{name}.start"
    amount = rng.uniform(0.05, 0.4) * size
    travel = amount * int(rng.random() < 0.3)
    extra = f"travel = '{travel:.15g} m'\n" if travel else ""
    sections = _sections(rng, "lift", amount, "m", travel)
    return (
        f"[mechanism.linear_drivers.{name}.guide]\nangle = {guide:.17g}\noffset = {side * 0.1 * size:.17g}\n"
        + _mass(rng, made, name)
        + _force(rng, made, name, side, size)
        + _friction(rng, made, name, guide, size)
        + _axis(rng, name, name, sections, extra, float(rng.uniform(0.005, 0.3)) * size)
    )


def _five(rng: Generator, made: AxisMachine, name: str, origin: np.ndarray, side: int, size: float) -> str:
    """A five-bar with two axes."""
    parts = []
    for end, x, angle in (("L", -0.1, 115), ("R", 0.1, 65)):
        axis = f"{name}{end}"
        made.starts[axis] = f"mechanism.cranks.{axis}.phase"
        swing = side * rng.uniform(8, 25) * rng.choice((-1, 1))
        parts.append(
            f"[mechanism.points.{axis}P]\nx = {origin[0] + x * size:.17g}\ny = {origin[1]:.17g}\n"
            f"[mechanism.cranks.{axis}]\npivot = '{axis}P'\n"
            f"radius = {0.2 * size:.17g}\nphase = '{side * angle} deg'\n"
            + _axis(rng, axis, axis, _sections(rng, "swing", swing, "deg"))
        )
    assembly = "right" if side > 0 else "left"
    return (
        "".join(parts) + f"[mechanism.rockers.{name}C]\ncrank = '{name}L'\npivot = '{name}R'\n"
        f"coupler = {0.34 * size:.17g}\nrocker = {0.3 * size:.17g}\nassembly = '{assembly}'\n"
        + _mass(rng, made, f"{name}C")
        + _force(rng, made, f"{name}C", side, size)
    )


def _arm(rng: Generator, made: AxisMachine, name: str, origin: np.ndarray, side: int, size: float) -> str:
    """An arm that an electric cylinder lifts."""
    pivot, trunnion, joint = f"{name}O", f"{name}T", f"{name}P"
    length, distance = rng.uniform(0.5, 0.8) * size, rng.uniform(0.5, 0.8) * size
    angle = rng.uniform(0.7, 1.2)
    place = origin + length * np.array([np.cos(angle), side * np.sin(angle)])
    foot = origin + np.array([distance, 0.0])
    start = float(np.hypot(*(place - foot)))
    made.starts[name] = f"mechanism.cylinders.{name}.start_length"
    amount = rng.uniform(0.1, 0.3) * min(start, length + distance - start)
    return (
        f"[mechanism.points.{pivot}]\nx = {origin[0]:.17g}\ny = {origin[1]:.17g}\n"
        f"[mechanism.points.{trunnion}]\nx = {foot[0]:.17g}\ny = {foot[1]:.17g}\n"
        f"[mechanism.joints.{joint}]\nx = {place[0]:.17g}\ny = {place[1]:.17g}\n"
        f"[mechanism.bars.{name}B]\nstart = '{pivot}'\nend = '{joint}'\nlength = {length:.17g}\n"
        f"[mechanism.cylinders.{name}]\nstart = '{trunnion}'\nend = '{joint}'\nstart_length = {start:.17g}\n"
        + _mass(rng, made, joint)
        + _force(rng, made, joint, side, size)
        + _axis(
            rng, name, name, _sections(rng, "lift", amount, "m"), along=float(rng.uniform(0.005, 0.02)) * size
        )
    )


def _clamp(rng: Generator, made: AxisMachine, name: str, origin: np.ndarray, side: int, size: float) -> str:
    """A toggle between a fixed pivot and a slide, whose knee a cylinder pushes."""
    pivot, trunnion, knee, slide = (f"{name}{end}" for end in "OTKS")
    lower, upper = rng.uniform(0.2, 0.3, 2) * size
    angle = rng.uniform(0.3, 0.6)
    k = origin + lower * np.array([np.cos(angle), side * np.sin(angle)])
    s = np.array([k[0] + np.sqrt(upper**2 - (k[1] - origin[1]) ** 2), origin[1]])
    foot = origin + np.array([0.2, side * 0.5]) * size
    start = float(np.hypot(*(k - foot)))
    made.starts[name] = f"mechanism.cylinders.{name}.start_length"
    amount = rng.uniform(0.2, 0.6) * abs(k[1] - origin[1])
    return (
        f"[mechanism.points.{pivot}]\nx = {origin[0]:.17g}\ny = {origin[1]:.17g}\n"
        f"[mechanism.points.{trunnion}]\nx = {foot[0]:.17g}\ny = {foot[1]:.17g}\n"
        f"[mechanism.joints.{knee}]\nx = {k[0]:.17g}\ny = {k[1]:.17g}\n"
        f"[mechanism.joints.{slide}]\nx = {s[0]:.17g}\ny = {s[1]:.17g}\nguide = {{ through = '{pivot}' }}\n"
        f"[mechanism.bars.{name}L]\nstart = '{pivot}'\nend = '{knee}'\nlength = {lower:.17g}\n"
        f"[mechanism.bars.{name}U]\nstart = '{knee}'\nend = '{slide}'\nlength = {upper:.17g}\n"
        f"[mechanism.cylinders.{name}]\nstart = '{trunnion}'\nend = '{knee}'\nstart_length = {start:.17g}\n"
        + _mass(rng, made, slide)
        + _force(rng, made, slide, side, size)
        + _friction(rng, made, slide, 0.0, size)
        + _axis(
            rng, name, name, _sections(rng, "lift", amount, "m"), along=float(rng.uniform(0.005, 0.02)) * size
        )
    )


_UNITS = {"turn": _turn, "line": _line, "five": _five, "arm": _arm, "clamp": _clamp}
