"""Laws that derivatives of rotators of rod strings obey, ties, what has none."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import FindingError, InputError
from linkwright.machine import exchanged
from linkwright.pumping.model.rod_rotator import diagonal_extremes
from linkwright.pumping.rotator_gradient import RotatorAlong
from linkwright.sensitivity.sources import source

# What holds in the continuous regime with lengths that are made for it: change points.
_LOST = {"lever_turns_per_cycle", "worm_turns_per_cycle", "lever_swing", "link_force_max"}


@pytest.mark.parametrize("name", ["continuous", "intermittent"])
def test_lengths_have_one_scale(name: str) -> None:
    """Lengths are homogeneous of degree one in all lengths, transfer functions of degree zero."""
    machine = lw.read(f"machines/rod_rotator_{name}.toml")
    gradient = lw.gradient(machine, ["rod_rotator"])
    sizes = {f"pumping_unit.{key}" for key in (*"ACIPHGR", "cable")} | {"rod_rotator.pin_distance"}
    for response, value in zip(gradient.responses, gradient.values, strict=True):
        slopes = gradient.of(response)
        degree = sum(slopes[size] * float(lw.get(machine, size)) for size in sizes) / value
        expected = {"link_length": 1, "lever_length": 1, "diagonal_min": 1, "diagonal_max": 1}
        expected["link_force_max"] = -1
        assert degree == pytest.approx(expected.get(response.partition(".")[2], 0), abs=1e-10), response


def test_a_lever_keeps_its_required_swing() -> None:
    machine = lw.read("machines/rod_rotator_intermittent.toml")
    slopes = lw.gradient(machine, ["rod_rotator.lever_swing"]).of("rod_rotator.lever_swing")
    for name, slope in slopes.items():
        assert slope == pytest.approx(float(name == "rod_rotator.swing"), abs=1e-12), name


def test_extremes_beside_a_change_point() -> None:
    """Derivatives of the transfer function at a change point, against differences at the same angle."""
    machine = lw.read("machines/rod_rotator_continuous.toml")
    change = lw.rod_rotator(machine, n=8).change_points[0]
    entries = ["pumping_unit.R", "rod_rotator.pin_distance"]
    along = RotatorAlong.of(machine, entries)
    for angle in (change, change + 1e-5, change - 0.01, change + 0.059, change + 0.061):
        for entry, exact in zip(entries, along.transfer_at(angle).d, strict=True):
            value = lw.get(machine, entry)

            def rate(share: float, angle: float = angle, entry: str = entry, value: float = value) -> float:
                near = exchanged(machine, {entry: value * (1 + share)})
                return float(lw.kinematics(near, np.array([angle])).links["rotator.rocker"].d1[0])

            once, twice = ((rate(n * 1e-3) - rate(-n * 1e-3)) / (2e-3 * n * value) for n in (1, 2))
            assert exact == pytest.approx((4 * once - twice) / 3, rel=1e-7, abs=1e-7), (angle, entry)


def test_a_force_as_large_at_both_ends_ties() -> None:
    """l_4² + l_5² = (m² + M²)/2: the arm of the link is as short at the top as at the bottom."""
    free = lw.read("machines/rod_rotator_continuous.toml")
    m, M = map(float, diagonal_extremes(free.pumping_unit, free.rod_rotator))
    lever = 0.5
    entries = {"regime": "intermittent", "lever_length": lever}
    entries |= {"link_length": float(np.sqrt(0.5 * (m * m + M * M) - lever**2))}
    machine = lw.replace(free, {f"rod_rotator.{key}": value for key, value in entries.items()})
    derived = source(machine, "rod_rotator", ["rod_rotator.pin_distance", "rod_rotator.string_torque"])
    assert list(derived.ties) == ["rod_rotator.link_force_max"]
    assert "2 positions" in derived.ties["rod_rotator.link_force_max"]
    slopes = derived.tangents["rod_rotator.link_force_max"].d
    assert np.isnan(slopes[0])
    assert np.isfinite(slopes[1])


def test_what_has_no_derivative() -> None:
    machine = lw.read("machines/rod_rotator_continuous.toml")
    assert {name.partition(".")[2] for name in source(machine, "rod_rotator", []).missing} == _LOST
    with pytest.raises(FindingError, match="whole number"):
        lw.gradient(machine, ["rod_rotator.lever_turns_per_cycle"])
    # The same lengths, given: beside them link and lever do not pass through a line.
    motion = lw.rod_rotator(machine, n=8)
    given = {f"rod_rotator.{key}": getattr(motion, key) for key in ("link_length", "lever_length")}
    with pytest.raises(InputError, match="change points"):
        lw.gradient(lw.replace(machine, given), ["rod_rotator.transfer_max"], ["rod_rotator.link_length"])
