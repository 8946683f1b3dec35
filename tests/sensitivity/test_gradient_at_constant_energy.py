"""Derivatives of δ, H and k_p at constant energy against extrapolated differences; ties."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import linkwright as lw
from linkwright import FindingError, LinkwrightError, Machine

NAMES = ("unevenness", "dynamism", "motion_coefficient")
MACHINES = sorted(
    path
    for path in (*Path("machines").glob("*.toml"), *Path("examples").glob("*/machine.toml"))
    if lw.read(path).bodies and not lw.read(path).is_topper_alone
)


def _values(machine: Machine) -> np.ndarray:
    found = lw.constant_energy(machine)
    return np.array([getattr(found, name) for name in NAMES])


def _difference(machine: Machine, entry: str, h: float) -> np.ndarray:
    """Central differences of three steps, extrapolated."""
    value = lw.get(machine, entry)

    def central(step: float) -> np.ndarray:
        ends = [_values(lw.replace(machine, {entry: value + way * step})) for way in (1, -1)]
        return (ends[0] - ends[1]) / (2 * step)

    coarse, middle, fine = (central(h / 2**k) for k in range(3))
    first, second = (4 * middle - coarse) / 3, (4 * fine - middle) / 3
    return (16 * second - first) / 15


@pytest.mark.parametrize("path", MACHINES, ids=lambda path: path.parent.name + "/" + path.stem)
def test_against_differences(path: Path) -> None:
    machine = lw.read(path)
    try:
        at = _values(machine)
    except LinkwrightError:
        pytest.skip("no inertia, or it does not close")
    if at[0] < 1e-11:
        pytest.skip("the inertia is constant")
    found = lw.gradient(machine, ["constant_energy"])
    assert found.responses == tuple(f"constant_energy.{name}" for name in NAMES)
    assert found.values == pytest.approx(at, rel=1e-12)
    # An entry of zero has no neighbours on both sides, and sections of a cam change together alone.
    sizes = np.abs([lw.get(machine, entry) for entry in found.variables])
    weighed = np.abs(found.derivatives * sizes)
    largest = np.nan_to_num(weighed).max(axis=1)
    # The entries that matter most, and one that does not.
    order = [
        nth
        for nth in np.argsort(-np.nan_to_num(weighed).max(axis=0))
        if np.nan_to_num(weighed[:, nth]).max() > 0
    ]
    order = [nth for nth in order if ".sections." not in found.variables[nth]]
    # Five like cranks reach every extreme five times.
    assert order or found.ties
    for nth in [*order[:4], *order[-1:]]:
        difference = _difference(machine, found.variables[nth], 1e-3 * sizes[nth]) * sizes[nth]
        off = np.abs(found.derivatives[:, nth] * sizes[nth] - difference)
        known = np.isfinite(found.derivatives[:, nth])
        # The series of the revolution are good to 1e-13: differences over 2.5e-4 to 1e-9.
        assert (off[known] <= 1e-7 * largest[known]).all(), (found.variables[nth], off / largest)


def test_ties_are_told() -> None:
    """Two like carts a quarter of a revolution apart reach the peak of acceleration more than once."""
    machine = lw.read("machines/roller_two_carts.toml", {"mechanism.cranks.A2.phase": np.pi})
    found = lw.gradient(machine, ["constant_energy"], ["mechanism.cranks.A2.phase", "bodies.cart1.mass"])
    value, step = lw.get(machine, "mechanism.cranks.A2.phase"), 1e-4
    below, at, above = (
        _values(lw.replace(machine, {"mechanism.cranks.A2.phase": value + change}))
        for change in (-step, 0.0, step)
    )
    for nth, name in enumerate(NAMES):
        left, right = at[nth] - below[nth], above[nth] - at[nth]
        if abs(left - right) > 0.1 * max(abs(left), abs(right)) and abs(left) > 1e-6 * step:
            assert f"constant_energy.{name}" in found.ties


def test_a_constant_inertia_has_none() -> None:
    machine = lw.read("machines/roller_one_cart.toml").with_entries({"bodies": {}})
    with pytest.raises(FindingError, match="the inertia is constant"):
        lw.gradient(machine, ["constant_energy"], ["mechanism.cranks.A1.radius"])
