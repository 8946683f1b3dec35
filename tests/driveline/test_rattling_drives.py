"""Whether motions of a rattling drive that begin close meet or part, by SciPy on equations written here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import linkwright as lw

# The slider-crank of the example, referred to the crank: motor with gearbox, and the rest.
_INERTIAS = 25 * (0.1 + 0.02), 1.0
_RADIUS, _ROD, _MASS, _VISCOUS, _STIFFNESS = 0.2, 0.7, 60.0, 30.0, 10e3

# Cycles that go by first, and over which the growth of a difference is measured, from this size on.
_FIRST, _CYCLES, _CLOSE = 40, 20, 1e-8


def _machine(backlash: float, damping: float) -> lw.Machine:
    values = {"drive.crankshaft.backlash": backlash, "drive.crankshaft.damping": damping}
    return lw.replace(lw.read("rattling_backlash"), values)


def _rates(phi: float, y: np.ndarray, backlash: float, damping: float) -> np.ndarray:
    """dy/dφ of twist, speed of the motor at the crank, and speed of the crank, of some motions."""
    twist, motor, crank = y.reshape(3, -1)
    spring = _STIFFNESS * (np.maximum(twist - backlash / 2, 0) + np.minimum(twist + backlash / 2, 0))
    size = np.abs(spring)
    torque = spring + np.clip(damping * (motor - crank), -size, size)
    s, c = np.sin(phi), np.cos(phi)
    root = np.sqrt(_ROD**2 - (_RADIUS * s) ** 2)
    x1 = -_RADIUS * s * (1 + _RADIUS * c / root)
    x2 = -_RADIUS * (c + _RADIUS * (c * c - s * s) / root + _RADIUS**3 * (s * c) ** 2 / root**3)
    driving = 5 * 1e3 * (1 - 5 * motor / 50)
    load = _VISCOUS * x1**2 * crank + _MASS * x1 * x2 * crank**2
    rates = motor - crank, (driving - torque) / _INERTIAS[0], (torque - load) / (_INERTIAS[1] + _MASS * x1**2)
    return np.concatenate(rates) / np.tile(crank, 3)


def _parting(backlash: float, damping: float) -> float:
    """Mean factor by which two motions that are close part, or below 1 meet, in a cycle."""
    at = np.array([[0.0, 0.0], [10.0, 10.0], [10.0, 10.0]])
    growth = []
    for cycle in range(_FIRST + _CYCLES):
        at[:, 1] = at[:, 0] + (at[:, 1] - at[:, 0]) * _CLOSE / max(np.abs(at[:, 1] - at[:, 0]).max(), 1e-300)
        if cycle == 0:
            at[2, 1] += _CLOSE
        before = np.abs(at[:, 1] - at[:, 0]).max()
        one = solve_ivp(
            _rates, (0, 2 * np.pi), at.ravel(), "DOP853", rtol=1e-8, atol=1e-11, args=(backlash, damping)
        )
        at = one.y[:, -1].reshape(3, 2)
        growth.append(np.log(np.abs(at[:, 1] - at[:, 0]).max() / before))
    return float(np.exp(np.mean(growth[_FIRST:])))


@pytest.mark.parametrize("backlash", [2.2, 2.3])
def test_a_drive_whose_neighbouring_motions_meet_is_periodic_and_not_called_chaotic(backlash: float) -> None:
    """The factor by which two motions of SciPy approach each other in a cycle is the largest multiplier."""
    motion = lw.elastic_motion(_machine(np.radians(backlash), 0.9), n=4)
    assert motion.turns == 1
    # SciPy passes the flanks within its steps.
    assert motion.multiplier_max == pytest.approx(_parting(np.radians(backlash), 0.9), rel=0.02)


def test_a_drive_is_called_chaotic_where_neighbouring_motions_part() -> None:
    """Two motions of SciPy that begin close part from cycle to cycle, by 1.05 at least as on no torus."""
    with pytest.raises(lw.SteadyStateError, match=r"chaotic; .* by a factor of 1\.\d+ per cycle"):
        lw.elastic_motion(_machine(np.radians(2.1), 0.9), n=4)
    assert _parting(np.radians(2.1), 0.9) > 1.05
