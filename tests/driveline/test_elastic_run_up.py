"""Elastic drivelines in time, against SciPy on equations that are written here, energy and the rigid machine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from elastic_drives import Drive, accelerations, random_drive
from numpy.random import Generator
from scipy.integrate import solve_ivp
from sizes import random_cases

import linkwright as lw


def two_carts(stiffness: float, damping: float) -> lw.Machine:
    entries = {"stiffness": stiffness, "damping": damping}
    return lw.replace(lw.read("roller_two_carts"), {"drive.crankshaft": entries})


def _slope(drive: Drive, phi: float) -> float:
    """ds/dφ of the slider."""
    s, c = drive.radius * np.sin(phi), drive.radius * np.cos(phi)
    return float(-s - s * c / np.sqrt(drive.rod**2 - s**2))


def _from_rest(drive: Drive, angle: float, times: np.ndarray) -> np.ndarray:
    """Twists, speeds and crank angle at times from rest, (states, times): the slider sticks, then slips.

    Written here: the crank stands until the torque of the last spring exceeds F |s′|; dead centres end a
    piece of the integration, and no speed of it changes its sign again.
    """
    n = len(drive.inertia)
    limit = drive.dry * abs(_slope(drive, angle))

    def rate(is_held: bool):
        def of(_: float, y: np.ndarray) -> np.ndarray:
            twist, speed = y[: n - 1, None], y[n - 1 : 2 * n - 1, None]
            a, _ = accelerations(drive, y[-1], twist, speed)
            a = a[:, 0]
            a[-1] *= not is_held
            return np.concatenate([(speed[:-1] - speed[1:])[:, 0], a, speed[-1]])

        return of

    def torn(_: float, y: np.ndarray) -> float:
        return drive.stiffness[-1] * y[n - 2] + drive.damping[-1] * y[2 * n - 3] - limit

    def dead_centre(_: float, y: np.ndarray) -> float:
        return float(np.sin(y[-1]))

    torn.terminal, torn.direction = True, 1
    dead_centre.terminal = True
    exact = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "dense_output": True}
    y, t = np.concatenate([np.zeros(2 * n - 1), [angle]]), 0.0
    out = np.empty((2 * n, len(times)))
    is_held = limit > 0
    while t < times[-1]:
        solved = solve_ivp(rate(is_held), (t, times[-1]), y, events=torn if is_held else dead_centre, **exact)
        mine = (times >= t) & (times <= solved.t[-1])
        out[:, mine] = solved.sol(times[mine])
        y, t, is_held = solved.y[:, -1].copy(), float(solved.t[-1]), False
        if t < times[-1]:
            # A little beyond the dead centre, so that it is not met again.
            step = 1e-9
            y, t = y + step * rate(False)(t, y), t + step
    return out


def _states(motion: lw.ElasticTransient, drive: Drive) -> np.ndarray:
    """Twists of springs and speeds of masses at the crank, and its angle."""
    n = len(drive.inertia)
    referred = motion.speed / motion.ratio[:, None]
    distinct = [0] + [k for k in range(1, len(referred)) if np.abs(referred[k] - referred[k - 1]).max() > 1e-12]
    assert len(distinct) == n
    return np.concatenate([motion.twist / drive.ratio[:, None], referred[distinct], motion.crank_angle[None]])


def _started(rng: Generator) -> tuple[Drive, float]:
    """A random drive with dry friction, away from its dead centres."""
    drive = random_drive(rng)
    while not drive.dry:
        drive = random_drive(rng)
    return drive, float(rng.choice([-1, 1]) * np.radians(rng.uniform(30, 150)))


def test_random_drives_start_as_equations_written_down_here() -> None:
    """Stuck, torn loose and running: states at given times to 1e-7 of their scale, from one to three springs."""
    for number, rng in random_cases(4811, 6, 100):
        drive, angle = _started(rng)
        times = np.linspace(0, 2.0, 41)
        motion = lw.elastic_transient(
            drive.machine, angle=angle, duration=2.0, times=times, accuracy=1e-10
        )
        found, expected = _states(motion, drive), _from_rest(drive, angle, times)
        scale = np.abs(expected).max(axis=1, keepdims=True)
        assert np.abs((found - expected) / scale).max() < 1e-7, number
        assert len(motion.slips) == 1, number
        assert motion.energy_error <= 1e-9, number


def test_the_crank_is_torn_loose_when_the_coupling_bears_the_friction() -> None:
    """At that instant the torque of the coupling is F r (|sin φ| + …), by hand; before it the crank stands."""
    rng = np.random.default_rng(7)
    drive, angle = _started(rng)
    motion = lw.elastic_transient(drive.machine, angle=angle, duration=1.0)
    torn = lw.elastic_transient(drive.machine, angle=angle, duration=1.0, times=motion.slips)
    own = drive.dry * abs(_slope(drive, angle)) / drive.ratio[-1]
    assert torn.torque[-1] * (1 if drive.ratio[-1] == 1 else 1) == pytest.approx([own], rel=1e-9)
    assert np.all(motion.speed[-1, motion.time < motion.slips[0]] == 0.0)
    assert np.all(motion.speed[-1, motion.time > motion.slips[0]] > 0.0)
