"""How long does it take to follow a train with variable inertias in time?

Twelve discs, six of them throws whose inertia changes with the angle, each with the torque of its gas: 10 s
of motion with 20 000 samples. Against DOP853 of SciPy a short stretch is timed: its right side, written with
NumPy over all discs at once, takes tens of microseconds.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from common import Row, faster, is_installed, seconds
from numpy.typing import NDArray

from linkwright.kernel.core.periodic_table import waves
from linkwright.torsion.core.torque import Power, TrainTorque
from linkwright.torsion.core.transient import MovingTrain, TrainMotion, VariableInertia

Floats = NDArray[np.float64]

# Damper ring and hub, six throws, flywheel, two halves of a coupling's shafting, propeller.
J = np.array([0.05, 0.02] + [0.02] * 6 + [0.9, 0.1, 0.15, 1.6])
K = np.array([2e4, 5e5] + [6e5] * 5 + [8e5, 1.5e4, 4e5, 1.2e5])
C = np.array([15.0, 0.0] + [5.0] * 5 + [5.0, 20.0, 10.0, 10.0])
THROWS, SPEED, FIRST = 6, 150.0, 2
CRANKS = 2 * np.pi * np.array([0, 2, 1, 1, 2, 0]) / 3
FIRES = 4 * np.pi * np.array([0, 4, 2, 5, 1, 3]) / 6
ORDERS = np.arange(1, 13) / 2
GAS = 900.0 / (1 + (ORDERS / 3) ** 2)
MEAN = 70.0

# Accuracy of a step of either; torques then agree to a millionth.
ACCURACY = 1e-8
SHORT = 0.1


def rows(quick: bool) -> list[Row]:
    """The whole motion, and a stretch of it against SciPy."""
    long = np.linspace(0, 10, 20_001)
    repeats = 3 if quick else 7
    (whole,) = seconds([partial(followed, long)], repeats=repeats)
    note = "12 discs, 6 of them throws with J(θ) and gas torque, 20 001 samples, accuracy 1e-8"
    found = [Row("10 s of a train in motion", "ms", 1e3 * whole, target=150.0, aim="at most", note=note)]
    if not is_installed("scipy"):
        return found
    times = np.linspace(0, SHORT, 201)
    off = np.abs(followed(times).torque - by_scipy(times)).max() / np.abs(followed(times).torque).max()
    assert off < 1e-5, f"product and SciPy differ by {off:g} of the largest torque"
    ours, theirs = seconds([partial(followed, times), partial(by_scipy, times)], repeats=repeats)
    note = f"the same train, {SHORT:g} s; SciPy's equations with NumPy over all discs"
    return [*found, faster("0.1 s of a train in motion", ours, "SciPy DOP853", theirs, note=note)]


def train() -> MovingTrain:
    """As the engine hands it to the core."""
    n = len(J)
    place = np.arange(n, dtype=np.int32)
    own = np.where((place >= FIRST) & (place < FIRST + THROWS), 0.0, J)
    inertia = waves([2.0], [0.006], [0.0], mean=J[FIRST])
    gas = waves(ORDERS.tolist(), GAS, np.zeros(len(ORDERS)), turns=2, mean=MEAN)
    torques = [TrainTorque(f"gas_{k}", FIRST + k, shape=gas, phase=-FIRES[k]) for k in range(THROWS)]
    load = TrainTorque("propeller", n - 1, -THROWS * MEAN, Power(SPEED, 2.0))
    return MovingTrain(
        discs=tuple(f"d{k}" for k in place),
        speed=np.ones(n),
        mass=place,
        inertia=own,
        damping=np.zeros(n),
        swing_damping=np.zeros(n),
        shafts=tuple(f"s{k}" for k in place[1:]),
        tip=np.column_stack([place[:-1], place[1:]]),
        stiffness=K,
        shaft_damping=C,
        curves=(None,) * (n - 1),
        inertias=tuple(VariableInertia(FIRST + k, inertia, CRANKS[k]) for k in range(THROWS)),
        torques=(*torques, load),
    )


TRAIN = train()


def followed(times: Floats) -> TrainMotion:
    """By the product."""
    n = len(J)
    return TRAIN.follow(
        np.zeros(n), np.full(n, SPEED), times, accuracy=ACCURACY, method="explicit", steps_max=10_000_000
    )


def by_scipy(times: Floats) -> Floats:
    """Torques of the shafts by SciPy, with the equations written out in NumPy."""
    from scipy.integrate import solve_ivp

    n = len(J)
    throws = slice(FIRST, FIRST + THROWS)

    def rates(_: float, y: Floats) -> Floats:
        theta, omega = y[:n], y[n:]
        shaft = K * (theta[:-1] - theta[1:]) + C * (omega[:-1] - omega[1:])
        torque = np.zeros(n)
        torque[:-1] -= shaft
        torque[1:] += shaft
        angle = theta[throws]
        waves = np.cos(ORDERS * (angle - FIRES)[:, None]) @ GAS + MEAN
        double = 2 * (angle + CRANKS)
        inertia = J.copy()
        inertia[throws] += 0.006 * np.cos(double)
        torque[throws] += waves + 0.006 * np.sin(double) * omega[throws] ** 2
        torque[-1] -= THROWS * MEAN * (omega[-1] / SPEED) ** 2
        return np.concatenate([omega, torque / inertia])

    start = np.concatenate([np.zeros(n), np.full(n, SPEED)])
    found = solve_ivp(
        rates, (0, times[-1]), start, method="DOP853", t_eval=times, rtol=ACCURACY, atol=1e-2 * ACCURACY
    )
    theta, omega = found.y[:n], found.y[n:]
    torque: Floats = K[:, None] * (theta[:-1] - theta[1:]) + C[:, None] * (omega[:-1] - omega[1:])
    return torque
