"""Flywheels of textbooks: R. S. Khurmi, J. K. Gupta, Theory of Machines, 2005, chapter 16; and Shigley."""

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


# Torque of a single-cylinder four-stroke engine every 15° over two revolutions [lbf in]: J. E. Shigley,
# C. R. Mischke, R. G. Budynas, Mechanical Engineering Design, 7th edition 2004, table 16-6.
_SHIGLEY = (
    *(0, 2800, 2090, 2430, 2160, 1840, 1590, 1210, 1066, 803, 532, 184),
    *(0, -107, -206, -260, -323, -310, -242, -126, -8, 89, 125, 85),
    *(0, -85, -125, -89, 8, 126, 242, 310, 323, 280, 206, 107),
    *(0, -107, -206, -292, -355, -371, -362, -312, -272, -274, -548, -760, 0),
)


def test_four_stroke_engine_by_a_table_of_torques() -> None:
    """Example 16-6: 3368 lbf in of work, 268 lbf in on average, 3531 lbf in from 0° to 180° are printed."""
    pound_inch = 4.4482216152605 * 0.0254
    found = diagram(
        speed=250.0,
        cycle="720 deg",
        unevenness=0.1,
        driver={
            "kind": "table",
            "between": "linear",
            "angle": f"{', '.join(str(15 * k) for k in range(49))} deg",
            "torque": [f"{torque} in lb" for torque in _SHIGLEY],
        },
    )
    assert found.torque_mean * 4 * math.pi / pound_inch == pytest.approx(3368, abs=0.5)
    assert found.torque_mean / pound_inch == pytest.approx(268, abs=0.5)
    # The book takes the loop of the expansion stroke from 0° to 180° as ΔE; here it ends where the torque
    # crosses its mean, which makes it 1.5 % larger.
    energy = np.interp(np.radians([0, 180]), found.crank_angle, found.energy)
    assert (energy[1] - energy[0]) / pound_inch == pytest.approx(3531, abs=1.0)
    assert found.energy_fluctuation / pound_inch > 3531
    assert found.flywheel_inertia == pytest.approx(found.energy_fluctuation / (0.1 * 250**2), rel=1e-12)
