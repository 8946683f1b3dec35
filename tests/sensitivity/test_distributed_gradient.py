"""Derivatives of trains with distributed inertia against differences, limits and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from differences import sixth_order
from numpy.random import Generator
from sizes import random_cases
from trains import mode_numbers

import linkwright as lw
from linkwright import FindingError
from linkwright.machine import exchanged

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
        f"d{i}": {
            "inertia": float(10 ** random.uniform(-1.0, 1.0)),
            "damping": float(random.uniform(0.0, 20.0)),
        }
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
        {
            "order": float(order),
            "torque": float(random.uniform(50, 500)),
            "phase": float(random.uniform(-3, 3)),
        }
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

    return lambda machine: mode_numbers(lw.free_vibration(machine), names)


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


def _difference(machine: lw.Machine, shares: dict[str, float], measure: Measure, step: float) -> np.ndarray:
    """The derivative along entries that change by shares."""
    at = {name: lw.get(machine, name) for name in shares}

    def near(way: float) -> np.ndarray:
        values = {name: at[name] * (1 + way * share) for name, share in shares.items()}
        return measure(exchanged(machine, values))

    return sixth_order(near, step)


def largest_error(
    machine: lw.Machine, found: lw.Gradient, measure: Measure, shares: dict[str, float]
) -> tuple[float, str]:
    """Error of the derivatives along shares of entries over the largest of a response, and where it is.

    Those that tie are left out. Amplitudes are compared with the largest of their mode, of which the rounding
    of a shape is a share.
    """
    exact = found.derivatives * found.at
    scale = np.maximum(np.abs(exact).max(axis=1), np.abs(found.values))
    of = [name.rpartition(".")[0] if ".mode_shapes." in name else name for name in found.responses]
    scale = np.array([max(s for s, other in zip(scale, of, strict=True) if other == mode) for mode in of])
    along = exact @ np.array([shares.get(name, 0.0) for name in found.variables])
    free = [k for k, name in enumerate(found.responses) if name not in found.ties]
    best = np.full(len(of), np.inf)
    for step in _STEPS:
        best = np.minimum(best, np.abs(along - _difference(machine, shares, measure, step)) / scale)
        if best[free].max(initial=0.0) < _TOLERANCE:
            break
    worst = max(free, key=lambda k: best[k], default=None)
    return (0.0, "") if worst is None else (float(best[worst]), found.responses[worst])


def _shares(random: Generator, machine: lw.Machine, found: lw.Gradient) -> dict[str, float]:
    """All entries at once, each by a share of its own."""
    known = [name for name in found.variables if name.startswith("train")]
    entries = [name for name in known if isinstance(lw.get(machine, name), float)]
    return {name: float(random.uniform(-1.0, 1.0)) for name in entries if lw.get(machine, name)}


def test_modes_of_random_trains() -> None:
    for case, random in random_cases(11, 12, 300):
        machine = _machine(random)
        found = lw.gradient(machine, ["free_vibration.natural_frequencies", "free_vibration.mode_shapes"])
        measure = _modes(list(found.responses))
        assert measure(machine) == pytest.approx(found.values, rel=1e-10, abs=1e-10)
        error, what = largest_error(machine, found, measure, _shares(random, machine, found))
        assert error < _TOLERANCE, (case, what, error)


def test_torques_of_random_trains() -> None:
    for case, random in random_cases(11, 32, 300):
        machine = _machine(random)
        found = lw.gradient(machine, ["forced_vibration"])
        measure = _forced(machine, list(found.responses))
        assert measure(machine) == pytest.approx(found.values, rel=1e-10)
        error, what = largest_error(machine, found, measure, _shares(random, machine, found))
        assert error < _TOLERANCE, (case, what, error)


def _stepped(inertia: str) -> lw.Machine:
    """A shaft of two sections between discs, with next to no inertia, and one of its own behind."""
    return lw.loads(
        f"""
        format = 1
        name = "Stepped shaft"
        [train]
        inertia = "{inertia}"
        modes = 3
        [train.discs]
        a = {{ inertia = 2.0, damping = 5.0 }}
        b = {{ inertia = 3.0 }}
        c = {{ inertia = 1.0 }}
        [train.shafts.s]
        between = ["a", "b"]
        density = 2e-3
        loss_factor = 0.02
        sections = [{{ length = 1.0, diameter = 0.1 }}, {{ length = 2.0, diameter = 0.06 }}]
        [train.shafts.t]
        between = ["b", "c"]
        stiffness = 3e5
        own_inertia = 1e-10
        damping = 30.0
        [train.excitations.x]
        on = "a"
        harmonics = [{{ order = 1, torque = 100.0 }}, {{ order = 2, torque = 30.0 }}]
        [train.run]
        speed_min = 50.0
        speed_max = 400.0
        points = 7
        """
    )


@pytest.mark.parametrize("response", ["free_vibration.natural_frequencies", "free_vibration.mode_shapes.1"])
def test_without_density_derivatives_are_those_of_springs(response: str) -> None:
    """Up to the share of the inertia of the shafts, 1e-8."""
    along, ends = (lw.gradient(_stepped(inertia), [response]) for inertia in ("distributed", "ends"))
    own = [name.endswith(("density", "own_inertia")) for name in ends.variables]
    scale = np.maximum(np.abs(ends.derivatives * ends.at).max(axis=1), np.abs(ends.values))[:, None]
    error = np.abs(along.derivatives - ends.derivatives) * np.abs(ends.at) / scale
    assert along.variables == ends.variables
    assert np.where(own, 0.0, error).max() < 1e-7


def test_without_density_torques_follow_entries_as_those_of_springs() -> None:
    along, ends = (
        lw.gradient(_stepped(inertia), ["forced_vibration"]) for inertia in ("distributed", "ends")
    )
    scale = np.abs(ends.derivatives * ends.at).max(axis=1, keepdims=True)
    error = np.abs(along.derivatives - ends.derivatives) * np.abs(ends.at) / scale
    assert along.responses == ends.responses
    assert error.max() < 1e-7


def _rods(discs: dict[str, float], joined: dict[str, tuple[str, str]], modes: int) -> lw.Machine:
    """Discs on like rods of stiffness 1000 N m/rad and inertia 2 kg m²."""
    shafts = {
        name: {"between": list(ends), "stiffness": 1000.0, "own_inertia": 2.0}
        for name, ends in joined.items()
    }
    train = {
        "inertia": "distributed",
        "modes": modes,
        "discs": {name: {"inertia": J} for name, J in discs.items()},
        "shafts": shafts,
    }
    return lw.Machine.model_validate({"format": 1, "name": "Rods", "train": train})


def test_a_mode_whose_discs_are_at_rest() -> None:
    """Three like rods between two walls: β = π, ω = π √(k/j), in which each has a third of the energy.

    The discs are at the nodes: the frequency does not depend on them, their amplitudes have no derivative.
    """
    joined = {"p": ("ground", "a"), "q": ("a", "b"), "r": ("b", "ground")}
    machine = _rods({"a": 2.0, "b": 2.0}, joined, 4)
    found = lw.gradient(machine, ["free_vibration.natural_frequencies.2"])
    share = dict(zip(found.variables, found.elasticities[0].tolist(), strict=True))
    for name in joined:
        assert share[f"train.shafts.{name}.stiffness"] == pytest.approx(1 / 6, rel=1e-9)
        assert share[f"train.shafts.{name}.own_inertia"] == pytest.approx(-1 / 6, rel=1e-9)
    assert share["train.discs.a.inertia"] == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(FindingError, match="all discs are at rest in this mode"):
        lw.gradient(machine, ["free_vibration.mode_shapes.2.a"])


def test_a_repeated_frequency_gives_its_invariant() -> None:
    """Three like arms on a hub: each rod has a third of the mean of both squares, and both modes tie."""
    joined = {f"arm{n}": ("hub", f"d{n}") for n in range(3)}
    machine = _rods({"hub": 5.0} | {f"d{n}": 1.0 for n in range(3)}, joined, 5)
    names = [f"train.shafts.{name}.{entry}" for name in joined for entry in ("stiffness", "own_inertia")]
    found = lw.gradient(machine, ["free_vibration.natural_frequencies"], names)
    twins = [f"free_vibration.natural_frequencies.{n}" for n in (1, 2)]
    assert set(found.ties) == set(twins)

    def mean(changed: lw.Machine) -> np.ndarray:
        return np.array([np.mean(lw.free_vibration(changed).angular_frequencies[1:3] ** 2)])

    rows = [found.responses.index(name) for name in twins]
    for place, name in enumerate(names):
        slope = _difference(machine, {name: 1.0}, mean, 1e-4)[0] / mean(machine)[0]
        assert found.elasticities[rows, place] == pytest.approx(slope / 2, rel=1e-8)


def test_equal_amplitudes_tie() -> None:
    """Of two like discs on a rod either is the larger one as soon as they differ."""
    found = lw.gradient(_rods({"a": 1.0, "b": 1.0}, {"s": ("a", "b")}, 3), ["free_vibration.mode_shapes.1"])
    assert set(found.ties.values()) == {"the largest amplitude occurs at several positions"}


def test_both_ends_of_a_shaft_tie() -> None:
    """Between like discs, pushed against each other, the torque is largest at either end of a rod alike."""
    machine = _rods({"a": 1.0, "b": 1.0}, {"s": ("a", "b")}, 3)
    waves = [{"order": 1.0, "torque": 10.0}]
    against = [{"order": 1.0, "torque": 10.0, "phase": math.pi}]
    assert machine.train is not None
    train = machine.train.model_dump(exclude_unset=True) | {
        "excitations": {"x": {"on": "a", "harmonics": waves}, "y": {"on": "b", "harmonics": against}},
        "run": {"speed_min": 60.0, "speed_max": 90.0, "points": 3},
    }
    found = lw.gradient(
        lw.Machine.model_validate({"format": 1, "name": "Twins", "train": train}), ["forced_vibration"]
    )
    assert "several positions along the shaft" in found.ties["forced_vibration.shaft_torque_vibratory.s"]


def test_shafts_side_by_side_share_the_mean_torque() -> None:
    """By their stiffnesses, with or without inertia of their own."""
    machine = _stepped("distributed")
    assert machine.train is not None
    beside = machine.train.shafts["t"].model_copy(update={"stiffness": 2e5, "own_inertia": None})
    train = machine.train.model_dump(exclude_unset=True)
    train["shafts"] |= {"u": beside.model_dump(exclude_unset=True, exclude_none=True)}
    train["loads"] = {"l": {"on": "c", "torque": 400.0, "speed": 100.0}}
    for kind in ("distributed", "ends"):
        both = lw.Machine.model_validate({"format": 1, "name": "Two", "train": train | {"inertia": kind}})
        names = [f"forced_vibration.shaft_torque_max.{name}" for name in ("t", "u")]
        found = lw.gradient(both, names, ["train.shafts.t.stiffness", "train.shafts.u.stiffness"])
        error, what = largest_error(both, found, _forced(both, names), {found.variables[0]: 1.0})
        assert error < _TOLERANCE, what
