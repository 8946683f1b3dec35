"""The equation of motion of `random_drives` written out anew, from kinematics to motor: it shares no line
with the product, and is what drives are integrated by in `stiff_drives`.

Every function takes real or complex crank angles: a derivative by φ is the imaginary part at φ + ih over h
(Squire and Trapp 1998), exact to rounding.
"""

from __future__ import annotations

import bisect
import cmath
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Table = dict[str, Any]

# Step of derivatives by complex numbers: nothing is subtracted, so it may be as small as this.
_H = 1e-30

# Instants that are kept.
_KNOWN = 64

# Gravity of the product [m/s²].
_G = 9.81

# A point over the crank angle: x, y and their first and second derivatives.
Place = tuple[complex, complex, complex, complex, complex, complex]


def turned(length: complex, angle: complex, rate: complex, bend: complex) -> Place:
    """The end of a vector from the origin at an angle with first and second derivatives."""
    x, y = length * cmath.cos(angle), length * cmath.sin(angle)
    return x, y, -y * rate, x * rate, -y * bend - x * rate**2, x * bend - y * rate**2


def between(a: Place, b: Place, share: complex) -> Place:
    """The point at a share of the way from one point to another."""
    return tuple(p + share * (q - p) for p, q in zip(a, b, strict=True))  # type: ignore[return-value]


def angle_rates(a: Place, b: Place) -> tuple[complex, complex]:
    """First and second derivative of the angle of the line from a to b."""
    x, y, x1, y1, x2, y2 = (q - p for p, q in zip(a, b, strict=True))
    square, cross = x * x + y * y, x * y1 - y * x1
    rate = cross / square
    return rate, (x * y2 - y * x2) / square - rate * 2 * (x * x1 + y * y1) / square


@dataclass
class Instant:
    """All that moves at one crank angle: J and J′/2, load torques by their dependence on the speed."""

    inertia: complex = 0j
    half_slope: complex = 0j
    load: complex = 0j
    viscous: complex = 0j
    # Of each load by a formula: torque per c·tanh(k ω), and k.
    tanh: list[tuple[complex, complex]] = field(default_factory=list)

    def add_mass(self, mass: float, at: Place) -> None:
        self.inertia += mass * (at[2] ** 2 + at[3] ** 2)
        self.half_slope += mass * (at[2] * at[4] + at[3] * at[5])

    def add_disc(self, inertia: complex, rate: complex, bend: complex) -> None:
        self.inertia += inertia * rate**2
        self.half_slope += inertia * rate * bend


class ByHand:
    """A random drive.

    Parameters
    ----------
    tables : dict
        Its description as `random_drives` makes it, with a motor of kind ``dc``, ``induction`` or ``table``.
    """

    def __init__(self, tables: Table) -> None:
        self.tables = tables = _plain(tables)
        # Instants at the last crank angles: an implicit method asks for each several times.
        self._known: dict[complex, Instant] = {}
        self.mechanism, self.loads = tables["mechanism"], tables["loads"]
        drive = tables["drive"]
        self.motor = drive["motor"]
        self.ratio, efficiency = drive["gearbox"]["ratio"], drive["gearbox"]["efficiency"]
        reverse = drive["gearbox"].get("reverse", 1.0 / efficiency)
        self.factors = efficiency, efficiency if reverse == "same" else reverse
        rotating = self.motor.get("inertia", 0.0) * self.ratio**2
        self.rotating = rotating + drive.get("flywheel", {}).get("inertia", 0.0)
        # Senses in which what is under dry friction moves; empty: those at each angle.
        self.senses: dict[str, float] = {}
        self.has_gravity = any(load["kind"] == "gravity" for load in self.loads.values())

    def instant(self, phi: complex) -> Instant:
        if phi not in self._known:
            if len(self._known) > _KNOWN:
                self._known.clear()
            self._known[phi] = self._instant(phi)
        return self._known[phi]

    def _instant(self, phi: complex) -> Instant:
        found = Instant(inertia=self.rotating + 0j)
        places: dict[str, tuple[Place, complex, complex]] = {}
        origin: Place = (0j,) * 6  # type: ignore[assignment]
        for name, crank in self.mechanism["cranks"].items():
            pin = turned(crank["radius"], phi + crank.get("phase", 0.0), 1.0, 0.0)
            places[name] = (pin, cmath.sqrt(pin[2] ** 2 + pin[3] ** 2), 0j)
            self._add_link(found, name, origin, pin, crank["radius"])
        for name, slider in self.mechanism.get("sliders", {}).items():
            self._add_slider(found, name, slider, places[slider["crank"]][0], places)
        for name, rocker in self.mechanism.get("rockers", {}).items():
            self._add_rocker(found, name, rocker, places[rocker["crank"]][0], places)
        for name, lever in self.mechanism.get("slotted_levers", {}).items():
            pivot = self._fixed(lever["pivot"])
            rate, bend = angle_rates(pivot, places[lever["pin"]][0])
            pin = places[lever["pin"]][0]
            way = cmath.atan((pin[1] - pivot[1]) / (pin[0] - pivot[0]))
            if (pin[0] - pivot[0]).real < 0:
                way += math.pi
            end = turned(lever["length"], way, rate, bend)
            end = (end[0] + pivot[0], end[1] + pivot[1], *end[2:])
            self._add_link(found, name, pivot, end, lever["length"])
        for load in self.loads.values():
            self._add_load(found, load, places, phi)
        return found

    def _fixed(self, name: str) -> Place:
        point = self.mechanism["points"][name]
        return (point["x"] + 0j, point["y"] + 0j, 0j, 0j, 0j, 0j)

    def _add_link(self, to: Instant, name: str, start: Place, end: Place, length: float) -> None:
        """A body on a link: its mass in the middle, its own inertia or that of a slender rod."""
        body = self.tables["bodies"].get(name)
        if body is None:
            return
        middle = between(start, end, 0.5)
        self._add_point(to, body["mass"], middle)
        inertia = body.get("inertia", body["mass"] * length**2 / 12)
        to.add_disc(inertia, *angle_rates(start, end))

    def _add_point(self, to: Instant, mass: float, at: Place) -> None:
        to.add_mass(mass, at)
        if self.has_gravity:
            to.load += mass * _G * at[3]

    def _add_slider(
        self,
        to: Instant,
        name: str,
        slider: Table,
        pin: Place,
        places: dict[str, tuple[Place, complex, complex]],
    ) -> None:
        """s on a line at an angle, shifted to its left by the offset; the farther of two."""
        t = math.cos(slider["angle"]), math.sin(slider["angle"])
        along = [t[0] * pin[k] + t[1] * pin[k + 1] for k in (0, 2, 4)]
        aside = [t[0] * pin[k + 1] - t[1] * pin[k] for k in (0, 2, 4)]
        aside[0] -= slider["offset"]
        root = cmath.sqrt(slider["rod"] ** 2 - aside[0] ** 2)
        fall = aside[0] * aside[1] / root
        s1 = along[1] - fall
        s2 = along[2] - (aside[1] ** 2 + aside[0] * aside[2] + fall**2) / root
        s = along[0] + root
        x, y = s * t[0] - slider["offset"] * t[1], s * t[1] + slider["offset"] * t[0]
        end: Place = (x, y, s1 * t[0], s1 * t[1], s2 * t[0], s2 * t[1])
        places[name] = (end, s1, s1)
        self._add_link(to, f"{name}.rod", pin, end, slider["rod"])
        if body := self.tables["bodies"].get(name):
            self._add_point(to, body["mass"], end)

    def _add_rocker(
        self,
        to: Instant,
        name: str,
        rocker: Table,
        pin: Place,
        places: dict[str, tuple[Place, complex, complex]],
    ) -> None:
        """The joint of two links between two points, on the left or right of the way from pin to pivot."""
        pivot, a, b = self._fixed(rocker["pivot"]), rocker["coupler"], rocker["rocker"]
        x, y = pivot[0] - pin[0], pivot[1] - pin[1]
        square = x * x + y * y
        share = (square + a * a - b * b) / (2 * square)
        height = cmath.sqrt(a * a / square - share**2) * (1 if rocker["assembly"] == "left" else -1)
        joint = [pin[0] + share * x - height * y, pin[1] + share * y + height * x]
        # (joint − pin)·(joint′ − pin′) = 0 and (joint − pivot)·joint′ = 0, and once more derived.
        u = joint[0] - pin[0], joint[1] - pin[1]
        v = joint[0] - pivot[0], joint[1] - pivot[1]
        det = u[0] * v[1] - u[1] * v[0]

        def solved(right: complex, other: complex) -> tuple[complex, complex]:
            return (right * v[1] - u[1] * other) / det, (u[0] * other - v[0] * right) / det

        first = solved(u[0] * pin[2] + u[1] * pin[3], 0j)
        apart = (first[0] - pin[2]) ** 2 + (first[1] - pin[3]) ** 2
        second = solved(u[0] * pin[4] + u[1] * pin[5] - apart, -(first[0] ** 2) - first[1] ** 2)
        end: Place = (*joint, *first, *second)  # type: ignore[assignment]
        places[name] = (end, b * angle_rates(pivot, end)[0], 0j)
        self._add_link(to, f"{name}.coupler", pin, end, a)
        self._add_link(to, f"{name}.rocker", pivot, end, b)
        if body := self.tables["bodies"].get(name):
            self._add_point(to, body["mass"], end)

    def _add_load(
        self, to: Instant, load: Table, places: dict[str, tuple[Place, complex, complex]], phi: complex
    ) -> None:
        kind = load["kind"]
        if kind in ("gravity", "torque_speed"):
            return
        if kind == "formula" and "torque" in load:
            size = float(load["torque"].split("*")[0][1:])
            to.tanh.append((size * (0.3 + cmath.sin(phi) ** 2), 1.0 + 0j))
            return
        on = load["between"][0] if kind == "spring" else load["on"]
        at, path, slide = places[on]
        if kind == "dry":
            to.load += load["force"] * path * self.senses.get(on, math.copysign(1.0, path.real))
        elif kind == "viscous":
            to.viscous += load["damping"] * path**2
        elif kind == "force":
            way = load["direction"]
            to.load -= load["force"] * (math.cos(way) * at[2] + math.sin(way) * at[3])
        elif kind == "spring":
            length = cmath.sqrt(at[0] ** 2 + at[1] ** 2)
            to.load += (
                load["stiffness"] * (length - load["free_length"]) * (at[0] * at[2] + at[1] * at[3]) / length
            )
        elif "direction" in load:
            to.viscous += load["constants"]["c"] * at[2] ** 2
        else:
            to.tanh.append((load["constants"]["c"] * slide, 20.0 * slide))

    def motor_torque(self, speed: float) -> tuple[float, float]:
        motor = self.motor
        if motor["kind"] == "dc":
            slope = -motor["torque_stall"] / motor["speed_no_load"]
            return motor["torque_stall"] + slope * speed, slope
        if motor["kind"] == "table":
            return _table(motor["speed"], motor["torque"], speed)
        most, rated = motor["torque_breakdown"], motor["torque_rated"]
        none = motor["speed_synchronous"]
        over, slip = most / rated, (none - motor["speed_rated"]) / none
        best = slip * (over + math.sqrt(over**2 - 1))
        s = (none - speed) / none
        low = s * s + best * best
        return 2 * most * best * s / low, -2 * most * best * (best * best - s * s) / low**2 / none

    def drive_torque(self, omega: float) -> tuple[float, float]:
        """Torque of the drive at the crank, and its slope over the speed of the crank."""
        torque, slope = self.motor_torque(omega * self.ratio)
        factor = self.ratio * self.factors[int(torque < 0)]
        return factor * torque, factor * slope * self.ratio

    def fans(self, omega: float) -> tuple[float, float]:
        """Torque of the loads by tables over the speed, and its slope."""
        fans = [load for load in self.loads.values() if load["kind"] == "torque_speed"]
        values = [_table(load["speed"], load["torque"], omega) for load in fans]
        return sum(value for value, _ in values), sum(slope for _, slope in values)

    def resisting(self, at: Instant, omega: float) -> tuple[complex, complex]:
        fan, fan_slope = self.fans(omega)
        torque, slope = at.load + at.viscous * omega + fan, at.viscous + fan_slope
        for size, rate in at.tanh:
            value = cmath.tanh(rate * omega)
            torque, slope = torque + size * value, slope + size * rate * (1 - value**2)
        return torque, slope

    def net(self, phi: complex, omega: float) -> tuple[complex, complex, Instant]:
        """J ε = M_d − M_r − J′ ω²/2 [N m], its slope over the speed, and the machine there."""
        at = self.instant(phi)
        drive, steep = self.drive_torque(omega)
        load, load_slope = self.resisting(at, omega)
        return drive - load - at.half_slope * omega**2, steep - load_slope - 2 * at.half_slope * omega, at

    def net_with_slope(self, phi: float, omega: float) -> tuple[float, float, float, Instant]:
        """J ε, its derivatives by φ and by u, and the machine there."""
        left, steep, at = self.net(complex(phi, _H), omega)
        return left.real, left.imag / _H, steep.real / omega, at

    @contextmanager
    def keeping_senses(self, phi: float) -> Iterator[None]:
        self._known.clear()
        self.senses = {on: float(np.sign(self._way(on, phi))) for on in self._rubbing()}
        try:
            yield
        finally:
            self._known.clear()
            self.senses = {}

    def dead_centres(self, n: int = 720) -> list[float]:
        """Angles at which what is under dry friction reverses: the load has a corner there."""
        grid = np.linspace(0.0, 2 * np.pi, n + 1).tolist()
        found = []
        for on in self._rubbing():
            ways = [self._way(on, phi) for phi in grid]
            pairs = zip(grid, grid[1:], ways, ways[1:], strict=False)
            found += [self._reversal(on, low, high) for low, high, a, b in pairs if a * b < 0]
        return sorted(found)

    def _rubbing(self) -> set[str]:
        """Sliders and joints of rockers under dry friction: a crank does not reverse."""
        return {load["on"] for load in self.loads.values() if load["kind"] == "dry"} - set(
            self.mechanism["cranks"]
        )

    def _way(self, on: str, phi: float) -> float:
        """Transfer function of a slider or the joint of a rocker, with its sign."""
        places: dict[str, tuple[Place, complex, complex]] = {}
        slider, rocker = (self.mechanism.get(kind, {}).get(on) for kind in ("sliders", "rockers"))
        moved = slider or rocker
        crank = self.mechanism["cranks"][moved["crank"]]
        pin = turned(crank["radius"], phi + crank.get("phase", 0.0), 1.0, 0.0)
        add = self._add_slider if slider else self._add_rocker
        add(Instant(), on, moved, pin, places)
        return places[on][1].real

    def _reversal(self, on: str, low: float, high: float) -> float:
        sign = self._way(on, low)
        for _ in range(60):
            middle = 0.5 * (low + high)
            if self._way(on, middle) * sign > 0:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)


def _plain(tables: Any) -> Any:
    """Tables with numbers of Python, whose arithmetic takes a fraction of the time of NumPy's scalars."""
    if isinstance(tables, dict):
        return {name: _plain(value) for name, value in tables.items()}
    if isinstance(tables, list):
        return [_plain(value) for value in tables]
    return float(tables) if isinstance(tables, np.floating) else tables


def _table(x: list[float], y: list[float], at: float) -> tuple[float, float]:
    """A table that is linear between its points and constant outside, with its slope."""
    if at <= x[0] or at >= x[-1]:
        return (y[0], 0.0) if at <= x[0] else (y[-1], 0.0)
    k = bisect.bisect_right(x, at) - 1
    slope = (y[k + 1] - y[k]) / (x[k + 1] - x[k])
    return y[k] + slope * (at - x[k]), slope
