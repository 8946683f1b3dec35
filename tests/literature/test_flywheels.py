"""Flywheels of a textbook: R. S. Khurmi, J. K. Gupta, Theory of Machines, 2005, chapter 16."""

from __future__ import annotations

import math

import numpy as np
import pytest

import linkwright as lw
from linkwright.turning.diagram import TurningMomentDiagram

RPM = math.pi / 30


def diagram(**entries: object) -> TurningMomentDiagram:
    return lw.turning_moment(
        lw.Machine.model_validate({"format": 1, "name": "flywheel", "turning_moment": entries})
    )


def test_example_16_1() -> None:
    """6.5 t at a radius of gyration of 1.8 m, 56 kN m, 120 rpm: 121 and 119 rpm are printed."""
    found = diagram(speed="120 rpm", areas=[56, -56], area_scale="1 kJ", inertia=6500 * 1.8**2)
    assert found.speed_max is not None
    assert found.speed_min is not None
    assert round(found.speed_max / RPM) == 121
    assert round(found.speed_min / RPM) == 119


def test_example_16_4() -> None:
    """36 kg at 150 mm, 1800 rpm, areas in mm² at 5 N m and 5° a millimetre: 1.49 % is printed."""
    areas = [295, -685, 40, -340, 960, -270]
    scale = 5 * math.radians(5)
    found = diagram(speed="1800 rpm", areas=areas, area_scale=scale, inertia=36 * 0.15**2)
    # Printed: 985 mm², 430 N m.
    assert found.energy_fluctuation / scale == pytest.approx(985, rel=1e-12)
    assert found.energy_fluctuation == pytest.approx(430, abs=0.5)
    assert found.unevenness == pytest.approx(0.0149, abs=5e-5)


def test_example_16_2() -> None:
    """A multicylinder engine by its areas, 600 N m and 3° a mm, ± 1.5 %: 5404 N m and 183 kg are printed."""
    found = diagram(
        speed="600 rpm",
        areas=[52, -124, 92, -140, 85, -72, 107],
        area_scale=600 * math.radians(3),
        unevenness=0.03,
        radius_of_gyration="500 mm",
    )
    assert found.energy_fluctuation / (600 * math.radians(3)) == pytest.approx(172, rel=1e-12)
    # 31.42 N m a square millimetre in the book, π/60·600 here.
    assert found.energy_fluctuation == pytest.approx(5404, abs=1.0)
    assert found.flywheel_mass is not None
    # The book rounds the speed to 31.42 m/s and the energy to 29.6 m before it divides.
    assert found.flywheel_mass == pytest.approx(183, abs=0.7)


def test_two_stroke_engine() -> None:
    """1000 + 300 sin 2θ − 500 cos 2θ N m, 250 rpm, 400 kg, 0.4 m: printed 26.18 kW, 1.33 %, 9.11 rad/s²."""
    found = diagram(
        speed="250 rpm",
        inertia=400 * 0.4**2,
        driver={"kind": "formula", "torque": "1000 + 300*sin(2*phi) - 500*cos(2*phi)"},
    )
    assert found.power_mean == pytest.approx(26.18e3, abs=5)
    # Printed 583.1 N m.
    assert found.energy_fluctuation == pytest.approx(583.1, abs=0.05)
    assert found.unevenness == pytest.approx(0.0133, abs=5e-5)
    assert found.acceleration_max == pytest.approx(9.11, abs=5e-3)
    assert found.acceleration_min == pytest.approx(-9.11, abs=5e-3)
    # At 60° the excess accelerates the flywheel with 7.965 rad/s².
    k = np.abs(np.degrees(found.crank_angle) - 60).argmin()
    excess = found.torque_driver[k] - found.torque_load[k]
    assert excess / found.inertia == pytest.approx(7.965, abs=5e-3)


def test_four_stroke_gas_engine() -> None:
    """20 kW at 300 rpm, triangles of expansion and compression, 3 to 1, ± 2 %: 255.2 kg m² is printed.

    The work of a cycle is 8000 J, of which expansion gives 12 000 J: a triangle of height 24 000/π N m.
    """
    expansion, compression = 24000 / math.pi, -8000 / math.pi
    found = diagram(
        speed="300 rpm",
        cycle="720 deg",
        unevenness="4 %",
        driver={
            "kind": "table",
            "angle": "0, 180, 270, 360, 450, 540, 720 deg",
            "torque": [0, 0, compression, 0, expansion, 0, 0],
        },
    )
    assert found.energy_cycle == pytest.approx(8000, rel=1e-12)
    assert found.power_mean == pytest.approx(20e3, rel=1e-12)
    # Closed form: the triangle above the mean, (11/12)² of its area.
    assert found.energy_fluctuation == pytest.approx(12000 * (11 / 12) ** 2, rel=1e-12)
    # Printed 10 081 N m and 255.2 kg m²; the book rounds the torques to 7638, 637 N m before.
    assert found.energy_fluctuation == pytest.approx(10081, abs=3)
    assert found.flywheel_inertia == pytest.approx(255.2, abs=0.3)


def test_example_16_8() -> None:
    """20000 + 9500 sin 2θ − 5700 cos 2θ N m at 180 rpm: 377 kW, 3121 kg m², 3.044 rad/s² are printed."""
    found = diagram(
        speed="180 rpm",
        unevenness="1 %",
        driver={"kind": "formula", "torque": "20000 + 9500*sin(2*phi) - 5700*cos(2*phi)"},
    )
    assert found.power_mean == pytest.approx(377e3, abs=500)
    # Printed 11 078 N m.
    assert found.energy_fluctuation == pytest.approx(11078, abs=1.0)
    # The book takes ω as 18.85 rad/s.
    assert found.flywheel_inertia == pytest.approx(3121, abs=3.0)
    # At 45° the excess is 9500 N m.
    assert 9500 / found.flywheel_inertia == pytest.approx(3.044, abs=0.003)
