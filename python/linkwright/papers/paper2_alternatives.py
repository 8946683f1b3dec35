"""Other laws at the same stroke and time, and the crank drive, all on the same motor, gearbox and cart.

Velocity, acceleration and jerk are those at the design speed. Force and torque act in steady motion, where
the crankshaft turns unevenly:

.. math:: F = m\\,(s''\\omega^2 + s'\\varepsilon) + F_r \\operatorname{sgn} s', \\qquad M = F s'
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.analysis.cam.profile import cam_profile
from linkwright.analysis.kinematics import kinematics
from linkwright.analysis.steady_state import SteadyState, steady_state
from linkwright.files.library import library_path
from linkwright.files.read import read
from linkwright.machine import DryFriction, Machine
from linkwright.papers.paper2_formulas import Formulas

Floats = NDArray[np.float64]

CART, ROLLING = "cart", "rolling"

# Intervals of the turn. Values are taken in the middle of pairs of them, off the joints of the laws, where
# the rolling resistance changes its sign; between these angles extremes err by 1e-6.
_ANGLES = 7200


@dataclass(frozen=True)
class Alternative:
    """A drive of the cart.

    Attributes
    ----------
    name, short : str
        What it is; a word or two for figures.
    machine : Machine
        The machine.
    steady : SteadyState
        Its steady motion.
    crank_angle : ndarray, shape (n,)
        Of the curves below [rad].
    velocity, acceleration : ndarray, shape (n,)
        Of the cart at the design speed [m/s, m/s²].
    force, torque : ndarray, shape (n,)
        On the cart, and from there on the shaft, in steady motion [N, N m].
    jerk_max : float
        Largest in size at the design speed [m/s³].
    jerk_step : float
        Largest step of the jerk [m/s³].
    pressure_angle_max : float or None
        Of a cam [rad].
    concave_radius : float or None
        Least concave radius of curvature of a cam [m]; None without hollows.
    steady_share : float
        Share of the stroke at constant speed [–].
    """

    name: str
    short: str
    machine: Machine
    steady: SteadyState
    crank_angle: Floats
    velocity: Floats
    acceleration: Floats
    force: Floats
    torque: Floats
    jerk_max: float
    jerk_step: float
    pressure_angle_max: float | None
    concave_radius: float | None
    steady_share: float

    @property
    def velocity_max(self) -> float:
        """Largest in size at the design speed [m/s]."""
        return float(np.abs(self.velocity).max())

    @property
    def acceleration_max(self) -> float:
        """Largest in size at the design speed [m/s²]."""
        return float(np.abs(self.acceleration).max())

    @property
    def force_max(self) -> float:
        """Largest in size in steady motion [N]."""
        return float(np.abs(self.force).max())

    @property
    def torque_max(self) -> float:
        """Greatest torque that the cart asks of the shaft in steady motion [N m]."""
        return float(self.torque.max())

    def to_dict(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        own = ("velocity_max", "acceleration_max", "jerk_max", "jerk_step", "force_max", "torque_max")
        found = {name: getattr(self, name) for name in ("name", *own)}
        found |= {name: getattr(self.steady, name) for name in ("unevenness", "dynamism", "period")}
        cam = ("pressure_angle_max", "concave_radius", "steady_share")
        return found | {name: getattr(self, name) for name in cam}


def alternatives(formulas: Formulas) -> tuple[Alternative, ...]:
    """The drive of paper 2, the crank drive, and other laws.

    Parameters
    ----------
    formulas : Formulas
        As printed.

    Returns
    -------
    tuple of Alternative
        The printed law first, then the crank.
    """
    given = formulas.printed
    name = given["given"]["machine"]
    found = [_with(name, "combined, 1/6 each, as printed", "as printed", {})]
    found.append(_with(name, "crank r = 0.2 m, rod 0.8 m", "crank", {"mechanism": _crank(given["crank"])}))
    for words, short, sections in _programmes(formulas.stroke):
        found.append(_with(name, words, short, {"mechanism.cams.cart.sections": sections}))
    return tuple(found)


def _crank(lengths: dict[str, float]) -> dict[str, Any]:
    """The mechanism of paper 1 for the same cart."""
    slider = {"crank": "A", "rod": lengths["rod"]}
    return {"cranks": {"A": {"radius": lengths["radius"]}}, "sliders": {CART: slider}}


def _programmes(stroke: float) -> Iterator[tuple[str, str, list[dict[str, Any]]]]:
    """Names and sections of the other laws."""
    for words, share in (("1/10", 1 / 10), ("1/4", 1 / 4), ("1/2", 1 / 2)):
        law = {"kind": "combined", "start": share, "stop": share}
        yield f"combined, {words} each", f"{words} each", _there_and_back(stroke, law)
    law = {"kind": "combined", "ramp": "optimal_jerk_free"}
    yield "combined, least ∫ jerk² over free travel", "free travel", _there_and_back(stroke, law)
    smooth: dict[str, Any] = {"kind": "polynomial", "continuity_start": 3, "continuity_end": 3}
    yield "combined, continuous jerk", "continuous jerk", _ramped(stroke, 1 / 2, smooth, smooth)
    free: list[dict[str, Any]] = [
        {"kind": "optimal", "order": 3, f"free_{end}": [2]} for end in ("start", "end")
    ]
    yield "combined, acceleration free at the turn", "free at the turn", _ramped(stroke, 5 / 8, *free)
    for kind in ("polynomial_4_5_6_7", "cycloidal", "modified_sine", "harmonic"):
        words = kind.replace("_4_5_6_7", " 4-5-6-7").replace("_", " ")
        yield words, words, _there_and_back(stroke, kind)


def _there_and_back(stroke: float, law: object) -> list[dict[str, Any]]:
    """A law over each half of the turn."""
    return [{"angle": np.pi, "lift": sign * stroke, "law": law} for sign in (1, -1)]


def _ramped(stroke: float, travel: float, start: object, stop: object) -> list[dict[str, Any]]:
    """Start, constant speed and braking from single sections; the ramps have a sixth of the time each.

    The travel of a ramp is given over that of constant speed in the same time.
    """
    share = 1 / 6
    cruise = 1 - 2 * share
    speed = stroke / (2 * share * travel + cruise)
    middle = {"angle": cruise * np.pi, "law": "constant_velocity"}
    return [
        part
        for sign in (1, -1)
        for part in (
            {"angle": share * np.pi, "lift": sign * speed * share * travel, "law": start},
            middle | {"lift": sign * speed * cruise},
            {"angle": share * np.pi, "lift": sign * speed * share * travel, "law": stop},
        )
    ]


def _with(machine: str, name: str, short: str, entries: dict[str, Any]) -> Alternative:
    """The machine of the library with some entries exchanged, and what becomes of it."""
    changed = read(library_path(machine), entries)
    omega = design_speed(changed)
    steady = steady_state(changed, n=_ANGLES)
    middle = slice(1, None, 2)
    phi, speed, bend = (each[middle] for each in (steady.crank_angle, steady.speed, steady.acceleration))
    slide = kinematics(changed, phi, third=True).slides[CART]
    assert slide.d3 is not None
    force = resistance(changed) * np.sign(slide.d1)
    force += (changed.bodies[CART].mass or 0.0) * (slide.d2 * speed**2 + slide.d1 * bend)
    jerk, step, angle, hollow, share = _of_cam(changed, omega)
    return Alternative(
        name=name,
        short=short,
        machine=changed,
        steady=steady,
        crank_angle=phi,
        velocity=slide.d1 * omega,
        acceleration=slide.d2 * omega**2,
        force=force,
        torque=force * slide.d1,
        jerk_max=float(np.abs(slide.d3).max()) * omega**3 if jerk is None else jerk,
        jerk_step=step,
        pressure_angle_max=angle,
        concave_radius=hollow,
        steady_share=share,
    )


def design_speed(machine: Machine) -> float:
    """Of the shaft [rad/s]."""
    assert machine.drive is not None
    assert machine.drive.speed is not None
    return float(machine.drive.speed)


def resistance(machine: Machine) -> float:
    """Rolling resistance of the cart [N]."""
    load = machine.loads[ROLLING]
    assert isinstance(load, DryFriction)
    return float(load.force or 0.0)


def _of_cam(machine: Machine, omega: float) -> tuple[float | None, float, float | None, float | None, float]:
    """Jerk and its largest step, pressure angle, hollow, and share at constant speed; a crank has none."""
    if not machine.mechanism.cams:
        return None, 0.0, None, None, 0.0
    cam = cam_profile(machine)
    law = cam.cam.lift
    # The joints inside a section, and that where the turn closes.
    steps = np.append(law.jumps(3), law.at(law.start, 3) - law.at(law.end, 3, "before"))
    step = float(np.abs(steps).max()) * omega**3
    slope = law.derivative(1)
    even = [
        abs(float(slope.at(0.5 * (low + high)))) * (high - low)
        for low, high, piece in zip(law.breaks, law.breaks[1:], slope.pieces, strict=False)
        if piece.derivative(1.0).vanishes(cam.stroke)
    ]
    hollow = cam.curvature_radius_concave_min
    return cam.jerk_max, step, cam.pressure_angle_max, hollow, sum(even) / (2 * cam.stroke)
