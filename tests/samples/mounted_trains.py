"""Random trains of two motors and two slider-cranks, and their motion by SciPy on equations written here.

Two motors drive a hub by shafts. A shaft joins the hub to the first crank; gears and a shaft join it to the
second one, which turns at 1, 2 or ½ of its speed and leads by a phase. Every disc has its own angle and speed
here; rods have no mass, so that inertia and loads of a crank have a closed form.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from scipy.integrate import solve_ivp

import linkwright as lw
from linkwright.torsion.model.train_mechanism import TrainMechanism

DISCS = ("m1", "m2", "hub", "c1", "c2")
SHAFTS = ("s1", "s2", "b1", "b2")


@dataclass(frozen=True)
class SliderCrank:
    """A slider of some mass on a crank, with a massless rod, dry friction and oil."""

    radius: float
    rod: float
    mass: float
    dry: float
    viscous: float

    def file(self) -> lw.Machine:
        """Its machine, with a motor that the train leaves out."""
        return lw.loads(
            'format = 1\nname = "press"\n[drive.motor]\nkind = "dc"\nspeed_no_load = 9\ntorque_stall = 9\n'
            f"inertia = 7\n[mechanism.cranks.A]\nradius = {self.radius}\n[mechanism.sliders.S]\n"
            f'crank = "A"\nrod = {self.rod}\n[bodies]\nS = {{ mass = {self.mass} }}\n[loads]\n'
            f'oil = {{ kind = "viscous", on = "S", damping = {self.viscous} }}\n'
            + (f'rub = {{ kind = "dry", on = "S", force = {self.dry} }}\n' if self.dry else "")
        )

    def at(self, angle: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Inertia at the crank, and the torque that loads and its change ask for."""
        s, c = self.radius * np.sin(angle), self.radius * np.cos(angle)
        root = np.sqrt(self.rod**2 - s**2)
        s1 = -s - s * c / root
        s2 = -c - (c**2 - s**2) / root - (s * c) ** 2 / root**3
        load = self.dry * abs(s1) + self.viscous * s1**2 * speed
        return self.mass * s1**2, load + self.mass * s1 * s2 * speed**2


@dataclass(frozen=True)
class MountedTrain:
    """A train: its machine, and its numbers."""

    machine: lw.Machine
    cranks: tuple[SliderCrank, SliderCrank]
    phase: tuple[float, float]
    ratio: float  # speed of the second crank over that of the hub
    inertia: np.ndarray  # (discs,) of the hub with the wheel of the second crank
    stiffness: np.ndarray  # (shafts,) at their own speeds
    damping: np.ndarray
    no_load: np.ndarray  # (2,)
    stall: np.ndarray
    fan: float  # torque at the hub over the square of its speed
    outside: np.ndarray  # (discs,) damping against the rotation of the whole train

    @property
    def share(self) -> np.ndarray:
        """Weight of the speed of each disc in that of the whole train, with mean inertias, (discs,)."""
        speed = np.array([1.0, 1.0, 1.0, 1.0, self.ratio])
        J = self.inertia.copy()
        phi = 2 * np.pi * np.arange(720) / 720
        for n, crank in enumerate(self.cranks):
            J[3 + n] += crank.at(phi, 1.0)[0].mean()
        share: np.ndarray = J * speed / (J @ speed**2)
        return share

    @property
    def turns(self) -> int:
        """Revolutions of the first crank after which both are back."""
        return 2 if self.ratio == 0.5 else 1


def random_train(rng: Generator, ratio: float) -> MountedTrain:
    """Soft to stiff shafts; with and without dry friction, a fan and damping from outside.

    `ratio`: speed of the second crank over that of the first.
    """
    omega = rng.uniform(5.0, 20.0)
    cranks = tuple(_slider(rng, omega * n) for n in (1.0, ratio))
    phase = tuple(rng.uniform(0.0, 2 * np.pi, 2))
    swing = sum(one.mass * one.radius**2 * n**2 for one, n in zip(cranks, (1.0, ratio), strict=True))
    at = np.array([1.0, 1.0, 1.0, 1.0, ratio])
    J = rng.uniform(0.3, 2.0, 5) * swing / at**2
    wheel = rng.uniform(0.1, 0.5) * swing / ratio**2
    own = np.array([1.0, 1.0, 1.0, ratio])
    k = (omega * 10 ** rng.uniform(0.5, 1.6, 4)) ** 2 * swing / own**2
    c = 2 * rng.uniform(0.03, 0.3, 4) * np.sqrt(k * swing) / own
    outside = float(rng.choice([0.0, 0.05])) * omega * swing * rng.uniform(0.0, 1.0, 5) / at**2
    fan = float(rng.choice([0.0, 0.2])) * swing
    mean = (
        sum(_mean(one, omega * n) * n for one, n in zip(cranks, (1.0, ratio), strict=True)) + fan * omega**2
    )
    no_load = omega * rng.uniform(1.1, 1.25, 2)
    share = rng.uniform(0.3, 0.7)
    stall = mean * np.array([share, 1 - share]) / (1 - omega / no_load)
    lines = ['format = 1\nname = "line shaft"', "[train.discs]"]
    lines += [
        f"{name} = {{ inertia = {j}, damping = {c} }}" for name, j, c in zip(DISCS, J, outside, strict=True)
    ]
    lines += [f"wheel = {{ inertia = {wheel} }}", "[train.shafts]"]
    ends = (("m1", "hub"), ("m2", "hub"), ("hub", "c1"), ("wheel", "c2"))
    lines += [
        f'{name} = {{ between = ["{a}", "{b}"], stiffness = {x}, damping = {y} }}'
        for name, (a, b), x, y in zip(SHAFTS, ends, k, c, strict=True)
    ]
    lines.append(f'[train.gears]\npair = {{ between = ["hub", "wheel"], ratio = {1 / ratio} }}')
    for n in range(2):
        motor = f'{{ kind = "dc", speed_no_load = {no_load[n]}, torque_stall = {stall[n]} }}'
        lines.append(f'[train.motors.motor{n + 1}]\non = "m{n + 1}"\nmotor = {motor}')
    if fan:
        lines.append(f'[train.loads.fan]\non = "hub"\ntorque = {fan * omega**2}\nspeed = {omega}')
    tables = lw.loads("\n".join(lines))
    mounted = {
        f"press{n + 1}": TrainMechanism(on=f"c{n + 1}", machine=one.file(), phase=phase[n])
        for n, one in enumerate(cranks)
    }
    assert tables.train is not None
    machine = tables.with_entries({"train": tables.train.with_entries({"mechanisms": mounted})})
    J[2] += wheel * ratio**2
    return MountedTrain(machine, cranks, phase, ratio, J, k, c, no_load, stall, fan, outside)


def _slider(rng: Generator, omega: float) -> SliderCrank:
    radius, mass = rng.uniform(0.05, 0.3), rng.uniform(5.0, 200.0)
    work = rng.uniform(0.1, 0.5) * mass * radius**2 * omega**2
    dry = float(rng.choice([0.0, 0.4])) * work / (4 * radius)
    viscous = (work - 4 * radius * dry) / (np.pi * radius**2 * omega)
    return SliderCrank(radius, radius * rng.uniform(2.5, 6.0), mass, dry, viscous)


def _mean(one: SliderCrank, speed: float) -> float:
    """Mean torque of the loads at a constant speed: inertia has none."""
    return float(one.at(2 * np.pi * np.arange(720) / 720, speed)[1].mean())


def accelerations(
    train: MountedTrain, phi: float | np.ndarray, twist: np.ndarray, speed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations of the discs and torques of the shafts, (parts, …)."""
    r = train.ratio
    first, second = phi, _second(train, phi, twist)
    slip = _slips(train, speed)
    torque = train.stiffness[:, None] * twist + train.damping[:, None] * slip
    J = np.repeat(train.inertia[:, None], speed.shape[1], axis=1)
    together = train.share @ speed
    rigid = np.array([1.0, 1.0, 1.0, 1.0, r])[:, None] * together
    net = -train.outside[:, None] * (speed - rigid)
    for n in range(2):
        net[n] += train.stall[n] * (1 - speed[n] / train.no_load[n]) - torque[n]
    net[2] += torque[0] + torque[1] - torque[2] - r * torque[3] - train.fan * speed[2] ** 2
    for n, (crank, angle) in enumerate(zip(train.cranks, (first, second), strict=True)):
        inertia, load = crank.at(angle, speed[3 + n])
        J[3 + n] += inertia
        net[3 + n] += torque[2 + n] - load
    return net / J, torque


def _second(train: MountedTrain, phi: float | np.ndarray, twist: np.ndarray) -> np.ndarray:
    """Angle of the second crank."""
    angle: np.ndarray = train.ratio * (phi - train.phase[0] + twist[2]) - twist[3] + train.phase[1]
    return angle


def _slips(train: MountedTrain, speed: np.ndarray) -> np.ndarray:
    m1, m2, hub, c1, c2 = speed
    return np.array([m1 - hub, m2 - hub, hub - c1, train.ratio * hub - c2])


@dataclass(frozen=True)
class Cycle:
    """A cycle from a given start: what is left at its end, and extremes on the way, [minimum, maximum]."""

    end: np.ndarray  # (states,) twists, speeds
    slopes: np.ndarray  # (states, states) derivative of the end by the start
    period: float
    speed: np.ndarray  # (discs, 2)
    acceleration: np.ndarray
    torque: np.ndarray


def cycle(train: MountedTrain, start: np.ndarray, steps: np.ndarray) -> Cycle:
    """One cycle from a start by DOP853, beside it from starts one and two steps away either way."""
    m, copies = len(start), 1 + 4 * len(start)
    away = np.concatenate([k * np.diag(steps) for k in (1, -1, 2, -2)], axis=1)
    starts = start[:, None] + np.concatenate([np.zeros((m, 1)), away], axis=1)

    def rate(phi: float, y: np.ndarray) -> np.ndarray:
        y = y.reshape(-1, copies)
        twist, speed = y[:4], y[4:9]
        a, _ = accelerations(train, phi, twist, speed)
        return (np.concatenate([_slips(train, speed), a, np.ones((1, copies))]) / speed[3]).ravel()

    y = np.concatenate([starts, np.zeros((1, copies))]).ravel()
    samples = []
    for k in range(2 * train.turns):
        low = k * np.pi
        solved = solve_ivp(rate, (low, low + np.pi), y, "DOP853", rtol=1e-11, atol=1e-13, dense_output=True)
        y = solved.y[:, -1]
        at = np.unique(np.concatenate([np.linspace(low, low + np.pi, 4001), solved.t]))
        sine = np.sin(_second(train, at, solved.sol(at).reshape(-1, copies, len(at))[:4, 0]))
        # Friction has a kink where the second slider turns back: samples lie close there.
        turns = np.flatnonzero(sine[:-1] * sine[1:] < 0)
        at = np.unique(np.concatenate([at, *(np.linspace(at[j], at[j + 1], 200) for j in turns)]))
        states = solved.sol(at).reshape(-1, copies, len(at))[:m, 0]
        curves = (states[4:9], *accelerations(train, at, states[:4], states[4:9]))
        samples.append([_extremes(at, curve) for curve in curves])
    y = y.reshape(-1, copies)
    moved = y[:m, 1:].reshape(m, 4, m)
    # Differences of fourth order.
    slopes = (8 * (moved[:, 0] - moved[:, 1]) - (moved[:, 2] - moved[:, 3])) / (12 * steps)
    low, high = (
        [of([piece[k][:, side] for piece in samples], axis=0) for k in range(3)]
        for side, of in enumerate((np.min, np.max))
    )
    whole = (np.column_stack(pair) for pair in zip(low, high, strict=True))
    return Cycle(y[:m, 0], slopes, float(y[m, 0]), *whole)


def _extremes(at: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Minimum and maximum of curves, with the parabola through the three samples about each, (rows, 2)."""
    found = np.empty((len(values), 2))
    for row, out in zip(values, found, strict=True):
        for k, best in enumerate((np.argmin, np.argmax)):
            n = int(best(row))
            out[k] = row[n]
            if 0 < n < len(row) - 1:
                x, y = at[n - 1 : n + 2] - at[n], row[n - 1 : n + 2] - row[n]
                bend, slope = np.linalg.solve([[x[0] ** 2, x[0]], [x[2] ** 2, x[2]]], y[[0, 2]])
                out[k] -= slope**2 / (4 * bend) if bend else 0.0
    return found
