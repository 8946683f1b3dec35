r"""Parametric resonance of a driveline, estimated from its linear modes and the harmonics of J(φ).

The inertia of the crank changes with the amplitude :math:`J_n` at the order n of its speed ω. With the
amplitude q_i of mode i at the crank, :math:`\sum J q^2 = 1`, a pair of modes is excited where

.. math:: n\,\omega \approx \omega_i + \omega_j, \qquad
    \sigma = \frac{J_n |q_i q_j|}{8} \frac{\omega_i^2 + \omega_j^2}{\sqrt{\omega_i\omega_j}}

is the rate at which it grows in the middle of the zone, of first order in J_n, where it exceeds damping,
:math:`\sigma^2 > \delta_i \delta_j`. Half of the width of the zone, as a difference of nω, is

.. math:: \Delta = (\delta_i + \delta_j) \sqrt{\frac{\sigma^2}{\delta_i\delta_j} - 1},
    \qquad \Delta \to 2\sigma \text{ without damping}.

For i = j and one degree of freedom this is Mathieu's first zone [1]_ [2]_.

References
----------
.. [1] Nayfeh and Mook, Nonlinear Oscillations, 1979, sections 5.3 and 5.5: zones of first
   order, combinations.
.. [2] Dresig and Holzweißig, Dynamics of Machinery, 2010, section 7.2.2.3: parametric resonance.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.machine.machine import Machine
from linkwright.torsion.core.train import refer
from linkwright.torsion.excitation.drive_line import drive_line, mechanism_alone, station_damping
from linkwright.torsion.in_time.moving_train import shaft_damping
from linkwright.torsion.model.drive_train import CRANK, MOTOR

# Orders of J(φ) that count, per revolution of a cycle, and samples of a revolution for them.
_ORDERS = 12
_SAMPLES = 720


class ParametricZone(NamedTuple):
    """A zone of parametric resonance in which the crank runs, by the estimate of first order."""

    order: float  # n, of the crank speed
    frequencies: tuple[float, float]  # of both modes, equal where it is one [Hz]
    growth: float  # exponent of the disturbance in the driveline as it runs [1/s]
    distance: float  # |nω − ω_i − ω_j| over the half-width of the zone


def parametric_zones(machine: Machine, speed: float) -> Iterator[ParametricZone]:
    """Zones of first order that hold a speed of the crank [rad/s]."""
    referred = refer(drive_line(machine))
    n = referred.speed[referred.discs.index(CRANK)]
    omega, shapes = referred.modes()
    crank = int(referred.mass[referred.discs.index(CRANK)])
    harmonics, turns = _inertia_harmonics(machine)
    decay = _decay(machine, speed, shapes)
    # Modes have Σ J q² = 1; inertias of the train are those at its first disc.
    at_crank = shapes[:, crank] * n
    modes = np.flatnonzero(omega > 0)
    for i in modes:
        for j in modes[modes >= i]:
            sum_of_both = omega[i] + omega[j]
            for k, amplitude in enumerate(harmonics, start=1):
                together = (omega[i] ** 2 + omega[j] ** 2) / np.sqrt(omega[i] * omega[j])
                rate = 0.125 * amplitude * abs(at_crank[i] * at_crank[j]) * together
                product = decay[i] * decay[j]
                if rate**2 <= product or rate == 0:
                    continue
                mean = 0.5 * (decay[i] + decay[j])
                half = 2 * rate if product == 0 else 2 * mean * np.sqrt(rate**2 / product - 1)
                off = abs(k / turns * speed - sum_of_both)
                if off < half:
                    growth = float(np.sqrt(max(rate**2 - 0.25 * off**2, 0.0)) - mean)
                    pair = (float(omega[i] / (2 * np.pi)), float(omega[j] / (2 * np.pi)))
                    yield ParametricZone(k / turns, pair, growth, float(off / half))


def _inertia_harmonics(machine: Machine) -> tuple[Floats, int]:
    """Amplitudes of the harmonics of J(φ) from the first of the cycle on [kg m²], and its revolutions."""
    compiled = mechanism_alone(machine)
    samples = _SAMPLES * compiled.turns
    J = compiled.reductions(compiled.cycle * np.arange(samples) / samples).inertia
    amplitudes: Floats = 2 * np.abs(np.fft.rfft(J)) / samples
    return amplitudes[1 : _ORDERS * compiled.turns + 1], compiled.turns


def _decay(machine: Machine, speed: float, shapes: Floats) -> Floats:
    """Decay δ_i = ½ q C q of every mode by shafts, motor and loads [1/s]."""
    referred = refer(drive_line(machine))
    own, _ = shaft_damping(referred)
    damping = (referred.joins.T * (own * referred.lead**2)) @ referred.joins
    c = np.diag(referred.disc_damping).astype(float)
    for station, of_torque in station_damping(machine, speed).items():
        if station in referred.discs and station in (MOTOR, CRANK):
            disc = referred.discs.index(station)
            mass = referred.mass[disc]
            c[mass, mass] += float(of_torque) * referred.speed[disc] ** 2
    decay: Floats = 0.5 * np.einsum("ia,ab,ib->i", shapes, damping + c, shapes)
    return np.maximum(decay, 0.0)
