"""Random pumping units of every geometry, with a load or with a rotator of rod strings."""

from __future__ import annotations

from typing import Any

import numpy as np

import linkwright as lw
from linkwright.pumping.model.rod_rotator import diagonal_extremes

# Conventional by API's example, the others with sizes of their kind.
GEOMETRIES = {
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


def random_unit(rng: np.random.Generator, geometry: str) -> lw.Machine:
    sizes = {key: value * rng.uniform(0.95, 1.05) for key, value in GEOMETRIES[geometry].items()}
    unit = {"geometry": geometry, **sizes, "structural_unbalance": rng.uniform(-2e3, 2e3)}
    described = {"format": 1, "name": "Unit", "drive": {"speed": rng.uniform(0.5, 1.5)}}
    return lw.Machine.model_validate(described | {"pumping_unit": unit | {"load": _load(rng, geometry)}})


def random_rotator(rng: np.random.Generator, regime: str, lengths: str) -> lw.Machine:
    geometry = str(rng.choice(list(GEOMETRIES)))
    unit: dict[str, Any] = {key: size * rng.uniform(0.9, 1.1) for key, size in GEOMETRIES[geometry].items()}
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
