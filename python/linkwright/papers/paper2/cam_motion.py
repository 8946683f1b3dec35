r"""Start, course and roller of the cam of paper 2.

| law | position at its end | acceleration at its begin |
| --- | --- | --- |
| `printed`, `fixed_travel` | 3/5 v t_p | zero |
| `free_travel` | free | zero |
| `free_acceleration` | free | free |

Euler's equation is :math:`x^{(6)} = 0`. A position that is free at the end adds :math:`x^{(5)} = 0` there,
an acceleration that is free at the begin :math:`\dddot x = 0` there (`linkwright.cam.laws.optimal`). The
jerk at an end cannot be prescribed: it may be changed there over a time as short as you like, at no cost.

The centre of a roller runs on the curve at its radius from the profile. Two rollers at a fixed distance need
a curve of centres of constant diameter; the printed profile has the constant diameter itself. So the printed
curve has to be the curve of centres, and the profile that is cut lies a radius inside it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.cam.laws.optimal import optimal
from linkwright.cam.laws.piece import Piece
from linkwright.cam.profile.least_sizes import base_for_pressure_angle, largest_roller
from linkwright.cam.profile.profile import CamProfile, cam_profile, the_cam
from linkwright.kernel.arrays import Bools, Floats
from linkwright.kernel.files.library import library_path
from linkwright.kinetostatics.forces import forces
from linkwright.machine.read import read
from linkwright.papers.paper2.alternatives import Alternative, design_speed
from linkwright.papers.paper2.formulas import Formulas, fraction


@dataclass(frozen=True)
class Start:
    """A start section x(u) over u from 0 to 1, from rest to the velocity 1."""

    law: MotionLaw

    @property
    def travel(self) -> float:
        """Over v t_p [–]."""
        return float(self.law.at(1.0))

    @property
    def cost(self) -> float:
        """∫ jerk² over v²/t_p³ [–]."""
        return self.law.integral_of_square(3)

    @property
    def acceleration_max(self) -> float:
        """Over v/t_p [–]."""
        return self.law.peak(2).value

    @property
    def jerk_max(self) -> float:
        """Largest in magnitude, over v/t_p² [–]."""
        return abs(self.law.peak(3).value)

    def over_stroke(self, share: float) -> float:
        """∫ jerk² of start and mirrored braking for a stroke of 1 in a time of 1, each a share of it."""
        speed = 1 / (2 * share * self.travel + 1 - 2 * share)
        return 2 * self.cost * speed**2 / share**3

    def to_dict(self) -> dict[str, float]:
        """Its numbers, ready for JSON."""
        return {name: getattr(self, name) for name in ("travel", "cost", "acceleration_max", "jerk_max")}


def starts(formulas: Formulas) -> dict[str, Start]:
    """The printed start section, and those of minimum ∫ jerk² by what is held fixed: the table above."""
    rest, end = {0: 0.0, 1: 0.0, 2: 0.0}, {1: 1.0, 2: 0.0}
    piece = Piece(tuple(formulas.polynomial("start", 0).coef.tolist()))
    printed = Start(MotionLaw((0.0, 1.0), (piece,)))
    return {
        "printed": printed,
        "fixed_travel": Start(optimal(3, rest, {0: printed.travel, **end})),
        "free_travel": Start(optimal(3, rest, end)),
        "free_acceleration": Start(optimal(3, {0: 0.0, 1: 0.0}, end)),
    }


@dataclass(frozen=True)
class Course:
    """The cart over one revolution of steady motion."""

    time: Floats  # (n,): from the start of the revolution [s]
    # (n,): of the cart, and by the law at the mean speed over time [m/s].
    velocity: Floats
    intended: Floats
    speed: Floats  # (n,): of the shaft [rad/s]
    # Of the shaft over time, and as designed [rad/s].
    speed_mean: float
    speed_design: float
    steady: Bools  # (n,): where the law has constant speed
    speed_constant: float  # that speed at the mean speed of the shaft [m/s]

    @property
    def period(self) -> float:
        """Of the revolution [s]."""
        return float(self.time[-1])

    @property
    def deviation(self) -> Floats:
        """Velocity less the intended one over the constant speed, (n,) [–]."""
        return (self.velocity - self.intended) / self.speed_constant

    @property
    def deviation_max(self) -> float:
        """Largest in magnitude [–]."""
        return float(np.abs(self.deviation).max())

    @property
    def deviation_time(self) -> float:
        """When [s]."""
        return float(self.time[np.abs(self.deviation).argmax()])

    @property
    def steady_range(self) -> tuple[float, float]:
        """Minimum and maximum speed of the cart where the law has constant speed, over that speed [–]."""
        speeds = np.abs(self.velocity[self.steady]) / self.speed_constant
        return float(speeds.min()), float(speeds.max())

    def to_dict(self) -> dict[str, float | list[float]]:
        """Its numbers, ready for JSON."""
        return {
            "speed_mean": self.speed_mean,
            "speed_design": self.speed_design,
            "speed_constant": self.speed_constant,
            "deviation_max": self.deviation_max,
            "deviation_max_time": self.deviation_time,
            "steady_range": list(self.steady_range),
        }


def course(drive: Alternative, formulas: Formulas) -> Course:
    """The cart of the cam drive with the printed law over one revolution of steady motion."""
    turn, law, given = drive.steady, the_cam(drive.machine)[1].lift, formulas.printed["given"]
    mean = turn.speed_mean_time
    half = np.mod(turn.crank_angle, np.pi) / np.pi
    return Course(
        time=turn.time,
        velocity=law.at(turn.crank_angle, 1) * turn.speed,
        intended=law.at(np.mod(mean * turn.time, 2 * np.pi), 1) * mean,
        speed=turn.speed,
        speed_mean=mean,
        speed_design=design_speed(drive.machine),
        steady=(half >= fraction(given["start"])) & (half <= 1 - fraction(given["stop"])),
        speed_constant=formulas.speed * formulas.time * mean / np.pi,
    )


# Points of the curve of centres, an even number: between them straight lines err by 1e-9 of the radius.
_POINTS = 40_000

# Angles of the revolution at which forces are compared, every quarter of a degree, off the joints of the law.
_ANGLES = 1440


@dataclass(frozen=True)
class Rollers:
    """Rollers on the printed profile, and on a profile inside of it."""

    # Of the rollers examined; what a roller must stay below that runs on the printed profile, its minimum
    # concave radius, and whose centre runs on it, its minimum convex radius [m].
    radius: float
    largest_in_hollow: float | None
    largest_inside: float | None
    # By how much the distance of two rollers on the printed profile changes over one revolution, and the
    # place of a roller's centre differs from ρ + r at most [m].
    play: float
    lift_error: float
    offset: CamProfile  # the cam whose rollers' centres run on the printed curve
    breadth_for_limit: float  # minimum b at which the pressure angle keeps the limit of the cam [m]


def rollers(profile: CamProfile, machine: str, radius: float) -> Rollers:
    """Look at rollers of a radius [m] on the cam with points of a machine of the library."""
    cam, contact = profile.cam, profile.flanks[0].contact
    centres = centre_distance(profile, radius)
    half = _POINTS // 2
    apart = centres[:half] + centres[half:]
    printed = np.hypot(*profile.flanks[0].curve().points(_angles()).T)
    place = f"mechanism.cams.{profile.name}"
    offset = read(library_path(machine), {f"{place}.contact": "roller", f"{place}.roller_radius": radius})
    base = base_for_pressure_angle(cam, contact, cam.limit)
    assert base is not None
    return Rollers(
        radius=radius,
        largest_in_hollow=profile.curvature_radius_concave_min,
        largest_inside=largest_roller(contact),
        play=float(np.ptp(apart)),
        lift_error=float(np.abs(centres - printed - radius).max()),
        offset=cam_profile(offset),
        breadth_for_limit=2 * base + cam.stroke,
    )


def centre_distance(profile: CamProfile, radius: float) -> Floats:
    """Distance of a roller's centre from the cam's at equal angles [m]; radius [m] below the concave one."""
    x, y = profile.flanks[0].curve(radius).points(_angles()).T
    # The cam is seen as it stands at the start: the place of contact goes round it backwards.
    polar = np.unwrap(-np.arctan2(y, x))
    distance: Floats = np.interp(_angles(), polar, np.hypot(x, y), period=2 * np.pi)
    return distance


def _angles() -> Floats:
    return np.linspace(0.0, 2 * np.pi, _POINTS, endpoint=False)


def two_cams(machine: str, cam: str) -> dict[str, float]:
    """Two cams that turn in opposite directions, one on each side of the cart, against one alone.

    Both move the cart in the same way, so each may be computed by itself, and their mean is what two cams
    with half the force each do. Largest forces at the design speed [N]: ``side_force`` of one cam on the
    guide, ``left_over`` of two, ``contact_force`` of one along the normal.
    """
    sides, angles = [], (np.arange(_ANGLES) + 0.5) * (2 * np.pi / _ANGLES)
    for rotation in ("same", "opposite"):
        driven = read(library_path(machine), {f"mechanism.cams.{cam}.rotation": rotation})
        acting = forces(driven, speed=design_speed(driven), angles=angles)
        sides.append(acting.pairs[f"{cam}.guide"].normal)
    return {
        "side_force": float(np.abs(sides[0]).max()),
        "left_over": float(np.abs(0.5 * (sides[0] + sides[1])).max()),
        "contact_force": float(np.abs(acting.drives[cam]).max()),
    }
