"""Flywheels of a textbook: R. S. Khurmi, J. K. Gupta, Theory of Machines, 14th edition 2005, chapter 16."""

from __future__ import annotations

import math

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
