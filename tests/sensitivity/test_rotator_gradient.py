"""Derivatives of random rotators of rod strings against extrapolated differences, and laws they obey."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from differences import sixth_order
from sizes import cases, random_cases

import linkwright as lw
from linkwright import FindingError, InputError, LinkwrightError
from linkwright.machine import exchanged
from linkwright.pumping.model.rod_rotator import diagonal_extremes
from linkwright.pumping.rotator_gradient import RotatorAlong
from linkwright.sensitivity.sources import Source, source

# Shares of an entry by which it is varied: the shorter where link and lever are nearly in line.
_STEPS = (3e-4, 3e-5, 3e-6)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7

# Conventional by API's example, the others with sizes of their kind.
_BASES = {
    "conventional": {"A": 1.83, "C": 1.63, "I": 1.63, "P": 1.89, "H": 2.95, "G": 1.04, "R": 0.6},
    "mark_ii": {"A": 6.1, "C": 4.4, "I": 3.6, "P": 3.0, "H": 5.6, "G": 1.6, "R": 1.0},
    "air_balanced": {"A": 6.1, "C": 4.4, "I": 3.6, "P": 3.0, "H": 5.6, "G": 1.6, "R": 0.9},
}

# What holds in the continuous regime with lengths that are made for it: change points.
_LOST = {"lever_turns_per_cycle", "worm_turns_per_cycle", "lever_swing", "link_force_max"}


def _machine(rng: np.random.Generator, regime: str, lengths: str) -> lw.Machine:
    geometry = str(rng.choice(list(_BASES)))
    unit: dict[str, Any] = {key: size * rng.uniform(0.9, 1.1) for key, size in _BASES[geometry].items()}
    unit |= {"geometry": geometry, "cable": unit["A"] * rng.uniform(0.05, 0.7)}
    unit |= {"rotation": str(rng.choice(["clockwise", "counter_clockwise"]))}
    rotator: dict[str, Any] = {
        "regime": regime,
        "pin_distance": unit["A"] * rng.uniform(0.4, 0.98),
        "assembly": str(rng.choice(["left", "right"])),
        "clutch": str(rng.choice(["upstroke", "downstroke"])),
        "worm_ratio": rng.uniform(20, 60),
        "worm_efficiency": rng.uniform(0.3, 0.9),
        "string_torque": rng.uniform(100, 500),
    }
    described = {
        "format": 1,
        "name": "Rotator",
        "drive": {"speed": rng.uniform(0.3, 1.5)},
        "pumping_unit": unit,
    }
    if lengths == "given":
        # Beyond the horsehead, the pin comes nearest to the hanger within the stroke.
        rotator["pin_distance"] = unit["A"] * rng.uniform(0.4, 1.1)
        free = lw.Machine.model_validate(described | {"rod_rotator": rotator | {"regime": "continuous"}})
        m, M = map(float, diagonal_extremes(free.pumping_unit, free.rod_rotator))
        lever = 0.5 * (M - m) * rng.uniform(1.05, 3)
        link = M - lever + (m - M + 2 * lever) * rng.uniform(0.05, 0.95)
        rotator |= {"lever_length": lever, "link_length": link}
    elif regime == "intermittent":
        rotator["swing"] = float(np.radians(rng.uniform(20, 150)))
    return lw.Machine.model_validate(described | {"rod_rotator": rotator})


def _numbers(machine: lw.Machine, names: list[str]) -> np.ndarray:
    motion = lw.rod_rotator(machine, n=8)
    return np.array([getattr(motion, name.partition(".")[2]) for name in names], dtype=float)


def _difference(machine: lw.Machine, names: list[str], address: str, step: float) -> np.ndarray:
    """The derivatives by an entry, times it."""
    value = lw.get(machine, address)
    return sixth_order(
        lambda share: _numbers(exchanged(machine, {address: value * (1 + share)}), names), step
    )


def _is_of_rotator(name: str) -> bool:
    return name == "drive.speed" or name.startswith(("pumping_unit.", "rod_rotator."))


def _wrong(machine: lw.Machine, derived: Source, many: int, rng: np.random.Generator) -> list[str]:
    """Which derivatives by some of the entries are wrong."""
    names = [name for name in derived.tangents if name not in derived.ties]
    d = np.array([derived.tangents[name].d for name in names])
    exact = d * np.array([float(lw.get(machine, name)) for name in derived.variables])
    scales = np.abs(exact).max(axis=1) + [abs(derived.tangents[name].value) for name in names]
    moving = [k for k, name in enumerate(derived.variables) if _is_of_rotator(name) and d[:, k].any()]
    wrong = []
    for k in rng.permutation(moving)[:many]:
        least = np.full(len(names), np.inf)
        for step in _STEPS:
            try:
                difference = _difference(machine, names, derived.variables[k], step)
            except LinkwrightError:
                continue
            least = np.minimum(least, np.abs(difference - exact[:, k]) / scales)
            if (least < _TOLERANCE).all():
                break
        wrong += [
            f"{name} by {derived.variables[k]}: {error:.1e}"
            for name, error in zip(names, least, strict=True)
            if error > _TOLERANCE
        ]
    return wrong


@pytest.mark.parametrize("lengths", ["given", "made"])
@pytest.mark.parametrize("regime", ["continuous", "intermittent"])
def test_derivatives_are_those_of_the_rotator(regime: str, lengths: str) -> None:
    compared = 0
    for case, rng in random_cases(31, 7, 80):
        try:
            machine = _machine(rng, regime, lengths)
            lw.rod_rotator(machine, n=8)
        except LinkwrightError:
            # A crank that cannot turn, lengths that do not meet, or a swing that no lever has.
            continue
        derived = source(machine, "rod_rotator", list(lw.addresses(machine)))
        assert not any(map(_is_of_rotator, derived.refused)), derived.refused
        wrong = _wrong(machine, derived, cases(1, 4), rng)
        assert not wrong, (regime, lengths, case, wrong)
        compared += 1
    assert compared > 3


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
