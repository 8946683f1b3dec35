"""Directional derivatives against differences of high order and against derivatives of the package."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import Unpacked
from fmus import opened
from sizes import DEEP

VERSIONS = ("2.0", "3.0")
UNKNOWNS = (
    "der(crank_angle)",
    "crank_acceleration",
    "torque_motor",
    "torque_drive",
    "torque_load",
    "power_motor",
    "energy_kinetic",
    "slides.cart1.position",
    "slides.cart1.velocity",
    "slides.cart1.acceleration",
    "points.cart2.ax",
    "links.cart1.rod.speed",
)
STATE = {"crank_angle": 0.9, "crank_speed": 8.5}
KNOWNS = {
    **STATE,
    "external_torque": 0.0,
    "bodies.cart1.mass": 1000.0,
    "loads.rolling1.force": 3562.0,
    "drive.motor.torque_breakdown": 215.4,
    "drive.motor.speed_synchronous": 104.72,
}


def values(folder: Path, changed: dict[str, float], *, exchange: bool) -> np.ndarray:
    with opened(folder, exchange=exchange) as unit:
        unit.start({**STATE, **changed})
        return np.array(unit.get(*UNKNOWNS))


def difference(of: Callable[[float], np.ndarray], at: float, step: float) -> np.ndarray:
    """Central difference of order eight."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    return sum(w * (of(at + k * step) - of(at - k * step)) for k, w in weights.items()) / step


@pytest.mark.deep
@pytest.mark.parametrize(
    ("version", "exchange"),
    itertools.product(VERSIONS, [True, False]) if DEEP else [("2.0", False), ("3.0", True)],
)
def test_derivatives_are_those_of_differences(version: str, exchange: bool, unpacked: Unpacked) -> None:
    """By states, inputs and parameters, to 1e-9 of the largest change that a known causes."""
    folder = unpacked("roller_two_carts", version)
    base = values(folder, {}, exchange=exchange)
    for known, at in KNOWNS.items():
        step = 2e-3 * (abs(at) or 1000.0)
        expected = difference(lambda x, known=known: values(folder, {known: x}, exchange=exchange), at, step)
        with opened(folder, exchange=exchange) as unit:
            unit.start(STATE)
            found = np.array(unit.along(UNKNOWNS, known))
        sizes = np.maximum(np.abs(expected), np.abs(base) / (abs(at) or 1000.0))
        assert (np.abs(found - expected) <= 1e-9 * np.maximum(sizes, 1e-12)).all(), (known, found, expected)


def test_the_acceleration_by_the_angle_is_that_of_the_package(unpacked: Unpacked) -> None:
    """∂ε/∂M = 1/J(φ): by a torque from outside, the acceleration changes by the reduced inertia."""
    with opened(unpacked("roller_two_carts"), exchange=True) as unit:
        unit.start(STATE)
        (inertia,) = unit.get("inertia_reduced")
        assert unit.along(["crank_acceleration"], "external_torque")[0] == pytest.approx(
            1 / inertia, rel=1e-14
        )


def test_a_direction_is_the_sum_of_its_parts(unpacked: Unpacked) -> None:
    """A derivative along several knowns at once is linear in the direction."""
    with opened(unpacked("roller_two_carts")) as unit:
        unit.start(STATE)
        knowns = ["crank_angle", "crank_speed", "bodies.cart1.mass"]
        seed = [0.3, -1.2, 55.0]
        references = [unit.variables[name].valueReference for name in UNKNOWNS]
        by = [unit.variables[name].valueReference for name in knowns]
        together = unit.fmu.getDirectionalDerivative(references, by, seed)
        parts = [
            np.array(unit.along(UNKNOWNS, name)) * weight for name, weight in zip(knowns, seed, strict=True)
        ]
        assert together == pytest.approx(sum(parts), rel=1e-12, abs=1e-9)


def test_a_step_of_newton(unpacked: Unpacked) -> None:
    """With ∂ε/∂ω, Newton's method finds the speed at which the crank does not accelerate at that angle."""
    with opened(unpacked("roller_two_carts")) as unit:
        unit.start(STATE)
        (epsilon,) = unit.get("crank_acceleration")
        slope = unit.along(["crank_acceleration"], "crank_speed")[0]
    speed = STATE["crank_speed"]
    for _ in range(20):
        speed -= epsilon / slope
        with opened(unpacked("roller_two_carts")) as unit:
            unit.start({**STATE, "crank_speed": speed})
            (epsilon,) = unit.get("crank_acceleration")
            slope = unit.along(["crank_acceleration"], "crank_speed")[0]
    assert abs(epsilon) < 1e-10 * abs(slope)


def test_supply_has_no_derivative(unpacked: Unpacked) -> None:
    """A switch is no number: the derivative by it is an error with a message, no number."""
    log: list[str] = []
    with opened(unpacked("roller_two_carts"), logged=log) as unit:
        unit.start(STATE)
        with pytest.raises(Exception, match="DirectionalDerivative"):
            unit.along(["crank_acceleration"], "motor_on")
        assert log
