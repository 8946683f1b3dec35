"""How the cart moves in steady motion, where the shaft turns unevenly, against the law that it was given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.cam.profile.profile import the_cam
from linkwright.papers.paper2.alternatives import Alternative, design_speed
from linkwright.papers.paper2.formulas import Formulas, fraction

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Course:
    """The cart over one revolution of steady motion.

    Attributes
    ----------
    time : ndarray, shape (n,)
        From the start of the revolution [s].
    velocity, intended : ndarray, shape (n,)
        Of the cart, and by the law at the mean speed over time [m/s].
    speed : ndarray, shape (n,)
        Of the shaft [rad/s].
    speed_mean, speed_design : float
        Of the shaft over time, and as designed [rad/s].
    steady : ndarray of bool, shape (n,)
        Where the law has constant speed.
    speed_constant : float
        That speed at the mean speed of the shaft [m/s].
    """

    time: Floats
    velocity: Floats
    intended: Floats
    speed: Floats
    speed_mean: float
    speed_design: float
    steady: NDArray[np.bool_]
    speed_constant: float

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
        """Largest in size [–]."""
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
