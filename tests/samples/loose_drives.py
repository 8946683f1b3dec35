"""Random elastic drives whose links have backlash or curves, and one cycle of them by SciPy with events.

Laws and equations are written here; all is referred to the crank. Derivatives by the start are those of the
variational equation, by complex steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from elastic_drives import Drive, random_drive
from numpy.random import Generator
from scipy.integrate import solve_ivp

import linkwright as lw

_TINY = 1e-40


@dataclass(frozen=True)
class Law:
    """Torque of one link: spring, straight or by points, behind half a backlash; damper."""

    stiffness: float
    damping: float
    gap: float
    points: tuple[np.ndarray, np.ndarray, np.ndarray] | None

    def spring(self, twist: np.ndarray) -> np.ndarray:
        """S of a twist, real or complex."""
        side = np.where(twist.real < 0, -1.0, 1.0)
        over = side * twist - self.gap
        if self.points is None:
            return np.where(over.real > 0, side * self.stiffness * over, 0.0)
        x, y, s = self.points
        k = np.clip(np.searchsorted(x, over.real, side="right") - 1, 0, len(x) - 1)
        n = np.minimum(k + 1, len(x) - 1)
        h = np.where(n > k, x[n] - x[k], 1.0)
        z = (over - x[k]) / h
        rise = y[n] - y[k]
        inside = (
            y[k]
            + h * s[k] * z
            + (3 * rise - h * (2 * s[k] + s[n])) * z**2
            + (h * (s[k] + s[n]) - 2 * rise) * z**3
        )
        value = np.where(n > k, inside, y[-1] + s[-1] * (over - x[-1]))
        return np.where((over.real > 0) | (self.gap == 0), side * value, 0.0)

    def torque(self, twist: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """T, and D of it."""
        spring, damper = self.spring(twist), self.damping * rate
        if self.gap > 0:
            size = np.where(spring.real < 0, -spring, spring)
            damper = np.where(
                damper.real > size.real, size, np.where(damper.real < -size.real, -size, damper)
            )
        return spring + damper, damper

    def kinks(self, twist: float, rate: float) -> list[float]:
        """What changes its sign where the law bends."""
        found = []
        if self.gap > 0:
            spring = float(self.spring(np.array(twist)))
            found += [twist - self.gap, twist + self.gap]
            if self.damping > 0:
                found += [spring - self.damping * rate, spring + self.damping * rate]
        if self.points is not None:
            found += [abs(twist) - self.gap - x for x in self.points[0][1:]]
            if self.gap == 0:
                found.append(twist)
        return found


@dataclass(frozen=True)
class LooseDrive:
    """A drive with its laws."""

    machine: lw.Machine
    drive: Drive
    laws: list[Law]


def random_loose_drive(rng: Generator) -> LooseDrive:
    """A random drive, each link with backlash of the size of its twists, a curve, both or neither."""
    drive = random_drive(rng)
    linear = lw.elastic_motion(drive.machine, n=8)
    given, laws = {}, []
    shafts = linear.shafts
    for k, (name, lead) in enumerate(zip(shafts, drive.ratio, strict=True)):
        place = {"gears": "drive.gearbox"}.get(name, f"drive.{name}")
        largest = max(abs(linear.twist_min[k]), abs(linear.twist_max[k]))
        stiffness, damping = drive.stiffness[k] / lead**2, drive.damping[k] / lead**2
        backlash = largest * rng.uniform(0.05, 1.5) if rng.random() < 0.6 else 0.0
        points = None
        if backlash and not damping:
            damping = 0.1 * np.sqrt(stiffness * drive.inertia.min()) / lead
            given[f"{place}.damping"] = damping
        if name != "gears" and rng.random() < 0.5:
            x = np.concatenate([[0.0], np.sort(rng.uniform(0.2, 1.5, 2)) * largest])
            slopes = stiffness * np.cumprod(rng.uniform(0.7, 2.5, 2))
            y = np.concatenate([[0.0], np.cumsum(np.diff(x) * slopes)])
            given |= {f"{place}.stiffness": None, f"{place}.twist": x.tolist(), f"{place}.torque": y.tolist()}
            points = (x / lead, y * lead, _slopes(x, y) * lead**2)
        if backlash:
            given[f"{place}.backlash"] = backlash
        laws.append(Law(stiffness * lead**2, damping * lead**2, backlash / 2 / lead, points))
    return LooseDrive(lw.replace(drive.machine, given), drive, laws)


def _slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Slopes of Fritsch and Butland for three points: harmonic in the middle, like a parabola at the ends."""
    h, s = np.diff(x), np.diff(y) / np.diff(x)
    w = (h[0] + 2 * h[1]) / (3 * h.sum())
    middle = 1 / (w / s[0] + (1 - w) / s[1])
    first, last = (min(max(1.5 * c - 0.5 * middle, 0.1 * c), 3 * c) for c in s)
    return np.array([first, middle, last])


def rates(loose: LooseDrive, phi: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, ...]:
    """dy/dφ of twists and speeds (states, …), accelerations, torques, and damping torques."""
    drive, n = loose.drive, len(loose.drive.inertia)
    twist, speed = y[: n - 1], y[n - 1 :]
    slip = speed[:-1] - speed[1:]
    pairs = [law.torque(twist[k], slip[k]) for k, law in enumerate(loose.laws)]
    torque, damper = (np.array([pair[k] for pair in pairs]) for k in range(2))
    s, c = drive.radius * np.sin(phi), drive.radius * np.cos(phi)
    root = np.sqrt(drive.rod**2 - s**2)
    s1 = -s - s * c / root
    s2 = -c - (c**2 - s**2) / root - (s * c) ** 2 / root**3
    omega = speed[-1]
    load = drive.dry * abs(s1) + drive.viscous * s1**2 * omega + drive.drag * s1**2 * abs(s1) * omega**2
    net = np.zeros_like(speed)
    net[0] += drive.motor(speed[0])
    net[:-1] -= torque
    net[1:] += torque
    net[-1] -= load + drive.mass * s1 * s2 * omega**2
    net[:-1] /= drive.inertia[:-1].reshape(-1, *(1,) * (net.ndim - 1))
    net[-1] /= drive.inertia[-1] + drive.mass * s1**2
    return np.concatenate([slip, net]) / omega, net, torque, damper * slip


@dataclass(frozen=True)
class LooseCycle:
    """Cycles from a given start: end, its derivatives by the start, period, loss, and extremes."""

    end: np.ndarray
    slopes: np.ndarray
    period: float
    loss: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray


def loose_cycle(loose: LooseDrive, start: np.ndarray, turns: int = 1) -> LooseCycle:
    """One cycle of so many revolutions, from kink to kink of mechanism and laws."""
    m, n = len(start), len(loose.drive.inertia)
    links = n - 1

    def rate(phi: float, z: np.ndarray) -> np.ndarray:
        y, change = z[:m], z[m : m + m * m].reshape(m, m)
        beside = np.concatenate([np.zeros((m, 1)), change], axis=1)
        own, _, _, lost = rates(loose, phi, y[:, None] + _TINY * 1j * beside)
        moved = own[:, 1:].imag / _TINY
        return np.concatenate([own[:, 0].real, moved.ravel(), [1 / y[-1]], lost[:, 0].real / y[-1]])

    def curves(states: Callable[[np.ndarray], np.ndarray], at: np.ndarray) -> np.ndarray:
        y = states(at)[:m]
        _, acceleration, torque, _ = rates(loose, at, y)
        return np.concatenate([y[links:], acceleration, torque])

    known: tuple[np.ndarray | None, list[float]] = (None, [])

    def kinks(z: np.ndarray) -> list[float]:
        nonlocal known
        if known[0] is not z:
            slip = z[links : m - 1] - z[links + 1 : m]
            known = z, [value for k, law in enumerate(loose.laws) for value in law.kinks(z[k], slip[k])]
        return known[1]

    def kink(which: int):
        def event(phi: float, z: np.ndarray) -> float:
            return kinks(z)[which]

        event.terminal = True
        return event

    count = len([1 for law in loose.laws for _ in law.kinks(1.0, 1.0)])
    z = np.concatenate([start, np.eye(m).ravel(), np.zeros(1 + links)])
    pieces, phi, passed = [], 0.0, set()
    while phi < 2 * np.pi * turns * (1 - 1e-14):
        until = np.pi * (np.floor(phi / np.pi + 1e-12) + 1)
        asked = [k for k in range(count) if k not in passed]
        solved = solve_ivp(
            rate, (phi, until), z, "DOP853", rtol=1e-11, atol=1e-13, dense_output=True,
            events=[kink(k) for k in asked],
        )  # fmt: skip
        met = [k for k, times in zip(asked, solved.t_events, strict=True) if len(times)]
        pieces.append((np.linspace(phi, solved.t[-1], 1001), partial(curves, solved.sol)))
        # Kinks that ended this part are passed in the next: their functions are zero but for rounding there.
        passed = set(met) | (passed if solved.t[-1] - phi < 1e-9 else set())
        phi, z = solved.t[-1], solved.y[:, -1]
    extremes = np.split(_extremes(pieces), [n, 2 * n])
    return LooseCycle(z[:m], z[m : m + m * m].reshape(m, m), z[m + m * m], z[m + m * m + 1 :], *extremes)


def _extremes(pieces: list[tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]]) -> np.ndarray:
    """Minimum and maximum of curves over pieces, looked at again about the best samples, (rows, 2)."""
    values = [read(at) for at, read in pieces]
    found = np.empty((len(values[0]), 2))
    for k, sign in enumerate((-1.0, 1.0)):
        for r in range(len(found)):
            tops = np.array([np.max(sign * value[r]) for value in values])
            near = 1e-3 * np.ptp(np.concatenate([value[r] for value in values]))
            for piece in np.flatnonzero(tops >= tops.max() - near):
                at, read = pieces[piece]
                best = int(np.argmax(sign * values[piece][r]))
                closer = np.linspace(at[max(best - 1, 0)], at[min(best + 1, len(at) - 1)], 201)
                tops[piece] = max(tops[piece], _top(sign * read(closer)[r]))
            found[r, k] = sign * tops.max()
    return found


def _top(row: np.ndarray) -> float:
    """Maximum of samples, with the parabola through the three about it."""
    at = int(np.argmax(row))
    if 0 < at < len(row) - 1:
        a, b, c = row[at - 1 : at + 2]
        bend = a - 2 * b + c
        if bend < 0:
            return float(b - (c - a) ** 2 / (8 * bend))
    return float(row[at])


def parting(loose: LooseDrive, settling: int = 20, cycles: int = 40) -> tuple[float, float]:
    """Mean factor by which neighbouring motions part in a cycle, and how near a cycle comes to one before.

    The motion is followed from the linear drive's speed without twist; its logarithm is the largest Lyapunov
    exponent. Nearness: of the last start to those of up to 24 cycles before, over the sizes of the states.
    """
    n = len(loose.drive.inertia)
    omega = lw.elastic_motion(loose.drive.machine, n=8).speed_mean_time
    y = np.concatenate([np.zeros(n - 1), np.full(n, omega)])
    off = np.concatenate([np.full(n - 1, 1e-2), np.full(n, omega)]) * 1e-7
    size, logs, starts = np.abs(off), [], [y]
    for _ in range(settling + cycles):
        pair = np.stack([y, y + off], axis=1)
        for low in (0.0, np.pi):
            pair = solve_ivp(
                lambda phi, z: rates(loose, phi, z.reshape(-1, 2))[0].ravel(),
                (low, low + np.pi), pair.ravel(), "DOP853", rtol=1e-9, atol=1e-12,
            ).y[:, -1].reshape(-1, 2)  # fmt: skip
        y, off = pair[:, 0], pair[:, 1] - pair[:, 0]
        logs.append(np.log(np.abs(off / size).max()))
        off /= np.abs(off / size).max()
        starts.append(y)
    listed = np.array(starts[-25:])
    near = np.abs((listed[:-1] - listed[-1]) / np.abs(listed).max(axis=0)).max(axis=1).min()
    return float(np.exp(np.mean(logs[settling:]))), float(near)
