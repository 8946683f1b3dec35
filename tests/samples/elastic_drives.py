"""Random elastic drives of one slider-crank, and their motion by SciPy on equations that are written here.

The rod has no mass, so that inertia and loads of the crank have a closed form; all is referred to the crank.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from scipy.integrate import solve_ivp

import linkwright as lw


@dataclass(frozen=True)
class Drive:
    """An elastic drive: its file, and its masses and springs at the crank."""

    machine: lw.Machine
    inertia: np.ndarray  # (masses,) the last without the slider
    stiffness: np.ndarray  # (masses − 1,)
    damping: np.ndarray
    ratio: np.ndarray  # (masses − 1,) speed of each spring over the crank's
    motor: Callable[[np.ndarray], np.ndarray]  # torque at the crank over the speed of the first mass there
    radius: float
    rod: float
    mass: float
    dry: float
    viscous: float
    drag: float


def random_drive(rng: Generator) -> Drive:
    """A motor, a gearbox and a slider-crank with one to three springs between them, soft to stiff."""
    i, efficiency = rng.uniform(1.5, 12.0), rng.uniform(0.85, 1.0)
    radius = rng.uniform(0.05, 0.3)
    rod, mass = radius * rng.uniform(2.5, 6.0), rng.uniform(5.0, 200.0)
    omega = rng.uniform(4.0, 20.0)
    swing = mass * radius**2
    work = rng.uniform(0.1, 0.5) * swing * omega**2  # of a revolution, in proportion to the kinetic energy
    dry = rng.choice([0.0, 0.5]) * work / (4 * radius)
    viscous = (work - 4 * radius * dry) / (np.pi * radius**2 * omega) * rng.uniform(0.3, 1.0)
    drag = rng.choice([0.0, 0.1]) * work / (radius**3 * omega**2)
    springs = [name for name in ("motor_shaft", "gears", "crankshaft") if rng.random() < 0.5] or [
        "crankshaft"
    ]
    # Inertias beside the slider's; frequencies of each spring with it from thrice to sixty times the speed.
    J_motor = rng.uniform(0.3, 3.0) * swing / i**2
    J_gearbox = rng.uniform(0.1, 1.0) * swing / i**2
    J_wheel, J_crank = rng.uniform(0.1, 1.0) * swing, rng.uniform(0.5, 3.0) * swing
    k = {name: (omega * 10 ** rng.uniform(0.5, 1.8)) ** 2 * swing for name in springs}
    c = {name: 2 * rng.uniform(0.02, 0.3) * np.sqrt(k[name] * swing) for name in springs}
    c.pop("gears", None)
    at_motor = {name: 1.0 if name == "crankshaft" else 1.0 / i**2 for name in springs}
    mean = work / (2 * np.pi) / (i * efficiency)
    no_load, slope = 1.15 * omega * i, 1.0
    stall = mean * rng.uniform(5.0, 12.0) * slope
    lines = [
        f'format = 1\nname = "elastic drive"\n[drive.motor]\nkind = "dc"\nspeed_no_load = {no_load}',
        f"torque_stall = {stall}\ninertia = {J_motor}",
        f'[drive.gearbox]\nratio = {i}\nefficiency = {efficiency}\nreverse = "same"\ninertia = {J_gearbox}',
        f"wheel_inertia = {J_wheel}",
        *([f"stiffness = {k['gears'] / i**2}"] if "gears" in springs else []),
        f"[drive.flywheel]\ninertia = {J_crank}\n[mechanism.cranks.A]\nradius = {radius}",
        f'[mechanism.sliders.S]\ncrank = "A"\nrod = {rod}\n[bodies]\nS = {{ mass = {mass} }}\n[loads]',
        f'dry = {{ kind = "dry", on = "S", force = {dry} }}' if dry else "",
        f'oil = {{ kind = "viscous", on = "S", damping = {viscous} }}',
        f'drag = {{ kind = "formula", on = "S", force = "-{drag} * v * abs(v)" }}' if drag else "",
    ]
    for name in ("motor_shaft", "crankshaft"):
        if name in springs:
            lines.append(f"[drive.{name}]\nstiffness = {k[name] * at_motor[name]}")
            lines.append(f"damping = {c[name] * at_motor[name]}")
    stations = [J_motor * i**2, J_gearbox * i**2, J_wheel, J_crank]
    between = ["motor_shaft", "gears", "crankshaft"]
    masses = [stations[0]]
    for name, J in zip(between, stations[1:], strict=True):
        if name in springs:
            masses.append(J)
        else:
            masses[-1] += J
    ordered = [name for name in between if name in springs]

    def motor(speed: np.ndarray) -> np.ndarray:
        return stall * (1 - speed * i / no_load) * i * efficiency

    return Drive(
        machine=lw.loads("\n".join(lines)),
        inertia=np.array(masses),
        stiffness=np.array([k[name] for name in ordered]),
        damping=np.array([c.get(name, 0.0) for name in ordered]),
        ratio=np.array([1.0 if name == "crankshaft" else i for name in ordered]),
        motor=motor,
        radius=radius,
        rod=rod,
        mass=mass,
        dry=dry,
        viscous=viscous,
        drag=drag,
    )


def accelerations(
    drive: Drive, phi: float | np.ndarray, twist: np.ndarray, speed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations of the masses and torques of the springs, which lie one behind the other, (parts, …)."""
    r, rod = drive.radius, drive.rod
    s, c = r * np.sin(phi), r * np.cos(phi)
    root = np.sqrt(rod**2 - s**2)
    s1 = -s - s * c / root
    s2 = -c - (c**2 - s**2) / root - (s * c) ** 2 / root**3
    omega = speed[-1]
    load = drive.dry * abs(s1) + drive.viscous * s1**2 * omega + drive.drag * s1**2 * abs(s1) * omega**2
    torque = drive.stiffness[:, None] * twist + drive.damping[:, None] * (speed[:-1] - speed[1:])
    net = np.zeros_like(speed)
    net[0] += drive.motor(speed[0])
    net[:-1] -= torque
    net[1:] += torque
    net[-1] -= load + drive.mass * s1 * s2 * omega**2
    net[:-1] /= drive.inertia[:-1, None]
    net[-1] /= drive.inertia[-1] + drive.mass * s1**2
    return net, torque


@dataclass(frozen=True)
class Cycle:
    """A cycle from a given start: what is left at its end, and extremes on the way."""

    end: np.ndarray  # (states,) twists, speeds
    slopes: np.ndarray  # (states, states) derivative of the end by the start
    period: float
    speed: np.ndarray  # (masses, 2)
    acceleration: np.ndarray
    torque: np.ndarray
    torque_mean: np.ndarray
    loss: np.ndarray  # [J]


def cycle(drive: Drive, start: np.ndarray, steps: np.ndarray) -> Cycle:
    """One cycle from a start by DOP853, beside it from starts one and two steps away either way."""
    m, n = len(start), len(drive.inertia)
    copies = 1 + 4 * m
    away = np.concatenate([k * np.diag(steps) for k in (1, -1, 2, -2)], axis=1)
    starts = start[:, None] + np.concatenate([np.zeros((m, 1)), away], axis=1)

    def rate(phi: float, y: np.ndarray) -> np.ndarray:
        y = y.reshape(-1, copies)
        twist, speed = y[: n - 1], y[n - 1 : 2 * n - 1]
        a, torque = accelerations(drive, phi, twist, speed)
        slip = speed[:-1] - speed[1:]
        sums = [np.ones((1, copies)), torque, drive.damping[:, None] * slip**2]
        return (np.concatenate([slip, a, *sums]) / speed[-1]).ravel()

    y = np.concatenate([starts, np.zeros((1 + 2 * (n - 1), copies))]).ravel()
    samples = []
    for low in (0.0, np.pi):
        solved = solve_ivp(rate, (low, low + np.pi), y, "DOP853", rtol=1e-11, atol=1e-13, dense_output=True)
        y = solved.y[:, -1]
        at = np.unique(np.concatenate([np.linspace(low, low + np.pi, 4001), solved.t]))
        samples.append(_sampled(drive, at, solved.sol(at).reshape(-1, copies, len(at))[: 2 * n - 1, 0]))
    y = y.reshape(-1, copies)
    ends, moved = y[:m, 0], y[:m, 1:].reshape(m, 4, m)
    # Differences of fourth order.
    slopes = (8 * (moved[:, 0] - moved[:, 1]) - (moved[:, 2] - moved[:, 3])) / (12 * steps)
    whole = [np.concatenate([piece[k] for piece in samples], axis=1) for k in range(3)]
    return Cycle(
        ends,
        slopes,
        y[m, 0],
        *(_extremes(each) for each in whole),
        y[m + 1 : m + n, 0] / y[m, 0],
        y[m + n :, 0],
    )


def _sampled(drive: Drive, at: np.ndarray, states: np.ndarray) -> list[np.ndarray]:
    n = len(drive.inertia)
    speed = states[n - 1 :]
    return [speed, *accelerations(drive, at, states[: n - 1], speed)]


def _extremes(values: np.ndarray) -> np.ndarray:
    """Minimum and maximum of samples, with the parabola through the three about each, (rows, 2)."""
    found = np.empty((len(values), 2))
    for row, out in zip(values, found, strict=True):
        for k, sign in enumerate((-1.0, 1.0)):
            at = int(np.argmax(sign * row))
            out[k] = row[at]
            if 0 < at < len(row) - 1:
                a, b, c = row[at - 1 : at + 2]
                bend = a - 2 * b + c
                if bend * sign < 0 and abs(a - b) + abs(c - b) > 1e-13 * abs(b):
                    out[k] = b - (c - a) ** 2 / (8 * bend)
    return found
