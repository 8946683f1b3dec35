"""What commands say of cycles of several revolutions, of counterweights in two planes, and of a function."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke

import linkwright as lw
from linkwright.kernel.reader.numbers import crank_angle

FOUND = Path(__file__).parents[1] / "found"
OTHER_ZERO = ("--set", "mechanism.cranks.B.phase=200 deg", "--set", "mechanism.sliders.C.assembly=negative")


def run(*words: str) -> str:
    result = invoke(*words, catch_exceptions=False)
    # Beside a change point forces grow without limit, which is a finding.
    assert result.exit_code == 0 or "unbounded or indeterminate" in result.output, result.output
    return result.output


def answer(*words: str) -> dict:
    return json.loads(run(*words, "--json"))["results"]


def test_balance_is_the_same_from_another_zero() -> None:
    words = ("balance", str(FOUND / "tangent_rod.toml"), "--links", "B", "--radius", "100 mm")
    words += ("--speed", "9 rad/s")
    first, second = (answer(*words, *zero)["balance"] for zero in ((), OTHER_ZERO))
    assert second["counterweights"]["B"]["mass"] == pytest.approx(first["counterweights"]["B"]["mass"])
    assert second["counterweights"]["B"]["angle"] == pytest.approx(first["counterweights"]["B"]["angle"])
    for name, value in first["rms"].items():
        assert second["rms"][name] == pytest.approx(value, rel=1e-7), name


def test_run_is_the_same_from_another_zero() -> None:
    first, second = (answer("run", str(FOUND / "tangent_rod.toml"), *zero) for zero in ((), OTHER_ZERO))
    for analysis in ("reduction", "constant_energy", "steady_state"):
        for name, value in first[analysis].items():
            # Places of extremes depend on the zero; accuracy and steps are those of the search.
            if not isinstance(value, float) or name.endswith("_angle") or name in ("accuracy", "multiplier"):
                continue
            size = 100.0 if "torque" in name else 0.0
            assert second[analysis][name] == pytest.approx(value, rel=1e-7, abs=1e-9 * size), name


def test_the_end_of_a_revolution_is_zero_only_where_the_cycle_ends() -> None:
    assert crank_angle(2 * math.pi) == "0°"
    assert crank_angle(2 * math.pi, cycle=4 * math.pi) == "360°"
    assert crank_angle(4 * math.pi, cycle=4 * math.pi) == "0°"


def test_a_counterweight_for_each_plane() -> None:
    words = ("balance", str(FOUND / "balance_two_planes.toml"), "--links", "A", "--planes", "-10 in, 40 in")
    words += ("--radius", "15 in")
    slow, fast = answer(*words)["balance"], answer(*words, "--speed", "100 rpm")["balance"]
    masses = [weight["mass"] for weight in fast["counterweights"].values()]
    # Bevan: 200 lb at 9 in, balanced at 15 in in planes 10 in before and 40 in behind: 96 and 24 lb.
    assert masses == pytest.approx(np.array([96, 24]) * 0.45359237)
    assert {weight["link"] for weight in fast["counterweights"].values()} == {"A"}
    assert [weight["mass"] for weight in slow["counterweights"].values()] == pytest.approx(masses)
    assert slow["speed_source"].startswith("the file has no drive.speed")
    # What is rounding beside the inertia of the mass is none.
    assert fast["rms"]["shaking_moment"] == {"before": 0.0, "after": 0.0}
    assert fast["rms"]["torque_drive"] == {"before": 0.0, "after": 0.0}


def test_the_choices_that_rebuild_a_function_generator() -> None:
    told = answer("synthesise", "function", str(FOUND / "function_generator.toml"))["function_generator"]
    crank = told["crank_start"] + (math.pi if told["crank_opposite"] else 0.0)
    text = f"""
format = 1
name = "from the table"
[mechanism.points]
B0 = {{ x = {told["frame"]} }}
[mechanism.cranks.A]
radius = {told["crank"]}
phase = {crank}
[mechanism.rockers.B]
crank = "A"
pivot = "B0"
coupler = {told["coupler"]}
rocker = {told["rocker"]}
assembly = "{told["assembly"]}"
"""
    turned = lw.kinematics(lw.loads(text), [0.0, np.radians(75.0)]).links["B.rocker"].angle
    # Freudenstein's equation is met at three points; the ends of the range are off by the structural error.
    rocker = turned - (math.pi if told["rocker_opposite"] else 0.0) - told["rocker_start"]
    off = np.angle(np.exp(1j * (rocker - np.array([0.0, np.radians(32.25)]))))
    assert np.abs(off).max() <= told["angle_error_max"] * (1 + 1e-6)
