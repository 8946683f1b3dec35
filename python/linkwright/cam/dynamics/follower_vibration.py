r"""How the mass of a follower really moves, over one revolution, when its train is elastic.

The departure e = x − κs from the place that a slow lift would give obeys, over the cam angle with r = Ω/ω,

.. math:: e'' + 2(\zeta + \zeta_f) r\,e' + r^2 e
    = -\kappa s'' - 2r\left(\kappa(\zeta + \zeta_f) - \zeta\right) s'

which is solved exactly and closed over the revolution. Where the lift's velocity jumps by Δs′, e′ jumps by
−κΔs′: the cam strikes.

Source: M. P. Koster, *Vibrations of Cam Mechanisms*, Macmillan 1974, chapters 2 and 3; H. Dresig,
F. Holzweißig, *Maschinendynamik*, Springer, on cam mechanisms.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from linkwright.cam.dynamics.one_mass import OneMass
from linkwright.cam.dynamics.oscillator import (
    Ends,
    Oscillation,
    in_pieces,
    oscillation,
    pole,
    steps,
    without_steps,
)
from linkwright.cam.laws.motion_law import Extreme, MotionLaw, combined
from linkwright.kernel.arrays import Bools, Floats, Indices
from linkwright.kernel.errors import require_within
from linkwright.kernel.limits import VIBRATIONS
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import Column
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import COUNT, SPEED
from linkwright.kernel.units.marks import positive

# Values and their first two derivatives by the cam angle or the time, (m,) each.
Derivatives = tuple[Floats, Floats, Floats]


class Impulse(NamedTuple):
    """A place where the cam strikes, because the velocity of the lift jumps.

    Attributes
    ----------
    cam_angle : float
        Where [rad].
    velocity_step : float
        By how much ṡ jumps [m/s].
    """

    cam_angle: float
    velocity_step: float


_KEEPS_CONTACT = (
    "Whether contact is maintained; otherwise the follower leaves the cam, and this motion does not apply."
)


@dataclass(frozen=True)
class FollowerVibration(Result):
    """Motion of the follower's mass over one revolution."""

    cam_angle: Annotated[
        Floats, Label("cam angle", "θ", "rad", "One revolution in even steps.", shape="(n + 1,)")
    ]
    lift: Annotated[Floats, Label("lift", "s", "m")]
    position: Annotated[Floats, Label("position of the mass", "x", "m")]
    velocity: Annotated[Floats, Label("velocity of the mass", "ẋ", "m/s")]
    acceleration: Annotated[Floats, Label("acceleration of the mass", "ẍ", "m/s²")]
    force: Annotated[Floats, Label("force of the train on the cam", "", "N", "Positive in compression.")]
    speed: Annotated[float, Label("speed of the cam", "ω", "rad/s")]
    natural_frequency: Annotated[float, Label("natural frequency of the follower", "Ω", "rad/s")]
    vibrations_per_turn: Annotated[float, Label("vibrations in one revolution", "Ω/ω", "")]
    force_max: Annotated[float, Label("maximum force of the train on the cam", "", "N", "Exact.")]
    force_min: Annotated[float, Label("minimum force of the train on the cam", "", "N", "Exact.")]
    force_max_angle: Annotated[float, Label("cam angle of the maximum force", "", "rad")]
    force_min_angle: Annotated[float, Label("cam angle of the minimum force", "", "rad")]
    acceleration_max: Annotated[
        float, Label("maximum acceleration of the mass", "", "m/s²", "In size, exact.")
    ]
    departure_max: Annotated[
        float, Label("maximum departure from the lift", "", "m", "Peak absolute value of e = x − κs, exact.")
    ]
    impulses: Annotated[tuple[Impulse, ...], About("Impacts of the cam.")]
    keeps_contact: Annotated[bool, About(_KEEPS_CONTACT)]
    findings: Annotated[tuple[str, ...], About("Impacts and loss of contact, in sentences.")]


class Train:
    """A follower train driven by a lift at one speed: the departure, and what follows from it.

    ``lift``: s over the cam angle [m]; ``speed``: ω [rad/s].
    """

    def __init__(self, lift: MotionLaw, model: OneMass, speed: float, ends: Ends) -> None:
        self.lift, self.model, self.speed = combined((1.0, lift)), model, speed
        r, kappa = model.natural_frequency / speed, model.share
        viscous = -2 * r * (kappa * model.damping_ratio_all - model.damping_ratio)
        drive = combined((-kappa, self.lift.derivative(2)), (viscous, self.lift.derivative(1)))
        self.steps = steps(self.lift, 1, ends)
        mu = pole(r, model.damping_ratio_all)
        self.departure: Oscillation = oscillation(drive, mu, -kappa * self.steps, periodic=ends == "turn")

    def _lift(self, order: int, step: Indices, phi: Floats) -> Floats:
        return in_pieces(self.lift.derivative(order), self.departure.pieces[step], phi)

    def motion(self, step: Indices, phi: Floats) -> Derivatives:
        """Place, velocity and acceleration of the mass.

        ``step`` (m,): step of the answer in which each angle lies; ``phi`` (m,): cam angles [rad] → position,
        velocity, acceleration: x, ẋ, ẍ [m, m/s, m/s²], (m,).
        """
        return self._motion(self.departure.at(step, phi), step, phi)

    def _motion(self, parts: Derivatives, step: Indices, phi: Floats) -> Derivatives:
        """Motion of the mass from the departure and its derivatives."""
        x, v, a = (self.model.share * self._lift(k, step, phi) + part for k, part in enumerate(parts))
        return x, v * self.speed, a * self.speed**2

    def force(self, step: Indices, phi: Floats) -> Floats:
        """Force on the cam F [N], (m,), at angles ``phi`` [rad] in steps ``step`` of the answer."""
        return self._force(self.departure.at(step, phi), step, phi, 0) + self.model.preload

    def force_slope(self, step: Indices, phi: Floats) -> Floats:
        """dF/dθ [N/rad], (m,), at cam angles ``phi`` [rad] in steps ``step`` of the answer."""
        return self._force(self.departure.at(step, phi), step, phi, 1)

    def _force(self, parts: Derivatives, step: Indices, phi: Floats, order: int) -> Floats:
        """k(s − x) + cω(s′ − x′), or its derivative."""
        model = self.model
        gap, gap_d1 = (
            (1 - model.share) * self._lift(order + k, step, phi) - parts[order + k] for k in range(2)
        )
        force: Floats = model.stiffness * gap + model.damping * self.speed * gap_d1
        return force

    def departure_extremes(self) -> tuple[Extreme, Extreme]:
        """Minimum and maximum departure e [m]."""
        return self.departure.extremes(
            lambda *at: self.departure.at(*at)[0], lambda *at: self.departure.at(*at)[1]
        )

    def acceleration_extremes(self) -> tuple[Extreme, Extreme]:
        """Minimum and maximum acceleration of the mass [m/s²]."""
        return self.departure.extremes(lambda *at: self.motion(*at)[2], self._jerk)

    def _jerk(self, step: Indices, phi: Floats) -> Floats:
        """Derivative of ẍ by the cam angle, from the equation of motion."""
        model, parts = self.model, self.departure.at(step, phi)
        _, v, a = self._motion(parts, step, phi)
        frame = 2 * model.damping_ratio_frame * model.natural_frequency
        pulls: Floats = self._force(parts, step, phi, 1) / model.mass
        return pulls - (frame * a + model.spring_rate / model.mass * v) / self.speed

    def impulses(self) -> tuple[Impulse, ...]:
        """Where the cam strikes."""
        where = np.flatnonzero(self.steps)
        return tuple(Impulse(self.lift.breaks[k], float(self.steps[k] * self.speed)) for k in where)


@public
def follower_vibration(lift: MotionLaw, model: OneMass, speed: float, n: int = 720) -> FollowerVibration:
    """Periodic motion of the follower's mass at a constant speed of the cam.

    Parameters
    ----------
    lift : MotionLaw
        s over one revolution [m over rad].
    model : OneMass
        The follower.
    speed : float
        ω [rad/s].
    n : int
        Steps of the revolution in the arrays; maximum and minimum values do not depend on it.

    Returns
    -------
    FollowerVibration
        The motion.

    Raises
    ------
    InputError
        The lift jumps, or is not one revolution long; or the follower vibrates too often in one revolution.
    FindingError
        Undamped and at resonance.
    """
    in_range(speed=(speed, positive(SPEED)), n=(n, positive(COUNT)))
    without_steps(lift, "turn")
    remedy = "reduce the stiffness of its train, or increase the cam speed"
    require_within(VIBRATIONS, model.natural_frequency / speed, "follower", remedy)
    train = Train(lift, model, speed, "turn")
    phi = np.linspace(lift.start, lift.end, n + 1)
    step = train.departure.find(phi)
    x, v, a = train.motion(step, phi)
    low, high = train.departure.extremes(train.force, train.force_slope)
    impulses = train.impulses()
    return FollowerVibration(
        cam_angle=phi,
        lift=train.lift.at(phi),
        position=x,
        velocity=v,
        acceleration=a,
        force=train.force(step, phi),
        speed=speed,
        natural_frequency=model.natural_frequency,
        vibrations_per_turn=model.natural_frequency / speed,
        force_max=high.value,
        force_min=low.value,
        force_max_angle=high.at,
        force_min_angle=low.at,
        acceleration_max=_size(train.acceleration_extremes()),
        departure_max=_size(train.departure_extremes()),
        impulses=impulses,
        keeps_contact=low.value > 0,
        findings=_findings(impulses, low),
    )


def _size(extremes: tuple[Extreme, Extreme]) -> float:
    """Larger absolute value of minimum and maximum."""
    return max(abs(extreme.value) for extreme in extremes)


def _findings(impulses: tuple[Impulse, ...], low: Extreme) -> tuple[str, ...]:
    sentences = [
        f"the velocity of the lift jumps by {impulse.velocity_step:.4g} m/s at "
        f"cam angle θ = {np.degrees(impulse.cam_angle):.4g}°: impact"
        for impulse in impulses
    ]
    if low.value <= 0:
        sentences.append(
            f"the train would have to pull with {-low.value:.4g} N at cam angle θ = "
            f"{np.degrees(low.at):.4g}°: the follower leaves the cam there; increase the "
            f"preload by {-low.value:.4g} N"
        )
    return tuple(sentences)


@dataclass(frozen=True)
class VibrationSweep(Result):
    """Largest values of the periodic motion over the speed."""

    speed: Annotated[Floats, Label("speed of the cam", "ω", "rad/s")]
    force_max: Annotated[Floats, Label("maximum force of the train on the cam", "", "N")]
    force_min: Annotated[Floats, Label("minimum force of the train on the cam", "", "N")]
    acceleration_max: Annotated[Floats, Label("maximum acceleration of the mass", "", "m/s²")]
    departure_max: Annotated[Floats, Label("maximum departure from the lift", "", "m", "Of e = x − κs.")]
    keeps_contact: Annotated[Bools, About("Whether contact is maintained, shape (n,).")]


@public
def vibration_over_speed(lift: MotionLaw, model: OneMass, speeds: Column) -> VibrationSweep:
    """Largest values of the periodic motion at many speeds.

    Parameters
    ----------
    lift : MotionLaw
        s over one revolution [m over rad].
    model : OneMass
        The follower.
    speeds : array_like, shape (n,)
        ω [rad/s].

    Returns
    -------
    VibrationSweep
        Over the speed.

    Raises
    ------
    InputError
        The lift jumps, or is not one revolution long.
    FindingError
        Undamped and at resonance.
    """
    in_range(speeds=(speeds, positive(SPEED)))
    speed = np.atleast_1d(np.asarray(speeds, dtype=float))
    vibrations = [follower_vibration(lift, model, float(omega), n=1) for omega in speed]
    names = ("force_max", "force_min", "acceleration_max", "departure_max")
    high, low, acceleration, departure = (
        np.array([getattr(vibration, name) for vibration in vibrations]) for name in names
    )
    return VibrationSweep(speed, high, low, acceleration, departure, low > 0)
