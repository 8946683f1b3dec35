r"""The closed forms of paper 4: beam, hanger, and the lever by the cosine theorem.

Origin in the saddle bearing, y up, the well to the right; φ_1 is the direction of the crank from the x axis,
counter- clockwise, φ_3 the angle of the front arm above the horizontal. Nothing here uses the core: these
formulas are a second way to all that `linkwright.pumping.rod_rotator` computes.

At a change point (19) to (28) give 0/0 for the lever. With l_d'' the second derivative of the diagonal by
φ_1 the limits are :math:`\sqrt{l_d''\,l_4/(m\,l_5)}` at the top and :math:`\sqrt{-l_d''\,l_4/(M\,l_5)}` at
the bottom, from the half angles :math:`\cos^2\tfrac\gamma2 = \frac{(l_d - m)(l_d + M)}{4 l_d l_5}` and
:math:`\sin^2\tfrac\gamma2 = \frac{(M - l_d)(l_d + m)}{4 l_d l_5}`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.kernel.arrays import Bools, Floats


@dataclass(frozen=True)
class Unit:
    """Pumping unit and place of the pin, by the letters of paper 4 [m].

    (x, y) is the crankshaft from the saddle bearing, k_1 the front arm, l_K the free cable at the top, l_3
    the distance of the pin.
    """

    r: float
    L: float
    k: float
    k_1: float
    x: float
    y: float
    l_K: float
    l_3: float

    def front(self, phi: Floats) -> tuple[Floats, Floats]:
        """φ_3 [rad] and dφ_3/dφ_1 at directions of the crank [rad]."""
        bx, by = self.x + self.r * np.cos(phi), self.y + self.r * np.sin(phi)
        u = np.hypot(bx, by)
        # The rear arm points to −k (cos φ_3, sin φ_3), and its end is L from the pin.
        turned = np.arccos((self.k**2 + u**2 - self.L**2) / (2 * self.k * u))
        rear = np.arctan2(by, bx) - turned
        ex, ey = self.k * np.cos(rear), self.k * np.sin(rear)
        px, py = ex - bx, ey - by
        speed = self.r * (-np.sin(phi) * px + np.cos(phi) * py) / (-ey * px + ex * py)
        return np.arctan2(-ey, -ex), speed

    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Direction of the crank and φ_3 at the top, then at the bottom [rad]."""
        return self._end(self.L - self.r, -1.0), self._end(self.L + self.r, 1.0)

    def _end(self, reach: float, sign: float) -> tuple[float, float]:
        """Crank and pitman in line, the rear arm's end a distance from the shaft."""
        K = np.hypot(self.x, self.y)
        psi = np.arccos((self.k**2 + K**2 - reach**2) / (2 * self.k * K))
        rear = np.arctan2(self.y, self.x) - psi
        ex, ey = self.k * np.cos(rear), self.k * np.sin(rear)
        crank = np.arctan2(sign * (ey - self.y), sign * (ex - self.x))
        return float(crank), float(np.arctan2(-ey, -ex))

    def diagonal(self, phi_3: Floats) -> tuple[Floats, Floats]:
        """l_dx and l_dy [m], (20) and (21), at angles of the front arm [rad]."""
        top = self.ends()[0][1]
        depth = self.l_K + self.k_1 * (top - phi_3)
        return self.k_1 - self.l_3 * np.cos(phi_3), depth + self.l_3 * np.sin(phi_3)

    def extremes(self) -> tuple[float, float]:
        """Minimum and maximum l_d [m], (5) and (6)."""
        (_, top), (_, bottom) = self.ends()
        return tuple(float(np.hypot(*self.diagonal(np.asarray(end)))) for end in (top, bottom))  # type: ignore[return-value]

    def diagonal_rates(self, phi: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """l_d, its derivative by φ_1, direction from the hanger to the pin, and its derivative."""
        phi_3, rate = self.front(phi)
        dx, dy = self.diagonal(phi_3)
        dx_d1 = self.l_3 * np.sin(phi_3) * rate
        dy_d1 = (self.l_3 * np.cos(phi_3) - self.k_1) * rate
        l_d = np.hypot(dx, dy)
        turned = (dy * dx_d1 - dx * dy_d1) / l_d**2
        return l_d, (dx * dx_d1 + dy * dy_d1) / l_d, np.pi / 2 + np.arctan2(dx, dy), turned

    def l_6(self, phi_3: Floats) -> Floats:
        """Distance from the saddle bearing to the hanger [m], (9)."""
        depth = self.l_K + self.k_1 * (self.ends()[0][1] - phi_3)
        return np.hypot(self.k_1, depth)


@dataclass(frozen=True)
class LeverFormula:
    """Link l_4 and lever l_5 on a unit [m]."""

    unit: Unit
    l_4: float
    l_5: float

    def closes(self, phi: Floats) -> Bools:
        """Where link and lever can meet."""
        l_d = self.unit.diagonal_rates(phi)[0]
        return (l_d <= self.l_4 + self.l_5) & (l_d >= abs(self.l_4 - self.l_5))

    def rocking(self, phi: Floats, side: float = 1.0) -> tuple[Floats, Floats]:
        """φ_5 [rad] and dφ_5/dφ_1 with the joint always on one side; NaN where the dyad does not close."""
        l_d, l_d_d1, alpha, alpha_d1 = self.unit.diagonal_rates(phi)
        with np.errstate(invalid="ignore", divide="ignore"):
            gamma = np.arccos((l_d**2 + self.l_5**2 - self.l_4**2) / (2 * l_d * self.l_5))
            rate = -(l_d**2 - self.l_5**2 + self.l_4**2) / (2 * l_d**2 * self.l_5 * np.sin(gamma)) * l_d_d1
        return alpha + side * gamma, alpha_d1 + side * rate

    def turning(self, phi: Floats, side: float = 1.0) -> tuple[Floats, Floats]:
        """φ_5 [rad] and dφ_5/dφ_1 of a lever that goes on through its change points, φ_1 increasing.

        The side is that of the upstroke; it changes at each end of the stroke.
        """
        (top, _), (bottom, _) = self.unit.ends()
        is_up = (phi - bottom) % (2 * np.pi) <= (top - bottom) % (2 * np.pi)
        angle_up, rate_up = self.rocking(phi, side)
        angle_down, rate_down = self.rocking(phi, -side)
        angle, rate = np.where(is_up, angle_up, angle_down), np.where(is_up, rate_up, rate_down)
        return np.unwrap(angle), rate

    def change_point_rates(self) -> tuple[float, float]:
        """Limits of |dφ_5/dφ_1| at the top and at the bottom."""
        m, M = self.unit.extremes()
        rates = []
        for (angle, _), l_d in zip(self.unit.ends(), (m, M), strict=True):
            rates.append(float(np.sqrt(abs(self._curvature(angle)) * self.l_4 / (l_d * self.l_5))))
        return rates[0], rates[1]

    def _curvature(self, angle: float) -> float:
        """l_d'' where l_d' is zero: l_d'' = (dl_d/dφ_3) φ_3'', and φ_3'' from the pitman's end in line."""
        unit = self.unit
        bx, by = unit.x + unit.r * np.cos(angle), unit.y + unit.r * np.sin(angle)
        rear = unit.front(np.asarray(angle))[0] + np.pi
        ex, ey = unit.k * np.cos(rear), unit.k * np.sin(rear)
        px, py = ex - bx, ey - by
        # The second derivative of |E − B|² = L² with E' = 0: (E'' − B'')·(E − B) + |B'|² = 0.
        second = (unit.r * (-np.cos(angle) * px - np.sin(angle) * py) - unit.r**2) / (-ey * px + ex * py)
        phi_3 = rear - np.pi
        dx, dy = unit.diagonal(np.asarray(phi_3))
        slope = (dx * unit.l_3 * np.sin(phi_3) + dy * (unit.l_3 * np.cos(phi_3) - unit.k_1)) / np.hypot(
            dx, dy
        )
        return float(slope * second)
