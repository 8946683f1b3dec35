"""The accuracy asked for holds at any instant, between the ends of steps too: SciPy at 1e-13.

Trains are also held against their exact modal motion in `test_rigid_shafts_in_time`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from test_torsion_transient import chain, sine

import linkwright as lw
from linkwright.torsion import MovingTrain, follow_train, variable_inertia

Floats = NDArray[np.float64]

TURN = 2 * np.pi * np.arange(64) / 64


class RandomTrain:
    """Discs in a row on shafts, one with an inertia that changes with its angle, under a sine."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        n = self.n = int(rng.integers(2, 6))
        self.J, self.ground = rng.uniform(0.1, 2, n), rng.uniform(0, 2, n)
        self.k, self.c = 10 ** rng.uniform(3.5, 5.5, n - 1), rng.uniform(0, 10, n - 1)
        self.wave = rng.uniform(0.02, 0.3) * self.J[0]
        self.omega, self.torque, self.on = rng.uniform(50, 600), rng.uniform(10, 300), int(rng.integers(n))
        self.angle, self.speed = 0.01 * rng.normal(size=n), np.full(n, rng.uniform(20, 150))
        self.rng = rng

    def moving(self) -> MovingTrain:
        turning = variable_inertia(0, 0.5 * self.J[0] + self.wave * (1 + np.cos(2 * TURN)))
        return chain(
            [0.0, *self.J[1:]],
            self.k,
            damping=self.c,
            ground=self.ground,
            inertias=[turning],
            torques=[sine(self.on, self.torque, self.omega)],
        )

    def shaft_torques(self, angle: Floats, speed: Floats) -> Floats:
        return -(np.diff(angle, axis=0).T * self.k + np.diff(speed, axis=0).T * self.c).T

    def rates(self, t: float, y: Floats) -> Floats:
        angle, speed = y[: self.n], y[self.n :]
        carried = self.shaft_torques(angle, speed)
        net = -self.ground * speed
        net[self.on] += self.torque * np.sin(self.omega * t)
        net[:-1] -= carried
        net[1:] += carried
        net[0] += self.wave * np.sin(2 * angle[0]) * speed[0] ** 2
        J = self.J.copy()
        J[0] = 0.5 * self.J[0] + self.wave * (1 + np.cos(2 * angle[0]))
        return np.concatenate([speed, net / J])


def reference(rates: Callable[[float, Floats], Floats], start: Floats, times: Floats) -> Floats:
    """SciPy's motion."""
    span = (0.0, float(times[-1]))
    found: Floats = solve_ivp(rates, span, start, method="DOP853", rtol=1e-13, atol=1e-14, t_eval=times).y
    return found


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("method", ["explicit", "implicit"])
def test_trains(seed: int, method: str) -> None:
    train = RandomTrain(seed)
    # Any number of samples: they meet the steps at no special places.
    samples = int(train.rng.integers(53, 400))
    for accuracy in (1e-6, 1e-8, 1e-10):
        found = follow_train(
            train.moving(),
            duration=0.2,
            speed=train.speed,
            angle=train.angle,
            accuracy=accuracy,
            method=method,  # type: ignore[arg-type]
            sample_time=0.2 / samples,
        )
        y = reference(train.rates, np.concatenate([train.angle, train.speed]), found.time)
        angle, speed = y[: train.n], y[train.n :]
        torque = train.shaft_torques(angle, speed)
        twist = np.abs(angle - angle[0]).max()
        assert np.abs(found.angle - angle).max() <= accuracy
        assert np.abs((found.angle - found.angle[0]) - (angle - angle[0])).max() <= accuracy * twist
        assert np.abs(found.speed - speed).max() <= accuracy * np.abs(speed).max()
        off = np.abs(found.torque - torque).max(axis=1) / np.abs(torque).max(axis=1)
        # SciPy holds the angles themselves, to 1e-13 of them; a twist is the small difference of two: both
        # methods are off by the same 1.6e-10 in the stiffest shaft.
        known = 1e-13 * np.abs(angle).max() * train.k / np.abs(torque).max(axis=1)
        assert (off <= accuracy + known).all()


@pytest.mark.parametrize("seed", range(6))
def test_drives(seed: int) -> None:
    """A slider-crank on a motor whose torque falls with the speed, from a random angle and speed."""
    rng = np.random.default_rng(seed)
    J, m, r, rod = rng.uniform(0.02, 0.5), rng.uniform(0.5, 5), rng.uniform(0.05, 0.2), rng.uniform(0.4, 0.9)
    c, M = rng.uniform(0.1, 1.0), rng.uniform(5, 40)
    text = f"""
    format = 1
    name = "random"
    [drive.flywheel]
    inertia = {J!r}
    [drive.motor]
    kind = "dc"
    speed_no_load = {M / c!r}
    torque_stall = {M!r}
    [mechanism.cranks.A]
    radius = {r!r}
    [mechanism.sliders.B]
    crank = "A"
    rod = {rod!r}
    [bodies]
    B = {{ mass = {m!r} }}
    """
    lam = r / rod

    def rates(t: float, y: Floats) -> Floats:
        s, k = np.sin(y[0]), np.cos(y[0])
        D = np.sqrt(1 - lam**2 * s**2)
        x1 = -r * s * (1 + lam * k / D)
        x2 = -r * k - r * lam * ((k * k - s * s) / D + lam**2 * s * s * k * k / D**3)
        return np.array([y[1], (M - c * y[1] - m * x1 * x2 * y[1] ** 2) / (J + m * x1**2)])

    times = np.sort(rng.uniform(0.0, 1.0, 400))
    start = np.array([rng.uniform(0, 2 * np.pi), rng.uniform(1, 20)])
    y = reference(rates, start, np.append(times, 1.0))[:, :-1]
    for accuracy in (1e-6, 1e-8, 1e-10):
        path = lw.transient(lw.loads(text), angle=start[0], speed=start[1], duration=1.0, accuracy=accuracy)
        angle, speed = path.at(times)
        ends = reference(rates, start, path.time)
        # What the ends have gathered over the turns, and the accuracy of one step more.
        gathered = [np.abs(path.crank_angle - ends[0]).max(), np.abs(path.speed - ends[1]).max()]
        assert np.abs(angle - y[0]).max() <= gathered[0] + accuracy
        assert np.abs(speed - y[1]).max() <= gathered[1] + accuracy * np.abs(y[1]).max()
        assert gathered[1] <= 10 * accuracy * np.abs(y[1]).max()
