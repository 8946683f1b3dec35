"""What holds for every steady motion, read from its curves: which law is broken, and by how much.

The equation of motion is checked without solving it again: the acceleration is that of the torques at the
speed, and the speed is the integral of the acceleration between any two angles. A periodic pair of curves
that keeps both *is* the solution.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright import Machine
from linkwright.drive import SteadyState
from linkwright.machine import CompiledMachine, SteadyMotion, compile_machine

Floats = NDArray[np.float64]

# Nodes of a panel: Gauss's rule of degree 11.
_X, _W = np.polynomial.legendre.leggauss(6)

# Accelerations count at least against this share of ω²: of a drive that idles rounding is all that there is.
_EVEN = 1e-4

# The same against this share of what the drive alone would give, as the product says: where a machine creeps,
# drive and loads balance to nearly all digits of them.
_BALANCED = 1e-6

# Rounding of a sum of torques that nearly cancel.
_ROUNDING = 1e-13

# Rounding of a speed: it comes from sums of about ten terms, each rounded to 1.1e-16.
_ROUNDING_OF_SPEED = 2e-15


def violations(machine: Machine, steady: SteadyState, accuracy: float) -> dict[str, float]:
    """Broken laws with their error as a share of the peak, where that is larger than the accuracy.

    Parameters
    ----------
    machine : Machine
        The machine.
    steady : SteadyState
        Its steady motion.
    accuracy : float
        Largest error allowed.
    """
    found = {
        "numbers": 0.0 if all(np.isfinite(curve).all() for curve in _curves(steady)) else np.inf,
        "closure": abs(steady.speed[-1] / steady.speed[0] - 1) + abs(steady.time[-1] / steady.period - 1),
        "energy": _energy(machine, steady),
        "balance": _balance(machine, steady),
        "extremes": _outside(steady),
        "integral": _integral(machine, steady),
    }
    return {law: error for law, error in found.items() if not error <= accuracy}


def rounding(steady: SteadyState, compiled: CompiledMachine) -> float:
    """Torque that rounding makes: of the speed on the characteristic, and of what oscillates [N m].

    Where a drive idles this is all the torque that there is.

    Parameters
    ----------
    steady : SteadyState
        A steady motion.
    compiled : CompiledMachine
        Its machine.
    """
    share = 1e-6
    here, aside = (compiled.motor_torques(steady.speed * factor).crank for factor in (1.0, 1.0 + share))
    steep = np.abs(aside - here).max() / share
    return float(_ROUNDING_OF_SPEED * steep + 1e-15 * (steady.inertia_reduced * steady.speed**2).max())


def _curves(steady: SteadyState) -> list[Floats]:
    return [steady.time, steady.speed, steady.acceleration, steady.torque_motor, steady.torque_load]


def _peak(steady: SteadyState) -> float:
    peak = max(abs(steady.acceleration_min), abs(steady.acceleration_max))
    driven = float(np.abs(steady.torque_drive / steady.inertia_reduced).max())
    return max(peak, _EVEN * steady.speed_max**2, _BALANCED * driven)


def _energy(machine: Machine, steady: SteadyState) -> float:
    """Work at the crank against that of the loads, as a share of what oscillates, rounding apart.

    Work counts at least against what the acceleration of `_EVEN` takes, as the accuracy of the product says.
    """
    size = float(np.trapezoid(np.abs(steady.torque_load) + np.abs(steady.torque_drive), steady.crank_angle))
    idle = _ROUNDING * float((steady.inertia_reduced * steady.speed**2).max())
    idle += 2 * np.pi * rounding(steady, compile_machine(machine))
    size = max(size, 2 * np.pi * _EVEN * float((steady.inertia_reduced * steady.speed**2).max()))
    return max(abs(steady.energy_drive - steady.energy_load) - idle, 0.0) / max(size, idle)


def _balance(machine: Machine, steady: SteadyState) -> float:
    """ε of the curve against that of the torques, the rounding of the speed in these apart."""
    compiled = compile_machine(machine)
    at = compiled.reductions(steady.crank_angle)
    omega = steady.speed

    def torque(omega: Floats) -> Floats:
        drive = compiled.motor_torques(omega).crank
        laws = _diagonal(compiled, steady.crank_angle, omega) if compiled.has_laws else 0.0
        return drive - at.load - at.dry - at.viscous * omega - compiled.speed_load(omega) - laws

    epsilon = (torque(omega) - 0.5 * at.inertia_slope * omega**2) / at.inertia
    step = 1e-6
    steep = np.abs(torque(omega * (1 + step)) - torque(omega)) / step
    rounding = 1e-15 * steep + _ROUNDING * (np.abs(steady.torque_drive) + np.abs(at.load))
    off = np.abs(epsilon - steady.acceleration) - 4 * rounding / at.inertia
    return float(off.max()) / _peak(steady)


def _diagonal(compiled: CompiledMachine, angles: Floats, omega: Floats) -> Floats:
    return np.array(
        [compiled.law_torques(phi, w)[0, 0] for phi, w in zip(angles, omega, strict=True)], dtype=np.float64
    )


def _outside(steady: SteadyState) -> float:
    speed = max(steady.speed.max() / steady.speed_max - 1, 1 - steady.speed.min() / steady.speed_min)
    over = steady.acceleration.max() - steady.acceleration_max
    under = steady.acceleration_min - steady.acceleration.min()
    return float(max(speed, over / _peak(steady), under / _peak(steady)))


def _integral(machine: Machine, steady: SteadyState) -> float:
    """½ ω² between the ends of panels against the integral of ε over them.

    Panels in which they differ are halved: a corner of the acceleration is left in a panel so short that it
    does not count, and what is wrong stays wrong in all of them, and adds up; an acceleration that is off
    everywhere by as much as the result reports adds up to 2π of it.
    """
    compiled = compile_machine(machine)
    edges = np.unique(np.concatenate([compiled.kinks(), np.linspace(0, 2 * np.pi, 33)]))
    low, high = edges[:-1], edges[1:]
    peak, lost = _peak(steady), 0.0
    while len(low):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        nodes = middle[:, None] + half[:, None] * _X
        angles = np.concatenate([nodes.ravel(), low, high])
        # To the accuracy that is asked for: to one that was reached a coarser solution would do.
        curves = compiled.steady(angles, 1e-9)
        assert isinstance(curves, SteadyMotion)
        n, size = len(low), nodes.size
        integral = (curves.acceleration[:size].reshape(nodes.shape) @ _W) * half
        gained = 0.5 * (curves.speed[size + n :] ** 2 - curves.speed[size : size + n] ** 2)
        error = np.abs(integral - gained) / peak
        bad = ~(error <= 1e-8 * 2 * half + 1e-13 * steady.speed_max**2 / peak)
        is_short = half < 1e-6
        lost += float(error[bad & is_short].sum())
        low, high = (
            np.concatenate(pair)[np.tile(bad & ~is_short, 2)] for pair in ((low, middle), (middle, high))
        )
    return max(lost - 2 * np.pi * steady.accuracy, 0.0)
