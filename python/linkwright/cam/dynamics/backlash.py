r"""Where a form-closed follower goes from one flank of its cam to the other, and how hard it lands.

Between the flanks nothing carries it: relative to the flank that it leaves it is accelerated by |F|/m,
until the clearance j is run through. Where F passes zero with the slope Ḟ, this takes t = (6jm/|Ḟ|)^{1/3},
and it lands with

.. math:: v = \frac12 \sqrt[3]{\frac{|\dot F|}{m}\,(6j)^2}

Here F is taken as it is given, straight from angle to angle.

Source: Koster, *Vibrations of Cam Mechanisms*, Macmillan 1974, on play; the closed form is the integral of
the sentence above.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from linkwright.cam.dynamics.follower_load import CamCourse
from linkwright.kernel.arrays import Floats

# Share of a revolution within which the first and the last angle are one revolution apart.
_TURN = 1e-9


@dataclass(frozen=True, slots=True)
class SideChange:
    """A change of the flank that carries.

    Attributes
    ----------
    cam_angle : float
        Where, by straight lines between the angles given [rad].
    side : int
        The flank that carries afterwards: 1 lifts, −1 is the other.
    force_rate : float
        Slope of the force over time there [N/s].
    impact_speed : float
        With which the clearance is closed; zero without clearance [m/s or rad/s].
    """

    cam_angle: float
    side: int
    force_rate: float
    impact_speed: float

    def __str__(self) -> str:
        """A sentence."""
        to = "the lifting flank" if self.side > 0 else "the other flank"
        text = f"the force goes to {to} at cam angle θ = {np.degrees(self.cam_angle):.4g}°"
        if self.impact_speed:
            text += f", through the clearance with {self.impact_speed:.4g} m/s at its end"
        return text


def side_changes(course: CamCourse, force: Floats, mass: float, clearance: float) -> tuple[SideChange, ...]:
    """Sign changes of the force (n,) [N or N m] by angle; `mass` [kg or kg m²]; `clearance` j [m or rad]."""
    # A force that is zero, as in a dwell without load, belongs to the flank that carried before.
    sign = np.sign(force)
    known = np.flatnonzero(sign)
    changes = []
    for a, b in pairwise(known.tolist()):
        if sign[a] != sign[b]:
            share = float(force[b - 1] / (force[b - 1] - force[b])) if b - a == 1 else 0.0
            changes.append(_change(course, force, (int(b), share), mass, clearance))
    return tuple(changes)


def _change(
    course: CamCourse, force: Floats, place: tuple[int, float], mass: float, clearance: float
) -> SideChange:
    b, share = place
    step = course.cam_angle[b] - course.cam_angle[b - 1]
    time = step / (0.5 * (course.speed[b] + course.speed[b - 1]))
    landing = _Landing(course, force / mass, place) if clearance and mass else None
    return SideChange(
        cam_angle=float(course.cam_angle[b - 1] + share * step),
        side=int(np.sign(force[b])),
        force_rate=float((force[b] - force[b - 1]) / time) if time > 0 else float("inf"),
        impact_speed=landing(clearance) if landing else 0.0,
    )


class _Landing:
    """Flight across the clearance, through the rows from a change of sign on; at most over one revolution."""

    def __init__(self, course: CamCourse, pull: Floats, place: tuple[int, float]) -> None:
        b, share = place
        n = len(pull)
        closed = abs(course.cam_angle[-1] - course.cam_angle[0] - 2 * np.pi) < _TURN
        rows = [*range(b, n), *(range(1, b + 1) if closed else ())]
        step = np.diff(course.cam_angle, prepend=course.cam_angle[0])
        self.sign = float(np.sign(pull[b]))
        self.times = [step[i] / (0.5 * (course.speed[i] + course.speed[i - 1])) for i in rows]
        self.times[0] *= 1 - share
        start = pull[b - 1] + share * (pull[b] - pull[b - 1])
        self.pulls = [float(start), *(float(pull[i]) for i in rows)]

    def __call__(self, clearance: float) -> float:
        """Speed as the clearance is closed; zero if the force turns back before that."""
        gap, speed = 0.0, 0.0
        for time, low, high in zip(self.times, self.pulls, self.pulls[1:], strict=False):
            a, rate = self.sign * low, self.sign * (high - low) / time if time > 0 else 0.0
            end = gap + speed * time + a * time**2 / 2 + rate * time**3 / 6
            if end >= clearance:
                roots = np.roots([rate / 6, a / 2, speed, gap - clearance])
                real = roots.real[(np.abs(roots.imag) < 1e-9 * np.abs(roots)) & (roots.real > 0)]
                t = float(real.min())
                return float(speed + a * t + rate * t**2 / 2)
            gap, speed = end, speed + a * time + rate * time**2 / 2
            if gap < 0:
                return 0.0
        return 0.0
