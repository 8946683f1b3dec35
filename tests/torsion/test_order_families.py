"""Families of orders without a common base: exact each, added as a bound; frequencies over their period."""

from __future__ import annotations

import numpy as np
import pytest

import linkwright as lw
from linkwright import forced_vibration, torsion_study
from linkwright.torsion import orders_together, span

RATIO = 67 / 97


def test_families_are_summed_exactly() -> None:
    """Over the true period of 97 revolutions the sum comes close to the bound, which sums of sizes exceed."""
    values = np.array([RATIO, 1.0, 2 * RATIO, 2.0, 3.0])
    sizes = np.array([3.0, 5.0, 2.0, 4.0, 1.0]) * np.exp(1j * np.array([0.3, 1.0, 2.5, -0.4, 0.2]))
    orders = orders_together(values)
    assert sorted(len(places) for places, _ in orders.families) == [2, 3]
    angle = 2 * np.pi * np.arange(0.0, 97.0, 1e-4)
    wave = (sizes[:, None] * np.exp(1j * np.outer(values, angle))).real.sum(axis=0)
    top, bottom = (float(one[0]) for one in span(orders, sizes[:, None], 0.7))
    assert wave.max() + 0.7 <= top <= wave.max() + 0.7 + 0.02
    assert wave.min() + 0.7 - 0.02 <= bottom <= wave.min() + 0.7
    assert top < np.abs(sizes).sum() + 0.7 - 0.5


def test_frequencies_have_a_period_of_their_own() -> None:
    """The supply frequency and its double are summed in phase, beside an order as their own family."""
    fixed = np.array([0.0, 100 * np.pi, 200 * np.pi])
    orders = orders_together(np.array([2.0, 0.0, 0.0]), fixed)
    sizes = np.array([[1.0 + 0j], [2.0], [2.0j]])
    time = np.linspace(0.0, 0.02, 200001)
    wave = (sizes[1:] * np.exp(1j * np.outer(fixed[1:], time))).real.sum(axis=0)
    top, bottom = (float(one[0]) for one in span(orders, sizes))
    assert top == pytest.approx(1.0 + wave.max(), rel=1e-8)
    assert bottom == pytest.approx(-1.0 + wave.min(), rel=1e-8)


def test_study_states_the_bound_and_its_derivatives_follow() -> None:
    """A train with two families says that their peaks are added; the derivative is that of this sum."""

    def machine(torque: float) -> lw.Machine:
        return lw.Machine.model_validate(
            {
                "format": 1,
                "name": "families",
                "train": {
                    "discs": {"a": {"inertia": 1.0}, "b": {"inertia": 0.4}, "c": {"inertia": 2.0}},
                    "shafts": {"s": {"between": ["a", "b"], "stiffness": 4e4, "loss_factor": 0.05}},
                    "gears": {"g": {"between": ["b", "c"], "teeth": [67, 97], "stiffness": 1e6}},
                    "excitations": {
                        "e": {
                            "on": "a",
                            "harmonics": [{"order": 1.0, "torque": torque}, {"order": 2.0, "torque": 8.0}],
                        },
                        "f": {
                            "on": "c",
                            "harmonics": [{"order": 1.0, "torque": 6.0}, {"order": 2.0, "torque": 5.0}],
                        },
                    },
                    "run": {"speed_min": 20.0, "speed_max": 60.0, "points": 5},
                },
            }
        )

    study = torsion_study(machine(10.0))
    assert any("the peaks of each family are added, an upper bound" in text for text in study.warnings)
    name, entry = "forced_vibration.shaft_torque_vibratory.s", "train.excitations.e.harmonics.0.torque"
    found = lw.gradient(machine(10.0), [name], [entry])
    more, less = (
        float(forced_vibration(machine(torque)).shaft_torque_vibratory[0].max()) for torque in (10.01, 9.99)
    )
    assert found.of(name)[entry] == pytest.approx((more - less) / 0.02, rel=1e-5)
