r"""Formulas of paper 2 as printed, and their checks.

.. math:: x^{(n)} = v\,t_p^{1-n} f_n(u), \qquad u = t/t_p

for each section of a stroke, equations (1) to (3), and the radius :math:`\rho(\varphi)` of the cam,
equations (17) to (22). The numbers are those of ``paper2.toml``.

All differences are the largest over many points, as a share of the largest value.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from linkwright.cam.profile.profile import CamProfile
from linkwright.kernel.arrays import Floats

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
        values: Floats = scale * self.polynomial(section, order)(u)
        return values

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
        peak = 0.0
        for section in SECTIONS:
            roots = self.polynomial(section, order).deriv().roots()
            inside = roots[np.isreal(roots)].real
            u = np.concatenate(([0.0, 1.0], inside[(inside > 0) & (inside < 1)]))
            peak = max(peak, float(np.abs(self.over(section, order, u)).max()))
        return peak

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
        branch: Floats = self.stroke * (row["from"] + fraction(row["factor"]) * bracket)
        return branch


# Points of a stroke: middles of equal parts, none of them on a joint.
_POINTS = 3600


def checks(formulas: Formulas, profile: CamProfile) -> dict[str, Any]:
    """Differences [–] by name of the check; ``places`` and ``travels`` by the law of the machine [m]."""
    law = profile.cam.lift
    places = [float(law.at(x)) for x in (0.0, *law.breaks[1:4])]
    return {
        "places": places,
        "travels": dict(zip(SECTIONS, np.diff(places).tolist(), strict=False)),
        "motion": [motion_difference(formulas, profile, order) for order in range(4)],
        "chain": {section: _chain(formulas, section) for section in SECTIONS},
        "mirror": _mirror(formulas),
        "joint": _joint(formulas),
        "radius": radius_difference(formulas, profile),
        "radius_joint": _radius_joint(formulas),
        "diameter": diameter_difference(formulas, profile),
    }


def motion_difference(formulas: Formulas, profile: CamProfile, order: int) -> float:
    """(1) to (3), there and back, against the law of the machine at its design speed, derivative by time."""
    time = (np.arange(_POINTS) + 0.5) / _POINTS * formulas.time
    omega = np.pi / formulas.time
    printed = formulas.stroke_motion(time, order)
    there, back = (profile.cam.lift.at(omega * time + turn, order) * omega**order for turn in (0, np.pi))
    start = formulas.stroke if order == 0 else 0.0
    return max(_share(there, printed), _share(back, start - printed))


def radius_difference(formulas: Formulas, profile: CamProfile) -> float:
    """(17) to (22) against the curve that the core puts under the follower."""
    phi = (np.arange(2 * _POINTS) + 0.5) / _POINTS * np.pi
    x, y = profile.flanks[0].curve().points(phi).T
    printed = formulas.radius(phi, breadth_of(profile))
    # The point that will touch at φ lies at −φ as the cam stands at its start.
    off = np.hypot(x - printed * np.cos(phi), y + printed * np.sin(phi))
    return float(off.max() / printed.max())


def diameter_difference(formulas: Formulas, profile: CamProfile) -> float:
    """ρ(φ) + ρ(φ + π) by (17) to (22) against b."""
    phi, b = (np.arange(_POINTS) + 0.5) / _POINTS * np.pi, breadth_of(profile)
    apart = formulas.radius(phi, b) + formulas.radius(phi + np.pi, b)
    return float(np.abs(apart - b).max() / b)


def _chain(formulas: Formulas, section: str) -> float:
    """Whether each line of (1) to (3) is the derivative of the line before, by its coefficients."""
    lines = [formulas.polynomial(section, order) for order in range(4)]
    off = [(line.deriv() - after).coef for line, after in pairwise(lines)]
    largest = max(float(np.abs(line.coef).max()) for line in lines)
    return max(float(np.abs(value).max()) for value in off) / largest


def _mirror(formulas: Formulas) -> float:
    """Whether (3) is (1) run through backwards, by its values."""
    u = np.linspace(0.0, 1.0, 101)
    start, stop = formulas.polynomial("start", 0), formulas.polynomial("stop", 0)
    return _share(stop(u), start(1.0) - start(1 - u))


def _joint(formulas: Formulas) -> float:
    """Whether velocity and acceleration pass from (1) to (2) and from (2) to (3) without a step."""
    scale, ends = formulas.speed / formulas.times["start"], np.array([0.0, 1.0])
    steps = []
    for order in (1, 2):
        values = [formulas.over(section, order, ends) for section in SECTIONS]
        steps += [abs(a[1] - b[0]) for a, b in pairwise(values)]
    return float(max(steps) / scale)


def _radius_joint(formulas: Formulas) -> float:
    """Whether (17) meets (18), (18) meets (19), and the two half revolutions meet."""
    ends = np.array([*formulas.branch_begins, np.pi])
    values = [formulas.branch(n, ends[n : n + 2]) for n in range(3)]
    steps = [before[1] - after[0] for before, after in pairwise(values)]
    # The return is the same with the other sign: the forward stroke has to end as far out as it begins in.
    steps.append(values[-1][1] + values[0][0])
    return float(np.abs(steps).max() / formulas.stroke)


def breadth_of(profile: CamProfile) -> float:
    """b of the cam [m]."""
    assert profile.cam.breadth is not None
    return profile.cam.breadth


def _share(computed: Floats, printed: Floats) -> float:
    """Largest difference over the largest value."""
    return float(np.abs(computed - printed).max() / np.abs(printed).max())
