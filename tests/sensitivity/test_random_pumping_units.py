"""Derivatives of random pumping units and of their gearboxes against extrapolated differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from differences import sixth_order
from sizes import cases, random_cases

import linkwright as lw
from linkwright import LinkwrightError
from linkwright.machine import exchanged
from linkwright.sensitivity.sources import source

# Shares of an entry by which it is varied: the shorter where two peaks nearly tie.
_STEPS = (3e-5, 3e-6)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7

# Conventional by API's example, the others with sizes of their kind.
_BASES = {
    "conventional": {"A": 1.83, "C": 1.63, "I": 1.63, "P": 1.89, "H": 2.95, "G": 1.04, "R": 0.6},
    "mark_ii": {"A": 6.1, "C": 4.4, "I": 3.6, "P": 3.0, "H": 5.6, "G": 1.6, "R": 1.0},
    "air_balanced": {"A": 6.1, "C": 4.4, "I": 3.6, "P": 3.0, "H": 5.6, "G": 1.6, "R": 0.9},
}


def _load(rng: np.random.Generator, geometry: str) -> dict[str, Any]:
    load: dict[str, Any] = {"efficiency": rng.uniform(0.9, 1.0), "phase": rng.uniform(-0.2, 0.2)}
    if rng.random() < 0.5:
        inner = np.sort(rng.uniform(0.1, 0.9, 2))
        load |= {"position": [0.0, *inner.tolist(), 1.0]}
        load |= {"up": rng.uniform(3e4, 5e4, 4).tolist(), "down": rng.uniform(1e4, 3e4, 4).tolist()}
    else:
        load |= {"angle": (np.arange(6) + rng.uniform(0.1, 0.9, 6)).tolist()}
        load |= {"force": rng.uniform(1e4, 5e4, 6).tolist()}
    key = "counterbalance_effect" if geometry == "air_balanced" else "counterbalance"
    if rng.random() < 0.6:
        load[key] = rng.uniform(1.5e4, 3e4)
    return load


def _machine(rng: np.random.Generator, geometry: str) -> lw.Machine:
    sizes = {key: value * rng.uniform(0.95, 1.05) for key, value in _BASES[geometry].items()}
    unit = {"geometry": geometry, **sizes, "structural_unbalance": rng.uniform(-2e3, 2e3)}
    described = {"format": 1, "name": "Unit", "drive": {"speed": rng.uniform(0.5, 1.5)}}
    return lw.Machine.model_validate(described | {"pumping_unit": unit | {"load": _load(rng, geometry)}})


def _numbers(machine: lw.Machine, names: list[str]) -> np.ndarray:
    motion = lw.pumping_unit(machine, n=8)
    values = [getattr(motion.gear if "gear." in name else motion, name.rpartition(".")[2]) for name in names]
    return np.array(values, dtype=float)


def _difference(machine: lw.Machine, names: list[str], address: str, step: float) -> np.ndarray:
    """The derivatives by an entry, times it."""
    value = lw.get(machine, address)
    return sixth_order(
        lambda share: _numbers(exchanged(machine, {address: value * (1 + share)}), names), step
    )


def _wrong(machine: lw.Machine, every: int) -> tuple[int, list[str]]:
    """How many derivatives were compared, and which are wrong."""
    derived = source(machine, "pumping_unit", list(lw.addresses(machine)))
    names = [name for name in derived.tangents if name not in derived.ties]
    d = np.array([derived.tangents[name].d for name in names])
    exact = d * np.array([float(lw.get(machine, name)) for name in derived.variables])
    scales = np.abs(exact).max(axis=1) + [abs(derived.tangents[name].value) for name in names]
    # A minimum torque of zero, at an end of the stroke, is rounding beside the maximum.
    torques = np.array(["gear.torque_net" in name for name in names])
    scales[torques] += max(abs(derived.tangents[name].value) for name in names if "gear.torque_net" in name)
    wrong, compared = [], 0
    for k in np.flatnonzero(np.abs(exact).max(axis=0))[::every]:
        errors = []
        for step in _STEPS:
            rough = _difference(machine, names, derived.variables[k], step)
            errors.append(np.abs(rough - exact[:, k]) / scales)
            if (errors[0] <= _TOLERANCE).all():
                break
        least = np.min(errors, axis=0)
        wrong += [
            f"{name} by {derived.variables[k]}: {least[i]:.1e}"
            for i, name in enumerate(names)
            if least[i] > _TOLERANCE and not errors[-1][i] < 1e-2 * errors[0][i]
        ]
        compared += len(names)
    return compared, wrong


@pytest.mark.parametrize("geometry", _BASES)
def test_derivatives_are_those_of_the_unit(geometry: str) -> None:
    compared = 0
    for case, random in random_cases(23, 1, 60):
        try:
            machine = _machine(random, geometry)
            lw.pumping_unit(machine, n=8)
        except LinkwrightError:
            # A crank that cannot turn.
            continue
        one, wrong = _wrong(machine, cases(6, 2))
        assert not wrong, (geometry, case, wrong)
        compared += one
    assert compared > 30
