"""Trains with dry friction by SciPy, from event to event; states are found by trying all of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.integrate import solve_ivp

from linkwright.kernel.arrays import Floats

STUCK, FORWARD, BACKWARD = 0, 1, -1


@dataclass
class Element:
    """Friction between two masses, −1 for the ground: sliding torque over the size of slip, static bounds."""

    ends: tuple[int, int]
    sliding: Callable[[float], float]
    low: float  # static bounds at full engagement [N m]
    high: float
    engaged: Callable[[float], float] = lambda _: 1.0


@dataclass
class Reference:
    """J ω′ = M(t, θ, ω) − B T with the elements' torques."""

    inertia: Floats
    torque: Callable[[float, Floats, Floats], Floats]
    elements: Sequence[Element]

    def __post_init__(self) -> None:
        self.B = np.zeros((len(self.inertia), len(self.elements)))
        for column, element in zip(self.B.T, self.elements, strict=True):
            for end, sign in zip(element.ends, (1.0, -1.0), strict=True):
                if end >= 0:
                    column[end] += sign

    def motion(self, t: float, y: Floats, states: Sequence[int]) -> tuple[Floats, Floats]:
        """Accelerations and torques of the elements in given states."""
        n, m = len(self.inertia), len(self.elements)
        net = self.torque(t, y[:n], y[n:])
        slip = self.B.T @ y[n:]
        A, b = np.zeros((n + m, n + m)), np.zeros(n + m)
        A[:n, :n], A[:n, n:], b[:n] = np.diag(self.inertia), self.B, net
        for e, (element, state) in enumerate(zip(self.elements, states, strict=True)):
            if state == STUCK:
                A[n + e, :n] = self.B[:, e]
            else:
                A[n + e, n + e] = 1.0
                b[n + e] = state * element.engaged(t) * element.sliding(max(state * slip[e], 0.0))
        found = np.linalg.solve(A, b)
        return found[:n], found[n:]

    def consistent(
        self, t: float, y: Floats, states: Sequence[int], resting: set[int], broken: dict[int, int]
    ) -> tuple[int, ...]:
        """States that agree with the motion, with as many stuck elements as can be."""
        choices = [
            (broken[e],) if e in broken else (STUCK, FORWARD, BACKWARD) if e in resting else (states[e],)
            for e in range(len(self.elements))
        ]
        fitting = []
        for tried in product(*choices):
            pairs = zip(self.elements, tried, strict=True)
            if any(state == FORWARD and np.isinf(element.high) for element, state in pairs):
                continue
            a, T = self.motion(t, y, tried)
            size = 1e-9 * (1 + np.abs(T).max())
            bounds = [self.bounds(e, t, T) for e in range(len(tried))]
            fits = all(
                (state != STUCK or bounds[e][0] - size <= T[e] <= bounds[e][1] + size)
                and (state == STUCK or e not in resting or state * (self.B[:, e] @ a) >= -size)
                for e, state in enumerate(tried)
            )
            if fits:
                fitting.append((-tried.count(STUCK), tried))
        best = [tried for count, tried in fitting if count == min(fitting)[0]]
        motions = [self.motion(t, y, tried)[0] for tried in best]
        # Static above sliding friction may leave two ways to go on.
        assert all(np.allclose(a, motions[0], rtol=0, atol=1e-6) for a in motions), f"two ways at {t} s"
        return best[0]

    def bounds(self, e: int, t: float, torques: Floats) -> tuple[float, float]:
        """Static bounds of an element, at the torques of a motion."""
        element, w = self.elements[e], self.elements[e].engaged(t)
        # A freewheel holds whether its clutch is engaged or not.
        high = element.high if np.isinf(element.high) else element.high * w
        return element.low * w if w else 0.0, high

    def follow(self, y: Floats, marks: Sequence[float], times: Floats) -> tuple[Floats, list[float]]:
        """States (2n, times), and the times of all events; no step passes a mark."""
        n, t, events = len(self.inertia), 0.0, []
        rows = np.full((2 * n, len(times)), np.nan)
        states: tuple[int, ...] = tuple(int(np.sign(s)) for s in self.B.T @ y[n:])
        for end in [*marks, float(times[-1])]:
            resting = {e for e, s in enumerate(self.B.T @ y[n:]) if states[e] == STUCK or abs(s) < 1e-10}
            # Just behind a mark, so that what steps there has stepped.
            states = self.consistent(t + 1e-13, y, states, resting, {})
            while t < end:
                t, y, happened = self._stretch(t, y, states, end, times, rows)
                if happened is None:
                    break
                events.append(t)
                e, way = happened
                resting = {k for k, state in enumerate(states) if state == STUCK} | {e}
                states = self.consistent(t, y, states, resting, {} if way == STUCK else {e: way})
        return rows, events

    def _spare(self, t: float, y: Floats, states: Sequence[int], e: int, way: int) -> float:
        """What an element could carry more in a sense."""
        torques = self.motion(t, y, states)[1]
        low, high = self.bounds(e, t, torques)
        return float(high - torques[e] if way == FORWARD else torques[e] - low)

    def _stretch(
        self, t: float, y: Floats, states: Sequence[int], end: float, times: Floats, rows: Floats
    ) -> tuple[float, Floats, tuple[int, int] | None]:
        n = len(self.inertia)
        conditions, meanings = [], []
        for e, state in enumerate(states):
            if state == STUCK:
                for way in (FORWARD, BACKWARD):
                    if way == BACKWARD or np.isfinite(self.elements[e].high):
                        conditions.append(lambda t, y, e=e, way=way: self._spare(t, y, states, e, way))
                        meanings.append((e, way))
            else:
                # A slip that has just begun does not end by rounding.
                conditions.append(lambda t, y, e=e, state=state: state * (self.B[:, e] @ y[n:]) + 1e-11)
                meanings.append((e, STUCK))
        for condition in conditions:
            condition.terminal, condition.direction = True, -1  # type: ignore[attr-defined]
        found = solve_ivp(
            lambda t, y: np.concatenate([y[n:], self.motion(t, y, states)[0]]),
            (t, end),
            y,
            method="DOP853",
            rtol=1e-12,
            atol=1e-13,
            events=conditions,
            dense_output=True,
            max_step=0.01,
        )
        within = (times >= t) & (times <= found.t[-1])
        if within.any():
            rows[:, within] = found.sol(times[within])
        if found.status != 1:
            return end, found.y[:, -1], None
        e = next(k for k, hits in enumerate(found.t_events) if len(hits))
        return float(found.t[-1]), found.y[:, -1], meanings[e]
