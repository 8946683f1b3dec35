"""Drives behind laws: each has its torque, and what the sum of all is is named."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw

FOUND = Path(__file__).parents[1] / "found" / "use"
SERVO = str(FOUND / "servo_carriage.toml")


def shown(*words: str) -> str:
    return " ".join(invoke(*words).stdout.split())


def test_the_shaft_in_front_of_a_law() -> None:
    """Its power is that of the drive behind it: M_shaft ω = M_drive ω dψ/dφ."""
    found = lw.forces(lw.read(SERVO), n=720)
    phi, h = found.crank_angle, np.pi
    slope = h / np.pi * np.where(phi < np.pi, 1 - np.cos(2 * phi), -(1 - np.cos(2 * phi)))
    np.testing.assert_allclose(found.torque_drive, found.drives["A"] * slope, atol=1e-9 * 45)
    assert found.laws == ("A",)
    assert found.shaft == "torque referred to the master shaft"
    assert abs(found.drive_max["A"]) == pytest.approx(25.99, abs=0.01)


def test_every_output_names_it() -> None:
    """Table, JSON, run and size; each drive has its row."""
    table = shown("forces", SERVO)
    assert "torque referred to the master shaft" in table
    assert "torque of the drive A 25.9" in table
    results = json.loads(invoke("forces", SERVO, "--json").stdout)["results"]
    text = json.dumps(results)
    assert "torque referred to the master shaft" in text
    assert '"A drive"' in text
    assert '"drive_max"' in text
    assert "The law of A acts as a cam on the crankshaft" in shown("run", SERVO)
    sized = shown("size", SERVO, "--catalogue", str(FOUND / "motors.csv"))
    assert "drives the input shaft of the law of A" in sized
    assert "give it [axes.A] and use linkwright axes" in sized


def test_a_crank_without_a_law_keeps_its_words() -> None:
    table = shown("forces", "roller_one_cart")
    assert "driving torque at the crank" in table
    assert "torque of the drive" not in table
    assert "acts as a cam" not in table
