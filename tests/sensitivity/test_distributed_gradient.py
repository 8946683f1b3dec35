"""Derivatives of trains with distributed inertia against extrapolated differences, limits and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.random import Generator
from sizes import cases

import linkwright as lw
from linkwright.kernel.errors import FindingError, LinkwrightError
from linkwright.machine.address import exchanged

# Shares of an entry by which it is varied: between two extremes that nearly tie, or over a number of stations
# that changes, longer steps err; over shorter ones rounding does.
_STEPS = (1e-3, 2e-4, 5e-5, 1e-5)

# What differences are good for, as a share of the largest derivative of a response, or of the response.
_TOLERANCE = 1e-7

Measure = Callable[[lw.Machine], np.ndarray]


def _sections(random: Generator) -> list[dict[str, Any]]:
    """One to three sections of a shaft, a taper or a bore among them."""
    sections = []
    for _ in range(random.integers(1, 4)):
        d = float(random.uniform(0.05, 0.1))
        section: dict[str, Any] = {"length": float(random.uniform(0.3, 2.0)), "diameter": d}
        if random.random() < 0.15:
            section |= {"kind": "taper", "diameter_end": d * float(random.uniform(0.7, 1.3))}
        elif random.random() < 0.3:
            section["inner_diameter"] = d * float(random.uniform(0.2, 0.6))
        sections.append(section)
    return sections


def _shaft(random: Generator, between: list[str]) -> dict[str, Any]:
    """A shaft without inertia, or with one at its ends or along it."""
    shaft: dict[str, Any] = {"between": between, "loss_factor": float(random.choice([0.0, 0.01, 0.05]))}
    shaft["damping"] = float(random.choice([0.0, random.uniform(1.0, 50.0)]))
    kind = random.choice(["light", "rod", "sections"], p=[0.2, 0.4, 0.4])
    if kind != "sections":
        shaft["stiffness"] = float(10 ** random.uniform(4.0, 6.0))
    if kind == "rod":
        shaft["own_inertia"] = float(10 ** random.uniform(-2.0, 0.5))
    if kind == "sections":
        shaft |= {"sections": _sections(random), "density": float(random.uniform(2700, 7850))}
    if kind != "light" and random.random() < 0.2:
        shaft["inertia"] = "ends"
    return shaft


def random_distributed_train(random: Generator) -> dict[str, Any]:
    """A line with a geared branch, in some a wall or two shafts side by side."""
    n = int(random.integers(2, 5))
    discs = {
        f"d{i}": {"inertia": float(10 ** random.uniform(-1.0, 1.0)), "damping": float(random.uniform(0.0, 20.0))}
        for i in range(n)
    }
    shafts = {f"s{i}": _shaft(random, [f"d{i - 1}", f"d{i}"]) for i in range(1, n)}
    gears: dict[str, Any] = {}
    if random.random() < 0.5:
        for name in ("g0", "g1"):
            discs[name] = {"inertia": float(10 ** random.uniform(-1.0, 1.0))}
        gears["g"] = {"between": [f"d{random.integers(n)}", "g0"], "ratio": float(random.uniform(0.3, 3.0))}
        if random.random() < 0.4:
            gears["g"] |= {"stiffness": float(10 ** random.uniform(4.0, 6.0)), "damping": 5.0}
        shafts["branch"] = _shaft(random, ["g0", "g1"])
    if random.random() < 0.2:
        shafts["wall"] = _shaft(random, [f"d{n - 1}", "ground"])
    if random.random() < 0.2:
        shafts["beside"] = _shaft(random, ["d0", "d1"])
    # One shaft at least has its inertia along it.
    shafts["s1"].pop("inertia", None)
    if "density" not in shafts["s1"]:
        shafts["s1"] |= {"stiffness": shafts["s1"].get("stiffness", 1e5), "own_inertia": 0.3}
    waves = [
        {"order": float(order), "torque": float(random.uniform(50, 500)), "phase": float(random.uniform(-3, 3))}
        for order in random.choice([0.5, 1, 1.5, 2, 3, 4], size=3, replace=False)
    ]
    return {
        "inertia": "distributed",
        "modes": 5,
        "run": {"speed_min": 20.0, "speed_max": float(random.uniform(60, 300)), "points": 5},
        "discs": discs,
        "shafts": shafts,
        "gears": gears,
        "loads": {"l": {"on": f"d{n - 1}", "torque": 300.0, "speed": 50.0, "exponent": 2}},
        "excitations": {"e": {"on": f"d{random.integers(n)}", "harmonics": waves}},
    }


def _machine(random: Generator) -> lw.Machine:
    described = {"format": 1, "name": "train", "train": random_distributed_train(random)}
    return lw.Machine.model_validate(described)


def _modes(names: list[str]) -> Measure:
    """Frequencies and amplitudes by the names of responses."""

    def measure(machine: lw.Machine) -> np.ndarray:
        found = lw.free_vibration(machine)
        values = []
        for name in names:
            _, quantity, mode, *disc = name.split(".")
            row = getattr(found, quantity)[int(mode)]
            values.append(row[found.discs.index(disc[0])] if disc else row)
        return np.array(values)

    return measure


def _forced(machine: lw.Machine, names: list[str]) -> Measure:
    """Torques at the speeds at which they are largest."""
    found = lw.forced_vibration(machine)
    rows = [name.split(".")[1:] for name in names]
    places = [int(getattr(found, kind)[found.shafts.index(shaft)].argmax()) for kind, shaft in rows]

    def measure(machine: lw.Machine) -> np.ndarray:
        at = lw.forced_vibration(machine)
        pairs = zip(rows, places, strict=True)
        return np.array([getattr(at, kind)[at.shafts.index(shaft), place] for (kind, shaft), place in pairs])

    return measure


def _difference(machine: lw.Machine, address: str, measure: Measure, step: float) -> np.ndarray:
    """Central differences over h, 2h and 4h, extrapolated to sixth order, times the entry."""
    value = lw.get(machine, address)
    near = {n: measure(exchanged(machine, {address: value * (1 + n * step)})) for n in (-4, -2, -1, 1, 2, 4)}
    once, twice, four = ((near[n] - near[-n]) / (2 * n * step) for n in (1, 2, 4))
    found: np.ndarray = (64 * once - 20 * twice + four) / 45
    return found


def errors_of(machine: lw.Machine, found: lw.Gradient, measure: Measure, every: int) -> dict[tuple[str, str], float]:
    """Errors of derivatives as a share of the largest of the response, or of the response, but for ties.

    Amplitudes are compared with the largest of their mode: rounding of a shape is a share of that.
    """
    exact = found.derivatives * found.at
    scale = np.maximum(np.abs(exact).max(axis=1), np.abs(found.values))
    modes = [name.rpartition(".")[0] if ".mode_shapes." in name else name for name in found.responses]
    scale = np.array([max(s for s, other in zip(scale, modes, strict=True) if other == mode) for mode in modes])
    free = [k for k, name in enumerate(found.responses) if name not in found.ties]
    errors = {}
    for place in np.flatnonzero(found.at)[::every]:
        address = found.variables[place]
        best = np.full(len(modes), np.inf)
        for step in _STEPS:
            try:
                measured = _difference(machine, address, measure, step)
            except LinkwrightError:
                break
            best = np.minimum(best, np.abs(exact[:, place] - measured) / scale)
            if best[free].max(initial=0.0) < _TOLERANCE / 100:
                break
        errors |= {(found.responses[k], address): float(best[k]) for k in free if np.isfinite(best[k])}
    return errors
