"""The two-cart drive by hand: the energy equation of paper 1 over the crank angle, with SciPy.

Scalar `math` functions in the right-hand side, energy for the state (no dJ/dφ), DOP853, extremes from its
dense output: what someone writes who knows both the theory and SciPy well.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

R, L, G = 0.2, 0.8, 9.81
LAM = R / L
ROD = 80.0 * L
J_DRIVE = 0.504 * 9.8**2

# The cycle counts as repeated when its energy does to this many times the solver's tolerance: below that the
# solver's own errors decide.
REPEATED = 10.0


@dataclass(frozen=True)
class Drive:
    """What the batch varies; masses [kg], force [N], phase [rad]."""

    mass_1: float = 1000.0
    mass_2: float = 1000.0
    force: float = 3562.0
    phase: float = pi / 2


@dataclass(frozen=True)
class Cycle:
    """One revolution of steady motion."""

    speed_min: float
    speed_max: float
    acceleration_max: float
    period: float
    turns: int


def reduced(phi: float, drive: Drive) -> tuple[float, float]:
    """J [kg m²] and load torque [N m] at a crank angle."""
    J, M = J_DRIVE, 0.0
    for mass, angle in ((drive.mass_1, phi), (drive.mass_2, phi + drive.phase)):
        sa, ca = sin(angle), cos(angle)
        D = sqrt(1.0 - (LAM * sa) ** 2)
        x1 = -R * sa * (1.0 + LAM * ca / D)
        xs1 = -R * sa * (1.0 + 0.5 * LAM * ca / D)
        ys1 = 0.5 * R * ca
        beta1 = -LAM * ca / D
        J += mass * x1 * x1 + ROD * (xs1 * xs1 + ys1 * ys1) + ROD * L * L / 12.0 * beta1 * beta1
        M += drive.force * abs(x1) + ROD * G * ys1
    return J, M


def motor(omega: float) -> float:
    """Torque at the crank [N m]: Kloss above breakdown, the catalogue's parabola below."""
    speed = 9.8 * omega
    if speed >= 94.95:
        s, s_k = 1.0 - speed / 104.72, 1.0 - 94.95 / 104.72
        torque = 2.0 * 215.4 * s * s_k / (s * s + s_k * s_k)
    else:
        z = speed / 94.95
        torque = 129.24 + (215.4 - 129.24) * z * (2.0 - z)
    return torque * 9.8 * 0.9


def turn(drive: Drive, energy: float, rtol: float) -> Any:
    """One revolution from an energy [J]: energy and time over the crank angle."""
    from scipy.integrate import solve_ivp

    def slope(phi: float, y: Any) -> tuple[float, float]:
        J, M = reduced(phi, drive)
        omega = sqrt(2.0 * y[0] / J)
        return motor(omega) - M, 1.0 / omega

    # Energies are some 5 kJ, times some 0.6 s.
    scale = [1e3 * rtol, 0.1 * rtol]
    options: dict[str, Any] = {"method": "DOP853", "rtol": rtol, "atol": scale, "dense_output": True}
    return solve_ivp(slope, (0.0, 2 * pi), [energy, 0.0], **options)


def steady(drive: Drive, speed: float, rtol: float = 1e-8) -> Cycle:
    """Revolution by revolution from a speed at φ = 0 until the cycle repeats, then its extremes."""
    energy = 0.5 * reduced(0.0, drive)[0] * speed * speed
    turns = 0
    while True:
        found = turn(drive, energy, rtol)
        turns += 1
        end = float(found.y[0, -1])
        if abs(end - energy) <= REPEATED * rtol * end:
            return measured(drive, found, turns)
        energy = end


def measured(drive: Drive, found: Any, turns: int) -> Cycle:
    """Extremes of a revolution from its dense output, on a grid of a quarter degree."""
    phi = np.linspace(0.0, 2 * pi, 1441)
    E = found.sol(phi)[0]
    J, J_d1, M = reduced_arrays(phi, drive)
    omega = np.sqrt(2.0 * E / J)
    drive_torque = np.array([motor(w) for w in omega.tolist()])
    epsilon = (drive_torque - M - 0.5 * J_d1 * omega**2) / J
    steepest = max(peak(epsilon), peak(-epsilon))
    return Cycle(-peak(-omega), peak(omega), steepest, float(found.y[1, -1]), turns)


def reduced_arrays(phi: Any, drive: Drive) -> tuple[Any, Any, Any]:
    """J, dJ/dφ and load torque at many angles."""
    J, J_d1, M = np.full_like(phi, J_DRIVE), np.zeros_like(phi), np.zeros_like(phi)
    for mass, angle in ((drive.mass_1, phi), (drive.mass_2, phi + drive.phase)):
        sa, ca = np.sin(angle), np.cos(angle)
        D = np.sqrt(1.0 - (LAM * sa) ** 2)
        bend = (ca * ca - sa * sa) / D + (LAM * sa * ca) ** 2 / D**3
        x1, x2 = -R * sa * (1.0 + LAM * ca / D), -R * (ca + LAM * bend)
        xs1, xs2 = -R * sa * (1.0 + 0.5 * LAM * ca / D), -R * (ca + 0.5 * LAM * bend)
        ys1, ys2 = 0.5 * R * ca, -0.5 * R * sa
        beta1, beta2 = -LAM * ca / D, LAM * sa * (1.0 - LAM * LAM) / D**3
        J_rod = ROD * L * L / 12.0
        J += mass * x1 * x1 + ROD * (xs1 * xs1 + ys1 * ys1) + J_rod * beta1 * beta1
        J_d1 += 2.0 * (mass * x1 * x2 + ROD * (xs1 * xs2 + ys1 * ys2) + J_rod * beta1 * beta2)
        M += drive.force * np.abs(x1) + ROD * G * ys1
    return J, J_d1, M


def peak(y: Any) -> float:
    """Largest value of a periodic curve: the parabola through the best sample and its neighbours."""
    k = int(np.argmax(y[:-1]))
    left, top, right = y[k - 1] if k else y[-2], y[k], y[k + 1]
    return float(top - (right - left) ** 2 / (8.0 * (left - 2.0 * top + right)))
