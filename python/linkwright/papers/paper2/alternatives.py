"""Other laws at the same stroke and time, and the crank drive, all on the same motor, gearbox and cart.

Velocity, acceleration and jerk are those at the design speed. Force and torque act in steady motion, where
the crankshaft turns unevenly:

.. math:: F = m\\,(s''\\omega^2 + s'\\varepsilon) + F_r \\operatorname{sgn} s', \\qquad M = F s'
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.profile.profile import cam_profile
from linkwright.drive.steady_state import SteadyState, steady_state
from linkwright.kernel.arrays import Floats
from linkwright.kernel.files.library import library_path
from linkwright.kinetostatics.model.loads.force import DryFriction
from linkwright.linkages.kinematics import SlideMotion, kinematics
from linkwright.machine.machine import Machine
from linkwright.machine.read import read
from linkwright.papers.page import filled
from linkwright.papers.paper2.formulas import SECTIONS, Formulas, fraction

CART, ROLLING = "cart", "rolling"

# Intervals of the revolution. Values are taken in the middle of pairs of them, off the joints of the laws,
# where the rolling resistance changes its sign; between these angles extremes err by 1e-6.
_ANGLES = 7200


@dataclass(frozen=True)
class Alternative:
    """A drive of the cart."""

    # What it is; a word or two for figures.
    name: str
    short: str
    # The machine and its steady motion.
    machine: Machine
    steady: SteadyState
    crank_angle: Floats  # (n,): of the curves [rad]
    # (n,): of the cart at the design speed [m/s, m/s²].
    velocity: Floats
    acceleration: Floats
    # (n,): on the cart, and from there on the shaft, in steady motion [N, N m].
    force: Floats
    torque: Floats
    # Largest in magnitude at the design speed, exact for a cam; largest step [m/s, m/s², m/s³].
    velocity_max: float
    acceleration_max: float
    jerk_max: float
    jerk_step: float
    # Of a cam [rad]; minimum concave radius of curvature, if there are hollows [m].
    pressure_angle_max: float | None
    concave_radius: float | None
    steady_share: float  # share of the stroke at constant speed [–]

    @property
    def force_max(self) -> float:
        """Largest in magnitude in steady motion [N]."""
        return float(np.abs(self.force).max())

    @property
    def torque_max(self) -> float:
        """Maximum torque that the cart asks of the shaft in steady motion [N m]."""
        return float(self.torque.max())

    @property
    def jerk_step_shown(self) -> float | None:
        """The step of the jerk, if it is more than rounding [m/s³]."""
        return self.jerk_step if self.jerk_step > 1e-9 * self.jerk_max else None

    def to_dict(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        own = ("velocity_max", "acceleration_max", "jerk_max", "jerk_step", "force_max", "torque_max")
        results = {name: getattr(self, name) for name in ("name", *own)}
        results |= {name: getattr(self.steady, name) for name in ("unevenness", "dynamism", "period")}
        cam = ("pressure_angle_max", "concave_radius", "steady_share")
        return results | {name: getattr(self, name) for name in cam}


def alternatives(formulas: Formulas) -> tuple[Alternative, ...]:
    """The drive of paper 2, then those of its file of data, the crank drive first."""
    given = formulas.printed
    machine = given["given"]["machine"]
    machines = [
        _with(
            machine,
            filled("combined, {start.0}/{start.1} each, as printed", given["given"]),
            "as printed",
            {},
        )
    ]
    for alternative in given["alternative"]:
        if "mechanism" in alternative:
            entries = {"mechanism": alternative["mechanism"]}
        else:
            entries = {"mechanism.cams.cart.sections": _sections(alternative, formulas)}
        machines.append(
            _with(machine, filled(alternative["name"], alternative), alternative["short"], entries)
        )
    return tuple(machines)


def _sections(law: dict[str, Any], formulas: Formulas) -> list[dict[str, Any]]:
    strokes = (formulas.stroke, -formulas.stroke)
    if "law" in law:
        return [{"angle": np.pi, "lift": lift, "law": law["law"]} for lift in strokes]
    shares = [formulas.times[name] / formulas.time for name in SECTIONS]
    ramp = fraction(law["travel"])
    laws = (law["start"], "constant_velocity", law["stop"])
    travels = [share * part for share, part in zip(shares, (ramp, 1.0, ramp), strict=True)]
    return [
        {"angle": share * np.pi, "lift": lift * travel / sum(travels), "law": law}
        for lift in strokes
        for share, travel, law in zip(shares, travels, laws, strict=True)
    ]


def _with(machine: str, name: str, short: str, entries: dict[str, Any]) -> Alternative:
    changed = read(library_path(machine), entries)
    omega = design_speed(changed)
    steady = steady_state(changed, n=_ANGLES)
    middle = slice(1, None, 2)
    phi, speed, bend = (curve[middle] for curve in (steady.crank_angle, steady.speed, steady.acceleration))
    slide = kinematics(changed, phi, third=True).slides[CART]
    force = resistance(changed) * np.sign(slide.d1)
    force += (changed.bodies[CART].mass or 0.0) * (slide.d2 * speed**2 + slide.d1 * bend)
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
        **(_of_cam(changed, omega) if changed.mechanism.cams else _of_slide(slide, omega)),
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


def _of_slide(slide: SlideMotion, omega: float) -> dict[str, Any]:
    assert slide.d3 is not None
    peaks = [float(np.abs(row).max()) * omega**n for n, row in enumerate((slide.d1, slide.d2, slide.d3), 1)]
    names = ("velocity_max", "acceleration_max", "jerk_max")
    none = {"jerk_step": 0.0, "pressure_angle_max": None, "concave_radius": None, "steady_share": 0.0}
    return dict(zip(names, peaks, strict=True)) | none


def _of_cam(machine: Machine, omega: float) -> dict[str, Any]:
    """Peaks of a cam drive, the largest step of its jerk, its shape, and its share at constant speed."""
    profile = cam_profile(machine)
    law = profile.cam.lift
    # The joints inside the revolution, and that where it closes.
    steps = np.append(law.jumps(3), law.at(law.start, 3) - law.at(law.end, 3, "before"))
    return {
        "velocity_max": profile.velocity_max,
        "acceleration_max": profile.acceleration_max,
        "jerk_max": profile.jerk_max,
        "jerk_step": float(np.abs(steps).max()) * omega**3,
        "pressure_angle_max": profile.pressure_angle_max,
        "concave_radius": profile.curvature_radius_concave_min,
        "steady_share": _even(law) / (2 * profile.stroke),
    }


def _even(law: MotionLaw) -> float:
    stretches = zip(pairwise(law.breaks), law.derivative(2).pieces, strict=True)
    ends = [law.at(np.array(pair)) for pair, bend in stretches if bend.vanishes(law.peak(2).value)]
    return float(sum(abs(high - low) for low, high in ends))
