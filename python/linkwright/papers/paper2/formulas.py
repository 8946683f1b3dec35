r"""The closed forms of paper 2 as printed, a second way beside the motion laws and the core.

.. math:: x^{(n)} = v\,t_p^{1-n} f_n(u), \qquad u = t/t_p

for each section of a stroke, equations (1) to (3), and the radius :math:`\rho(\varphi)` of the cam,
equations (17) to (22). The numbers are those of ``paper2.toml``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
SECTIONS = ("start", "steady", "stop")


def fraction(pair: list[float]) -> float:
    """The value of a printed fraction."""
    return pair[0] / pair[1]


@dataclass(frozen=True)
class Formulas:
    """The printed formulas for the printed stroke and time, from ``paper2.toml``."""

    printed: dict[str, Any]

    @property
    def stroke(self) -> float:
        """Δx [m]."""
        return float(self.printed["given"]["stroke"])

    @property
    def time(self) -> float:
        """t_3, of one stroke [s]."""
        return float(self.printed["given"]["time"])

    @property
    def speed(self) -> float:
        """v = 15 Δx/(13 t_3) [m/s], (8)."""
        return self.fractions["speed"] * self.stroke / self.time

    @property
    def fractions(self) -> dict[str, float]:
        """Travels over v t, speed over Δx/t_3, ends of the steady section over Δx [–], (4) to (10)."""
        return {name: fraction(pair) for name, pair in self.printed["travel"].items()}

    @property
    def times(self) -> dict[str, float]:
        """t_p, t_y and t_g by section [s]."""
        return {name: fraction(self.printed["given"][name]) * self.time for name in SECTIONS}

    @property
    def travels(self) -> dict[str, float]:
        """S_p, S_y and S_g by section [m]."""
        return {name: self.fractions[name] * self.speed * time for name, time in self.times.items()}

    @property
    def steady_ends(self) -> tuple[float, float]:
        """Where constant speed begins and ends [m], (9) and (10)."""
        return self.fractions["steady_from"] * self.stroke, self.fractions["steady_to"] * self.stroke

    def polynomial(self, section: str, order: int) -> np.polynomial.Polynomial:
        """f_n(u) of a section, n the order of the derivative."""
        row = self.printed[section]["motion"][order]
        return np.polynomial.Polynomial([row["factor"] * term for term in row["terms"]])

    def over(self, section: str, order: int, u: Floats) -> Floats:
        """Position in the section, or a derivative of it [m, m/s, …], at shares u of its time."""
        scale = self.speed * self.times[section] ** (1 - order)
        found: Floats = scale * self.polynomial(section, order)(u)
        return found

    def stroke_motion(self, time: Floats, order: int) -> Floats:
        """Position, or a derivative of it [m, m/s, …], over a stroke that begins at 0 s and 0 m."""
        value, begin, place = np.zeros_like(time), 0.0, 0.0
        for section, length in self.times.items():
            here = time >= begin
            start = place if order == 0 else 0.0
            value[here] = start + self.over(section, order, (time[here] - begin) / length)
            begin, place = begin + length, place + self.travels[section]
        return value

    def peak(self, order: int) -> float:
        """Largest value of a derivative over a stroke by (1) to (3), from the zeros of the next one."""
        found = 0.0
        for section in SECTIONS:
            roots = self.polynomial(section, order).deriv().roots()
            inside = roots[np.isreal(roots)].real
            u = np.concatenate(([0.0, 1.0], inside[(inside > 0) & (inside < 1)]))
            found = max(found, float(np.abs(self.over(section, order, u)).max()))
        return found

    def radius(self, angle: Floats, breadth: float) -> Floats:
        """ρ by (17) to (22) [m], at φ from 0 to 2π, b the breadth [m]."""
        back = angle >= np.pi
        half = np.where(back, angle - np.pi, angle)
        from_middle = np.zeros_like(half)
        for n, begin in enumerate(self.branch_begins):
            here = half >= begin
            from_middle[here] = self.branch(n, half[here])
        return 0.5 * breadth + np.where(back, -from_middle, from_middle)

    @property
    def branch_begins(self) -> list[float]:
        """Angles at which (17), (18) and (19) begin [rad]."""
        return [fraction(row["begin"]) * np.pi for row in self.printed["profile"]]

    def branch(self, number: int, angle: Floats) -> Floats:
        """ρ − b/2 by one of (17) to (19), counted from 0 [m]."""
        row = self.printed["profile"][number]
        bracket = np.polynomial.Polynomial(row["terms"])((angle - self.branch_begins[number]) / np.pi)
        found: Floats = self.stroke * (row["from"] + fraction(row["factor"]) * bracket)
        return found
