"""Random machines that a user might write, by a seed: linkages that close, bodies, loads, drives.

The sizes spread over decades, the way careless files do: light and heavy cranks, motors with and without
inertia, springs from soft to nearly rigid, gearboxes that tell the directions apart. Every machine is valid;
whether it moves is for the analysis to find.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.machine.machine import Machine

Tables = dict[str, Any]


def random_machine(seed: int) -> Machine:
    """The machine of a seed."""
    return Machine.model_validate(random_tables(seed))


def random_tables(seed: int) -> Tables:
    """The machine of a seed as the tables of its file."""
    random = np.random.default_rng(seed)
    radius = _spread(random, 0.02, 1.0)
    mechanism = _mechanism(random, radius)
    bodies = _bodies(random, mechanism)
    speed, ratio = _spread(random, 1.0, 60.0), float(random.choice([1.0, 5.0, 9.8, 40.0]))
    # Forces that the inertia, the weight, or neither calls for.
    force = _spread(random, 1.0, 1e3) * (1.0 + radius * speed)
    loads = _loads(random, mechanism, radius, force)
    torque = force * radius * _spread(random, 0.3, 30.0) / ratio
    return {
        "format": 1,
        "name": f"Random machine {seed}",
        "mechanism": mechanism,
        "bodies": bodies,
        "loads": loads,
        "drive": {
            "motor": _motor(random, speed * ratio, torque),
            "gearbox": {"ratio": ratio} | _efficiency(random),
        },
    }


def _spread(random: np.random.Generator, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def _mechanism(random: np.random.Generator, r: float) -> Tables:
    """A crank with a slider or a rocker that it can turn all round, or both; perhaps a second crank."""
    tables: Tables = {"cranks": {"A": {"radius": r, "phase": float(random.uniform(0, 2 * np.pi))}}}
    pins = ["A"]
    if random.random() < 0.3:
        tables["cranks"]["A2"] = {
            "radius": r * random.uniform(0.5, 1.5),
            "phase": random.uniform(0, 2 * np.pi),
        }
        pins.append("A2")
    kinds = random.choice(["slider", "rocker", "both"], p=[0.6, 0.2, 0.2])
    if kinds != "rocker":
        tables["sliders"] = {
            f"S{k}": {
                "crank": pin,
                "rod": 1.5 * r * random.uniform(1.6, 6.0),
                "offset": float(random.choice([0.0, 0.4 * r * random.uniform(-1, 1)])),
                "angle": float(random.choice([0.0, np.pi / 2, random.uniform(0, 6)])),
            }
            for k, pin in enumerate(pins)
        }
    if kinds != "slider":
        frame, coupler = 4.0 * r * random.uniform(1.0, 2.0), 4.0 * r * random.uniform(1.0, 2.0)
        # Grashof with the crank as the shortest link.
        rocker = random.uniform(abs(frame - coupler) + 1.5 * r, frame + coupler - 1.5 * r)
        way = random.uniform(0, 2 * np.pi)
        tables["points"] = {"P": {"x": frame * np.cos(way), "y": frame * np.sin(way)}}
        tables["rockers"] = {"R": {"crank": "A", "pivot": "P", "coupler": coupler, "rocker": rocker}}
    return tables


def _bodies(random: np.random.Generator, mechanism: Tables) -> Tables:
    bodies: Tables = {
        "A": {"mass": _spread(random, 0.1, 100.0), "inertia": float(random.choice([0.0, 0.1, 5.0]))}
    }
    for name in mechanism.get("sliders", {}):
        bodies[name] = {"mass": _spread(random, 0.1, 1e3)}
    if "rockers" in mechanism:
        bodies["R"] = {"mass": _spread(random, 0.1, 300.0)}
    return bodies


def _loads(random: np.random.Generator, mechanism: Tables, radius: float, force: float) -> Tables:
    """Up to three loads of different kinds; sometimes none."""
    member = "S0" if "sliders" in mechanism else "R"
    kinds: Tables = {
        "dry": {"kind": "dry", "on": member, "force": force},
        "viscous": {"kind": "viscous", "on": member, "damping": force / radius / 10.0},
        "gravity": {"kind": "gravity"},
        "spring": {
            "kind": "spring",
            "between": [member, "O"],
            "stiffness": _spread(random, 0.01, 30.0) * force / radius,
            "free_length": radius * random.uniform(0.5, 2.0),
        },
        "formula": {
            "kind": "formula",
            "on": member,
            "force": "-c*tanh(20*v)" if member == "S0" else "-c*vx",
            **({} if member == "S0" else {"direction": 0.0}),
            "constants": {"c": 0.3 * force},
        },
        "fan": {
            "kind": "torque_speed",
            "speed": [0.0, 20.0, 60.0],
            "torque": [0.0, 0.2 * force * radius, force],
        },
    }
    chosen = random.choice(list(kinds), size=int(random.integers(0, 4)), replace=False)
    return {str(name): kinds[str(name)] for name in chosen}


def _motor(random: np.random.Generator, speed: float, torque: float) -> Tables:
    inertia = float(random.choice([0.0, _spread(random, 1e-5, 10.0)])) * torque / speed
    kind = random.choice(["dc", "induction", "catalogue", "table"])
    if kind == "dc":
        motor = {"kind": "dc", "speed_no_load": speed, "torque_stall": torque * 3.0}
    elif kind == "table":
        speeds, torques = [0.0, 0.4 * speed, 0.8 * speed, 1.2 * speed], [0.8, 1.0, 0.4, -0.8]
        motor = {"kind": "table", "speed": speeds, "torque": [torque * share for share in torques]}
    else:
        slip = random.uniform(0.01, 0.06)
        motor = {
            "kind": "induction",
            "speed_synchronous": speed,
            "speed_rated": speed * (1 - slip),
            "torque_rated": torque,
            "torque_breakdown": torque * random.uniform(2.0, 3.5),
        }
        if kind == "catalogue":
            motor["torque_start"] = torque * random.uniform(1.2, 2.0)
    return motor | ({"inertia": inertia} if inertia > 0 else {})


def _efficiency(random: np.random.Generator) -> Tables:
    return [
        {"efficiency": 1.0},
        {"efficiency": 0.9},
        {"efficiency": 0.7, "reverse": "same"},
        {"efficiency": 0.7, "reverse": 1.2},
    ][int(random.integers(4))]
