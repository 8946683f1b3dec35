r"""Residual vibration after a rise: motion of the follower during the rise and in the dwell after it.

Of a rise with total lift h in the time T, the answer depends on τ = T/T_n alone, rise time over natural
period. With u = t/T, ν = 2πτ and the pole μ of all damping, the free vibration after the rise has the
amplitude |F|/Im μ,

.. math:: F(\nu) = \int_0^1 e^{\mu(1-u)}\left(\kappa s'' + 2\nu(\kappa(\zeta+\zeta_f) - \zeta)s'\right) du

jumps of s′ included: of an undamped follower, the Fourier transform of the lift's acceleration.

Source: M. P. Koster, *Vibrations of Cam Mechanisms*, Macmillan 1974, chapter 3; F. Y. Chen, *Mechanics and
Design of Cam Mechanisms*, Pergamon 1982, on residual vibration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from linkwright.cam.dynamics.follower_vibration import Train
from linkwright.cam.dynamics.one_mass import OneMass
from linkwright.cam.dynamics.oscillator import in_pieces, nodes_for, pole, steps, without_steps
from linkwright.cam.laws.motion_law import MotionLaw
from linkwright.kernel.arrays import Complexes, Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.numerics import zeros
from linkwright.kernel.public import public
from linkwright.kernel.public.arguments import Column
from linkwright.kernel.public.in_range import in_range
from linkwright.kernel.quantities import About, Label
from linkwright.kernel.result import Result
from linkwright.kernel.units.kinds import RATIO, SPEED
from linkwright.kernel.units.marks import FRACTION, Quantity, positive

# Grid on which minima of the residual are bracketed: they are about 1 apart in τ.
_GRID = 0.02

# Ratios at once: keeps the arrays of exponentials within some 10 MB.
_CHUNK = 256


class Quiet(NamedTuple):
    """A rise after which the vibration that is left is smallest.

    Attributes
    ----------
    ratio : float
        τ, rise time over natural period [–].
    residual : float
        Amplitude that is left, over the total lift [–]; of an undamped follower and a symmetric law, zero.
    """

    ratio: float
    residual: float


@dataclass(frozen=True)
class ResidualSpectrum(Result):
    """Vibration during and after a rise between dwells."""

    ratio: Annotated[Floats, Label("rise time over natural period", "τ", "–")]
    residual: Annotated[
        Floats,
        Label(
            "residual amplitude over the total lift", "", "–", "Of the free vibration as the dwell begins."
        ),
    ]
    residual_acceleration: Annotated[
        Floats, Label("residual acceleration over h/T²", "", "–", "To be compared with the law's own C_a.")
    ]
    primary: Annotated[
        Floats, Label("maximum departure from the lift during the rise, over the total lift", "", "–")
    ]
    primary_acceleration: Annotated[
        Floats, Label("maximum acceleration of the mass during the rise, over h/T²", "", "–")
    ]
    lift_total: Annotated[float, Label("total lift", "h", "m")]
    rise_angle: Annotated[float, Label("angle of the rise", "β", "rad")]
    impulses: Annotated[int, About("How often the velocity of the lift jumps.")]
    quiet: Annotated[tuple[Quiet, ...], About("Where the residual has its minima, exactly.")]


@public
def residual_spectrum(
    rise: MotionLaw,
    ratio: Column,
    *,
    damping_ratio: float = 0.0,
    damping_ratio_frame: float = 0.0,
    share: float = 1.0,
) -> ResidualSpectrum:
    """Primary and residual vibration of a rise between dwells.

    Parameters
    ----------
    rise : MotionLaw
        s over the angle of rise; the follower dwells before and after it [m over rad].
    ratio : array_like, shape (n,)
        τ, rise time over natural period [–].
    damping_ratio, damping_ratio_frame : float
        ζ of the damper in the train, ζ_f of that to the frame [–].
    share : float
        κ = k/(k + k_r) [–].

    Returns
    -------
    ResidualSpectrum
        Over τ.

    Raises
    ------
    InputError
        The lift jumps or has no total lift; a ratio or damping that makes no sense.
    """
    tau = np.atleast_1d(np.asarray(ratio, dtype=float))
    kernel = _kernel(rise, tau, (damping_ratio, damping_ratio_frame, share))
    height = _height(rise)
    residual = np.abs(kernel.amplitude(tau)) / height
    primary = np.array([_primary(kernel.course, kernel.unit, float(ratio)) for ratio in tau]) / height
    return ResidualSpectrum(
        ratio=tau,
        residual=residual,
        residual_acceleration=residual * (2 * np.pi * tau) ** 2,
        primary=primary[:, 0],
        primary_acceleration=primary[:, 1],
        lift_total=height,
        rise_angle=rise.length,
        impulses=int(np.count_nonzero(kernel.kicks)),
        quiet=_quiet(kernel, float(tau.min()), float(tau.max()), height),
    )


def residual_amplitude(
    rise: MotionLaw,
    ratio: Column,
    *,
    damping_ratio: float = 0.0,
    damping_ratio_frame: float = 0.0,
    share: float = 1.0,
) -> Floats:
    """The residual alone, as `residual_spectrum` gives it, for many ratios τ, (n,), in little time.

    `rise`: s over the angle of rise, with dwells before and after it [m over rad]; τ: rise time over natural
    period; `damping_ratio`, `damping_ratio_frame`: ζ of the damper in the train, ζ_f of that to the frame;
    `share`: κ = k/(k + k_r). Returns the amplitude of the free vibration as the dwell begins, over the total
    lift, (n,) [–]. Raises `InputError` if the lift jumps or has no total lift, or a number makes no sense.
    """
    tau = np.atleast_1d(np.asarray(ratio, dtype=float))
    kernel = _kernel(rise, tau, (damping_ratio, damping_ratio_frame, share))
    return np.asarray(np.abs(kernel.amplitude(tau)) / _height(rise))


@public
def residual_over_speed(rise: MotionLaw, model: OneMass, speed: Column) -> ResidualSpectrum:
    """Primary and residual vibration of a rise between dwells, for speeds of the cam.

    Parameters
    ----------
    rise : MotionLaw
        s over the angle of rise [m over rad].
    model : OneMass
        The follower.
    speed : array_like, shape (n,)
        ω [rad/s].

    Returns
    -------
    ResidualSpectrum
        At τ = βΩ/(2πω), in the order of the speeds.

    Raises
    ------
    InputError
        The lift jumps or has no total lift; a speed that makes no sense.
    """
    in_range(speed=(speed, positive(SPEED)))
    omega = np.atleast_1d(np.asarray(speed, dtype=float))
    return residual_spectrum(
        rise,
        rise.length * model.natural_frequency / (2 * np.pi * omega),
        damping_ratio=model.damping_ratio,
        damping_ratio_frame=model.damping_ratio_frame,
        share=model.share,
    )


def _kernel(rise: MotionLaw, tau: Floats, train: tuple[float, float, float]) -> _Kernel:
    """The rise with one mass whose natural period is the unit of time; given are ζ, ζ_f and κ."""
    zeta, zeta_f, share = train
    in_range(ratio=(tau, positive(RATIO)), share=(share, Quantity(RATIO, FRACTION)))
    without_steps(rise, "dwell")
    square = 4 * math.pi**2
    unit = OneMass(1.0, share * square, zeta, zeta_f, (1 - share) * square)
    return _Kernel(rise.placed(0.0, 1.0), unit)


def _height(rise: MotionLaw) -> float:
    low, high = rise.extremes()
    if not high.value > low.value:
        raise InputError(f"rise: found a lift that stays at {high.value:g} m, expected one that moves")
    return high.value - low.value


def _primary(course: MotionLaw, unit: OneMass, tau: float) -> tuple[float, float]:
    """Largest departure and acceleration during a rise from u = 0 to 1 that takes τ natural periods."""
    train = Train(course, unit, 1 / tau, "dwell")
    departure = max(abs(extreme.value) for extreme in train.departure_extremes())
    acceleration = max(abs(extreme.value) for extreme in train.acceleration_extremes())
    return departure, acceleration * tau**2


class _Kernel:
    """Residual amplitude of a rise, for many τ at once."""

    def __init__(self, course: MotionLaw, unit: OneMass) -> None:
        self.course, self.unit = course, unit
        self.kicks = steps(course, 1, "dwell")
        self.breaks = np.array(course.breaks)
        self.viscous = unit.share * unit.damping_ratio_all - unit.damping_ratio

    def amplitude(self, tau: Floats) -> Complexes:
        """Complex amplitude of the free vibration at the start of the dwell."""
        return self.with_slope(tau)[0]

    def with_slope(self, tau: Floats) -> tuple[Complexes, Complexes]:
        """Complex amplitude and its derivative by τ."""
        parts = [self._chunk(tau[k : k + _CHUNK]) for k in range(0, len(tau), _CHUNK)]
        value, slope = (np.concatenate(part) for part in zip(*parts, strict=True))
        return value, slope

    def _chunk(self, tau: Floats) -> tuple[Complexes, Complexes]:
        """The same for a few τ."""
        mu = pole(2 * np.pi, self.unit.damping_ratio_all)
        u, acceleration, velocity = self._nodes(float(tau.max()))
        back = 1 - u
        rotation = np.exp(mu * tau[:, None] * back)
        first, second = rotation @ velocity, rotation @ acceleration
        first_d1, second_d1 = mu * (rotation @ (back * velocity)), mu * (rotation @ (back * acceleration))
        factor = 4 * np.pi * self.viscous
        amplitude = self.unit.share * second + factor * tau * first
        found_d1 = self.unit.share * second_d1 + factor * (first + tau * first_d1)
        scale = mu.imag * tau
        return amplitude / scale, found_d1 / scale - amplitude / (scale * tau)

    def _nodes(self, tau: float) -> tuple[Floats, Floats, Floats]:
        """Nodes, with s″ and s′ there times the weights; jumps of s′ are nodes too."""
        law = self.course.derivative(2)
        starts, x, w, pieces = nodes_for(law, 2 * np.pi * tau)
        length = np.diff(starts)[:, None]
        u, weight = starts[:-1, None] + length * x, length * w
        second = (in_pieces(law, pieces, u) * weight).ravel()
        first = (in_pieces(self.course.derivative(1), pieces, u) * weight).ravel()
        none = np.zeros_like(self.breaks)
        return (
            np.concatenate([u.ravel(), self.breaks]),
            np.concatenate([second, self.kicks]),
            np.concatenate([first, none]),
        )


def _quiet(kernel: _Kernel, low: float, high: float, height: float) -> tuple[Quiet, ...]:
    if high - low < _GRID:
        return ()

    def slope(tau: Floats) -> Floats:
        value, value_d1 = kernel.with_slope(tau)
        return np.asarray((value.conj() * value_d1).real)

    tau = np.linspace(low, high, math.ceil((high - low) / _GRID) + 1)
    slopes = slope(tau)
    before = np.flatnonzero((slopes[:-1] < 0) & (slopes[1:] >= 0))
    if not len(before):
        return ()
    quiet, _ = zeros.zeros(slope, tau[before], tau[before + 1])
    # Where a double zero lies on the grid, the sign of the slope there is rounding: the end is the answer.
    candidates = np.stack([quiet, tau[before], tau[before + 1]])
    left = np.abs(kernel.amplitude(candidates.ravel())).reshape(candidates.shape) / height
    best = np.argmin(left, axis=0)
    quiet, left = candidates[best, np.arange(len(best))], left.min(axis=0)
    return tuple(Quiet(float(t), float(a)) for t, a in zip(quiet, left, strict=True))
