"""Steady motion against SciPy's DOP853 on a model written by hand from paper 1, equations (1) to (10).

The model shares nothing with the package: energy as the state over the angle, carts in closed form, from one
corner of the friction to the next; the energy at the start is the root of what a cycle adds to it. Without a
starting torque Kloss's formula holds at all speeds.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from linkwright import Machine, steady_state

G = 9.81

# DOP853 at 1e-11 a step leaves about 1e-9 in the speed; the extremes are found on its dense output, of
# order 7, whose error is some ten times that of the steps.
RTOL, AGREES = 1e-11, 1e-7


@dataclass
class Variant:
    """Numbers of a machine with carts on one crankshaft."""

    phases: tuple[float, ...] = (0.0, np.pi / 2)
    masses: tuple[float, ...] = (1000.0, 1000.0)
    offsets: tuple[float, ...] = (0.0, 0.0)
    r: float = 0.2
    rod: float = 0.8
    q: float = 80.0
    force: float = 3562.0
    ratio: float = 9.8
    eta: float = 0.9
    reverse: float | None = 0.9
    stator: float = 0.0
    inertia: float = 0.504
    viscous: float = 0.0
    motor: tuple[float, float, float] = (104.72, 94.95, 215.4)

    def machine(self) -> Machine:
        n = range(len(self.phases))
        omega_0, omega_k, M_k = self.motor
        loads = {f"roll{k}": {"kind": "dry", "on": f"cart{k}", "force": self.force} for k in n}
        oil = {"oil": {"kind": "viscous", "on": "A0", "damping_torsional": self.viscous}}
        return Machine.model_validate(
            {
                "format": 1,
                "name": "variant",
                "drive": {
                    "motor": {
                        "kind": "induction",
                        "speed_synchronous": omega_0,
                        "speed_breakdown": omega_k,
                        "torque_breakdown": M_k,
                        "resistance_ratio": self.stator,
                        "inertia": self.inertia,
                    },
                    "gearbox": {
                        "ratio": self.ratio,
                        "efficiency": self.eta,
                        **({"reverse": self.reverse} if self.reverse is not None else {}),
                    },
                },
                "mechanism": {
                    "cranks": {f"A{k}": {"radius": self.r, "phase": self.phases[k]} for k in n},
                    "sliders": {
                        f"cart{k}": {"crank": f"A{k}", "rod": self.rod, "offset": self.offsets[k]} for k in n
                    },
                },
                "bodies": {f"cart{k}": {"mass": self.masses[k]} for k in n}
                | {f"cart{k}.rod": {"mass_per_length": self.q} for k in n},
                "loads": loads | {"gravity": {"kind": "gravity", "acceleration": G}} | oil,
            }
        )

    def reduced(self, phi: float) -> tuple[float, float]:
        """I(φ) and M_0(φ), equations (5) and (10), for a guide at height e."""
        J, M = self.inertia * self.ratio**2, 0.0
        m_rod = self.q * self.rod
        for phase, mass, e in zip(self.phases, self.masses, self.offsets, strict=True):
            a = phi + phase
            sin_beta = (e - self.r * np.sin(a)) / self.rod
            cos_beta = np.sqrt(1 - sin_beta**2)
            beta_d1 = -self.r * np.cos(a) / (self.rod * cos_beta)
            x_d1 = -self.r * np.sin(a) - self.rod * sin_beta * beta_d1
            xs_d1 = -self.r * np.sin(a) - 0.5 * self.rod * sin_beta * beta_d1
            ys_d1 = 0.5 * self.r * np.cos(a)
            J += mass * x_d1**2 + m_rod * (xs_d1**2 + ys_d1**2) + m_rod * self.rod**2 / 12 * beta_d1**2
            M += self.force * abs(x_d1) + m_rod * G * ys_d1
        return J, M

    def drive(self, omega: float) -> float:
        """Torque at the crank, equations (8) and (9), with stator resistance and reverse factor."""
        omega_0, omega_k, M_k = self.motor
        s, s_k = (omega_0 - self.ratio * omega) / omega_0, (omega_0 - omega_k) / omega_0
        a = self.stator
        # Multiplied by s s_k, so that it holds at s = 0.
        M = 2 * M_k * (1 + a * s_k) * s * s_k / (s * s + s_k * s_k + 2 * a * s_k * s * s_k)
        back = 1 / self.eta if self.reverse is None else self.reverse
        return M * self.ratio * (self.eta if M >= 0 else back)

    def slope(self, phi: float, y: np.ndarray) -> list[float]:
        """dE/dφ and dt/dφ."""
        J, M = self.reduced(phi)
        omega = np.sqrt(2 * y[0] / J)
        return [self.drive(omega) - M - self.viscous * omega, 1 / omega]

    def corners(self) -> list[float]:
        """Angles from 0 to 2π where a cart turns back: crank and rod in one line."""
        found = [0.0, 2 * np.pi]
        for phase, e in zip(self.phases, self.offsets, strict=True):
            for a in (np.arcsin(e / (self.rod + self.r)), np.pi + np.arcsin(e / (self.r - self.rod))):
                found.append((a - phase) % (2 * np.pi))
        return sorted(found)

    def turn(self, start: np.ndarray, dense: bool = False) -> tuple[np.ndarray, list]:
        """One revolution, from corner to corner."""
        y, pieces = start, []
        for low, high in pairwise(self.corners()):
            if high - low < 1e-12:
                continue
            done = solve_ivp(self.slope, (low, high), y, "DOP853", rtol=RTOL, atol=1e-12, dense_output=dense)
            y = done.y[:, -1]
            pieces.append((low, high, done.sol))
        return y, pieces

    def solve(self) -> tuple[float, float, float]:
        """ω_min, ω_max and the period of steady motion, by secant steps on the map of a revolution."""
        J0 = self.reduced(0.0)[0]
        top = self.motor[0] / self.ratio

        def gain(log_E: float) -> float:
            end, _ = self.turn(np.array([np.exp(log_E), 0.0]))
            return float(np.log(end[0]) - log_E)

        low, high = (np.log(0.5 * J0 * (share * top) ** 2) for share in (0.93, 1.05))
        E = np.exp(brentq(gain, low, high, xtol=1e-13, rtol=1e-14))
        end, pieces = self.turn(np.array([E, 0.0]), dense=True)
        speeds = [self.extremes(*piece) for piece in pieces]
        return min(low for low, _ in speeds), max(high for _, high in speeds), float(end[1])

    def extremes(self, low: float, high: float, sol) -> tuple[float, float]:
        """Minimum and maximum speed of a piece, closed in on three times."""

        def omega(phi: float) -> float:
            return float(np.sqrt(2 * sol(phi)[0] / self.reduced(phi)[0]))

        found = []
        for sign in (-1, 1):
            a, b = low, high
            for _ in range(4):
                phi = np.linspace(a, b, 81)
                best = int(np.argmax([sign * omega(each) for each in phi]))
                a, b = phi[max(best - 1, 0)], phi[min(best + 1, 80)]
            found.append(omega(phi[best]))
        return found[0], found[1]


VARIANTS = {
    "two carts": Variant(),
    "another phase": Variant(phases=(0.0, 1.1)),
    "unequal masses": Variant(masses=(1500.0, 400.0)),
    "offset guides": Variant(offsets=(0.15, -0.08)),
    "another ratio": Variant(ratio=7.3, inertia=0.8, viscous=3.0),
    "stator resistance": Variant(stator=0.8, viscous=5.0),
    "one cart, load drives the motor, reverse by default": Variant(
        phases=(0.3,), masses=(1000.0,), offsets=(0.0,), reverse=None, motor=(104.72, 92.0, 600.0)
    ),
    "three carts": Variant(
        phases=(0.0, 2 * np.pi / 3, 4 * np.pi / 3),
        masses=(1000.0,) * 3,
        offsets=(0.0,) * 3,
        motor=(104.72, 95.0, 400.0),
    ),
}


@pytest.mark.parametrize("name", VARIANTS)
def test_steady_motion_agrees(name: str) -> None:
    variant = VARIANTS[name]
    low, high, period = variant.solve()
    found = steady_state(variant.machine(), accuracy=1e-11)
    assert found.speed_min == pytest.approx(low, rel=AGREES)
    assert found.speed_max == pytest.approx(high, rel=AGREES)
    assert found.period == pytest.approx(period, rel=AGREES)
